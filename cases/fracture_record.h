#pragma once

#include "cases/scene.h"
#include "cases/summary.h"

#include <string>

namespace antiform::cases
{
/// Results of pre-existing fractures: how many, how dense, how far they have slid.
void report_fractures(const Scene &scene, Summary &summary);

/// Fractures where they are now, a line for every pair of grains across them: slip,
/// opening and stresses [m, Pa]. \pre the scene has some
void write_fractures(const std::string &path, const Scene &scene);
} // namespace antiform::cases
