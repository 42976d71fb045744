// A body on all ranks, its nodes dealt out in an irregular way after positions were set,
// has the force density, energy, totals and largest displacement of the same body on one
// rank: exactly the same elastic forces, because each node's sum is taken in the same
// order, and densities to the tolerance of the mass solve (1e-13 here).

#include "structure_tests.h"

using namespace structure_tests;

template <int dim>
void
check(const ElementShape shape)
{
  BodyParameters<dim> parameters = make_parameters<dim>();
  parameters.mass_tolerance      = 1e-13;

  dealii::ParameterHandler prm;
  constraints<dim>().declare_parameters("tether", prm);
  prm.parse_input_from_string("set Region = x < 0.4\n"
                              "set Stiffness = 50\n"
                              "set Damping = 3\n");

  const auto make = [&](const MPI_Comm communicator) {
    BodyParameters<dim> p = parameters;
    p.constraints.push_back({"hold", constraints<dim>().create("tether")});
    p.constraints.back().constraint->parse_parameters(prm, "hold");
    return std::make_unique<FiniteElementBody<dim>>(
      p, make_box<dim>(shape, 4), communicator);
  };
  const auto alone = make(MPI_COMM_SELF), together = make(MPI_COMM_WORLD);

  const auto evaluate = [&](FiniteElementBody<dim> &body) {
    VectorType X, U, G, F;
    for (VectorType *v : {&X, &U})
      body.initialize_vector(*v);
    set_positions(body, X);
    U = X;
    U *= 0.3;

    const unsigned int n_ranks =
      dealii::Utilities::MPI::n_mpi_processes(body.communicator());
    body.distribute(
      [&](const std::vector<dealii::Point<dim>> &points) {
        std::vector<unsigned int> owners;
        for (const dealii::Point<dim> &x : points)
          owners.push_back((x[0] + 0.3 * std::sin(9 * x[1]) > 0.5 ? 1 : 0) % n_ranks);
        return owners;
      },
      X,
      {&U});
    body.initialize_vector(G);
    body.initialize_vector(F);

    std::vector<std::vector<double>> results;
    const double t = 0.25;
    body.compute_elastic_force(X, t, G);
    results.push_back(body.to_mesh_order(G));
    body.compute_force_density(X, U, t, F);
    results.push_back(body.to_mesh_order(F));
    const dealii::Tensor<1, dim> total = body.compute_total(F);
    results.push_back({body.compute_elastic_energy(X, t),
                       body.compute_constraint_displacements(X, t)[0],
                       body.compute_volume_ratios(X).first,
                       body.compute_volume_ratios(X).second});
    for (unsigned int d = 0; d < dim; ++d)
      results.back().push_back(total[d]);
    return results;
  };
  const auto a = evaluate(*alone), b = evaluate(*together);

  std::vector<double> differences;
  for (unsigned int k = 0; k < a.size(); ++k)
    {
      double difference = 0, largest = 0;
      for (unsigned int i = 0; i < a[k].size(); ++i)
        {
          difference = std::max(difference, std::abs(a[k][i] - b[k][i]));
          largest    = std::max(largest, std::abs(a[k][i]));
        }
      differences.push_back(difference / largest);
    }
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << shape_name(dim, shape) << ": elastic forces "
              << (differences[0] == 0 ? "equal" : "differ") << ", densities "
              << below(differences[1], 1e-11) << ", sums " << below(differences[2], 1e-12)
              << std::endl;
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(ElementShape::simplex);
  check<2>(ElementShape::hypercube);
  check<3>(ElementShape::simplex);
  check<3>(ElementShape::hypercube);
}
