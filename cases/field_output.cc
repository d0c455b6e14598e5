#include "cases/field_output.h"

#include "cases/fracture_record.h"
#include "coupling/output/mesh_vtu.h"
#include "coupling/output/vtu.h"

#include <algorithm>
#include <cstdio>

namespace antiform::cases
{
using coupling::Field;
using Points = std::vector<std::array<double, 3>>;

namespace
{
std::string numbered(const std::string &group, const std::size_t number)
{
  char text[32];
  std::snprintf(text, sizeof text, "_%04zu.vtu", number);
  return "fields/" + group + text;
}

Points grain_centres(const discrete::Grains &grains)
{
  Points points;
  for (std::size_t i = 0; i < grains.size(); ++i)
    points.push_back({grains.position(i).x, grains.position(i).y, 0.});
  return points;
}

/// Mean stress of each grain from the forces of its joints, 1/A sum of lever times force
/// (tension positive).
void grain_stress(const coupling::GrainState &state, Field &xx, Field &yy, Field &xy)
{
  const discrete::Grains &grains = state.grains;
  for (Field *field : {&xx, &yy, &xy})
    field->values.assign(grains.size(), 0.);
  const discrete::Joints &joints = state.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const double w = joints.weight.empty() ? 1. : joints.weight[j];
    const Vec2 n{joints.normal_x[j], joints.normal_y[j]};
    const Vec2 force = (1. / w) * Vec2{joints.force[j].x, joints.force[j].y};
    for (const int side : {0, 1})
    {
      const std::size_t i = side == 0 ? joints.first[j] : joints.second[j];
      const double lever =
          0.5 * (joints.length[j] + (side == 0 ? -1. : 1.) * joints.lever_difference[j]);
      // The force on the second acts at -lever n from it; on the first the opposite at
      // +lever n: the same product.
      const double area = M_PI * grains.radius[i] * grains.radius[i];
      xx.values[i] -= lever * n.x * force.x / area;
      yy.values[i] -= lever * n.y * force.y / area;
      xy.values[i] -= 0.5 * lever * (n.x * force.y + n.y * force.x) / area;
    }
  }
}

void write_grains(const std::string &path, const Scene &scene)
{
  const coupling::GrainState &state = scene.grains->state;
  const discrete::Grains &grains = state.grains;
  Field displacement{"displacement_m", 3, {}}, region{"region", 1, {}},
      weight{"weight", 1, {}};
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    displacement.values.insert(displacement.values.end(),
                               {grains.displacement_x[i], grains.displacement_y[i], 0.});
    region.values.push_back(grains.region[i]);
    weight.values.push_back(
        scene.bridging ? scene.bridging->weight().grains(grains.reference(i)) : 1.);
  }
  Field xx{"stress_xx_Pa", 1, {}}, yy{"stress_yy_Pa", 1, {}}, xy{"stress_xy_Pa", 1, {}};
  grain_stress(state, xx, yy, xy);
  coupling::write_points_vtu(path, grain_centres(grains),
                             {{"radius_m", 1, grains.radius},
                              displacement,
                              {"rotation_rad", 1, grains.rotation},
                              region,
                              weight,
                              xx,
                              yy,
                              xy});
}

void write_joints(const std::string &path, const coupling::GrainState &state)
{
  const discrete::Grains &grains = state.grains;
  const discrete::Joints &joints = state.joints;
  std::vector<std::array<long, 2>> lines;
  Field normal{"normal_force_N", 1, {}}, shear{"shear_force_N", 1, {}};
  Field bonds{"bonds_left", 1, {}}, group{"group", 1, {}};
  for (std::size_t g = 0; g < joints.groups.size(); ++g)
    for (std::size_t j = joints.groups[g].begin; j < joints.groups[g].end; ++j)
    {
      const std::size_t one = joints.first[j], two = joints.second[j];
      lines.push_back({static_cast<long>(one), static_cast<long>(two)});
      const double turn = 0.5 * (grains.rotation[one] + grains.rotation[two]);
      const Vec2 n = rotated({joints.normal_x[j], joints.normal_y[j]}, turn);
      const double w = joints.weight.empty() ? 1. : joints.weight[j];
      const Vec2 force = (-1. / w) * Vec2{joints.force[j].x, joints.force[j].y};
      normal.values.push_back(dot(force, n)); // tension positive
      shear.values.push_back(dot(force, perpendicular(n)));
      const int n_elements = discrete::constants(joints.groups[g].law).n_elements;
      int left = n_elements;
      for (int e = 0; joints.damage[j] >= 0 && e < n_elements; ++e)
        left -= joints.damaged.bond(joints.damage[j], e) != discrete::Bond::bonded;
      bonds.values.push_back(static_cast<double>(left));
      group.values.push_back(static_cast<double>(g));
    }
  coupling::write_lines_vtu(path, grain_centres(grains), lines,
                            {normal, shear, bonds, group});
}

/// Cracks where they are now: carried by one of the two grains.
/// \param field_time of the file
void write_cracks(const std::string &path, const Scene &scene, const double field_time)
{
  const coupling::GrainState &state = scene.grains->state;
  Points points;
  Field mode{"mode", 1, {}}, length{"length_m", 1, {}},
      orientation{"orientation_rad", 1, {}};
  Field time{"time_s", 1, {}}, layer{"layer", 1, {}};
  Field when{scene.parameters.bends() ? "wall_rotation_deg" : "shortening", 1, {}};
  const discrete::Grains &grains = state.grains;
  for (const discrete::Crack &crack : state.cracks)
  {
    const std::size_t one = crack.grain;
    const Vec2 arm =
        rotated(crack.reference_place - grains.reference(one), grains.rotation[one]);
    const Vec2 place = grains.position(one) + arm;
    points.push_back({place.x, place.y, 0.});
    mode.values.push_back(static_cast<double>(crack.mode));
    length.values.push_back(crack.length);
    orientation.values.push_back(crack.orientation);
    time.values.push_back(crack.time);
    when.values.push_back(field_time);
    layer.values.push_back(crack.layer);
  }
  coupling::write_points_vtu(path, points,
                             {mode, length, orientation, time, when, layer});
}
} // namespace

void write_field_files(const Scene &scene,
                       const std::string &directory,
                       const std::vector<double> &times)
{
  const std::size_t number = times.size() - 1;
  std::vector<std::string> groups;
  if (scene.mesh)
    groups.push_back("continuum");
  if (scene.grains)
    groups.insert(groups.end(), {"grains", "joints", "cracks"});
  if (scene.grains && scene.grains->smooth)
    groups.push_back("fractures");
  for (const std::string &group : groups)
  {
    const std::string path = directory + "/" + numbered(group, number);
    if (group == "continuum")
      coupling::write_mesh_vtu(path, *scene.solid, scene.mesh->displacement);
    else if (group == "grains")
      write_grains(path, scene);
    else if (group == "joints")
      write_joints(path, scene.grains->state);
    else if (group == "fractures")
      write_fractures(path, scene);
    else
      write_cracks(path, scene, times.back());
  }
  if (scene.mesh && dealii::Utilities::MPI::this_mpi_process(
                        scene.solid->dof_handler().get_communicator()) != 0)
    return;
  std::vector<coupling::PvdEntry> entries;
  for (std::size_t k = 0; k < times.size(); ++k)
    for (const std::string &group : groups)
      entries.push_back({times[k], group, numbered(group, k)});
  coupling::write_pvd(directory + "/fields.pvd", entries);
}
} // namespace antiform::cases
