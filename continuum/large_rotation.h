#pragma once

#include "continuum/material_law.h"

#include <memory>

namespace antiform::continuum
{
/// A law of small strain in a body that turns far: Green-Lagrange strain in place of the
/// small one, second Piola-Kirchhoff stress in place of Cauchy's. Both turn with the
/// material, so the law never sees the rotation; what is left out is of the order of the
/// strain (de Souza Neto, Peric & Owen 2008, 14.1: for some percents).
class LargeRotation : public MaterialLaw
{
public:
  explicit LargeRotation(std::shared_ptr<const MaterialLaw> small_strain)
      : law_(std::move(small_strain))
  {
  }

  unsigned int n_history() const override { return law_->n_history(); }
  bool is_finite_strain() const override { return true; }
  bool has_symmetric_tangent() const override { return law_->has_symmetric_tangent(); }
  double plastic_strain(const double *history) const override
  {
    return law_->plastic_strain(history);
  }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override
  {
    return law_->respond(input, begin, end);
  }

private:
  std::shared_ptr<const MaterialLaw> law_;
};
} // namespace antiform::continuum
