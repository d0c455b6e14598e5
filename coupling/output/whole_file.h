#pragma once

#include <string>

namespace antiform::coupling
{
/// Put @p bytes at @p path so that a reader, a kill or a full disk never sees half a
/// file: written to `path.tmp` in the same folder, flushed to disk, renamed. On failure
/// the former file is as it was, the temporary one is removed, and std::runtime_error
/// names the file and the reason.
void replace_file(const std::string &path, const std::string &bytes);

/// Everything that @p path holds. Throws std::runtime_error with file and reason.
std::string read_file(const std::string &path);

/// Write all of @p bytes to the open file @p descriptor; false, with errno set, if not
/// all could be written.
bool write_all(int descriptor, const std::string &bytes);
} // namespace antiform::coupling
