#include "continuum/principal_return.h"

#include "continuum/elastic_laws.h"
#include "continuum/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::continuum
{
namespace
{
using Matrix = std::array<PrincipalStress, 3>;

// Numbers of the planes: those of Mohr-Coulomb by their pair of stresses, cut-offs.
enum : unsigned int
{
  shear_I_III,
  shear_II_III,
  shear_I_II,
  cut_I,
  cut_II,
  cut_III
};

double dot(const PrincipalStress &a, const PrincipalStress &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// (s_i - s_j)/2 + (s_i + s_j)/2 sine, as a row.
PrincipalStress shear_row(const int i, const int j, const double sine)
{
  PrincipalStress row{};
  row[i] = 0.5 * (1. + sine);
  row[j] = -0.5 * (1. - sine);
  return row;
}

/// Inverse of the leading n by n block by Gauss-Jordan without pivots, which its positive
/// principal minors allow (docs/theory/continuum.md, 13); the rest stays 0.
Matrix inverse(Matrix a, const unsigned int n)
{
  Matrix result{};
  for (unsigned int i = 0; i < n; ++i)
    result[i][i] = 1.;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double pivot = a[i][i];
    for (unsigned int j = 0; j < n; ++j)
    {
      a[i][j] /= pivot;
      result[i][j] /= pivot;
    }
    for (unsigned int k = 0; k < n; ++k)
      if (const double factor = a[k][i]; k != i)
        for (unsigned int j = 0; j < n; ++j)
        {
          a[k][j] -= factor * a[i][j];
          result[k][j] -= factor * result[i][j];
        }
  }
  return result;
}
} // namespace

PrincipalReturn::PrincipalReturn(const LameConstants &elastic,
                                 const double cohesion_term,
                                 const double sin_friction,
                                 const double sin_dilation,
                                 const double cutoff)
    : twice_shear_modulus_(2. * elastic.mu)
    , apex_(sin_friction > 0. ? cohesion_term / sin_friction
                              : std::numeric_limits<double>::infinity())
    , has_cutoff_(cutoff < apex_)
    , has_apex_(!has_cutoff_ && sin_friction > 0.)
{
  const auto add =
      [&](const PrincipalStress &normal, const PrincipalStress &flow, const double limit)
  {
    const double volumetric = elastic.lambda * (flow[0] + flow[1] + flow[2]);
    PrincipalStress relief;
    for (int i = 0; i < 3; ++i)
      relief[i] = volumetric + 2. * elastic.mu * flow[i];
    planes_.push_back({normal, relief, limit});
  };
  for (const auto &[i, j] : {std::array{0, 2}, {1, 2}, {0, 1}})
    add(shear_row(i, j, sin_friction), shear_row(i, j, sin_dilation), cohesion_term);
  if (has_cutoff_)
    for (int i = 0; i < 3; ++i)
    {
      PrincipalStress row{};
      row[i] = 1.;
      add(row, row, cutoff);
    }

  for (const auto &planes : std::vector<std::vector<unsigned int>>{
           {shear_I_III}, {shear_I_III, shear_II_III}, {shear_I_III, shear_I_II}})
    targets_.push_back(target(planes));
  if (has_cutoff_)
    for (const auto &planes :
         std::vector<std::vector<unsigned int>>{{cut_I},
                                                {shear_I_III, cut_I},
                                                {cut_I, cut_II},
                                                {cut_I, cut_II, cut_III},
                                                {shear_I_III, cut_I, cut_II},
                                                {shear_I_III, shear_II_III, cut_I},
                                                {shear_I_III, shear_I_II, cut_I}})
      targets_.push_back(target(planes));
}

PrincipalReturn::Target
PrincipalReturn::target(const std::vector<unsigned int> &planes) const
{
  Target target;
  target.planes = planes;
  const auto n = static_cast<unsigned int>(planes.size());
  Matrix coupling{};
  for (unsigned int k = 0; k < n; ++k)
    for (unsigned int l = 0; l < n; ++l)
      coupling[k][l] = dot(planes_[planes[k]].normal, planes_[planes[l]].relief);
  target.inverse = inverse(coupling, n);

  if (n < 3) // a point does not move with the trial stress
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        target.derivative[i][j] = i == j ? 1. : 0.;
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            target.derivative[i][j] -= planes_[planes[k]].relief[i] *
                                       target.inverse[k][l] *
                                       planes_[planes[l]].normal[j];
      }
  return target;
}

