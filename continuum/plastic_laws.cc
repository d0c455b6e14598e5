#include "continuum/plastic_laws.h"

#include "continuum/errors.h"
#include "continuum/require.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace antiform::continuum
{
namespace
{
constexpr double pi = 3.14159265358979323846;

void require_strength(const double cohesion, const double friction, const double dilation)
{
  require(friction >= 0. && friction < 0.5 * pi, "Friction angle", friction, "rad",
          ">= 0 and < pi/2");
  require(dilation >= 0. && dilation <= friction, "Dilation angle", dilation, "rad",
          ">= 0 and at most the friction angle");
  require(cohesion >= 0. && std::isfinite(cohesion), "Cohesion", cohesion, "Pa",
          ">= 0 and finite");
  require(cohesion > 0. || friction > 0., "Cohesion", cohesion, "Pa",
          "> 0 where there is no friction");
}

/// Stress if nothing more flows in the step.
PointStress
trial_stress(const LameConstants &elastic, const PointInput &input, const double *plastic)
{
  const PlaneVector &e = input.strain;
  const PointStress s = elastic.stress(
      {e[0] - plastic[0], e[1] - plastic[1], -plastic[2], e[2] - plastic[3]});
  const PointStress &initial = input.initial;
  return {initial.xx + s.xx, initial.yy + s.yy, initial.zz + s.zz, initial.xy + s.xy};
}

/// Plastic strain at the end of a step that took @p drop from the trial stress.
void add_plastic_strain(const LameConstants &elastic,
                        const PointStress &drop,
                        const double *begin,
                        double *end)
{
  const PointStrain increment = elastic.strain(drop);
  for (int i = 0; i < 4; ++i)
    end[i] = begin[i] + increment[i];
}

PrincipalReturn principal_return(const LameConstants &elastic,
                                 const MohrCoulombParameters &p)
{
  require_strength(p.cohesion, p.friction_angle, p.dilation_angle);
  const double infinity = std::numeric_limits<double>::infinity();
  const double apex =
      p.friction_angle > 0. ? p.cohesion / std::tan(p.friction_angle) : infinity;
  if (p.tension_cutoff)
    require(*p.tension_cutoff >= 0. && *p.tension_cutoff <= apex, "Tension cut-off",
            *p.tension_cutoff, "Pa", ">= 0 and at most c cot phi");
  return {elastic, p.cohesion * std::cos(p.friction_angle), std::sin(p.friction_angle),
          std::sin(p.dilation_angle), p.tension_cutoff.value_or(infinity)};
}

/// alpha of a match, and its k per cohesion.
struct Cone
{
  double slope, strength_per_cohesion;
};

Cone matched_cone(const DruckerPragerParameters::Match match, const double angle)
{
  using Match = DruckerPragerParameters::Match;
  const double sine = std::sin(angle), cosine = std::cos(angle), root_3 = std::sqrt(3.);
  switch (match)
  {
  case Match::outer:
    return {2. * sine / (root_3 * (3. - sine)), 6. * cosine / (root_3 * (3. - sine))};
  case Match::inner:
    return {2. * sine / (root_3 * (3. + sine)), 6. * cosine / (root_3 * (3. + sine))};
  case Match::plane_strain_associated:
  {
    const double tangent = sine / cosine, root = std::sqrt(9. + 12. * tangent * tangent);
    return {tangent / root, 3. / root};
  }
  case Match::plane_strain_isochoric:
    return {sine / 3., cosine};
  }
  throw std::invalid_argument("unknown match of Drucker and Prager's cone");
}

/// Principal axes 1, 2 of a stress in the plane, 1 of the greater one.
struct PlaneAxes
{
  double mean, radius; ///< of Mohr's circle
  double cos_2, sin_2; ///< of twice the angle from x to 1; round stress: along x

  explicit PlaneAxes(const PointStress &s)
      : mean(0.5 * (s.xx + s.yy))
      , radius(std::hypot(0.5 * (s.xx - s.yy), s.xy))
      , cos_2(radius > 0. ? 0.5 * (s.xx - s.yy) / radius : 1.)
      , sin_2(radius > 0. ? s.xy / radius : 0.)
  {
  }

  /// Components 11, 22, 33, 12 of a stress given in x, y, and back.
  PointStress from_xy(const PointStress &s) const { return turned(s, -sin_2); }
  PointStress to_xy(const PointStress &s) const { return turned(s, sin_2); }

private:
  PointStress turned(const PointStress &s, const double sine) const
  {
    const double middle = 0.5 * (s.xx + s.yy), half = 0.5 * (s.xx - s.yy);
    const double difference = half * cos_2 - s.xy * sine;
    return {middle + difference, middle - difference, s.zz, half * sine + s.xy * cos_2};
  }
};

/// Share of a shear 12 of the trial stress that is left: the axes of both stresses are
/// the same, so it is (s_1 - s_2) / (trial_1 - trial_2). Where both are equal, in a
/// region that does not tie them to each other, nothing is lost.
double shear_left(const bool tied, const double trial_difference, const double lost)
{
  if (tied)
    return 0.;
  if (lost == 0.)
    return 1.;
  return trial_difference > lost ? 1. - lost / trial_difference : 0.;
}

/// Of xx, yy, zz, 2 xy.
double equivalent(const double *const e)
{
  return std::sqrt((e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 0.5 * e[3] * e[3]) * 2. /
                   3.);
}
} // namespace

MohrCoulomb::MohrCoulomb(const LameConstants &elastic,
                         const MohrCoulombParameters &parameters)
    : elastic_(elastic)
    , associated_(parameters.dilation_angle == parameters.friction_angle)
    , principal_return_(principal_return(elastic, parameters))
{
}

PointResponse
MohrCoulomb::respond(const PointInput &input, const double *begin, double *end) const
{
  const PointStress trial = trial_stress(elastic_, input, begin);
  const PlaneAxes axes(trial);
  PrincipalStress ordered{axes.mean + axes.radius, axes.mean - axes.radius, trial.zz};
  // Places of the stresses 1, 2 and zz in the order.
  const int first = trial.zz > ordered[0] ? 1 : 0, second = trial.zz > ordered[1] ? 2 : 1;
  const int across = 3 - first - second;
  std::sort(ordered.begin(), ordered.end(), std::greater<>());

  const PrincipalReturn::Answer answer = principal_return_(ordered);
  const auto stiffness = elastic_.plane_stiffness();
  if (answer.is_elastic)
  {
    std::copy_n(begin, 4, end);
    return {trial, stiffness};
  }
  const PrincipalStress &s = answer.stress, &drop = answer.drop;
  add_plastic_strain(elastic_, axes.to_xy({drop[first], drop[second], drop[across], 0.}),
                     begin, end);

  PointResponse response;
  response.stress = axes.to_xy({s[first], s[second], s[across], 0.});
  const bool tied = (first > 0 || answer.tied_I_II) && (second < 2 || answer.tied_II_III);
  const double left = shear_left(tied, 2. * axes.radius, drop[first] - drop[second]);
  for (int j = 0; j < 3; ++j)
  {
    const double zz = j < 2 ? elastic_.lambda : 0.;
    const PointStress change =
        axes.from_xy({stiffness[0][j], stiffness[1][j], zz, stiffness[2][j]});
    const auto row = [&](const int i)
    {
      const PrincipalStress &d = answer.derivative[i];
      return d[first] * change.xx + d[second] * change.yy + d[across] * change.zz;
    };
    const PointStress column =
        axes.to_xy({row(first), row(second), 0., left * change.xy});
    response.tangent[0][j] = column.xx;
    response.tangent[1][j] = column.yy;
    response.tangent[2][j] = column.xy;
  }
  return response;
}

DruckerPrager::DruckerPrager(const LameConstants &elastic,
                             const DruckerPragerParameters &parameters)
    : elastic_(elastic)
{
  require_strength(parameters.cohesion, parameters.friction_angle,
                   parameters.dilation_angle);
  const Cone cone = matched_cone(parameters.match, parameters.friction_angle);
  alpha_ = cone.slope;
  k_ = cone.strength_per_cohesion * parameters.cohesion;
  dilation_ = matched_cone(parameters.match, parameters.dilation_angle).slope;
}

PointResponse
DruckerPrager::respond(const PointInput &input, const double *begin, double *end) const
{
  const PointStress trial = trial_stress(elastic_, input, begin);
  const double bulk = elastic_.bulk_modulus(), mu = elastic_.mu;
  const double mean = (trial.xx + trial.yy + trial.zz) / 3.;
  const PointStress s{trial.xx - mean, trial.yy - mean, trial.zz - mean, trial.xy};
  const double root_j2 =
      std::sqrt(0.5 * (s.xx * s.xx + s.yy * s.yy + s.zz * s.zz) + s.xy * s.xy);
  const double yield = 3. * alpha_ * mean + root_j2 - k_;
  if (!std::isfinite(yield))
    throw NumericalError("Drucker-Prager law", "the strain is not a finite number", yield,
                         std::numeric_limits<double>::max());
  if (yield <= 0.)
  {
    std::copy_n(begin, 4, end);
    return {trial, elastic_.plane_stiffness()};
  }

  const double resistance = 9. * bulk * alpha_ * dilation_ + mu;
  const double multiplier = yield / resistance;
  const double kept = 1. - mu * multiplier / root_j2; // share of s
  PointResponse response;
  if (!(kept > 0.))
  {
    const double apex = k_ / (3. * alpha_); // alpha > 0, else kept = k / sqrt(J_2)
    response.stress = {apex, apex, apex, 0.};
  }
  else
  {
    const double left = mean - 3. * bulk * dilation_ * multiplier;
    response.stress = {left + kept * s.xx, left + kept * s.yy, left + kept * s.zz,
                       kept * s.xy};
    response.tangent = cone_tangent(s, root_j2, kept, resistance);
  }
  const PointStress &end_stress = response.stress;
  add_plastic_strain(elastic_,
                     {trial.xx - end_stress.xx, trial.yy - end_stress.yy,
                      trial.zz - end_stress.zz, trial.xy - end_stress.xy},
                     begin, end);
  return response;
}

std::array<PlaneVector, 3> DruckerPrager::cone_tangent(const PointStress &s,
                                                       const double root_j2,
                                                       const double kept,
                                                       const double resistance) const
{
  // Flow and normal through Hooke's law: 3 K alpha 1 + mu s / sqrt(J_2).
  const double bulk = elastic_.bulk_modulus(), mu = elastic_.mu;
  const PlaneVector n{s.xx / root_j2, s.yy / root_j2, s.xy / root_j2};
  const double normal = bulk + 4. / 3. * mu * kept, cross = bulk - 2. / 3. * mu * kept;
  std::array<PlaneVector, 3> tangent{
      PlaneVector{normal, cross, 0.}, {cross, normal, 0.}, {0., 0., mu * kept}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const double direct_i = i < 2 ? 1. : 0., direct_j = j < 2 ? 1. : 0.;
      const double flow = 3. * bulk * dilation_ * direct_i + mu * n[i];
      const double gradient = 3. * bulk * alpha_ * direct_j + mu * n[j];
      // The rest is what the turn of n leaves of its own growth.
      tangent[i][j] -= flow * gradient / resistance - mu * (1. - kept) * n[i] * n[j];
    }
  return tangent;
}

double MohrCoulomb::plastic_strain(const double *const history) const
{
  return equivalent(history);
}

double DruckerPrager::plastic_strain(const double *const history) const
{
  return equivalent(history);
}
} // namespace antiform::continuum
