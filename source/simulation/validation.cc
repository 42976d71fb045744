#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>
#include <unistd.h>

#include <mitre/base/exceptions.h>
#include <mitre/base/time_table.h>
#include <mitre/base/units.h>
#include <mitre/coupling/kernels.h>
#include <mitre/simulation/validation.h>

namespace mitre::simulation
{
  using namespace dealii;

  namespace
  {
    /// Pressures and speeds beyond these are hardly those of blood.
    constexpr double largest_pressure = 1000. * base::mmHg;
    constexpr double largest_speed    = 1e4; // cm/s

    /// Below this, forces and time step suffer; generated tetrahedra have 0.2 and more.
    constexpr double poor_quality = 0.05;

    const std::array<const char *, 6> side_names = {
      {"x min", "x max", "y min", "y max", "z min", "z max"}};


    template <typename T>
    std::string text(const T &value)
    {
      std::ostringstream stream;
      stream << value;
      return stream.str();
    }


    /// "3 of 120 elements (2.5 %)"
    std::string share(const std::size_t n, const std::size_t all, const std::string &what)
    {
      std::ostringstream stream;
      stream.precision(3);
      stream << n << " of " << all << " " << what << " (" << 100. * n / all << " %)";
      return stream.str();
    }


    template <int dim>
    int level_of(const PartView<dim> &part, const grid::PatchGrid<dim> &grid)
    {
      return part.coupling.level < 0 ? static_cast<int>(grid.maximum_level())
                                     : part.coupling.level;
    }


    /// The corners are the first of an element's nodes.
    template <int dim>
    unsigned int n_corners(const structure::Mesh<dim> &mesh)
    {
      return mesh.shape == structure::ElementShape::segment   ? 2
             : mesh.shape == structure::ElementShape::simplex ? dim + 1
                                                              : 1u << dim;
    }