double PrincipalReturn::yield_function(const PrincipalStress &stress) const
{
  double greatest = -std::numeric_limits<double>::infinity();
  for (const Plane &plane : planes_)
    greatest = std::max(greatest, dot(plane.normal, stress) - plane.limit);
  return greatest;
}

double PrincipalReturn::try_target(const Target &target,
                                   const PrincipalStress &trial,
                                   Answer &answer) const
{
  const auto n = target.planes.size();
  PrincipalStress excess{};
  for (unsigned int k = 0; k < n; ++k)
  {
    const Plane &plane = planes_[target.planes[k]];
    excess[k] = dot(plane.normal, trial) - plane.limit;
  }
  double violation = -std::numeric_limits<double>::infinity();
  answer.drop = {};
  for (unsigned int k = 0; k < n; ++k)
  {
    const double multiplier = dot(target.inverse[k], excess);
    violation = std::max(violation, -twice_shear_modulus_ * multiplier);
    for (int i = 0; i < 3; ++i)
      answer.drop[i] += multiplier * planes_[target.planes[k]].relief[i];
  }
  for (int i = 0; i < 3; ++i)
    answer.stress[i] = trial[i] - answer.drop[i];
  answer.derivative = target.derivative;
  answer.tied_I_II = answer.tied_II_III = false;
  for (unsigned int k = 0; k < planes_.size(); ++k)
    if (std::find(target.planes.begin(), target.planes.end(), k) == target.planes.end())
      violation =
          std::max(violation, dot(planes_[k].normal, answer.stress) - planes_[k].limit);
    else
    {
      answer.tied_I_II |= k == shear_II_III || k == cut_II;
      answer.tied_II_III |= k == shear_I_II || k == cut_III;
    }
  return violation;
}

double PrincipalReturn::try_apex(const PrincipalStress &trial, Answer &answer) const
{
  double violation = -std::numeric_limits<double>::infinity();
  for (const Target *edge : {&targets_[1], &targets_[2]})
  {
    try_target(*edge, trial, answer);
    const PrincipalStress &s = answer.stress;
    violation = std::max(violation, apex_ - (s[0] + s[1] + s[2]) / 3.);
  }
  answer.stress = {apex_, apex_, apex_};
  for (int i = 0; i < 3; ++i)
    answer.drop[i] = trial[i] - apex_;
  answer.derivative = {};
  answer.tied_I_II = answer.tied_II_III = true;
  return violation;
}

PrincipalReturn::Answer PrincipalReturn::operator()(const PrincipalStress &trial) const
{
  const double size =
      std::max(std::abs(trial[0]), std::abs(trial[2])) + std::abs(planes_[0].limit);
  if (!std::isfinite(size + trial[1]))
    throw NumericalError("Mohr-Coulomb law", "the strain is not a finite number", size,
                         std::numeric_limits<double>::max());
  if (yield_function(trial) <= 0.)
  {
    const Matrix identity{PrincipalStress{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}};
    return {trial, {}, identity, false, false, true};
  }

  // At the border of two regions both returns agree but for round-off, of which the
  // smaller violation is the better one.
  Answer best{}, candidate{};
  const Target *chosen = nullptr;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](const double violation, const Target *target)
  {
    if (!(violation < least))
      return;
    least = violation;
    best = candidate;
    chosen = target;
  };
  for (const Target &target : targets_)
    if (least > 0.)
      consider(try_target(target, trial, candidate), &target);
  if (has_apex_ && least > 0.)
    consider(try_apex(trial, candidate), nullptr);
  if (!(least <= 1e-10 * size)) // far above round-off
    throw NumericalError("Mohr-Coulomb law",
                         "no part of the yield surface takes the trial stress back",
                         least, 1e-10 * size);

  if (chosen != nullptr)
  {
    // Once more, from where it ended: removes the round-off of a far trial stress.
    try_target(*chosen, best.stress, candidate);
    best.stress = candidate.stress;
    for (int i = 0; i < 3; ++i)
      best.drop[i] += candidate.drop[i];
  }
  PrincipalStress &s = best.stress;
  if (best.tied_I_II && best.tied_II_III)
    s = {s[0], s[0], s[0]};
  else if (best.tied_I_II)
    s[0] = s[1] = 0.5 * (s[0] + s[1]);
  else if (best.tied_II_III)
    s[1] = s[2] = 0.5 * (s[1] + s[2]);
  return best;
}
} // namespace antiform::continuum
