#include "cases/specimen.h"

#include "cases/remedies.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace antiform::cases
{
namespace
{
/// Slope of y over x by least squares; nothing with fewer than two points.
std::optional<double> slope(const std::vector<double> &x, const std::vector<double> &y)
{
  const double n = static_cast<double>(x.size());
  double sx = 0., sy = 0., sxx = 0., sxy = 0.;
  for (std::size_t k = 0; k < x.size(); ++k)
  {
    sx += x[k];
    sy += y[k];
    sxx += x[k] * x[k];
    sxy += x[k] * y[k];
  }
  const double spread = n * sxx - sx * sx;
  if (x.size() < 2 || !(spread > 0.))
    return {};
  return (n * sxy - sx * sy) / spread;
}

/// 1/A sum of a^2 over elements without bond, whether broken or never bonded, a half of
/// their length (Budiansky and O'Connell 1976) [-].
double crack_density(const Scene &scene)
{
  double sum = 0.;
  const discrete::Joints &joints = scene.grains->state.joints;
  const discrete::DamagedJoints &damaged = joints.damaged;
  for (std::size_t k = 0; k < damaged.size(); ++k)
  {
    const int n = discrete::constants(joints.groups[damaged.group[k]].law).n_elements;
    const double a = joints.half_length[damaged.joint[k]] / n;
    for (int e = 0; e < n; ++e)
      sum += damaged.bond(k, e) != discrete::Bond::bonded ? a * a : 0.;
  }
  return sum / (scene.geometry.length() * scene.geometry.thickness());
}
} // namespace

SpecimenRecord::Gauge
SpecimenRecord::gauge(const std::vector<double> &coordinate,
                      const std::function<bool(double, double)> &holds,
                      const discrete::Grains &grains)
{
  Gauge found;
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (holds(grains.reference_x[i], grains.reference_y[i]))
    {
      found.grains.push_back(static_cast<std::int32_t>(i));
      found.place += coordinate[i];
    }
  found.place /= static_cast<double>(found.grains.size()); // none: not a number
  return found;
}

SpecimenRecord::SpecimenRecord(const Scene &scene)
{
  const SectionGeometry &g = scene.geometry;
  const discrete::Grains &grains = scene.grains->state.grains;
  const double d = g.diameter(), L = g.length(), half = 0.5 * g.thickness();
  // Axial gauges away from platens and grips; lateral ones along the sides, over a
  // quarter of the length. Where so few grains are that one holds none, they are wider.
  const bool pulls = scene.parameters.walls.pulls();
  const double at =
      pulls ? 0.3 * (L - 2. * scene.parameters.walls.grip_layers * d) : 0.2 * L;
  for (double wide = 1.; wide < 100. * L / d; wide *= 1.5)
  {
    for (const int side : {0, 1})
    {
      const double sign = side == 0 ? -1. : 1.;
      axial_[side] = gauge(
          grains.reference_x,
          [&](const double x, const double)
          { return std::abs(x - sign * at) <= wide * d; },
          grains);
      lateral_[side] = gauge(
          grains.reference_y,
          [&](const double x, const double y) {
            return sign * y >= half - 1.5 * wide * d && std::abs(x) <= 0.125 * L * wide;
          },
          grains);
    }
    if (axial_[1].place > axial_[0].place && lateral_[1].place > lateral_[0].place)
      return;
  }
}

const std::vector<std::string> &SpecimenRecord::columns()
{
  static const std::vector<std::string> names{
      "gauge_strain_axial", "gauge_strain_lateral", "lateral_stress_Pa"};
  return names;
}

/// Strain between two gauges, extension positive [-].
double SpecimenRecord::elongation(const Scene &scene,
                                  const Gauge (&pair)[2],
                                  const bool axial) const
{
  const discrete::Grains &grains = scene.grains->state.grains;
  const std::vector<double> &u = axial ? grains.displacement_x : grains.displacement_y;
  double mean[2] = {0., 0.};
  for (const int side : {0, 1})
  {
    for (const std::int32_t i : pair[side].grains)
      mean[side] += u[i];
    mean[side] /= static_cast<double>(pair[side].grains.size());
  }
  return (mean[1] - mean[0]) / (pair[1].place - pair[0].place);
}

std::vector<double> SpecimenRecord::measure(const Scene &scene) const
{
  double pressure = scene.membrane != nullptr ? scene.membrane->pressure() : 0.;
  for (const discrete::Wall &wall : scene.side_walls)
    pressure += 0.5 * wall.reaction / scene.geometry.length();
  return {elongation(scene, axial_, true), elongation(scene, lateral_, false), pressure};
}

void SpecimenRecord::keep(const Scene &scene,
                          const std::vector<double> &values,
                          const double stress)
{
  if (scene.loading_sign() * scene.shortening() <= 0.)
  {
    // Confinement is coming up: strains count from the last such sample.
    axial_strain_.clear();
    lateral_strain_.clear();
    stress_.clear();
  }
  if (scene.parameters.confinement() != nullptr && stress_.empty())
  {
    const double wanted = scene.parameters.confinement()->pressure;
    off_pressure_ =
        std::max(std::abs(values[2] / wanted - 1.), std::abs(stress / wanted - 1.));
  }
  const double sign = -scene.loading_sign(); // strains in the direction of loading
  axial_strain_.push_back(sign * values[0]);
  lateral_strain_.push_back(sign * values[1]);
  stress_.push_back(stress);
}

std::size_t SpecimenRecord::peak_sample(const double peak_stress) const
{
  return static_cast<std::size_t>(std::find(stress_.begin(), stress_.end(), peak_stress) -
                                  stress_.begin());
}

void SpecimenRecord::fill(const Scene &scene,
                          const double peak_stress,
                          Summary &summary) const
{
  auto &results = summary.results;
  const ConfinementParameters *const confinement = scene.parameters.confinement();
  if (!scene.pulls())
    results["confining_pressure"] = {
        confinement == nullptr ? 0. : confinement->pressure, "Pa"};
  if (confinement != nullptr && off_pressure_ > 0.02)
    summary.warnings.push_back(
        "shortening began with the confinement " + std::to_string(100. * off_pressure_) +
        " % off its value; raise its 'Ramp', or give less pressure");
  results["crack_density"] = {crack_density(scene), "-"};
  const std::size_t peak = peak_sample(peak_stress);
  if (peak >= stress_.size() || peak == 0)
    return; // nothing has been loaded yet
  fill_moduli(scene, peak, summary);
  // Cracks become unstable where the volume stops shrinking.
  std::size_t smallest = 0;
  double most = 0.;
  for (std::size_t k = 0; k <= peak; ++k)
    if (axial_strain_[k] + lateral_strain_[k] > most)
    {
      most = axial_strain_[k] + lateral_strain_[k];
      smallest = k;
    }
  if (!scene.pulls() && peak >= 3)
    results["crack_damage_stress"] = {stress_[smallest], "Pa"};
}

void SpecimenRecord::fill_moduli(const Scene &scene,
                                 const std::size_t peak,
                                 Summary &summary) const
{
  // Between 30 and 60 % of the stress that shortening has added at the peak.
  const double first = stress_.front(), rise = stress_[peak] - first;
  std::vector<double> axial, lateral, stress;
  for (std::size_t k = 0; k <= peak; ++k)
    if (stress_[k] >= first + 0.3 * rise && stress_[k] <= first + 0.6 * rise)
    {
      axial.push_back(axial_strain_[k]);
      lateral.push_back(lateral_strain_[k]);
      stress.push_back(stress_[k]);
    }
  const std::optional<double> modulus = slope(axial, stress),
                              ratio = slope(axial, lateral);
  if (modulus && ratio)
  {
    summary.results["young_modulus"] = {*modulus, "Pa"};
    summary.results["poisson_ratio"] = {-*ratio, "-"};
  }
  else
    summary.warnings.push_back(
        too_few_records(scene.parameters, "Young's modulus and Poisson's ratio are",
                        "between 30 and 60 % of the stress at the peak"));
}

void SpecimenRecord::visit_state(coupling::StateArchive &archive)
{
  archive.array("specimen/axial_strain", axial_strain_);
  archive.array("specimen/lateral_strain", lateral_strain_);
  archive.array("specimen/stress", stress_);
  archive.value("specimen/off_pressure", off_pressure_);
}
} // namespace antiform::cases
