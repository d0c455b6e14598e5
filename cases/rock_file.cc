// The rock that a calibration has found, as an include of decks, and its table.
#include "cases/calibrate.h"
#include "cases/declarations.h"
#include "cases/formatted.h"

#include <sstream>

namespace antiform::cases
{
namespace
{
/// The section Layer in the form of a deck, with only what makes the rock.
class Entries
{
public:
  void add(const std::string &name, const double value)
  {
    text_ << std::string(depth_, ' ') << "set " << name << " = " << exact_text(value)
          << '\n';
  }
  void enter(const std::string &section)
  {
    text_ << std::string(depth_, ' ') << "subsection " << section << '\n';
    depth_ += 2;
  }
  void leave()
  {
    depth_ -= 2;
    text_ << std::string(depth_, ' ') << "end\n";
  }
  std::string text() const { return text_.str(); }

private:
  std::ostringstream text_;
  std::size_t depth_ = 0;
};

std::string entries_of(const Parameters &p,
                       const CalibrationProblem &problem,
                       const MicroParameters &micro)
{
  const LayerParameters &layer = p.layer;
  double modulus = layer.young_modulus, strength = layer.compressive_strength;
  for (const Target &target : problem.targets)
    if (target.is_modulus)
      modulus = target.value;
    else if (target.name == "ucs")
      strength = target.value;
  Entries entries;
  entries.enter("Layer");
  entries.add("Young modulus", modulus);
  entries.add("UCS", strength);
  entries.add("Radius ratio", layer.radius_ratio);
  entries.add("Grain density", layer.grain_density);
  entries.add("Installation gap ratio", layer.installation_gap);
  entries.enter("Flat joint");
  entries.add("Effective modulus", micro.effective_modulus);
  entries.add("Stiffness ratio", layer.joint.stiffness_ratio);
  entries.add("Tensile strength", micro.tensile_strength);
  entries.add("Cohesion", micro.cohesion);
  entries.add("Friction angle", micro.friction_angle);
  entries.add("Residual friction", micro.residual_friction);
  if (layer.joint.residual_cohesion > 0.)
    entries.add("Residual cohesion", layer.joint.residual_cohesion);
  entries.add("Elements", layer.joint.n_elements);
  entries.add("Radius multiplier", layer.joint.radius_multiplier);
  entries.leave();
  const discrete::JointTypes &types = layer.types;
  if (micro.slit_fraction > 0. || types.gapped_fraction > 0.)
  {
    entries.enter("Joint types");
    entries.add("Slit fraction", micro.slit_fraction);
    entries.add("Gapped fraction", types.gapped_fraction);
    entries.add("Gap ratio", types.gap_ratio);
    entries.add("Gap deviation", types.gap_deviation);
    entries.leave();
  }
  if (layer.scatter.any())
  {
    entries.enter("Strength scatter");
    entries.add("Tensile strength deviation", layer.scatter.tension);
    entries.add("Cohesion deviation", layer.scatter.cohesion);
    entries.leave();
  }
  entries.leave();
  return entries.text();
}
} // namespace

std::vector<std::string> table_of(const CalibrationProblem &problem,
                                  const CalibrationResult &result)
{
  const Evaluation &check = result.check;
  std::vector<std::string> lines;
  lines.push_back(formatted("%-20s %10s %10s %21s %10s", "", "target", "expected",
                            "fresh packings", "off by"));
  for (std::size_t i = 0; i < problem.targets.size(); ++i)
  {
    const Target &target = problem.targets[i];
    const double unit = target.is_modulus ? 1e-9 : 1e-6;
    lines.push_back(formatted(
        "%-20s %10.4g %10.4g %10.4g +- %7.2g %+8.1f %%  %s (%.3g %%)",
        (target.name + (target.is_modulus ? " GPa" : " MPa")).c_str(),
        unit * target.value, unit * result.expected[i], unit * check.mean(i),
        unit * check.deviation(i), 100. * (check.mean(i) / target.value - 1.),
        is_met(check, problem.targets, i) ? "met" : "not met", 100. * target.tolerance));
  }
  lines.push_back(formatted("expected: of %d packings before the check, brought to these "
                            "micro-parameters;",
                            result.packings_before));
  lines.push_back(formatted("fresh: mean and standard deviation of seeds %d to %d",
                            check.seeds.front(), check.seeds.back()));
  return lines;
}

std::string rock_file(const Parameters &p,
                      const CalibrationProblem &problem,
                      const CalibrationResult &result,
                      const std::string &date)
{
  std::ostringstream text;
  text << "# Calibrated by 'antiform calibrate' (" ANTIFORM_VERSION ") on " << date
       << ":\n# " << p.title
       << ".\n# To be included above all subsections of a deck.\n#\n";
  for (const std::string &line : table_of(problem, result))
    text << "#   " << line << '\n';
  text << "#\n"
       << (result.met ? "# All targets are met on the fresh packings."
                      : "# NOT all targets are met on the fresh packings.")
       << formatted(" It is checked %d time%s.\n", result.rounds,
                    result.rounds == 1 ? "" : "s")
       << formatted("# Valid at the resolution it was calibrated at, %.4g grains across "
                    "%.4g m; strengths depend on it.\n",
                    p.layer.grains_across, p.layer.thickness)
       << "# Young modulus and UCS are the targets.\n"
       << entries_of(p, problem, result.micro);
  return text.str();
}
} // namespace antiform::cases
