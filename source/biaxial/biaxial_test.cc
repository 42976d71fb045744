#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/nearest_name.h>
#include <mitre/base/parameters.h>
#include <mitre/base/units.h>
#include <mitre/biaxial/biaxial_test.h>
#include <mitre/structure/library.h>

namespace mitre::biaxial
{
  namespace
  {
    const char *const loading_names = "uniaxial 1|uniaxial 2|equibiaxial|strip biaxial "
                                      "1|strip biaxial 2|simple shear";


    State deform(const Sample &sample, const std::string &loading, const double amount)
    {
      if (loading == "uniaxial 1")
        return sample.stretch_uniaxially(1, amount);
      if (loading == "uniaxial 2")
        return sample.stretch_uniaxially(2, amount);
      if (loading == "equibiaxial")
        return sample.deform(amount, amount, 0);
      if (loading == "strip biaxial 1")
        return sample.deform(amount, 1, 0);
      if (loading == "strip biaxial 2")
        return sample.deform(1, amount, 0);
      return sample.deform(1, 1, amount);
    }


    std::string with_underscores(std::string text)
    {
      std::replace(text.begin(), text.end(), ' ', '_');
      return text;
    }


    // Writes a table of which each line is a state, and more columns if need be.
    class StateTable
    {
    public:
      StateTable(const BiaxialParameters &parameters,
                 const std::string &file_name,
                 const std::vector<std::pair<std::string, bool>> &more = {})
        : parameters(parameters)
        , file_name(file_name)
        , file(file_name)
      {
        const std::string stress = " [" + parameters.stress_unit + "]";
        file << "stretch 1 [1],stretch 2 [1],stretch 3 [1],shear [1]";
        for (const std::string component : {"11", "22", "12"})
          file << ",Cauchy stress " << component << stress;
        for (const std::string component : {"11", "22", "12"})
          file << ",first Piola stress " << component << stress;
        if (parameters.thickness > 0)
          file << ",tension 11 [N/m],tension 22 [N/m]";
        for (const auto &[name, is_tension] : more)
          file << ',' << name << (is_tension ? " [N/m]" : stress);
        file << '\n' << std::setprecision(12);
      }

      void write(const State &state,
                 const std::vector<std::pair<double, bool>> &more = {})
      {
        const double unit         = base::unit_in_cgs(parameters.stress_unit),
                     tension_unit = base::unit_in_cgs("N/m");
        file << state.F[0][0] << ',' << state.F[1][1] << ',' << state.F[2][2] << ','
             << state.F[0][1];
        for (const dealii::Tensor<2, 3> *stress :
             {&state.cauchy_stress, &state.first_piola_stress})
          file << ',' << (*stress)[0][0] / unit << ',' << (*stress)[1][1] / unit << ','
               << (*stress)[0][1] / unit;
        if (parameters.thickness > 0)
          for (unsigned int i = 0; i < 2; ++i)
            file << ','
                 << state.first_piola_stress[i][i] * parameters.thickness / tension_unit;
        for (const auto &[value, is_tension] : more)
          file << ',' << value / (is_tension ? tension_unit : unit);
        file << '\n';
        AssertThrow(file, base::UserError("Cannot write the table '" + file_name + "'."));
      }

    private:
      const BiaxialParameters &parameters;
      const std::string file_name;
      std::ofstream file;
    };


    Sample make_sample(const BiaxialMaterial &material,
                       const BiaxialParameters &parameters)
    {
      return Sample(material.law->law(),
                    material.fibres,
                    parameters.volume,
                    material.time_factor.value(parameters.time),
                    parameters.time);
    }


