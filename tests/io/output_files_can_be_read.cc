// Frames of a linear velocity and pressure on a grid of two levels, and of a deformed
// cube, are read back from the files: the collections list two frames, the pieces have
// all cells of the grid between them, and in every corner of a cell are the velocity and
// the pressure at its place, for the means from which they follow are exact for linear
// functions, across levels and up to the boundary too (to the precision of 32-bit
// numbers, 1e-6 of the largest value); only the velocity near the edges of a box is not,
// for walls are not known beyond their ends. The cells of the part are in
// VTK's order, in which they have a positive volume; they add up to the cube's, 1.5 times
// the reference volume. All fields of stress and strain are there, with their units, and
// are those of the elements; in the plain material under F = diag(2, 3/4 (, 1)), C1 = 2
// and kappa = 7, sigma = (2 C1 (F F^T - I) + kappa ln J I)/J = diag(9.892170, 0.725504
// (, 1.892170)).

#include <filesystem>
#include <iostream>

#include <mitre/io/output.h>

#include "../structure/structure_tests.h"
#include "io_tests.h"
#include "vtu_file.h"

using namespace io_tests;

/// The volume of a cell of a file, from parallelepipeds; 0 if it is none.
double
cell_volume(const vtu::File &file, const unsigned int cell)
{
  const auto &x       = file.arrays.at("position");
  const auto &nodes   = file.arrays.at("connectivity");
  const auto &offsets = file.arrays.at("offsets");
  const int type      = static_cast<int>(file.arrays.at("types")[cell]);
  const size_t first  = cell == 0 ? 0 : offsets[cell - 1];

  const auto corner = [&](const unsigned int i) {
    const size_t node = nodes[first + i];
    return Point<3>(x[3 * node], x[3 * node + 1], x[3 * node + 2]);
  };
  const auto volume =
    [&](const unsigned int i, const unsigned int j, const unsigned int k) {
      return cross_product_3d(corner(i) - corner(0), corner(j) - corner(0)) *
             (corner(k) - corner(0));
    };
  const auto area = [&](const unsigned int i, const unsigned int j) {
    return cross_product_3d(corner(i) - corner(0), corner(j) - corner(0))[2];
  };
  switch (type)
    {
      case 5: // triangle
        return area(1, 2) / 2.;
      case 9: // quadrilateral, around
        return area(1, 2) / 2. + area(2, 3) / 2.;
      case 10: // tetrahedron
        return volume(1, 2, 3) / 6.;
      case 12: // hexahedron: around the bottom, then around the top
        return std::abs(volume(1, 3, 4) - volume(2, 3, 6)) < 1e-5 ? volume(1, 3, 4) : 0.;
      default:
        return 0.;
    }
}

template <int dim>
void
check_fluid(const Case<dim> &flow, const std::string &folder)
{
  std::vector<std::string> frames =
    vtu::attributes(vtu::read_text(folder + "/fluid.pvd"), "file");
  std::cout << "frames:";
  for (const std::string &frame : frames)
    std::cout << ' ' << frame;
  std::cout << "\ntimes:";
  for (const std::string &time :
       vtu::attributes(vtu::read_text(folder + "/fluid.pvd"), "timestep"))
    std::cout << ' ' << time;
  const std::string record = vtu::read_text(folder + "/" + frames.back());
  std::cout << "\nfields:";
  for (const std::string &name : vtu::attributes(record, "Name"))
    std::cout << " '" << name << "'";
  std::cout << std::endl;

  std::size_t n_cells   = 0;
  double worst_velocity = 0., worst_pressure = 0., worst_level = 0.;
  for (const std::string &piece : vtu::attributes(record, "Source"))
    {
      const vtu::File file(folder + "/" + piece);
      n_cells += file.n_cells;
      const auto &x = file.arrays.at("position"), &u = file.arrays.at("velocity");
      const auto &p = file.arrays.at("pressure [mmHg]"), &level = file.arrays.at("level");
      for (std::size_t i = 0; i < file.n_points; ++i)
        {
          Point<dim> place;
          for (unsigned int d = 0; d < dim; ++d)
            place[d] = x[3 * i + d];
          unsigned int n_walls = 0;
          for (unsigned int d = 0; d < dim; ++d)
            n_walls += place[d] < 0.07 || place[d] > (d == 0 ? 1.93 : 0.93) ? 1 : 0;
          for (unsigned int c = 0; c < dim && (dim == 2 || n_walls < 2); ++c)
            worst_velocity =
              std::max(worst_velocity, std::abs(u[3 * i + c] - velocity(place, c)));
          worst_pressure = std::max(worst_pressure, std::abs(p[i] - pressure(place)));
          if (place[1] > 0.51 || std::abs(place[0] - 1.) > 0.51)
            worst_level = std::max(worst_level, std::abs(level[i] - 1.));
          if (place[1] < 0.49 && std::abs(place[0] - 1.) < 0.49)
            worst_level = std::max(worst_level, std::abs(level[i] - 2.));
        }
    }
  std::cout << "cells: "
            << (n_cells == flow.patch_grid.n_global_cells() ? "all" : "FAILED") << ' '
            << n_cells << "\nvelocity: " << structure_tests::below(worst_velocity, 1e-5)
            << "\npressure: " << structure_tests::below(worst_pressure, 1e-4)
            << "\nlevel: " << structure_tests::below(worst_level, 1e-10) << std::endl;
}

