#include "continuum/contact_laws.h"

#include "continuum/require.h"

#include <cmath>

namespace antiform::continuum
{
ContactResponse SlidingContact::respond(const ContactPoint &point) const
{
  ContactResponse response;
  response.traction.normal = point.initial.normal + normal_stiffness * point.gap.opening;
  response.tangent[0][0] = normal_stiffness;
  response.phase = ContactPhase::slides;
  return response;
}

ContactResponse FrictionlessContact::respond(const ContactPoint &point) const
{
  const ContactResponse closed = SlidingContact{normal_stiffness}.respond(point);
  return closed.traction.normal <= 0. ? closed : ContactResponse();
}

ContactResponse FrictionalContact::respond(const ContactPoint &point) const
{
  ContactResponse response = FrictionlessContact{normal_stiffness}.respond(point);
  const double normal = response.traction.normal;
  const double offset = point.initial.shear / shear_stiffness;
  if (response.phase == ContactPhase::open)
  {
    response.slip_at_rest = point.gap.slip + offset;
    return response;
  }
  // Elastic slip is gap.slip - slip_at_rest + offset.
  const double trial = shear_stiffness * (point.gap.slip - point.slip_at_rest + offset);
  const double limit = cohesion - tan_friction * normal;
  if (std::abs(trial) <= limit)
  {
    response.phase = ContactPhase::sticks;
    response.traction.shear = trial;
    response.tangent[1][1] = shear_stiffness;
    response.slip_at_rest = point.slip_at_rest;
    return response;
  }
  const double side = trial > 0. ? 1. : -1.;
  response.traction.shear = side * limit;
  response.tangent[1][0] = -side * tan_friction * normal_stiffness;
  response.slip_at_rest = point.gap.slip + offset - side * limit / shear_stiffness;
  return response;
}

ContactStiffness
contact_stiffness(const ContactSide &lower, const ContactSide &upper, const double ratio)
{
  require(ratio > 0., "contact: the ratio of stiffnesses", ratio, "", "> 0");
  for (const ContactSide &side : {lower, upper})
    require(side.cell > 0., "contact: the height of the cells beside it", side.cell, "m",
            "> 0");
  const auto compliance = [&](const auto &modulus) {
    return lower.cell / modulus(lower.constants) + upper.cell / modulus(upper.constants);
  };
  return {ratio / compliance([](const LameConstants &c) { return c.lambda + 2. * c.mu; }),
          ratio / compliance([](const LameConstants &c) { return c.mu; })};
}
} // namespace antiform::continuum
