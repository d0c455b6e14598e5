#include "cases/study.h"

#include "cases/deck_reader.h"
#include "cases/directory_lock.h"
#include "cases/interrupt.h"
#include "cases/output_directory.h"
#include "cases/run_log.h"
#include "cases/study_prediction.h"
#include "cases/study_tables.h"
#include "coupling/output/whole_file.h"

#include <nlohmann/json.hpp>

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;

/// Settle where a study writes, before any work. Throws InputError when the directory
/// holds something else.
void prepare_study_directory(RunOptions &options)
{
  if (options.output.empty())
    options.output = default_output(options.deck);
  const std::string begin = "output directory '" + options.output + "': ";
  const fs::path directory(options.output);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw InputError({begin + "cannot be created (" + error.message() +
                      "). Give one that can be written to with -o DIR."});
  prove_writable(options.output);
  if (fs::exists(directory / "study.json", error))
    return;
  for (const char *name : {"state.h5", "history.csv", "modes.csv", "summary.json",
                           "calibration.json", "trials.csv", "members"})
    if (fs::exists(directory / name, error))
      throw InputError({begin + "holds something else than a study (" + name +
                        "). Give another directory with -o DIR."});
}

/// Names of the members that the study had when it was last at work there.
std::set<std::string> former_members(const std::string &directory)
{
  std::set<std::string> names;
  std::ifstream input(directory + "/study.json");
  const auto json = nlohmann::json::parse(input, nullptr, false);
  if (json.is_object() && json.contains("members"))
    for (const auto &member : json["members"])
      names.insert(member.value("name", std::string()));
  return names;
}

std::string some_of(const std::vector<std::string> &names)
{
  constexpr std::size_t most = 6;
  const std::vector<std::string> first(
      names.begin(),
      names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size())));
  return join(first) + (names.size() > most ? ", ..." : "");
}

/// What has changed of the choice of members, in words; nothing of a new study.
std::vector<std::string> changes_of_choice(const std::set<std::string> &former,
                                           const std::vector<MemberDeck> &decks)
{
  std::vector<std::string> added, gone, lines;
  std::set<std::string> now;
  for (const MemberDeck &deck : decks)
  {
    now.insert(deck.member.name);
    if (former.count(deck.member.name) == 0)
      added.push_back(deck.member.name);
  }
  for (const std::string &name : former)
    if (now.count(name) == 0)
      gone.push_back(name);
  if (former.empty())
    return lines;
  if (!added.empty())
    lines.push_back("the study has changed: " + std::to_string(added.size()) +
                    " new: " + some_of(added));
  if (!gone.empty())
    lines.push_back(
        "the study has changed: " + std::to_string(gone.size()) +
        " of before are not in it any more, their runs are left as they are: " +
        some_of(gone));
  return lines;
}

std::string end_in_words(const StudyMembers &members, const double seconds)
{
  const auto said = [&](const std::string &status, const std::string &what)
  {
    const std::size_t n = members.count(status);
    return n > 0 ? ", " + std::to_string(n) + " " + what : "";
  };
  char text[96];
  std::snprintf(text, sizeof text, " (%d of them found), %.0f s", members.n_found(),
                seconds);
  return std::to_string(members.decks().size()) +
         " members: " + std::to_string(members.count("completed")) + " completed" +
         said("failed", "failed") + said("interrupted", "interrupted") +
         said("waiting", "not begun") + text;
}
} // namespace

int run_study(const RunOptions &given, const int jobs_wanted)
{
  RunOptions options = given;
  const StudyParameters study = read_study(options.deck, options.overrides);
  MachineSpeed speed;
  const std::vector<MemberDeck> decks =
      read_members(options.deck, options.overrides, study, speed);
  prepare_study_directory(options);
  const DirectoryLock lock(options.output, "another study",
                           DirectoryLock::Children::let_go);
  demand_same_decks(options.output, decks);
  const std::set<std::string> former = former_members(options.output);

  const int cores = cores_of_machine();
  const int jobs = jobs_wanted > 0 ? jobs_wanted
                                   : std::max(1, cores / std::max(1, options.threads));
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, std::min(cores, omp_get_max_threads()) / jobs);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&]
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
        .count();
  };
  RunLog log(options.output + "/log.txt", true, true);
  const std::string title = decks.front().scene;
  if (const std::string deck = deck_of_study(options.deck, options.overrides, study);
      !deck.empty())
    coupling::replace_file(options.output + "/deck.prm", deck);
  log.line("antiform " ANTIFORM_VERSION ": study of " + title + ", " +
           std::to_string(decks.size()) + " members, " + std::to_string(jobs) +
           " at once, predicted to take " +
           duration_text(predicted_seconds(decks, jobs)));
  for (const std::string &line : varied_in_vain(decks))
    log.line("note: " + line);
  for (const std::string &line : changes_of_choice(former, decks))
    log.line(line);
  catch_interrupts();

  std::vector<std::string> ignored; // read_study() has found none
  const StudyTable table(paths_of(read_axes(study.vary, ignored)), study.collect);
  const auto write = [&](const StudyMembers &members, const std::string &status)
  {
    coupling::replace_file(options.output + "/study.csv", table.csv(members));
    coupling::replace_file(options.output + "/study.json",
                           table.json(members, title, status, elapsed()));
  };
  StudyMembers members(
      options.output, decks, jobs, threads,
      [&](const std::string &text) { log.line(text); },
      [&](const StudyMembers &changed) { write(changed, "running"); });
  const bool went_through = members.run();
  const bool interrupted = !went_through || members.count("interrupted") > 0;
  const bool failed = members.count("failed") > 0;
  write(members, interrupted ? "interrupted" : (failed ? "failed" : "completed"));
  for (const auto &texts : {table.missing(members), StudyTable::warnings_of(members)})
    for (const std::string &text : texts)
      log.line("warning: " + text);
  log.line(end_in_words(members, elapsed()));
  log.line(
      (interrupted ? "interrupted: the same command goes on; so far in " : "table: ") +
      options.output + "/study.csv");
  return interrupted ? 3 : (failed ? 2 : 0);
}
} // namespace antiform::cases
