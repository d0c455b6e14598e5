#include "cases/prestress.h"

#include "continuum/loads.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>

namespace antiform::cases
{
using namespace discrete;

namespace
{
Vec2 contact_point(const Grains &grains, const Joints &joints, const std::size_t j)
{
  const double r1 = 0.5 * (joints.length[j] - joints.lever_difference[j]);
  return grains.reference(joints.first[j]) +
         r1 * Vec2{joints.normal_x[j], joints.normal_y[j]};
}

/// Joints of the tile by their grains.
class TileField
{
public:
  explicit TileField(const MatrixRock &rock)
      : rock_(rock)
  {
    // Strain of a unit isotropic pressure: C e = -(1, 1, 0).
    Eigen::Matrix3d c;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        c(a, b) = rock.response.stiffness[a][b];
    strain_ = c.ldlt().solve(Eigen::Vector3d(-1., -1., 0.));
    for (std::size_t k = 0; k < rock.response.joints.size(); ++k)
    {
      const TileJoint &joint = rock.response.joints[k];
      by_grains_.emplace(std::make_pair(joint.first, joint.second), k);
    }
  }

  /// Gap, shear and rotation under unit pressure of the joint of tile grains @p a, @p b
  /// with this branch. False when the tile has no such joint.
  bool
  deformation(const int a, const int b, const Vec2 &branch, JointDeformation &d) const
  {
    return find(a, b, branch, 1., d) || find(b, a, -branch, -1., d);
  }

private:
  bool find(const int a,
            const int b,
            const Vec2 &branch,
            const double rotation_sign,
            JointDeformation &d) const
  {
    const auto range = by_grains_.equal_range({a, b});
    for (auto it = range.first; it != range.second; ++it)
    {
      const TileJoint &joint = rock_.response.joints[it->second];
      const Vec2 own =
          rock_.tile.disks[b].centre + joint.shift - rock_.tile.disks[a].centre;
      if (norm(own - branch) > 1e-6 * norm(branch))
        continue;
      double value[3] = {0., 0., 0.};
      for (int strain = 0; strain < 3; ++strain)
        for (int row = 0; row < 3; ++row)
          value[row] +=
              strain_[strain] * rock_.response.deformation[it->second][strain][row];
      d = {value[0], value[1], rotation_sign * value[2]};
      return true;
    }
    return false;
  }

  const MatrixRock &rock_;
  Eigen::Vector3d strain_;
  std::multimap<std::pair<int, int>, std::size_t> by_grains_;
};

/// Force per pressure and per sum of radii in the joints of the layer: mean stress
/// 1/(2A) sum f d = P with f = c P (R1 + R2).
double force_factor(const Grains &grains, const Joints &joints, const double layer_area)
{
  double sum = 0.;
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    if (grains.region[one] == layer_region && grains.region[two] == layer_region)
      sum += (grains.radius[one] + grains.radius[two]) * joints.length[j];
  }
  return 2. * layer_area / sum;
}

void guess_joints(Scene &scene, const Prestress &prestress, const double factor)
{
  const Grains &grains = scene.grains->state.grains;
  Joints &joints = scene.grains->state.joints;
  for (std::vector<double> *v :
       {&joints.initial_gap, &joints.initial_shear, &joints.initial_rotation})
    v->assign(joints.size(), 0.);
  const std::vector<int> &copies = scene.grains->tile_grain;
  std::optional<TileField> tile;
  if (scene.grains->matrix)
    tile.emplace(*scene.grains->matrix);
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const std::size_t one = joints.first[j], two = joints.second[j];
    const double pressure = prestress.pressure(contact_point(grains, joints, j).y);
    JointDeformation d;
    if (copies[one] >= 0 && copies[two] >= 0 &&
        tile->deformation(copies[one], copies[two],
                          grains.reference(two) - grains.reference(one), d))
    {
      joints.initial_gap[j] = pressure * d.gap;
      joints.initial_shear[j] = pressure * d.shear;
      joints.initial_rotation[j] = pressure * d.rotation;
    }
    else
      joints.initial_gap[j] = -factor * pressure *
                              (grains.radius[one] + grains.radius[two]) /
                              (joints.stiffness[j] * 2. * joints.half_length[j]);
  }
}

