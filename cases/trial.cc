#include "cases/trial.h"

#include "cases/child_runs.h"
#include "cases/declarations.h"
#include "coupling/state_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace antiform::cases
{
namespace
{
/// Far below the first crack, far above rounding.
constexpr double elastic_shortening = 1e-4;
} // namespace

const std::vector<MicroName> &micro_names()
{
  using M = MicroParameters;
  static const std::vector<MicroName> names = {
      {"effective modulus", "Layer/Flat joint/Effective modulus", "effective_modulus_Pa",
       &M::effective_modulus},
      {"tensile strength", "Layer/Flat joint/Tensile strength", "tensile_strength_Pa",
       &M::tensile_strength},
      {"cohesion", "Layer/Flat joint/Cohesion", "cohesion_Pa", &M::cohesion},
      {"friction angle", "Layer/Flat joint/Friction angle", "friction_angle_deg",
       &M::friction_angle},
      {"residual friction", "Layer/Flat joint/Residual friction", "residual_friction",
       &M::residual_friction},
      {"slit fraction", "Layer/Joint types/Slit fraction", "slit_fraction",
       &M::slit_fraction}};
  return names;
}

MicroParameters micro_parameters_of(const LayerParameters &layer)
{
  const discrete::FlatJoint &joint = layer.joint;
  return {joint.effective_modulus, joint.tensile_strength,
          joint.cohesion,          degrees_of_tangent(joint.tan_friction),
          joint.residual_friction, layer.types.slit_fraction};
}

MicroParameters rounded(const MicroParameters &micro)
{
  MicroParameters result = micro;
  for (const MicroName &name : micro_names())
  {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", micro.*name.value);
    result.*name.value = std::stod(text);
  }
  return result;
}

bool is_possible(const MicroParameters &micro)
{
  const double tangent = tangent_of_degrees(micro.friction_angle);
  return micro.tensile_strength * tangent <= micro.cohesion;
}

std::string Test::name() const
{
  if (kind == Kind::elastic)
    return "elastic";
  if (kind == Kind::tension)
    return "tension";
  if (confinement == 0.)
    return "uniaxial";
  std::ostringstream text;
  text << "biaxial-" << 1e-6 * confinement << "MPa";
  return text.str();
}

Parameters deck_of(const Trial &trial, const Parameters &calibration)
{
  Parameters p = calibration;
  const auto leave_out = [&p](const std::string &component)
  {
    p.components.erase(std::remove(p.components.begin(), p.components.end(), component),
                       p.components.end());
  };
  p.title = trial.test.name() + ", seed " + std::to_string(trial.seed);
  leave_out("calibration");
  if (trial.test.confinement > 0.)
    p.servo_walls.pressure = trial.test.confinement;
  else
    leave_out("servo walls");

  p.layer.seed = trial.seed;
  p.layer.joint.effective_modulus = trial.micro.effective_modulus;
  p.layer.joint.tensile_strength = trial.micro.tensile_strength;
  p.layer.joint.cohesion = trial.micro.cohesion;
  p.layer.joint.tan_friction = tangent_of_degrees(trial.micro.friction_angle);
  p.layer.joint.residual_friction = trial.micro.residual_friction;
  p.layer.types.slit_fraction = trial.micro.slit_fraction;
  p.layer.joint.breakable = trial.test.kind != Test::Kind::elastic;

  p.output.fields_interval = 1.; // none but the first and the last
  p.walls.action = "press";
  if (trial.test.kind == Test::Kind::tension)
  {
    // Samples keep their distance in transits.
    p.output.samples_per_millistrain = static_cast<int>(
        std::ceil(p.output.samples_per_millistrain * p.calibration.transits_of_tension /
                  p.walls.transits_per_millistrain));
    p.walls.transits_per_millistrain = p.calibration.transits_of_tension;
    p.walls.action = "pull";
  }
  if (trial.test.kind == Test::Kind::elastic)
  {
    p.run.end_shortening = elastic_shortening;
    // Short as it is, it must be longer than the walls take to come up to speed.
    p.walls.transits_per_millistrain = std::max(p.walls.transits_per_millistrain, 600.);
    p.output.samples_per_millistrain = std::max(p.output.samples_per_millistrain, 2000);
  }
  return p;
}

std::string trial_name(const Trial &trial, const Parameters &deck)
{
  const std::string text = effective_deck(deck);
  char checksum[24];
  std::snprintf(
      checksum, sizeof checksum, "%016llx",
      static_cast<unsigned long long>(coupling::crc64(text.data(), text.size())));
  return trial.test.name() + "-seed" + std::to_string(trial.seed) + "-" + checksum;
}

bool read_measurement(const Trial &trial,
                      const double longest_shortening,
                      const std::string &directory,
                      Measurement &measurement,
                      double &cpu_seconds)
{
  std::ifstream input(directory + "/summary.json");
  const auto summary = nlohmann::json::parse(input, nullptr, false);
  if (!input.is_open() || summary.is_discarded() || !summary.is_object() ||
      summary.value("status", "") == "interrupted")
    return false;
  if (summary.value("status", "") != "completed")
    throw std::runtime_error("the run has failed: " +
                             last_line_of(directory + "/log.txt"));
  const auto &results = summary.at("results");
  const auto value = [&](const char *name)
  { return results.contains(name) ? results[name]["value"].template get<double>() : 0.; };
  cpu_seconds = summary.value("cpu_seconds", 0.);
  const bool breaks = trial.test.kind != Test::Kind::elastic;
  // A curve that still rises where the run gave up has no strength, but under
  // confinement, where it may harden for good: there it is the stress at that strain.
  if (breaks && trial.test.confinement == 0. &&
      std::abs(value("shortening")) >= 0.99 * longest_shortening &&
      value("strain_at_peak") > 0.97 * longest_shortening)
    throw std::runtime_error(
        "the specimen did not break before 'Run/Longest shortening'");
  measurement.young_modulus = value("young_modulus");
  measurement.strength =
      value(trial.test.kind == Test::Kind::tension ? "tensile_strength" : "peak_stress");
  if (!(measurement.young_modulus > 0.) || (breaks && !(measurement.strength > 0.)))
    throw std::runtime_error("the curve has no slope or no peak: " +
                             last_line_of(directory + "/log.txt"));
  return true;
}
} // namespace antiform::cases
