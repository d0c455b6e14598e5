#include "cases/calibration_problem.h"

#include "cases/deck_reader.h"
#include "cases/declarations.h"
#include "cases/strength_envelope.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace antiform::cases
{
namespace
{
std::string six_digits(const double number)
{
  std::ostringstream text;
  text.precision(6);
  text << number;
  return text.str();
}

/// Hoek-Brown line of the table of a deck. Throws InputError, or std::invalid_argument
/// when the points give no line.
HoekBrownFit fit_of_data(const CalibrationParameters &c)
{
  std::vector<std::string> problems;
  const auto sites = read_strength_table(c.data, problems);
  if (!problems.empty())
    throw InputError(problems);
  std::vector<StrengthPoint> points;
  std::vector<std::string> names;
  for (const auto &[site, rows] : sites)
  {
    names.push_back(site);
    for (const StrengthPoint &row : rows)
      if (row.sigma3 >= 0. && (c.site.empty() || site == c.site))
        points.push_back(row);
  }
  if (points.empty())
    throw std::invalid_argument("it has no rows of the site '" + c.site +
                                "'. What it has: " + join(names));
  return fit_hoek_brown(points);
}

/// The targets in the section's own terms, those of the data included.
struct Wanted
{
  double modulus = 0., tension = 0., uniaxial = 0.;
  std::vector<double> strengths;
};

Wanted wanted_of(const CalibrationParameters &c)
{
  Wanted wanted{c.young_modulus, c.tensile_strength, c.compressive_strength, c.strengths};
  if (c.data.empty())
    return wanted;
  const HoekBrownFit fit = fit_of_data(c);
  if (wanted.tension == 0.)
    wanted.tension = fit.tensile_strength;
  if (wanted.uniaxial == 0.)
    wanted.uniaxial = fit.sigma_ci;
  if (wanted.strengths.empty())
    for (const double p : c.confinements)
      wanted.strengths.push_back(
          p + std::sqrt(fit.mi * fit.sigma_ci * p + fit.sigma_ci * fit.sigma_ci));
  return wanted;
}

std::vector<Target> targets_of(const CalibrationParameters &c)
{
  const Wanted wanted = wanted_of(c);
  std::vector<Target> targets;
  const Test elastic{Test::Kind::elastic, 0.}, uniaxial{Test::Kind::compression, 0.};
  if (wanted.modulus > 0.)
    targets.push_back({"young_modulus", c.modulus_from == "uniaxial" ? uniaxial : elastic,
                       true, wanted.modulus, c.modulus_tolerance});
  if (wanted.tension > 0.)
    targets.push_back({"tensile_strength",
                       {Test::Kind::tension, 0.},
                       false,
                       wanted.tension,
                       c.tension_tolerance});
  if (wanted.uniaxial > 0.)
    targets.push_back({"ucs", uniaxial, false, wanted.uniaxial, c.uniaxial_tolerance});
  for (std::size_t k = 0; k < std::min(c.confinements.size(), wanted.strengths.size());
       ++k)
    targets.push_back({"strength_at_" + six_digits(1e-6 * c.confinements[k]) + "MPa",
                       {Test::Kind::compression, c.confinements[k]},
                       false,
                       wanted.strengths[k],
                       c.confined_tolerance});
  return targets;
}

/// Rules of thumb for a flat joint, measured on packings bonded across gaps up to the
/// mean radius: where the search begins, not where it ends.
MicroParameters start_of(const Parameters &p, const std::vector<Target> &targets)
{
  MicroParameters start = micro_parameters_of(p.layer);
  if (p.calibration.start == "rock")
    return start;
  for (const Target &target : targets)
    if (target.is_modulus)
      start.effective_modulus = target.value / 1.11;
    else if (target.test.kind == Test::Kind::tension)
      start.tensile_strength = 1.2 * target.value;
    else if (target.test.confinement == 0.)
      start.cohesion = target.value / 2.5;
  return start;
}

FreeParameter free_parameter(const MicroName &micro,
                             const CalibrationParameters &c,
                             const MicroParameters &start)
{
  if (micro.name == "friction angle")
    return {micro, c.angle_bounds[0], c.angle_bounds[1], false, 6.};
  if (micro.name == "residual friction")
    return {micro, c.friction_bounds[0], c.friction_bounds[1], false, 0.15};
  if (micro.name == "slit fraction")
    return {micro, c.slit_bounds[0], c.slit_bounds[1], false, 0.06};
  const double value = start.*micro.value;
  return {micro, value / c.range_factor, value * c.range_factor, true, 0.15};
}

void check_bounds(const std::string &entry,
                  const std::vector<double> &bounds,
                  std::vector<Finding> &findings)
{
  if (bounds.size() != 2 || bounds[0] >= bounds[1])
    findings.push_back({{entry}, "give two numbers, the least and a larger one."});
}

void check_free(const CalibrationParameters &c,
                const std::size_t n_targets,
                std::vector<Finding> &findings)
{
  const std::string entry = "Calibration/Free";
  std::vector<std::string> names;
  for (const MicroName &name : micro_names())
    names.push_back(name.name);
  for (const std::string &name : c.free)
    if (std::find(names.begin(), names.end(), name) == names.end())
    {
      const std::string near = nearest_name(name, names);
      findings.push_back({{entry},
                          "there is no micro-parameter '" + name + "'. " +
                              (near.empty() ? "" : "Did you mean '" + near + "'? ") +
                              "What exists: " + join(names) + "."});
    }
    else if (std::count(c.free.begin(), c.free.end(), name) > 1)
    {
      findings.push_back({{entry}, "names '" + name + "' twice. Name it once."});
      break;
    }
  if (c.free.empty())
    findings.push_back(
        {{entry}, "nothing is free. Name one or more of: " + join(names) + "."});
  if (c.free.size() > n_targets)
    findings.push_back(
        {{entry, "Calibration/Young modulus", "Calibration/Tensile strength",
          "Calibration/UCS", "Calibration/Confinements", "Calibration/Strengths"},
         std::to_string(c.free.size()) + " free micro-parameters for " +
             std::to_string(n_targets) +
             " targets: nothing would tell them apart. Give more targets, "
             "or free fewer."});
}

/// What each free parameter is found by.
void check_targets(const CalibrationParameters &c,
                   const std::vector<Target> &targets,
                   std::vector<Finding> &findings)
{
  const auto is_free = [&](const std::string &name)
  { return std::find(c.free.begin(), c.free.end(), name) != c.free.end(); };
  const auto is_there = [&](const std::string &name)
  {
    return std::any_of(targets.begin(), targets.end(),
                       [&](const Target &t) { return t.name == name; });
  };
  struct Need
  {
    const char *micro, *target, *entry;
  };
  for (const Need &need :
       {Need{"effective modulus", "young_modulus", "Young modulus"},
        Need{"tensile strength", "tensile_strength", "Tensile strength"},
        Need{"cohesion", "ucs", "UCS"}})
    if (is_free(need.micro) && !is_there(need.target))
      findings.push_back(
          {{std::string("Calibration/") + need.entry, "Calibration/Laboratory data"},
           std::string("the target is missing, and '") + need.micro +
               "' is free, which is found by it. Give the target [Pa]" +
               (need.micro == std::string("effective modulus") ? ""
                                                               : ", or laboratory data") +
               ", or take '" + need.micro + "' out of 'Calibration/Free'."});
  if (is_free("friction angle") && c.confinements.empty())
    findings.push_back({{"Calibration/Confinements", "Calibration/Free"},
                        "no confined test, and 'friction angle' is free, which is found "
                        "by them. Give confinements, or take it out of "
                        "'Calibration/Free'."});
}

void check_strengths(const CalibrationParameters &c,
                     const std::vector<Target> &targets,
                     std::vector<Finding> &findings)
{
  if (c.data.empty() && c.strengths.size() != c.confinements.size())
    findings.push_back({{"Calibration/Strengths", "Calibration/Confinements"},
                        std::to_string(c.strengths.size()) + " strengths for " +
                            std::to_string(c.confinements.size()) +
                            " confinements. Give one for each, or laboratory data."});
  else if (!c.strengths.empty() && c.strengths.size() != c.confinements.size())
    findings.push_back({{"Calibration/Strengths", "Calibration/Confinements"},
                        std::to_string(c.strengths.size()) + " strengths for " +
                            std::to_string(c.confinements.size()) +
                            " confinements. Give one for each, or none for those of the "
                            "laboratory data."});
  double before = -1., strength = 0.;
  for (const Target &target : targets)
    if (!target.is_modulus && target.test.kind == Test::Kind::compression)
    {
      if (target.test.confinement <= before || target.value <= strength ||
          target.value <= target.test.confinement)
        findings.push_back(
            {{"Calibration/Strengths", "Calibration/Confinements", "Calibration/UCS"},
             "sigma_1 = " + six_digits(target.value) +
                 " Pa at sigma_3 = " + six_digits(target.test.confinement) +
                 " Pa: strengths rise with confinement, and exceed it. Give both in "
                 "rising order, in Pa."});
      before = target.test.confinement;
      strength = target.value;
    }
  for (const Target &target : targets)
    if (target.test.kind == Test::Kind::tension)
      for (const Target &other : targets)
        if (other.name == "ucs" && other.value <= target.value)
          findings.push_back({{"Calibration/UCS", "Calibration/Tensile strength"},
                              "not above the tensile strength, " +
                                  six_digits(target.value) +
                                  " Pa. No rock is so; give both in Pa."});
}
} // namespace

double FreeParameter::coordinate(const double value) const
{
  const auto scaled = [this](const double x) { return is_logarithmic ? std::log(x) : x; };
  const double share = (scaled(value) - scaled(lower)) / (scaled(upper) - scaled(lower));
  // On a bound nothing would move any more.
  const double inside = std::clamp(share, 0.02, 0.98);
  return std::log(inside / (1. - inside));
}

double FreeParameter::value(const double coordinate) const
{
  const double share = 1. / (1. + std::exp(-coordinate));
  return is_logarithmic ? lower * std::pow(upper / lower, share)
                        : lower + (upper - lower) * share;
}

double FreeParameter::slope(const double coordinate) const
{
  const double share = 1. / (1. + std::exp(-coordinate));
  return share * (1. - share) *
         (is_logarithmic ? std::log(upper / lower) : upper - lower);
}

std::vector<Test> tests_of(const std::vector<Target> &targets)
{
  std::vector<Test> tests;
  for (const Target &target : targets)
    if (std::find(tests.begin(), tests.end(), target.test) == tests.end())
      tests.push_back(target.test);
  return tests;
}

CalibrationProblem calibration_problem(const Parameters &p)
{
  const CalibrationParameters &c = p.calibration;
  CalibrationProblem problem;
  problem.targets = targets_of(c);
  problem.start = start_of(p, problem.targets);
  for (const MicroName &micro : micro_names())
    if (std::find(c.free.begin(), c.free.end(), micro.name) != c.free.end())
      problem.free.push_back(free_parameter(micro, c, problem.start));
  problem.first_seed = p.layer.seed;
  problem.search_seeds = c.search_seeds;
  problem.check_seeds = c.check_seeds;
  problem.check_rounds = c.check_rounds;
  problem.evaluations = c.evaluations;
  return problem;
}

void check_calibration(const Parameters &p, std::vector<Finding> &findings)
{
  const CalibrationParameters &c = p.calibration;
  if (!p.is_specimen() || !p.has("walls") || p.has("gravity") ||
      p.has("surface pressure"))
    findings.push_back({{"Components"},
                        "a calibration tests specimens: a straight layer of grains "
                        "between walls. List layer, walls, damping, servo walls and "
                        "calibration, and give 'Layer/Shape' = 'straight'."});
  if (!c.confinements.empty() && !p.has("servo walls"))
    findings.push_back({{"Components", "Calibration/Confinements"},
                        "confined tests need servo walls. Add servo walls, or give no "
                        "'Calibration/Confinements'."});
  check_bounds("Calibration/Friction angle bounds", c.angle_bounds, findings);
  check_bounds("Calibration/Residual friction bounds", c.friction_bounds, findings);
  check_bounds("Calibration/Slit fraction bounds", c.slit_bounds, findings);
  std::vector<Target> targets;
  try
  {
    targets = targets_of(c);
  }
  catch (const InputError &error)
  {
    findings.push_back({{"Calibration/Laboratory data"}, error.what()});
    return;
  }
  catch (const std::invalid_argument &error)
  {
    findings.push_back({{"Calibration/Laboratory data", "Calibration/Site"},
                        std::string(error.what()) + "."});
    return;
  }
  check_targets(c, targets, findings);
  check_strengths(c, targets, findings);
  check_free(c, targets.size(), findings);
  const MicroParameters start = start_of(p, targets);
  if (!is_possible(start))
    findings.push_back({{"Layer/Flat joint/Friction angle", "Calibration/Start"},
                        "the search would begin with a tensile strength beyond cohesion "
                        "/ tan(friction angle), where no shear strength is left. Give a "
                        "smaller angle, or other targets."});
  if (!findings.empty())
    return;
  for (const Test &test : tests_of(targets))
    for (const Finding &finding : check_parameters(deck_of({test, 1, start}, p)))
    {
      findings.push_back(finding);
      findings.back().text += " (In the test '" + test.name() + "'.)";
    }
}
} // namespace antiform::cases
