#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

#include <mitre/structure/face_frame.h>
#include <mitre/structure/surface_tractions.h>

namespace mitre::structure
{
  namespace
  {
    /// Points of a line, triangle or square, about n along an edge; exact for quadratics
    /// at least.
    template <int dim>
    dealii::Quadrature<dim - 1> dense_rule(const ElementShape shape, const unsigned int n)
    {
      if constexpr (dim == 3)
        if (shape == ElementShape::simplex)
          {
            // three points in each of m^2 equal triangles, of which some stand on their
            // tips
            const unsigned int m = (n + 1) / 2;
            std::vector<dealii::Point<2>> points;
            for (unsigned int j = 0; j < m; ++j)
              for (unsigned int i = 0; i + j < m; ++i)
                for (const auto &[a, b] : {std::make_pair(1. / 6, 1. / 6),
                                           std::make_pair(2. / 3, 1. / 6),
                                           std::make_pair(1. / 6, 2. / 3)})
                  {
                    points.emplace_back((i + a) / m, (j + b) / m);
                    if (i + j + 1 < m)
                      points.emplace_back((i + 1 - a) / m, (j + 1 - b) / m);
                  }
            return dealii::Quadrature<2>(
              points, std::vector<double>(points.size(), 0.5 / points.size()));
          }
      return dealii::QGauss<dim - 1>(n);
    }
  } // namespace


  template <int dim>
  SurfaceTractions<dim>::SurfaceTractions(const FiniteElementBody<dim> &body)
    : body(body)
    , faces(find_boundary_faces(body.mesh()))
  {
    const std::vector<Material<dim>> &all = body.materials();
    for (const BoundaryFace &face : faces)
      {
        const unsigned int id = body.mesh().material_ids[face.element];
        const auto found =
          std::find_if(all.begin(), all.end(), [id](const Material<dim> &material) {
            return std::find(material.ids.begin(), material.ids.end(), id) !=
                   material.ids.end();
          });
        AssertThrow(found != all.end(), dealii::ExcInternalError());
        materials.push_back(found - all.begin());
      }
  }


  template <int dim>
  const typename SurfaceTractions<dim>::Table &
  SurfaceTractions<dim>::table(const unsigned int face, const unsigned int n) const
  {
    const auto [entry, is_new] = tables.try_emplace({face, n});
    if (is_new)
      {
        const FaceFrame<dim> frame             = face_frame<dim>(body.mesh().shape, face);
        const dealii::Quadrature<dim - 1> rule = dense_rule<dim>(body.mesh().shape, n);
        std::vector<dealii::Point<dim>> points;
        for (const dealii::Point<dim - 1> &eta : rule.get_points())
          {
            points.push_back(frame.origin);
            for (unsigned int k = 0; k + 1 < dim; ++k)
              points.back() += eta[k] * frame.tangents[k];
          }
        entry->second.shape =
          ShapeTable<dim>(body.reference_element(), dealii::Quadrature<dim>(points));
        entry->second.weights = rule.get_weights();
      }
    return entry->second;
  }


  template <int dim>
  void SurfaceTractions<dim>::compute(
    const std::vector<double> &X,
    const double t,
    const double spacing,
    const std::function<bool(const dealii::Point<dim> &)> &is_here,
    SurfaceForces<dim> &result) const
  {
    const Mesh<dim> &mesh      = body.mesh();
    const unsigned int n_nodes = mesh.nodes_per_element;
    result.points.clear();
    result.forces.clear();
    result.moments.assign(X.size(), 0.);

    std::vector<FaceFrame<dim>> frames;
    for (unsigned int f = 0; f < face_corners<dim>(mesh.shape).size(); ++f)
      frames.push_back(face_frame<dim>(mesh.shape, f));
    std::vector<double> factors;
    for (const Material<dim> &material : body.materials())
      factors.push_back(material.time_factor.value(t));

    for (unsigned int i = 0; i < faces.size(); ++i)
      {
        const BoundaryFace &face  = faces[i];
        const unsigned int *nodes = &mesh.elements[face.element * n_nodes];
        const auto position       = [&](const unsigned int node) {
          dealii::Point<dim> x;
          for (unsigned int c = 0; c < dim; ++c)
            x[c] = X[node * dim + c];
          return x;
        };

        // Step 1: a rule for its longest edge.
        const std::vector<unsigned int> &corners =
          face_corners<dim>(mesh.shape)[face.face];
        double longest = 0;
        for (const unsigned int a : corners)
          for (const unsigned int b : corners)
            longest = std::max(longest, position(nodes[a]).distance(position(nodes[b])));
        const unsigned int n =
          std::max(mesh.degree + 1., std::min(64., std::ceil(1.1 * longest / spacing)));
        const Table &rule = table(face.face, n);

        // Step 2: what acts on its points.
        Fibres<dim> fibres;
        for (unsigned int f = 0; f < mesh.n_fibre_families(); ++f)
          fibres[f] = mesh.fibres[f][face.element];
        const FaceFrame<dim> &frame = frames[face.face];
        for (unsigned int q = 0; q < rule.weights.size(); ++q)
          {
            dealii::Point<dim> x;
            for (unsigned int a = 0; a < n_nodes; ++a)
              x += rule.shape.values[q * n_nodes + a] * position(nodes[a]);
            if (!is_here(x))
              continue;

            const dealii::Tensor<2, dim> jacobian =
              rule.shape.jacobian(mesh, face.element, q);
            const dealii::Tensor<2, dim> inverse = invert(jacobian);
            dealii::Tensor<2, dim> F;
            for (unsigned int a = 0; a < n_nodes; ++a)
              F += outer_product(position(nodes[a]),
                                 rule.shape.gradients[q * n_nodes + a] * inverse);
            std::array<dealii::Tensor<1, dim>, dim - 1> tangents;
            for (unsigned int k = 0; k + 1 < dim; ++k)
              tangents[k] =
                (k == 0 ? frame.orientation : 1.) * (jacobian * frame.tangents[k]);
            const dealii::Tensor<1, dim> force =
              (-factors[materials[i]] * rule.weights[q]) *
              (body.materials()[materials[i]].law->first_piola_kirchhoff_stress(
                 F, fibres, t) *
               area_vector<dim>(tangents));

            result.points.push_back(x);
            result.forces.push_back(force);
            for (unsigned int a = 0; a < n_nodes; ++a)
              for (unsigned int c = 0; c < dim; ++c)
                result.moments[nodes[a] * dim + c] +=
                  rule.shape.values[q * n_nodes + a] * force[c];
          }
      }
  }


  template struct SurfaceForces<2>;
  template struct SurfaceForces<3>;
  template class SurfaceTractions<2>;
  template class SurfaceTractions<3>;
} // namespace mitre::structure
