#ifndef mitre_structure_material_h
#define mitre_structure_material_h

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

#include <mitre/base/expression.h>
#include <mitre/base/time_table.h>
#include <mitre/structure/constitutive_laws/constitutive_law.h>

namespace mitre::structure
{
  /**
   * What multiplies energy and stress of a material over time, whatever its law: an
   * expression of t [s] or a column of a time table. By default 1.
   */
  class StiffnessFactor
  {
  public:
    StiffnessFactor();

    StiffnessFactor(base::TimeExpression expression);

    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what the material, for messages. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);

    double value(const double t) const;

  private:
    base::TimeExpression expression;

    /// Takes the place of the expression if there is one.
    std::shared_ptr<const base::TimeTable> table;

    unsigned int column = 0;
  };


  /**
   * What the elements with some material ids are made of.
   */
  template <int dim>
  struct Material
  {
    std::string name;
    std::vector<unsigned int> ids;
    std::shared_ptr<ConstitutiveLaw<dim>> law;

    /// Multiplies energy and stress.
    StiffnessFactor time_factor;

    /// Declare the law, its constants and the time factor, not the ids, in the subsection
    /// of the material.
    static void declare_parameters(dealii::ParameterHandler &prm);

    /// @param what the material, for messages. Throws base::UserError, which names it.
    void parse_parameters(dealii::ParameterHandler &prm, const std::string &what);
  };
} // namespace mitre::structure

#endif