/// Contacts of an unbonded interface press from the start.
void guess_contacts(Scene &scene, const Prestress &prestress, const double factor)
{
  const Grains &grains = scene.grains->state.grains;
  for (Contacts::Installed &pair : scene.contacts.installed)
  {
    Contact contact;
    contact.first = pair.first;
    contact.second = pair.second;
    const double sum = grains.radius[pair.first] + grains.radius[pair.second];
    const double stiffness =
        normal_stiffness(scene.contacts.law(grains, contact), grains.radius[pair.first],
                         grains.radius[pair.second]);
    const double y =
        0.5 * (grains.reference_y[pair.first] + grains.reference_y[pair.second]);
    pair.reference_gap += factor * prestress.pressure(y) * sum / stiffness;
  }
}

/// Walls press with P on the height that each region has at them.
void press_walls(Scene &scene, const Prestress &prestress)
{
  const Grains &grains = scene.grains->state.grains;
  const SectionGeometry &g = scene.geometry;
  for (Wall &wall : scene.walls)
  {
    const double x = wall.point.x;
    double top = g.surface(), bottom = g.base();
    if (scene.bridging)
    {
      if (!g.has_grain_cover())
        top = g.core_top(x) + scene.bridging->weight().width;
      bottom = g.core_bottom(x) - scene.bridging->weight().width;
    }
    double height[2] = {g.thickness(), top - bottom - g.thickness()};
    double width[2] = {0., 0.};
    const auto presses = [&](const WallContact &contact) // the first row, not the second
    { return contact.reference_gap != 0.; };
    for (const WallContact &contact : wall.contacts)
      if (presses(contact))
        width[grains.region[contact.grain]] += 2. * grains.radius[contact.grain];
    for (WallContact &contact : wall.contacts)
      if (presses(contact))
      {
        const int region = grains.region[contact.grain];
        const double share =
            2. * grains.radius[contact.grain] * height[region] / width[region];
        contact.initial_gap = -prestress.pressure(grains.reference_y[contact.grain]) *
                              share / contact.stiffness;
      }
  }
}

/// Vertical external forces on the grains: gravity, surface pressure [N].
std::vector<double> external_forces(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  const Grains &grains = scene.grains->state.grains;
  std::vector<double> force(grains.size(), 0.);
  if (p.has("gravity"))
    for (std::size_t i = 0; i < grains.size(); ++i)
      force[i] -=
          grains.mass[i] * p.gravity.acceleration *
          (scene.bridging ? scene.bridging->weight().grains(grains.reference(i)) : 1.);
  if ((!scene.mesh || p.has_grain_cover()) && p.has("surface pressure"))
    for (const auto &[i, width] : surface_grains(*scene.grains, scene.geometry))
      force[i] -= p.pressure_on_top() * width;
  return force;
}

/// Contacts of a surface interface press from the start: on the grains, and on the nodes
/// of the edge. @p mesh_force holds the free ones; walls feel what presses on theirs.
void press_edges(Scene &scene, continuum::Vector &mesh_force)
{
  if (!scene.surface)
    return;
  continuum::Vector pressed = scene.solid->make_vector();
  for (const auto &contact : scene.surface->contacts)
    contact->add_forces(scene.grains->state.grains, scene.mesh->displacement,
                        scene.mesh->velocity, 0., pressed);
  for (const auto dof : scene.solid->locally_owned())
    if (scene.mesh->inverse_mass(dof) > 0.)
      mesh_force(dof) -= pressed(dof);
}

