#pragma once

#include "cases/summary.h"

namespace antiform::cases
{
struct Scene;

/// Let the scene go from one state of balance to the next instead of in time
/// (coupling::EventLoading): the one component beside the record.
void add_event_loading(Scene &scene);

/// What the driver has done and how good its balances are.
void report_events(const Scene &scene, Summary &summary);
} // namespace antiform::cases
