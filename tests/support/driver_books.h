#pragma once
#include "coupling/event_driver.h"

#include <algorithm>
#include <cmath>

namespace antiform::coupling::test
{
/// What the books of the records leave open, over what they hold.
inline double open_share(const DriverReport &report)
{
  double worst = 0., scale = 0.;
  for (const LoadRecord &record : report.records)
  {
    const Energies &e = record.energies;
    worst = std::max(worst, std::abs(e.boundary_work - e.stored_and_spent()));
    scale = std::max(scale, e.magnitude());
  }
  return worst / scale;
}
} // namespace antiform::coupling::test
