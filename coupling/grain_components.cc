#include "coupling/grain_components.h"

#include "discrete/joint_damage.h"

#include <cmath>

namespace antiform::coupling
{
using namespace discrete;

void GrainMotion::run(const Stage stage, const Clock &clock)
{
  if (stage == Stage::kick)
  {
    if (clock.sample_due)
      before_ = velocities(state_.grains);
    if (!damped)
      discrete::kick(state_.grains, clock.dt);
  }
  else
    discrete::drift(state_.grains, clock.dt);
}

void GrainMotion::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  energies.kinetic += discrete::kinetic_energy(state_.grains, before_);
}

void GrainMotion::visit_state(StateArchive &archive)
{
  Grains &g = state_.grains;
  archive.array("grains/displacement_x", g.displacement_x);
  archive.array("grains/displacement_y", g.displacement_y);
  archive.array("grains/rotation", g.rotation);
  archive.array("grains/velocity_x", g.velocity_x);
  archive.array("grains/velocity_y", g.velocity_y);
  archive.array("grains/spin", g.spin);
  archive.array("grains/inverse_mass", g.inverse_mass);
  archive.array("grains/inverse_inertia", g.inverse_inertia);
}

namespace
{
/// Cracks of this step join those of the run; tells of the first.
void add_cracks(const std::vector<Crack> &found,
                GrainState &state,
                const std::function<void()> &on_first_crack)
{
  if (found.empty())
    return;
  const bool first = state.cracks.empty();
  state.cracks.insert(state.cracks.end(), found.begin(), found.end());
  if (first && on_first_crack)
    on_first_crack();
}
} // namespace

void Bonds::run(const Stage, const Clock &clock)
{
  std::vector<Crack> found;
  const StepTime now{static_cast<std::uint64_t>(clock.step), clock.time, clock.dt};
  evaluate_bonds(state_.grains, state_.joints, now, state_.breaking ? &found : nullptr,
                 clock.balance_due);
  add_cracks(found, state_, on_first_crack);
}

void Bonds::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  const JointEnergies joints = joint_energies(state_.grains, state_.joints);
  energies.strain_grains += joints.strain;
  energies.slip += joints.slip;
  energies.fracture += joints.fracture;
}

namespace
{
/// Broken joints as flat arrays, and back.
void visit_damaged(StateArchive &archive, Joints &joints)
{
  DamagedJoints &damaged = joints.damaged;
  std::vector<std::int64_t> joint, bond, removed;
  std::vector<double> values;
  const auto n_elements = [&](const std::size_t k)
  { return constants(joints.groups[damaged.group[k]].law).n_elements; };
  if (!archive.is_loading())
    for (std::size_t k = 0; k < damaged.size(); ++k)
    {
      joint.push_back(damaged.joint[k]);
      removed.push_back(damaged.removed[k]);
      for (int e = 0; e < n_elements(k); ++e)
      {
        bond.push_back(static_cast<std::int64_t>(damaged.bond(k, e)));
        values.push_back(damaged.slip(k, e));
      }
      for (const double v : {damaged.gap[k], damaged.shear[k], damaged.rotation[k],
                             damaged.slip_energy[k], damaged.fracture_energy[k]})
        values.push_back(v);
    }
  archive.array("broken/joint", joint);
  archive.array("broken/bond", bond);
  archive.array("broken/removed", removed);
  archive.array("broken/values", values);
  if (!archive.is_loading())
    return;
  damaged.clear();
  auto next_bond = bond.begin();
  auto next = values.begin();
  for (std::size_t i = 0; i < joint.size(); ++i)
  {
    const std::size_t k = add_damaged(joints, static_cast<std::size_t>(joint[i]));
    damaged.removed[k] = removed[i] != 0 ? 1 : 0;
    for (int e = 0; e < n_elements(k); ++e)
    {
      damaged.set_bond(k, e, static_cast<Bond>(*next_bond++));
      damaged.set_slip(k, e, *next++);
    }
    for (std::vector<double> *v : {&damaged.gap, &damaged.shear, &damaged.rotation,
                                   &damaged.slip_energy, &damaged.fracture_energy})
      (*v)[k] = *next++;
  }
}

void visit_cracks(StateArchive &archive, std::vector<Crack> &cracks)
{
  std::vector<std::int64_t> integers;
  std::vector<double> values;
  if (!archive.is_loading())
    for (const Crack &crack : cracks)
    {
      for (const std::int64_t v :
           {static_cast<std::int64_t>(crack.step), static_cast<std::int64_t>(crack.mode),
            static_cast<std::int64_t>(crack.layer),
            static_cast<std::int64_t>(crack.joint),
            static_cast<std::int64_t>(crack.element),
            static_cast<std::int64_t>(crack.grain)})
        integers.push_back(v);
      for (const double v :
           {crack.time, crack.place.x, crack.place.y, crack.reference_place.x,
            crack.reference_place.y, crack.orientation, crack.length})
        values.push_back(v);
    }
  archive.array("cracks/integers", integers);
  archive.array("cracks/values", values);
  if (!archive.is_loading())
    return;
  cracks.assign(integers.size() / 6, {});
  auto i = integers.begin();
  auto v = values.begin();
  for (Crack &crack : cracks)
  {
    crack.step = static_cast<std::uint64_t>(*i++);
    crack.mode = static_cast<Bond>(*i++);
    crack.layer = static_cast<int>(*i++);
    crack.joint = static_cast<std::size_t>(*i++);
    crack.element = static_cast<int>(*i++);
    crack.grain = static_cast<std::size_t>(*i++);
    for (double *x :
         {&crack.time, &crack.place.x, &crack.place.y, &crack.reference_place.x,
          &crack.reference_place.y, &crack.orientation, &crack.length})
      *x = *v++;
  }
}
} // namespace

