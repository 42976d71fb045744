#if defined(__GNUC__) && !defined(__clang__)
// The choice of induction variables by gcc 12.2 (-O2 and above) makes wrong addresses in
// the loops over points: velocities come out as zero or as those of other points. clang,
// -O1, and -fno-ivopts all give the right ones.
//
// Without the other two, square roots and rounding are not vectorised: 33 instead of 12
// ns a point for the weights.
#  pragma GCC optimize("no-ivopts", "no-math-errno", "no-trapping-math")
#endif

#include <algorithm>
#include <cmath>
#include <cstring>

#include <mitre/coupling/kernels.h>
#include <mitre/coupling/patch_loops.h>

namespace mitre::coupling
{
  template <int dim>
  PaddedPatch<dim>::PaddedPatch(
    const std::array<std::array<unsigned int, dim>, dim> &extents,
    const unsigned int width)
    : extents(extents)
    , width(width)
  {
    for (unsigned int c = 0; c < dim; ++c)
      {
        std::size_t size = 1;
        for (const unsigned int extent : extents[c])
          size *= extent;
        values[c].assign(size + 4, 0.);
      }
  }


  template <int dim>
  PatchFrame<dim>::PatchFrame(const grid::PatchGrid<dim> &grid, const unsigned int p)
  {
    const grid::Patch<dim> &patch = grid.patch(p);
    const auto &corners           = grid.box().get_boundary_points();
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d]     = patch.lower[d];
        inverse_h[d] = 1 / patch.h[d];
        period[d]    = grid.periodic()[d]
                         ? std::round((corners.second[d] - corners.first[d]) / patch.h[d])
                         : 0;
      }
  }


  namespace
  {
    using EightDoubles = double __attribute__((vector_size(64)));

    /// Vectors are read and written by memcpy, which compilers turn into one instruction
    /// and which, unlike a cast of the pointer, may be mixed with access to the numbers.
    template <typename Vector>
    inline Vector load(const double *values)
    {
      Vector vector;
      std::memcpy(&vector, values, sizeof(Vector));
      return vector;
    }

    template <typename Vector>
    inline void store(double *values, const Vector vector)
    {
      std::memcpy(values, &vector, sizeof(Vector));
    }


    /// As many points as are worked on at a time; all arrays stay in the first cache.
    constexpr unsigned int chunk_size = 64;


    /**
     * Coordinates and kernel weights of a number of points. A component is at faces in
     * its own direction and in the middle of cells in the others, so that each direction
     * has two sets of weights: [0] for faces, [1] for cell centres.
     */
    template <int dim>
    struct Chunk
    {
      unsigned int n_points = 0;

      /// Coordinates relative to the patch, in grid spacings.
      alignas(64) double coordinates[dim][chunk_size + 8];

      /// A value a component of each point, and the weights of quadrature.
      alignas(64) double values[dim][chunk_size + 8];

      alignas(64) double weights[chunk_size][dim][2][4];
      alignas(64) double r[dim][2][chunk_size + 8];
      alignas(64) double root[dim][2][chunk_size + 8];
      alignas(64) int index[dim][2][chunk_size + 8];
    };


    /// A run that is part of a chunk.
    template <int dim>
    struct RunInChunk
    {
      const typename PartPoints<dim>::Run *run;
      const PointRule<dim> *rule;
      unsigned int first_in_run;
      unsigned int first_in_chunk;
      unsigned int n_points;
    };


    /// The number in its rule of point @p i of a run.
    template <int dim>
    inline unsigned int rule_point(const PartPoints<dim> &points,
                                   const typename PartPoints<dim>::Run &run,
                                   const unsigned int i)
    {
      return run.list ? points.selected()[run.first + i] : run.first + i;
    }


    /// values[c][i] = sum_a phi_a(point i) nodal[a][c] for a run of points.
    template <int dim, int n_nodes>
    inline void evaluate_at_points(const PartPoints<dim> &points,
                                   const RunInChunk<dim> &part,
                                   const double (&nodal)[n_nodes][dim],
                                   double (&values)[dim][chunk_size + 8])
    {
      if (part.run->list)
        for (unsigned int i = 0; i < part.n_points; ++i)
          {
            const double *phi =
              part.rule->by_point.data() +
              rule_point<dim>(points, *part.run, part.first_in_run + i) * n_nodes;
            for (int c = 0; c < dim; ++c)
              {
                double sum = 0;
                for (int a = 0; a < n_nodes; ++a)
                  sum += phi[a] * nodal[a][c];
                values[c][part.first_in_chunk + i] = sum;
              }
          }
      else
        for (unsigned int i = 0; i < part.n_points; i += 8)
          {
            const unsigned int q = part.run->first + part.first_in_run + i;
            EightDoubles sum[dim];
            for (int c = 0; c < dim; ++c)
              sum[c] = EightDoubles{};
            for (int a = 0; a < n_nodes; ++a)
              {
                const EightDoubles phi = load<EightDoubles>(part.rule->by_node.data() +
                                                            a * part.rule->n_padded + q);
                for (int c = 0; c < dim; ++c)
                  sum[c] += phi * nodal[a][c];
              }
            for (int c = 0; c < dim; ++c)
              store(values[c] + part.first_in_chunk + i, sum[c]);
          }
    }


    /// Kernel weights and first grid points from coordinates. Bound by arithmetic.
    template <int dim, typename Kernel>
    inline void compute_weights(const PatchFrame<dim> &frame,
                                const PaddedPatch<dim> &patch,
                                Chunk<dim> &chunk)
    {
      const unsigned int n_padded = (chunk.n_points + 7) / 8 * 8;
      const double n              = patch.n_cells();

      for (int d = 0; d < dim; ++d)
        {
          double *const x = chunk.coordinates[d];
          for (unsigned int i = 0; i < n_padded; ++i)
            x[i] = (x[i] - frame.lower[d]) * frame.inverse_h[d];
          if (frame.period[d] > 0)
            for (unsigned int i = 0; i < n_padded; ++i)
              x[i] -= frame.period[d] * std::floor(x[i] / frame.period[d] +
                                                   0.5 * (1 - n / frame.period[d]));

          for (int s = 0; s < 2; ++s)
            {
              const double offset = patch.width - 0.5 * s;

              // Round-off at the faces of the patch must not lead out of the array.
              const double last  = patch.width + n + (s == 0 ? 1 : 0) + patch.width - 3;
              double *const r    = chunk.r[d][s];
              double *const root = chunk.root[d][s];
              int *const index   = chunk.index[d][s];
              for (unsigned int i = 0; i < n_padded; ++i)
                {
                  const double coordinate = x[i] + offset;
                  double base             = Kernel::index_plus_one(coordinate);
                  base                    = base > 1 ? base : 1;
                  base                    = base < last ? base : last;
                  r[i]                    = coordinate - base;
                  root[i]                 = Kernel::root(r[i]);
                  index[i]                = static_cast<int>(base) - 1;
                }
            }
        }

      for (unsigned int i = 0; i < chunk.n_points; ++i)
        for (int d = 0; d < dim; ++d)
          for (int s = 0; s < 2; ++s)
            store(chunk.weights[i][d][s],
                  Kernel::weights(chunk.r[d][s][i], chunk.root[d][s][i]));
    }


    // In what follows the component is a template argument, so that which of the two sets
    // of weights a direction takes is known to the compiler.

    /// Calls @p function with the components 0, .., dim - 1 as constants.
    template <int dim, typename Function>
    inline void for_each_component(const Function &function)
    {
      function(std::integral_constant<int, 0>());
      function(std::integral_constant<int, 1>());
      if constexpr (dim == 3)
        function(std::integral_constant<int, 2>());
    }


    /// Offset in the array of component c of the first of the 4^dim values at point i.
    template <int dim, int c>
    inline std::size_t first_entry(const Chunk<dim> &chunk,
                                   const std::array<unsigned int, dim> &extents,
                                   const unsigned int i)
    {
      const std::size_t x = chunk.index[0][c == 0 ? 0 : 1][i];
      const std::size_t y = chunk.index[1][c == 1 ? 0 : 1][i];
      if constexpr (dim == 2)
        return x + extents[0] * y;
      else
        {
          const std::size_t z = chunk.index[2][c == 2 ? 0 : 1][i];
          return x + extents[0] * (y + extents[1] * z);
        }
    }


    /// Four rows of four values, each weighted, as a row.
    inline FourDoubles
    sum_of_rows(const double *plane, const unsigned int stride, const double *weights)
    {
      return (load<FourDoubles>(plane) * weights[0] +
              load<FourDoubles>(plane + stride) * weights[1]) +
             (load<FourDoubles>(plane + 2 * stride) * weights[2] +
              load<FourDoubles>(plane + 3 * stride) * weights[3]);
    }


    /// Adds a row, weighted, to each of four rows.
    inline void add_to_rows(double *plane,
                            const unsigned int stride,
                            const double *weights,
                            const FourDoubles row)
    {
      store(plane, load<FourDoubles>(plane) + row * weights[0]);
      store(plane + stride, load<FourDoubles>(plane + stride) + row * weights[1]);
      store(plane + 2 * stride, load<FourDoubles>(plane + 2 * stride) + row * weights[2]);
      store(plane + 3 * stride, load<FourDoubles>(plane + 3 * stride) + row * weights[3]);
    }


    /// values[c][i] = velocity component c at point i. Bound by loads: 4^dim values a
    /// component, in rows of four.
    template <int dim>
    inline void interpolate_chunk(const PaddedPatch<dim> &velocity, Chunk<dim> &chunk)
    {
      for_each_component<dim>([&](const auto component) {
        constexpr int c             = decltype(component)::value;
        const auto &extents         = velocity.extents[c];
        const unsigned int stride_y = extents[0], stride_z = extents[0] * extents[1];
        const double *values        = velocity.values[c].data();
        const unsigned int n_points = chunk.n_points;
        for (unsigned int i = 0; i < n_points; ++i)
          {
            const double *corner    = values + first_entry<dim, c>(chunk, extents, i);
            const double *weights_y = chunk.weights[i][1][c == 1 ? 0 : 1];

            FourDoubles sum = sum_of_rows(corner, stride_y, weights_y);
            if constexpr (dim == 3)
              {
                const double *weights_z = chunk.weights[i][2][c == 2 ? 0 : 1];
                sum *= weights_z[0];
                sum += sum_of_rows(corner + stride_z, stride_y, weights_y) * weights_z[1];
                sum +=
                  sum_of_rows(corner + 2 * stride_z, stride_y, weights_y) * weights_z[2];
                sum +=
                  sum_of_rows(corner + 3 * stride_z, stride_y, weights_y) * weights_z[3];
              }
            sum *= load<FourDoubles>(chunk.weights[i][0][c == 0 ? 0 : 1]);
            chunk.values[c][i] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
          }
      });
    }


    /// The transpose of interpolate_chunk(). Bound by loads and stores.
    template <int dim>
    inline void spread_chunk(const Chunk<dim> &chunk, PaddedPatch<dim> &force)
    {
      for_each_component<dim>([&](const auto component) {
        constexpr int c             = decltype(component)::value;
        const auto &extents         = force.extents[c];
        const unsigned int stride_y = extents[0], stride_z = extents[0] * extents[1];
        double *values              = force.values[c].data();
        const unsigned int n_points = chunk.n_points;
        for (unsigned int i = 0; i < n_points; ++i)
          {
            double *corner          = values + first_entry<dim, c>(chunk, extents, i);
            const double *weights_y = chunk.weights[i][1][c == 1 ? 0 : 1];
            const FourDoubles row =
              load<FourDoubles>(chunk.weights[i][0][c == 0 ? 0 : 1]) * chunk.values[c][i];

            if constexpr (dim == 2)
              add_to_rows(corner, stride_y, weights_y, row);
            else
              {
                const double *weights_z = chunk.weights[i][2][c == 2 ? 0 : 1];
                add_to_rows(corner, stride_y, weights_y, row * weights_z[0]);
                add_to_rows(corner + stride_z, stride_y, weights_y, row * weights_z[1]);
                add_to_rows(
                  corner + 2 * stride_z, stride_y, weights_y, row * weights_z[2]);
                add_to_rows(
                  corner + 3 * stride_z, stride_y, weights_y, row * weights_z[3]);
              }
          }
      });
    }


    /// Calls @p function with chunks that are made of the runs of patch p.
    template <int dim, int n_nodes, typename Function>
    inline void for_each_chunk(PartPoints<dim> &points,
                               const unsigned int p,
                               Chunk<dim> &chunk,
                               const Function &function)
    {
      std::array<RunInChunk<dim>, chunk_size> parts;
      unsigned int n_parts = 0;
      chunk.n_points       = 0;

      const auto flush = [&]() {
        if (n_parts > 0)
          function(parts.data(), n_parts);
        n_parts        = 0;
        chunk.n_points = 0;
      };

      const double *positions = points.positions();
      for (unsigned int r = points.run_starts()[p]; r < points.run_starts()[p + 1]; ++r)
        {
          const auto &run            = points.runs()[r];
          const PointRule<dim> &rule = points.rules().get(run.k);

          double X[n_nodes][dim];
          for (int a = 0; a < n_nodes; ++a)
            for (int c = 0; c < dim; ++c)
              X[a][c] = positions[points.elements().nodes(run.element)[a] * dim + c];

          for (unsigned int done = 0; done < run.n_points;)
            {
              // Short runs are not divided; pieces of long ones start at multiples of 8.
              const unsigned int room = chunk_size - chunk.n_points;
              const unsigned int rest = run.n_points - done;
              if (rest > room && (rest <= chunk_size || room < 8))
                {
                  flush();
                  continue;
                }
              const unsigned int n =
                std::min(rest, room / 8 * 8 > 0 && rest > room ? room / 8 * 8 : rest);
              parts[n_parts] = {&run, &rule, done, chunk.n_points, n};
              evaluate_at_points<dim, n_nodes>(
                points, parts[n_parts], X, chunk.coordinates);
              ++n_parts;
              chunk.n_points += n;
              done += n;
            }
        }
      flush();
    }


    template <int dim, int n_nodes, typename Kernel>
    void interpolate(PartPoints<dim> &points,
                     const PatchFrame<dim> &frame,
                     const unsigned int p,
                     const PaddedPatch<dim> &velocity,
                     double *moments)
    {
      static thread_local Chunk<dim> chunk;
      for_each_chunk<dim, n_nodes>(
        points, p, chunk, [&](const RunInChunk<dim> *parts, const unsigned int n_parts) {
          // Step 1: velocities at the points.
          compute_weights<dim, Kernel>(frame, velocity, chunk);
          interpolate_chunk(velocity, chunk);

          // Step 2: moments of each element.
          for (unsigned int part = 0; part < n_parts; ++part)
            {
              const auto &run = *parts[part].run;
              const double *weights =
                points.weights().data() + run.first_point + parts[part].first_in_run;

              double sums[dim][n_nodes] = {};
              for (unsigned int i = 0; i < parts[part].n_points; ++i)
                {
                  const double *phi =
                    parts[part].rule->by_point.data() +
                    rule_point<dim>(points, run, parts[part].first_in_run + i) * n_nodes;
                  for (int c = 0; c < dim; ++c)
                    {
                      const double value =
                        weights[i] * chunk.values[c][parts[part].first_in_chunk + i];
                      for (int a = 0; a < n_nodes; ++a)
                        sums[c][a] += phi[a] * value;
                    }
                }
              const unsigned int *nodes = points.elements().nodes(run.element);
              for (int a = 0; a < n_nodes; ++a)
                for (int c = 0; c < dim; ++c)
                  moments[nodes[a] * dim + c] += sums[c][a];
            }
        });
    }


    template <int dim, int n_nodes, typename Kernel>
    void spread(PartPoints<dim> &points,
                const PatchFrame<dim> &frame,
                const unsigned int p,
                const double *densities,
                PaddedPatch<dim> &force)
    {
      static thread_local Chunk<dim> chunk;
      for_each_chunk<dim, n_nodes>(
        points, p, chunk, [&](const RunInChunk<dim> *parts, const unsigned int n_parts) {
          // Step 1: forces at the points.
          for (unsigned int part = 0; part < n_parts; ++part)
            {
              const auto &run           = *parts[part].run;
              const unsigned int *nodes = points.elements().nodes(run.element);
              double F[n_nodes][dim];
              for (int a = 0; a < n_nodes; ++a)
                for (int c = 0; c < dim; ++c)
                  F[a][c] = densities[nodes[a] * dim + c];
              evaluate_at_points<dim, n_nodes>(points, parts[part], F, chunk.values);

              const double *weights =
                points.weights().data() + run.first_point + parts[part].first_in_run;
              for (int c = 0; c < dim; ++c)
                {
                  double *values = chunk.values[c] + parts[part].first_in_chunk;
                  for (unsigned int i = 0; i < parts[part].n_points; ++i)
                    values[i] *= weights[i];
                }
            }

          // Step 2: to the grid.
          compute_weights<dim, Kernel>(frame, force, chunk);
          spread_chunk(chunk, force);
        });
    }


    /// Call @p function with the number of nodes of an element as a constant.
    template <int dim, typename Function>
    void with_n_nodes(const unsigned int n_nodes, const Function &function)
    {
      switch (n_nodes)
        {
          case dim + 1:
            function(std::integral_constant<int, dim + 1>());
            break;
          case (1 << dim):
            function(std::integral_constant<int, (1 << dim)>());
            break;
          default:
            AssertThrow(false, dealii::ExcNotImplemented());
        }
    }
  } // namespace


  template <int dim>
  void interpolate_patch(PartPoints<dim> &points,
                         const std::string &kernel,
                         const PatchFrame<dim> &frame,
                         const unsigned int p,
                         const PaddedPatch<dim> &velocity,
                         double *moments)
  {
    with_kernel(kernel, [&](const auto kernel_object) {
      with_n_nodes<dim>(points.body().mesh().nodes_per_element, [&](const auto n_nodes) {
        interpolate<dim, decltype(n_nodes)::value, std::decay_t<decltype(kernel_object)>>(
          points, frame, p, velocity, moments);
      });
    });
  }


  template <int dim>
  void spread_patch(PartPoints<dim> &points,
                    const std::string &kernel,
                    const PatchFrame<dim> &frame,
                    const unsigned int p,
                    const double *densities,
                    PaddedPatch<dim> &force)
  {
    with_kernel(kernel, [&](const auto kernel_object) {
      with_n_nodes<dim>(points.body().mesh().nodes_per_element, [&](const auto n_nodes) {
        spread<dim, decltype(n_nodes)::value, std::decay_t<decltype(kernel_object)>>(
          points, frame, p, densities, force);
      });
    });
  }


#define INSTANTIATE(dim)                                                                 \
  template struct PaddedPatch<dim>;                                                      \
  template struct PatchFrame<dim>;                                                       \
  template void interpolate_patch(PartPoints<dim> &,                                     \
                                  const std::string &,                                   \
                                  const PatchFrame<dim> &,                               \
                                  const unsigned int,                                    \
                                  const PaddedPatch<dim> &,                              \
                                  double *);                                             \
  template void spread_patch(PartPoints<dim> &,                                          \
                             const std::string &,                                        \
                             const PatchFrame<dim> &,                                    \
                             const unsigned int,                                         \
                             const double *,                                             \
                             PaddedPatch<dim> &);

  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace mitre::coupling
