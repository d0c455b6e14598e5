#include "cases/closed_forms.h"

#include "cases/declarations.h"
#include "cases/loads_across.h"
#include "cases/mechanism.h"
#include "continuum/bonded_theory.h"
#include "continuum/strut_theory.h"

#include <cmath>
#include <cstdio>

namespace antiform::cases
{
namespace theory = continuum::theory;

TheoryRow figure_row(const std::string &name,
                     const std::string &label,
                     const double value,
                     const std::string &unit)
{
  return {name, label, {{"", value, unit, ""}}, "", true};
}

TheoryRow
words_row(const std::string &name, const std::string &label, const std::string &words)
{
  return {name, label, {}, words, true};
}

TheoryRow
no_row(const std::string &name, const std::string &label, const std::string &reason)
{
  return {name, label, {}, reason, false};
}

namespace
{
/// L/h below which thin beams are off by more than a tenth (docs/theory/continuum.md, 4).
constexpr double shortest_beam = 5.;
// Limits of the thesis for H/h (Gioiello 2018, 5.1).
constexpr double shallow_cover = 0.1, deep_cover = 10.;

const std::string of_one_layer =
    "the closed forms are of one layer, not of a stack of beds";
const std::string no_matrix = "there is no matrix";

// --- the strut

TheorySection strut_of_one_layer(const Parameters &p, const SectionGeometry &g)
{
  const LayerParameters &l = p.layer;
  const Mechanism e = expect_mechanism(p, g);
  const double L = g.wavelength(), h = g.thickness();
  return {
      "strut",
      "Layer as a strut (Gioiello 2018, 5.1; with E, as there)",
      {figure_row("length_ratio", "L/h", L / h, "-"),
       figure_row("slenderness", "slenderness lambda = sqrt(12) L/h",
                  theory::slenderness(L, h), "-"),
       figure_row(
           "critical_slenderness", "critical slenderness lambda_c = pi sqrt(E/UCS)",
           theory::critical_slenderness(l.young_modulus, l.compressive_strength), "-"),
       figure_row("slenderness_ratio", "slenderness ratio Lambda = lambda/lambda_c",
                  e.slenderness_ratio, "-"),
       figure_row("gamma", "gamma = sigma_1/UCS at buckling, Lambda^-2",
                  theory::stress_ratio_at_buckling(e.slenderness_ratio), "-"),
       figure_row("buckling_stress", "buckling stress, ends that turn",
                  theory::euler_stress_pinned(l.young_modulus, L, h), "Pa"),
       figure_row("strength", "UCS", l.compressive_strength, "Pa")}};
}

TheorySection strut_of_beds(const Parameters &p, const SectionGeometry &g)
{
  TheorySection section{
      "strut", "Beds as struts (Gioiello 2018, 5.1; each alone, with its E)", {}};
  const double L = g.wavelength(), h = g.thickness();
  std::vector<theory::Layer> beds;
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &rock = p.bed(k);
    const double E = rock.young_modulus, UCS = rock.compressive_strength;
    const double thickness = p.bed_share(k) * h;
    const double ratio = theory::slenderness_ratio(E, UCS, L, thickness);
    const std::string number = std::to_string(k + 1);
    beds.push_back({E, rock.poisson_ratio, thickness});
    section.rows.push_back(
        {"bed_" + number,
         "bed " + number + " from below",
         {{"slenderness", theory::slenderness(L, thickness), "-", "lambda"},
          {"critical_slenderness", theory::critical_slenderness(E, UCS), "-", "lambda_c"},
          {"slenderness_ratio", ratio, "-", "Lambda"},
          {"gamma", theory::stress_ratio_at_buckling(ratio), "-", "gamma"},
          {"strength", UCS, "Pa", "UCS"}},
         "",
         true});
  }
  const double per_stiffness = std::pow(M_PI / L, 2) / h;
  for (const bool stick : {true, false})
    section.rows.push_back(
        figure_row(stick ? "stack_cemented" : "stack_sliding",
                   std::string("stack, ends that turn, beds that ") +
                       (stick ? "stick" : "slide freely") + ": buckling stress (E')",
                   theory::stack_bending_stiffness(beds, stick) * per_stiffness, "Pa"));
  return section;
}

// --- the regime

std::string
regime_word(const double value, const double shallow_limit, const double deep_limit)
{
  return value <= shallow_limit ? "shallow" : value >= deep_limit ? "deep" : "transition";
}

TheorySection regime(const Parameters &p)
{
  TheorySection section{
      "regime",
      "Regime, Theta = (H/h) (E0'/E')^(1/3) (cover with a free top on a "
      "deep base)",
      {}};
  if (!p.has("matrix") || p.has("beds"))
  {
    section.rows.push_back(
        no_row("theta", "Theta", p.has("matrix") ? of_one_layer : no_matrix));
    return section;
  }
  const double H = p.matrix.burial_depth_ratio;
  const double layer = layer_of(p).plane_modulus();
  const double matrix = theory::plane_modulus(p.matrix_modulus(), p.matrix.poisson_ratio);
  const double theta = theory::cover_variable(H, layer, matrix);
  const double per_theta = theory::cover_variable(1., layer, matrix);
  const std::string by_theta = regime_word(theta, shallow_theta, deep_theta),
                    by_thesis = regime_word(H, shallow_cover, deep_cover);
  const double shallow = shallow_theta / per_theta, deep = deep_theta / per_theta;
  section.rows = {
      figure_row("burial_depth_ratio", "H/h", H, "-"),
      figure_row("theta", "Theta", theta, "-"),
      words_row("by_theta", "by Theta (shallow to 0.3, deep from 2)", by_theta),
      words_row("by_thesis_limits", "by the thesis' limits (H/h to 0.1, from 10)",
                by_thesis),
      words_row("agreement", "the two",
                by_theta == by_thesis
                    ? "agree"
                    : "disagree: with this matrix a cover is shallow to H/h = " +
                          short_text(shallow) + " and deep from " + short_text(deep) +
                          "; follow Theta"),
      figure_row("shallow_to", "shallow to H/h =", shallow, "-"),
      figure_row("deep_from", "deep from H/h =", deep, "-")};
  return section;
}

// --- critical stress and wavelength

TheoryRow critical_row(const std::string &name,
                       const std::string &label,
                       const theory::SupportedLayer &layer)
{
  const std::string contact = layer.bonded ? "bonded" : "smooth";
  const std::string key = name + "_" + contact, text = label + ", " + contact;
  const auto state = layer.critical();
  if (!state)
    return no_row(key, text, "the longest wave has the least force: the length decides");
  return {key,
          text,
          {{"critical_stress", state->stress, "Pa", ""},
           {"wavelength", state->wavelength, "m", "wavelength"}},
          "",
          true};
}

TheoryRow cover_stiffness(const theory::SupportedLayer &layer)
{
  const std::string label = "cover stiffness K(k,H) at that wave";
  const auto state = layer.critical();
  if (!state)
    return no_row(std::string("cover_stiffness_") + (layer.bonded ? "bonded" : "smooth"),
                  label, "there is no such wave");
  const theory::Side &cover = layer.sides.front();
  if (!layer.bonded)
    return {"cover_stiffness_smooth",
            label + ", smooth",
            {{"", cover.stiffness(state->wavenumber), "Pa/m", "K"}},
            "",
            true};
  const theory::FaceStiffness face = theory::bonded_stiffness(cover, state->wavenumber);
  return {"cover_stiffness_bonded",
          label + ", bonded",
          {{"normal", face.normal, "Pa/m", "K_yy"},
           {"coupling", face.coupling, "Pa/m", "K_yx"},
           {"shear", face.shear, "Pa/m", "K_xx"}},
          "",
          true};
}

/// How far the critical state of the deck's scene is from what the theory of thin beams
/// and small strain holds for. Buckling runs of finite elements are 2 % lower at a wave
/// of 35 h (contrast 1e3), 7 % at 18 h and 29 % at 8 h.
TheoryRow trust_row(const Parameters &p)
{
  const std::string name = "trust", label = "how far to trust them";
  const auto state = supported_layer(p).critical();
  if (!state)
    return no_row(name, label, "no critical wave");
  const double wave = state->wavelength / p.layer.thickness;
  const double strain =
      state->stress / theory::plane_modulus(p.layer.young_modulus, p.layer.poisson_ratio);
  char text[200];
  std::snprintf(text, sizeof text,
                "%s: wave %.3g h (holds within 2 %% from 35 h on), "
                "strain before it %.2g %% (below 1 %%)",
                wave >= 35. && strain < 0.01 ? "yes"
                : wave >= 15.                ? "some per cent too high"
                                             : "no, far too high",
                wave, 100. * strain);
  return words_row(name, label, text);
}

TheorySection critical_states(const Parameters &p, const SectionGeometry &g)
{
  TheorySection section{"critical",
                        "Critical stress and wavelength of a long layer (E', E0'; this "
                        "deck's contact is " +
                            p.matrix.interface + ")",
                        {}};
  if (!p.has("matrix") || p.has("beds"))
  {
    section.title = "Critical stress and wavelength of a long layer";
    if (p.has("foundation") && !p.has("beds") && !p.foundation.lifts_off)
      section.rows.push_back(
          critical_row("on_foundation", "on its foundation", supported_layer(p)));
    else
      section.rows.push_back(
          no_row("critical_stress", "critical stress",
                 p.has("matrix") ? of_one_layer : no_matrix + ": the length decides"));
    return section;
  }
  const std::vector<theory::Side> sides = matrix_sides(p);
  const theory::Side half_space{sides[0].young_modulus, sides[0].poisson_ratio, 0.};
  theory::Side weighty = sides[0];
  weighty.far_face = theory::Side::FarFace::spring;
  weighty.far_spring += unit_weight(p); // on what a foundation on top adds already
  for (const bool bonded : {false, true})
  {
    const auto between = [&](const theory::Side &above, const theory::Side &below) {
      return theory::SupportedLayer{layer_of(p), {above, below}, 0., false, bonded};
    };
    const theory::SupportedLayer scene = between(sides[0], sides[1]);
    section.rows.push_back(critical_row("scene", "cover H, base of the deck", scene));
    section.rows.push_back(cover_stiffness(scene));
    if (p.has("gravity"))
      section.rows.push_back(critical_row("scene_with_relief",
                                          "the same with the weight of its relief",
                                          between(weighty, sides[1])));
    section.rows.push_back(critical_row("cover_on_half_space", "cover H on a half-space",
                                        between(sides[0], half_space)));
    section.rows.push_back(critical_row("half_spaces", "half-spaces on both sides",
                                        between(half_space, half_space)));
  }
  section.rows.push_back(trust_row(p));
  section.rows.push_back(
      figure_row("section_length", "the section has room for", g.length(), "m"));
  return section;
}

// --- at the length of the deck

TheorySection at_length(const Parameters &p, const SectionGeometry &g)
{
  TheorySection section{
      "at_length",
      "Buckling at the length of the deck (E'" +
          (p.has("matrix") ? "; contact " + p.matrix.interface : std::string()) + ")",
      {}};
  const double slender = g.wavelength() / g.thickness();
  if (p.has("beds") || slender < shortest_beam)
  {
    section.rows.push_back(no_row("buckling_stress", "buckling stress",
                                  p.has("beds") ? of_one_layer
                                                : "L/h = " + short_text(slender) +
                                                      " is too short for a beam"));
    return section;
  }
  const double UCS = p.layer.compressive_strength;
  const Mechanism e = expect_mechanism(p, g);
  const auto ends = [&](const std::string &name, const std::string &label,
                        const double pinned, const double guided)
  {
    section.rows.push_back(
        {name,
         label,
         {{"pinned", pinned, "Pa", "ends that turn"}, {"guided", guided, "Pa", "guided"}},
         "",
         true});
  };
  ends("without_matrix", "without matrix", e.bare_pinned * UCS, e.bare_guided * UCS);
  if (p.has("matrix"))
    ends("with_matrix", "with its matrix", e.pinned * UCS, e.guided * UCS);
  const double bent = g.amplitude() / g.thickness();
  const std::string crushing = "crushing of the inner arc (Perry-Robertson)";
  if (bent == 0.)
    section.rows.push_back(no_row("perry_robertson", crushing,
                                  "the layer is straight: 'Layer/Amplitude ratio'"));
  else // the matrix takes a part of the bending of either wave
    ends("perry_robertson", crushing,
         theory::perry_robertson(UCS, e.pinned * UCS,
                                 6. * bent * e.bare_pinned / e.pinned),
         theory::perry_robertson(UCS, e.guided * UCS,
                                 3. * bent * e.bare_guided / e.guided));
  return section;
}

// --- confinement

TheorySection
confinement_section(const Parameters &p, const SectionGeometry &g, const Confinement &c)
{
  TheorySection section{"confinement",
                        "Confinement: sigma_1 - p buckles the layer, N_phi p adds to its "
                        "strength (with E)",
                        {}};
  if (c.pressure == 0.)
  {
    section.title = "Confinement";
    section.rows.push_back(
        no_row("pressure", "pressure p on the layer",
               "neither surface pressure nor gravity, and nothing around "
               "a specimen"));
    return section;
  }
  const LayerParameters &l = p.layer;
  const double slope = theory::strength_slope(c.friction_angle * M_PI / 180.);
  section.rows = {
      figure_row("pressure", "pressure p on the layer", c.pressure, "Pa"),
      figure_row("friction_angle", "friction angle of the rock (--friction-angle)",
                 c.friction_angle, "degrees"),
      figure_row("buckling_stress",
                 "sigma_1 at buckling without matrix, ends that turn: p + sigma_E",
                 c.pressure + theory::euler_stress_pinned(l.young_modulus, g.wavelength(),
                                                          g.thickness()),
                 "Pa"),
      figure_row("failure_stress", "sigma_1 at failure: UCS + N_phi p",
                 l.compressive_strength + slope * c.pressure, "Pa"),
      figure_row("failure_ratio", "gamma_p = (sigma_1 - p)/UCS at failure",
                 c.failure_ratio, "-"),
      figure_row(
          "critical_slenderness_ratio", "folds before it fails above Lambda_c(p)",
          theory::confined_slenderness_limit(slope, c.pressure / l.compressive_strength),
          "-")};
  if (p.has("matrix") && !p.has("beds"))
    section.rows.insert(
        section.rows.begin() + 3,
        figure_row("buckling_stress_with_matrix", "the same with its matrix (E')",
                   c.pressure + supported_layer(p).critical_mode(g.wavelength()).force /
                                    g.thickness(),
                   "Pa"));
  return section;
}

// --- the mechanism

/// In the words of `antiform check`; \param gamma at buckling over gamma at failure
std::string mechanism_word(const double gamma, const bool at_once)
{
  if (gamma < 1.)
    return "buckle, then crush";
  return at_once && gamma <= 1.5 ? "fold and crush at once" : "crush";
}

/// Of all beds together, which crush when each of them does.
TheoryRow mechanism_of_stack(const Parameters &p, const SectionGeometry &g)
{
  std::vector<theory::Layer> beds;
  double crushing = 0.;
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &rock = p.bed(k);
    const double thickness = p.bed_share(k) * g.thickness();
    beds.push_back({rock.young_modulus, rock.poisson_ratio, thickness});
    crushing += rock.compressive_strength * thickness;
  }
  const bool stick = p.beds.interface == "cemented";
  const double gamma = theory::stack_bending_stiffness(beds, stick) *
                       std::pow(M_PI / g.wavelength(), 2) / crushing;
  return words_row("stack",
                   std::string("stack, beds that ") + (stick ? "stick" : "slide freely") +
                       ", ends that turn, without matrix",
                   mechanism_word(gamma, false));
}

