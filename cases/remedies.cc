#include "cases/remedies.h"

namespace antiform::cases
{
std::string closer_records(const Parameters &p)
{
  return p.follows_events() || p.walls.steps_and_relaxes()
             ? "lower 'Walls/Load step'"
             : "raise 'Output/Samples per millistrain'";
}

std::string closer_ledger(const Parameters &p)
{
  if (p.follows_events())
    return "lower 'Walls/Balance tolerance', or 'Walls/Load step'";
  return std::string("lower 'Run/Step safety', or ") +
         (p.walls.steps_and_relaxes() ? "lower 'Walls/Load step'"
                                      : "raise 'Walls/Transits per millistrain'");
}

std::string too_few_records(const Parameters &p,
                            const std::string &results,
                            const std::string &span)
{
  return results + " left out: fewer than two records lie " + span + ". To have more, " +
         closer_records(p);
}
} // namespace antiform::cases
