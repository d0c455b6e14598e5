#include "cases/prestress.h"

#include "continuum/loads.h"
#include "continuum/section_mesh.h"
#include "coupling/static_system.h"
#include "discrete/errors.h"

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

/// Vertical external forces on the grains: gravity, surface pressure, base.
std::vector<double>
grain_loads(const Scene &scene, const Prestress &prestress, InstalledPrestress &installed)
{
  const Parameters &p = scene.parameters;
  const Grains &grains = scene.grains->state.grains;
  std::vector<double> force(grains.size(), 0.);
  if (p.has("gravity"))
    for (std::size_t i = 0; i < grains.size(); ++i)
      force[i] -=
          grains.mass[i] * p.gravity.acceleration *
          (scene.bridging ? scene.bridging->weight().grains(grains.reference(i)) : 1.);
  const bool all_grains = !scene.mesh;
  if (all_grains && p.has("surface pressure"))
    for (const auto &[i, width] : surface_grains(*scene.grains, scene.geometry))
      force[i] -= p.surface_pressure.pressure * width;
  if (all_grains && p.has("foundation"))
  {
    installed.grain_base_force.assign(grains.size(), 0.);
    for (const auto &[i, width] : base_grains(*scene.grains, scene.geometry))
      installed.grain_base_force[i] = prestress.pressure(scene.geometry.base()) * width;
    for (std::size_t i = 0; i < grains.size(); ++i)
      force[i] += installed.grain_base_force[i];
  }
  return force;
}

/// One linear solve for the pseudo-displacement that balances the residual, added to the
/// stress-free deformations. Returns the largest force left.
void relax(Scene &scene,
           const std::vector<double> &loads,
           const continuum::Vector &mesh_loads,
           InstalledPrestress &installed)
{
  Grains &grains = scene.grains->state.grains;
  Joints &joints = scene.grains->state.joints;
  compute_joint_forces(grains, joints, {}, nullptr);
  for (Wall &wall : scene.walls)
    add_wall_forces(grains, wall);
  if (!scene.contacts.installed.empty())
  {
    search_contacts(grains, joints, scene.contacts);
    add_contact_forces(grains, scene.contacts, 0.);
  }
  coupling::StaticSystem system(grains, joints, scene.solid.get(), scene.bridging.get());
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    system.add_grain_force(i, 0, grains.force_x[i]);
    system.add_grain_force(i, 1, grains.force_y[i] + loads[i]);
    system.add_grain_force(i, 2, grains.torque[i]);
  }
  for (const Contact &contact : scene.contacts.contacts)
  {
    const LinearContact &law = scene.contacts.law(grains, contact);
    const Vec2 branch =
        grains.reference(contact.second) - grains.reference(contact.first);
    system.add_pair_spring(contact.first, contact.second, (1. / norm(branch)) * branch,
                           normal_stiffness(law, grains.radius[contact.first],
                                            grains.radius[contact.second]));
  }
  if (scene.mesh)
  {
    for (std::size_t dof = 0; dof < scene.solid->dof_handler().n_dofs(); ++dof)
      system.add_mesh_force(dof, installed.mesh_force(dof) + mesh_loads(dof));
    for (const coupling::PrescribedDof &entry : scene.mesh->prescribed)
      system.fix_mesh(entry.dof, 0.);
    if (scene.parameters.has("foundation"))
      for (const auto dof : scene.solid->locally_owned())
        if (scene.solid->component(dof) == 1 &&
            scene.solid->support_point(dof)[1] <
                scene.geometry.base() + 1e-9 * scene.geometry.length())
          system.fix_mesh(dof, 0.);
  }
  else
  {
    // The base holds y; one grain of it keeps the section from drifting along x.
    const auto base = base_grains(*scene.grains, scene.geometry);
    for (const auto &[i, width] : base)
      system.fix_grain(i, 1, 0.);
    system.fix_grain(base[base.size() / 2].first, 0, 0.);
  }

  const coupling::StaticSolution u = system.solve();
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    const auto rows = coupling::joint_rows(joints, j);
    const std::size_t one = joints.first[j], two = joints.second[j];
    const double ends[6] = {u.ux[one], u.uy[one], u.rotation[one],
                            u.ux[two], u.uy[two], u.rotation[two]};
    double change[3] = {0., 0., 0.};
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 6; ++k)
        change[row] += rows[row][k] * ends[k];
    joints.initial_gap[j] += change[0];
    joints.initial_shear[j] += change[1];
    joints.initial_rotation[j] += change[2];
  }
  for (Contacts::Installed &pair : scene.contacts.installed)
  {
    const Vec2 branch = grains.reference(pair.second) - grains.reference(pair.first);
    const Vec2 relative{u.ux[pair.second] - u.ux[pair.first],
                        u.uy[pair.second] - u.uy[pair.first]};
    pair.reference_gap -= dot(branch, relative) / norm(branch);
  }
  if (!scene.contacts.installed.empty())
  {
    scene.contacts.contacts.clear();
    search_contacts(grains, joints, scene.contacts);
  }
  if (scene.mesh)
    scene.solid->add_internal_force(u.mesh, installed.mesh_force);
}
} // namespace

Prestress prestress_of(const Scene &scene)
{
  const Parameters &p = scene.parameters;
  Prestress prestress;
  prestress.surface = scene.geometry.surface();
  if (p.has("surface pressure"))
    prestress.surface_pressure = p.surface_pressure.pressure;
  if (p.has("gravity"))
    prestress.unit_weight =
        p.gravity.acceleration * (scene.grains && scene.grains->matrix
                                      ? scene.grains->matrix->bulk_density
                                      : 0.84 * p.layer.grain_density);
  return prestress;
}

InstalledPrestress install_prestress(Scene &scene, const continuum::Vector &loads)
{
  const Prestress prestress = prestress_of(scene);
  InstalledPrestress installed;
  if (scene.mesh)
    installed.mesh_force = continuum::prestress(*scene.solid,
                                                [&](const dealii::Point<2> &x)
                                                {
                                                  dealii::SymmetricTensor<2, 2> stress;
                                                  stress[0][0] = stress[1][1] =
                                                      -prestress.pressure(x[1]);
                                                  return stress;
                                                });
  if (scene.grains)
  {
    const Grains &grains = scene.grains->state.grains;
    const double factor =
        force_factor(grains, scene.grains->state.joints,
                     scene.geometry.length() * scene.geometry.thickness());
    guess_joints(scene, prestress, factor);
    guess_contacts(scene, prestress, factor);
    press_walls(scene, prestress);
    const std::vector<double> forces = grain_loads(scene, prestress, installed);
    relax(scene, forces, loads, installed);
  }
  return installed;
}
} // namespace antiform::cases
