#pragma once

#include "discrete/grains.h"

#include <cstdint>

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

/// Normal stiffness of a pair [N/m]: k_n = A E / L, A = 2 min(R), L = R_1 + R_2; the
/// shear stiffness is k_n over the stiffness ratio.
double normal_stiffness(const LinearContact &law, double radius_1, double radius_2);
} // namespace antiform::discrete
