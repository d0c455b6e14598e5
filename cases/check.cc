#include "cases/effects.h"
#include "cases/geometry.h"
#include "cases/join_choice.h"
#include "cases/mechanism.h"
#include "cases/predicted_cost.h"
#include "cases/program.h"
#include "cases/study_decks.h"
#include "cases/study_members.h"

#include <nlohmann/json.hpp>

#include <omp.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
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

/// What all members of a study take.
struct StudyCost
{
  std::size_t members = 0; ///< 0: no study
  double core_seconds = 0.;
};

StudyCost predict_study(const RunOptions &options, MachineSpeed &speed)
{
  StudyCost cost;
  if (!has_study(options.deck, options.overrides))
    return cost;
  const StudyParameters study = read_study(options.deck, options.overrides);
  for (const MemberDeck &member :
       read_members(options.deck, options.overrides, study, speed))
  {
    ++cost.members;
    cost.core_seconds += member.core_seconds;
  }
  return cost;
}

/// All that is predicted of a deck.
struct Prediction
{
  Prediction(const Parameters &p, const SectionGeometry &g, const RunOptions &options)
      : threads(options.threads > 0 ? options.threads : omp_get_max_threads())
      , sizes(predict_sizes(p, g))
      , cost(predict_cost(p, g, sizes, speed, threads))
      , study(predict_study(options, speed))
  {
  }

  int threads;
  MachineSpeed speed;
  Sizes sizes;
  PredictedCost cost;
  StudyCost study;
};

std::string short_number(const double x)
{
  char text[24];
  std::snprintf(text, sizeof text, "%.2e", x);
  return text;
}

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
  if (prediction.study.members > 0)
    json["study"] = {{"members", prediction.study.members},
                     {"core_seconds", prediction.study.core_seconds}};
  return json;
}

Json to_json(const Parameters &p, const RunOptions &options)
{
  const SectionGeometry g(p);
  const Prediction prediction(p, g, options);
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
  json["prediction"] = to_json(prediction);
  if (p.accuracy.percent > 0.)
    json["accuracy"] = Json::parse(accuracy_json(p.accuracy));
  for (const Effect &effect : list_effects(p))
    json["effects"][effect.name] = {{"state", state_name(effect.state)},
                                    {"reason", effect.reason}};
  return json;
}

void line(std::ostream &out, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void line(std::ostream &out, const char *format, ...)
{
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  out << text << '\n';
}
void print_mechanism(const Parameters &p, const Mechanism &e, std::ostream &out)
{
  out << "\nMechanism (closed forms, docs/theory/continuum.md)\n";
  line(out, "  slenderness ratio Lambda = %.3f (L/h at Lambda = 1: %.1f)",
       e.slenderness_ratio, e.critical_length_ratio);
  line(out,
       "  gamma at buckling: pinned ends %.3f, guided ends %.3f (without matrix %.3f, "
       "%.3f)",
       e.pinned, e.guided, e.bare_pinned, e.bare_guided);
  if (e.crushes_first)
    out << "  warning: the layer is expected to crush before it folds (gamma above 1.5 "
           "with guided ends). Raise 'Layer/"
        << (p.layer.length_ratio > 0. ? "Length ratio" : "Slenderness ratio") << "'"
        << (p.has("matrix") ? " or 'Matrix/Stiffness contrast'" : "") << ".\n";
  else if (e.guided > 1. && p.layer.shape != "straight")
    out << "  the bare estimate with guided ends is above gamma = 1: bent beforehand, "
           "the "
           "layer folds and breaks at once\n";
}

void print_cost(const Prediction &prediction, std::ostream &out)
{
  const Sizes &sizes = prediction.sizes;
  const PredictedCost &cost = prediction.cost;
  const double seconds = cost.core_seconds();
  out << "\nSize and cost (predicted)\n";
  line(out, "  %.0f grains (%.0f in the layer), %.0f joints, %.0f cells, %.0f dofs",
       sizes.grains, sizes.layer_grains, sizes.joints, sizes.cells, sizes.dofs);
  line(out, "  about %.2g steps%s, %s of one core, %.2f GB", cost.course.steps,
       cost.course.shortening > 0.
           ? (" to a shortening of " + short_number(cost.course.shortening)).c_str()
           : "",
       duration_text(seconds).c_str(), 1e-9 * cost.memory);
  if (prediction.threads > 1)
    line(out, "  %s on %d threads with a free core each",
         duration_text(cost.wall_seconds()).c_str(), prediction.threads);
  for (const CostShare &share : cost.shares)
    line(out, "  %5.1f %%  %s", 100. * share.core_seconds / seconds, share.what.c_str());
  if (prediction.study.members > 0)
    line(out, "  all %zu members of the study: about %s of one core",
         prediction.study.members, duration_text(prediction.study.core_seconds).c_str());
  out << "Measured on this machine just now\n";
  for (const MachineSpeed::Measured &measured : prediction.speed.measured())
    line(out, "  %s: %.3g ns %s (%.0f of them)", measured.what.c_str(),
         measured.nanoseconds, measured.unit.c_str(), measured.size);
}
} // namespace

