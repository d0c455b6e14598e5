#pragma once
// A bridged model whose core may break: what a scene adds to the loop for it.
#include "support/coupling_loop.h"

#include "discrete/contacts.h"

namespace antiform::coupling::test
{
/// Flat joint that breaks in tension at @p strength; the rest as elastic_law().
inline FlatJoint brittle_law(const double strength)
{
  FlatJoint law = elastic_law();
  law.breakable = true;
  law.tensile_strength = strength;
  law.cohesion = 3. * strength;
  law.tan_friction = 0.2;
  law.residual_friction = 0.5;
  return law;
}

/// Bond the grains: by @p law where @p may_break says so of both grains, else
/// elastically. \param tension_factor strength of a joint that may break, over that of
/// the law, by its
///                       place
inline void bond_with_core(Bridged &model,
                           const FlatJoint &law,
                           const std::function<bool(const Vec2 &)> &may_break,
                           const std::function<double(const Vec2 &)> &tension_factor)
{
  discrete::Grains &g = model.state.grains;
  discrete::Joints &joints = model.state.joints;
  const auto pairs = discrete::pairs_within(g, 1e-6, 0, 0);
  for (const bool brittle : {true, false})
  {
    joints.begin_group(brittle ? law : elastic_law(), 0, brittle ? "core" : "overlap");
    for (const auto &[i, j] : pairs)
      if ((may_break(g.reference(i)) && may_break(g.reference(j))) == brittle)
      {
        joints.add(g, i, j, 1., 1.);
        joints.tension_factor.push_back(
            brittle ? tension_factor(0.5 * (g.reference(i) + g.reference(j))) : 1.);
        joints.cohesion_factor.push_back(1.);
      }
  }
  joints.finish(g.size());
}

/// Broken joints, and contacts of grains that no joint holds any more.
class Breakage
{
public:
  Breakage(Loop &run, Bridged &model)
  {
    discrete::LinearContact touching;
    touching.effective_modulus = 1.;
    touching.stiffness_ratio = 2.2;
    contacts_.margin = 0.2;
    contacts_.groups.push_back({0, 0, touching});
    GrainState &state = model.state;
    state.breaking = true;
    run.add(std::make_unique<BrokenJoints>(state), {Stage::forces}, 10, "friction");
    run.add(std::make_unique<ContactSearch>(
                state, contacts_,
                [&state, this]
                { discrete::search_contacts(state.grains, state.joints, contacts_); },
                [] { return 0.; }),
            {Stage::forces}, 25, "search");
    run.add(std::make_unique<GrainContacts>(state, contacts_), {Stage::forces}, 30,
            "contacts");
  }
  Breakage(const Breakage &) = delete;

  const discrete::Contacts &contacts() const { return contacts_; }

private:
  discrete::Contacts contacts_;
};

/// The energy balance at samples.
struct Ledger
{
  double first = 0., worst = 0., scale = 0.;
  bool has_first = false, finite = true;

  void record(const Energies &e)
  {
    const double sum = e.stored_and_spent() - e.boundary_work;
    if (!has_first)
      first = sum;
    has_first = true;
    finite = finite && std::isfinite(sum);
    worst = std::max(worst, std::abs(sum - first));
    scale = std::max(scale, std::abs(e.stored_and_spent()));
  }
  /// Largest error over the largest energy.
  double closure() const { return worst / scale; }
};
} // namespace antiform::coupling::test
