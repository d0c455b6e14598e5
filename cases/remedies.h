#pragma once

#include "cases/parameters.h"

#include <string>

/// What to do about a run, in the entries that its driver reads: ends of sentences.
namespace antiform::cases
{
/// More records over the same strain: "lower 'Walls/Load step'".
std::string closer_records(const Parameters &parameters);
/// A smaller error of the energy ledger.
std::string closer_ledger(const Parameters &parameters);

/// That @p results could not be told: "the section stiffness is left out: ...".
/// \param span what has fewer than two records
std::string too_few_records(const Parameters &parameters,
                            const std::string &results,
                            const std::string &span);
} // namespace antiform::cases
