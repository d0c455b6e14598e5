#include "cases/grain_fields.h"

#include "coupling/output/vtu.h"

namespace antiform::cases
{
using coupling::Field;

namespace
{
std::vector<std::array<double, 3>> places_of(const discrete::Grains &grains)
{
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i < grains.size(); ++i)
    places.push_back({grains.reference_x[i], grains.reference_y[i], 0.});
  return places;
}
} // namespace

discrete::JointTension tension_in(const discrete::Joints &joints,
                                  const std::size_t j,
                                  const coupling::StaticSolution &state)
{
  const auto rows = coupling::joint_rows(joints, j);
  const auto one = static_cast<std::size_t>(joints.first[j]),
             two = static_cast<std::size_t>(joints.second[j]);
  const std::array<double, 6> u{{state.ux[one], state.uy[one], state.rotation[one],
                                 state.ux[two], state.uy[two], state.rotation[two]}};
  discrete::JointDeformation d;
  for (std::size_t a = 0; a < 6; ++a)
  {
    d.gap += rows[0][a] * u[a];
    d.shear += rows[1][a] * u[a];
  }
  return discrete::intact_tension(joints, j, d);
}

void write_static_grains(const std::string &path,
                         const discrete::Grains &grains,
                         const coupling::StaticSolution &state,
                         const double factor)
{
  Field displacement{"displacement_m", 3, {}}, rotation{"rotation_rad", 1, {}},
      region{"region", 1, {}};
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    displacement.values.insert(displacement.values.end(),
                               {factor * state.ux[i], factor * state.uy[i], 0.});
    rotation.values.push_back(factor * state.rotation[i]);
    region.values.push_back(grains.region[i]);
  }
  coupling::write_points_vtu(
      path, places_of(grains),
      {{"radius_m", 1, grains.radius}, displacement, rotation, region});
}

void write_static_joints(const std::string &path,
                         const discrete::Grains &grains,
                         const discrete::Joints &joints,
                         const coupling::StaticSolution &state,
                         const double factor)
{
  std::vector<std::array<long, 2>> lines;
  Field normal{"normal_force_N", 1, {}}, shear{"shear_force_N", 1, {}},
      group{"group", 1, {}};
  for (std::size_t g = 0; g < joints.groups.size(); ++g)
    for (std::size_t j = joints.groups[g].begin; j < joints.groups[g].end; ++j)
    {
      const discrete::JointTension T = tension_in(joints, j, state);
      const double whole = factor / (joints.weight.empty() ? 1. : joints.weight[j]);
      lines.push_back({joints.first[j], joints.second[j]});
      normal.values.push_back(whole * T.normal);
      shear.values.push_back(whole * T.shear);
      group.values.push_back(static_cast<double>(g));
    }
  coupling::write_lines_vtu(path, places_of(grains), lines, {normal, shear, group});
}
} // namespace antiform::cases
