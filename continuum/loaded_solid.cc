#include "continuum/loaded_solid.h"

#include "continuum/errors.h"
#include "continuum/hanging_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::continuum
{
using namespace dealii;

LoadedSolid::LoadedSolid(NonlinearSolid &solid,
                         const Loads &constant,
                         const Loads &growing)
    : solid_(solid)
    , constant_(constant)
    , growing_(growing)
    , values_(complete(solid, constant.displacements))
    , rates_(complete(solid, growing.displacements))
    , internal_force_(solid.make_vector())
    , load_(solid.make_vector())
    , residual_(solid.make_vector())
    , reactions_(solid.make_vector())
{
  for (const auto &[dof, value] : values_)
    rates_.emplace(dof, 0.);
  for (const auto &[dof, rate] : rates_)
    values_.emplace(dof, 0.);
}

bool LoadedSolid::has_symmetric_tangent() const
{
  return constant_.pressures.empty() && growing_.pressures.empty() &&
         solid_.has_symmetric_tangent();
}

void LoadedSolid::give_to_masters(Vector &force) const
{
  if (solid_.hanging_nodes() != nullptr)
    solid_.hanging_nodes()->move_to_masters(force);
}

void LoadedSolid::add_loads(const Vector &displacement,
                            const double factor,
                            Vector &force,
                            TrilinosWrappers::SparseMatrix *tangent) const
{
  for (const auto &pressure : constant_.pressures)
    pressure.add(displacement, 1., force, tangent);
  for (const auto &pressure : growing_.pressures)
    pressure.add(displacement, factor, force, tangent);
  force.compress(VectorOperation::add);
  if (tangent)
    tangent->compress(VectorOperation::add);
  if (constant_.dead)
    force.add(1., *constant_.dead);
  if (growing_.dead)
    force.add(factor, *growing_.dead);
}

void LoadedSolid::assemble(const Vector &displacement,
                           const double factor,
                           const double time_step,
                           TrilinosWrappers::SparseMatrix *tangent)
{
  solid_.assemble(displacement, time_step, internal_force_, tangent);
  load_ = 0.;
  add_loads(displacement, factor, load_, tangent);
  give_to_masters(internal_force_);
  give_to_masters(load_);

  residual_ = load_;
  residual_.add(-1., internal_force_);
  reactions_ = 0.;
  for (const auto &[dof, value] : values_)
    if (solid_.locally_owned().is_element(dof))
    {
      reactions_(dof) = -residual_(dof);
      residual_(dof) = 0.;
    }
  if (const double norm = residual_.l2_norm(); !std::isfinite(norm))
    throw NumericalError("solid",
                         "forces are not numbers; take smaller load steps. Residual [N]",
                         norm, 0.);
}

double LoadedSolid::force_scale() const
{
  return std::max(internal_force_.l2_norm(), load_.l2_norm());
}

Vector LoadedSolid::load_rate(const Vector &displacement) const
{
  Vector rate = solid_.make_vector();
  for (const auto &pressure : growing_.pressures)
    pressure.add(displacement, 1., rate, nullptr);
  rate.compress(VectorOperation::add);
  if (growing_.dead)
    rate.add(1., *growing_.dead);
  give_to_masters(rate);
  return rate;
}

DirichletValues LoadedSolid::displacements(const double factor) const
{
  DirichletValues result = values_;
  for (auto &[dof, value] : result)
    value += factor * rates_.at(dof);
  return result;
}

bool Convergence::is_reached(const LoadedSolid &body,
                             const TrilinosWrappers::SparseMatrix &tangent,
                             const Vector &displacement)
{
  const double rest = body.residual().l2_norm();
  const double scale = std::max(body.force_scale(), options_.least_force);
  const double former = residuals_.empty() ? 0. : residuals_.back();
  residuals_.push_back(rest == 0. ? 0. : rest / scale);
  is_round_off_ = rest <= std::numeric_limits<double>::epsilon() * tangent.linfty_norm() *
                              displacement.linfty_norm();
  return residuals_.back() <= options_.tolerance ||
         (is_round_off_ && residuals_.back() > 0.5 * former && former > 0.);
}
} // namespace antiform::continuum
