#pragma once

#include "cases/parameters.h"

#include <map>
#include <string>

namespace antiform::cases
{
/// The deck of a run's directory, with the files that it names: rocks of beds, the table
/// of fractures. They stand beside it, so that the directory can be taken anywhere, and
/// the deck is the same text wherever the user's files are.
struct RunDeck
{
  explicit RunDeck(const Parameters &parameters);

  std::string text;
  std::map<std::string, std::string> files; ///< name -> bytes

  /// Deck and files as one deck without includes: by it a resumed run sees what has
  /// changed.
  std::string everything;

  /// Write all into @p directory. Throws InputError, before anything is written, when a
  /// file there is in the way that no run has written; and when the disk is full.
  void write(const std::string &directory) const;
};
} // namespace antiform::cases
