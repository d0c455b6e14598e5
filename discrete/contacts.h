#pragma once

#include "discrete/grains.h"
#include "discrete/joints.h"
#include "discrete/linear_contact.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Two regions of grains that may touch, and their law.
struct ContactGroup
{
  int region_i = 0, region_j = 0;
  LinearContact law;
};

/// All pairs near enough to touch before the next search. Contacts are evaluated and
/// summed in the order of (first, second).
struct Contacts
{
  std::vector<ContactGroup> groups;
  double margin = 0.; ///< candidates have an effective gap below this at the search [m]

  // State.
  std::vector<Contact> contacts;
  std::vector<double> search_x, search_y; ///< displacements at the last search [m]
  double lost_energy = 0.; ///< slip and dashpot energy of pairs no longer listed [J]

  /// Pairs that were stress-free at a gap other than zero when the scene was built (an
  /// unbonded interface): sorted (first, second), reference gap.
  struct Installed
  {
    std::int32_t first, second;
    double reference_gap;
  };
  std::vector<Installed> installed;

  const LinearContact &law(const Grains &grains, const Contact &contact) const;
};

/// Whoever holds pairs of grains that must not meet as round ones.
class PairOwner
{
public:
  virtual ~PairOwner() = default;
  virtual bool takes(std::int32_t i, std::int32_t j) = 0;
};

/// Find the candidates anew, keeping the state of pairs that stay. Jointed pairs are left
/// out until their joint is removed, but for those whose law has the contact beside the
/// joint; the joint's installed gap is their reference. @p owner is asked about every
/// pair that no joint holds; null: nobody.
void search_contacts(const Grains &grains,
                     const Joints &joints,
                     Contacts &contacts,
                     PairOwner *owner = nullptr);

/// Take over the contacts that bonds broken in this step have left behind
/// (Joints::released), in the order of (first, second).
void take_released(Joints &joints, Contacts &contacts);

/// True when some grain has moved by more than half the margin since the last search.
bool needs_search(const Grains &grains, const Contacts &contacts);

/// Evaluate every candidate and add to the grains' forces.
/// @p dt the step that led to these positions, with the half-step velocities of the
/// grains.
void add_contact_forces(Grains &grains, Contacts &contacts, double dt);

struct ContactEnergies
{
  double strain = 0., slip = 0., dashpot = 0.; ///< [J]
};
ContactEnergies contact_energies(const Grains &grains, const Contacts &contacts);

/// A spring between two grains as the element that it is for the bound of the step:
/// stiffness of its normal motion and its shear [N/m] and of its bending [N m], and the
/// levers of its shear [m].
struct PairStiffness
{
  std::int32_t first, second;
  double normal, shear, bending;
  double lever1, lever2;

  double translation() const { return normal + shear; }
  double rotation(const double lever) const { return shear * lever * lever + bending; }
};

/// Stable step of joints, contacts and springs to the ground together, as stable_step()
/// of joints alone. Every candidate counts as if it touched, so that the bound holds from
/// one search to the next; joints that are removed do not. Dashpots are not counted.
/// @p more: further springs between grains.
double stable_step(const Grains &grains,
                   const Joints &joints,
                   const Contacts &contacts,
                   const std::vector<double> &extra = {},
                   const std::vector<PairStiffness> &more = {});
} // namespace antiform::discrete
