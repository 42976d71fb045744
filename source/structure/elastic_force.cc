#include <deal.II/base/types.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <array>

#include <mitre/structure/constitutive_laws/volumetric_part.h>
#include <mitre/structure/elastic_force.h>

namespace mitre::structure
{
  namespace
  {
    /// Gradients of the shape functions and JxW at the points of a rule.
    template <int dim>
    void compute_gradients(const Mesh<dim> &mesh,
                           const ElementSet<dim> &elements,
                           const ShapeTable<dim> &shape,
                           std::vector<double> &gradients,
                           std::vector<double> &JxW)
    {
      gradients.clear();
      gradients.reserve(elements.n_elements() * shape.n_points * shape.n_nodes * dim);
      JxW.clear();
      JxW.reserve(elements.n_elements() * shape.n_points);
      for (unsigned int i = 0; i < elements.n_elements(); ++i)
        for (unsigned int q = 0; q < shape.n_points; ++q)
          {
            const dealii::Tensor<2, dim> jacobian =
              shape.jacobian(mesh, elements.element(i), q);
            const dealii::Tensor<2, dim> inverse = invert(jacobian);
            for (unsigned int a = 0; a < shape.n_nodes; ++a)
              {
                const dealii::Tensor<1, dim> gradient =
                  shape.gradients[q * shape.n_nodes + a] * inverse;
                for (unsigned int d = 0; d < dim; ++d)
                  gradients.push_back(gradient[d]);
              }
            JxW.push_back(determinant(jacobian) * shape.weights[q]);
          }
    }
  } // namespace


  template <int dim>
  void ReferenceCache<dim>::reinit(const Mesh<dim> &mesh,
                                   const ElementSet<dim> &elements,
                                   const ReferenceElement<dim> &reference_element)
  {
    // Step 1: gradients.
    const ShapeTable<dim> shape(reference_element, reference_element.force_quadrature());
    nodes_per_element  = shape.n_nodes;
    points_per_element = shape.n_points;
    compute_gradients(mesh, elements, shape, gradients, JxW);

    // Step 2: the functions for the change of volume, and the inverse of their mass.
    const dealii::Quadrature<dim> &rule = reference_element.force_quadrature();
    n_volume_modes                      = shape.n_nodes == dim + 1 ? 0
                                          : mesh.shape == ElementShape::hypercube && mesh.degree == 2 ? dim + 1
                                                                                                      : 1;
    volume_modes.clear();
    for (unsigned int q = 0; q < shape.n_points; ++q)
      for (unsigned int k = 0; k < n_volume_modes; ++k)
        volume_modes.push_back(k == 0 ? 1 : rule.point(q)[k - 1] - 0.5);
    inverse_volume_mass.clear();
    for (unsigned int i = 0; i < (n_volume_modes > 0 ? elements.n_elements() : 0); ++i)
      {
        dealii::FullMatrix<double> mass(n_volume_modes);
        for (unsigned int q = 0; q < shape.n_points; ++q)
          for (unsigned int k = 0; k < n_volume_modes; ++k)
            for (unsigned int l = 0; l < n_volume_modes; ++l)
              mass(k, l) += JxW[i * shape.n_points + q] *
                            volume_modes[q * n_volume_modes + k] *
                            volume_modes[q * n_volume_modes + l];
        mass.gauss_jordan();
        for (unsigned int k = 0; k < n_volume_modes; ++k)
          for (unsigned int l = 0; l < n_volume_modes; ++l)
            inverse_volume_mass.push_back(mass(k, l));
      }

    // Step 3: fibres.
    fibres.assign(elements.n_elements(), Fibres<dim>());
    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      for (unsigned int f = 0; f < mesh.n_fibre_families(); ++f)
        fibres[i][f] = mesh.fibres[f][elements.element(i)];
  }


  namespace
  {
    template <int dim, int n_nodes>
    inline dealii::Tensor<2, dim> deformation_gradient(const double *gradients,
                                                       const unsigned int *nodes,
                                                       const double *positions)
    {
      double F[dim][dim] = {};
      for (int a = 0; a < n_nodes; ++a)
        {
          const double *X = positions + nodes[a] * dim;
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
              F[i][j] += X[i] * gradients[a * dim + j];
        }

      dealii::Tensor<2, dim> result;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          result[i][j] = F[i][j];
      return result;
    }


