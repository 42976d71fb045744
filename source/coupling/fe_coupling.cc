#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

#include <mitre/base/exceptions.h>
#include <mitre/coupling/fe_coupling.h>
#include <mitre/coupling/kernels.h>

namespace mitre::coupling
{
  void CouplingParameters::declare_parameters(dealii::ParameterHandler &prm,
                                              const bool of_fibres)
  {
    std::string names;
    for (const std::string &name : kernel_names())
      names += (names.empty() ? "" : "|") + name;

    if (!of_fibres)
      prm.declare_entry(
        "Point density",
        "2",
        dealii::Patterns::Double(0.1, 20),
        "Quadrature points for each grid spacing along the longest edge of "
        "an element as it is now, deformed; in tetrahedra and triangles the "
        "points have no larger holes between them than those of a cube with "
        "such edges. Too few let fluid through. Without effect on nodal "
        "coupling.");
    prm.declare_entry("Kernel",
                      "IB_4",
                      dealii::Patterns::Selection(names),
                      "Regularised delta function: IB_4 (Peskin's four-point kernel), "
                      "IB_3 (Roma, Peskin and Berger), IB_5 and IB_6 (Bao, Kaye and "
                      "Peskin), BSPLINE_n (B-spline of n points), or composite B-splines "
                      "CBSmn (of m points along a velocity component, n across), which "
                      "keep the interpolated velocity free of divergence. IB_5, IB_6, "
                      "BSPLINE_5, BSPLINE_6, CBS54 and CBS65 reach a cell farther than "
                      "the others and cost twice as much or more.");
    if (!of_fibres)
      prm.declare_entry(
        "Coupling",
        "elemental",
        dealii::Patterns::Selection("elemental|nodal"),
        "elemental: velocities are interpolated to, and forces spread from, "
        "quadrature points in the elements; nodal: to and from the nodes "
        "alone, with a lumped mass matrix, which is cheaper but lets fluid "
        "through where elements are larger than the grid's cells.");
    if (!of_fibres)
      prm.declare_entry(
        "Split forces",
        "false",
        dealii::Patterns::Bool(),
        "Whether the transmission force -P N of the surface is spread from points on "
        "the surface, as the pressure jumps there, instead of together with the force "
        "of the volume over the width of an element: more accurate where elements are "
        "larger than the grid's cells, and slower.");
    prm.declare_entry("Grid level",
                      "finest",
                      dealii::Patterns::Anything(),
                      "Refinement level of the grid about the part: a number, or "
                      "'finest'.");
  }


  void CouplingParameters::parse_parameters(dealii::ParameterHandler &prm,
                                            const bool of_fibres)
  {
    kernel = prm.get("Kernel");
    if (of_fibres)
      points = PointChoice::nodes;
    else
      {
        point_density = prm.get_double("Point density");
        points =
          prm.get("Coupling") == "nodal" ? PointChoice::nodes : PointChoice::quadrature;
        split_forces = prm.get_bool("Split forces");
      }
    const std::string level_text = prm.get("Grid level");
    level                        = -1;
    if (level_text != "finest")
      {
        AssertThrow(!level_text.empty() && level_text.size() < 4 &&
                      level_text.find_first_not_of("0123456789") == std::string::npos,
                    base::UserError("Grid level: expected 'finest' or a level 0, 1, 2, "
                                    "..., found '" +
                                    level_text + "'."));
        level = std::stoi(level_text);
      }
  }


  template <int dim>
  FECoupling<dim>::FECoupling(const grid::PatchGrid<dim> &grid)
    : grid(grid)
  {
  }


  template <int dim>
  void FECoupling<dim>::add_part(const structure::Body<dim> &body,
                                 const CouplingParameters &parameters)
  {
    Part part;
    part.parameters = parameters;
    part.points     = std::make_unique<PartPoints<dim>>(
      grid, body, parameters.point_density, parameters.points);
    part.points->reinit();
    parts.push_back(std::move(part));
  }


  template <int dim>
  unsigned int FECoupling<dim>::halo_width() const
  {
    unsigned int width = kernel_halo_width("IB_4");
    for (const Part &part : parts)
      width = std::max(width, kernel_halo_width(part.parameters.kernel));
    return width;
  }


  template <int dim>
  void FECoupling<dim>::reinit(grid::VelocityHalo<dim> &new_halo)
  {
    halo = &new_halo;
    AssertThrow(halo->width() >= halo_width(), dealii::ExcInternalError());
    AssertThrow(halo->shape() == grid::HaloShape::full, dealii::ExcInternalError());

    std::array<std::array<unsigned int, dim>, dim> extents;
    for (unsigned int c = 0; c < dim; ++c)
      extents[c] = halo->extents(c);
    padded = std::make_unique<PaddedPatch<dim>>(extents, halo->width());

    for (Part &part : parts)
      part.points->reinit();
  }


