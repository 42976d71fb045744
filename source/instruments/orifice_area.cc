#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/measuring_disc.h>
#include <mitre/instruments/orifice_area.h>
#include <mitre/structure/boundary_faces.h>

namespace mitre::instruments
{
  using dealii::Point;

  namespace
  {
    /// Two neighbours of a node that are neighbours of each other, or have another common
    /// neighbour, span a triangle with it. Of a cell of four segments that gives each of
    /// the four triangles that two sides span; they overlap.
    std::vector<std::array<unsigned int, 3>>
    find_cells_of_segments(const structure::Mesh<3> &mesh)
    {
      std::vector<std::set<unsigned int>> neighbours(mesh.nodes.size());
      for (unsigned int e = 0; e < mesh.n_elements(); ++e)
        {
          const unsigned int a = mesh.elements[2 * e], b = mesh.elements[2 * e + 1];
          if (a != b)
            {
              neighbours[a].insert(b);
              neighbours[b].insert(a);
            }
        }
      std::map<std::pair<unsigned int, unsigned int>, std::vector<unsigned int>> between;
      for (unsigned int a = 0; a < neighbours.size(); ++a)
        for (auto b = neighbours[a].begin(); b != neighbours[a].end(); ++b)
          for (auto c = std::next(b); c != neighbours[a].end(); ++c)
            between[{*b, *c}].push_back(a);
      std::vector<std::array<unsigned int, 3>> triangles;
      for (const auto &[pair, nodes] : between)
        if (nodes.size() > 1 || neighbours[pair.first].count(pair.second) > 0)
          for (const unsigned int a : nodes)
            triangles.push_back({{pair.first, a, pair.second}});
      return triangles;
    }


    /// Pixels of a picture, with a free margin.
    class Picture
    {
    public:
      Picture(const Point<2> &lower,
              const Point<2> &upper,
              const double pixel,
              const std::string &instrument)
        : origin(lower[0] - 2 * pixel, lower[1] - 2 * pixel)
        , pixel(pixel)
      {
        const double width  = (upper[0] - lower[0]) / pixel + 5,
                     height = (upper[1] - lower[1]) / pixel + 5;
        AssertThrow(width * height < 1e8,
                    base::UserError("Instrument " + instrument +
                                    ": with a \"Pixel\" of " + std::to_string(pixel) +
                                    " cm, its picture has " +
                                    std::to_string(std::llround(width * height)) +
                                    " pixels; expected fewer than 1e8."));
        nx = static_cast<int>(width);
        ny = static_cast<int>(height);
        flags.assign(static_cast<std::size_t>(nx) * ny, 0);
      }

      void add(const std::array<Point<2>, 3> &corners)
      {
        std::array<Point<2>, 3> c;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int d = 0; d < 2; ++d)
            c[i][d] = (corners[i][d] - origin[d]) / pixel;
        for (unsigned int i = 0; i < 3; ++i)
          close_along(c[i], c[(i + 1) % 3]);
        cover(c);
      }

      /// In pixels.
      double open_area()
      {
        find_outside();
        double sum = 0;
        for (int y = 0; y < ny; ++y)
          for (int x = 0; x < nx; ++x)
            {
              const std::uint8_t flag = flags[index(x, y)];
              if ((flag & (covered | outside)) == 0)
                sum += (flag & closed) != 0 ? enclosed_share(x, y) : 1.;
            }
        return sum;
      }

    private:
      static constexpr std::uint8_t covered = 1, closed = 2, outside = 4;

      std::size_t index(const int x, const int y) const
      {
        return static_cast<std::size_t>(y) * nx + x;
      }

      /// Marks the pixels of a line, each of which touches the next at least by a corner.
      void close_along(const Point<2> &a, const Point<2> &b)
      {
        const int n = 1 + static_cast<int>(4 * a.distance(b));
        for (int i = 0; i <= n; ++i)
          {
            const Point<2> x = a + (b - a) * (static_cast<double>(i) / n);
            flags[index(static_cast<int>(x[0]), static_cast<int>(x[1]))] |= closed;
          }
      }

