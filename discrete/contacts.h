#pragma once

#include "discrete/grains.h"
#include "discrete/joints.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Linear contact of two grains that no joint holds (Cundall & Strack 1979): stiffness by
/// the deformability method, Coulomb friction, no tension. Compression is a positive
/// number N here, as in the source; gaps are opening positive as everywhere.
struct LinearContact
{
  double effective_modulus = 50e9; ///< E* [Pa]
  double stiffness_ratio = 2.2;    ///< k_n / k_s [-]
  double friction = 0.4;           ///< mu [-]; 0: no shear force at all
  double normal_dashpot = 0.;      ///< beta_n, share of critical damping [-]
  double shear_dashpot = 0.;       ///< beta_s [-]
  bool tension_in_dashpot = true;  ///< false: the dashpot never makes the contact pull
};

/// One candidate pair. State survives as long as the pair stays a candidate.
struct Contact
{
  std::int32_t first = 0, second = 0; ///< first < second
  double reference_gap = 0.;          ///< gap at which the contact is stress-free [m]
  double gap = 0.;                    ///< effective gap at the last evaluation [m]
  double shear_force = 0.;            ///< S, along the tangent [N]
  double normal_force = 0.;           ///< N >= 0 [N]
  double slip_energy = 0.;            ///< dissipated by friction so far [J]
  double dashpot_energy = 0.;
};

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

/// Find the candidates anew, keeping the state of pairs that stay. Jointed pairs are left
/// out until their joint is removed; then the joint's installed gap is their reference.
void search_contacts(const Grains &grains, const Joints &joints, Contacts &contacts);

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

/// Normal and shear stiffness [N/m] of a pair: k_n = A E / L, A = 2 min(R), L = R_1 +
/// R_2.
double normal_stiffness(const LinearContact &law, double radius_1, double radius_2);

/// Stable step of joints, contacts and springs to the ground together, as stable_step()
/// of joints alone. Every candidate counts as if it touched, so that the bound holds from
/// one search to the next; joints that are removed do not. Dashpots are not counted.
double stable_step(const Grains &grains,
                   const Joints &joints,
                   const Contacts &contacts,
                   const std::vector<double> &extra = {});
} // namespace antiform::discrete
