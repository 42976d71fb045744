#include <deal.II/base/numbers.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/fibre_rule.h>

namespace mitre::structure
{
  namespace
  {
    const char *const surface_names[4] = {"Inner surface",
                                          "Outer surface",
                                          "Start surface",
                                          "End surface"};

    /// How many of these surfaces there are.
    template <int dim>
    constexpr unsigned int n_surfaces = dim == 2 ? 2 : 4;

    constexpr unsigned int invalid = dealii::numbers::invalid_unsigned_int;


    bool contains(const std::vector<int> &ids, const unsigned int id)
    {
      return std::find(ids.begin(), ids.end(), static_cast<int>(id)) != ids.end();
    }


    /// Some elements of a mesh with their nodes, as a mesh.
    template <int dim>
    Mesh<dim> extract(const Mesh<dim> &mesh, const std::vector<unsigned int> &elements)
    {
      Mesh<dim> part;
      part.source            = mesh.source;
      part.shape             = mesh.shape;
      part.degree            = mesh.degree;
      part.nodes_per_element = mesh.nodes_per_element;
      std::vector<unsigned int> number(mesh.nodes.size(), invalid);
      for (const unsigned int e : elements)
        {
          for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
            {
              const unsigned int node = mesh.elements[e * mesh.nodes_per_element + a];
              if (number[node] == invalid)
                {
                  number[node] = part.nodes.size();
                  part.nodes.push_back(mesh.nodes[node]);
                }
              part.elements.push_back(number[node]);
            }
          part.material_ids.push_back(mesh.material_ids[e]);
          part.element_tags.push_back(mesh.element_tags.empty() ? e
                                                                : mesh.element_tags[e]);
        }

      const unsigned int n = face_corners<dim>(mesh.shape)[0].size();
      for (unsigned int i = 0; i < mesh.boundary_ids.size(); ++i)
        {
          const auto begin = mesh.boundary_elements.begin() + i * n;
          if (std::any_of(begin, begin + n, [&](const unsigned int node) {
                return number[node] == invalid;
              }))
            continue;
          for (unsigned int k = 0; k < n; ++k)
            part.boundary_elements.push_back(number[*(begin + k)]);
          part.boundary_ids.push_back(mesh.boundary_ids[i]);
        }
      return part;
    }
  } // namespace


  template <int dim>
  std::vector<double> solve_laplace(const Mesh<dim> &mesh,
                                    const std::vector<unsigned int> &zero,
                                    const std::vector<unsigned int> &one)
  {
    const unsigned int n_nodes = mesh.nodes_per_element;
    const ReferenceElement<dim> element(mesh.shape, mesh.degree);
    const ShapeTable<dim> shape(element, element.force_quadrature());

    // Step 1: rows of nodes whose value is known are those of the identity.
    std::vector<bool> known(mesh.nodes.size(), false);
    dealii::Vector<double> solution(mesh.nodes.size()), rhs(mesh.nodes.size());
    for (const unsigned int node : zero)
      known[node] = true;
    for (const unsigned int node : one)
      {
        known[node]    = true;
        solution[node] = 1;
      }

    dealii::DynamicSparsityPattern dynamic_pattern(mesh.nodes.size());
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      for (unsigned int a = 0; a < n_nodes; ++a)
        for (unsigned int b = 0; b < n_nodes; ++b)
          dynamic_pattern.add(mesh.elements[e * n_nodes + a],
                              mesh.elements[e * n_nodes + b]);
    dealii::SparsityPattern pattern;
    pattern.copy_from(dynamic_pattern);
    dealii::SparseMatrix<double> matrix(pattern);

    // Step 2: the matrix and what the known values contribute to the right hand side.
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      for (unsigned int q = 0; q < shape.n_points; ++q)
        {
          const dealii::Tensor<2, dim> jacobian = shape.jacobian(mesh, e, q);
          const dealii::Tensor<2, dim> inverse  = invert(jacobian);
          const double JxW = determinant(jacobian) * shape.weights[q];
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (unsigned int b = 0; b < n_nodes; ++b)
              {
                const unsigned int row    = mesh.elements[e * n_nodes + a];
                const unsigned int column = mesh.elements[e * n_nodes + b];
                const double entry = JxW * (shape.gradients[q * n_nodes + a] * inverse) *
                                     (shape.gradients[q * n_nodes + b] * inverse);
                if (known[row])
                  continue;
                if (known[column])
                  rhs[row] -= entry * solution[column];
                else
                  matrix.add(row, column, entry);
              }
        }
    for (unsigned int i = 0; i < mesh.nodes.size(); ++i)
      if (known[i])
        {
          matrix.set(i, i, 1);
          rhs[i] = solution[i];
        }

    // Step 3: solve.
    dealii::SolverControl control(10000, 1e-10 * std::max(rhs.l2_norm(), 1e-300));
    dealii::SolverCG<dealii::Vector<double>> solver(control);
    dealii::PreconditionSSOR<dealii::SparseMatrix<double>> preconditioner;
    preconditioner.initialize(matrix, 1.2);
    solver.solve(matrix, solution, rhs, preconditioner);
    return std::vector<double>(solution.begin(), solution.end());
  }


