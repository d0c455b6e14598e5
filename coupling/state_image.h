#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace antiform::coupling
{
/// Contents of an entry; the alternatives' order is the code of their type in the file.
using StateEntry =
    std::variant<std::vector<double>, std::vector<std::int64_t>, std::string>;

/// The data set that lists the others; no entry can be called so.
constexpr const char *state_contents_name = "contents";

/// A whole state file: a text block with version, size and checksum, then an HDF5 image.
/// Throws std::runtime_error when HDF5 cannot make one.
std::string state_bytes(const std::map<std::string, StateEntry> &entries);

/// What is wrong with version, size or checksum of a file, and the remedy; or nothing.
std::string problem_of_state(const std::string &bytes);

/// The entries of a file that has no such problem. Throws std::runtime_error.
std::map<std::string, StateEntry> parse_state(std::string bytes);

/// CRC-64/XZ (ECMA-182 polynomial, reflected) of @p n bytes.
std::uint64_t crc64(const void *bytes, std::size_t n);
} // namespace antiform::coupling
