#pragma once

#include "cases/scene.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// Write the field files of the present state (grains, joints, cracks, continuum) under
/// DIRECTORY/fields with the number of the last entry of @p times, and rewrite
/// fields.pvd, whose times they are (Scene::field_time()). docs/output.md lists the fields.
void write_field_files(const Scene &scene,
                       const std::string &directory,
                       const std::vector<double> &times);
} // namespace antiform::cases
