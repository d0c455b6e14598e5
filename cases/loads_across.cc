#include "cases/loads_across.h"

#include "cases/declarations.h"
#include "cases/mechanism.h"
#include "continuum/arch_theory.h"

#include <cmath>

namespace antiform::cases
{
namespace theory = continuum::theory;

namespace
{
void add_arch(const Parameters &p, const SectionGeometry &g, TheorySection &section)
{
  const std::string label = "arch: load q* under which it neither grows nor sinks";
  if (g.amplitude() == 0.)
  {
    section.rows.push_back(
        no_row("arch", label, "the layer is straight: there is no arch"));
    return;
  }
  const double D = layer_of(p).bending_stiffness(), L = g.wavelength();
  const double a0 = g.amplitude(), q = load_of_cover(p);
  const double guided = theory::arch_critical_load(a0, L, D, theory::ArchEnds::guided);
  section.rows.push_back(
      {"arch",
       label,
       {{"pinned", theory::arch_critical_load(a0, L, D, theory::ArchEnds::pinned), "Pa",
         "ends that turn"},
        {"guided", guided, "Pa", "guided"}},
       "",
       true});
  if (q == 0.)
  {
    section.rows.push_back(no_row("cover_load", "load across the layer",
                                  "neither gravity nor surface pressure in Components"));
    return;
  }
  section.rows.push_back(figure_row("cover_load", "load across the layer, q", q, "Pa"));
  section.rows.push_back(words_row(
      "arch_grows", "under it, without support below and with guided ends, the arch",
      q < guided ? "grows" : "is pressed down"));
}

void add_snap_through(const Parameters &p,
                      const SectionGeometry &g,
                      TheorySection &section)
{
  const std::string label = "snap-through, ends pinned and fixed";
  const double r = g.thickness() / std::sqrt(12.), e0 = g.amplitude() / r;
  if (e0 == 0.)
  {
    section.rows.push_back(
        no_row("snap_through", label, "the layer is straight: there is no arch"));
    return;
  }
  const auto snap = theory::snap_through(e0);
  if (!snap)
  {
    section.rows.push_back(
        no_row("snap_through", label,
               "a0 = " + short_text(e0) +
                   " h/sqrt(12), at most 2: pressed flat without a snap"));
    return;
  }
  const double load = snap->load * theory::snap_load_unit(layer_of(p), g.wavelength());
  section.rows.push_back({"snap_through",
                          label,
                          {{"load", 0.25 * M_PI * load, "Pa", "uniform load"},
                           {"rise", snap->rise * r, "m", "at a rise of"}},
                          "",
                          true});
  section.rows.push_back(
      words_row("snap_through_mode", "it gives way",
                snap->antisymmetric ? "by swaying to one side" : "symmetrically"));
}

/// Why a layer of this deck is not lifted from a rigid base; empty: it may be.
std::string why_no_upheaval(const Parameters &p)
{
  const bool lifts_off = p.has_foundation_under("base") && p.foundation.lifts_off;
  if (!p.has("matrix") && !lifts_off)
    return "the layer rests on nothing that it could leave";
  if (p.has("matrix") && p.matrix.interface == "cemented")
    return "the contact is cemented: the layer cannot leave its base";
  if (load_of_cover(p) == 0.)
    return "neither gravity nor surface pressure: nothing holds the layer down";
  if (!p.has("matrix"))
    return "";
  const double theta = theory::cover_variable(
      p.matrix.burial_depth_ratio, layer_of(p).plane_modulus(),
      theory::plane_modulus(p.matrix_modulus(), p.matrix.poisson_ratio));
  return theta > shallow_theta
             ? "the cover is not shallow (Theta above 0.3): it resists by its stiffness"
             : "";
}

void add_upheaval(const Parameters &p, const SectionGeometry &g, TheorySection &section)
{
  const std::string label = "upheaval from a rigid base";
  std::string reason = why_no_upheaval(p);
  if (reason.empty())
  {
    const double q = load_of_cover(p);
    const theory::Upheaval up = theory::least_upheaval(layer_of(p), q, g.length());
    // A base that gives way by more than a tenth of the lift is not rigid.
    const double sinks =
        q / (p.has("matrix") ? matrix_sides(p)[1].stiffness(2. * M_PI / up.length)
                             : p.foundation_stiffness());
    if (up.length > g.length())
      reason = "the lifted length of " + short_text(up.length) +
               " m is longer than the section";
    else if (sinks > 0.1 * up.deflection)
      reason = "the base is not rigid: it gives way by " + short_text(sinks) +
               " m under the cover, the layer would rise by " +
               short_text(up.deflection) + " m";
    else
      section.rows.push_back(
          {"upheaval",
           label,
           {{"stress", up.prebuckling_force / g.thickness(), "Pa", "sigma_1 at least"},
            {"length", up.length, "m", "lifted length"},
            {"deflection", up.deflection, "m", "rise"}},
           "",
           true});
  }
  if (!reason.empty())
    section.rows.push_back(no_row("upheaval", label, reason));
}

} // namespace

TheorySection
loads_across(const Parameters &p, const SectionGeometry &g, const std::string &why_none)
{
  TheorySection section{
      "loads_across", "Loads across the layer (E', no support below)", {}};
  if (!why_none.empty())
  {
    section.rows.push_back(no_row("arch", "arch, snap-through, upheaval", why_none));
    return section;
  }
  add_arch(p, g, section);
  add_snap_through(p, g, section);
  add_upheaval(p, g, section);
  return section;
}
} // namespace antiform::cases