int check(const Parameters &p,
          const RunOptions &options,
          const bool json,
          std::ostream &out)
{
  if (json)
  {
    out << to_json(p, options).dump(2) << '\n';
    return 0;
  }
  const SectionGeometry g(p);
  const Prediction prediction(p, g, options);
  const Mechanism e = expect_mechanism(p, g);
  out << p.title << "\n\nScene\n";
  line(out, "  section   %.4g m long, from y = %.4g to %.4g m", g.length(), g.base(),
       g.surface());
  line(out, "  layer     %s, h = %.3g m, L/h = %.2f, amplitude %.2f h, as %s",
       p.layer.shape.c_str(), g.thickness(), g.wavelength() / g.thickness(),
       g.amplitude() / g.thickness(), p.layer.representation.c_str());
  if (p.layer.representation == "grains")
    line(out, "            %.3g grains across, mean diameter %.3g m",
         p.layer.grains_across, g.diameter());
  for (int bed = 0; p.has("beds") && bed < p.n_beds(); ++bed)
    line(out, "  bed %d     %.3g m thick, %s: %.40s", bed + 1,
         p.bed_share(bed) * g.thickness(), p.beds.interface.c_str(),
         p.beds.rocks[static_cast<std::size_t>(bed)]
             .substr(p.beds.rocks[static_cast<std::size_t>(bed)].rfind('/') + 1)
             .c_str());
  if (p.has("matrix"))
  {
    line(out,
         "  matrix    E/E0 = %.3g (E0 = %.3g MPa), H/h = %.3g above, %.3g h below, %s, "
         "as %s",
         p.matrix.stiffness_contrast, 1e-6 * p.matrix_modulus(),
         p.matrix.burial_depth_ratio, p.matrix.base_depth_ratio,
         p.matrix.interface.c_str(), p.matrix.representation.c_str());
    if (p.is_bridged())
      line(out, "  overlap   %.3g d wide (%.3g m), %.3g d of matrix grains before it",
           p.bridging.overlap, p.bridging.overlap * g.diameter(), p.bridging.buffer);
    if (p.has_grain_cover())
      out << "  cover     matrix grains up to its surface, mesh below the layer only\n";
    if (p.has_surface_interface())
      line(out, "  join      the mesh ends at the layer's outer grains, cells of %.3g m",
           p.matrix.cell_size * g.diameter());
    if (!p.matrix.why_join.empty())
      out << "  chosen    " << join_in_words(p) << '\n';
  }
  if (p.bends())
    line(out,
         "  walls     turn to %.3g degrees each, which puts a strain of %.3g on the "
         "faces of a straight layer",
         p.walls.end_rotation, p.end_bending());
  if (p.bends())
    out << "\nMechanism: bent by its ends, which leave the walls above: nothing "
           "bifurcates\n";
  else if (p.has("beds"))
    out << "\nMechanism: the closed forms are of one layer, not of a stack of beds\n";
  else if (!p.is_specimen())
    print_mechanism(p, e, out);
  if (p.accuracy.percent > 0.)
    out << '\n';
  for (const std::string &text : accuracy_in_words(p.accuracy))
    out << text << '\n';
  out << "\nEffects\n";
  for (const Effect &effect : list_effects(p))
    line(out, "  %-21s %-12s %s", effect.name.c_str(), state_name(effect.state).c_str(),
         effect.reason.c_str());
  print_cost(prediction, out);
  return 0;
}
} // namespace antiform::cases
