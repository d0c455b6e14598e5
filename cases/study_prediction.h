#pragma once

#include "cases/program.h"
#include "cases/study_decks.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What a study runs, and what its members take; builds nothing.
struct StudyPrediction
{
  StudyParameters study;
  std::vector<StudyAxis> axes;
  std::vector<MemberDeck> members;
  StudyBase base;

  double core_seconds() const { return predicted_seconds(members, 1); }
  double memory() const; ///< of the member that takes most [bytes]
};

/// Throws InputError, with the problems of all members.
StudyPrediction predict_study(const RunOptions &options, MachineSpeed &speed);

/// How many members, what is varied, what one and what all of them take; last of all what
/// the scene is that is told of next.
void print_study(const StudyPrediction &prediction, std::ostream &out);

/// The same for programs, as JSON.
std::string study_json(const StudyPrediction &prediction);

/// How many members run at once where the user does not say.
int cores_of_machine();
} // namespace antiform::cases
