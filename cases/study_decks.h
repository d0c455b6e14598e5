#pragma once

#include "cases/machine_speed.h"
#include "cases/parameters.h"
#include "cases/summary.h"

#include <map>
#include <string>
#include <vector>

namespace antiform::cases
{
/// A member of a study and what it runs.
struct MemberDeck
{
  StudyMember member;
  std::string scene;        ///< title of the study's deck
  std::string text;         ///< of its deck
  std::string checksum;     ///< of the deck and the files that it names
  double core_seconds = 0.; ///< predicted
  double memory = 0.;       ///< predicted [bytes]
  /// What 'antiform theory' says of its scene, "theory/critical/scene_smooth/wavelength";
  /// empty unless the study collects of it.
  std::map<std::string, Result> theory;
  /// Entries that the study varies and that change nothing in this member, and why.
  std::map<std::string, std::string> idle;
};

/// Those of --set that are not of the section Study.
std::vector<std::string> overrides_of_scene(const std::vector<std::string> &overrides);

/// Whether the deck says what to vary.
bool has_study(const std::string &file, const std::vector<std::string> &overrides);

/// Read the deck of every member: the study's, its @p overrides and the member's values.
/// Throws InputError with the problems of all members at once, those that several have
/// named once; and when two members are the same run.
/// \param speed by which their cost is predicted
std::vector<MemberDeck> read_members(const std::string &file,
                                     const std::vector<std::string> &overrides,
                                     const StudyParameters &study,
                                     MachineSpeed &speed);

/// Of all members, had none been run, @p jobs of them at once [s].
double predicted_seconds(const std::vector<MemberDeck> &members, int jobs);

/// What the study varies without effect in any member, in words.
std::vector<std::string> varied_in_vain(const std::vector<MemberDeck> &members);

/// The scene that the members of a study change.
struct StudyBase
{
  Parameters scene;
  std::string member; ///< the first one, where the deck without its values is no scene
};
StudyBase read_base(const std::string &file,
                    const std::vector<std::string> &overrides,
                    const StudyParameters &study);

/// The deck of the study itself, by which it can be repeated; empty when the scene is
/// none without the values of a member.
std::string deck_of_study(const std::string &file,
                          const std::vector<std::string> &overrides,
                          const StudyParameters &study);

/// Where a member's files are: `DIRECTORY/members/NAME`, `NAME.prm`, `NAME.out`.
std::string member_folder(const std::string &directory, const std::string &name);

/// The deck that a member is run from, with its checksum.
void write_member_deck(const std::string &directory, const MemberDeck &deck);

/// Throws InputError when members have been run there from other decks than these: a
/// study is of one deck. A changed choice of members is none of this.
void demand_same_decks(const std::string &directory,
                       const std::vector<MemberDeck> &members);
} // namespace antiform::cases
