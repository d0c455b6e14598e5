#pragma once

#include "cases/parameters.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// An entry, or a subsection of entries, whose value changes nothing in a scene although
/// the scene reads the section that it stands in.
struct IdleEntry
{
  std::string path;   ///< "Section/Entry"; of a subsection "Section/Subsection/"
  std::string reason; ///< what decides instead
};

/// Those that are known; an entry that is not among them may be idle all the same.
std::vector<IdleEntry> idle_entries(const Parameters &parameters);

/// The reason why @p path is idle in a scene; empty: it is not known to be.
std::string why_idle(const std::vector<IdleEntry> &entries, const std::string &path);

/// Lines of the deck @p file itself (what it includes serves other scenes too) and of
/// --set that change nothing, each with its place and the reason. Of the deck's those
/// that say the default are left out; no file: of --set alone.
std::vector<std::string> idle_lines(const std::string &file,
                                    const std::vector<std::string> &overrides,
                                    const Parameters &parameters);
} // namespace antiform::cases
