#pragma once

#include "support/grain_fixtures.h"

namespace antiform::discrete::test
{
/// A disk above a rigid plane (y = 0), for which a held disk of 1e5 radii stands: over a
/// way of some radii its surface falls short of the plane's by 1e-5 of the way, and its
/// slope by as much.
struct DiskOnPlane
{
  static constexpr std::size_t disk = 1; ///< number of its grain
  ExplicitRun run;

  /// \param normal_stiffness of the contact [N/m]; @p law gives the rest
  DiskOnPlane(const double radius,
              const double density,
              const double gap,
              LinearContact law,
              const double normal_stiffness)
      : run(sample(radius, density, gap))
  {
    const double plane = run.sample.grains.radius[0];
    law.effective_modulus = normal_stiffness * (plane + radius) / (2. * radius);
    run.has_contacts = true;
    run.contacts.margin = radius;
    run.contacts.groups.push_back({0, 0, law});
  }

  Grains &grains() { return run.sample.grains; }
  const Contact &contact() const { return run.contacts.contacts.at(0); }
  double gap() const
  {
    const Grains &g = run.sample.grains;
    return norm(g.position(disk) - g.position(0)) - g.radius[0] - g.radius[disk];
  }

private:
  static Sample sample(const double radius, const double density, const double gap)
  {
    Sample sample;
    const double plane = 1e5 * radius;
    sample.grains.add({0., -plane}, plane, density, 0);
    hold(sample.grains, 0);
    sample.grains.add({0., radius + gap}, radius, density, 0);
    sample.joints.begin_group(strong_law(), 0, "none");
    sample.joints.finish(2);
    return sample;
  }
};
} // namespace antiform::discrete::test
