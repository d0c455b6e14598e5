#include "cases/predicted_course.h"

#include "cases/closed_forms.h"
#include "cases/mechanism.h"
#include "cases/theory.h"
#include "continuum/strut_theory.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace antiform::cases
{
namespace theory = continuum::theory;

namespace
{
/// Of walls that step and relax, measured on specimens up to the peak.
constexpr double transits_per_load_step = 4.;
/// Of a collapse that is followed to rest, by these walls or by events; measured on one
/// specimen each.
constexpr double transits_of_collapse = 400.;

/// Of a bent layer that events follow beyond its peak, over its tolerance of balance: it
/// swings to rest in time. Means of five: 6, 35, 120, 250, 800 transits at 9e-3, 3e-3,
/// 1e-3, 3e-4, 1e-4 (cases/accuracy/balance.prm).
constexpr double transits_of_fold = 0.1;

/// Runs that end before the stress has fallen to this share of its peak are spared it.
constexpr double stress_before_collapse = 0.8;

/// Pressure over UCS from which on rock 1 hardens as it is crushed: a bent layer in its
/// matrix has its peak early at 0.03, late at 0.06 and none at 0.13 (cases/confinement).
constexpr double pressure_to_harden = 0.06;

/// Load step of events over the strain at which a body fails that its strength may be low
/// by, and is worth it [-].
constexpr double finest_load_step = 0.01;

/// Share of the largest load step that events leave, on the average.
constexpr double share_of_load_step = 0.6;

/// Iterations of Newton's method for a load step, measured on the decks of cases/.
constexpr double iterations_per_load_step = 3.;
/// A step without equilibrium is halved, again and again.
constexpr double iterations_to_give_up = 40.;

/// Modulus of one layer of one rock that bends like the beds: as one when cemented, each
/// on its own when they slide [Pa].
double bending_modulus(const Parameters &p)
{
  const bool slide = p.has("beds") && p.beds.interface == "frictional";
  double stretching = 0., moment = 0., bending = 0., below = 0.;
  for (int bed = 0; bed < p.n_beds(); ++bed)
  {
    const double modulus = p.bed(bed).young_modulus, share = p.bed_share(bed);
    const double lever = slide ? 0. : below + 0.5 * share;
    stretching += modulus * share;
    moment += modulus * share * lever;
    bending += modulus * share * (share * share / 12. + lever * lever);
    below += share;
  }
  return 12. * (bending - moment * moment / stretching);
}

/// Strength over UCS under the pressure on the sides, by Mohr-Coulomb with the friction
/// of rock 1 [-].
double gain_by_pressure(const Parameters &p, const LayerParameters &bed)
{
  const double angle = TheoryOptions().friction_angle * M_PI / 180.;
  return 1. + side_pressure(p) * theory::strength_slope(angle) / bed.compressive_strength;
}

/// Factor by which walls this fast put the peak of a bent layer off: its inertia across
/// counts the more, the less resists the fold. Measured 1.06 from 200 transits a
/// millistrain to 100 at gamma = 1 (cases/burial-depth), 1.04 from 200 to 50 at gamma = 8
/// (cases/accuracy).
double delay_by_rate(const Parameters &p, const double gamma)
{
  return p.follows_events() || p.walls.steps_and_relaxes()
             ? 1.
             : 1. + 14. / (gamma * p.walls.transits_per_millistrain);
}

/// Of the matrix on one face, over the layer's crushing stress, when the fold grows under
/// a share @p n of its crushing load [-].
double contact_of_fold(const SectionGeometry &g, const Mechanism &e, const double n)
{
  const double wave_number = 2. * M_PI / g.wavelength();
  const double deflection = 0.5 * g.amplitude() * n / (e.guided - n);
  return 0.5 * (e.guided - e.bare_guided) * g.thickness() * wave_number * wave_number *
         deflection;
}

/// Share of the load that crushes a straight layer which a bent one carries, by Perry and
/// Robertson: a force N and its moment, which alone crush at N_0 and N_0 h/4, crush it
/// together, and the matrix takes its part of the moment.
double share_of_crushing(const Parameters &p,
                         const SectionGeometry &g,
                         const Mechanism &e,
                         const double crushing_stress,
                         const double bend)
{
  const double bare = theory::perry_robertson(1., e.bare_guided, bend);
  const double held =
      theory::perry_robertson(1., e.guided, bend * e.bare_guided / e.guided);
  const double pressure = side_pressure(p);
  const bool may_part = p.has("matrix") && (p.matrix.interface == "frictional" ||
                                            p.matrix.interface == "frictionless");
  if (may_part && contact_of_fold(g, e, held) * crushing_stress > pressure)
    return bare;
  // Rock that hardens crushes all through the section, where the matrix alone is stiff
  // enough to keep a layer without bending stiffness from folding on.
  const bool keeps_straight = e.guided - e.bare_guided > 1.;
  const double hard = pressure / (pressure_to_harden * p.layer.compressive_strength);
  return keeps_straight ? held + std::min(1., hard) * (1. - held) : held;
}
} // namespace

double side_pressure(const Parameters &p)
{
  return confinement_of(p, TheoryOptions().friction_angle).pressure;
}

namespace
{
/// Strain at which a specimen parts: its weakest bed at three quarters of its bonds'
/// strength, as specimens of rock 1 do [-].
double parting_strain(const Parameters &p)
{
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < p.n_beds(); ++k)
    least = std::min(least, 0.75 * discrete::constants(p.bed(k).law()).tensile_strength /
                                p.bed(k).young_modulus);
  return least;
}
} // namespace