/// What the forces of joints, walls, contacts and loads leave over on each grain,
/// opposite. \param mesh_force likewise what holds the mesh
std::vector<coupling::GrainLoad> holding_forces(Scene &scene,
                                                const std::vector<double> &loads,
                                                continuum::Vector &mesh_force)
{
  Grains &grains = scene.grains->state.grains;
  Joints &joints = scene.grains->state.joints;
  compute_joint_forces(grains, joints, {}, nullptr);
  press_edges(scene, mesh_force);
  for (Wall &wall : scene.walls)
    add_wall_forces(grains, wall);
  if (!scene.contacts.installed.empty())
  {
    scene.contacts.contacts.clear(); // found before they had the prestress
    search_contacts(grains, joints, scene.contacts);
    add_contact_forces(grains, scene.contacts, 0.);
  }
  std::vector<coupling::GrainLoad> held(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i)
    held[i] = {static_cast<std::int32_t>(i),
               {-grains.force_x[i], -grains.force_y[i] - loads[i]},
               -grains.torque[i]};
  return held;
}

/// Turn the prestress of joints that cannot break into resultants on their grains.
void take_from_unbreakable(Scene &scene, std::vector<coupling::GrainLoad> &held)
{
  Joints &joints = scene.grains->state.joints;
  bool all = true;
  for (const JointGroup &group : joints.groups)
  {
    all = all && !discrete::constants(group.law).breakable;
    if (discrete::constants(group.law).breakable)
      continue;
    for (std::size_t j = group.begin; j < group.end; ++j)
    {
      const JointForce &force = joints.force[j];
      coupling::GrainLoad &one = held[joints.first[j]], &two = held[joints.second[j]];
      one.force += Vec2{-force.x, -force.y};
      one.torque += force.torque1;
      two.force += Vec2{force.x, force.y};
      two.torque += force.torque2;
      joints.initial_gap[j] = joints.initial_shear[j] = joints.initial_rotation[j] = 0.;
    }
  }
  if (all)
    for (std::vector<double> *v :
         {&joints.initial_gap, &joints.initial_shear, &joints.initial_rotation})
      v->clear();
}
} // namespace

Prestress prestress_of(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  Prestress prestress;
  prestress.surface = scene.geometry.surface();
  if (p.has("surface pressure"))
    prestress.surface_pressure = p.pressure_on_top();
  if (p.has("gravity"))
    prestress.unit_weight =
        p.gravity.acceleration * (scene.grains && scene.grains->matrix
                                      ? scene.grains->matrix->bulk_density
                                  : p.has("matrix") ? p.matrix_density()
                                                    : p.layer_density());
  return prestress;
}

InstalledPrestress install_prestress(Scene &scene, const continuum::Vector &loads)
{
  const Prestress prestress = prestress_of(scene);
  InstalledPrestress installed;
  if (scene.mesh)
  {
    // Free nodes are at rest; the walls feel the pressure of the mesh beside them.
    installed.mesh_force = continuum::prestress(*scene.solid,
                                                [&](const dealii::Point<2> &x)
                                                {
                                                  dealii::SymmetricTensor<2, 2> stress;
                                                  stress[0][0] = stress[1][1] =
                                                      -prestress.pressure(x[1]);
                                                  return stress;
                                                });
    for (const auto dof : scene.solid->locally_owned())
      if (scene.mesh->inverse_mass(dof) > 0.)
        installed.mesh_force(dof) = -loads(dof);
  }
  if (scene.grains)
  {
    const Grains &grains = scene.grains->state.grains;
    const double factor =
        force_factor(grains, scene.grains->state.joints,
                     scene.geometry.length() * scene.geometry.thickness());
    guess_joints(scene, prestress, factor);
    guess_contacts(scene, prestress, factor);
    press_walls(scene, prestress);
    installed.grain_loads =
        holding_forces(scene, external_forces(scene), installed.mesh_force);
    take_from_unbreakable(scene, installed.grain_loads);
  }
  return installed;
}
} // namespace antiform::cases
