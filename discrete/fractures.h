#pragma once

#include "discrete/vec2.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Law of a pre-existing fracture (smooth joint, Mas Ivars et al. 2011): its two sides
/// slide along its plane, not around the grains. Stress and opening tension positive.
struct SmoothJoint
{
  double normal_stiffness = 0.; ///< k_n [Pa/m]; 0: of the joints that it replaces
  double shear_stiffness = 0.;  ///< k_s [Pa/m]; 0: likewise
  double friction = 0.6;        ///< mu [-]
  double tan_dilation = 0.;     ///< tan(psi), opening per slip, at most mu [-]
  bool bonded = false;          ///< healed: has the strengths below until it breaks
  double tensile_strength = 0.; ///< [Pa]
  double cohesion = 0.;         ///< c_b, shear strength without normal stress [Pa]
  double tan_friction = 0.;     ///< tan(phi_b) of the bonded joint [-]
};

/// A straight fracture in the reference section.
struct Fracture
{
  Vec2 begin, end; ///< tips [m]
  SmoothJoint law;

  double length() const { return norm(end - begin); }
};

/// Do @p a and @p b lie on either side of @p fracture, the branch between them crossing
/// it between its tips? A point on its line belongs to its left.
bool crosses(const Fracture &fracture, const Vec2 &a, const Vec2 &b);

/// Where the line of @p fracture cuts the branch from @p a to @p b. \pre they lie on
/// either side
Vec2 crossing(const Fracture &fracture, const Vec2 &a, const Vec2 &b);

/// The first of @p fractures that crosses the branch from @p a to @p b, or -1.
std::int32_t
crossed_by(const std::vector<Fracture> &fractures, const Vec2 &a, const Vec2 &b);

/// How the lengths of a fracture set are distributed. Numbers beyond the bounds are drawn
/// again.
struct LengthDistribution
{
  enum class Form
  {
    constant,    ///< mean
    exponential, ///< mean
    lognormal,   ///< mean and deviation of the length itself
    power_law    ///< density ~ l^-exponent between the bounds
  };
  Form form = Form::constant;
  double mean = 1., deviation = 0.; ///< [m]
  double exponent = 2.5;
  double least = 0., largest = 1e300; ///< bounds [m]
};

/// A set of a fracture network: independent, uniformly placed fractures.
struct FractureSet
{
  double intensity = 0.;                           ///< P21, length per area [1/m]
  double orientation = 0., angle_deviation = 0.;   ///< from x, normally distributed [rad]
  LengthDistribution length;
  SmoothJoint law;
};

/// A set of parallel fractures at even distances that go all the way through.
struct ParallelSet
{
  double orientation = 0.; ///< of the traces, from x [rad]
  double spacing = 1.;     ///< between neighbours, across the traces [m]
  double phase = 0.5;      ///< distance from the origin to a trace over the spacing [-]
  SmoothJoint law;
};

/// Length of the segment from @p a to @p b inside a simple polygon [m].
double
length_inside(const std::vector<Vec2> &polygon, const Vec2 &a, const Vec2 &b);

/// Draw fractures until their length inside the simple @p polygon is the set's P21 times
/// its area; the last one is cut to length. Centres are uniform in the polygon's box,
/// grown by half of the longest fracture, so that its rim has no fewer of them. The same
/// bits for the same seed. Throws std::invalid_argument for an impossible distribution.
std::vector<Fracture> draw_fractures(const std::vector<Vec2> &polygon,
                                     const FractureSet &set,
                                     std::uint64_t seed);

/// The traces of @p set inside the simple @p polygon, in the order in which they lie to
/// the left of the first. One that leaves the polygon and returns is in pieces. In a large
/// region P21 is 1/spacing. \pre spacing > 0
std::vector<Fracture> parallel_fractures(const std::vector<Vec2> &polygon,
                                         const ParallelSet &set);
} // namespace antiform::discrete
