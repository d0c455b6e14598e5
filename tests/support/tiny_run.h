#pragma once

#include "support/files.h"
#include "support/program.h"

#include <gtest/gtest.h>

#include <string>

/// Runs of tests/decks/tiny.prm, each in a folder of its own, compared file by file.
namespace antiform::test
{
inline std::string tiny_deck()
{
  return std::string(ANTIFORM_SOURCE_DIR) + "/tests/decks/tiny.prm";
}

/// A pre-bent layer and its matrix of finite elements, for the static driver.
inline std::string buried_deck()
{
  return std::string(ANTIFORM_SOURCE_DIR) + "/tests/decks/buried.prm";
}

/// --set "ENTRY=VALUE" for each of @p entries.
inline std::string set(const std::vector<std::string> &entries)
{
  std::string text;
  for (const std::string &entry : entries)
    text += " --set \"" + entry + "\"";
  return text;
}

/// Run the tiny deck with @p options into @p directory, to its end.
inline Outcome run_tiny(const std::string &directory,
                        const std::string &options = "",
                        const int n_threads = 1)
{
  return run_program("run " + tiny_deck() + " -o " + directory + " " + options, 1,
                     n_threads);
}

/// A deck that ends long before anything could break.
inline std::vector<std::string> unbreakable(const std::vector<std::string> &more = {})
{
  std::vector<std::string> entries{"Layer/Breakable=false", "Run/End shortening=2e-4"};
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

inline void expect_same_file(const std::string &name,
                             const std::string &directory,
                             const std::string &other)
{
  const std::string a = contents(directory + "/" + name),
                    b = contents(other + "/" + name);
  if (a == b)
    return;
  std::istringstream lines_a(a), lines_b(b);
  std::string line_a, line_b;
  int n = 0;
  do
  {
    ++n;
    line_a = line_b = "(no more lines)";
    std::getline(lines_a, line_a);
    std::getline(lines_b, line_b);
  } while (line_a == line_b);
  ADD_FAILURE() << name << " differs from line " << n << " on:\n"
                << line_a << "\n"
                << line_b;
}

/// What two runs answer: everything in their summaries but times and memory.
inline void expect_same_answers(const std::string &directory, const std::string &other)
{
  const nlohmann::json a = summary_of(directory), b = summary_of(other);
  for (const char *entry : {"status", "results", "energy", "steps", "sizes", "warnings"})
    EXPECT_EQ(a.at(entry), b.at(entry)) << entry;
  const nlohmann::json &effects = a.at("effects"), &others = b.at("effects");
  ASSERT_EQ(effects.size(), others.size());
  for (const auto &[name, effect] : effects.items())
    for (const char *entry : {"active", "calls", "reason"})
      EXPECT_EQ(effect.at(entry), others.at(name).at(entry)) << name << ", " << entry;
}

/// Two runs that took the same steps: the same bits in every file that holds numbers.
inline void expect_same_run(const std::string &directory, const std::string &other)
{
  for (const char *name : {"deck.prm", "history.csv", "cracks.csv"})
    expect_same_file(name, directory, other);
  expect_same_answers(directory, other);
}
} // namespace antiform::test
