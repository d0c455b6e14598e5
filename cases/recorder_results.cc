// What a recorder says of its run in summary.json.
#include "cases/bending_record.h"
#include "cases/fracture_record.h"
#include "cases/recorder.h"
#include "cases/remedies.h"
#include "cases/scene_events.h"

#include <algorithm>
#include <string>

namespace antiform::cases
{
std::optional<double>
Recorder::elastic_slope(const std::vector<double> &values) const
{
  // Least squares through the elastic part: up to half of the first crack's or the peak's
  // strain.
  const double limit =
      0.5 * (first_crack_strain_ > 0. ? std::min(first_crack_strain_, peak_strain_)
                                      : peak_strain_);
  double xx = 0., xy = 0., x = 0., y = 0., n = 0.;
  for (std::size_t k = 0; k < strain_.size() && strain_[k] <= limit; ++k)
  {
    if (strain_[k] < 0.2 * limit)
      continue; // the walls are coming up to speed
    xx += strain_[k] * strain_[k];
    xy += strain_[k] * values[k];
    x += strain_[k];
    y += values[k];
    n += 1.;
  }
  const double spread = n * xx - x * x;
  if (n < 2. || !(spread > 0.))
    return {};
  return (n * xy - x * y) / spread;
}

double Recorder::crack_initiation_stress() const
{
  // Cracks begin when there are 1 % of those at the peak.
  const auto peak = std::find(stress_.begin(), stress_.end(), peak_stress_);
  if (peak == stress_.end())
    return 0.;
  const double wanted = std::max(1., 0.01 * cracks_[peak - stress_.begin()]);
  const auto begin = std::find_if(cracks_.begin(), cracks_.end(),
                                  [&](const double n) { return n >= wanted; });
  return begin == cracks_.end() ? 0. : stress_[begin - cracks_.begin()];
}

void Recorder::fill_loading(Summary &summary) const
{
  auto &results = summary.results;
  const bool bends = scene_.parameters.bends();
  const std::optional<double> slope = elastic_slope(bends ? stress_ : total_);
  if (!slope && peak_strain_ > 0.)
    summary.warnings.push_back(
        too_few_records(scene_.parameters,
                        bends ? "the bending stiffness is" : "the section stiffness is",
                        "between a tenth and a half of the strain at the first crack, or "
                        "at the peak"));
  if (bends)
    return report_bending(scene_,
                          {peak_strain_, peak_stress_, first_crack_strain_,
                           first_crack_stress_, crack_initiation_stress(), slope},
                          results);
  const double height = scene_.geometry.surface() - scene_.geometry.base();
  results[scene_.pulls() ? "tensile_strength" : "peak_stress"] = {peak_stress_, "Pa"};
  results["strain_at_peak"] = {peak_strain_, "-"};
  if (slope)
    results["section_stiffness"] = {*slope / height, "Pa"};
  results["matrix_share_at_peak"] = {peak_share_, "-"};
  if (!scene_.grains || scene_.grains->state.cracks.empty())
    return;
  results["first_crack_stress"] = {first_crack_stress_, "Pa"};
  results["crack_initiation_stress"] = {crack_initiation_stress(), "Pa"};
}

void Recorder::fill(Summary &summary) const
{
  const SectionGeometry &g = scene_.geometry;
  auto &results = summary.results;
  results["shortening"] = {last_.shortening, "-"};
  fill_loading(summary);
  results["unbalanced_ratio"] = {ratio_, "-"};
  if (specimen_)
    specimen_->fill(scene_, peak_stress_, summary);
  else if (const ConfinementParameters *const around = scene_.parameters.confinement())
    results["confining_pressure"] = {around->pressure, "Pa"};
  results["fold_amplitude"] = {last_.fold.fold_amplitude, "m"};
  results["limb_dip"] = {last_.fold.limb_dip, "deg"};
  results["surface_uplift"] = {last_.fold.surface_uplift, "m"};
  if (scene_.grains)
  {
    const auto &cracks = scene_.grains->state.cracks;
    results["crack_count"] = {static_cast<double>(cracks.size()), "-"};
    results["cracks_tensile"] = {static_cast<double>(n_tensile_), "-"};
    results["cracks_shear"] = {static_cast<double>(n_shear_), "-"};
    double near_walls = 0.;
    for (const discrete::Crack &crack : cracks)
      if (std::min(crack.reference_place.x - g.x_min(),
                   g.x_max() - crack.reference_place.x) < g.thickness())
        near_walls += 1.;
    results["cracks_near_walls"] = {near_walls, "-"};
    if (!cracks.empty())
    {
      const Vec2 place = cracks.front().reference_place;
      results["first_crack_x"] = {place.x, "m"};
      results["first_crack_above_axis"] = {place.y - g.axis(place.x), "m"};
      results["first_crack_is_tensile"] = {
          cracks.front().mode == discrete::Bond::broken_in_tension ? 1. : 0., "-"};
    }
    if (!specimen_ && !scene_.pulls())
      report_fold(cracks, g, at_peak_, summary);
    const auto &would = scene_.grains->state.joints.would_break;
    const auto n_would = std::count(would.begin(), would.end(), 1);
    if (scene_.events == nullptr) // which looks at joints that break only
      results["unbreakable_joints_over_strength"] = {static_cast<double>(n_would), "-"};
  }
  report_events(scene_, summary);
  if (const coupling::StepAndRelax *const loading = scene_.load_steps)
  {
    results["load_steps"] = {static_cast<double>(loading->n_load_steps()), "-"};
    results["collapses"] = {static_cast<double>(loading->n_collapses()), "-"};
  }
  report_fractures(scene_, summary);
  report_surface(scene_, summary);
  summary.energy = {
      {"boundary_work", energies_.boundary_work},
      {"kinetic", energies_.kinetic},
      {"strain_grains", energies_.strain_grains},
      {"strain_continuum", energies_.strain_continuum},
      {"slip", energies_.slip},
      {"damping", energies_.damping},
      {"fracture", energies_.fracture},
      {"closure_error", largest_terms_ > 0. ? largest_gap_ / largest_terms_ : 0.}};
  if (const double closure = summary.energy.at("closure_error"); !(closure < 1e-3))
    summary.warnings.push_back("the energy ledger is open by " + std::to_string(closure) +
                               " of its terms, 0.001 is the limit: " +
                               closer_ledger(scene_.parameters));
  if (without_peak_)
    summary.warnings.push_back(
        "the run ended at the longest shortening before its stress had a peak: the peak "
        "given is its largest stress so far. Raise 'Run/Longest shortening'");
  for (const std::string &warning : mesh_watch_.warnings())
    summary.warnings.push_back(warning);
}
} // namespace antiform::cases
