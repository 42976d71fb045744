// A forest that has been refined and coarsened here and there, and divided among ranks by
// uneven weights, is made again from the list of its leaves: the same patches in the same
// order on the same ranks. So is one without a partition, up to the ranks; a list with a
// hole is an error.

#include "grid_tests.h"

using namespace grid_tests;

template <int dim>
void
check(const unsigned int n_balls)
{
  auto parameters = unit_box<dim>(16, 3, "x");
  for (unsigned int d = 0; d < dim; ++d)
    parameters.base_patches[d] = d + 1;
  grid::PatchGrid<dim> original(MPI_COMM_WORLD, parameters);
  original.extra_weight = [](const BoundingBox<dim> &leaf) {
    return leaf.get_boundary_points().first[0] < 0.5 ? 7000u : 0u;
  };
  for (unsigned int ball = 0; ball < n_balls; ++ball)
    {
      Point<dim> center;
      for (unsigned int d = 0; d < dim; ++d)
        center[d] = 0.2 + 0.15 * ball;
      original.adapt(refine_ball<dim>(original, center, 0.1));
    }

  std::vector<grid::Leaf> leaves;
  std::vector<unsigned int> owners;
  const auto all = Utilities::MPI::all_gather(MPI_COMM_WORLD, [&]() {
    std::vector<int> numbers;
    for (const grid::Leaf &leaf : original.owned_leaves())
      numbers.insert(numbers.end(),
                     {leaf.level, leaf.index[0], leaf.index[1], leaf.index[2]});
    return numbers;
  }());
  for (unsigned int r = 0; r < all.size(); ++r)
    for (unsigned int i = 0; i < all[r].size(); i += 4)
      {
        leaves.push_back({all[r][i], {{all[r][i + 1], all[r][i + 2], all[r][i + 3]}}});
        owners.push_back(r);
      }

  grid::PatchGrid<dim> again(MPI_COMM_WORLD, parameters);
  const bool exact = again.set_leaves(leaves, owners);
  bool same        = exact && again.n_local_patches() == original.n_local_patches() &&
              again.n_owned_patches() == original.n_owned_patches();
  for (unsigned int p = 0; same && p < again.n_local_patches(); ++p)
    same = again.patch(p).level == original.patch(p).level &&
           again.patch(p).index == original.patch(p).index &&
           again.patch(p).global_id == original.patch(p).global_id;
  out() << dim << " dimensions, " << n_balls << " changes, " << leaves.size()
        << " leaves: "
        << (Utilities::MPI::min(same ? 1 : 0, MPI_COMM_WORLD) == 1 ? "the same"
                                                                   : "FAILED")
        << std::endl;

  grid::PatchGrid<dim> anywhere(MPI_COMM_WORLD, parameters);
  anywhere.set_leaves(leaves);
  unsigned int n_found = 0;
  for (const grid::Leaf &leaf : anywhere.owned_leaves())
    for (const grid::Leaf &other : leaves)
      n_found += leaf.level == other.level && leaf.index == other.index;
  out() << "without a partition: "
        << Utilities::MPI::sum(n_found, MPI_COMM_WORLD) - leaves.size()
        << " leaves too many or too few" << std::endl;

  std::size_t finest = 0;
  while (leaves[finest].level < static_cast<int>(parameters.maximum_level))
    ++finest;
  leaves.erase(leaves.begin() + finest);
  grid::PatchGrid<dim> broken(MPI_COMM_WORLD, parameters);
  try
    {
      broken.set_leaves(leaves);
      out() << "FAILED: no error" << std::endl;
    }
  catch (const ExcMessage &)
    {
      out() << "with a hole: error" << std::endl;
    }
}

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check<2>(1);
  check<2>(4);
  check<3>(1);
  check<3>(3);
}
