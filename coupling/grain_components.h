#pragma once

#include "coupling/simulation.h"
#include "discrete/contacts.h"
#include "discrete/smooth_joints.h"
#include "discrete/grains.h"
#include "discrete/integrate.h"
#include "discrete/joints.h"

#include <functional>
#include <vector>

namespace antiform::coupling
{
/// Everything of the grains that forces act on, and the cracks found so far.
struct GrainState
{
  discrete::Grains grains;
  discrete::Joints joints;
  std::vector<discrete::Crack> cracks;
  std::size_t cracks_recorded = 0; ///< of them already written by the recorder
  bool breaking = true;            ///< false: strengths are not looked at
  /// Whether this rank tells the energies of the grains. All ranks have the grains, one
  /// tells.
  bool tells_energies = true;
};

/// Kick and drift of the grains; keeps the velocities before the kick at a sample. Grains
/// that are damped are kicked by LocalDamping, in one pass.
class GrainMotion : public Component
{
public:
  explicit GrainMotion(GrainState &state)
      : state_(state)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  bool damped = false; ///< the kick is the damping component's

private:
  GrainState &state_;
  discrete::GrainVelocities before_;
};

/// Flat joints that hold: vector kernel, first breaks, sum over the grains.
class Bonds : public Component
{
public:
  explicit Bonds(GrainState &state)
      : state_(state)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  /// Called after the step in which the first bond breaks.
  std::function<void()> on_first_crack;

private:
  GrainState &state_;
};

/// Friction, closing and further damage of joints with broken elements.
class BrokenJoints : public Component
{
public:
  explicit BrokenJoints(GrainState &state)
      : state_(state)
  {
  }
  void run(Stage stage, const Clock &clock) override;

private:
  GrainState &state_;
};

/// Linear contacts of grains that no joint holds.
class GrainContacts : public Component
{
public:
  GrainContacts(GrainState &state, discrete::Contacts &contacts)
      : state_(state)
      , contacts_(contacts)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

private:
  GrainState &state_;
  discrete::Contacts &contacts_;
};

/// Smooth joints of pre-existing fractures.
class SmoothJointForces : public Component
{
public:
  SmoothJointForces(GrainState &state, discrete::SmoothJoints &joints)
      : state_(state)
      , joints_(joints)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  /// Called after the step in which the first bond breaks.
  std::function<void()> on_first_crack;

private:
  GrainState &state_;
  discrete::SmoothJoints &joints_;
};

/// Search for pairs that may touch, whenever a grain has used up half the margin.
/// What follows a search may cost kinetic energy, which it returns: it is booked as
/// damping. At the drift it takes over what broken contact bonds have left.
class ContactSearch : public Component
{
public:
  ContactSearch(GrainState &state,
                discrete::Contacts &contacts,
                std::function<void()> search,
                std::function<double()> on_search)
      : state_(state)
      , contacts_(contacts)
      , search_(std::move(search))
      , on_search_(std::move(on_search))
  {
  }
  void run(Stage stage, const Clock &clock) override;
  bool acted() const override { return acted_; }
  void add_energies(Energies &energies) const override { energies.damping += lost_; }
  void visit_state(StateArchive &archive) override
  {
    archive.value("search/lost_energy", lost_);
  }

private:
  GrainState &state_;
  discrete::Contacts &contacts_;
  std::function<void()> search_;
  std::function<double()> on_search_;
  double lost_ = 0.; ///< [J]
  bool acted_ = false;
};

/// Weight of the grains: m g with the real, energy-weighted mass.
class GrainGravity : public Component
{
public:
  /// \param weight w_D of each grain; empty: 1
  GrainGravity(GrainState &state, double acceleration, const std::vector<double> &weight);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;

private:
  GrainState &state_;
  std::vector<double> force_; ///< downward [N]
};

/// A force on a grain that does not change.
struct GrainLoad
{
  std::int32_t grain = 0;
  Vec2 force;         ///< [N]
  double torque = 0.; ///< [N m]
};

/// Forces that do not change: surface pressure on the outer chain of grains; or those of
/// an installed prestress, whose work is strain energy, not work of the boundary.
class GrainLoads : public Component
{
public:
  GrainLoads(GrainState &state, std::vector<GrainLoad> loads, bool is_prestress = false)
      : state_(state)
      , loads_(std::move(loads))
      , is_prestress_(is_prestress)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;

private:
  GrainState &state_;
  std::vector<GrainLoad> loads_;
  bool is_prestress_;
};

/// Support of base grains, x free: a Winkler spring in y, or (stiffness infinite) no
/// motion.
class GrainBase : public Component
{
public:
  struct Support
  {
    std::int32_t grain;
    double stiffness; ///< [N/m]; infinity: held
  };
  /// \param fixed held in x too
  GrainBase(GrainState &state, std::vector<Support> supports, const bool fixed = false)
      : state_(state)
      , supports_(std::move(supports))
      , fixed_(fixed)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;

private:
  GrainState &state_;
  std::vector<Support> supports_;
  bool fixed_;
};
} // namespace antiform::coupling
