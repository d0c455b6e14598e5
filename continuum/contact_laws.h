#pragma once

#include "continuum/elastic_laws.h"

#include <array>
#include <variant>

namespace antiform::continuum
{
/// How far the upper side of an interface has moved from the lower one at a point, in the
/// frame of the surface midway between them.
struct ContactGap
{
  double opening = 0.; ///< along the normal, from the lower side to the upper one [m]
  double slip = 0.;    ///< along the tangent, the normal turned by -90 degrees [m]
};

/// What the upper side does to the lower one, per length of the reference interface in
/// that frame.
struct ContactTraction
{
  double normal = 0.; ///< tension positive [Pa]
  double shear = 0.;  ///< along the tangent, as slip drags [Pa]
};

enum class ContactPhase
{
  open,
  sticks,
  slides
};

struct ContactResponse
{
  ContactTraction traction;
  /// d (normal, shear) / d (opening, slip) [Pa/m], consistent with the step's update.
  std::array<std::array<double, 2>, 2> tangent{};
  ContactPhase phase = ContactPhase::open;
  double slip_at_rest = 0.; ///< for the next step, ContactPoint's
};

/// A point as a law gets it.
struct ContactPoint
{
  ContactGap gap;           ///< at the end of the step
  ContactTraction initial;  ///< at gap 0
  double slip_at_rest = 0.; ///< sum of the slip that was not elastic, at the step's start
};

/// Keeps together and slides freely: pushes and pulls with initial + k_n opening.
struct SlidingContact
{
  double normal_stiffness; ///< k_n [Pa/m]

  ContactResponse respond(const ContactPoint &point) const;
};

/// Opens and slides freely: pushes with initial + k_n opening, as long as that is not
/// above 0. At 0 it is closed, so that bodies laid down without weight hold on.
struct FrictionlessContact
{
  double normal_stiffness; ///< k_n [Pa/m]

  ContactResponse respond(const ContactPoint &point) const;
};

/// Opens freely and slides at |shear| = c + tan(phi) |normal|; below, slip is elastic.
/// The cohesion outlasts slip and opening. An open interface carries nothing and is free
/// of shear where it closes. Backward Euler, so the tangent is not symmetric as it
/// slides.
struct FrictionalContact
{
  double normal_stiffness; ///< k_n [Pa/m]
  double shear_stiffness;  ///< k_t [Pa/m]
  double tan_friction;     ///< tan(phi) [-]
  double cohesion = 0.;    ///< c [Pa]

  ContactResponse respond(const ContactPoint &point) const;
};

using ContactLaw = std::variant<SlidingContact, FrictionlessContact, FrictionalContact>;

/// Stiffnesses of an interface [Pa/m].
struct ContactStiffness
{
  double normal, shear;
};

/// The cells on one side of an interface.
struct ContactSide
{
  LameConstants constants;
  double cell; ///< height of those at the interface [m]
};

/// Stiffnesses with which an interface gives way to stress by a share 1 / @p ratio of
/// what the cells on both sides of it do, 1/k_n = (h_1/M_1 + h_2/M_2) / ratio with M =
/// lambda + 2 mu, and k_t likewise with mu. So a pressure p makes a penetration p/k_n,
/// and a stack of N even rows is too soft by 2 / (ratio N). That error falls with
/// 1/ratio; Newton's method takes more steps where contacts change, and round-off grows,
/// with ratio. Throws std::invalid_argument unless cells and ratio are > 0.
ContactStiffness contact_stiffness(const ContactSide &lower,
                                   const ContactSide &upper,
                                   double ratio = 100.);
} // namespace antiform::continuum