      void cover(const std::array<Point<2>, 3> &c)
      {
        const auto turn = [](const Point<2> &a, const Point<2> &b, const Point<2> &x) {
          return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
        };
        const double area = turn(c[0], c[1], c[2]);
        if (area == 0)
          return;
        const double sign = area > 0 ? 1 : -1, least = -1e-10;
        const auto [x0, x1] = std::minmax({c[0][0], c[1][0], c[2][0]});
        const auto [y0, y1] = std::minmax({c[0][1], c[1][1], c[2][1]});
        for (int y = static_cast<int>(y0); y <= static_cast<int>(y1); ++y)
          for (int x = static_cast<int>(x0); x <= static_cast<int>(x1); ++x)
            {
              const Point<2> centre(x + 0.5, y + 0.5);
              if (sign * turn(c[0], c[1], centre) >= least &&
                  sign * turn(c[1], c[2], centre) >= least &&
                  sign * turn(c[2], c[0], centre) >= least)
                flags[index(x, y)] |= covered;
            }
      }

      /// Spreads from a corner of the picture over the sides of pixels.
      void find_outside()
      {
        std::vector<std::pair<int, int>> front = {{0, 0}};
        flags[0] |= outside;
        while (!front.empty())
          {
            const auto [x, y] = front.back();
            front.pop_back();
            for (const auto &[dx, dy] : {std::make_pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
              if (x + dx >= 0 && x + dx < nx && y + dy >= 0 && y + dy < ny)
                if (std::uint8_t &flag = flags[index(x + dx, y + dy)]; flag == 0)
                  {
                    flag |= outside;
                    front.emplace_back(x + dx, y + dy);
                  }
          }
      }

      /// Of the neighbours of a closed pixel that are outside or enclosed and open, the
      /// share of the latter; 1 if there are none, as in a slit.
      double enclosed_share(const int x, const int y) const
      {
        unsigned int n_outside = 0, n_enclosed = 0;
        for (int j = y - 1; j <= y + 1; ++j)
          for (int i = x - 1; i <= x + 1; ++i)
            {
              const std::uint8_t flag = flags[index(i, j)];
              n_outside += flag == outside ? 1 : 0;
              n_enclosed += flag == 0 ? 1 : 0;
            }
        return n_outside + n_enclosed == 0
                 ? 1.
                 : static_cast<double>(n_enclosed) / (n_outside + n_enclosed);
      }

      const Point<2> origin;
      const double pixel;
      int nx = 0, ny = 0;
      std::vector<std::uint8_t> flags;
    };
  } // namespace


  template <int dim>
  std::vector<std::array<unsigned int, dim>>
  find_surface(const structure::Mesh<dim> &mesh)
  {
    std::vector<std::array<unsigned int, dim>> surface;
    if (mesh.shape == structure::ElementShape::segment)
      {
        if constexpr (dim == 3)
          return find_cells_of_segments(mesh);
        else
          for (unsigned int e = 0; e < mesh.n_elements(); ++e)
            surface.push_back({{mesh.elements[2 * e], mesh.elements[2 * e + 1]}});
        return surface;
      }
    const auto &corners = structure::face_corners<dim>(mesh.shape);
    for (const structure::BoundaryFace &face : structure::find_boundary_faces(mesh))
      {
        std::vector<unsigned int> nodes;
        for (const unsigned int corner : corners[face.face])
          nodes.push_back(mesh.elements[face.element * mesh.nodes_per_element + corner]);
        std::array<unsigned int, dim> piece;
        std::copy_n(nodes.begin(), dim, piece.begin());
        surface.push_back(piece);
        if (nodes.size() > dim)
          {
            std::copy_n(nodes.begin() + 1, dim, piece.begin());
            surface.push_back(piece);
          }
      }
    return surface;
  }