  template <int dim>
  std::vector<unsigned int>
  FECoupling<dim>::owners_of(const std::vector<dealii::Point<dim>> &points) const
  {
    const unsigned int rank =
      dealii::Utilities::MPI::this_mpi_process(grid.communicator());
    std::vector<unsigned int> owners(points.size(),
                                     dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        dealii::Point<dim> point = points[i];
        for (unsigned int d = 0; d < dim; ++d)
          point[d] = grid.pull_into_box(point[d], d);
        if (grid.locate(point) != dealii::numbers::invalid_unsigned_int)
          owners[i] = rank;
      }
    dealii::Utilities::MPI::min(dealii::ArrayView<const unsigned int>(owners),
                                grid.communicator(),
                                dealii::ArrayView<unsigned int>(owners));
    return owners;
  }


  template <int dim>
  void FECoupling<dim>::update_points(const std::vector<const VectorType *> &X)
  {
    AssertDimension(X.size(), parts.size());
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].points->update(*X[i]);
        if (parts[i].ghosted.get_partitioner() !=
            parts[i].points->elements().partitioner())
          parts[i].ghosted.reinit(parts[i].points->elements().partitioner());
      }
  }


  template <int dim>
  void FECoupling<dim>::compute_velocity_moments(const VectorType &u,
                                                 const std::vector<VectorType *> &moments)
  {
    AssertDimension(moments.size(), parts.size());
    Assert(halo != nullptr, dealii::ExcNotInitialized());

    const VectorType &imported = halo->import(u);
    for (Part &part : parts)
      {
        part.ghosted.zero_out_ghost_values();
        part.ghosted = 0;
      }

    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      if (n_points(p) > 0)
        {
          for (unsigned int c = 0; c < dim; ++c)
            halo->gather(imported, p, c, padded->values[c].data(), true);
          const PatchFrame<dim> frame(grid, p);
          for (Part &part : parts)
            interpolate_patch(*part.points,
                              part.parameters.kernel,
                              frame,
                              p,
                              *padded,
                              part.ghosted.begin());
        }

    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].ghosted.compress(dealii::VectorOperation::add);
        std::copy(parts[i].ghosted.begin(), parts[i].ghosted.end(), moments[i]->begin());
      }
  }


  template <int dim>
  void FECoupling<dim>::interpolate(const VectorType &u,
                                    const std::vector<VectorType *> &U)
  {
    std::vector<VectorType> moments(parts.size());
    std::vector<VectorType *> pointers;
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        body(i).initialize_vector(moments[i]);
        pointers.push_back(&moments[i]);
      }
    compute_velocity_moments(u, pointers);
    for (unsigned int i = 0; i < parts.size(); ++i)
      if (parts[i].parameters.points == PointChoice::nodes)
        {
          const std::vector<double> &weights = body(i).node_weights();
          for (unsigned int node = 0; node < weights.size(); ++node)
            for (unsigned int c = 0; c < dim; ++c)
              U[i]->local_element(node * dim + c) =
                moments[i].local_element(node * dim + c) / weights[node];
        }
      else
        body(i).project(*U[i], moments[i]);
  }


  namespace
  {
    /// Coordinates of a point relative to a patch, in grid spacings.
    template <int dim>
    std::array<double, dim> coordinates_in_patch(const grid::PatchGrid<dim> &grid,
                                                 const unsigned int p,
                                                 const dealii::Point<dim> &x)
    {
      std::array<double, dim> coordinates;
      for (unsigned int d = 0; d < dim; ++d)
        coordinates[d] =
          (grid.pull_into_box(x[d], d) - grid.patch(p).lower[d]) / grid.patch(p).h[d];
      return coordinates;
    }


    /// Calls function(entry, weight) with the entries of component @p c of a patch about
    /// a point; one point at a time, for where there are few.
    template <typename Kernel, int dim, typename Function>
    void for_each_entry(const std::array<double, dim> &coordinates,
                        const PaddedPatch<dim> &patch,
                        const unsigned int c,
                        const Function &function)
    {
      constexpr int most = std::max(Kernel::Normal::n_points, Kernel::Across::n_points);
      std::array<std::array<double, most>, dim> weights;
      std::array<int, dim> first, n;
      const auto set = [&](const auto &kernel, const unsigned int d) {
        using Function1D = std::decay_t<decltype(kernel)>;
        const double x =
          coordinates[d] + static_cast<double>(patch.width) - (d == c ? 0. : 0.5);
        const double base = std::floor(Function1D::n_points % 2 == 0 ? x : x + 0.5);
        const auto w      = Function1D::weights(x - base);
        n[d]              = Function1D::n_points;
        first[d]          = static_cast<int>(base) - (n[d] - 1) / 2;
        std::copy(w.begin(), w.end(), weights[d].begin());
      };
      for (unsigned int d = 0; d < dim; ++d)
        if (d == c)
          set(typename Kernel::Normal(), d);
        else
          set(typename Kernel::Across(), d);

      const auto &extents = patch.extents[c];
      for (int k = 0; k < (dim == 3 ? n[dim - 1] : 1); ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i)
            {
              std::size_t entry = first[0] + i + extents[0] * (first[1] + j);
              double weight     = weights[0][i] * weights[1][j];
              if constexpr (dim == 3)
                {
                  entry += extents[0] * extents[1] * (first[2] + k);
                  weight *= weights[2][k];
                }
              function(entry, weight);
            }
    }
  } // namespace


  template <int dim>
  std::vector<std::pair<std::size_t, dealii::Tensor<1, dim>>>
  FECoupling<dim>::velocities_at(const VectorType &u,
                                 const std::vector<dealii::Point<dim>> &points) const
  {
    Assert(halo != nullptr, dealii::ExcNotInitialized());
    using Kernel = kernels::CompositeBSpline<3>;

    // Step 1: points by patch.
    std::vector<std::pair<unsigned int, std::size_t>> order;
    for (std::size_t i = 0; i < points.size(); ++i)
      {
        const unsigned int p = grid.locate(points[i]);
        if (p != dealii::numbers::invalid_unsigned_int)
          order.emplace_back(p, i);
      }
    std::sort(order.begin(), order.end());

    // Step 2: their velocities.
    const VectorType &imported = halo->import(u);
    std::vector<std::pair<std::size_t, dealii::Tensor<1, dim>>> result;
    unsigned int gathered = dealii::numbers::invalid_unsigned_int;
    for (const auto &[p, i] : order)
      {
        if (p != gathered)
          for (unsigned int c = 0; c < dim; ++c)
            halo->gather(imported, p, c, padded->values[c].data(), true);
        gathered = p;

        dealii::Tensor<1, dim> velocity;
        const auto coordinates = coordinates_in_patch(grid, p, points[i]);
        for (unsigned int c = 0; c < dim; ++c)
          for_each_entry<Kernel, dim>(
            coordinates, *padded, c, [&](const std::size_t entry, const double weight) {
              velocity[c] += weight * padded->values[c][entry];
            });
        result.emplace_back(i, velocity);
      }
    return result;
  }


  template <int dim>
  void FECoupling<dim>::spread(const std::vector<const VectorType *> &F,
                               VectorType &f,
                               VectorType *total,
                               const std::vector<PointForces<dim>> &extra)
  {
    AssertDimension(F.size(), parts.size());
    Assert(halo != nullptr, dealii::ExcNotInitialized());

    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].ghosted.zero_out_ghost_values();
        std::copy(F[i]->begin(), F[i]->end(), parts[i].ghosted.begin());
        parts[i].ghosted.update_ghost_values();
      }

    // The points of their own by patch: which of the sets, and which in it.
    std::vector<std::vector<std::pair<unsigned int, std::size_t>>> own_points;
    if (!extra.empty())
      own_points.resize(grid.n_owned_patches());
    for (unsigned int set = 0; set < extra.size(); ++set)
      for (std::size_t i = 0; i < extra[set].points.size(); ++i)
        {
          const unsigned int p = grid.locate(extra[set].points[i]);
          if (p != dealii::numbers::invalid_unsigned_int)
            own_points[p].emplace_back(set, i);
        }

    halo->begin_scatter();
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      if (n_points(p) > 0 || (!own_points.empty() && !own_points[p].empty()))
        {
          for (std::vector<double> &values : padded->values)
            std::fill(values.begin(), values.end(), 0.);
          const PatchFrame<dim> frame(grid, p);
          for (Part &part : parts)
            spread_patch(*part.points,
                         part.parameters.kernel,
                         frame,
                         p,
                         part.ghosted.begin(),
                         *padded);
          if (!own_points.empty())
            for (const auto &[set, i] : own_points[p])
              spread_one(extra[set], i, p);
          for (unsigned int c = 0; c < dim; ++c)
            halo->scatter_add(p, c, padded->values[c].data());
        }
    halo->end_scatter(f, total);
  }


  template <int dim>
  void FECoupling<dim>::spread_one(const PointForces<dim> &set,
                                   const std::size_t i,
                                   const unsigned int p)
  {
    const auto coordinates = coordinates_in_patch(grid, p, set.points[i]);
    with_kernel(parts[set.part].parameters.kernel, [&](const auto kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      for (unsigned int c = 0; c < dim; ++c)
        for_each_entry<Kernel, dim>(
          coordinates, *padded, c, [&](const std::size_t entry, const double weight) {
            padded->values[c][entry] += weight * set.forces[i][c];
          });
    });
  }


  template <int dim>
  std::size_t FECoupling<dim>::n_points(const unsigned int p) const
  {
    std::size_t n = 0;
    for (const Part &part : parts)
      for (unsigned int r = part.points->run_starts()[p];
           r < part.points->run_starts()[p + 1];
           ++r)
        n += part.points->runs()[r].n_points;
    return n;
  }


  template <int dim>
  std::size_t FECoupling<dim>::n_points() const
  {
    std::size_t n = 0;
    for (const Part &part : parts)
      n += part.points->n_points();
    return n;
  }


  template class FECoupling<2>;
  template class FECoupling<3>;
} // namespace mitre::coupling
