#ifndef mitre_biaxial_biaxial_test_h
#define mitre_biaxial_biaxial_test_h

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

#include <mitre/biaxial/fit.h>
#include <mitre/biaxial/sample.h>
#include <mitre/structure/material.h>

namespace mitre::biaxial
{
  /**
   * A law whose constants can be changed by name.
   */
  class AdjustableLaw
  {
  public:
    /// The constants of @p law in the subsection of @p prm that has been entered.
    AdjustableLaw(const std::string &law, dealii::ParameterHandler &prm);

    /// Names of the constants that are numbers.
    const std::vector<std::string> &numbers() const
    {
      return number_names;
    }

    double get(const std::string &name) const;

    void set(const std::string &name, const double value);

    const structure::ConstitutiveLaw<3> &law() const
    {
      return *law_;
    }

  private:
    dealii::ParameterHandler constants;
    std::vector<std::string> number_names;
    std::unique_ptr<structure::ConstitutiveLaw<3>> law_;
  };


  /**
   * A material, its fibres, and what is to be fitted.
   */
  struct BiaxialMaterial
  {
    std::string name, law_name;
    std::shared_ptr<AdjustableLaw> law;
    structure::StiffnessFactor time_factor;
    structure::Fibres<3> fibres;

    /// Empty if there is nothing to fit.
    std::string measurements_file;
    std::vector<FreeParameter> free_parameters;
    double tolerance             = 1e-10;
    unsigned int max_evaluations = 20000;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm, const std::string &name);
  };


  /**
   * What a parameter file of mitre-biaxial says.
   */
  struct BiaxialParameters
  {
    std::string output_folder, stress_unit;
    std::vector<BiaxialMaterial> materials;
    std::vector<std::string> loadings;
    Volume volume           = Volume::incompressible;
    double thickness        = 0;
    double time             = 0;
    double smallest_stretch = 1, largest_stretch = 1.2, largest_shear = 0.4;
    unsigned int n_steps = 40;

    static void declare_parameters(dealii::ParameterHandler &prm);

    void parse_parameters(dealii::ParameterHandler &prm);

    /// A parameter file in which there is one of everything, for the parameter reference.
    static std::string example();
  };


  /**
   * Fit what is to be fitted, then write the stresses of each material in each loading to
   * MATERIAL_LOADING.csv, and the measurements beside the fit to MATERIAL_fit.csv, in the
   * output folder. Returns a summary. Throws base::UserError.
   */
  std::string run_biaxial_test(const BiaxialParameters &parameters);
} // namespace mitre::biaxial

#endif
