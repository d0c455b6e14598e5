#include "cases/deck_doubts.h"
#include "cases/effects.h"
#include "cases/formatted.h"
#include "cases/fracture_list.h"
#include "cases/geometry.h"
#include "cases/idle_entries.h"
#include "cases/mechanism.h"
#include "cases/predicted_cost.h"
#include "cases/program.h"
#include "cases/scene_in_words.h"
#include "cases/study_members.h"
#include "cases/study_prediction.h"

#include <nlohmann/json.hpp>

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace antiform::cases
{
namespace
{
using Json = nlohmann::ordered_json;

std::string state_name(const Effect::State state)
{
  switch (state)
  {
  case Effect::State::present:
    return "present";
  case Effect::State::when_needed:
    return "when needed";
  default:
    return "absent";
  }
}

/// All that is predicted of a deck.
struct Prediction
{
  Prediction(const Parameters &p,
             const SectionGeometry &g,
             const int n_threads,
             MachineSpeed &machine)
      : threads(n_threads > 0 ? n_threads : omp_get_max_threads())
      , speed(machine)
      , sizes(predict_sizes(p, g))
      , cost(predict_cost(p, g, sizes, speed, threads))
  {
  }

  int threads;
  MachineSpeed &speed;
  Sizes sizes;
  PredictedCost cost;
};

Json to_json(const Prediction &prediction)
{
  const PredictedCost &cost = prediction.cost;
  Json json = {{"steps", std::llround(cost.course.steps)},
               {"solves", std::llround(cost.course.solves)},
               {"shortening_at_end", cost.course.shortening},
               {"core_seconds", cost.core_seconds()},
               {"wall_seconds", cost.wall_seconds()},
               {"threads", prediction.threads},
               {"memory_bytes", std::llround(cost.memory)}};
  for (const CostShare &share : cost.shares)
    json["shares"].push_back(
        {{"of", share.what}, {"core_seconds", share.core_seconds}});
  for (const MachineSpeed::Measured &measured : prediction.speed.measured())
    json["measured"].push_back({{"what", measured.what},
                                {"size", std::llround(measured.size)},
                                {"unit", measured.unit},
                                {"nanoseconds", measured.nanoseconds}});
  return json;
}

Json to_json(const Parameters &p, const SectionGeometry &g, const Prediction &prediction)
{
  const Sizes &sizes = prediction.sizes;
  const Mechanism e = expect_mechanism(p, g);
  Json json;
  json["title"] = p.title;
  json["geometry"] = {{"length_m", g.length()},          {"wavelength_m", g.wavelength()},
                      {"thickness_m", g.thickness()},    {"amplitude_m", g.amplitude()},
                      {"surface_y_m", g.surface()},      {"base_y_m", g.base()},
                      {"grain_diameter_m", g.diameter()}};
  json["ratios"] = {
      {"L_over_h", g.wavelength() / g.thickness()},
      {"slenderness_ratio", e.slenderness_ratio},
      {"burial_depth_ratio", p.has("matrix") ? p.matrix.burial_depth_ratio : 0.},
      {"stiffness_contrast", p.has("matrix") ? p.matrix.stiffness_contrast : 0.}};
  if (!p.has("beds")) // the closed forms are of one layer
  {
    json["gamma_at_buckling"] = {{"pinned", e.pinned},
                                 {"guided", e.guided},
                                 {"pinned_without_matrix", e.bare_pinned},
                                 {"guided_without_matrix", e.bare_guided}};
    json["crushes_before_folding"] = e.crushes_first;
  }
  if (p.joins_grains_and_mesh())
    json["join"] = {{"how", p.matrix.join}, {"why_chosen", p.matrix.why_join}};
  json["sizes"] = {{"grains", std::llround(sizes.grains)},
                   {"layer_grains", std::llround(sizes.layer_grains)},
                   {"joints", std::llround(sizes.joints)},
                   {"cells", std::llround(sizes.cells)},
                   {"dofs", std::llround(sizes.dofs)},
                   {"multipliers", std::llround(sizes.multipliers)}};
  if (p.has("fractures"))
  {
    const FractureTraces traces = traces_in_layer(make_fractures(p, g), g);
    json["fractures"] = {{"in_the_layer", traces.number},
                         {"trace_length_m", traces.length},
                         {"P21_per_m", traces.intensity}};
  }
  json["warnings"] = doubts_of(p, g);
  for (const std::string &text : p.accuracy.warnings())
    json["warnings"].push_back(text);
  json["prediction"] = to_json(prediction);
  if (p.accuracy.percent > 0.)
    json["accuracy"] = Json::parse(accuracy_json(p.accuracy));
  for (const Effect &effect : list_effects(p))
    json["effects"][effect.name] = {{"state", state_name(effect.state)},
                                    {"reason", effect.reason}};
  return json;
}

void print_mechanism(const Parameters &p, const Mechanism &e, std::ostream &out)
{
  out << "\nMechanism (closed forms, docs/theory/continuum.md)\n";
  out << formatted("  slenderness ratio Lambda = %.3f (L/h at Lambda = 1: %.1f)\n",
                   e.slenderness_ratio, e.critical_length_ratio)
      << formatted("  gamma at buckling: pinned ends %.3f, guided ends %.3f (without "
                   "matrix %.3f, %.3f)\n",
                   e.pinned, e.guided, e.bare_pinned, e.bare_guided);
  if (e.crushes_first)
    out << "  so the layer is expected to crush before it folds much (gamma above 1.5 "
           "with guided ends);\n  for folds that grow raise 'Layer/"
        << (p.layer.length_ratio > 0. ? "Length ratio" : "Slenderness ratio") << "'"
        << (p.has("matrix") ? " or 'Matrix/Stiffness contrast'" : "") << '\n';
  else if (e.guided > 1. && p.layer.shape != "straight")
    out << "  the bare estimate with guided ends is above gamma = 1: bent beforehand, "
           "the "
           "layer folds and breaks at once\n";
}

std::string work_in_words(const PredictedCourse &course)
{
  if (course.steps > 1.)
    return formatted("%.2g steps", course.steps);
  const double solves = std::max(1., course.solves);
  return formatted("%.0f %s", solves, solves > 1. ? "solves" : "solve");
}

void print_cost(const Prediction &prediction, const std::string &of, std::ostream &out)
{
  const Sizes &sizes = prediction.sizes;
  const PredictedCost &cost = prediction.cost;
  const double seconds = cost.core_seconds(), shortening = cost.course.shortening;
  out << "\nSize and cost" << of << " (predicted)\n"
      << formatted("  %.0f grains (%.0f in the layer), %.0f joints, %.0f cells, %.0f "
                   "dofs\n",
                   sizes.grains, sizes.layer_grains, sizes.joints, sizes.cells,
                   sizes.dofs)
      << "  about " << work_in_words(cost.course)
      << (shortening > 0. ? formatted(" to a shortening of %.2e", shortening) : "")
      << formatted(", %s of one core, %.2f GB\n", duration_text(seconds).c_str(),
                   1e-9 * cost.memory);
  if (prediction.threads > 1)
    out << formatted("  %s on %d threads with a free core each\n",
                     duration_text(cost.wall_seconds()).c_str(), prediction.threads);
  for (const CostShare &share : cost.shares)
    out << formatted("  %5.1f %%  %s\n", 100. * share.core_seconds / seconds,
                     share.what.c_str());
  out << "Measured on this machine just now\n";
  for (const MachineSpeed::Measured &measured : prediction.speed.measured())
    out << formatted("  %s: %.3g ns %s (%.0f of them)\n", measured.what.c_str(),
                     measured.nanoseconds, measured.unit.c_str(), measured.size);
}

void print_check(const Parameters &p,
                 const SectionGeometry &g,
                 const Prediction &prediction,
                 const std::vector<std::string> &idle,
                 const std::string &of,
                 std::ostream &out)
{
  out << p.title << "\n\nScene\n";
  print_scene(p, g, out);
  if (p.bends())
    out << "\nMechanism: bent by its ends, which leave the walls above: nothing "
           "bifurcates\n";
  else if (p.has("beds"))
    out << "\nMechanism: the closed forms are of one layer, not of a stack of beds\n";
  else if (!p.is_specimen())
    print_mechanism(p, expect_mechanism(p, g), out);
  for (const std::string &doubt : doubts_of(p, g))
    out << "\nWarning: " << doubt << '\n';
  if (p.accuracy.percent > 0.)
    out << '\n';
  for (const std::string &text : accuracy_in_words(p.accuracy))
    out << text << '\n';
  if (!idle.empty())
    out << "\nWithout effect in this scene\n";
  for (const std::string &text : idle)
    out << "  " << text << '\n';
  out << "\nEffects\n";
  for (const Effect &effect : list_effects(p))
    out << formatted("  %-21s %-12s %s\n", effect.name.c_str(),
                     state_name(effect.state).c_str(), effect.reason.c_str());
  print_cost(prediction, of, out);
}
} // namespace

int check(const Parameters &p,
          const RunOptions &options,
          const bool json,
          std::ostream &out)
{
  const SectionGeometry g(p);
  MachineSpeed speed;
  const Prediction prediction(p, g, options.threads, speed);
  const std::vector<std::string> idle = idle_lines(options.deck, options.overrides, p);
  if (json)
  {
    Json all = to_json(p, g, prediction);
    all["without_effect"] = idle;
    out << all.dump(2) << '\n';
  }
  else
    print_check(p, g, prediction, idle, "", out);
  return 0;
}

int check_study(const RunOptions &options, const bool json, std::ostream &out)
{
  MachineSpeed speed;
  const StudyPrediction study = predict_study(options, speed);
  const Parameters &p = study.base.scene;
  const SectionGeometry g(p);
  const Prediction prediction(p, g, options.threads, speed);
  if (json)
  {
    Json all = to_json(p, g, prediction);
    all["prediction"]["study"] = Json::parse(study_json(study));
    out << all.dump(2) << '\n';
    return 0;
  }
  print_study(study, out);
  // Lines of the deck may serve some of the members.
  print_check(p, g, prediction,
              idle_lines("", overrides_of_scene(options.overrides), p),
              study.base.member.empty() ? " of the base deck" : " of the first run", out);
  return 0;
}
} // namespace antiform::cases