void Bonds::visit_state(StateArchive &archive)
{
  visit_damaged(archive, state_.joints);
  visit_cracks(archive, state_.cracks);
  std::vector<std::int64_t> would_break(state_.joints.would_break.begin(),
                                        state_.joints.would_break.end());
  archive.array("joints/would_break", would_break);
  if (archive.is_loading())
  {
    for (std::size_t j = 0; j < would_break.size(); ++j)
      state_.joints.would_break[j] = static_cast<unsigned char>(would_break[j]);
    state_.cracks_recorded = state_.cracks.size();
  }
}

void BrokenJoints::run(const Stage, const Clock &clock)
{
  const StepTime now{static_cast<std::uint64_t>(clock.step), clock.time, clock.dt};
  evaluate_broken_joints(state_.grains, state_.joints, now,
                         state_.breaking ? &state_.cracks : nullptr);
}

void GrainContacts::run(const Stage, const Clock &clock)
{
  add_contact_forces(state_.grains, contacts_, clock.dt);
}

void GrainContacts::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  const ContactEnergies contact = contact_energies(state_.grains, contacts_);
  energies.strain_grains += contact.strain;
  energies.slip += contact.slip;
  energies.damping += contact.dashpot;
}

void GrainContacts::visit_state(StateArchive &archive)
{
  std::vector<std::int64_t> pairs;
  std::vector<double> values;
  if (archive.is_loading())
  {
    contacts_.contacts.clear();
    contacts_.search_x.clear();
    contacts_.search_y.clear();
  }
  for (const Contact &c : contacts_.contacts)
  {
    pairs.push_back(c.first);
    pairs.push_back(c.second);
    for (const double v : {c.reference_gap, c.gap, c.shear_force, c.normal_force,
                           c.slip_energy, c.dashpot_energy})
      values.push_back(v);
  }
  archive.array("contacts/pairs", pairs);
  archive.array("contacts/values", values);
  archive.array("contacts/search_x", contacts_.search_x);
  archive.array("contacts/search_y", contacts_.search_y);
  archive.value("contacts/lost_energy", contacts_.lost_energy);
  if (!archive.is_loading())
    return;
  contacts_.contacts.assign(pairs.size() / 2, {});
  auto v = values.begin();
  for (std::size_t k = 0; k < contacts_.contacts.size(); ++k)
  {
    Contact &c = contacts_.contacts[k];
    c.first = static_cast<std::int32_t>(pairs[2 * k]);
    c.second = static_cast<std::int32_t>(pairs[2 * k + 1]);
    for (double *x : {&c.reference_gap, &c.gap, &c.shear_force, &c.normal_force,
                      &c.slip_energy, &c.dashpot_energy})
      *x = *v++;
  }
}

void SmoothJointForces::run(const Stage, const Clock &clock)
{
  std::vector<Crack> found;
  const StepTime now{static_cast<std::uint64_t>(clock.step), clock.time, clock.dt};
  add_smooth_joint_forces(state_.grains, joints_, now,
                          state_.breaking ? &found : nullptr);
  add_cracks(found, state_, on_first_crack);
}

