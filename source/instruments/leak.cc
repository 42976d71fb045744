#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/coupling/fe_coupling.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/leak.h>

namespace mitre::instruments
{
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    /// Nodes of an element that its faces have: on simplices all but one, on hypercubes
    /// those with the same coordinate; in the order of the element, first direction
    /// fastest.
    template <int dim>
    std::vector<std::vector<unsigned int>>
    element_faces(const structure::ElementShape shape)
    {
      std::vector<std::vector<unsigned int>> faces;
      if (shape == structure::ElementShape::simplex)
        for (unsigned int left_out = 0; left_out <= dim; ++left_out)
          {
            faces.emplace_back();
            for (unsigned int a = 0; a <= dim; ++a)
              if (a != left_out)
                faces.back().push_back(a);
          }
      else
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int side = 0; side < 2; ++side)
            {
              faces.emplace_back();
              for (unsigned int a = 0; a < (1u << dim); ++a)
                if (((a >> d) & 1) == side)
                  faces.back().push_back(a);
            }
      return faces;
    }


    /// Position and area vector (normal times area) at a point of a face; the face is
    /// bilinear if it has four nodes.
    template <int dim>
    struct FacePoint
    {
      std::array<double, 4> shape_values{};
      Point<dim> x;
      Tensor<1, dim> area;

      FacePoint(const std::vector<Point<dim>> &nodes, const double s, const double t)
      {
        const unsigned int n = nodes.size();
        std::array<double, 4> by_s{}, by_t{};
        if (n == 4)
          {
            shape_values = {{(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}};
            by_s         = {{t - 1, 1 - t, -t, t}};
            by_t         = {{s - 1, -s, 1 - s, s}};
          }
        else if (n == 3)
          {
            shape_values = {{1 - s - t, s, t, 0}};
            by_s         = {{-1, 1, 0, 0}};
            by_t         = {{-1, 0, 1, 0}};
          }
        else
          {
            shape_values = {{1 - s, s, 0, 0}};
            by_s         = {{-1, 1, 0, 0}};
          }
        Tensor<1, dim> along_s, along_t;
        for (unsigned int a = 0; a < n; ++a)
          {
            x += shape_values[a] * nodes[a];
            along_s += by_s[a] * nodes[a];
            along_t += by_t[a] * nodes[a];
          }
        if constexpr (dim == 2)
          area = dealii::cross_product_2d(along_s);
        else
          area = dealii::cross_product_3d(along_s, along_t);
      }
    };
  } // namespace


  template <int dim>
  void Leak<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Part", "", dealii::Patterns::Anything(), "Name of the part.");
    prm.declare_entry(
      "Direction",
      dim == 2 ? "1, 0" : "1, 0, 0",
      dealii::Patterns::List(dealii::Patterns::Double(), dim, dim),
      "Flow is measured through the faces of the part whose normals are "
      "within 60 degrees of this vector while the part is undeformed, and "
      "counts as positive along it.");
  }


  template <int dim>
  void Leak<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                   const std::string &instrument)
  {
    name = instrument;
    part = prm.get("Part");
    direction =
      base::parse_point<dim>(prm.get("Direction"), "Instrument " + name + ", Direction");
    AssertThrow(direction.norm() > 0.,
                base::UserError("Instrument " + name +
                                ": \"Direction\" is zero; expected is a vector along "
                                "which flow counts as positive."));
    direction /= direction.norm();
  }


  template <int dim>
  std::vector<std::string> Leak<dim>::columns() const
  {
    const std::string unit = dim == 3 ? "mL" : "cm^2";
    return {name + " flow [" + unit + "/s]",
            name + " volume [" + unit + "]",
            name + " volume both ways [" + unit + "]"};
  }


  template <int dim>
  void Leak<dim>::find_faces(const structure::Mesh<dim> &mesh)
  {
    // Step 1: faces that a single element has, and the element's centroid.
    struct Found
    {
      unsigned int count;
      std::vector<unsigned int> nodes;
      Point<dim> centroid;
    };
    std::map<std::vector<unsigned int>, Found> found;
    const auto local_faces = element_faces<dim>(mesh.shape);
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      {
        const unsigned int *element = &mesh.elements[e * mesh.nodes_per_element];
        Point<dim> centroid;
        for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
          centroid += mesh.nodes[element[a]] / mesh.nodes_per_element;
        for (const auto &face : local_faces)
          {
            std::vector<unsigned int> nodes, sorted;
            for (const unsigned int a : face)
              nodes.push_back(element[a]);
            sorted = nodes;
            std::sort(sorted.begin(), sorted.end());
            const auto [entry, is_new] =
              found.try_emplace(sorted, Found{1, nodes, centroid});
            entry->second.count += is_new ? 0 : 1;
          }
      }

    // Step 2: of these, the ones that look in the direction.
    faces.clear();
    for (auto &[sorted, face] : found)
      if (face.count == 1)
        {
          std::vector<Point<dim>> positions;
          for (const unsigned int node : face.nodes)
            positions.push_back(mesh.nodes[node]);
          const FacePoint<dim> middle(positions,
                                      face.nodes.size() == 3 ? 1. / 3 : 0.5,
                                      face.nodes.size() == 3 ? 1. / 3 : 0.5);
          Tensor<1, dim> normal = middle.area / middle.area.norm();
          if ((middle.x - face.centroid) * normal < 0)
            {
              // the other orientation: exchange the two directions along the face
              std::swap(face.nodes[dim - 2], face.nodes[dim - 1]);
              normal *= -1.;
            }
          if (normal * direction > 0.5)
            faces.push_back(face.nodes);
        }
    AssertThrow(!faces.empty(),
                base::UserError("Instrument " + name + ": no face of part " + part +
                                " looks within 60 degrees of the direction (" +
                                structure::to_string(Point<dim>(direction)) + ")."));
  }


  template <int dim>
  std::vector<double> Leak<dim>::measure(const Observation<dim> &observation)
  {
    const ObservedPart<dim> &observed = observation.find_part(part, name);
    const structure::FiniteElementBody<dim> &body =
      observation.find_finite_elements(part, name);
    if (faces.empty())
      find_faces(body.mesh());

    // Step 1: points on the faces.
    const grid::PatchGrid<dim> &patch_grid = observation.fluid->space().grid();
    double h                               = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      h = std::min(h, patch_grid.cell_width(patch_grid.maximum_level(), d));
    const std::vector<double> X = body.to_mesh_order(*observed.X),
                              U = body.to_mesh_order(*observed.U);
    std::vector<Point<dim>> points;
    std::vector<Tensor<1, dim>> areas, velocities;
    for (const auto &face : faces)
      {
        std::vector<Point<dim>> nodes(face.size());
        double longest = 0;
        for (unsigned int a = 0; a < face.size(); ++a)
          {
            for (unsigned int d = 0; d < dim; ++d)
              nodes[a][d] = X[face[a] * dim + d];
            longest = std::max(longest, nodes[a].distance(nodes[0]));
          }
        // Gauss points; on triangles of the square folded onto them.
        const unsigned int k = std::max(
          2u, static_cast<unsigned int>(std::ceil(std::min(4 * longest / h, 64.))));
        const dealii::QGauss<1> rule(k);
        for (unsigned int i = 0; i < k; ++i)
          for (unsigned int j = 0; j < (dim == 3 ? k : 1); ++j)
            {
              double s = rule.point(i)[0], t = rule.point(j)[0];
              double weight = rule.weight(i) * (dim == 3 ? rule.weight(j) : 1.);
              if (face.size() == 3)
                {
                  weight *= 1 - s;
                  t *= 1 - s;
                }
              const FacePoint<dim> point(nodes, s, t);
              points.push_back(point.x);
              areas.push_back(weight * point.area);
              velocities.emplace_back();
              for (unsigned int a = 0; a < face.size(); ++a)
                for (unsigned int d = 0; d < dim; ++d)
                  velocities.back()[d] += point.shape_values[a] * U[face[a] * dim + d];
            }
      }

    // Step 2: the flow through them.
    double flow = 0;
    for (const auto &[i, u] :
         observation.coupling->velocities_at(observation.fluid->velocity(), points))
      flow += (u - velocities[i]) * areas[i];
    flow = dealii::Utilities::MPI::sum(flow, body.communicator());

    if (has_previous)
      {
        const double dt = observation.time - previous_time;
        volume += 0.5 * dt * (flow + previous_flow);
        volume_both_ways += 0.5 * dt * (std::abs(flow) + std::abs(previous_flow));
      }
    has_previous  = true;
    previous_time = observation.time;
    previous_flow = flow;
    return {flow, volume, volume_both_ways};
  }


  template <int dim>
  std::vector<double> Leak<dim>::state() const
  {
    return {
      has_previous ? 1. : 0., previous_time, previous_flow, volume, volume_both_ways};
  }


  template <int dim>
  void Leak<dim>::set_state(const std::vector<double> &state)
  {
    AssertDimension(state.size(), 5);
    has_previous     = state[0] != 0.;
    previous_time    = state[1];
    previous_flow    = state[2];
    volume           = state[3];
    volume_both_ways = state[4];
  }


  template class Leak<2>;
  template class Leak<3>;
} // namespace mitre::instruments
