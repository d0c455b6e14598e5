#include "discrete/joint_kernel.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace antiform::discrete
{
std::vector<KernelLevel> supported_kernel_levels()
{
  std::vector<KernelLevel> levels{level_baseline::kernel_level()};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    levels.push_back(level_x86_64_v3::kernel_level());
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd"))
    levels.push_back(level_x86_64_v4::kernel_level());
  return levels;
}

const KernelLevel &kernel_level()
{
  static const KernelLevel chosen = []
  {
    const std::vector<KernelLevel> levels = supported_kernel_levels();
    const char *wanted = std::getenv("ANTIFORM_KERNEL_LEVEL");
    if (wanted == nullptr)
      return levels.back();
    for (const KernelLevel &level : levels)
      if (std::string(wanted) == level.name)
        return level;
    throw std::runtime_error(std::string("ANTIFORM_KERNEL_LEVEL is '") + wanted +
                             "', which this processor does not have. Unset it.");
  }();
  return chosen;
}
} // namespace antiform::discrete
