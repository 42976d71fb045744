// Two materials fill half of a box each. Under F = diag(2, 1/2 (, 1)) neo-Hookean solids
// have the first principal stress 6 C1 (see structure/stress_and_strain_are_exact): 18
// with C1 = 3 in material 1, 36 with C1 = 6 in material 2. In the whole the mean is 27,
// the median 18 and the 51st percentile 36. Fibres along x are stretched by 2; those of
// half of the elements have none and do not count. One and two ranks agree.

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/instruments/instruments.h>

#include "../structure/structure_tests.h"

using namespace structure_tests;
namespace instruments = mitre::instruments;

template <int dim>
void
measure(const instruments::Observation<dim> &observation, const std::string &values)
{
  const bool root = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  dealii::ParameterHandler prm;
  mitre::base::parse_parameter_text(
    prm,
    "set Instruments = load\nsubsection Instrument load\n  set Type = stress and strain\n"
    "  set Part = box\n" +
      values + "end\n",
    "test.prm",
    [](dealii::ParameterHandler &p) {
      instruments::Instruments<dim>::declare_parameters(p);
    });
  try
    {
      instruments::Instruments<dim> list;
      list.parse_parameters(prm);
      const std::vector<std::string> columns = list.columns();
      const std::vector<double> result       = list.measure(observation);
      if (root)
        for (unsigned int i = 0; i < columns.size(); ++i)
          std::cout << columns[i] << ": " << result[i] << std::endl;
    }
  catch (const mitre::base::UserError &error)
    {
      if (root)
        std::cout << error.what() << std::endl;
    }
}

template <int dim>
void
check()
{
  Mesh<dim> mesh = make_box<dim>(ElementShape::simplex, 4, 0.);
  for (unsigned int e = 0; e < mesh.n_elements(); ++e)
    {
      mesh.fibres[0][e] = 0;
      if (mesh.material_ids[e] == 2)
        mesh.fibres[0][e][0] = 1;
    }
  BodyParameters<dim> parameters;
  parameters.name = "box";
  for (const unsigned int id : {1, 2})
    parameters.materials.push_back(
      {id == 1 ? "soft" : "stiff",
       {id},
       make_law<dim>("neo-Hookean", id == 1 ? "set C1 = 3" : "set C1 = 6"),
       mitre::base::TimeExpression("1", "factor")});
  const FiniteElementBody<dim> body(parameters, mesh, MPI_COMM_WORLD);
  std::vector<double> positions;
  for (const auto &s : mesh.nodes)
    for (unsigned int d = 0; d < dim; ++d)
      positions.push_back((d == 0 ? 2 : d == 1 ? 0.5 : 1) * s[d]);
  VectorType X;
  body.initialize_vector(X);
  body.from_mesh_order(positions, X);
  const instruments::Observation<dim> observation{0., 0., nullptr, {{&body, &X, &X}}};

  measure(observation,
          "  set Quantities = first principal stress, fibre stretch\n"
          "  set Percentile = 50\n");
  measure(observation,
          "  set Quantities = first principal stress\n  set Percentile = 51\n");
  measure(
    observation,
    "  set Quantities = first principal stress, J\n  set Materials = stiff, soft\n");
  measure(observation, "  set Materials = soft, hard\n");
  measure(observation, "  set Materials = soft\n  set Quantities = fibre stress\n");
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>();
  check<3>();
}
