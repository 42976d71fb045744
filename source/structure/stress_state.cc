#include <deal.II/base/numbers.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/structure/stress_state.h>

namespace mitre::structure
{
  template <int dim>
  StressState<dim>::StressState(const dealii::Tensor<2, dim> &F,
                                const dealii::Tensor<2, dim> &P,
                                const Fibres<dim> &fibres)
    : piola(P)
    , J(determinant(F))
  {
    cauchy = P * transpose(F) / J;
    green  = 0.5 * transpose(F) * F;
    for (unsigned int d = 0; d < dim; ++d)
      green[d][d] -= 0.5;
    for (unsigned int f = 0; f < max_fibre_families; ++f)
      if (fibres[f].norm_square() > 0)
        {
          const dealii::Tensor<1, dim> a = F * fibres[f];
          fibre_stretch[f]               = a.norm();
          fibre_direction[f]             = a / fibre_stretch[f];
          fibre_stress[f] = fibre_direction[f] * (cauchy * fibre_direction[f]);
        }
  }


  template <int dim>
  void StressState<dim>::add(const double weight, const StressState &other)
  {
    piola += weight * other.piola;
    cauchy += weight * other.cauchy;
    green += weight * other.green;
    J += weight * other.J;
    for (unsigned int f = 0; f < max_fibre_families; ++f)
      {
        fibre_stretch[f] += weight * other.fibre_stretch[f];
        fibre_stress[f] += weight * other.fibre_stress[f];
        fibre_direction[f] += weight * other.fibre_direction[f];
      }
  }


  template <int dim>
  void StressState<dim>::divide(const double volume)
  {
    piola /= volume;
    cauchy /= volume;
    green /= volume;
    J /= volume;
    for (unsigned int f = 0; f < max_fibre_families; ++f)
      {
        fibre_stretch[f] /= volume;
        fibre_stress[f] /= volume;
        const double length = fibre_direction[f].norm();
        if (length > 0)
          fibre_direction[f] /= length;
      }
  }


  namespace
  {
    /// Principal values from the largest on, with their directions.
    template <int dim>
    auto principal(const dealii::Tensor<2, dim> &T)
    {
      return eigenvectors(dealii::symmetrize(T));
    }


    template <int dim>
    void write_tensor(const dealii::Tensor<2, dim> &T, double *values)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          values[3 * i + j] = i < dim && j < dim ? T[i][j] : 0.;
    }


    template <int dim>
    void write_vector(const dealii::Tensor<1, dim> &v, double *values)
    {
      for (unsigned int i = 0; i < 3; ++i)
        values[i] = i < dim ? v[i] : 0.;
    }


    /// The quantities that follow from the principal values of one tensor.
    template <int dim, typename GetTensor>
    void add_principal_quantities(std::vector<StressQuantity<dim>> &quantities,
                                  const std::string &of,
                                  const std::string &unit,
                                  const GetTensor &tensor)
    {
      quantities.push_back({"principal " + of + (of == "stress" ? "es" : "s"),
                            unit,
                            3,
                            max_fibre_families,
                            [tensor](const StressState<dim> &state, double *values) {
                              const auto pairs = principal(tensor(state));
                              for (unsigned int i = 0; i < 3; ++i)
                                values[i] = i < dim ? pairs[i].first : 0.;
                            }});
      quantities.push_back({"first principal " + of,
                            unit,
                            1,
                            max_fibre_families,
                            [tensor](const StressState<dim> &state, double *values) {
                              values[0] = principal(tensor(state))[0].first;
                            }});
      quantities.push_back({"last principal " + of,
                            unit,
                            1,
                            max_fibre_families,
                            [tensor](const StressState<dim> &state, double *values) {
                              values[0] = principal(tensor(state))[dim - 1].first;
                            }});
      quantities.push_back({"direction of first principal " + of,
                            "",
                            3,
                            max_fibre_families,
                            [tensor](const StressState<dim> &state, double *values) {
                              write_vector(principal(tensor(state))[0].second, values);
                            }});
    }


    template <int dim>
    std::vector<StressQuantity<dim>> make_stress_quantities()
    {
      using State                 = StressState<dim>;
      constexpr unsigned int none = max_fibre_families;
      const std::string stress    = "dyn/cm^2";
      std::vector<StressQuantity<dim>> all;
      all.push_back({"J", "", 1, none, [](const State &state, double *values) {
                       values[0] = state.J;
                     }});
      all.push_back({"Cauchy stress", stress, 9, none, [](const State &state, double *v) {
                       write_tensor(state.cauchy, v);
                     }});
      all.push_back(
        {"first Piola-Kirchhoff stress",
         stress,
         9,
         none,
         [](const State &state, double *v) { write_tensor(state.piola, v); }});
      all.push_back({"Green strain", "", 9, none, [](const State &state, double *v) {
                       write_tensor(state.green, v);
                     }});
      add_principal_quantities<dim>(
        all, "stress", stress, [](const State &state) { return state.cauchy; });
      add_principal_quantities<dim>(
        all, "strain", "", [](const State &state) { return state.green; });
      for (unsigned int f = 0; f < max_fibre_families; ++f)
        {
          const std::string fibre = f == 0 ? "fibre" : "second fibre";
          all.push_back(
            {fibre + " stretch", "", 1, f, [f](const State &state, double *v) {
               v[0] = state.fibre_stretch[f];
             }});
          all.push_back(
            {fibre + " stress", stress, 1, f, [f](const State &state, double *v) {
               v[0] = state.fibre_stress[f];
             }});
          all.push_back(
            {fibre + " direction", "", 3, f, [f](const State &state, double *v) {
               write_vector(state.fibre_direction[f], v);
             }});
        }
      all.push_back({"fibre angle", "degrees", 1, 0, [](const State &state, double *v) {
                       const double cosine = std::abs(principal(state.cauchy)[0].second *
                                                      state.fibre_direction[0]);
                       v[0] = std::acos(std::min(cosine, 1.)) * 180 / dealii::numbers::PI;
                     }});
      return all;
    }
  } // namespace


  template <int dim>
  const std::vector<StressQuantity<dim>> &stress_quantities()
  {
    static const std::vector<StressQuantity<dim>> quantities =
      make_stress_quantities<dim>();
    return quantities;
  }


  template <int dim>
  const StressQuantity<dim> &find_stress_quantity(const std::string &name)
  {
    std::vector<std::string> names;
    for (const StressQuantity<dim> &quantity : stress_quantities<dim>())
      {
        if (quantity.name == name)
          return quantity;
        names.push_back(quantity.name);
      }
    throw base::UserError("There is no quantity of stress or strain '" + name + "'. " +
                          base::suggest_name(name, names));
  }


  template struct StressState<2>;
  template struct StressState<3>;
  template const std::vector<StressQuantity<2>> &stress_quantities();
  template const std::vector<StressQuantity<3>> &stress_quantities();
  template const StressQuantity<2> &find_stress_quantity(const std::string &);
  template const StressQuantity<3> &find_stress_quantity(const std::string &);
} // namespace mitre::structure
