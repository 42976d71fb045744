#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/body.h>
#include <mitre/structure/constitutive_laws/volumetric_part.h>
#include <mitre/structure/library.h>

namespace mitre::structure
{
  template <int dim>
  void declare_constraints(dealii::ParameterHandler &prm)
  {
    for (const std::string &name :
         base::declare_names(prm,
                             "Constraints",
                             "",
                             "Names of the constraints; each is described in 'subsection "
                             "Constraint NAME'."))
      {
        prm.enter_subsection("Constraint " + name);
        const std::string type = base::declare_choice(
          prm,
          "Type",
          structure::constraints<dim>().names().front(),
          structure::constraints<dim>().names(),
          "Kind of constraint.\n" + structure::constraints<dim>().help());
        structure::constraints<dim>().declare_parameters(type, prm);
        prm.leave_subsection();
      }
  }


  template <int dim>
  std::vector<NamedConstraint<dim>> parse_constraints(dealii::ParameterHandler &prm,
                                                      const std::string &part)
  {
    std::vector<NamedConstraint<dim>> constraints;
    for (const std::string &constraint_name : base::parse_names(prm.get("Constraints")))
      {
        const std::string what = "Part " + part + ", constraint " + constraint_name;

        prm.enter_subsection("Constraint " + constraint_name);
        constraints.push_back(
          {constraint_name, structure::constraints<dim>().create(prm.get("Type"))});
        constraints.back().constraint->parse_parameters(prm, what);
        prm.leave_subsection();
      }
    return constraints;
  }


