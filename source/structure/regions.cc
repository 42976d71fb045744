#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/face_frame.h>
#include <mitre/structure/regions.h>

namespace mitre::structure
{
  namespace
  {
    bool contains(const std::vector<int> &ids, const unsigned int id)
    {
      return std::find(ids.begin(), ids.end(), static_cast<int>(id)) != ids.end();
    }


    /// Points of a line, triangle or square in coordinates from 0 to 1.
    template <int dim>
    dealii::Quadrature<dim - 1> face_rule(const ElementShape shape, const unsigned int n)
    {
      if constexpr (dim == 3)
        if (shape == ElementShape::simplex)
          return dealii::QWitherdenVincentSimplex<2>(n);
      return dealii::QGauss<dim - 1>(n);
    }


  } // namespace


  template <int dim>
  void SurfaceRegion<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Boundary ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Acts on those faces of the surface only that have one of these "
                      "physical ids in the mesh; empty: on all.");
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Acts on faces of elements with these ids only; empty: all.");
    prm.declare_entry(
      "Region",
      "1",
      dealii::Patterns::Anything(),
      "Acts on the faces at whose centre this expression of the reference "
      "coordinates x, y, z [cm] is not 0, for example 'x < 4'.");
  }


  template <int dim>
  void SurfaceRegion<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                            const std::string &owner)
  {
    what         = owner;
    region       = base::Expression<dim>(prm.get("Region"), what + ", Region");
    material_ids = base::parse_integers(prm.get("Material ids"), what + ", Material ids");
    boundary_ids = base::parse_integers(prm.get("Boundary ids"), what + ", Boundary ids");
  }


  template <int dim>
  void SurfaceRegion<dim>::initialize(const Mesh<dim> &mesh)
  {
    for (const int id : boundary_ids)
      if (std::find(mesh.boundary_ids.begin(), mesh.boundary_ids.end(), id) ==
          mesh.boundary_ids.end())
        {
          std::vector<unsigned int> known = mesh.boundary_ids;
          std::sort(known.begin(), known.end());
          known.erase(std::unique(known.begin(), known.end()), known.end());
          std::string list;
          for (const unsigned int other : known)
            list += (list.empty() ? "" : ", ") + std::to_string(other);
          throw base::UserError(
            what + ": \"Boundary ids\" has " + std::to_string(id) +
            ", but no surface element of " + mesh.source +
            " has this physical id. Its ids: " + (list.empty() ? "none" : list) + ".");
        }

    all_faces.clear();
    for (const BoundaryFace &face : find_boundary_faces(mesh))
      if ((boundary_ids.empty() || contains(boundary_ids, face.id)) &&
          (material_ids.empty() ||
           contains(material_ids, mesh.material_ids[face.element])) &&
          region.holds(centroid(mesh, face)))
        all_faces.push_back(face);
    make_tables(mesh);
  }


  template <int dim>
  void SurfaceRegion<dim>::make_tables(const Mesh<dim> &mesh)
  {
    const ReferenceElement<dim> element(mesh.shape, mesh.degree);
    const dealii::Quadrature<dim - 1> rule = face_rule<dim>(mesh.shape, mesh.degree + 1);
    n_points                               = rule.size();
    n_nodes                                = element.n_nodes();

    tables.clear();
    for (unsigned int f = 0; f < face_corners<dim>(mesh.shape).size(); ++f)
      {
        const FaceFrame<dim> frame = face_frame<dim>(mesh.shape, f);
        Table table;
        table.weights = rule.get_weights();
        table.on_face.assign(n_nodes, false);
        for (unsigned int q = 0; q < n_points; ++q)
          {
            dealii::Point<dim> xi = frame.origin;
            for (unsigned int k = 0; k + 1 < dim; ++k)
              xi += rule.point(q)[k] * frame.tangents[k];
            for (unsigned int a = 0; a < n_nodes; ++a)
              {
                table.values.push_back(element.value(a, xi));
                if (std::abs(table.values.back()) > 1e-12)
                  table.on_face[a] = true;
                std::array<double, dim - 1> derivatives;
                // where the normal would point inward, one tangent is turned round
                for (unsigned int k = 0; k + 1 < dim; ++k)
                  derivatives[k] = element.gradient(a, xi) * frame.tangents[k] *
                                   (k == 0 ? frame.orientation : 1.);
                table.derivatives.push_back(derivatives);
              }
          }
        tables.push_back(table);
      }
  }


  template <int dim>
  void SurfaceRegion<dim>::reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements)
  {
    std::vector<unsigned int> local(mesh.n_elements(),
                                    dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      local[elements.element(i)] = i;

    faces.clear();
    element_nodes.clear();
    reference_positions.clear();
    for (const BoundaryFace &face : all_faces)
      if (local[face.element] != dealii::numbers::invalid_unsigned_int)
        {
          const unsigned int *nodes = elements.nodes(local[face.element]);
          bool touches_owned_node   = false;
          for (unsigned int a = 0; a < n_nodes; ++a)
            touches_owned_node =
              touches_owned_node ||
              (tables[face.face].on_face[a] && nodes[a] < elements.n_owned_nodes());
          if (!touches_owned_node)
            continue;
          faces.push_back({face.face, static_cast<unsigned int>(element_nodes.size())});
          for (unsigned int a = 0; a < n_nodes; ++a)
            {
              element_nodes.push_back(nodes[a]);
              reference_positions.push_back(mesh.nodes[elements.file_node(nodes[a])]);
            }
        }
  }


  template <int dim>
  std::vector<unsigned int> SurfaceRegion<dim>::find_nodes(const Mesh<dim> &mesh) const
  {
    std::vector<unsigned int> nodes;
    for (const BoundaryFace &face : all_faces)
      for (unsigned int a = 0; a < n_nodes; ++a)
        if (tables[face.face].on_face[a])
          nodes.push_back(mesh.elements[face.element * n_nodes + a]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }


  template <int dim>
  std::vector<unsigned int>
  SurfaceRegion<dim>::find_owned_nodes(const ElementSet<dim> &elements) const
  {
    std::vector<unsigned int> nodes;
    for (const Face &face : faces)
      for (unsigned int a = 0; a < n_nodes; ++a)
        {
          const unsigned int node = element_nodes[face.first_node + a];
          if (tables[face.face].on_face[a] && node < elements.n_owned_nodes())
            nodes.push_back(node);
        }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }


  template <int dim>
  SurfacePoint<dim> SurfaceRegion<dim>::point(const Face &face,
                                              const unsigned int q,
                                              const NodalState &state) const
  {
    const Table &table = tables[face.face];
    SurfacePoint<dim> result;
    std::array<dealii::Tensor<1, dim>, dim - 1> reference_tangents, tangents;
    for (unsigned int a = 0; a < n_nodes; ++a)
      {
        const double *x   = state.X + element_nodes[face.first_node + a] * dim;
        const double *u   = state.U + element_nodes[face.first_node + a] * dim;
        const auto &s     = reference_positions[face.first_node + a];
        const double phi  = table.values[q * n_nodes + a];
        const auto &slope = table.derivatives[q * n_nodes + a];
        for (unsigned int c = 0; c < dim; ++c)
          {
            result.s[c] += phi * s[c];
            result.x[c] += phi * x[c];
            result.u[c] += phi * u[c];
            for (unsigned int k = 0; k + 1 < dim; ++k)
              {
                reference_tangents[k][c] += slope[k] * s[c];
                tangents[k][c] += slope[k] * x[c];
              }
          }
      }
    result.reference_area = table.weights[q] * area_vector<dim>(reference_tangents);
    result.area           = table.weights[q] * area_vector<dim>(tangents);
    return result;
  }


  template <int dim>
  void VolumeRegion<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Acts on elements with these ids only; empty: on all.");
    prm.declare_entry(
      "Region",
      "1",
      dealii::Patterns::Anything(),
      "Acts on the elements at whose centre this expression of the "
      "reference coordinates x, y, z [cm] is not 0, for example 'x < 4'.");
  }


  template <int dim>
  void VolumeRegion<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                           const std::string &what)
  {
    region       = base::Expression<dim>(prm.get("Region"), what + ", Region");
    material_ids = base::parse_integers(prm.get("Material ids"), what + ", Material ids");
  }


  template <int dim>
  void VolumeRegion<dim>::reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements)
  {
    const ReferenceElement<dim> element(mesh.shape, mesh.degree);
    shape = ShapeTable<dim>(element, element.mass_quadrature());

    element_nodes.clear();
    reference_positions.clear();
    volumes.clear();
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      {
        const unsigned int e = elements.element(i);
        if (!(material_ids.empty() || contains(material_ids, mesh.material_ids[e])) ||
            !region.holds(mesh.centroid(e)))
          continue;
        for (unsigned int a = 0; a < shape.n_nodes; ++a)
          {
            element_nodes.push_back(elements.nodes(i)[a]);
            reference_positions.push_back(
              mesh.nodes[elements.file_node(elements.nodes(i)[a])]);
          }
        for (unsigned int q = 0; q < shape.n_points; ++q)
          volumes.push_back(determinant(shape.jacobian(mesh, e, q)) * shape.weights[q]);
      }
  }


  template class SurfaceRegion<2>;
  template class SurfaceRegion<3>;
  template class VolumeRegion<2>;
  template class VolumeRegion<3>;
} // namespace mitre::structure
