#include "continuum/elastic_laws.h"

#include "continuum/errors.h"
#include "continuum/require.h"

#include <cmath>

namespace antiform::continuum
{
namespace
{
PointStress sum(const PointStress &a, const PointStress &b)
{
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy};
}

/// det C - 1 = J^2 - 1 of C = 1 + 2 E, without the cancellation of small strain.
double area_change(const PlaneVector &e, const char *law)
{
  const double change = 2. * (e[0] + e[1]) + 4. * e[0] * e[1] - e[2] * e[2];
  if (!(change > -1. && e[0] > -0.5)) // also refuses what is not a number
    throw NumericalError(law,
                         "the body is pressed to nothing here: det C = J^2 must stay "
                         "above 0. Load in smaller steps or refine the mesh",
                         1. + change, 0.);
  return change;
}
} // namespace

LameConstants LameConstants::from_young_poisson(const double young_modulus,
                                                const double poisson_ratio)
{
  require(young_modulus > 0., "Young's modulus", young_modulus, "Pa", "> 0");
  require(poisson_ratio > -1. && poisson_ratio < 0.5, "Poisson's ratio", poisson_ratio,
          "", "> -1 and < 0.5");
  return {young_modulus * poisson_ratio /
              ((1. + poisson_ratio) * (1. - 2. * poisson_ratio)),
          young_modulus / (2. * (1. + poisson_ratio))};
}

PointStress LameConstants::stress(const PointStrain &strain) const
{
  const double volumetric = lambda * (strain[0] + strain[1] + strain[2]);
  return {volumetric + 2. * mu * strain[0], volumetric + 2. * mu * strain[1],
          volumetric + 2. * mu * strain[2], mu * strain[3]};
}

PointStrain LameConstants::strain(const PointStress &stress) const
{
  const double mean = (stress.xx + stress.yy + stress.zz) / 3.;
  const double third = mean / (3. * bulk_modulus()); // of the change of volume
  return {third + (stress.xx - mean) / (2. * mu), third + (stress.yy - mean) / (2. * mu),
          third + (stress.zz - mean) / (2. * mu), stress.xy / mu};
}

std::array<PlaneVector, 3> LameConstants::plane_stiffness() const
{
  const double oedometer = lambda + 2. * mu;
  return {PlaneVector{oedometer, lambda, 0.}, {lambda, oedometer, 0.}, {0., 0., mu}};
}

PointResponse
LinearElastic::respond(const PointInput &input, const double *, double *) const
{
  const PlaneVector &e = input.strain;
  return {sum(input.initial, constants_.stress({e[0], e[1], 0., e[2]})),
          constants_.plane_stiffness()};
}

PointStress NeoHookean::stress(const PlaneVector &e) const
{
  const double change = area_change(e, "neo-Hookean law"), per_det = 1. / (1. + change);
  const double volumetric = constants_.lambda * 0.5 * std::log1p(change);
  const double mu = constants_.mu;
  // C^-1, and 1 - C^-1 without cancellation: (det - C_yy) / det and so on.
  const double xx = 1. + 2. * e[0], yy = 1. + 2. * e[1], square = e[2] * e[2];
  return {per_det * (mu * (2. * e[0] * yy - square) + volumetric * yy),
          per_det * (mu * (2. * e[1] * xx - square) + volumetric * xx), volumetric,
          per_det * (mu - volumetric) * e[2]};
}

double NeoHookean::energy(const PlaneVector &e) const
{
  const double change = area_change(e, "neo-Hookean law");
  const double log_jacobian = 0.5 * std::log1p(change);
  // tr C - 3 - 2 ln J = 2 tr E - ln(1 + change); both are of first order in the strain,
  // their difference of second: change - ln(1 + change) + 2 tr E - change.
  const double shape = e[2] * e[2] - 4. * e[0] * e[1]; // 2 tr E - change
  const double volume = change - std::log1p(change);
  return 0.5 * constants_.mu * (shape + volume) +
         0.5 * constants_.lambda * log_jacobian * log_jacobian;
}

PointResponse NeoHookean::respond(const PointInput &input, const double *, double *) const
{
  const PlaneVector &e = input.strain;
  const double change = area_change(e, "neo-Hookean law"), det = 1. + change;
  const double log_jacobian = 0.5 * std::log1p(change);
  const double lambda = constants_.lambda, mu = constants_.mu;
  const PlaneVector inverse{(1. + 2. * e[1]) / det, (1. + 2. * e[0]) / det, -e[2] / det};

  // lambda C^-1 x C^-1 + (mu - lambda ln J)(C^-1_IK C^-1_JL + C^-1_IL C^-1_JK)
  PointResponse response{sum(input.initial, stress(e)), {}};
  const double shear = mu - lambda * log_jacobian;
  const auto at = [&](const int i, const int j) { return inverse[i == j ? i : 2]; };
  constexpr int first[] = {0, 1, 0}, second[] = {0, 1, 1};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      response.tangent[a][b] =
          lambda * inverse[a] * inverse[b] +
          shear * (at(first[a], first[b]) * at(second[a], second[b]) +
                   at(first[a], second[b]) * at(second[a], first[b]));
  return response;
}

PointResponse
StVenantKirchhoff::respond(const PointInput &input, const double *, double *) const
{
  const PlaneVector &e = input.strain;
  area_change(e, "St Venant-Kirchhoff law");
  return {sum(input.initial, constants_.stress({e[0], e[1], 0., e[2]})),
          constants_.plane_stiffness()};
}
} // namespace antiform::continuum