    /// Add factor P grad phi_a to the nodes of an element.
    template <int dim, int n_nodes>
    inline void add_stress(const dealii::Tensor<2, dim> &P,
                           const double factor,
                           const double *gradients,
                           const unsigned int *nodes,
                           double *forces)
    {
      double stress[dim][dim];
      for (int c = 0; c < dim; ++c)
        for (int j = 0; j < dim; ++j)
          stress[c][j] = P[c][j] * factor;

      for (int a = 0; a < n_nodes; ++a)
        {
          double *force = forces + nodes[a] * dim;
          for (int c = 0; c < dim; ++c)
            {
              double sum = 0;
              for (int j = 0; j < dim; ++j)
                sum += stress[c][j] * gradients[a * dim + j];
              force[c] += sum;
            }
        }
    }


    // Batches of elements: deformation gradients, then all stresses by one virtual call,
    // then forces. Bound by arithmetic and by the latency of the nodes' gather.
    template <int dim, int n_nodes>
    unsigned int compute_force(const ReferenceCache<dim> &cache,
                               const ElementSet<dim> &elements,
                               const MaterialRange<dim> &range,
                               const double t,
                               const double *positions,
                               double *forces)
    {
      constexpr unsigned int max_points = 64;
      const unsigned int n_q            = cache.points_per_element;
      const unsigned int batch_size     = std::max(1u, max_points / n_q);

      std::array<dealii::Tensor<2, dim>, max_points> F, P;
      std::array<double, max_points> J;
      AssertThrow(n_q <= max_points, dealii::ExcNotImplemented());

      for (unsigned int begin = range.begin; begin < range.end; begin += batch_size)
        {
          const unsigned int end = std::min(begin + batch_size, range.end);

          // Step 1: deformation gradients.
          double smallest_J = 1;
          unsigned p        = 0;
          for (unsigned int i = begin; i < end; ++i)
            for (unsigned int q = 0; q < n_q; ++q, ++p)
              {
                F[p] = deformation_gradient<dim, n_nodes>(cache.gradients.data() +
                                                            (i * n_q + q) * n_nodes * dim,
                                                          elements.nodes(i),
                                                          positions);
                J[p] = determinant(F[p]);
                // Written so that NaN counts as inverted.
                smallest_J = J[p] > 0 ? smallest_J : -1;
              }
          if (smallest_J < 0)
            for (unsigned int point = 0; point < p; ++point)
              if (!(J[point] > 0))
                return begin + point / n_q;

          // Step 2: stresses.
          range.law->compute_stresses(
            dealii::ArrayView<const dealii::Tensor<2, dim>>(F.data(), p),
            dealii::ArrayView<const double>(J.data(), p),
            cache.fibres.data() + begin,
            n_q,
            t,
            dealii::ArrayView<dealii::Tensor<2, dim>>(P.data(), p));

          if (range.projected_part != nullptr)
            {
              std::array<double, max_points> pressures;
              for (unsigned int i = begin; i < end; ++i)
                project_volumetric_part(cache,
                                        *range.projected_part,
                                        i,
                                        J.data() + (i - begin) * n_q,
                                        pressures.data() + (i - begin) * n_q);
              for (unsigned int point = 0; point < p; ++point)
                P[point] += (pressures[point] -
                             range.projected_part->bulk_kirchhoff_pressure(J[point])) *
                            transpose(invert(F[point]));
            }

          // Step 3: forces.
          p = 0;
          for (unsigned int i = begin; i < end; ++i)
            for (unsigned int q = 0; q < n_q; ++q, ++p)
              {
                const double factor = -cache.JxW[i * n_q + q] * range.time_factor;
                const double *gradients =
                  cache.gradients.data() + (i * n_q + q) * n_nodes * dim;

                add_stress<dim, n_nodes>(
                  P[p], factor, gradients, elements.nodes(i), forces);
              }
        }
      return dealii::numbers::invalid_unsigned_int;
    }
  } // namespace


  template <int dim>
  unsigned int compute_elastic_force(const ReferenceCache<dim> &cache,
                                     const ElementSet<dim> &elements,
                                     const MaterialRange<dim> &range,
                                     const double t,
                                     const double *positions,
                                     double *forces)
  {
    unsigned int result = dealii::numbers::invalid_unsigned_int;
    with_n_nodes<dim>(cache.nodes_per_element, [&](const auto n_nodes) {
      result = compute_force<dim, decltype(n_nodes)::value>(
        cache, elements, range, t, positions, forces);
    });
    return result;
  }