    std::string fit_material(BiaxialMaterial &material,
                             const BiaxialParameters &parameters)
    {
      const Measurements measurements(material.measurements_file, parameters.thickness);
      FitResult result;
      try
        {
          result = fit(
            material.free_parameters,
            measurements,
            parameters.thickness,
            [&](const std::vector<double> &values) {
              for (unsigned int i = 0; i < values.size(); ++i)
                material.law->set(material.free_parameters[i].name, values[i]);
              return make_sample(material, parameters);
            },
            material.tolerance,
            material.max_evaluations);
        }
      catch (const base::UserError &error)
        {
          throw base::UserError("Material " + material.name + ", fit to '" +
                                material.measurements_file + "': " + error.what());
        }

      std::ostringstream text;
      text << "Material " << material.name << ": " << material.law_name << " fitted to "
           << measurements.n_lines() << " lines of " << material.measurements_file << " ("
           << result.n_evaluations << " evaluations)\n";
      for (unsigned int i = 0; i < result.values.size(); ++i)
        {
          const FreeParameter &p = material.free_parameters[i];
          material.law->set(p.name, result.values[i]);
          text << "    set " << p.name << " = " << std::setprecision(6)
               << result.values[i] << "    # ";
          if (std::isfinite(result.standard_errors[i]))
            text << "standard error " << std::setprecision(2) << result.standard_errors[i]
                 << '\n';
          else
            text << "not determined, or at a bound (" << p.lower << ", " << p.upper
                 << ")\n";
        }
      const auto &quantities = measurements.quantities();
      std::vector<std::pair<std::string, bool>> headings;
      for (unsigned int k = 0; k < quantities.size(); ++k)
        {
          const bool tension     = quantities[k].kind == Quantity::Kind::tension;
          const std::string unit = tension ? "N/m" : parameters.stress_unit;
          text << "    " << quantities[k].name() << ": root mean square difference "
               << std::setprecision(4) << result.rms[k] / base::unit_in_cgs(unit) << ' '
               << unit << ", R^2 " << std::setprecision(5) << result.r_squared[k] << '\n';
          headings.emplace_back("measured " + quantities[k].name(), tension);
        }

      const Sample sample = make_sample(material, parameters);
      StateTable table(parameters,
                       parameters.output_folder + "/" + with_underscores(material.name) +
                         "_fit.csv",
                       headings);
      for (unsigned int line = 0; line < measurements.n_lines(); ++line)
        {
          std::vector<std::pair<double, bool>> measured;
          for (unsigned int k = 0; k < quantities.size(); ++k)
            measured.emplace_back(measurements.value(k, line),
                                  quantities[k].kind == Quantity::Kind::tension);
          table.write(measurements.state(sample, line), measured);
        }
      return text.str();
    }
  } // namespace


  AdjustableLaw::AdjustableLaw(const std::string &law, dealii::ParameterHandler &prm)
    : law_(structure::constitutive_laws<3>().create(law))
  {
    structure::constitutive_laws<3>().declare_parameters(law, constants);
    std::stringstream text;
    constants.print_parameters(text, dealii::ParameterHandler::ShortText);
    for (std::string line; std::getline(text, line);)
      {
        const auto begin  = line.find("set ");
        const auto equals = line.find('=');
        if (begin == std::string::npos || equals == std::string::npos)
          continue;
        std::string name = line.substr(begin + 4, equals - begin - 4);
        name.erase(name.find_last_not_of(' ') + 1);

        const std::string value = prm.get(name);
        constants.set(name, value);
        try
          {
            base::parse_number(value, name);
            number_names.push_back(name);
          }
        catch (const base::UserError &)
          {
            // A choice.
          }
      }
    law_->parse_parameters(constants);
  }


  double AdjustableLaw::get(const std::string &name) const
  {
    return constants.get_double(name);
  }


  void AdjustableLaw::set(const std::string &name, const double value)
  {
    constants.set(name, value);
    law_->parse_parameters(constants);
  }


  void BiaxialMaterial::declare_parameters(dealii::ParameterHandler &prm)
  {
    structure::Material<3>::declare_parameters(prm);
    prm.declare_entry("Fibre angles",
                      "0, 90",
                      dealii::Patterns::List(dealii::Patterns::Double(), 1, 2),
                      "Angles of the fibre families to direction 1, in the plane of the "
                      "sheet [degrees].");
    prm.enter_subsection("Fit");
    prm.declare_entry(
      "Measurements",
      "",
      base::InputFile(),
      "Table (CSV) to fit the law to, with columns such as 'stretch 1 "
      "[1]', 'stretch 2 [1]', 'Cauchy stress 11 [kPa]', 'first Piola "
      "stress 22 [kPa]', 'tension 11 [N/m]'. Without one of the stretches "
      "the test is uniaxial. Empty: nothing is fitted.");
    prm.declare_entry("Parameters",
                      "",
                      dealii::Patterns::Anything(),
                      "Names of the constants of the law to fit; their values in the "
                      "law's subsection are where the search starts.");
    prm.declare_entry("Lower bounds",
                      "",
                      dealii::Patterns::Anything(),
                      "One for each of the parameters, in their units. Parameters with "
                      "positive bounds are varied in their logarithms.");
    prm.declare_entry("Upper bounds",
                      "",
                      dealii::Patterns::Anything(),
                      "One for each of the parameters.");
    prm.declare_entry(
      "Tolerance",
      "1e-10",
      dealii::Patterns::Double(1e-15, 0.1),
      "Change of the parameters, relative to the distance of their bounds, "
      "at which the search ends.");
    prm.declare_entry("Maximum evaluations",
                      "20000",
                      dealii::Patterns::Integer(1),
                      "Evaluations of all stresses after which the search gives up.");
    prm.leave_subsection();
  }


