#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/base/units.h>
#include <mitre/fluid/navier_stokes.h>
#include <mitre/instruments/pressure_point.h>

namespace mitre::instruments
{
  using dealii::Point;

  template <int dim>
  double compute_pressure_at(const Point<dim> &x,
                             const grid::PatchGrid<dim> &patch_grid,
                             const grid::VectorType &p)
  {
    const int n          = patch_grid.n_cells_per_side();
    const unsigned int q = patch_grid.locate(x);
    std::array<double, 2> value_and_count{{0., 0.}};
    if (q != dealii::numbers::invalid_unsigned_int)
      {
        const grid::Patch<dim> &patch = patch_grid.patch(q);
        std::array<int, dim> lower;
        std::array<double, dim> weight;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double cells = (x[d] - patch.lower[d]) / patch.h[d] - 0.5;
            lower[d]  = std::min(std::max(static_cast<int>(std::floor(cells)), 0), n - 2);
            weight[d] = cells - lower[d];
          }
        const std::size_t first =
          q * dealii::Utilities::fixed_power<dim>(static_cast<std::size_t>(n));
        for (unsigned int corner = 0; corner < (1u << dim); ++corner)
          {
            std::size_t cell = 0, stride = 1;
            double product = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int upper = (corner >> d) & 1;
                cell += (lower[d] + upper) * stride;
                stride *= n;
                product *= upper == 1 ? weight[d] : 1. - weight[d];
              }
            value_and_count[0] += product * p.local_element(first + cell);
          }
        value_and_count[1] = 1.;
      }
    dealii::Utilities::MPI::sum(
      dealii::ArrayView<const double>(value_and_count.data(), 2),
      patch_grid.communicator(),
      dealii::ArrayView<double>(value_and_count.data(), 2));
    return value_and_count[1] > 0. ? value_and_count[0] / value_and_count[1]
                                   : std::numeric_limits<double>::quiet_NaN();
  }


  template <int dim>
  void PressurePoint<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    const std::string origin = dim == 2 ? "0, 0" : "0, 0, 0";
    prm.declare_entry("Point",
                      origin,
                      dealii::Patterns::List(dealii::Patterns::Double(), dim, dim),
                      "Where the pressure is wanted [cm].");
    prm.declare_entry("Normal",
                      origin,
                      dealii::Patterns::List(dealii::Patterns::Double(), dim, dim),
                      "Direction, of any length, that points into the fluid if the point "
                      "lies on the surface of a part.");
    prm.declare_entry("Extrapolation distance",
                      "0",
                      dealii::Patterns::Double(0.),
                      "If not 0: the pressure is extrapolated along the normal from one, "
                      "two and three times this distance [cm], which should be at least "
                      "the reach of the part's kernel.");
    prm.declare_entry("Unit",
                      "mmHg",
                      dealii::Patterns::Selection("mmHg|dyn/cm^2"),
                      "Unit of the column.");
  }


  template <int dim>
  void PressurePoint<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                            const std::string &instrument)
  {
    name                   = instrument;
    in_mmHg                = prm.get("Unit") == "mmHg";
    const std::string what = "Instrument " + name;
    const Point<dim> point = base::parse_point<dim>(prm.get("Point"), what + ", Point");
    dealii::Tensor<1, dim> normal =
      base::parse_point<dim>(prm.get("Normal"), what + ", Normal");
    const double distance = prm.get_double("Extrapolation distance");
    samples.clear();
    if (distance == 0.)
      samples.emplace_back(point, 1.);
    else
      {
        AssertThrow(normal.norm() > 0.,
                    base::UserError(what +
                                    ": an \"Extrapolation distance\" is given, but "
                                    "no \"Normal\" along which to extrapolate."));
        normal /= normal.norm();
        samples.emplace_back(point + distance * normal, 3.);
        samples.emplace_back(point + 2. * distance * normal, -3.);
        samples.emplace_back(point + 3. * distance * normal, 1.);
      }
  }


  template <int dim>
  std::vector<std::string> PressurePoint<dim>::columns() const
  {
    return {name + (in_mmHg ? " [mmHg]" : " [dyn/cm^2]")};
  }


  template <int dim>
  std::vector<double> PressurePoint<dim>::measure(const Observation<dim> &observation)
  {
    double sum = 0.;
    for (const auto &[x, weight] : samples)
      {
        const double value = compute_pressure_at(
          x, observation.fluid->space().grid(), observation.fluid->pressure());
        if (std::isnan(value) && !observation.fluid->space().grid().box().point_inside(x))
          {
            std::ostringstream message;
            message << "Instrument " << name << ": the pressure is wanted at (" << x
                    << ") cm, outside of the fluid box.";
            throw base::UserError(message.str());
          }
        sum += weight * value;
      }
    return {in_mmHg ? sum / base::mmHg : sum};
  }


  template double compute_pressure_at(const Point<2> &,
                                      const grid::PatchGrid<2> &,
                                      const grid::VectorType &);
  template double compute_pressure_at(const Point<3> &,
                                      const grid::PatchGrid<3> &,
                                      const grid::VectorType &);
  template class PressurePoint<2>;
  template class PressurePoint<3>;
} // namespace mitre::instruments
