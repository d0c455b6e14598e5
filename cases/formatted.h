#pragma once

#include <string>

namespace antiform::cases
{
/// What printf would print, of any length.
std::string formatted(const char *format, ...) __attribute__((format(printf, 1, 2)));
} // namespace antiform::cases
