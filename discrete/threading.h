#pragma once

#include <cstdint>

namespace antiform::discrete
{
/// Loops over fewer grains than this stay on one thread: a step of 2000 grains takes some
/// 100 microseconds, and each of its handful of barriers several of them.
constexpr std::int64_t threads_from_grains = 2000;
} // namespace antiform::discrete
