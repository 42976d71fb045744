#ifndef mitre_grid_types_h
#define mitre_grid_types_h

#include <deal.II/lac/la_parallel_vector.h>

namespace mitre::grid
{
  using VectorType = dealii::LinearAlgebra::distributed::Vector<double>;
}

#endif