  template <int dim>
  void BodyParameters<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Mesh file",
                      "",
                      base::InputFile(),
                      "Mesh of the part in its reference configuration [cm], as gmsh "
                      "writes it (.msh, ASCII), elements of one shape: tetrahedra or "
                      "hexahedra, in 2D triangles or quadrilaterals.");
    prm.declare_entry("Mass matrix",
                      "consistent",
                      dealii::Patterns::Selection("consistent|lumped"),
                      "Matrix of the L2 projections of forces and velocities.");
    prm.declare_entry("Mass solver tolerance",
                      "1e-10",
                      dealii::Patterns::Double(1e-15, 1e-2),
                      "Residual at which the solution with the consistent mass matrix "
                      "stops, relative to the right hand side.");
    prm.declare_entry(
      "Rigid",
      "false",
      dealii::Patterns::Bool(),
      "The part is always where its constraints, which must hold all of its nodes, want "
      "it to be. They pull by as much as the part would have moved with the fluid "
      "(virtual boundary method, Goldstein, Handler and Sirovich 1993). It has no "
      "materials.");
    FibreRule<dim>::declare_parameters(prm);
    std::string names, list;
    for (const StressQuantity<dim> &quantity : stress_quantities<dim>())
      {
        names += (names.empty() ? "" : "|") + quantity.name;
        list += (list.empty() ? "" : ", ") + quantity.name +
                (quantity.unit.empty() ? "" : " [" + quantity.unit + "]");
      }
    prm.declare_entry(
      "Element fields",
      "",
      dealii::Patterns::MultipleSelection(names),
      "Fields of stress and strain by element that the output of the part "
      "shall have besides J: " +
        list + ".");

    for (const std::string &name :
         base::declare_names(prm,
                             "Materials",
                             "",
                             "Names of the materials; each is described in 'subsection "
                             "Material NAME'."))
      {
        prm.enter_subsection("Material " + name);
        prm.declare_entry("Material id",
                          "0",
                          dealii::Patterns::List(dealii::Patterns::Integer(0), 1),
                          "Physical ids of the elements of this material in the mesh.");
        Material<dim>::declare_parameters(prm);
        prm.leave_subsection();
      }

    declare_constraints<dim>(prm);

    for (const std::string &name :
         base::declare_names(prm,
                             "Loads",
                             "",
                             "Names of the loads; each is described in 'subsection Load "
                             "NAME'."))
      {
        prm.enter_subsection("Load " + name);
        const std::string type =
          base::declare_choice(prm,
                               "Type",
                               structure::loads<dim>().names().front(),
                               structure::loads<dim>().names(),
                               "Kind of load.\n" + structure::loads<dim>().help());
        structure::loads<dim>().declare_parameters(type, prm);
        prm.leave_subsection();
      }
  }


  template <int dim>
  void BodyParameters<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                             const std::string &part)
  {
    name            = part;
    mesh_file       = prm.get("Mesh file");
    consistent_mass = prm.get("Mass matrix") == "consistent";
    mass_tolerance  = prm.get_double("Mass solver tolerance");
    rigid           = prm.get_bool("Rigid");
    fibre_rule.parse_parameters(prm, "Part " + part);
    element_fields = base::parse_names(prm.get("Element fields"));

    materials.clear();
    for (const std::string &material_name : base::parse_names(prm.get("Materials")))
      {
        const std::string what = "Part " + part + ", material " + material_name;

        prm.enter_subsection("Material " + material_name);
        Material<dim> material;
        material.name = material_name;
        for (const int id :
             base::parse_integers(prm.get("Material id"), what + ", Material id"))
          material.ids.push_back(id);
        material.parse_parameters(prm, what);
        prm.leave_subsection();
        materials.push_back(std::move(material));
      }

    constraints = parse_constraints<dim>(prm, part);

    loads.clear();
    for (const std::string &load_name : base::parse_names(prm.get("Loads")))
      {
        const std::string what = "Part " + part + ", load " + load_name;

        prm.enter_subsection("Load " + load_name);
        loads.push_back({load_name, structure::loads<dim>().create(prm.get("Type"))});
        loads.back().load->parse_parameters(prm, what);
        prm.leave_subsection();
      }
  }


  template <int dim>
  Body<dim>::Body(const std::string &name,
                  Mesh<dim> mesh,
                  std::vector<NamedConstraint<dim>> constraints,
                  std::vector<NamedLoad<dim>> loads,
                  const MPI_Comm communicator)
    : name_(name)
    , mesh_(std::move(mesh))
    , constraints_(std::move(constraints))
    , loads_(std::move(loads))
  {
    numbering_.communicator = communicator;
  }


  template <int dim>
  FiniteElementBody<dim>::FiniteElementBody(BodyParameters<dim> parameters_,
                                            Mesh<dim> mesh,
                                            const MPI_Comm communicator)
    : Body<dim>(parameters_.name,
                parameters_.fibre_rule.apply(std::move(mesh)),
                parameters_.constraints,
                parameters_.loads,
                communicator)
    , parameters(std::move(parameters_))
    , reference_element_(this->mesh().shape, this->mesh().degree)
  {
    const Mesh<dim> &mesh_  = this->mesh();
    const std::string &name = this->name();
    AssertThrow(mesh_.n_elements() > 0,
                base::UserError("Part " + name + ": the mesh " + mesh_.source +
                                " has no elements."));
    if (!parameters.rigid)
      check_materials();
    try
      {
        check_orientation(mesh_);
      }
    catch (const base::UserError &error)
      {
        throw base::UserError("Part " + name + ": " + error.what());
      }

    AssertThrow(
      parameters.consistent_mass || mesh_.shape == ElementShape::hypercube ||
        mesh_.degree == 1,
      base::UserError(
        "Part " + name +
        ": \"Mass matrix\" is 'lumped', as nodal coupling "
        "has it, but the elements of " +
        mesh_.source + " are quadratic " + (dim == 2 ? "triangles" : "tetrahedra") +
        ", at whose corners the row sums are " + (dim == 2 ? "zero" : "negative") +
        "; expected 'consistent' and elemental coupling, or linear elements."));
    this->deal_out_nodes();
    if (parameters.rigid)
      check_rigid();
  }


  template <int dim>
  void Body<dim>::deal_out_nodes()
  {
    for (const NamedConstraint<dim> &c : constraints_)
      c.constraint->initialize(mesh_);
    for (const NamedLoad<dim> &l : loads_)
      l.load->initialize(mesh_);

    const unsigned int n_ranks  = dealii::Utilities::MPI::n_mpi_processes(communicator());
    const std::uint64_t n_nodes = mesh_.nodes.size();
    std::vector<unsigned int> owners(n_nodes);
    for (std::uint64_t i = 0; i < n_nodes; ++i)
      owners[i] = i * n_ranks / n_nodes;
    setup(owners);

    for (const NamedConstraint<dim> &c : constraints_)
      AssertThrow(
        dealii::Utilities::MPI::sum(c.constraint->n_nodes(), communicator()) > 0,
        base::UserError("Part " + name() + ", constraint " + c.name + ": no node of " +
                        mesh_.source + " is in its region and material ids."));
    for (const NamedLoad<dim> &l : loads_)
      AssertThrow(dealii::Utilities::MPI::sum(l.load->n_elements(), communicator()) > 0,
                  base::UserError("Part " + name() + ", load " + l.name +
                                  ": no element or face of " + mesh_.source +
                                  " is in its region and has its ids."));
  }


  template <int dim>
  void FiniteElementBody<dim>::check_rigid() const
  {
    const std::string prefix = "Part " + this->name() + ": \"Rigid\" is true, but ";
    AssertThrow(parameters.materials.empty(),
                base::UserError(prefix + "the part has the material '" +
                                parameters.materials.front().name +
                                "'; expected none, as it does not deform."));
    AssertThrow(parameters.element_fields.empty(),
                base::UserError(prefix + "\"Element fields\" has '" +
                                parameters.element_fields.front() +
                                "'; expected none, as the part has no stress."));

    VectorType X;
    this->initialize_vector(X);
    X = std::numeric_limits<double>::quiet_NaN();
    this->set_to_held_positions(0., X);
    const std::vector<double> values = this->to_mesh_order(X);
    for (std::size_t i = 0; i < values.size(); ++i)
      AssertThrow(std::isfinite(values[i]),
                  base::UserError(prefix + "no constraint holds the node at " +
                                  to_string(this->mesh().nodes[i / dim]) + " in " +
                                  this->mesh().source + " in the direction " +
                                  "xyz"[i % dim] + "; expected a tether on all nodes."));
  }


  template <int dim>
  void FiniteElementBody<dim>::check_materials() const
  {
    const std::string prefix = "Part " + this->name() + ": ";

    std::map<unsigned int, unsigned int> first_element;
    for (unsigned int e = 0; e < this->mesh().n_elements(); ++e)
      first_element.emplace(this->mesh().material_ids[e], e);

    std::map<unsigned int, const Material<dim> *> material_of_id;
    for (const Material<dim> &material : parameters.materials)
      for (const unsigned int id : material.ids)
        {
          const auto added = material_of_id.emplace(id, &material);
          AssertThrow(added.second,
                      base::UserError(prefix + "the material id " + std::to_string(id) +
                                      " belongs to two materials, '" +
                                      added.first->second->name + "' and '" +
                                      material.name + "'."));

          if (first_element.count(id) == 0)
            {
              std::string known;
              for (const auto &[mesh_id, e] : first_element)
                known += (known.empty() ? "" : ", ") + std::to_string(mesh_id);
              throw base::UserError(prefix + "the material '" + material.name +
                                    "' has the id " + std::to_string(id) +
                                    ", but the mesh " + this->mesh().source +
                                    " has no element with it. Its ids: " + known + ".");
            }
          AssertThrow(material.law->n_fibre_families() <= this->mesh().n_fibre_families(),
                      base::UserError(
                        prefix + "the law of the material '" + material.name +
                        "' needs " + std::to_string(material.law->n_fibre_families()) +
                        " fibre direction(s) an element, but " + this->mesh().source +
                        " has " + std::to_string(this->mesh().n_fibre_families()) +
                        ": an $ElementData section \"fibre\" is expected there."));
        }

    for (const auto &[id, e] : first_element)
      {
        const auto material = material_of_id.find(id);
        AssertThrow(material != material_of_id.end(),
                    base::UserError(prefix + "no material has the id " +
                                    std::to_string(id) + " of the " +
                                    this->mesh().describe_element(e) + "."));
      }
    for (unsigned int e = 0; e < this->mesh().n_elements(); ++e)
      {
        const unsigned int needed =
          material_of_id[this->mesh().material_ids[e]]->law->n_fibre_families();
        for (unsigned int f = 0; f < needed; ++f)
          AssertThrow(std::abs(this->mesh().fibres[f][e].norm() - 1) < 1e-6,
                      base::UserError(prefix + "the " + this->mesh().describe_element(e) +
                                      " has no fibre direction, which the law of its "
                                      "material needs."));
      }
  }


  template <int dim>
  void FiniteElementBody<dim>::reinit()
  {
    const Mesh<dim> &mesh           = this->mesh();
    const ElementSet<dim> &elements = this->elements();
    cache.reinit(mesh, elements, reference_element_);
    mass_matrix_.reinit(mesh, elements, reference_element_);

    ranges.clear();
    for (unsigned int i = 0; i < elements.n_elements() && !parameters.rigid; ++i)
      {
        const unsigned int id = mesh.material_ids[elements.element(i)];
        unsigned int material = 0;
        while (std::find(parameters.materials[material].ids.begin(),
                         parameters.materials[material].ids.end(),
                         id) == parameters.materials[material].ids.end())
          ++material;
        if (ranges.empty() || ranges.back().material != material)
          ranges.push_back({i, i, material});
        ranges.back().end = i + 1;
      }
  }


  template <int dim>
  ElementSet<dim> Body<dim>::find_elements() const
  {
    return ElementSet<dim>(
      mesh_, numbering_, find_elements_of_owned_nodes(mesh_, numbering_));
  }


  template <int dim>
  void Body<dim>::setup(const std::vector<unsigned int> &owners)
  {
    numbering_ = NodeNumbering(owners, numbering_.communicator);
    elements_  = find_elements();
    reinit();

    for (const NamedConstraint<dim> &c : constraints_)
      c.constraint->reinit(mesh_, elements_);
    for (const NamedLoad<dim> &l : loads_)
      l.load->reinit(mesh_, elements_);

    ghosted_positions.reinit(elements_.partitioner());
    ghosted_velocities.reinit(elements_.partitioner());
    local_forces.assign(elements_.n_nodes() * dim, 0.);
    initialize_vector(elastic_force);
    initialize_vector(external_force);
    initialize_vector(elastic_density);
  }


  template <int dim>
  void Body<dim>::distribute(const OwnersOfPoints &owners_of,
                             VectorType &X,
                             const std::vector<VectorType *> &others)
  {
    // Step 1: the new owners.
    const std::vector<double> positions = to_mesh_order(X);
    std::vector<dealii::Point<dim>> points(mesh_.nodes.size());
    for (unsigned int i = 0; i < points.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        points[i][c] = positions[i * dim + c];

    const std::vector<unsigned int> owners = owners_of(points);
    AssertDimension(owners.size(), points.size());
    const auto outside =
      std::find(owners.begin(), owners.end(), dealii::numbers::invalid_unsigned_int);
    AssertThrow(outside == owners.end(),
                base::UserError("Part " + name() + ": the node at " +
                                to_string(points[outside - owners.begin()]) + ", at " +
                                to_string(mesh_.nodes[outside - owners.begin()]) +
                                " in " + mesh_.source +
                                ", is outside of the fluid's box."));

    // Step 2: everything in the old order.
    const VectorType density = elastic_density;
    std::vector<std::vector<double>> values{to_mesh_order(density)};
    for (const VectorType *v : others)
      values.push_back(to_mesh_order(*v));

    // Step 3: everything in the new order.
    setup(owners);
    from_mesh_order(values[0], elastic_density);
    initialize_vector(X);
    from_mesh_order(positions, X);
    for (unsigned int k = 0; k < others.size(); ++k)
      {
        initialize_vector(*others[k]);
        from_mesh_order(values[k + 1], *others[k]);
      }
  }


  template <int dim>
  void Body<dim>::initialize_vector(VectorType &v) const
  {
    v.reinit(elements_.partitioner()->locally_owned_range(), communicator());
  }


  template <int dim>
  void Body<dim>::set_to_reference_positions(VectorType &X) const
  {
    for (unsigned int i = 0; i < elements_.n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        X.local_element(i * dim + c) = mesh_.nodes[elements_.file_node(i)][c];
  }


  template <int dim>
  void Body<dim>::set_to_held_positions(const double t, VectorType &X) const
  {
    for (const NamedConstraint<dim> &c : constraints_)
      c.constraint->set_targets(t, X);
  }


  template <int dim>
  std::vector<double> Body<dim>::to_mesh_order(const VectorType &v) const
  {
    std::vector<double> values(mesh_.nodes.size() * dim, 0.);
    for (unsigned int i = 0; i < elements_.n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        values[elements_.file_node(i) * dim + c] = v.local_element(i * dim + c);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values),
                                communicator(),
                                dealii::ArrayView<double>(values));
    return values;
  }


  template <int dim>
  void Body<dim>::from_mesh_order(const std::vector<double> &values, VectorType &v) const
  {
    AssertDimension(values.size(), mesh_.nodes.size() * dim);
    for (unsigned int i = 0; i < elements_.n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        v.local_element(i * dim + c) = values[elements_.file_node(i) * dim + c];
  }


  template <int dim>
  std::vector<unsigned int> Body<dim>::node_owners() const
  {
    std::vector<unsigned int> owners(numbering_.n_nodes());
    for (unsigned int r = 0; r + 1 < numbering_.first.size(); ++r)
      for (unsigned int i = numbering_.first[r]; i < numbering_.first[r + 1]; ++i)
        owners[numbering_.node_of[i]] = r;
    return owners;
  }


  template <int dim>
  const double *Body<dim>::import_positions(const VectorType &X) const
  {
    AssertDimension(X.locally_owned_size(), elements_.n_owned_nodes() * dim);
    ghosted_positions.zero_out_ghost_values();
    std::copy(X.begin(), X.end(), ghosted_positions.begin());
    ghosted_positions.update_ghost_values();
    return ghosted_positions.begin();
  }


  template <int dim>
  std::vector<MaterialRange<dim>>
  FiniteElementBody<dim>::material_ranges(const double t, const unsigned int only) const
  {
    std::vector<MaterialRange<dim>> result;
    for (const Range &range : ranges)
      if (only == dealii::numbers::invalid_unsigned_int || only == range.material)
        {
          const Material<dim> &material = parameters.materials[range.material];
          // A constant pointer, so that the law's constant function is taken.
          const ConstitutiveLaw<dim> *const law = material.law.get();
          const VolumetricPart *const part      = law->volumetric_part();
          const bool projected = material.project_volume && cache.n_volume_modes > 0 &&
                                 part != nullptr && part->bulk_modulus > 0;
          result.push_back({range.begin,
                            range.end,
                            law,
                            material.time_factor.value(t),
                            projected ? part : nullptr});
        }
    return result;
  }


  template <int dim>
  void FiniteElementBody<dim>::compute_elastic_force(const VectorType &X,
                                                     const double t,
                                                     VectorType &G,
                                                     const unsigned int material) const
  {
    const double *positions = import_positions(X);

    std::fill(local_forces.begin(), local_forces.end(), 0.);
    unsigned int inverted = dealii::numbers::invalid_unsigned_int;
    for (const MaterialRange<dim> &range : material_ranges(t, material))
      inverted =
        std::min(inverted,
                 structure::compute_elastic_force(
                   cache, this->elements(), range, t, positions, local_forces.data()));

    // All ranks stop if one does.
    std::string message;
    if (inverted != dealii::numbers::invalid_unsigned_int)
      {
        dealii::Point<dim> centroid;
        for (unsigned int a = 0; a < this->mesh().nodes_per_element; ++a)
          for (unsigned int c = 0; c < dim; ++c)
            centroid[c] += positions[this->elements().nodes(inverted)[a] * dim + c] /
                           this->mesh().nodes_per_element;
        std::ostringstream text;
        text << "Part " << this->name() << ": the "
             << this->mesh().describe_element(this->elements().element(inverted))
             << " has been turned inside out (det F <= 0) at time " << t
             << " s; its centroid is at " << to_string(centroid)
             << ". A smaller time step, a larger bulk modulus or a finer mesh there may "
                "help.";
        message = text.str();
      }
    if (dealii::Utilities::MPI::logical_or(!message.empty(), this->communicator()))
      for (const std::string &text :
           dealii::Utilities::MPI::all_gather(this->communicator(), message))
        AssertThrow(text.empty(), base::UserError(text));

    std::copy(local_forces.begin(),
              local_forces.begin() + this->elements().n_owned_nodes() * dim,
              G.begin());
  }


  template <int dim>
  std::string FiniteElementBody<dim>::description() const
  {
    return std::to_string(this->mesh().n_elements()) + " elements, " +
           std::to_string(this->mesh().nodes.size()) + " nodes (" + this->mesh().source +
           ")";
  }


  template <int dim>
  std::vector<std::string> FiniteElementBody<dim>::elastic_force_names() const
  {
    std::vector<std::string> names;
    for (const Material<dim> &material : parameters.materials)
      names.push_back("material " + material.name);
    return names;
  }


  template <int dim>
  std::vector<std::string> Body<dim>::external_force_names() const
  {
    std::vector<std::string> names;
    for (const NamedConstraint<dim> &c : constraints_)
      names.push_back("constraint " + c.name);
    for (const NamedLoad<dim> &l : loads_)
      names.push_back("load " + l.name);
    return names;
  }


  template <int dim>
  bool Body<dim>::has_external_forces() const
  {
    return !loads_.empty() || std::any_of(constraints_.begin(),
                                          constraints_.end(),
                                          [](const NamedConstraint<dim> &c) {
                                            return c.constraint->has_nodal_forces();
                                          });
  }


  template <int dim>
  void Body<dim>::compute_external_forces(const VectorType &X,
                                          const VectorType &U,
                                          const double t,
                                          VectorType &G,
                                          const unsigned int which) const
  {
    const double *positions = import_positions(X);
    ghosted_velocities.zero_out_ghost_values();
    std::copy(U.begin(), U.end(), ghosted_velocities.begin());
    ghosted_velocities.update_ghost_values();
    const NodalState state{positions, ghosted_velocities.begin(), t};

    std::fill(local_forces.begin(), local_forces.end(), 0.);
    const auto wanted = [&](const unsigned int number) {
      return which == dealii::numbers::invalid_unsigned_int || which == number;
    };
    unsigned int number = 0;
    for (const NamedConstraint<dim> &c : constraints_)
      if (wanted(number++))
        c.constraint->add_forces(state, local_forces.data());
    for (const NamedLoad<dim> &l : loads_)
      if (wanted(number++))
        l.load->add_forces(state, local_forces.data());
    std::copy(local_forces.begin(),
              local_forces.begin() + elements_.n_owned_nodes() * dim,
              G.begin());
  }


  template <int dim>
  dealii::Tensor<1, dim> Body<dim>::compute_total_external_force(const VectorType &X,
                                                                 const VectorType &U,
                                                                 const double t) const
  {
    VectorType v;
    initialize_vector(v);
    for (const NamedConstraint<dim> &c : constraints_)
      c.constraint->add_force_density(X, U, t, v);
    dealii::Tensor<1, dim> total = compute_total(v);

    compute_external_forces(X, U, t, v);
    dealii::Tensor<1, dim> sum;
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      sum[i % dim] += v.local_element(i);
    return total + dealii::Utilities::MPI::sum(sum, communicator());
  }


  template <int dim>
  void Body<dim>::compute_force_density(const VectorType &X,
                                        const VectorType &U,
                                        const double t,
                                        VectorType &F)
  {
    compute_elastic_force(X, t, elastic_force);
    if (has_external_forces())
      {
        compute_external_forces(X, U, t, external_force);
        elastic_force += external_force;
      }
    project(elastic_density, elastic_force);
    std::copy(elastic_density.begin(), elastic_density.end(), F.begin());
    for (const NamedConstraint<dim> &c : constraints_)
      c.constraint->add_force_density(X, U, t, F);
  }


  template <int dim>
  unsigned int FiniteElementBody<dim>::project(VectorType &x, const VectorType &b) const
  {
    if (parameters.consistent_mass)
      try
        {
          return mass_matrix_.solve(x, b, parameters.mass_tolerance);
        }
      catch (const base::UserError &error)
        {
          throw base::UserError("Part " + this->name() + ": " + error.what());
        }

    for (unsigned int i = 0; i < this->elements().n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        x.local_element(i * dim + c) =
          b.local_element(i * dim + c) / mass_matrix_.lumped()[i];
    return 0;
  }


  template <int dim>
  dealii::Tensor<1, dim> Body<dim>::compute_total(const VectorType &F) const
  {
    const std::vector<double> &weights = node_weights();
    dealii::Tensor<1, dim> total;
    for (unsigned int i = 0; i < elements_.n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        total[c] += weights[i] * F.local_element(i * dim + c);
    return dealii::Utilities::MPI::sum(total, communicator());
  }


  template <int dim>
  void FiniteElementBody<dim>::for_each_point(
    const VectorType &X,
    const double t,
    const std::function<void(const unsigned int,
                             const unsigned int,
                             const double,
                             const StressState<dim> &)> &function) const
  {
    const double *positions                         = import_positions(X);
    const std::vector<MaterialRange<dim>> materials = material_ranges(t);
    for (unsigned int r = 0; r < ranges.size(); ++r)
      for (unsigned int i = ranges[r].begin; i < ranges[r].end; ++i)
        if (this->elements().nodes(i)[0] < this->elements().n_owned_nodes())
          {
            const MaterialRange<dim> &range = materials[r];
            const unsigned int n_q          = cache.points_per_element;
            std::vector<dealii::Tensor<2, dim>> F(n_q);
            std::vector<double> J(n_q), pressures(n_q);
            for (unsigned int q = 0; q < n_q; ++q)
              {
                F[q] =
                  compute_deformation_gradient(cache, this->elements(), i, q, positions);
                J[q] = determinant(F[q]);
              }
            if (range.projected_part != nullptr)
              project_volumetric_part(
                cache, *range.projected_part, i, J.data(), pressures.data());
            for (unsigned int q = 0; q < n_q; ++q)
              {
                dealii::Tensor<2, dim> P =
                  range.law->first_piola_kirchhoff_stress(F[q], cache.fibres[i], t);
                if (range.projected_part != nullptr)
                  P +=
                    (pressures[q] - range.projected_part->bulk_kirchhoff_pressure(J[q])) *
                    transpose(invert(F[q]));
                function(ranges[r].material,
                         this->elements().element(i),
                         cache.JxW[i * n_q + q],
                         StressState<dim>(F[q], range.time_factor * P, cache.fibres[i]));
              }
          }
  }


  template <int dim>
  std::vector<std::vector<double>>
  FiniteElementBody<dim>::compute_element_fields(const std::vector<std::string> &names,
                                                 const VectorType &X,
                                                 const double t) const
  {
    std::vector<const StressQuantity<dim> *> quantities;
    std::vector<std::vector<double>> fields;
    for (const std::string &quantity_name : names)
      {
        quantities.push_back(&find_stress_quantity<dim>(quantity_name));
        fields.emplace_back(this->mesh().n_elements() * quantities.back()->n_components,
                            0.);
      }

    unsigned int element = dealii::numbers::invalid_unsigned_int;
    StressState<dim> mean;
    double volume             = 0;
    const auto finish_element = [&]() {
      if (volume == 0)
        return;
      mean.divide(volume);
      for (unsigned int k = 0; k < quantities.size(); ++k)
        quantities[k]->evaluate(mean,
                                fields[k].data() + element * quantities[k]->n_components);
    };
    for_each_point(X,
                   t,
                   [&](const unsigned int,
                       const unsigned int e,
                       const double JxW,
                       const StressState<dim> &state) {
                     if (e != element)
                       {
                         finish_element();
                         element = e;
                         mean    = StressState<dim>();
                         volume  = 0;
                       }
                     mean.add(JxW, state);
                     volume += JxW;
                   });
    finish_element();

    for (std::vector<double> &field : fields)
      dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(field),
                                  this->communicator(),
                                  dealii::ArrayView<double>(field));
    return fields;
  }


  template <int dim>
  double FiniteElementBody<dim>::compute_elastic_energy(const VectorType &X,
                                                        const double t) const
  {
    const double *positions = import_positions(X);
    double energy           = 0;
    for (const MaterialRange<dim> &range : material_ranges(t))
      energy +=
        structure::compute_elastic_energy(cache, this->elements(), range, t, positions);
    return dealii::Utilities::MPI::sum(energy, this->communicator());
  }


  template <int dim>
  std::vector<double> Body<dim>::compute_constraint_displacements(const VectorType &X,
                                                                  const double t) const
  {
    std::vector<double> largest;
    for (const NamedConstraint<dim> &c : constraints_)
      largest.push_back(c.constraint->largest_displacement(X, t));
    if (!largest.empty())
      dealii::Utilities::MPI::max(dealii::ArrayView<const double>(largest),
                                  communicator(),
                                  dealii::ArrayView<double>(largest));
    return largest;
  }


  template <int dim>
  std::pair<double, double>
  FiniteElementBody<dim>::compute_volume_ratios(const VectorType &X) const
  {
    const double *positions = import_positions(X);
    double smallest         = std::numeric_limits<double>::max();
    double largest          = std::numeric_limits<double>::lowest();
    for (unsigned int i = 0; i < this->elements().n_elements(); ++i)
      {
        double volume = 0, reference_volume = 0;
        for (unsigned int q = 0; q < cache.points_per_element; ++q)
          {
            const double JxW = cache.JxW[i * cache.points_per_element + q];
            reference_volume += JxW;
            volume += JxW * determinant(compute_deformation_gradient(
                              cache, this->elements(), i, q, positions));
          }
        smallest = std::min(smallest, volume / reference_volume);
        largest  = std::max(largest, volume / reference_volume);
      }
    return {dealii::Utilities::MPI::min(smallest, this->communicator()),
            dealii::Utilities::MPI::max(largest, this->communicator())};
  }


  template struct BodyParameters<2>;
  template struct BodyParameters<3>;
  template void declare_constraints<2>(dealii::ParameterHandler &);
  template void declare_constraints<3>(dealii::ParameterHandler &);
  template std::vector<NamedConstraint<2>>
  parse_constraints<2>(dealii::ParameterHandler &, const std::string &);
  template std::vector<NamedConstraint<3>>
  parse_constraints<3>(dealii::ParameterHandler &, const std::string &);
  template class Body<2>;
  template class Body<3>;
  template class FiniteElementBody<2>;
  template class FiniteElementBody<3>;
} // namespace mitre::structure
