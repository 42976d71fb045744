#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <mitre/structure/stable_time_step.h>

namespace mitre::structure
{
  namespace
  {
    /**
     * How the nodal forces of a body fall as its nodes move by a small displacement, or
     * as they move at a velocity: the products with the matrices of stiffness and of
     * damping, by central differences.
     */
    template <int dim>
    class Response
    {
    public:
      /// @param amplitude the largest component of a change
      Response(const Body<dim> &body,
               const VectorType &X,
               const double t,
               const bool to_displacement,
               const double amplitude)
        : body(body)
        , X(X)
        , t(t)
        , to_displacement(to_displacement)
        , amplitude(amplitude)
      {
        for (VectorType *vector : {&positions, &velocities, &forces, &density})
          body.initialize_vector(*vector);
      }

      /// Nodal elastic forces [dyn], or one of them.
      void apply_elastic(const unsigned int which, const VectorType &v, VectorType &G)
      {
        difference(v, G, [&](VectorType &result) {
          body.compute_elastic_force(positions, t, result, which);
        });
      }

      /// Nodal forces [dyn] of all constraints and loads, or of one.
      void
      apply_external(const VectorType &v,
                     VectorType &G,
                     const unsigned int which = dealii::numbers::invalid_unsigned_int)
      {
        difference(v, G, [&](VectorType &result) {
          body.compute_external_forces(positions, velocities, t, result, which);
        });
      }

      /// Force density [dyn/cm^dim] of one constraint.
      void apply_constraint(const unsigned int number, const VectorType &v, VectorType &F)
      {
        difference(v, F, [&](VectorType &result) {
          result = 0;
          body.constraints()[number].constraint->add_force_density(
            positions, velocities, t, result);
        });
      }

      /// Force density of everything.
      void apply(const VectorType &v, VectorType &F)
      {
        VectorType G = forces;
        apply_external(v, G);
        if (to_displacement)
          {
            apply_elastic(dealii::numbers::invalid_unsigned_int, v, density);
            G += density;
          }
        F = 0;
        body.project(F, G);
        for (unsigned int c = 0; c < body.constraints().size(); ++c)
          {
            apply_constraint(c, v, density);
            F += density;
          }
      }

    private:
      /// Minus the change of what @p compute gives, a unit of @p v.
      template <typename Compute>
      void difference(const VectorType &v, VectorType &result, const Compute &compute)
      {
        const double step = amplitude / v.linfty_norm();
        VectorType before = v;
        for (const double sign : {1., -1.})
          {
            positions  = X;
            velocities = 0;
            (to_displacement ? positions : velocities).add(sign * step, v);
            compute(sign > 0 ? before : result);
          }
        result -= before;
        result *= 0.5 / step;
      }

      const Body<dim> &body;
      const VectorType &X;
      const double t;
      const bool to_displacement;
      const double amplitude;
      VectorType positions, velocities, forces, density;
    };


    /// The largest eigenvalue by power iteration from a fixed irregular vector, and its
    /// mode @p v.
    template <int dim>
    double find_largest_eigenvalue(const Body<dim> &body,
                                   Response<dim> &response,
                                   const Mobility &mobility,
                                   VectorType &v)
    {
      // The same start on any number of ranks, in which all modes take part.
      std::vector<double> start(body.mesh().nodes.size() * dim);
      for (std::size_t i = 0; i < start.size(); ++i)
        start[i] = std::sin(12.9898 * (i + 1) + 4.1414 * ((7 * i) % 13));
      body.initialize_vector(v);
      body.from_mesh_order(start, v);
      v /= v.l2_norm();

      VectorType w, density;
      body.initialize_vector(w);
      body.initialize_vector(density);
      double eigenvalue = 0;
      for (unsigned int iteration = 0; iteration < 100; ++iteration)
        {
          if (mobility)
            {
              response.apply(v, density);
              mobility(density, w);
            }
          else
            response.apply(v, w);
          const double norm = w.l2_norm();
          if (norm == 0)
            return 0;
          w /= norm;
          std::swap(v, w);
          const double change = std::abs(norm - eigenvalue);
          eigenvalue          = norm;
          if (iteration > 10 && change < 1e-4 * norm)
            break;
        }
      return eigenvalue;
    }


