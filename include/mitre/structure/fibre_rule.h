#ifndef mitre_structure_fibre_rule_h
#define mitre_structure_fibre_rule_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/structure/mesh.h>
#include <mitre/structure/regions.h>

namespace mitre::structure
{
  /**
   * Fibre directions by rule, in place of those of the mesh file. In the elements of some
   * materials the Laplace equation is solved twice: for @f$\phi@f$, which rises from 0 on
   * an inner to 1 on an outer surface, and, in 3D, for @f$\psi@f$, which rises from 0 on
   * a surface where the part starts to 1 where it ends. In the middle of each element
   * @f[ e_t = \nabla\phi/|\nabla\phi|,\quad
   *     e_l \sim \nabla\psi - (\nabla\psi\cdot e_t)\,e_t,\quad
   *     e_c = e_l\times e_t @f]
   * are the transmural, longitudinal and circumferential directions; in 2D @f$e_c@f$ is
   * @f$e_t@f$ turned by 90 degrees. Fibres run at an angle to @f$e_c@f$ towards
   * @f$e_l@f$ that changes linearly with @f$\phi@f$.
   *
   * After Bayer et al. (2012), Ann. Biomed. Eng. 40, for the wall of a ventricle, without
   * their interpolation between walls.
   */
  template <int dim>
  class FibreRule
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what the part, for messages. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);

    /**
     * @p mesh with the directions of the rule in the elements that it is for; elsewhere
     * those that the mesh has. Without a rule, the mesh as it is. Throws base::UserError
     * if a surface has no nodes or shares nodes with the opposite one, or if a potential
     * is constant in an element, which it names.
     */
    Mesh<dim> apply(Mesh<dim> mesh);

  private:
    enum class SecondFamily : unsigned char
    {
      none,
      mirrored,
      transmural
    };

    /// One of the surfaces between which a potential rises.
    struct Surface
    {
      std::string name;
      SurfaceRegion<dim> region;
      std::vector<int> adjacent_ids;
    };

    /// Numbers of the nodes of @p part, a part of @p mesh, on a surface.
    std::vector<unsigned int> find_nodes(Surface &surface,
                                         const Mesh<dim> &mesh,
                                         const std::vector<unsigned int> &elements,
                                         const Mesh<dim> &part) const;

    std::string what;
    bool active = false;
    std::vector<int> material_ids;
    SecondFamily second = SecondFamily::none;

    /// At the inner and the outer surface [radians].
    double inner_angle = 0, outer_angle = 0;

    /// Inner, outer, and in 3D start and end.
    std::vector<Surface> surfaces;
  };


  /**
   * The solution of the Laplace equation that is 0 at the nodes @p zero, 1 at the nodes
   * @p one and has no normal derivative elsewhere on the boundary, by node, with the
   * shape functions of the mesh. Conjugate gradients to a residual of 1e-10.
   */
  template <int dim>
  std::vector<double> solve_laplace(const Mesh<dim> &mesh,
                                    const std::vector<unsigned int> &zero,
                                    const std::vector<unsigned int> &one);
} // namespace mitre::structure

#endif
