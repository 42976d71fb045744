#include <algorithm>
#include <cmath>
#include <utility>

#include <mitre/structure/constraints/target_points.h>

namespace mitre::structure
{
  template <int dim>
  TargetPoints<dim>::TargetPoints(std::vector<TargetPoint> targets,
                                  const VectorExpression<dim> &displacement)
    : targets(std::move(targets))
    , displacement(displacement)
  {
  }


  template <int dim>
  void TargetPoints<dim>::parse_parameters(dealii::ParameterHandler &,
                                           const std::string &)
  {
  }


  template <int dim>
  void TargetPoints<dim>::reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements)
  {
    owned.clear();
    reference_positions.clear();
    std::vector<unsigned int> local_number(mesh.nodes.size(),
                                           dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < elements.n_owned_nodes(); ++i)
      local_number[elements.file_node(i)] = i;
    for (TargetPoint target : targets)
      if (local_number[target.node] != dealii::numbers::invalid_unsigned_int)
        {
          reference_positions.push_back(mesh.nodes[target.node]);
          target.node = local_number[target.node];
          owned.push_back(target);
        }
  }


  template <int dim>
  dealii::Point<dim> TargetPoints<dim>::target(const dealii::Point<dim> &s,
                                               const double t) const
  {
    return displacement.is_zero() ? s : s + displacement.value(s, t);
  }


  // All of it is a force, see add_forces().
  template <int dim>
  void TargetPoints<dim>::add_force_density(const VectorType &,
                                            const VectorType &,
                                            const double,
                                            VectorType &) const
  {
  }


  template <int dim>
  void TargetPoints<dim>::add_forces(const NodalState &state, double *forces) const
  {
    constexpr double step = 1e-6;
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        const dealii::Point<dim> &s = reference_positions[i];
        const dealii::Point<dim> x  = target(s, state.t);
        dealii::Tensor<1, dim> u;
        if (owned[i].damping > 0 && !displacement.is_zero())
          u = (target(s, state.t + step) - target(s, state.t - step)) / (2 * step);
        for (unsigned int c = 0; c < dim; ++c)
          forces[owned[i].node * dim + c] -=
            owned[i].stiffness * (state.X[owned[i].node * dim + c] - x[c]) +
            owned[i].damping * (state.U[owned[i].node * dim + c] - u[c]);
      }
  }


  template <int dim>
  void TargetPoints<dim>::set_targets(const double t, VectorType &X) const
  {
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        const dealii::Point<dim> x = target(reference_positions[i], t);
        for (unsigned int c = 0; c < dim; ++c)
          X.local_element(owned[i].node * dim + c) = x[c];
      }
  }


  template <int dim>
  double TargetPoints<dim>::largest_displacement(const VectorType &X,
                                                 const double t) const
  {
    double largest_square = 0;
    for (unsigned int i = 0; i < owned.size(); ++i)
      {
        if (owned[i].stiffness == 0) // a damper, which holds its node nowhere
          continue;
        const dealii::Point<dim> x = target(reference_positions[i], t);
        double square              = 0;
        for (unsigned int c = 0; c < dim; ++c)
          {
            const double difference = X.local_element(owned[i].node * dim + c) - x[c];
            square += difference * difference;
          }
        largest_square = std::max(largest_square, square);
      }
    return std::sqrt(largest_square);
  }


  template class TargetPoints<2>;
  template class TargetPoints<3>;
} // namespace mitre::structure