  template <int dim>
  void FibreRule<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Fibres",
                      "from mesh",
                      dealii::Patterns::Selection("from mesh|by rule"),
                      "Where fibre directions come from: the mesh file, or the rule of "
                      "'subsection Fibre rule'.");
    prm.enter_subsection("Fibre rule");
    prm.declare_entry("Material ids",
                      "",
                      dealii::Patterns::List(dealii::Patterns::Integer(0)),
                      "Elements with these ids get their directions by the rule; empty: "
                      "all.");
    prm.declare_entry("Inner angle",
                      "0",
                      dealii::Patterns::Double(-90, 90),
                      "From the circumferential towards the longitudinal direction, at "
                      "the inner surface [degrees]; 0 in 2D.");
    prm.declare_entry("Outer angle",
                      "0",
                      dealii::Patterns::Double(-90, 90),
                      "The same at the outer surface [degrees]; linear in between.");
    prm.declare_entry(
      "Second family",
      "none",
      dealii::Patterns::Selection("none|mirrored|transmural"),
      "A second family of fibres: none, one at the opposite angle, or one "
      "across the wall.");
    for (unsigned int s = 0; s < n_surfaces<dim>; ++s)
      {
        prm.enter_subsection(surface_names[s]);
        SurfaceRegion<dim>::declare_parameters(prm);
        prm.declare_entry(
          "Adjacent material ids",
          "",
          dealii::Patterns::List(dealii::Patterns::Integer(0)),
          "If given, the surface consists of the nodes that elements with "
          "these ids share with those of the rule, and the entries above "
          "are without effect.");
        prm.leave_subsection();
      }
    prm.leave_subsection();
  }


  template <int dim>
  void FibreRule<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                        const std::string &part)
  {
    what   = part + ", fibre rule";
    active = prm.get("Fibres") == "by rule";
    surfaces.clear();
    if (!active)
      return;

    prm.enter_subsection("Fibre rule");
    material_ids = base::parse_integers(prm.get("Material ids"), what + ", Material ids");
    inner_angle  = prm.get_double("Inner angle") * dealii::numbers::PI / 180;
    outer_angle  = prm.get_double("Outer angle") * dealii::numbers::PI / 180;
    AssertThrow(dim == 3 || (inner_angle == 0 && outer_angle == 0),
                base::UserError(what + ": the angles are " + prm.get("Inner angle") +
                                " and " + prm.get("Outer angle") +
                                "; in 2D they must be 0."));
    const std::string family = prm.get("Second family");
    second                   = family == "mirrored"     ? SecondFamily::mirrored
                               : family == "transmural" ? SecondFamily::transmural
                                                        : SecondFamily::none;
    for (unsigned int s = 0; s < n_surfaces<dim>; ++s)
      {
        const std::string name = surface_names[s];
        prm.enter_subsection(name);
        Surface surface;
        surface.name = name;
        surface.region.parse_parameters(prm, what + ", " + name);
        surface.adjacent_ids =
          base::parse_integers(prm.get("Adjacent material ids"),
                               what + ", " + name + ", Adjacent material ids");
        surfaces.push_back(surface);
        prm.leave_subsection();
      }
    prm.leave_subsection();
  }


  template <int dim>
  std::vector<unsigned int>
  FibreRule<dim>::find_nodes(Surface &surface,
                             const Mesh<dim> &mesh,
                             const std::vector<unsigned int> &elements,
                             const Mesh<dim> &part) const
  {
    std::vector<unsigned int> nodes;
    if (surface.adjacent_ids.empty())
      {
        surface.region.initialize(part);
        nodes = surface.region.find_nodes(part);
      }
    else
      {
        std::vector<bool> shared(mesh.nodes.size(), false);
        for (unsigned int e = 0; e < mesh.n_elements(); ++e)
          if (contains(surface.adjacent_ids, mesh.material_ids[e]))
            for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
              shared[mesh.elements[e * mesh.nodes_per_element + a]] = true;
        for (unsigned int i = 0; i < elements.size(); ++i)
          for (unsigned int a = 0; a < mesh.nodes_per_element; ++a)
            if (shared[mesh.elements[elements[i] * mesh.nodes_per_element + a]])
              nodes.push_back(part.elements[i * mesh.nodes_per_element + a]);
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      }
    AssertThrow(!nodes.empty(),
                base::UserError(what + ": no node of " + mesh.source + " is on the " +
                                surface.name + "."));
    return nodes;
  }


  template <int dim>
  Mesh<dim> FibreRule<dim>::apply(Mesh<dim> mesh)
  {
    if (!active)
      return mesh;

    // Step 1: the elements of the rule.
    std::vector<unsigned int> elements;
    for (unsigned int e = 0; e < mesh.n_elements(); ++e)
      if (material_ids.empty() || contains(material_ids, mesh.material_ids[e]))
        elements.push_back(e);
    AssertThrow(!elements.empty(),
                base::UserError(what + ": no element of " + mesh.source +
                                " has one of its material ids."));
    const Mesh<dim> part = extract(mesh, elements);

    // Step 2: the potentials.
    std::vector<std::vector<double>> potentials;
    for (unsigned int s = 0; s < n_surfaces<dim>; s += 2)
      {
        const std::vector<unsigned int> zero =
          find_nodes(surfaces[s], mesh, elements, part);
        const std::vector<unsigned int> one =
          find_nodes(surfaces[s + 1], mesh, elements, part);
        std::vector<unsigned int> both;
        std::set_intersection(
          zero.begin(), zero.end(), one.begin(), one.end(), std::back_inserter(both));
        AssertThrow(both.empty(),
                    base::UserError(what + ": the node at " +
                                    to_string(part.nodes[both.front()]) + " of " +
                                    mesh.source + " is on the " + surfaces[s].name +
                                    " and on the " + surfaces[s + 1].name +
                                    "; expected are surfaces that do not touch."));
        potentials.push_back(solve_laplace(part, zero, one));
      }

    // Step 3: directions in the middle of each element.
    const unsigned int n_nodes = mesh.nodes_per_element;
    const ReferenceElement<dim> element(mesh.shape, mesh.degree);
    dealii::Point<dim> middle;
    for (unsigned int d = 0; d < dim; ++d)
      middle[d] = mesh.shape == ElementShape::simplex ? 1. / (dim + 1) : 0.5;
    const ShapeTable<dim> shape(element, dealii::Quadrature<dim>(middle));
    const unsigned int n_families = second == SecondFamily::none ? 1 : 2;
    for (unsigned int f = 0; f < n_families; ++f)
      mesh.fibres[f].resize(mesh.n_elements());

    for (unsigned int i = 0; i < elements.size(); ++i)
      {
        const dealii::Tensor<2, dim> inverse = invert(shape.jacobian(part, i, 0));
        const auto fail                      = [&](const std::string &surface) {
          throw base::UserError(what + ": the potential that rises from the " + surface +
                                " is constant in the " +
                                mesh.describe_element(elements[i]) + " at " +
                                to_string(part.centroid(i)) + ".");
        };
        const auto gradient = [&](const unsigned int potential) {
          dealii::Tensor<1, dim> sum;
          for (unsigned int a = 0; a < n_nodes; ++a)
            sum += potentials[potential][part.elements[i * n_nodes + a]] *
                   (shape.gradients[a] * inverse);
          return sum;
        };
        double phi = 0;
        for (unsigned int a = 0; a < n_nodes; ++a)
          phi += potentials[0][part.elements[i * n_nodes + a]] * shape.values[a];

        dealii::Tensor<1, dim> across = gradient(0);
        if (!(across.norm() > 1e-12))
          fail(surfaces[0].name);
        across /= across.norm();

        dealii::Tensor<1, dim> fibre, mirrored;
        if constexpr (dim == 2)
          fibre = mirrored = cross_product_2d(across);
        else
          {
            dealii::Tensor<1, dim> along = gradient(1);
            const double length          = along.norm();
            along -= (along * across) * across;
            if (!(along.norm() > 1e-6 * length))
              fail(surfaces[2].name);
            along /= along.norm();
            const dealii::Tensor<1, dim> around = cross_product_3d(along, across);
            const double angle = (1 - phi) * inner_angle + phi * outer_angle;
            fibre              = std::cos(angle) * around + std::sin(angle) * along;
            mirrored           = std::cos(angle) * around - std::sin(angle) * along;
          }
        mesh.fibres[0][elements[i]] = fibre;
        if (n_families == 2)
          mesh.fibres[1][elements[i]] =
            second == SecondFamily::transmural ? across : mirrored;
      }
    return mesh;
  }


  template std::vector<double> solve_laplace(const Mesh<2> &,
                                             const std::vector<unsigned int> &,
                                             const std::vector<unsigned int> &);
  template std::vector<double> solve_laplace(const Mesh<3> &,
                                             const std::vector<unsigned int> &,
                                             const std::vector<unsigned int> &);
  template class FibreRule<2>;
  template class FibreRule<3>;
} // namespace mitre::structure
