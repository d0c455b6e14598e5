#include "discrete/bond_laws.h"

namespace antiform::discrete
{
namespace
{
BondConstants of(const FlatJoint &law)
{
  const double n = law.n_elements;
  BondConstants c;
  c.stiffness_ratio = law.stiffness_ratio;
  c.radius_multiplier = law.radius_multiplier;
  c.moment_factor = (law.element_moment ? 1. : 1. - 1. / (n * n)) / 12.;
  c.tension_arm = c.coulomb_arm = 1. - 1. / n; // centre of the outer element
  c.tensile_strength = law.tensile_strength;
  c.cohesion = law.cohesion;
  c.tan_friction = law.tan_friction;
  c.n_elements = law.n_elements;
  c.breakable = law.breakable;
  return c;
}

BondConstants of(const ParallelBond &law)
{
  BondConstants c;
  c.stiffness_ratio = law.stiffness_ratio;
  c.radius_multiplier = law.radius_multiplier;
  c.moment_factor = 1. / 12.;
  c.tension_arm = law.moment_contribution;
  c.tensile_strength = law.tensile_strength;
  c.cohesion = law.cohesion;
  c.tan_friction = law.tan_friction;
  c.breakable = law.breakable;
  return c;
}

BondConstants of(const ContactBond &law)
{
  BondConstants c;
  c.stiffness_ratio = law.stiffness_ratio;
  c.tensile_strength = law.tensile_strength;
  c.cohesion = law.shear_strength;
  c.breakable = law.breakable;
  return c;
}

double modulus(const FlatJoint &law)
{
  return law.effective_modulus;
}
double modulus(const ParallelBond &law)
{
  return law.bond_modulus;
}
double modulus(const ContactBond &law)
{
  return law.effective_modulus;
}
} // namespace

BondConstants constants(const JointLaw &law)
{
  return std::visit([](const auto &one) { return of(one); }, law);
}

double joint_modulus(const JointLaw &law)
{
  return std::visit([](const auto &one) { return modulus(one); }, law);
}
} // namespace antiform::discrete