  template <int dim>
  double compute_elastic_energy(const ReferenceCache<dim> &cache,
                                const ElementSet<dim> &elements,
                                const MaterialRange<dim> &range,
                                const double t,
                                const double *positions)
  {
    const unsigned int n_q     = cache.points_per_element;
    const VolumetricPart *part = range.projected_part;
    std::vector<double> J(n_q), pressures(n_q);
    double energy = 0;
    for (unsigned int i = range.begin; i < range.end; ++i)
      if (elements.nodes(i)[0] < elements.n_owned_nodes())
        {
          for (unsigned int q = 0; q < n_q; ++q)
            {
              const dealii::Tensor<2, dim> F =
                compute_deformation_gradient(cache, elements, i, q, positions);
              double density = range.law->energy(F, cache.fibres[i], t);
              if (part != nullptr)
                {
                  J[q] = determinant(F);
                  density -= part->bulk_energy(J[q]);
                }
              energy += cache.JxW[i * n_q + q] * density;
            }
          if (part != nullptr)
            energy +=
              project_volumetric_part(cache, *part, i, J.data(), pressures.data());
        }
    return energy * range.time_factor;
  }


  template <int dim>
  double project_volumetric_part(const ReferenceCache<dim> &cache,
                                 const VolumetricPart &part,
                                 const unsigned int i,
                                 const double *J,
                                 double *pressures)
  {
    constexpr unsigned int max_modes = dim + 1;
    const unsigned int n_q           = cache.points_per_element;
    const unsigned int n             = cache.n_volume_modes;
    const double *JxW                = cache.JxW.data() + i * n_q;
    const double *inverse_mass       = cache.inverse_volume_mass.data() + i * n * n;

    /// Replace values at the points by those of their projection.
    const auto project = [&](double *values) {
      double moments[max_modes] = {};
      for (unsigned int q = 0; q < n_q; ++q)
        for (unsigned int k = 0; k < n; ++k)
          moments[k] += JxW[q] * values[q] * cache.volume_modes[q * n + k];
      double coefficients[max_modes] = {};
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          coefficients[k] += inverse_mass[k * n + l] * moments[l];
      for (unsigned int q = 0; q < n_q; ++q)
        {
          values[q] = 0;
          for (unsigned int k = 0; k < n; ++k)
            values[q] += coefficients[k] * cache.volume_modes[q * n + k];
        }
    };

    std::copy(J, J + n_q, pressures);
    project(pressures);
    double energy = 0;
    for (unsigned int q = 0; q < n_q; ++q)
      {
        const double projected_J = pressures[q];
        energy += JxW[q] * part.bulk_energy(projected_J);
        pressures[q] = part.bulk_kirchhoff_pressure(projected_J) / projected_J;
      }
    project(pressures);
    for (unsigned int q = 0; q < n_q; ++q)
      pressures[q] *= J[q];
    return energy;
  }


  template <int dim>
  dealii::Tensor<2, dim> compute_deformation_gradient(const ReferenceCache<dim> &cache,
                                                      const ElementSet<dim> &elements,
                                                      const unsigned int i,
                                                      const unsigned int q,
                                                      const double *positions)
  {
    const double *gradients =
      cache.gradients.data() +
      (i * cache.points_per_element + q) * cache.nodes_per_element * dim;
    dealii::Tensor<2, dim> result;
    with_n_nodes<dim>(cache.nodes_per_element, [&](const auto n_nodes) {
      result = deformation_gradient<dim, decltype(n_nodes)::value>(
        gradients, elements.nodes(i), positions);
    });
    return result;
  }


#define INSTANTIATE(dim)                                                                 \
  template struct ReferenceCache<dim>;                                                   \
  template unsigned int compute_elastic_force(const ReferenceCache<dim> &,               \
                                              const ElementSet<dim> &,                   \
                                              const MaterialRange<dim> &,                \
                                              const double,                              \
                                              const double *,                            \
                                              double *);                                 \
  template double compute_elastic_energy(const ReferenceCache<dim> &,                    \
                                         const ElementSet<dim> &,                        \
                                         const MaterialRange<dim> &,                     \
                                         const double,                                   \
                                         const double *);                                \
  template double project_volumetric_part(const ReferenceCache<dim> &,                   \
                                          const VolumetricPart &,                        \
                                          const unsigned int,                            \
                                          const double *,                                \
                                          double *);                                     \
  template dealii::Tensor<2, dim> compute_deformation_gradient(                          \
    const ReferenceCache<dim> &,                                                         \
    const ElementSet<dim> &,                                                             \
    const unsigned int,                                                                  \
    const unsigned int,                                                                  \
    const double *);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace mitre::structure
