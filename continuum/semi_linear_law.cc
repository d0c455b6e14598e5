#include "continuum/semi_linear_law.h"

#include "continuum/errors.h"

#include <cmath>

namespace antiform::continuum
{
namespace
{
/// Stretch U of a Green-Lagrange strain, as differences that do not cancel where it is
/// small.
struct Stretch
{
  double volume;          ///< J - 1
  double trace;           ///< tr U - 2
  PlaneVector difference; ///< U - 1, xx, yy and the component xy
  PlaneVector inverse;    ///< U^-1
  PlaneVector complement; ///< 1 - U^-1
};

/// In the plane U = (C + J 1) / tr U and (tr U)^2 = tr C + 2 J.
Stretch stretch_of(const PlaneVector &e)
{
  const double change = 2. * (e[0] + e[1]) + 4. * e[0] * e[1] - e[2] * e[2]; // J^2 - 1
  if (!(change > -1. && e[0] > -0.5)) // also refuses what is not a number
    throw NumericalError("semi-linear law",
                         "the body is pressed to nothing here: det C = J^2 must stay "
                         "above 0. Load in smaller steps or refine the mesh",
                         1. + change, 0.);
  Stretch s;
  const double J = std::sqrt(1. + change);
  s.volume = change / (J + 1.);
  const double squares = 2. * (e[0] + e[1]) + 2. * s.volume; // (tr U)^2 - 4
  const double r = std::sqrt(4. + squares);
  s.trace = squares / (r + 2.);
  const double rest = s.volume - s.trace;
  s.difference = {(2. * e[0] + rest) / r, (2. * e[1] + rest) / r, e[2] / r};
  // U^-1 = (tr U 1 - U) / J
  s.inverse = {(1. + s.difference[1]) / J, (1. + s.difference[0]) / J,
               -s.difference[2] / J};
  s.complement = {(rest + s.difference[0]) / J, (rest + s.difference[1]) / J,
                  s.difference[2] / J};
  return s;
}
} // namespace

PointStress SemiLinear::stress(const PlaneVector &strain) const
{
  const Stretch s = stretch_of(strain);
  const double twice = 2. * constants_.mu, area = constants_.lambda * s.trace;
  return {twice * s.complement[0] + area * s.inverse[0],
          twice * s.complement[1] + area * s.inverse[1], area,
          twice * s.complement[2] + area * s.inverse[2]};
}

double SemiLinear::energy(const PlaneVector &strain) const
{
  const Stretch s = stretch_of(strain);
  const PlaneVector &d = s.difference;
  return constants_.mu * (d[0] * d[0] + d[1] * d[1] + 2. * d[2] * d[2]) +
         0.5 * constants_.lambda * s.trace * s.trace;
}

PointResponse SemiLinear::respond(const PointInput &input, const double *, double *) const
{
  const PlaneVector &e = input.strain;
  const Stretch s = stretch_of(e);
  const PointStress own = stress(e), &initial = input.initial;
  PointResponse response{{initial.xx + own.xx, initial.yy + own.yy, initial.zz + own.zz,
                          initial.xy + own.xy},
                         {}};
  const double J = 1. + s.volume, r = 2. + s.trace;
  const PlaneVector U{1. + s.difference[0], 1. + s.difference[1], s.difference[2]};
  // dJ = J C^-1 : dE = ((1 + 2 E_yy) dE_xx + (1 + 2 E_xx) dE_yy - 2 E_xy 2 dE_xy / 2) / J
  const PlaneVector of_volume{(1. + 2. * e[1]) / J, (1. + 2. * e[0]) / J, -e[2] / J};
  for (int b = 0; b < 3; ++b) // derivatives by E_xx, E_yy, 2 E_xy
  {
    const PlaneVector dC{b == 0 ? 2. : 0., b == 1 ? 2. : 0., b == 2 ? 1. : 0.};
    const double dJ = of_volume[b], dr = (dC[0] + dC[1] + 2. * dJ) / (2. * r);
    const PlaneVector dU{(dC[0] + dJ - U[0] * dr) / r, (dC[1] + dJ - U[1] * dr) / r,
                         (dC[2] - U[2] * dr) / r};
    const PlaneVector d_inverse{(dU[1] - s.inverse[0] * dJ) / J,
                                (dU[0] - s.inverse[1] * dJ) / J,
                                (-dU[2] - s.inverse[2] * dJ) / J};
    for (int a = 0; a < 3; ++a)
      response.tangent[a][b] =
          (constants_.lambda * s.trace - 2. * constants_.mu) * d_inverse[a] +
          constants_.lambda * dr * s.inverse[a];
  }
  return response;
}
} // namespace antiform::continuum
