#ifndef mitre_structure_regions_h
#define mitre_structure_regions_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

#include <mitre/base/expression.h>
#include <mitre/structure/boundary_faces.h>
#include <mitre/structure/node_numbering.h>
#include <mitre/structure/reference_element.h>

namespace mitre::structure
{
  /// A body as it is now: positions X [cm] and velocities U [cm/s] by local node of an
  /// ElementSet, ghosts included, and component; and the time [s].
  struct NodalState
  {
    const double *X;
    const double *U;
    double t;
  };


  /// A quadrature point on a surface.
  template <int dim>
  struct SurfacePoint
  {
    /// Where it is in the reference configuration and now [cm], and its velocity [cm/s].
    dealii::Point<dim> s, x;
    dealii::Tensor<1, dim> u;

    /// @f$N\,dA@f$ and @f$n\,da@f$ [cm^(dim-1)]: outward normals times area (length in
    /// 2D) and weight, in the reference configuration and now.
    dealii::Tensor<1, dim> reference_area, area;
  };


  /**
   * Those faces of a body's boundary that a parameter file chooses by the physical ids of
   * surface elements in the mesh, by materials and by an expression, and integrals over
   * them.
   */
  template <int dim>
  class SurfaceRegion
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what names the load or constraint in messages
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);

    /// Find the faces.
    void initialize(const Mesh<dim> &mesh);

    /// Keep those of @p elements, which touch owned nodes; to be called again whenever
    /// nodes have been distributed anew.
    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements);

    /// Number of faces that this rank works on.
    unsigned int n_faces() const
    {
      return faces.size();
    }

    /// Nodes of the mesh on the faces that initialize() has found.
    std::vector<unsigned int> find_nodes(const Mesh<dim> &mesh) const;

    /// Owned nodes on the faces, by local number.
    std::vector<unsigned int> find_owned_nodes(const ElementSet<dim> &elements) const;

    /**
     * Add @f$\int \phi_a f\,dA@f$ [dyn] to the @p forces by local node and component. The
     * @p force of a SurfacePoint is a function that returns f dA [dyn]. Entries of nodes
     * that are not owned are incomplete.
     */
    template <typename Force>
    void add_forces(const NodalState &state, const Force &force, double *forces) const
    {
      for (const Face &face : faces)
        {
          const Table &table = tables[face.face];
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const dealii::Tensor<1, dim> f = force(point(face, q, state));
              for (unsigned int a = 0; a < n_nodes; ++a)
                for (unsigned int c = 0; c < dim; ++c)
                  forces[element_nodes[face.first_node + a] * dim + c] +=
                    table.values[q * n_nodes + a] * f[c];
            }
        }
    }

  private:
    struct Face
    {
      unsigned int face;

      /// Of the element, in element_nodes and reference_positions.
      unsigned int first_node;
    };

    /// Shape functions of an element at the points of one of its faces, and their
    /// derivatives along it.
    struct Table
    {
      std::vector<double> values;
      std::vector<std::array<double, dim - 1>> derivatives;
      std::vector<double> weights;
      std::vector<bool> on_face;
    };

    SurfacePoint<dim>
    point(const Face &face, const unsigned int q, const NodalState &state) const;

    void make_tables(const Mesh<dim> &mesh);

    base::Expression<dim> region;
    std::vector<int> material_ids;
    std::vector<int> boundary_ids;
    std::string what;

    std::vector<BoundaryFace> all_faces;
    std::vector<Table> tables;
    unsigned int n_points = 0, n_nodes = 0;

    std::vector<Face> faces;
    std::vector<unsigned int> element_nodes;
    std::vector<dealii::Point<dim>> reference_positions;
  };


  /// A quadrature point within a body.
  template <int dim>
  struct VolumePoint
  {
    /// Where it is in the reference configuration and now [cm], and its velocity [cm/s].
    dealii::Point<dim> s, x;
    dealii::Tensor<1, dim> u;

    /// Weight times reference volume [cm^dim].
    double volume;
  };


  /**
   * Those elements of a body that a parameter file chooses by materials and by an
   * expression, and integrals over them.
   */
  template <int dim>
  class VolumeRegion
  {
  public:
    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements);

    unsigned int n_elements() const
    {
      return volumes.empty() ? 0 : volumes.size() / shape.n_points;
    }

    /// As SurfaceRegion::add_forces(), with a function of a VolumePoint.
    template <typename Force>
    void add_forces(const NodalState &state, const Force &force, double *forces) const
    {
      const unsigned int n_nodes = shape.n_nodes;
      for (unsigned int i = 0; i < n_elements(); ++i)
        for (unsigned int q = 0; q < shape.n_points; ++q)
          {
            const unsigned int *nodes = element_nodes.data() + i * n_nodes;
            VolumePoint<dim> point;
            point.volume = volumes[i * shape.n_points + q];
            for (unsigned int a = 0; a < n_nodes; ++a)
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const double value = shape.values[q * n_nodes + a];
                  point.s[c] += value * reference_positions[i * n_nodes + a][c];
                  point.x[c] += value * state.X[nodes[a] * dim + c];
                  point.u[c] += value * state.U[nodes[a] * dim + c];
                }
            const dealii::Tensor<1, dim> f = force(point);
            for (unsigned int a = 0; a < n_nodes; ++a)
              for (unsigned int c = 0; c < dim; ++c)
                forces[nodes[a] * dim + c] += shape.values[q * n_nodes + a] * f[c];
          }
    }

  private:
    base::Expression<dim> region;
    std::vector<int> material_ids;

    ShapeTable<dim> shape;
    std::vector<unsigned int> element_nodes;
    std::vector<dealii::Point<dim>> reference_positions;
    std::vector<double> volumes;
  };
} // namespace mitre::structure

#endif
