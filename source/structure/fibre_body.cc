#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>
#include <mitre/structure/constraints/target_points.h>
#include <mitre/structure/fibre_body.h>
#include <mitre/structure/library.h>

namespace mitre::structure
{
  template <int dim>
  void FibreParameters<dim>::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Vertex file",
      "",
      base::InputFile(),
      "Nodes of the fibres at rest [cm], in the format of IBAMR: NAME.vertex. "
      "Files NAME.spring, NAME.beam and NAME.target beside it are read, too, "
      "if they are there.");
    for (const std::string &name : base::declare_names(
           prm,
           "Spring laws",
           "",
           "Names of laws for the tension of springs; each is described in "
           "'subsection Spring law NAME'. None: all springs are linear, "
           "T = kappa (l - l_0)."))
      {
        prm.enter_subsection("Spring law " + name);
        prm.declare_entry(
          "Force function",
          "0",
          dealii::Patterns::Integer(0),
          "Springs with this index in the fifth column of the spring file "
          "follow the law; those without a fifth column have 0.");
        prm.declare_entry(
          "Compression",
          "true",
          dealii::Patterns::Bool(),
          "Whether springs that are shorter than at rest push; false: they "
          "are slack.");
        const std::string type =
          base::declare_choice(prm,
                               "Type",
                               structure::spring_laws().names().front(),
                               structure::spring_laws().names(),
                               "Kind of law.\n" + structure::spring_laws().help());
        structure::spring_laws().declare_parameters(type, prm);
        prm.leave_subsection();
      }
    VectorExpression<dim>::declare_parameters(
      prm,
      "Target displacement",
      "Of the target points of the .target file from the nodes at rest [cm]");
    declare_constraints<dim>(prm);
  }


  template <int dim>
  void FibreParameters<dim>::parse_parameters(dealii::ParameterHandler &prm,
                                              const std::string &part)
  {
    name        = part;
    vertex_file = prm.get("Vertex file");
    spring_laws.clear();
    for (const std::string &law_name : base::parse_names(prm.get("Spring laws")))
      {
        prm.enter_subsection("Spring law " + law_name);
        NamedSpringLaw law;
        law.name                = law_name;
        law.force_function      = prm.get_integer("Force function");
        law.carries_compression = prm.get_bool("Compression");
        law.law                 = structure::spring_laws().create(prm.get("Type"));
        law.law->parse_parameters(prm, "Part " + part + ", spring law " + law_name);
        prm.leave_subsection();
        for (const NamedSpringLaw &other : spring_laws)
          AssertThrow(other.force_function != law.force_function,
                      base::UserError("Part " + part + ": the spring laws '" +
                                      other.name + "' and '" + law_name +
                                      "' have the same \"Force function\", " +
                                      std::to_string(law.force_function) + "."));
        spring_laws.push_back(std::move(law));
      }
    target_displacement.parse_parameters(prm, "Target displacement", "Part " + part);
    constraints = parse_constraints<dim>(prm, part);
  }


  namespace
  {
    /// The constraints of the parameter file, and the target points of the network.
    template <int dim>
    std::vector<NamedConstraint<dim>>
    all_constraints(const FibreParameters<dim> &parameters,
                    const FibreNetwork<dim> &network)
    {
      std::vector<NamedConstraint<dim>> constraints = parameters.constraints;
      for (const NamedConstraint<dim> &c : constraints)
        AssertThrow(c.constraint->acts_on_points(),
                    base::UserError("Part " + parameters.name + ", constraint " + c.name +
                                    ": it acts on a volume or a surface, which fibres do "
                                    "not have; expected 'Acts on = points'."));
      if (!network.targets.empty())
        constraints.push_back({"target points",
                               std::make_shared<TargetPoints<dim>>(
                                 network.targets, parameters.target_displacement)});
      return constraints;
    }


    std::vector<NamedSpringLaw> laws_or_linear(const std::vector<NamedSpringLaw> &laws)
    {
      if (!laws.empty())
        return laws;
      const std::string name = structure::spring_laws().names().front();
      return {{name, 0, true, structure::spring_laws().create(name)}};
    }
  } // namespace


  template <int dim>
  FibreBody<dim>::FibreBody(FibreParameters<dim> parameters_,
                            FibreNetwork<dim> network,
                            const MPI_Comm communicator)
    : Body<dim>(parameters_.name,
                make_segment_mesh(network),
                all_constraints(parameters_, network),
                {},
                communicator)
    , parameters(std::move(parameters_))
    , network_(std::move(network))
  {
    parameters.spring_laws = laws_or_linear(parameters.spring_laws);
    AssertThrow(!network_.springs.empty() || !network_.beams.empty() ||
                  !this->constraints().empty(),
                base::UserError("Part " + this->name() + ": beside " + network_.source +
                                " there are neither springs nor beams nor target points, "
                                "and the part has no constraints; expected one of the "
                                "files .spring, .beam and .target."));
    check_springs();
    this->deal_out_nodes();
  }


  template <int dim>
  void FibreBody<dim>::check_springs() const
  {
    for (const Spring &spring : network_.springs)
      {
        const std::string prefix = "Part " + this->name() + ": " +
                                   network_.spring_source + ", line " +
                                   std::to_string(spring.line) + ": the spring ";
        const auto law = std::find_if(parameters.spring_laws.begin(),
                                      parameters.spring_laws.end(),
                                      [&](const NamedSpringLaw &l) {
                                        return l.force_function == spring.force_function;
                                      });
        if (law == parameters.spring_laws.end())
          {
            std::string known;
            for (const NamedSpringLaw &l : parameters.spring_laws)
              known += (known.empty() ? "" : ", ") + std::to_string(l.force_function);
            throw base::UserError(prefix + "has the force function " +
                                  std::to_string(spring.force_function) +
                                  ", for which there is no law in \"Spring laws\"; "
                                  "expected one of: " +
                                  known + ".");
          }
        AssertThrow(
          spring.parameters.size() <= law->law->n_spring_parameters(),
          base::UserError(prefix + "has " + std::to_string(spring.parameters.size()) +
                          " value(s) after its force function; the law '" + law->name +
                          "' takes at most " +
                          std::to_string(law->law->n_spring_parameters()) + "."));
        AssertThrow(spring.rest_length > 0 || !law->law->needs_rest_length(),
                    base::UserError(prefix + "has the rest length 0; the law '" +
                                    law->name +
                                    "' is a function of the strain, so that it must be "
                                    "positive."));
      }
  }


  template <int dim>
  const NamedSpringLaw &FibreBody<dim>::law_of(const Spring &spring) const
  {
    for (const NamedSpringLaw &law : parameters.spring_laws)
      if (law.force_function == spring.force_function)
        return law;
    AssertThrow(false, dealii::ExcInternalError());
    return parameters.spring_laws.front();
  }


  template <int dim>
  double FibreBody<dim>::tension(const Spring &spring, const double length) const
  {
    const NamedSpringLaw &law = law_of(spring);
    return law.carries_compression || length > spring.rest_length
             ? law.law->tension(spring, length)
             : 0;
  }


  template <int dim>
  std::string FibreBody<dim>::description() const
  {
    return std::to_string(network_.nodes.size()) + " nodes, " +
           std::to_string(network_.springs.size()) + " springs, " +
           std::to_string(network_.beams.size()) + " beams, " +
           std::to_string(network_.targets.size()) + " target points (" +
           network_.source + ")";
  }


  template <int dim>
  std::vector<std::string> FibreBody<dim>::elastic_force_names() const
  {
    return {"springs", "beams"};
  }


  template <int dim>
  template <std::size_t n>
  bool FibreBody<dim>::owns_any(const std::array<unsigned int, n> &nodes) const
  {
    const NodeNumbering &numbering = this->numbering();
    return std::any_of(nodes.begin(), nodes.end(), [&](const unsigned int node) {
      const unsigned int number = numbering.number_of[node];
      return number >= numbering.begin_owned() && number < numbering.end_owned();
    });
  }


  template <int dim>
  ElementSet<dim> FibreBody<dim>::find_elements() const
  {
    std::vector<unsigned int> others;
    for (const Spring &spring : network_.springs)
      if (owns_any(spring.nodes))
        others.insert(others.end(), spring.nodes.begin(), spring.nodes.end());
    for (const Beam<dim> &beam : network_.beams)
      if (owns_any(beam.nodes))
        others.insert(others.end(), beam.nodes.begin(), beam.nodes.end());
    return ElementSet<dim>(this->mesh(),
                           this->numbering(),
                           find_elements_of_owned_nodes(this->mesh(), this->numbering()),
                           others);
  }


  template <int dim>
  void FibreBody<dim>::reinit()
  {
    weights.assign(this->elements().n_owned_nodes(), 1.);
    springs.clear();
    spring_nodes.clear();
    beams.clear();
    beam_nodes.clear();
    const auto local = [&](const unsigned int node) {
      return this->elements().local_node(this->numbering(), node);
    };
    for (unsigned int i = 0; i < network_.springs.size(); ++i)
      if (const auto &nodes = network_.springs[i].nodes; owns_any(nodes))
        {
          springs.push_back(i);
          spring_nodes.push_back({{local(nodes[0]), local(nodes[1])}});
        }
    for (unsigned int i = 0; i < network_.beams.size(); ++i)
      if (const auto &nodes = network_.beams[i].nodes; owns_any(nodes))
        {
          beams.push_back(i);
          beam_nodes.push_back({{local(nodes[0]), local(nodes[1]), local(nodes[2])}});
        }
  }


  namespace
  {
    template <int dim>
    dealii::Tensor<1, dim> vector_at(const double *X, const unsigned int node)
    {
      dealii::Tensor<1, dim> x;
      for (unsigned int c = 0; c < dim; ++c)
        x[c] = X[node * dim + c];
      return x;
    }


    template <int dim>
    void add_at(double *G, const unsigned int node, const dealii::Tensor<1, dim> &f)
    {
      for (unsigned int c = 0; c < dim; ++c)
        G[node * dim + c] += f[c];
    }


    /// x_i - 2 x_j + x_k - c
    template <int dim>
    dealii::Tensor<1, dim> bending(const Beam<dim> &beam,
                                   const std::array<unsigned int, 3> &nodes,
                                   const double *X)
    {
      return vector_at<dim>(X, nodes[0]) - 2. * vector_at<dim>(X, nodes[1]) +
             vector_at<dim>(X, nodes[2]) - beam.curvature;
    }
  } // namespace


  template <int dim>
  void FibreBody<dim>::compute_elastic_force(const VectorType &X,
                                             const double,
                                             VectorType &G,
                                             const unsigned int which) const
  {
    const double *positions = import_positions(X);
    double *forces          = local_forces.data();
    std::fill(local_forces.begin(), local_forces.end(), 0.);

    if (which != 1)
      for (unsigned int i = 0; i < springs.size(); ++i)
        {
          const auto &nodes = spring_nodes[i];
          const dealii::Tensor<1, dim> d =
            vector_at<dim>(positions, nodes[1]) - vector_at<dim>(positions, nodes[0]);
          const double length = d.norm();
          if (length == 0)
            continue;
          const dealii::Tensor<1, dim> f =
            tension(network_.springs[springs[i]], length) / length * d;
          add_at<dim>(forces, nodes[0], f);
          add_at<dim>(forces, nodes[1], -f);
        }
    if (which != 0)
      for (unsigned int i = 0; i < beams.size(); ++i)
        {
          const Beam<dim> &beam = network_.beams[beams[i]];
          const dealii::Tensor<1, dim> f =
            beam.stiffness * bending(beam, beam_nodes[i], positions);
          add_at<dim>(forces, beam_nodes[i][0], -f);
          add_at<dim>(forces, beam_nodes[i][1], 2. * f);
          add_at<dim>(forces, beam_nodes[i][2], -f);
        }

    std::copy(local_forces.begin(),
              local_forces.begin() + this->elements().n_owned_nodes() * dim,
              G.begin());
  }


  template <int dim>
  unsigned int FibreBody<dim>::project(VectorType &x, const VectorType &b) const
  {
    std::copy(b.begin(), b.end(), x.begin());
    return 0;
  }


  template <int dim>
  double FibreBody<dim>::compute_elastic_energy(const VectorType &X, const double) const
  {
    const double *positions  = import_positions(X);
    const unsigned int owned = this->elements().n_owned_nodes();
    double energy            = 0;
    for (unsigned int i = 0; i < springs.size(); ++i)
      if (const auto &nodes = spring_nodes[i]; nodes[0] < owned)
        {
          const Spring &spring      = network_.springs[springs[i]];
          const NamedSpringLaw &law = law_of(spring);
          const double length =
            (vector_at<dim>(positions, nodes[1]) - vector_at<dim>(positions, nodes[0]))
              .norm();
          if (law.carries_compression || length > spring.rest_length)
            energy += law.law->energy(spring, length);
        }
    for (unsigned int i = 0; i < beams.size(); ++i)
      if (beam_nodes[i][1] < owned)
        {
          const Beam<dim> &beam = network_.beams[beams[i]];
          energy +=
            0.5 * beam.stiffness * bending(beam, beam_nodes[i], positions).norm_square();
        }
    return dealii::Utilities::MPI::sum(energy, this->communicator());
  }


  template <int dim>
  std::vector<double>
  FibreBody<dim>::compute_spring_tensions(const std::vector<double> &X) const
  {
    std::vector<double> tensions;
    for (const Spring &spring : network_.springs)
      tensions.push_back(tension(spring,
                                 (vector_at<dim>(X.data(), spring.nodes[1]) -
                                  vector_at<dim>(X.data(), spring.nodes[0]))
                                   .norm()));
    return tensions;
  }


  template <int dim>
  std::vector<double> FibreBody<dim>::compute_tensions(const std::vector<double> &X) const
  {
    const std::vector<unsigned int> &segments = this->mesh().elements;
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> segment_of;
    for (unsigned int e = 0; e < this->mesh().n_elements(); ++e)
      segment_of[std::minmax(segments[2 * e], segments[2 * e + 1])] = e;
    const std::vector<double> of_springs = compute_spring_tensions(X);
    std::vector<double> tensions(this->mesh().n_elements(), 0.);
    for (unsigned int i = 0; i < of_springs.size(); ++i)
      {
        const auto &nodes = network_.springs[i].nodes;
        tensions[segment_of.at(std::minmax(nodes[0], nodes[1]))] += of_springs[i];
      }
    return tensions;
  }


  template struct FibreParameters<2>;
  template struct FibreParameters<3>;
  template class FibreBody<2>;
  template class FibreBody<3>;
} // namespace mitre::structure