  double compute_open_area(const std::vector<std::array<Point<2>, 3>> &triangles,
                           const double pixel,
                           const std::string &instrument)
  {
    Point<2> lower, upper;
    for (unsigned int d = 0; d < 2; ++d)
      {
        lower[d] = std::numeric_limits<double>::infinity();
        upper[d] = -lower[d];
        for (const auto &triangle : triangles)
          for (const Point<2> &x : triangle)
            {
              lower[d] = std::min(lower[d], x[d]);
              upper[d] = std::max(upper[d], x[d]);
            }
      }
    if (triangles.empty())
      return 0;
    Picture picture(lower, upper, pixel, instrument);
    for (const auto &triangle : triangles)
      picture.add(triangle);
    return picture.open_area() * pixel * pixel;
  }


  double compute_open_length(std::vector<std::array<double, 2>> intervals)
  {
    for (std::array<double, 2> &interval : intervals)
      if (interval[0] > interval[1])
        std::swap(interval[0], interval[1]);
    std::sort(intervals.begin(), intervals.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < intervals.size(); ++i)
      {
        intervals[i + 1][1] = std::max(intervals[i + 1][1], intervals[i][1]);
        sum += std::max(0., intervals[i + 1][0] - intervals[i][1]);
      }
    return sum;
  }


  template <int dim>
  void OrificeArea<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Parts",
                      "",
                      dealii::Patterns::Anything(),
                      "Names of the parts that together enclose the orifice.");
    prm.declare_entry("Axis",
                      "x",
                      dealii::Patterns::Selection("x|y|z"),
                      "Along which one looks at them.");
    prm.declare_entry(
      "Pixel",
      "0.02",
      dealii::Patterns::Double(1e-6),
      "Width of the pixels on which the parts are drawn [cm] (not in 2D).");
  }


  template <int dim>
  void OrificeArea<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                          const std::string &instrument)
  {
    name  = instrument;
    parts = base::parse_names(prm.get("Parts"));
    axis  = parse_axis<dim>(prm.get("Axis"), name);
    pixel = prm.get_double("Pixel");
    AssertThrow(!parts.empty(),
                base::UserError("Instrument " + name +
                                ": \"Parts\" names no part; expected those that enclose "
                                "the orifice."));
    surfaces.clear();
  }


  template <int dim>
  std::vector<std::string> OrificeArea<dim>::columns() const
  {
    return {name + (dim == 3 ? " [cm^2]" : " [cm]")};
  }


  template <int dim>
  std::vector<double> OrificeArea<dim>::measure(const Observation<dim> &observation)
  {
    if (surfaces.empty())
      for (const std::string &part : parts)
        {
          surfaces.push_back(
            find_surface(observation.find_part(part, name).body->mesh()));
          AssertThrow(!surfaces.back().empty(),
                      base::UserError("Instrument " + name + ": the part " + part +
                                      " has no surface: its fibres form no cells of "
                                      "three or four segments."));
        }

    std::vector<std::array<Point<dim - 1>, dim>> pieces;
    for (unsigned int i = 0; i < parts.size(); ++i)
      {
        const ObservedPart<dim> &part = observation.find_part(parts[i], name);
        const std::vector<double> X   = part.body->to_mesh_order(*part.X);
        for (const std::array<unsigned int, dim> &nodes : surfaces[i])
          {
            std::array<Point<dim - 1>, dim> piece;
            for (unsigned int a = 0; a < dim; ++a)
              for (unsigned int d = 0, k = 0; d < dim; ++d)
                if (d != axis)
                  piece[a][k++] = X[nodes[a] * dim + d];
            pieces.push_back(piece);
          }
      }
    if constexpr (dim == 3)
      return {compute_open_area(pieces, pixel, name)};
    else
      {
        std::vector<std::array<double, 2>> intervals;
        for (const auto &piece : pieces)
          intervals.push_back({{piece[0][0], piece[1][0]}});
        return {compute_open_length(intervals)};
      }
  }


  template std::vector<std::array<unsigned int, 2>>
  find_surface<2>(const structure::Mesh<2> &);
  template std::vector<std::array<unsigned int, 3>>
  find_surface<3>(const structure::Mesh<3> &);
  template class OrificeArea<2>;
  template class OrificeArea<3>;
} // namespace mitre::instruments
