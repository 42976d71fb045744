#ifndef mitre_structure_fibre_network_h
#define mitre_structure_fibre_network_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <string>
#include <vector>

#include <mitre/structure/mesh.h>

namespace mitre::structure
{
  /**
   * A spring between two nodes. Its tension is a function of its length that a SpringLaw
   * gives, by default @f$T = \kappa (|x_1 - x_0| - l_0)@f$ [dyn].
   */
  struct Spring
  {
    std::array<unsigned int, 2> nodes;

    /// @f$\kappa@f$ [dyn/cm] and @f$l_0@f$ [cm].
    double stiffness   = 0;
    double rest_length = 0;

    /// Which law, and what that law needs beside.
    unsigned int force_function = 0;
    std::vector<double> parameters;

    /// Line of its file, for messages.
    unsigned long line = 0;
  };


  /**
   * Resistance of three neighbours i, j, k of a fibre to bending at the middle one:
   * @f[ E = \frac{\kappa}{2} |x_i - 2 x_j + x_k - c|^2. @f]
   * For nodes at a distance ds, @f$\kappa = EI/ds^3@f$ (3.2). c is the second difference
   * at rest, a vector in space that does not turn with the fibre.
   */
  template <int dim>
  struct Beam
  {
    std::array<unsigned int, 3> nodes;

    /// @f$\kappa@f$ [dyn/cm]
    double stiffness = 0;

    /// c [cm]
    dealii::Tensor<1, dim> curvature;
  };


  /// A spring of no length and a damper between a node and where it shall be.
  struct TargetPoint
  {
    unsigned int node;

    /// [dyn/cm] and [dyn s/cm]
    double stiffness = 0;
    double damping   = 0;
  };


  /**
   * A structure of fibres at rest as plain arrays, the same on every rank. Nodes are
   * numbered from 0.
   */
  template <int dim>
  struct FibreNetwork
  {
    /// Where it comes from, for messages: the file of its nodes and, if there is one,
    /// that of its springs.
    std::string source, spring_source;

    /// [cm]
    std::vector<dealii::Point<dim>> nodes;

    std::vector<Spring> springs;
    std::vector<Beam<dim>> beams;
    std::vector<TargetPoint> targets;
  };


  /**
   * The nodes, and as elements every pair of neighbours in a spring or a beam once, in
   * the order in which the network names them first, then each node that has no neighbour
   * twice. The force function of the first spring between a pair is its material id.
   */
  template <int dim>
  Mesh<dim> make_segment_mesh(const FibreNetwork<dim> &network);
} // namespace mitre::structure

#endif
