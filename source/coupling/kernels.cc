#include <mitre/coupling/kernels.h>

namespace mitre::coupling
{
  const std::vector<std::string> &kernel_names()
  {
    static const std::vector<std::string> names = {kernels::IB4::name,
                                                   kernels::IB3::name};
    return names;
  }
} // namespace mitre::coupling
