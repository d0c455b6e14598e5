#pragma once

#include <optional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// Packings on disk, by everything that made them. A convenience only: with and without
/// it a run has the same bits, and no fault of it is an error. Files may be deleted at
/// any time.
class PackingCache
{
public:
  /// @p directory is made when first needed; empty: nothing is kept or found.
  explicit PackingCache(std::string directory);
  /// Where ANTIFORM_CACHE says (off: nowhere), or antiform in $XDG_CACHE_HOME, or in
  /// ~/.cache.
  static std::string default_directory();

  /// What was stored under @p key. \param[out] complaint why a file that is there cannot
  /// be used
  std::optional<std::vector<double>> find(const std::string &key,
                                          std::string &complaint) const;
  /// Returns whether it has been written; a full disk or a folder that is not writable is
  /// no error.
  bool store(const std::string &key, const std::vector<double> &numbers) const;
  /// The file of @p key; empty without a directory.
  std::string file(const std::string &key) const;

private:
  std::string directory_;
};
} // namespace antiform::cases