TheorySection
mechanism_section(const Parameters &p, const SectionGeometry &g, const Confinement &c)
{
  TheorySection section{"mechanism", "Mechanism to expect", {}};
  if (p.bends())
  {
    section.rows.push_back(no_row("by_thesis_plot", "by the thesis' plot",
                                  "its ends are turned: it bends, nothing bifurcates"));
    return section;
  }
  if (p.has("walls") && p.walls.pulls())
  {
    section.rows.push_back(no_row("by_thesis_plot", "by the thesis' plot",
                                  "the grips pull: the layer tears"));
    return section;
  }
  for (int k = 0; k < p.n_beds() && p.has("beds"); ++k)
  {
    const LayerParameters &rock = p.bed(k);
    const double ratio =
        theory::slenderness_ratio(rock.young_modulus, rock.compressive_strength,
                                  g.wavelength(), p.bed_share(k) * g.thickness());
    const std::string number = std::to_string(k + 1);
    section.rows.push_back(
        words_row("bed_" + number, "bed " + number + " alone, by the thesis' plot",
                  mechanism_word(theory::stress_ratio_at_buckling(ratio), false)));
  }
  if (p.has("beds"))
  {
    section.rows.push_back(mechanism_of_stack(p, g));
    return section;
  }
  const Mechanism e = expect_mechanism(p, g);
  const double strut = theory::stress_ratio_at_buckling(e.slenderness_ratio);
  section.rows.push_back(words_row("by_thesis_plot", "by the thesis' plot (Lambda alone)",
                                   mechanism_word(strut / c.failure_ratio, false)));
  // A straight layer may take a shorter wave than one in its length.
  const theory::Mode mode = supported_layer(p).critical_mode(g.wavelength());
  const double crushing = p.layer.compressive_strength * g.thickness();
  const double gamma = g.amplitude() == 0. && mode.half_waves > 1
                           ? std::min(e.guided, mode.force / crushing)
                           : e.guided;
  section.rows.push_back(figure_row("gamma_with_guided_ends",
                                    "gamma with matrix and guided ends", gamma, "-"));
  section.rows.push_back(words_row("by_scene", "by that gamma, as 'antiform check'",
                                   mechanism_word(gamma / c.failure_ratio, true)));
  return section;
}
} // namespace