  void BiaxialMaterial::parse_parameters(dealii::ParameterHandler &prm,
                                         const std::string &material_name)
  {
    name                   = material_name;
    const std::string what = "Material " + name;
    structure::Material<3> material;
    material.parse_parameters(prm, what);
    time_factor = material.time_factor;

    law_name = prm.get("Law");
    prm.enter_subsection(law_name);
    law = std::make_shared<AdjustableLaw>(law_name, prm);
    prm.leave_subsection();

    const std::vector<double> angles =
      base::parse_numbers(prm.get("Fibre angles"), what + ", Fibre angles");
    AssertThrow(angles.size() >= material.law->n_fibre_families(),
                base::UserError(what + ": the law '" + law_name + "' needs " +
                                std::to_string(material.law->n_fibre_families()) +
                                " \"Fibre angles\"; found '" + prm.get("Fibre angles") +
                                "'."));
    for (unsigned int f = 0; f < angles.size() && f < fibres.size(); ++f)
      {
        const double angle = angles[f] * dealii::numbers::PI / 180;
        fibres[f][0]       = std::cos(angle);
        fibres[f][1]       = std::sin(angle);
      }

    prm.enter_subsection("Fit");
    measurements_file                    = prm.get("Measurements");
    tolerance                            = prm.get_double("Tolerance");
    max_evaluations                      = prm.get_integer("Maximum evaluations");
    const std::vector<std::string> names = base::parse_names(prm.get("Parameters"));
    const auto bounds                    = [&](const std::string &entry) {
      const std::string place           = what + ", Fit, " + entry;
      const std::vector<double> numbers = prm.get(entry).empty()
                                                               ? std::vector<double>()
                                                               : base::parse_numbers(prm.get(entry), place);
      AssertThrow(numbers.size() == names.size(),
                  base::UserError(place + ": found " + std::to_string(numbers.size()) +
                                  " numbers for " + std::to_string(names.size()) +
                                  " parameters ('" + prm.get("Parameters") + "')."));
      return numbers;
    };
    const std::vector<double> lower = bounds("Lower bounds"),
                              upper = bounds("Upper bounds");
    for (unsigned int i = 0; i < names.size(); ++i)
      {
        const auto &known = law->numbers();
        AssertThrow(std::find(known.begin(), known.end(), names[i]) != known.end(),
                    base::UserError(what + ", Fit, Parameters: the law '" + law_name +
                                    "' has no constant '" + names[i] + "'. " +
                                    base::suggest_name(names[i], known)));
        free_parameters.push_back({names[i], law->get(names[i]), lower[i], upper[i]});
      }
    prm.leave_subsection();
    AssertThrow(measurements_file.empty() == free_parameters.empty(),
                base::UserError(what + ", Fit: \"Measurements\" is '" +
                                measurements_file + "' and \"Parameters\" names " +
                                std::to_string(names.size()) +
                                " constants; expected both or neither."));
  }


