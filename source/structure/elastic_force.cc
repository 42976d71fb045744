#include <deal.II/base/types.h>

#include <algorithm>
#include <array>

#include <mitre/structure/elastic_force.h>

namespace mitre::structure
{
  template <int dim>
  void ReferenceCache<dim>::reinit(const Mesh<dim> &mesh,
                                   const ElementSet<dim> &elements,
                                   const ReferenceElement<dim> &reference_element)
  {
    const ShapeTable<dim> shape(reference_element, reference_element.force_quadrature());
    nodes_per_element  = shape.n_nodes;
    points_per_element = shape.n_points;

    gradients.clear();
    gradients.reserve(elements.n_elements() * shape.n_points * shape.n_nodes * dim);
    JxW.clear();
    JxW.reserve(elements.n_elements() * shape.n_points);
    fibres.assign(elements.n_elements(), Fibres<dim>());

    for (unsigned int i = 0; i < elements.n_elements(); ++i)
      {
        const unsigned int e = elements.element(i);
        for (unsigned int q = 0; q < shape.n_points; ++q)
          {
            const dealii::Tensor<2, dim> jacobian = shape.jacobian(mesh, e, q);
            const dealii::Tensor<2, dim> inverse  = invert(jacobian);
            for (unsigned int a = 0; a < shape.n_nodes; ++a)
              {
                const dealii::Tensor<1, dim> gradient =
                  shape.gradients[q * shape.n_nodes + a] * inverse;
                for (unsigned int d = 0; d < dim; ++d)
                  gradients.push_back(gradient[d]);
              }
            JxW.push_back(determinant(jacobian) * shape.weights[q]);
          }
        for (unsigned int f = 0; f < mesh.n_fibre_families(); ++f)
          fibres[i][f] = mesh.fibres[f][e];
      }
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

          // Step 3: forces.
          p = 0;
          for (unsigned int i = begin; i < end; ++i)
            for (unsigned int q = 0; q < n_q; ++q, ++p)
              {
                const double factor = -cache.JxW[i * n_q + q] * range.time_factor;
                const double *gradients =
                  cache.gradients.data() + (i * n_q + q) * n_nodes * dim;

                double stress[dim][dim];
                for (int c = 0; c < dim; ++c)
                  for (int j = 0; j < dim; ++j)
                    stress[c][j] = P[p][c][j] * factor;

                for (int a = 0; a < n_nodes; ++a)
                  {
                    double *force = forces + elements.nodes(i)[a] * dim;
                    for (int c = 0; c < dim; ++c)
                      {
                        double sum = 0;
                        for (int j = 0; j < dim; ++j)
                          sum += stress[c][j] * gradients[a * dim + j];
                        force[c] += sum;
                      }
                  }
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
    const auto compute = [&](const auto n_nodes) {
      return compute_force<dim, decltype(n_nodes)::value>(
        cache, elements, range, t, positions, forces);
    };
    switch (cache.nodes_per_element)
      {
        case dim + 1:
          return compute(std::integral_constant<int, dim + 1>());
        case (1 << dim):
          return compute(std::integral_constant<int, (1 << dim)>());
        default:
          AssertThrow(false, dealii::ExcNotImplemented());
          return 0;
      }
  }


  template <int dim>
  double compute_elastic_energy(const ReferenceCache<dim> &cache,
                                const ElementSet<dim> &elements,
                                const MaterialRange<dim> &range,
                                const double t,
                                const double *positions)
  {
    double energy = 0;
    for (unsigned int i = range.begin; i < range.end; ++i)
      if (elements.nodes(i)[0] < elements.n_owned_nodes())
        for (unsigned int q = 0; q < cache.points_per_element; ++q)
          energy += cache.JxW[i * cache.points_per_element + q] *
                    range.law->energy(
                      compute_deformation_gradient(cache, elements, i, q, positions),
                      cache.fibres[i],
                      t);
    return energy * range.time_factor;
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
    if (cache.nodes_per_element == dim + 1)
      return deformation_gradient<dim, dim + 1>(gradients, elements.nodes(i), positions);
    AssertThrow(cache.nodes_per_element == (1 << dim), dealii::ExcNotImplemented());
    return deformation_gradient<dim, (1 << dim)>(gradients, elements.nodes(i), positions);
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
