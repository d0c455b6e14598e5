#include "continuum/maxwell_law.h"

#include "continuum/require.h"

#include <cassert>
#include <cmath>

namespace antiform::continuum
{
namespace
{
/// (1 - e^-r) / r. Below 1e-8 by its series: the next term, r^2 / 6, is below round-off.
double mean_decay(const double r)
{
  return r < 1e-8 ? 1. - 0.5 * r : -std::expm1(-r) / r;
}
} // namespace

MaxwellBody::MaxwellBody(const LameConstants &constants, const double viscosity)
    : constants_(constants)
    , relaxation_time_(viscosity / constants.mu)
{
  require(viscosity > 0., "Viscosity", viscosity, "Pa s", "> 0");
}

PointResponse
MaxwellBody::respond(const PointInput &input, const double *begin, double *end) const
{
  assert(input.time_step >= 0.);
  const PlaneVector &e = input.strain;
  const PointStress &initial = input.initial;
  const double initial_mean = (initial.xx + initial.yy + initial.zz) / 3.;
  const double bulk = constants_.bulk_modulus();

  const double r = input.time_step / relaxation_time_;
  const double lost = std::expm1(-r); // e^-r - 1
  const double shear = constants_.mu * mean_decay(r);

  const PlaneVector step{e[0] - begin[3], e[1] - begin[4], e[2] - begin[5]};
  const double step_mean = (step[0] + step[1]) / 3.;
  const PlaneVector deviatoric_step{2. * (step[0] - step_mean),
                                    2. * (step[1] - step_mean), step[2]};
  const PlaneVector initial_deviator{initial.xx - initial_mean, initial.yy - initial_mean,
                                     initial.xy};
  for (int i = 0; i < 3; ++i)
  {
    end[i] =
        begin[i] + lost * (initial_deviator[i] + begin[i]) + shear * deviatoric_step[i];
    end[3 + i] = e[i];
  }

  const double pressure = bulk * (e[0] + e[1]); // tension positive
  const double normal = bulk + 4. / 3. * shear, cross = bulk - 2. / 3. * shear;
  return {{initial.xx + end[0] + pressure, initial.yy + end[1] + pressure,
           initial.zz - end[0] - end[1] + pressure, initial.xy + end[2]},
          {PlaneVector{normal, cross, 0.}, {cross, normal, 0.}, {0., 0., shear}}};
}
} // namespace antiform::continuum