double longest_load_step(const Parameters &p)
{
  if (!p.walls.pulls())
    return p.walls.load_step;
  return std::min(p.walls.load_step, finest_load_step * parting_strain(p));
}

double predict_strain_at_peak(const Parameters &p, const SectionGeometry &g)
{
  if (p.walls.pulls())
    return parting_strain(p);
  // Between platens all beds have one strain, and the weakest breaks first.
  double crushing = std::numeric_limits<double>::infinity(), thickest = 0.;
  for (int k = 0; k < p.n_beds(); ++k)
  {
    const LayerParameters &bed = p.bed(k);
    crushing = std::min(crushing, gain_by_pressure(p, bed) * bed.compressive_strength /
                                      bed.young_modulus);
    thickest = std::max(thickest, p.bed_share(k) * g.thickness());
  }
  if (g.amplitude() == 0.)
    return crushing;
  const double modulus = p.young_modulus();
  Parameters one = p;
  one.layer.young_modulus = bending_modulus(p);
  one.layer.compressive_strength = crushing * modulus;
  const Mechanism e = expect_mechanism(one, g);
  const bool slide = p.has("beds") && p.beds.interface == "frictional";
  const double bend = 2. * g.amplitude() / (slide ? thickest : g.thickness());
  return crushing * delay_by_rate(p, e.guided) *
         share_of_crushing(p, g, e, crushing * modulus, bend);
}

