#pragma once

#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// A linear form of the displacements of grains and mesh: a constraint (form = 0) or the
/// elongation of a spring.
struct LinearForm
{
  struct GrainTerm
  {
    std::int32_t grain;
    unsigned int component; ///< 0: x, 1: y [m], 2: rotation [rad]
    double value;
  };
  struct MeshTerm
  {
    std::uint32_t dof;
    double value;
  };
  std::vector<GrainTerm> grains;
  std::vector<MeshTerm> mesh;
};
} // namespace antiform::coupling
