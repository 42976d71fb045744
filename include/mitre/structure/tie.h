#ifndef mitre_structure_tie_h
#define mitre_structure_tie_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/base/expression.h>
#include <mitre/structure/body.h>

namespace mitre::structure
{
  /**
   * Ties a part to another one of finite elements where they meet: springs of no length
   * between nodes of the first and the material points of the second that are in the same
   * places at rest. With the shape functions @f$\phi_a@f$ of the element around node i,
   * @f[ f_i = -\kappa \Big(x_i - \sum_a \phi_a X_a\Big), \qquad f_a = -\phi_a f_i, @f]
   * so that forces and, while the spring is short, torques balance, and the energy is
   * @f$\frac{\kappa}{2} |x_i - \sum_a \phi_a X_a|^2@f$.
   */
  template <int dim>
  class Tie
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param name for messages
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &name);

    const std::string &name() const
    {
      return name_;
    }

    /// The part whose nodes are tied, and the one that they are tied to.
    const std::string &part() const
    {
      return part_;
    }

    const std::string &host() const
    {
      return host_;
    }

    /**
     * Finds the places of the nodes of @p part in @p host. Throws base::UserError if a
     * node that the region chooses is in no element of @p host, if none is chosen, or if
     * @p host has no elements of degree 1 or 2.
     */
    void reinit(const Mesh<dim> &part, const Mesh<dim> &host);

    unsigned int n_nodes() const
    {
      return places.size();
    }

    /// Adds the forces [dyn] on both parts; all arrays by node of the mesh and component.
    void add_forces(const std::vector<double> &X_part,
                    const std::vector<double> &X_host,
                    std::vector<double> &on_part,
                    std::vector<double> &on_host) const;

    /// The longest of the springs [cm].
    double largest_distance(const std::vector<double> &X_part,
                            const std::vector<double> &X_host) const;

  private:
    struct Place
    {
      unsigned int node;
      std::vector<unsigned int> host_nodes;
      std::vector<double> weights;
    };

    dealii::Tensor<1, dim> distance(const Place &place,
                                    const std::vector<double> &X_part,
                                    const std::vector<double> &X_host) const;

    std::string name_, part_, host_;
    base::Expression<dim> region;
    bool takes_all_inside = true;
    double stiffness      = 0.;
    std::vector<Place> places;
  };
} // namespace mitre::structure

#endif
