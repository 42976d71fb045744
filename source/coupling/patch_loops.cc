#if defined(__GNUC__) && !defined(__clang__)
// gcc's own intrinsics start from vectors without a value (gcc bug 105593).
#  pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#  pragma GCC diagnostic ignored "-Wuninitialized"
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <experimental/simd>

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
        values[c].assign(size + 8, 0.);
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
    namespace stdx     = std::experimental;
    using Lanes        = stdx::native_simd<double>;
    using FourDoubles  = double __attribute__((vector_size(32)));
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
     *
     * Loops are over n_reach grid points in each direction, 4 or 6; kernels that reach
     * fewer have weights of zero at the others.
     */
    template <int dim, int n_reach>
    struct Chunk
    {
      /// The values in a row of the grid that is read or written at once.
      using Row = std::conditional_t<n_reach == 4, FourDoubles, EightDoubles>;

      unsigned int n_points = 0;

      /// Coordinates relative to the patch, in grid spacings.
      alignas(64) double coordinates[dim][chunk_size + 8];

      /// A value a component of each point, and the weights of quadrature.
      alignas(64) double values[dim][chunk_size + 8];

      alignas(64) double weights[dim][2][n_reach][chunk_size];
      alignas(64) int index[dim][2][chunk_size];

      /// Where the n_reach^dim values at a point begin in the array of a component.
      alignas(64) int first_entry[dim][chunk_size];

      /// The weights of point @p i along the first direction.
      Row x_weights(const unsigned int s, const unsigned int i) const
      {
        const auto &w = weights[0][s];
        if constexpr (n_reach == 4)
          return Row{w[0][i], w[1][i], w[2][i], w[3][i]};
        else
          return Row{w[0][i], w[1][i], w[2][i], w[3][i], w[4][i], w[5][i], 0., 0.};
      }
    };


    /// Weights and number of the first grid point for the @p n coordinates x + offset,
    /// which round-off must not lead beyond @p last (the grid point below or nearest).
    template <int n_reach>
    using WeightFunction = void (*)(const double *x,
                                    const unsigned int n,
                                    const double offset,
                                    const double last,
                                    double (*weights)[chunk_size],
                                    int *index);

    // Bound by arithmetic.
    template <typename Kernel, int n_reach>
    void weights_of_kernel(const double *x,
                           const unsigned int n,
                           const double offset,
                           const double last,
                           double (*weights)[chunk_size],
                           int *index)
    {
      constexpr int below   = n_reach / 2 - 1;
      constexpr int missing = below - (Kernel::n_points - 1) / 2;
      static_assert(chunk_size % Lanes::size() == 0);
      for (unsigned int i = 0; i < n; i += Lanes::size())
        {
          const Lanes coordinate = Lanes(x + i, stdx::element_aligned) + offset;
          Lanes base =
            stdx::floor(Kernel::n_points % 2 == 0 ? coordinate : coordinate + 0.5);
          base         = stdx::min(stdx::max(base, Lanes(below)), Lanes(last));
          const auto w = Kernel::weights(coordinate - base);
          for (int j = 0; j < n_reach; ++j)
            (j < missing || j >= missing + Kernel::n_points ? Lanes(0.) : w[j - missing])
              .copy_to(weights[j] + i, stdx::vector_aligned);
          stdx::static_simd_cast<stdx::rebind_simd_t<int, Lanes>>(base - below)
            .copy_to(index + i, stdx::element_aligned);
        }
    }


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
        {
          FourDoubles node_values[n_nodes] = {};
          for (int a = 0; a < n_nodes; ++a)
            for (int c = 0; c < dim; ++c)
              node_values[a][c] = nodal[a][c];
          for (unsigned int i = 0; i < part.n_points; ++i)
            {
              const double *phi =
                part.rule->by_point.data() +
                rule_point<dim>(points, *part.run, part.first_in_run + i) * n_nodes;
              FourDoubles sum = node_values[0] * phi[0];
              for (int a = 1; a < n_nodes; ++a)
                sum += node_values[a] * phi[a];
              for (int c = 0; c < dim; ++c)
                values[c][part.first_in_chunk + i] = sum[c];
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


    /// The functions of a kernel along a component's direction and across.
    template <int n_reach>
    struct KernelWeights
    {
      WeightFunction<n_reach> normal, across;
    };


    /// Kernel weights and first grid points from coordinates.
    template <int dim, int n_reach>
    inline void compute_weights(const KernelWeights<n_reach> &kernel,
                                const PatchFrame<dim> &frame,
                                const PaddedPatch<dim> &patch,
                                Chunk<dim, n_reach> &chunk)
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

          // A component has faces in its own direction and cells' centres across.
          for (int s = 0; s < 2; ++s)
            (s == 0 ? kernel.normal
                    : kernel.across)(x,
                                     n_padded,
                                     patch.width - 0.5 * s,
                                     n + 2 * patch.width - s - n_reach / 2,
                                     chunk.weights[d][s],
                                     chunk.index[d][s]);
        }

      for (int c = 0; c < dim; ++c)
        {
          const int stride_y = patch.extents[c][0],
                    stride_z = stride_y * patch.extents[c][1];
          const auto index = [&](const int d) { return chunk.index[d][d == c ? 0 : 1]; };
          const int *x = index(0), *y = index(1), *z = index(dim - 1);
          for (unsigned int i = 0; i < n_padded; ++i)
            chunk.first_entry[c][i] =
              x[i] + stride_y * y[i] + (dim == 3 ? stride_z * z[i] : 0);
        }
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


    /// Distances of neighbours in the arrays of the components.
    template <int dim>
    struct Strides
    {
      explicit Strides(const PaddedPatch<dim> &patch)
      {
        for (int c = 0; c < dim; ++c)
          {
            y[c] = patch.extents[c][0];
            z[c] = y[c] * patch.extents[c][1];
          }
      }

      std::ptrdiff_t y[dim], z[dim];
    };


    inline FourDoubles fold(const FourDoubles row)
    {
      return row;
    }

    inline FourDoubles fold(const EightDoubles row)
    {
      return __builtin_shufflevector(row, row, 0, 1, 2, 3) +
             __builtin_shufflevector(row, row, 4, 5, 6, 7);
    }


    /// The sums of the entries of up to four rows.
    inline FourDoubles sums_of_rows(const FourDoubles a,
                                    const FourDoubles b,
                                    const FourDoubles c,
                                    const FourDoubles d)
    {
      const FourDoubles ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) +
                             __builtin_shufflevector(a, b, 1, 5, 3, 7);
      const FourDoubles cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) +
                             __builtin_shufflevector(c, d, 1, 5, 3, 7);
      return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
             __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    }


    /// values[c][i] = velocity component c at point i. Bound by loads: n_reach^dim values
    /// a component, in rows.
    template <int dim, int n_reach>
    inline void interpolate_chunk(const PaddedPatch<dim> &velocity,
                                  Chunk<dim, n_reach> &chunk)
    {
      using Row = typename Chunk<dim, n_reach>::Row;
      const Strides<dim> strides(velocity);
      for (unsigned int i = 0; i < chunk.n_points; ++i)
        {
          const Row x_weights[2] = {chunk.x_weights(0, i), chunk.x_weights(1, i)};
          FourDoubles rows[4]    = {};
          for_each_component<dim>([&](const auto component) {
            constexpr int c = decltype(component)::value;
            const double *const corner =
              velocity.values[c].data() + chunk.first_entry[c][i];
            const auto &y_weights   = chunk.weights[1][c == 1 ? 0 : 1];
            const auto sum_of_plane = [&](const double *const plane) {
              Row sum = load<Row>(plane) * y_weights[0][i];
              for (int y = 1; y < n_reach; ++y)
                sum += load<Row>(plane + y * strides.y[c]) * y_weights[y][i];
              return sum;
            };

            Row sum = sum_of_plane(corner);
            if constexpr (dim == 3)
              {
                const auto &z_weights = chunk.weights[2][c == 2 ? 0 : 1];
                sum *= z_weights[0][i];
                for (int z = 1; z < n_reach; ++z)
                  sum += sum_of_plane(corner + z * strides.z[c]) * z_weights[z][i];
              }
            rows[c] = fold(sum * x_weights[c == 0 ? 0 : 1]);
          });
          const FourDoubles sums = sums_of_rows(rows[0], rows[1], rows[2], rows[3]);
          for (int c = 0; c < dim; ++c)
            chunk.values[c][i] = sums[c];
        }
    }


    /// The transpose of interpolate_chunk(). Bound by loads and stores. Neighbours in the
    /// chunk are neighbours in space: points are taken from its halves in turn, as loads
    /// wait for earlier stores that overlap them in part.
    template <int dim, int n_reach>
    inline void spread_chunk(const Chunk<dim, n_reach> &chunk, PaddedPatch<dim> &force)
    {
      using Row = typename Chunk<dim, n_reach>::Row;
      const Strides<dim> strides(force);
      const unsigned int half = (chunk.n_points + 1) / 2;
      for (unsigned int k = 0; k < chunk.n_points; ++k)
        {
          const unsigned int i   = k / 2 + (k % 2) * half;
          const Row x_weights[2] = {chunk.x_weights(0, i), chunk.x_weights(1, i)};
          for_each_component<dim>([&](const auto component) {
            constexpr int c         = decltype(component)::value;
            double *const corner    = force.values[c].data() + chunk.first_entry[c][i];
            const Row row           = x_weights[c == 0 ? 0 : 1] * chunk.values[c][i];
            const auto &y_weights   = chunk.weights[1][c == 1 ? 0 : 1];
            const auto add_to_plane = [&](double *const plane, const Row value) {
              for (int y = 0; y < n_reach; ++y)
                store<Row>(plane + y * strides.y[c],
                           load<Row>(plane + y * strides.y[c]) + value * y_weights[y][i]);
            };

            if constexpr (dim == 2)
              add_to_plane(corner, row);
            else
              {
                const auto &z_weights = chunk.weights[2][c == 2 ? 0 : 1];
                for (int z = 0; z < n_reach; ++z)
                  add_to_plane(corner + z * strides.z[c], row * z_weights[z][i]);
              }
          });
        }
    }


    /// Calls @p function with chunks that are made of the runs of patch p.
    template <int dim, int n_nodes, int n_reach, typename Function>
    inline void for_each_chunk(PartPoints<dim> &points,
                               const unsigned int p,
                               Chunk<dim, n_reach> &chunk,
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
          const PointRule<dim> &rule = points.rule(run);

          double X[n_nodes][dim];
          for (int a = 0; a < n_nodes; ++a)
            for (int c = 0; c < dim; ++c)
              X[a][c] = positions[points.nodes(run)[a] * dim + c];

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


    /// Vectors with a value for each node of an element, and room for some more.
    template <int n_nodes>
    struct NodeValues
    {
      using Vector = std::conditional_t<n_nodes <= 4, FourDoubles, EightDoubles>;
      static constexpr int width     = sizeof(Vector) / sizeof(double);
      static constexpr int n_vectors = (n_nodes + width - 1) / width;
    };


    template <int dim, int n_nodes, int n_reach>
    void interpolate(PartPoints<dim> &points,
                     const KernelWeights<n_reach> &kernel,
                     const PatchFrame<dim> &frame,
                     const unsigned int p,
                     const PaddedPatch<dim> &velocity,
                     double *moments)
    {
      static thread_local Chunk<dim, n_reach> chunk;
      for_each_chunk<dim, n_nodes, n_reach>(
        points, p, chunk, [&](const RunInChunk<dim> *parts, const unsigned int n_parts) {
          // Step 1: velocities at the points.
          compute_weights(kernel, frame, velocity, chunk);
          interpolate_chunk(velocity, chunk);

          // Step 2: moments of each element.
          for (unsigned int part = 0; part < n_parts; ++part)
            {
              const auto &run = *parts[part].run;
              const double *weights =
                points.weights().data() + run.first_point + parts[part].first_in_run;

              using Values                                         = NodeValues<n_nodes>;
              typename Values::Vector sums[Values::n_vectors][dim] = {};
              for (unsigned int i = 0; i < parts[part].n_points; ++i)
                {
                  const double *const phi =
                    parts[part].rule->by_point.data() +
                    rule_point<dim>(points, run, parts[part].first_in_run + i) * n_nodes;
                  for (int v = 0; v < Values::n_vectors; ++v)
                    {
                      const auto some =
                        load<typename Values::Vector>(phi + v * Values::width);
                      for (int c = 0; c < dim; ++c)
                        sums[v][c] +=
                          some *
                          (weights[i] * chunk.values[c][parts[part].first_in_chunk + i]);
                    }
                }
              const unsigned int *nodes = points.nodes(run);
              for (int a = 0; a < n_nodes; ++a)
                for (int c = 0; c < dim; ++c)
                  moments[nodes[a] * dim + c] +=
                    sums[a / Values::width][c][a % Values::width];
            }
        });
    }


    template <int dim, int n_nodes, int n_reach>
    void spread(PartPoints<dim> &points,
                const KernelWeights<n_reach> &kernel,
                const PatchFrame<dim> &frame,
                const unsigned int p,
                const double *densities,
                PaddedPatch<dim> &force)
    {
      static thread_local Chunk<dim, n_reach> chunk;
      for_each_chunk<dim, n_nodes, n_reach>(
        points, p, chunk, [&](const RunInChunk<dim> *parts, const unsigned int n_parts) {
          // Step 1: forces at the points.
          for (unsigned int part = 0; part < n_parts; ++part)
            {
              const auto &run           = *parts[part].run;
              const unsigned int *nodes = points.nodes(run);
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
          compute_weights(kernel, frame, force, chunk);
          spread_chunk(chunk, force);
        });
    }


    /// Call @p function with the number of nodes on which a point depends as a constant.
    template <int dim, typename Function>
    void with_n_nodes(const unsigned int n_nodes, const Function &function)
    {
      if (n_nodes == 1)
        function(std::integral_constant<int, 1>());
      else
        structure::with_n_nodes<dim>(n_nodes, function);
    }


    /// Call @p function with the functions of a kernel.
    template <typename Function>
    void with_weights(const std::string &name, const Function &function)
    {
      with_kernel(name, [&](const auto kernel) {
        using Kernel          = std::decay_t<decltype(kernel)>;
        constexpr int n_reach = Kernel::Normal::n_points <= 4 ? 4 : 6;
        function(
          KernelWeights<n_reach>{&weights_of_kernel<typename Kernel::Normal, n_reach>,
                                 &weights_of_kernel<typename Kernel::Across, n_reach>});
      });
    }
  } // namespace


  template <int dim>
  void interpolate_patch(PartPoints<dim> &points,
                         const std::string &kernel_name,
                         const PatchFrame<dim> &frame,
                         const unsigned int p,
                         const PaddedPatch<dim> &velocity,
                         double *moments)
  {
    with_weights(kernel_name, [&](const auto &kernel) {
      with_n_nodes<dim>(points.nodes_per_run(), [&](const auto n_nodes) {
        interpolate<dim, decltype(n_nodes)::value>(
          points, kernel, frame, p, velocity, moments);
      });
    });
  }


  template <int dim>
  void spread_patch(PartPoints<dim> &points,
                    const std::string &kernel_name,
                    const PatchFrame<dim> &frame,
                    const unsigned int p,
                    const double *densities,
                    PaddedPatch<dim> &force)
  {
    with_weights(kernel_name, [&](const auto &kernel) {
      with_n_nodes<dim>(points.nodes_per_run(), [&](const auto n_nodes) {
        spread<dim, decltype(n_nodes)::value>(points, kernel, frame, p, densities, force);
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