double unit_weight(const Parameters &p)
{
  return p.has("gravity") ? p.gravity.acceleration * p.matrix_density() : 0.;
}

double load_of_cover(const Parameters &p)
{
  if (!p.has("matrix")) // a bare layer bears its own
    return p.pressure_on_top() + (p.has("gravity") ? p.layer_density() *
                                                         p.gravity.acceleration *
                                                         p.layer.thickness
                                                   : 0.);
  const double cover = p.matrix.burial_depth_ratio * p.layer.thickness;
  return p.pressure_on_top() + unit_weight(p) * cover;
}

Confinement confinement_of(const Parameters &p, const double friction_angle)
{
  Confinement c;
  c.friction_angle = friction_angle;
  if (p.confinement() != nullptr)
    c.pressure = p.confinement()->pressure;
  else if (p.has("matrix"))
    c.pressure = load_of_cover(p) + unit_weight(p) * 0.5 * p.layer.thickness;
  c.failure_ratio =
      theory::confined_failure_ratio(theory::strength_slope(friction_angle * M_PI / 180.),
                                     c.pressure / p.layer.compressive_strength);
  return c;
}

std::vector<TheorySection> closed_forms(const Parameters &p, const double friction_angle)
{
  const SectionGeometry g(p);
  const Confinement c = confinement_of(p, friction_angle);
  return {p.has("beds") ? strut_of_beds(p, g) : strut_of_one_layer(p, g),
          regime(p),
          critical_states(p, g),
          at_length(p, g),
          loads_across(p, g, p.has("beds") ? of_one_layer : ""),
          confinement_section(p, g, c),
          mechanism_section(p, g, c)};
}
} // namespace antiform::cases