    /// What contributes most to the power of a mode @p v.
    template <int dim>
    std::string find_largest_contribution(const Body<dim> &body,
                                          Response<dim> &response,
                                          const bool to_displacement,
                                          const VectorType &v)
    {
      std::string name;
      double largest = -std::numeric_limits<double>::max();
      VectorType G;
      body.initialize_vector(G);
      const auto compare = [&](const std::string &candidate, const double power) {
        if (power > largest)
          {
            largest = power;
            name    = candidate;
          }
      };

      if (to_displacement)
        for (unsigned int m = 0; m < body.elastic_force_names().size(); ++m)
          {
            response.apply_elastic(m, v, G);
            compare(body.elastic_force_names()[m], v * G);
          }
      for (unsigned int c = 0; c < body.constraints().size(); ++c)
        {
          response.apply_constraint(c, v, G);
          for (unsigned int i = 0; i < G.locally_owned_size(); ++i)
            G.local_element(i) *= body.node_weights()[i / dim];
          double power = v * G;
          response.apply_external(v, G, c);
          power += v * G;
          compare("constraint " + body.constraints()[c].name, power);
        }
      for (unsigned int l = 0; l < body.loads().size(); ++l)
        {
          response.apply_external(v, G, body.constraints().size() + l);
          compare("load " + body.loads()[l].name, v * G);
        }
      return name;
    }


    /// A thousandth of the shortest distance of two nodes of an element (1e-3 cm if there
    /// are nodes only).
    template <int dim>
    double small_displacement(const Mesh<dim> &mesh)
    {
      double shortest      = std::numeric_limits<double>::max();
      const unsigned int n = mesh.nodes_per_element;
      const auto &nodes    = mesh.elements;
      for (unsigned int e = 0; e < mesh.n_elements(); ++e)
        for (unsigned int a = 1; a < n; ++a)
          {
            const double distance =
              mesh.nodes[nodes[e * n + a]].distance(mesh.nodes[nodes[e * n + a - 1]]);
            if (distance > 0)
              shortest = std::min(shortest, distance);
          }
      return 1e-3 * std::min(shortest, 1.);
    }
  } // namespace


  template <int dim>
  StableTimeStep estimate_stable_time_step(const Body<dim> &body,
                                           const VectorType &X,
                                           const double t,
                                           const double density,
                                           const Mobility &mobility)
  {
    AssertThrow(mobility || body.mesh().shape != ElementShape::segment,
                dealii::ExcMessage("Fibres have no mass of their own."));
    StableTimeStep estimate;
    estimate.part = body.name();

    // Step 1: stiffness and damping.
    Response<dim> stiffness(body, X, t, true, small_displacement(body.mesh()));
    Response<dim> damping(body, X, t, false, 1.);
    VectorType mode, damped_mode;
    const double square =
      find_largest_eigenvalue(body, stiffness, mobility, mode) / density;
    estimate.frequency = std::sqrt(square);
    estimate.damping_rate =
      find_largest_eigenvalue(body, damping, mobility, damped_mode) / density;

    // Step 2: both together, written so that either may be zero.
    const double c     = estimate.damping_rate;
    estimate.time_step = square + c > 0 ? 4 / (c + std::sqrt(c * c + 4 * square))
                                        : std::numeric_limits<double>::infinity();

    // Step 3: whose doing it is.
    if (square + c > 0)
      estimate.limited_by =
        c > estimate.frequency
          ? find_largest_contribution(body, damping, false, damped_mode)
          : find_largest_contribution(body, stiffness, true, mode);
    return estimate;
  }


  template StableTimeStep estimate_stable_time_step(const Body<2> &,
                                                    const VectorType &,
                                                    const double,
                                                    const double,
                                                    const Mobility &);
  template StableTimeStep estimate_stable_time_step(const Body<3> &,
                                                    const VectorType &,
                                                    const double,
                                                    const double,
                                                    const Mobility &);
} // namespace mitre::structure
