#include <algorithm>

#include <mitre/base/exceptions.h>
#include <mitre/coupling/kernels.h>

namespace mitre::coupling
{
  const std::vector<std::string> &kernel_names()
  {
    static const std::vector<std::string> names = std::apply(
      [](const auto... kernel) {
        return std::vector<std::string>{decltype(kernel)::name...};
      },
      Kernels());
    return names;
  }


  void throw_unknown_kernel(const std::string &name)
  {
    std::string names;
    for (const std::string &known : kernel_names())
      names += (names.empty() ? "" : ", ") + known;
    throw base::UserError("There is no kernel '" + name + "'; there are " + names + ".");
  }


  unsigned int kernel_halo_width(const std::string &name)
  {
    unsigned int width = 0;
    with_kernel(name, [&](const auto kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      width        = Kernel::Normal::n_points <= 4 ? 2 : 3;
    });
    return width;
  }


  double kernel_reach(const std::string &name)
  {
    double reach = 0;
    with_kernel(name, [&](const auto kernel) {
      using Kernel = std::decay_t<decltype(kernel)>;
      reach = 0.5 * std::max<int>(Kernel::Normal::n_points, Kernel::Across::n_points);
    });
    return reach;
  }
} // namespace mitre::coupling