namespace
{
/// At which a run ends, roughly [-].
double predict_shortening(const Parameters &p, const SectionGeometry &g)
{
  if (p.bends())
    return p.end_bending() + p.walls.shortening_before;
  if (p.run.end_shortening > 0.)
    return p.run.end_shortening;
  const double peak = predict_strain_at_peak(p, g);
  double multiple = p.run.strain_multiple_of_peak;
  const double ratio = p.run.stress_ratio_of_peak;
  if (ratio > 0. && side_pressure(p) == 0.)
    // A bare specimen has lost half of its strength at once; the stress of a bent layer
    // falls evenly on the way to the multiple.
    multiple =
        std::min(multiple, p.is_specimen() ? 1.03 : 1. + (multiple - 1.) * (1. - ratio));
  return std::min(multiple * peak, p.run.longest_shortening);
}

/// In which a wave passes the layer. For one mean grain of packings with this spread of
/// sizes, measured: scaled to the least step of a matrix, to the mean of a bare layer, or
/// real masses, for whose least grain all step. Smooth joints count as isotropic springs,
/// which takes another tenth.
double steps_of_transit(const Parameters &p, const SectionGeometry &g)
{
  const bool is_real = p.run.driver == "dynamic";
  const double undamped = (is_real ? 2.4 : p.has("matrix") ? 1.6 : 1.8) *
                          (p.has_smooth_joints() ? 1.1 : 1.);
  return undamped * std::sqrt(1. + (p.has("damping") ? p.damping.coefficient : 0.)) /
         p.run.safety * g.length() / g.diameter();
}

double
steps_in_time(const Parameters &p, const SectionGeometry &g, const double shortening)
{
  const double transit = steps_of_transit(p, g);
  const double transits_per_millistrain =
      p.walls.steps_and_relaxes() ? transits_per_load_step * 1e-3 / p.walls.load_step
                                  : p.walls.transits_per_millistrain;
  double transits = transits_per_millistrain * 1e3 * shortening;
  const double ramp = p.walls.ramp;
  if (p.walls.steps_and_relaxes())
    transits += shortening > predict_strain_at_peak(p, g) ? transits_of_collapse : 0.;
  else // walls come up to speed evenly
    transits = transits < 0.5 * ramp ? std::sqrt(2. * ramp * transits)
                                     : transits + 0.5 * ramp;
  if (p.confinement() != nullptr)
    transits += 2. * p.confinement()->ramp;
  return transit * transits;
}

/// In time, between those of the event driver, of a run beyond its peak.
double transits_beyond_peak(const Parameters &p, const SectionGeometry &g)
{
  if (g.amplitude() > 0. && !p.bends())
    return transits_of_fold / p.walls.balance_tolerance;
  const double ratio = p.run.stress_ratio_of_peak;
  return ratio > 0. && ratio < stress_before_collapse ? transits_of_collapse : 0.;
}

/// Load steps up to the limit load of a yielding strut, beyond which there is no
/// equilibrium.
double load_steps_with_equilibria(const Parameters &p, const SectionGeometry &g)
{
  const double steps = p.has("walls") ? p.run.load_steps : 1.;
  if (p.run.path != "load steps" || !p.has("walls") || !p.has_layer_mesh() ||
      !p.layer_material.yields() || g.amplitude() == 0.)
    return steps;
  const Mechanism e = expect_mechanism(p, g);
  const double limit =
      std::min(1., e.guided) * p.layer.compressive_strength / p.layer.young_modulus;
  return std::max(1., steps * std::min(1., 1.2 * limit / p.run.end_shortening));
}
} // namespace

double half_load_step(const Parameters &p)
{
  return std::min(0.5 * longest_load_step(p),
                  finest_load_step * predict_strain_at_peak(p, SectionGeometry(p)));
}

PredictedCourse predict_course(const Parameters &p, const SectionGeometry &g)
{
  PredictedCourse course;
  if (p.run.driver == "buckling")
  {
    course.steps = 1.;
    course.solves = p.matrix.refinement_rounds + 1.;
    return course;
  }
  if (p.run.driver == "static")
  {
    course.shortening = p.has("walls") ? p.run.end_shortening : 0.;
    course.steps = load_steps_with_equilibria(p, g);
    course.solves = course.steps;
    if (p.is_nonlinear())
      course.solves = iterations_per_load_step * (course.steps + 1.);
    if (p.has("walls") && course.steps < p.run.load_steps)
      course.solves += iterations_to_give_up;
    course.field_files = course.steps;
    return course;
  }
  if (!p.has("walls"))
    return course;
  course.shortening = predict_shortening(p, g);
  course.field_files = course.shortening / p.output.fields_interval;
  if (p.follows_events())
  {
    course.steps = course.shortening / (share_of_load_step * longest_load_step(p));
    course.samples = course.steps;
    if (course.shortening > predict_strain_at_peak(p, g))
      course.collapse_steps = transits_beyond_peak(p, g) * steps_of_transit(p, g);
  }
  else
  {
    course.steps = steps_in_time(p, g, course.shortening);
    course.samples = p.walls.steps_and_relaxes()
                         ? course.shortening / p.walls.load_step
                         : 1e3 * course.shortening * p.output.samples_per_millistrain;
  }
  return course;
}
} // namespace antiform::cases