void SmoothJointForces::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  const JointEnergies joints = smooth_joint_energies(joints_);
  energies.strain_grains += joints.strain;
  energies.slip += joints.slip;
  energies.fracture += joints.fracture;
}

void SmoothJointForces::visit_state(StateArchive &archive)
{
  std::vector<std::int64_t> integers;
  std::vector<double> values;
  if (!archive.is_loading())
    for (const SmoothContact &c : joints_.contacts)
    {
      for (const std::int64_t v : {static_cast<std::int64_t>(c.first),
                                   static_cast<std::int64_t>(c.second),
                                   static_cast<std::int64_t>(c.fracture),
                                   static_cast<std::int64_t>(c.bonded ? 1 : 0)})
        integers.push_back(v);
      for (const double v :
           {c.normal_x, c.normal_y, c.distance, c.origin, c.area, c.normal_stiffness,
            c.shear_stiffness, c.slip, c.dilation, c.gap, c.shear, c.normal_stress,
            c.shear_stress, c.slip_energy, c.fracture_energy})
        values.push_back(v);
    }
  archive.array("smooth_joints/integers", integers);
  archive.array("smooth_joints/values", values);
  archive.value("smooth_joints/lost_slip", joints_.lost_slip);
  archive.value("smooth_joints/lost_fracture", joints_.lost_fracture);
  if (!archive.is_loading())
    return;
  joints_.contacts.assign(integers.size() / 4, {});
  auto i = integers.begin();
  auto v = values.begin();
  for (SmoothContact &c : joints_.contacts)
  {
    c.first = static_cast<std::int32_t>(*i++);
    c.second = static_cast<std::int32_t>(*i++);
    c.fracture = static_cast<std::int32_t>(*i++);
    c.bonded = *i++ != 0;
    for (double *x :
         {&c.normal_x, &c.normal_y, &c.distance, &c.origin, &c.area, &c.normal_stiffness,
          &c.shear_stiffness, &c.slip, &c.dilation, &c.gap, &c.shear, &c.normal_stress,
          &c.shear_stress, &c.slip_energy, &c.fracture_energy})
      *x = *v++;
  }
}

void ContactSearch::run(const Stage stage, const Clock &)
{
  if (stage == Stage::drift)
  {
    take_released(state_.joints, contacts_);
    return;
  }
  acted_ = needs_search(state_.grains, contacts_);
  if (!acted_)
    return;
  search_();
  lost_ += on_search_();
}

GrainGravity::GrainGravity(GrainState &state,
                           const double acceleration,
                           const std::vector<double> &weight)
    : state_(state)
{
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    force_.push_back(state.grains.mass[i] * acceleration *
                     (weight.empty() ? 1. : weight[i]));
}

void GrainGravity::run(const Stage, const Clock &)
{
  for (std::size_t i = 0; i < force_.size(); ++i)
    state_.grains.force_y[i] -= force_[i];
}

void GrainGravity::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  for (std::size_t i = 0; i < force_.size(); ++i)
    energies.boundary_work -= force_[i] * state_.grains.displacement_y[i];
}

void GrainLoads::run(const Stage, const Clock &)
{
  Grains &grains = state_.grains;
  for (const GrainLoad &load : loads_)
  {
    grains.force_x[load.grain] += load.force.x;
    grains.force_y[load.grain] += load.force.y;
    grains.torque[load.grain] += load.torque;
  }
}

void GrainLoads::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  const Grains &grains = state_.grains;
  double work = 0.;
  for (const GrainLoad &load : loads_)
    work += load.force.x * grains.displacement_x[load.grain] +
            load.force.y * grains.displacement_y[load.grain] +
            load.torque * grains.rotation[load.grain];
  if (is_prestress_)
    energies.strain_grains -= work;
  else
    energies.boundary_work += work;
}

void GrainBase::run(const Stage, const Clock &)
{
  for (const Support &support : supports_)
  {
    if (fixed_)
      state_.grains.force_x[support.grain] = 0.; // the support takes it
    if (std::isinf(support.stiffness))
      state_.grains.force_y[support.grain] = 0.;
    else
      state_.grains.force_y[support.grain] -=
          support.stiffness * state_.grains.displacement_y[support.grain];
  }
}

void GrainBase::add_energies(Energies &energies) const
{
  if (!state_.tells_energies)
    return;
  for (const Support &support : supports_)
    if (!std::isinf(support.stiffness))
    {
      const double u = state_.grains.displacement_y[support.grain];
      energies.strain_continuum += 0.5 * support.stiffness * u * u;
    }
}
} // namespace antiform::coupling
