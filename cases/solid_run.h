#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "cases/summary.h"
#include "continuum/static_solver.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace antiform::cases
{
/// What the runs of a section of finite elements alone share (static, buckling).
/// Displacements of the supports: sides follow the walls by half of @p shortening [-]
/// each, the base is held as the deck says.
continuum::DirichletValues section_supports(const Parameters &parameters,
                                            const SectionGeometry &geometry,
                                            const continuum::DisplacementSpace &solid,
                                            double shortening);

/// As Summary::sizes.
std::map<std::string, std::int64_t> sizes_of_solid(const continuum::DisplacementSpace &solid);

/// Everything of the summary that does not depend on what was computed; status and
/// results are the caller's. Collective.
Summary summary_of_run(const Parameters &parameters,
                       MPI_Comm communicator,
                       const std::map<std::string, std::int64_t> &sizes,
                       std::chrono::steady_clock::time_point begin);
Summary summary_of_solid(const Parameters &parameters,
                         const continuum::DisplacementSpace &solid,
                         std::chrono::steady_clock::time_point begin);

/// The deck's effects, with @p solves calls of what is in the system matrix.
void summarise_effects(const Parameters &parameters,
                       std::int64_t solves,
                       Summary &summary);
} // namespace antiform::cases
