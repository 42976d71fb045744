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
    const double width         = halo->width();
    std::vector<std::pair<std::size_t, dealii::Tensor<1, dim>>> result;
    unsigned int gathered = dealii::numbers::invalid_unsigned_int;
    for (const auto &[p, i] : order)
      {
        if (p != gathered)
          for (unsigned int c = 0; c < dim; ++c)
            halo->gather(imported, p, c, padded->values[c].data(), true);
        gathered = p;

        dealii::Tensor<1, dim> velocity;
        for (unsigned int c = 0; c < dim; ++c)
          {
            std::array<std::array<double, 3>, dim> weights;
            std::array<unsigned int, dim> first;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const double x =
                  (grid.pull_into_box(points[i][d], d) - grid.patch(p).lower[d]) /
                    grid.patch(p).h[d] +
                  width - (d == c ? 0. : 0.5);
                weights[d] = {{0., 0., 0.}};
                if (d == c)
                  {
                    const double base = std::floor(x + 0.5);
                    weights[d]        = Kernel::Normal::weights(x - base);
                    first[d]          = static_cast<unsigned int>(base) - 1;
                  }
                else
                  {
                    const double base = std::floor(x);
                    const auto two    = Kernel::Across::weights(x - base);
                    weights[d]        = {{two[0], two[1], 0.}};
                    first[d]          = static_cast<unsigned int>(base);
                  }
              }
            double sum = 0;
            for (unsigned int k = 0; k < (dim == 3 ? 3 : 1); ++k)
              for (unsigned int j = 0; j < 3; ++j)
                for (unsigned int m = 0; m < 3; ++m)
                  {
                    const auto &extents     = padded->extents[c];
                    const std::size_t entry = first[0] + m + extents[0] * (first[1] + j);
                    if constexpr (dim == 3)
                      sum +=
                        weights[0][m] * weights[1][j] * weights[2][k] *
                        padded
                          ->values[c][entry + extents[0] * extents[1] * (first[2] + k)];
                    else
                      sum += weights[0][m] * weights[1][j] * padded->values[c][entry];
                  }
            velocity[c] = sum;
          }
        result.emplace_back(i, velocity);
      }
    return result;
  }


  template <int dim>
  void FECoupling<dim>::spread(const std::vector<const VectorType *> &F,
                               VectorType &f,
                               VectorType *total)
  {
    AssertDimension(F.size(), parts.size());
    Assert(halo != nullptr, dealii::ExcNotInitialized());

    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        parts[i].ghosted.zero_out_ghost_values();
        std::copy(F[i]->begin(), F[i]->end(), parts[i].ghosted.begin());
        parts[i].ghosted.update_ghost_values();
      }

    halo->begin_scatter();
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      if (n_points(p) > 0)
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
          for (unsigned int c = 0; c < dim; ++c)
            halo->scatter_add(p, c, padded->values[c].data());
        }
    halo->end_scatter(f, total);
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