/// Whether the file has the values of each quantity of stress and strain.
template <int dim>
void
check_stress(const vtu::File &file, const std::vector<std::vector<double>> &wanted)
{
  double worst        = 0.;
  unsigned int number = 0;
  for (const auto &quantity : structure::stress_quantities<dim>())
    {
      const auto field = file.arrays.find(
        quantity.name + (quantity.unit.empty() ? "" : " [" + quantity.unit + "]"));
      const std::vector<double> &values = wanted[number++];
      if (field == file.arrays.end() || field->second.size() != values.size() ||
          values.size() != file.n_cells * quantity.n_components)
        {
          std::cout << "FAILED: " << quantity.name << std::endl;
          continue;
        }
      for (std::size_t i = 0; i < values.size(); ++i)
        worst = std::max(worst,
                         std::abs(field->second[i] - values[i]) /
                           std::max(1., std::abs(values[i])));
    }
  std::cout << number << " stresses and strains: " << structure_tests::below(worst, 1e-6)
            << std::endl;

  const std::array<double, 3> stress{{9.892170, 0.725504, 1.892170}};
  worst = 0.;
  for (unsigned int cell = 0; cell < file.n_cells; ++cell)
    if (file.arrays.at("material id")[cell] == 2.)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          worst = std::max(
            worst,
            std::abs(file.arrays.at("Cauchy stress [dyn/cm^2]")[9 * cell + 3 * i + j] -
                     (i == j ? stress[i] : 0.)));
  std::cout << "Cauchy stress: " << structure_tests::below(worst, 1e-5) << std::endl;
}

template <int dim>
void
check_part(const std::string &folder,
           const std::string &name,
           const std::vector<std::vector<double>> &stress)
{
  const std::vector<std::string> frames =
    vtu::attributes(vtu::read_text(folder + "/" + name + ".pvd"), "file");
  const vtu::File file(folder + "/" + frames.back());
  const auto &x = file.arrays.at("position");
  const auto &s = file.arrays.at("displacement"), &v = file.arrays.at("velocity");

  double volume = 0., smallest = 1., worst_J = 0., worst_place = 0.;
  unsigned int first_material = 0;
  for (unsigned int cell = 0; cell < file.n_cells; ++cell)
    {
      volume += cell_volume(file, cell);
      smallest = std::min(smallest, cell_volume(file, cell));
      worst_J  = std::max(worst_J, std::abs(file.arrays.at("J")[cell] - 1.5));
      first_material += file.arrays.at("material id")[cell] == 1. ? 1 : 0;
    }
  // X = 0.5 + 2 s_0 (or 0.75 s_1, or s_2) and U = 3 X, so that s + displacement = X says
  // s_0 = (X_0 - 0.5) / 2 and so on.
  const std::array<double, 3> stretch{{2., 0.75, 1.}};
  for (unsigned int i = 0; i < file.n_points; ++i)
    for (unsigned int d = 0; d < 3; ++d)
      {
        const double X         = x[3 * i + d];
        const double reference = d < dim ? (X - 0.5) / stretch[d] : 0.;
        worst_place = std::max(worst_place, std::abs(X - s[3 * i + d] - reference));
        worst_place = std::max(worst_place, std::abs(3. * X - v[3 * i + d]));
      }
  std::cout << name << ": " << frames.size() << " frame(s), " << file.n_points
            << " nodes, " << file.n_cells << " elements, " << first_material
            << " of material 1\nvolume: "
            << structure_tests::below(std::abs(volume - 1.5), 1e-5)
            << (smallest > 0. ? ", all positive" : ", FAILED: some not positive")
            << "\nJ: " << structure_tests::below(worst_J, 1e-5)
            << "\nfields: " << structure_tests::below(worst_place, 1e-5) << std::endl;
  check_stress<dim>(file, stress);
}

template <int dim>
void
test()
{
  const bool prints     = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  const std::string run = "run_" + std::to_string(dim);
  if (prints)
    std::cout << dim << "D" << std::endl;

  const Case<dim> flow;
  io::OutputWriter<dim> writer(run, MPI_COMM_WORLD);
  for (const double time : {0., 0.125})
    writer.write_fluid(
      *flow.space, flow.u, flow.p, time, [](const grid::BoundaryTerm<dim> &term) {
        return velocity(term.x, term.component);
      });

  structure::BodyParameters<dim> parameters = structure_tests::make_parameters<dim>();
  for (const auto &quantity : structure::stress_quantities<dim>())
    parameters.element_fields.push_back(quantity.name);
  std::vector<std::vector<std::vector<double>>> stresses;
  for (const auto shape :
       {structure::ElementShape::simplex, structure::ElementShape::hypercube})
    {
      parameters.name = structure_tests::shape_name(dim, shape);
      const structure::FiniteElementBody<dim> body(
        parameters, structure_tests::make_box<dim>(shape, 4, 0.), MPI_COMM_WORLD);
      std::vector<double> values;
      for (const Point<dim> &s : body.mesh().nodes)
        for (unsigned int d = 0; d < dim; ++d)
          values.push_back(0.5 + (d == 0 ? 2. : d == 1 ? 0.75 : 1.) * s[d]);
      structure::VectorType X, U;
      body.initialize_vector(X);
      body.initialize_vector(U);
      body.from_mesh_order(values, X);
      U.equ(3., X);
      writer.write_part(body, X, U, 0.);
      stresses.push_back(body.compute_element_fields(parameters.element_fields, X, 0.));
    }

  if (prints)
    {
      check_fluid(flow, run + "/output");
      check_part<dim>(run + "/output",
                      structure_tests::shape_name(dim, structure::ElementShape::simplex),
                      stresses[0]);
      check_part<dim>(
        run + "/output",
        structure_tests::shape_name(dim, structure::ElementShape::hypercube),
        stresses[1]);
      for (const auto &entry : std::filesystem::directory_iterator(run + "/output"))
        if (entry.path().extension() == ".tmp")
          std::cout << "FAILED: " << entry.path() << " is left" << std::endl;
    }
}

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}