  void BiaxialParameters::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Output folder",
                      "biaxial",
                      dealii::Patterns::Anything(),
                      "Where the tables are written; it is made if need be.");
    prm.declare_entry(
      "Volume",
      "incompressible",
      dealii::Patterns::Selection("incompressible|compressible"),
      "'incompressible': det F = 1, with the pressure that frees the faces "
      "of the sheet of stress; 'compressible': the law's own, with the "
      "stretch through the thickness at which they are free.");
    prm.declare_entry(
      "Loadings",
      "equibiaxial",
      dealii::Patterns::MultipleSelection(loading_names),
      "How the sheet is stretched. 'strip biaxial 1' stretches direction 1 "
      "and holds direction 2; 'simple shear' moves direction 1 along 2.");
    prm.declare_entry("Smallest stretch",
                      "1",
                      dealii::Patterns::Double(0.1, 10),
                      "Stretch at which the tables begin.");
    prm.declare_entry("Largest stretch",
                      "1.2",
                      dealii::Patterns::Double(0.1, 10),
                      "Stretch at which the tables end.");
    prm.declare_entry("Largest shear",
                      "0.4",
                      dealii::Patterns::Double(0, 10),
                      "Amount of shear at which the table of simple shear ends.");
    prm.declare_entry(
      "Steps", "40", dealii::Patterns::Integer(1), "Number of steps of each table.");
    prm.declare_entry("Stress unit",
                      "kPa",
                      dealii::Patterns::Selection("dyn/cm^2|Pa|kPa|MPa|mmHg"),
                      "Unit of the stresses in the tables.");
    prm.declare_entry(
      "Thickness",
      "0",
      dealii::Patterns::Double(0),
      "Thickness of the undeformed sheet [cm]; if it is not 0, the tables "
      "have the tension, the force per length of the undeformed sheet.");
    prm.declare_entry("Time",
                      "0",
                      dealii::Patterns::Double(),
                      "Time at which time factors are taken [s].");
    for (const std::string &name :
         base::declare_names(prm,
                             "Materials",
                             "",
                             "Names of the materials; each is described in 'subsection "
                             "Material NAME'."))
      {
        prm.enter_subsection("Material " + name);
        BiaxialMaterial::declare_parameters(prm);
        prm.leave_subsection();
      }
  }


  void BiaxialParameters::parse_parameters(dealii::ParameterHandler &prm)
  {
    output_folder = prm.get("Output folder");
    stress_unit   = prm.get("Stress unit");
    loadings      = base::parse_names(prm.get("Loadings"));
    volume =
      prm.get("Volume") == "compressible" ? Volume::compressible : Volume::incompressible;
    thickness        = prm.get_double("Thickness");
    time             = prm.get_double("Time");
    smallest_stretch = prm.get_double("Smallest stretch");
    largest_stretch  = prm.get_double("Largest stretch");
    largest_shear    = prm.get_double("Largest shear");
    n_steps          = prm.get_integer("Steps");
    AssertThrow(smallest_stretch < largest_stretch,
                base::UserError("\"Smallest stretch\" is " + prm.get("Smallest stretch") +
                                " and \"Largest stretch\" " + prm.get("Largest stretch") +
                                "; expected a larger one."));

    materials.clear();
    for (const std::string &name : base::parse_names(prm.get("Materials")))
      {
        prm.enter_subsection("Material " + name);
        materials.emplace_back();
        materials.back().parse_parameters(prm, name);
        prm.leave_subsection();
      }
    AssertThrow(!materials.empty(),
                base::UserError("\"Materials\" names none; expected at least one."));
  }


  std::string BiaxialParameters::example()
  {
    return "set Materials = NAME\n";
  }


  std::string run_biaxial_test(const BiaxialParameters &parameters)
  {
    std::error_code error;
    std::filesystem::create_directories(parameters.output_folder, error);
    AssertThrow(!error,
                base::UserError("Cannot make the folder '" + parameters.output_folder +
                                "' that 'Output folder' names: " + error.message() +
                                "."));

    std::string summary;
    for (BiaxialMaterial material : parameters.materials)
      {
        if (!material.free_parameters.empty())
          summary += fit_material(material, parameters);

        const Sample sample = make_sample(material, parameters);
        for (const std::string &loading : parameters.loadings)
          {
            const std::string file = parameters.output_folder + "/" +
                                     with_underscores(material.name + "_" + loading) +
                                     ".csv";
            StateTable table(parameters, file);
            const bool shear   = loading == "simple shear";
            const double first = shear ? 0 : parameters.smallest_stretch,
                         last =
                           shear ? parameters.largest_shear : parameters.largest_stretch;
            try
              {
                for (unsigned int i = 0; i <= parameters.n_steps; ++i)
                  table.write(deform(
                    sample, loading, first + (last - first) * i / parameters.n_steps));
              }
            catch (const base::UserError &problem)
              {
                throw base::UserError("Material " + material.name + ", " + loading +
                                      ": " + problem.what());
              }
            summary += "Material " + material.name + ", " + loading + ": " + file + "\n";
          }
      }
    return summary;
  }
} // namespace mitre::biaxial
