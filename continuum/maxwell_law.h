#pragma once

#include "continuum/elastic_laws.h"

namespace antiform::continuum
{
/// Maxwell body of small strain: s' + s / t_M = 2 mu e' for the deviatoric stress s, with
/// the relaxation time t_M = eta / mu; elastic in volume. The update is exact for strain
/// that grows evenly in the step, whatever its length; a step of no time is elastic.
///
/// The deviatoric part of the initial stress relaxes as any other, so that a body at rest
/// under a lithostatic stress other than hydrostatic creeps.
///
/// History: deviatoric stress less that of the initial stress, xx, yy, xy [Pa] (its zz is
/// -xx - yy); strain at the end of the step, xx, yy, 2 xy.
class MaxwellBody : public MaterialLaw
{
public:
  /// \param viscosity eta of shear [Pa s]; throws std::invalid_argument unless > 0
  MaxwellBody(const LameConstants &constants, double viscosity);

  double relaxation_time() const { return relaxation_time_; } ///< t_M [s]

  unsigned int n_history() const override { return 6; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override;

private:
  LameConstants constants_;
  double relaxation_time_;
};
} // namespace antiform::continuum