    /// Quadratic elements are taken as if they were straight, here and below.
    template <int dim>
    double longest_edge(const structure::Mesh<dim> &mesh, const unsigned int e)
    {
      const unsigned int n        = n_corners(mesh);
      const unsigned int *const v = mesh.elements.data() + e * mesh.nodes_per_element;
      double longest              = 0.;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < a; ++b)
          {
            // of a hypercube the edges, no diagonals: one bit differs
            const unsigned int bits = a ^ b;
            if (mesh.shape == structure::ElementShape::simplex ||
                (bits & (bits - 1)) == 0)
              longest = std::max(longest, mesh.nodes[v[a]].distance(mesh.nodes[v[b]]));
          }
      return longest;
    }
  } // namespace


  template <int dim>
  double element_quality(const structure::Mesh<dim> &mesh, const unsigned int e)
  {
    const unsigned int n        = n_corners(mesh);
    const unsigned int *const v = mesh.elements.data() + e * mesh.nodes_per_element;
    if (mesh.shape == structure::ElementShape::simplex)
      {
        Tensor<2, dim> edges;
        for (unsigned int d = 0; d < dim; ++d)
          edges[d] = mesh.nodes[v[d + 1]] - mesh.nodes[v[0]];
        double squares = 0.;
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < a; ++b)
            squares += mesh.nodes[v[a]].distance_square(mesh.nodes[v[b]]);
        const double det = std::max(0., determinant(edges));
        return dim == 2 ? 4. * std::sqrt(3.) * (det / 2.) / squares
                        : 12. * std::pow(3. * det / 6., 2. / 3.) / squares;
      }
    double least = std::numeric_limits<double>::max();
    for (unsigned int a = 0; a < n; ++a)
      {
        Tensor<2, dim> edges;
        double lengths = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double sign = (a & (1u << d)) != 0 ? -1. : 1.;
            edges[d]          = sign * (mesh.nodes[v[a ^ (1u << d)]] - mesh.nodes[v[a]]);
            lengths *= edges[d].norm();
          }
        least = std::min(least, lengths > 0. ? determinant(edges) / lengths : 0.);
      }
    return std::max(0., least);
  }


  template <int dim>
  void check_part(const PartView<dim> &part,
                  const grid::PatchGrid<dim> &grid,
                  Findings &findings,
                  std::ostream &out)
  {
    const structure::Mesh<dim> &mesh = part.body.mesh();
    const std::string prefix         = "Part " + part.body.name() + ": ";
    const int level                  = level_of(part, grid);
    double h                         = grid.cell_width(level, 0);
    for (unsigned int d = 1; d < dim; ++d)
      h = std::min(h, grid.cell_width(level, d));

    // Step 1: sizes.
    Point<dim> lower = mesh.nodes.front(), upper = mesh.nodes.front();
    for (const Point<dim> &node : mesh.nodes)
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = std::min(lower[d], node[d]);
          upper[d] = std::max(upper[d], node[d]);
        }
    const bool of_fibres = mesh.shape == structure::ElementShape::segment;
    std::vector<double> edges;
    std::vector<unsigned int> numbers;
    std::size_t n_fine = 0, n_poor = 0;
    unsigned int worst       = 0;
    double worst_quality     = std::numeric_limits<double>::max();
    double shortest_in_cells = std::numeric_limits<double>::max();
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        const double edge = longest_edge(mesh, e) / h;
        // nodes of fibres by themselves
        if (of_fibres && edge == 0.)
          continue;
        edges.push_back(edge);
        numbers.push_back(e);
        shortest_in_cells = std::min(shortest_in_cells, edge);
        // Fibres hold their nodes apart at any distance.
        n_fine += !of_fibres && edge < 0.5 ? 1 : 0;
        const double quality = of_fibres ? 1. : element_quality(mesh, e);
        n_poor += quality < poor_quality ? 1 : 0;
        if (quality < worst_quality)
          {
            worst_quality = quality;
            worst         = e;
          }
      }
    out << "    from " << structure::to_string(lower) << " to "
        << structure::to_string(upper) << " cm, on level " << level << " (cells of " << h
        << " cm), kernel " << part.coupling.kernel;
    if (!of_fibres)
      out << ", " << part.coupling.point_density << " points a cell";
    out << '\n';
    double longest_in_cells = 0.;
    unsigned int longest    = 0;
    if (!edges.empty())
      {
        const auto largest         = std::max_element(edges.begin(), edges.end());
        longest_in_cells           = *largest;
        longest                    = numbers[largest - edges.begin()];
        std::vector<double> sorted = edges;
        const auto middle          = sorted.begin() + sorted.size() / 2;
        std::nth_element(sorted.begin(), middle, sorted.end());
        out << "    " << (of_fibres ? "segments" : "longest edges of elements") << ": "
            << shortest_in_cells << " to " << longest_in_cells << " cells, median "
            << *middle;
        if (!of_fibres)
          out << "; quality at least " << worst_quality << " (1: regular)";
        out << '\n';
      }
    if (of_fibres && longest_in_cells > 1.)
      findings.warnings.push_back(
        prefix + "the " + mesh.describe_element(longest) + " is " +
        text(longest_in_cells) +
        " grid cells long; fluid may pass between its nodes. Use more nodes or a coarser "
        "grid, if the part shall hold fluid back.");

    if (n_poor > 0)
      findings.warnings.push_back(
        prefix + share(n_poor, mesh.n_elements(), "elements") + " have a quality below " +
        text(poor_quality) + "; the worst, " + text(worst_quality) + ", is the " +
        mesh.describe_element(worst) + " at " +
        structure::to_string(mesh.centroid(worst)) +
        ". Flat elements are soon turned inside out and need short steps.");
    if (n_fine > mesh.n_elements() / 10)
      findings.warnings.push_back(
        prefix + share(n_fine, mesh.n_elements(), "elements") +
        " are smaller than half a cell of the grid (" + text(0.5 * h) +
        " cm). Such nodes can drift apart in ways that the grid does not feel: use "
        "elements of half a cell to four cells, or a finer grid.");
    // The run stops at 64 points an edge: warn if a twofold stretch would do that.
    if (part.coupling.points == coupling::PointChoice::quadrature &&
        longest_in_cells * part.coupling.point_density > 32.)
      findings.warnings.push_back(
        prefix + "the longest edge of the " + mesh.describe_element(longest) + " is " +
        text(longest_in_cells) +
        " grid cells, so that it needs very many quadrature points; the run would stop "
        "if it was stretched. Use a finer mesh or another unit of length (cm).");

    // Step 2: distance to the walls.
    const auto &[box_lower, box_upper] = grid.box().get_boundary_points();
    const double reach                 = coupling::kernel_reach(part.coupling.kernel);
    std::string distances;
    double largest_share = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        largest_share =
          std::max(largest_share, (upper[d] - lower[d]) / (box_upper[d] - box_lower[d]));
        if (grid.periodic()[d])
          continue;
        const std::array<double, 2> gaps = {
          {lower[d] - box_lower[d], box_upper[d] - upper[d]}};
        for (unsigned int s = 0; s < 2; ++s)
          {
            const double cells = gaps[s] / grid.cell_width(level, d);
            const bool touches = cells < 1e-6;
            distances += (distances.empty() ? "" : ", ") +
                         std::string(side_names[2 * d + s]) + " " +
                         (touches ? std::string("touched") : text(gaps[s]));
            if (!touches && cells < reach)
              findings.warnings.push_back(
                prefix + "it is only " + text(gaps[s]) + " cm, " + text(cells) +
                " cells, away from the face " + side_names[2 * d + s] +
                " of the box, and the kernel " + part.coupling.kernel + " reaches " +
                text(reach) +
                " cells: the boundary holds part of the force. Leave more room, or let "
                "the part touch the face if that is meant.");
          }
      }
    if (!distances.empty())
      out << "    distance to the faces of the box [cm]: " << distances << '\n';
    if (largest_share < 0.005)
      findings.warnings.push_back(prefix + "it is " + text(1. / largest_share) +
                                  " times smaller than the box. Are " + mesh.source +
                                  " and the box both in cm? (1 m = 100 cm)");
  }


  template <int dim>
  void check_levels(const PartView<dim> &part,
                    const grid::PatchGrid<dim> &grid,
                    Findings &findings)
  {
    const double reach         = coupling::kernel_reach(part.coupling.kernel);
    const auto &elements       = part.body.elements();
    const auto &[lower, upper] = grid.box().get_boundary_points();
    std::uint64_t n_mixed      = 0;
    std::string first;
    for (unsigned int i = 0; i < elements.n_owned_nodes(); ++i)
      {
        Point<dim> node;
        for (unsigned int d = 0; d < dim; ++d)
          node[d] = grid.pull_into_box(part.X.local_element(i * dim + d), d);
        const int level = grid.level_at(node);
        if (level < 0)
          continue;
        int other = level;
        for (unsigned int corner = 0; corner < Utilities::pow(3u, dim); ++corner)
          {
            Point<dim> x = node;
            for (unsigned int d = 0, rest = corner; d < dim; ++d, rest /= 3)
              {
                x[d] += (static_cast<int>(rest % 3) - 1) * 0.999 * reach *
                        grid.cell_width(level, d);
                if (!grid.periodic()[d])
                  x[d] = std::clamp(x[d], lower[d], upper[d]);
              }
            const int found = grid.level_at(x);
            if (found >= 0 && found != level)
              other = found;
          }
        if (other == level)
          continue;
        ++n_mixed;
        if (first.empty())
          first = structure::to_string(node) + " cm, where levels " +
                  std::to_string(std::min(level, other)) + " and " +
                  std::to_string(std::max(level, other)) + " meet";
      }

    const MPI_Comm communicator = grid.communicator();
    n_mixed                     = Utilities::MPI::sum(n_mixed, communicator);
    if (n_mixed == 0)
      return;
    for (const std::string &place : Utilities::MPI::all_gather(communicator, first))
      if (!place.empty())
        {
          findings.warnings.push_back(
            "Part " + part.body.name() + ": the kernels of " +
            share(n_mixed, part.body.mesh().nodes.size(), "nodes") +
            " reach cells of two levels, for example at " + place +
            ". Velocities and forces are less accurate there: give the parts that meet "
            "one \"Grid level\", or enlarge or remove the refinement box.");
          return;
        }
  }


  template <int dim>
  double check_boundaries(const fluid::BoundaryConditions<dim> &conditions,
                          const grid::PatchGrid<dim> &grid,
                          const double start,
                          const double end,
                          Findings &findings,
                          std::ostream &out)
  {
    constexpr unsigned int n_samples = 200, n_times = 101;
    const MPI_Comm communicator = grid.communicator();
    const unsigned int n        = grid.n_cells_per_side();

    // Step 1: areas, and some points of each condition.
    std::vector<double> areas(conditions.size(), 0.);
    std::vector<std::vector<Point<dim>>> points(conditions.size());
    for (unsigned int p = 0; p < grid.n_owned_patches(); ++p)
      for (unsigned int side = 0; side < 2 * dim; ++side)
        if (grid.neighbor(p, side) == grid::Neighbor::boundary)
          {
            const grid::Patch<dim> &patch = grid.patch(p);
            double area                   = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              area *= d == side / 2 ? 1. : patch.h[d];
            for (unsigned int face = 0; face < Utilities::pow(n, dim - 1); ++face)
              {
                Point<dim> x;
                for (unsigned int d = 0, rest = face; d < dim; ++d)
                  if (d == side / 2)
                    x[d] = patch.lower[d] + (side % 2) * n * patch.h[d];
                  else
                    {
                      x[d] = patch.lower[d] + (rest % n + 0.5) * patch.h[d];
                      rest /= n;
                    }
                const unsigned int c = conditions.info(side, x).condition;
                areas[c] += area;
                if (points[c].size() < n_samples)
                  points[c].push_back(x);
              }
          }
    Utilities::MPI::sum(areas, communicator, areas);

    // Step 2: what they prescribe.
    double lowest = std::numeric_limits<double>::max(), highest = -lowest;
    for (unsigned int c = 0; c < conditions.size(); ++c)
      {
        const fluid::BoundaryCondition<dim> &condition = conditions.condition(c);
        // lowest pressure with its sign changed, highest pressure, largest speed
        std::array<double, 3> extremes = {
          {-std::numeric_limits<double>::max(), -std::numeric_limits<double>::max(), 0.}};
        for (const Point<dim> &x : points[c])
          for (unsigned int k = 0; k < n_times; ++k)
            {
              const double t = start + (end - start) * k / (n_times - 1.);
              if (condition.kind() == grid::BoundaryKind::traction)
                {
                  const double pressure = condition.pressure(x, t);
                  extremes[0]           = std::max(extremes[0], -pressure);
                  extremes[1]           = std::max(extremes[1], pressure);
                }
              else if (!condition.velocity_is_zero())
                {
                  double square = 0.;
                  for (unsigned int d = 0; d < dim; ++d)
                    square += std::pow(condition.velocity(x, d, t), 2);
                  extremes[2] = std::max(extremes[2], std::sqrt(square));
                }
            }
        Utilities::MPI::max(ArrayView<const double>(extremes.data(), 3),
                            communicator,
                            ArrayView<double>(extremes.data(), 3));

        const std::string name = "Boundary condition \"" + conditions.name(c) + "\"";
        out << "  boundary condition " << conditions.name(c) << ": " << areas[c]
            << (dim == 2 ? " cm" : " cm^2");
        if (areas[c] == 0.)
          findings.warnings.push_back(
            name + " holds nowhere: its region meets none of its faces, or conditions "
                   "before it in the list hold there.");
        else if (condition.kind() == grid::BoundaryKind::traction)
          {
            lowest  = std::min(lowest, -extremes[0]);
            highest = std::max(highest, extremes[1]);
            out << ", pressure " << -extremes[0] / base::mmHg << " to "
                << extremes[1] / base::mmHg << " mmHg";
            const double largest = std::max(std::abs(extremes[0]), std::abs(extremes[1]));
            if (largest > largest_pressure)
              findings.warnings.push_back(
                name + ": the pressure reaches " + text(largest / base::mmHg) +
                " mmHg. Is it in the right unit? \"Pressure\" is in dyn/cm^2 (1 mmHg = "
                "1333.22 dyn/cm^2, 1 Pa = 10 dyn/cm^2), a table's unit is in its first "
                "line.");
          }
        else if (condition.kind() == grid::BoundaryKind::slip)
          out << ", slip";
        else if (condition.velocity_is_zero())
          out << ", wall";
        else
          {
            out << ", velocity up to " << extremes[2] << " cm/s";
            if (extremes[2] > largest_speed)
              findings.warnings.push_back(name + ": the velocity reaches " +
                                          text(extremes[2]) +
                                          " cm/s. Is it in the right unit (cm/s)?");
          }
        out << '\n';
      }
    return highest > lowest ? highest - lowest : 0.;
  }


  void check_fluid(const fluid::FluidParameters &parameters, Findings &findings)
  {
    if (parameters.density > 100.)
      findings.warnings.push_back(
        "\"Fluid / Density\" is " + text(parameters.density) +
        " g/cm^3. Is it in kg/m^3? Blood has about 1.06 g/cm^3.");
    else if (parameters.density > 1.01 && parameters.density < 1.1 &&
             parameters.viscosity < 0.008)
      findings.warnings.push_back("\"Fluid / Viscosity\" is " +
                                  text(parameters.viscosity) +
                                  " g/(cm s), less than that of water. Is it in Pa s? "
                                  "Blood has about 0.04 g/(cm s), "
                                  "which is 0.004 Pa s.");
  }


  void check_tables(const std::map<std::string, std::string> &parameters,
                    const double start,
                    const double end,
                    Findings &findings)
  {
    const std::string ending = " extension";
    for (const auto &[name, value] : parameters)
      {
        if (name.size() < ending.size() || value != "clamped" ||
            name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
          continue;
        const std::string stem = name.substr(0, name.size() - ending.size());
        for (const std::string &entry : {stem + " file", stem + " table"})
          {
            const auto found = parameters.find(entry);
            if (found == parameters.end() || found->second.empty())
              continue;
            const std::string file =
              found->second.substr(0, found->second.rfind(", contents "));
            const base::TimeTable table(file, base::TimeTable::Extension::clamped);
            const double slack = 1e-9 * (end - start);
            if (table.start_time() > start + slack || table.end_time() < end - slack)
              findings.warnings.push_back(
                entry + ": the table " + file + " goes from " + text(table.start_time()) +
                " to " + text(table.end_time()) + " s, the run from " + text(start) +
                " to " + text(end) + " s; its first or last value holds outside. Set \"" +
                name.substr(name.rfind(" / ") + 3) +
                " = periodic\" if it shall be repeated.");
          }
      }
  }


  namespace
  {
    /// Largest eigenvalue of a map between velocities of parts by power iteration, and
    /// the part and node where its eigenvector is largest.
    struct Eigenvalue
    {
      double value = 0.;
      std::string place;
    };


    template <int dim, typename Map>
    Eigenvalue largest_eigenvalue(const std::vector<PartView<dim>> &parts, const Map &map)
    {
      using structure::VectorType;
      const unsigned int n = parts.size();

      // Smooth motions are what the grid resists most, so the start is one, with a
      // disturbance that has a share of all others. It depends on the node of the mesh
      // alone, and not on the number of ranks.
      std::vector<VectorType> v(n), image(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          parts[i].body.initialize_vector(v[i]);
          parts[i].body.initialize_vector(image[i]);
          const auto &elements = parts[i].body.elements();
          for (unsigned int k = 0; k < elements.n_owned_nodes(); ++k)
            for (unsigned int c = 0; c < dim; ++c)
              v[i].local_element(k * dim + c) =
                1. + 0.5 * std::sin(12.9898 * (elements.file_node(k) * dim + c));
        }
      const auto norm = [&](const std::vector<VectorType> &x) {
        double square = 0.;
        for (const VectorType &part : x)
          square += part * part;
        return std::sqrt(square);
      };

      Eigenvalue result;
      double size = norm(v);
      for (unsigned int iteration = 0; iteration < 40; ++iteration)
        {
          for (VectorType &part : v)
            part /= size;
          map(v, image);
          size = norm(image);
          if (!(size > 0.))
            return {};
          const bool settled = std::abs(size - result.value) < 1e-3 * size;
          result.value       = size;
          v.swap(image);
          if (settled && iteration > 5)
            break;
        }

      double largest = -1.;
      for (unsigned int i = 0; i < n; ++i)
        {
          const std::vector<double> values = parts[i].body.to_mesh_order(v[i]);
          for (std::size_t k = 0; k < values.size(); ++k)
            if (std::abs(values[k]) > largest)
              {
                largest      = std::abs(values[k]);
                result.place = "part " + parts[i].body.name() + " about " +
                               structure::to_string(parts[i].body.mesh().nodes[k / dim]);
              }
        }
      return result;
    }
  } // namespace


  template <int dim>
  std::vector<StepLimit>
  constraint_step_limits(const std::vector<PartView<dim>> &parts,
                         coupling::FECoupling<dim> &coupling,
                         const fluid::StokesOperators<dim> &operators,
                         const double density)
  {
    using structure::VectorType;
    const unsigned int n = parts.size();
    std::vector<VectorType> forces(n), forces_at_rest(n), zero(n), moved(n);
    grid::VectorType grid_force;
    operators.initialize_velocity(grid_force);
    for (unsigned int i = 0; i < n; ++i)
      for (VectorType *v : {&forces[i], &forces_at_rest[i], &zero[i], &moved[i]})
        parts[i].body.initialize_vector(*v);

    // Constraints are linear, so that the size of the motion does not matter.
    const auto add_forces =
      [&](const unsigned int i, const VectorType &X, const VectorType &U, VectorType &F) {
        for (const auto &c : parts[i].body.constraints())
          c.constraint->add_force_density(X, U, 0., F);
      };
    for (unsigned int i = 0; i < n; ++i)
      add_forces(i, parts[i].X, zero[i], forces_at_rest[i]);

    const auto accelerate = [&](const bool by_position,
                                const std::vector<VectorType> &v,
                                std::vector<VectorType> &acceleration) {
      std::vector<const VectorType *> force_pointers;
      std::vector<VectorType *> pointers;
      for (unsigned int i = 0; i < n; ++i)
        {
          forces[i] = forces_at_rest[i];
          forces[i] *= -1.;
          moved[i] = parts[i].X;
          if (by_position)
            moved[i].add(1., v[i]);
          add_forces(i, moved[i], by_position ? zero[i] : v[i], forces[i]);
          forces[i] *= -1. / density;
          force_pointers.push_back(&forces[i]);
          pointers.push_back(&acceleration[i]);
        }
      coupling.spread(force_pointers, grid_force);
      coupling.interpolate(grid_force, pointers);
    };

    std::vector<StepLimit> limits;
    for (const bool by_position : {true, false})
      {
        const Eigenvalue mu = largest_eigenvalue(
          parts, [&](const std::vector<VectorType> &v, std::vector<VectorType> &image) {
            accelerate(by_position, v, image);
          });
        if (mu.value > 0.)
          limits.push_back({std::string(by_position ? "stiffness" : "damping") +
                              " of the constraints (" + mu.place + ")",
                            by_position ? 2. / std::sqrt(mu.value) : 2. / mu.value,
                            by_position ? "a smaller \"Stiffness\" of the constraint"
                                        : "a smaller \"Damping\" of the constraint"});
      }
    return limits;
  }


  void check_step_limits(const std::vector<StepLimit> &limits,
                         const double time_step,
                         Findings &findings,
                         std::ostream &out)
  {
    for (const StepLimit &limit : limits)
      {
        out << "    " << limit.cause << ": " << limit.time_step << " s\n";
        const std::string message = "\"Time / Time step\" is " + text(time_step) +
                                    " s, but the " + limit.cause + " allows about " +
                                    text(limit.time_step) +
                                    " s. Use a shorter step, or " + limit.remedy + ".";
        if (time_step > 2. * limit.time_step)
          findings.errors.push_back(message);
        else if (time_step > limit.time_step)
          findings.warnings.push_back(message);
      }
  }


  void check_output_folder(const std::string &folder)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::path place = fs::absolute(folder.empty() ? "." : folder, error);
    while (!fs::exists(place, error) && place.has_parent_path() &&
           place != place.parent_path())
      place = place.parent_path();
    if (!fs::is_directory(place, error))
      throw base::UserError("\"Output folder\" is " + folder + ", but " + place.string() +
                            " is not a folder.");
    if (::access(place.c_str(), W_OK | X_OK) != 0)
      throw base::UserError("\"Output folder\" is " + folder +
                            ", but no files can be made in " + place.string() + ": " +
                            std::strerror(errno) + ".");
  }


#define MITRE_INSTANTIATE(dim)                                                           \
  template double element_quality(const structure::Mesh<dim> &, const unsigned int);     \
  template void check_part(                                                              \
    const PartView<dim> &, const grid::PatchGrid<dim> &, Findings &, std::ostream &);    \
  template void check_levels(                                                            \
    const PartView<dim> &, const grid::PatchGrid<dim> &, Findings &);                    \
  template double check_boundaries(const fluid::BoundaryConditions<dim> &,               \
                                   const grid::PatchGrid<dim> &,                         \
                                   const double,                                         \
                                   const double,                                         \
                                   Findings &,                                           \
                                   std::ostream &);                                      \
  template std::vector<StepLimit> constraint_step_limits(                                \
    const std::vector<PartView<dim>> &,                                                  \
    coupling::FECoupling<dim> &,                                                         \
    const fluid::StokesOperators<dim> &,                                                 \
    const double);

  MITRE_INSTANTIATE(2)
  MITRE_INSTANTIATE(3)
#undef MITRE_INSTANTIATE
} // namespace mitre::simulation
