// What a deck may say of the layer and of what joins its grains.
#include "cases/declarations.h"

namespace antiform::cases
{
void declare_strengths(double &tensile_strength,
                       double &cohesion,
                       double &tan_friction,
                       double &residual_friction,
                       Declarations &entries)
{
  entries.number("Tensile strength", tensile_strength,
                 "sigma_b, normal stress at which a bonded element breaks [Pa].",
                 Number::at_least(0.));
  entries.number("Cohesion", cohesion,
                 "c_b, shear strength of a bonded element without normal stress [Pa].",
                 Number::at_least(0.));
  entries.angle("Friction angle", tan_friction,
                "phi_b, by which pressure adds to the shear strength of a bonded element "
                "[degrees].");
  entries.number("Residual friction", residual_friction,
                 "mu, friction coefficient of a broken element [-].",
                 Number::at_least(0.));
}

namespace
{
/// From soft clay to diamond, of a rock as of its bonds: what is meant in MPa or GPa is
/// far below.
Number moduli()
{
  return Number::between(1e6, 1e12);
}

/// Disks with k_s beyond ten times k_n shear less than they shorten, which no rock does;
/// below a hundredth of it they have lost their shear stiffness.
Number stiffness_ratios()
{
  return Number::between(0.1, 100.);
}

void declare(discrete::FlatJoint &joint, Declarations &entries)
{
  entries.enter("Flat joint");
  entries.number(
      "Effective modulus", joint.effective_modulus,
      "E*, of grains and bonds; the stiffness of a joint follows from it and the "
      "two radii [Pa].",
      moduli());
  entries.number("Stiffness ratio", joint.stiffness_ratio,
                 "kappa, normal over shear stiffness [-].", stiffness_ratios());
  declare_strengths(joint.tensile_strength, joint.cohesion, joint.tan_friction,
                    joint.residual_friction, entries);
  entries.number("Residual cohesion", joint.residual_cohesion,
                 "Shear strength of the closed part of a broken element without pressure "
                 "[Pa].",
                 Number::at_least(0.));
  entries.number("Radius multiplier", joint.radius_multiplier,
                 "lambda, half length of the joint over the smaller radius [-].",
                 Number::above(0.).up_to(1.));
  entries.whole("Elements", joint.n_elements,
                "N, elements of a joint; each breaks on its own [-].",
                Number::between(1, 16));
  entries.flag("Element moment", joint.element_moment,
               "Does the stress vary linearly within an element, or is it uniform?");
  entries.leave();
}

void declare(discrete::ParallelBond &bond, Declarations &entries)
{
  entries.enter("Parallel bond");
  entries.number("Bond modulus", bond.bond_modulus,
                 "E_c, of the cement; its stiffness follows from it and the two radii "
                 "[Pa].",
                 moduli());
  entries.number("Stiffness ratio", bond.stiffness_ratio,
                 "kappa, normal over shear stiffness of the cement [-].",
                 stiffness_ratios());
  entries.number("Tensile strength", bond.tensile_strength,
                 "sigma_c, normal stress at the cement's edge at which it breaks [Pa].",
                 Number::at_least(0.));
  entries.number("Cohesion", bond.cohesion,
                 "c, shear stress at which the cement breaks without normal stress [Pa].",
                 Number::at_least(0.));
  entries.angle("Friction angle", bond.tan_friction,
                "phi, by which pressure adds to the shear strength; 0 in the model of "
                "2004 [degrees].");
  entries.number("Radius multiplier", bond.radius_multiplier,
                 "lambda, half width of the cement over the smaller radius [-].",
                 Number::above(0.).up_to(1.));
  entries.number("Moment contribution", bond.moment_contribution,
                 "beta, share of the bending stress that the strengths see; 1 in the "
                 "model of 2004 [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number("Contact modulus", bond.contact_modulus,
                 "E*, of the linear contact of the grains beside the cement [Pa].",
                 moduli());
  entries.number("Contact stiffness ratio", bond.contact_stiffness_ratio,
                 "Normal over shear stiffness of the contact [-].", stiffness_ratios());
  entries.number("Residual friction", bond.residual_friction,
                 "mu, friction coefficient of the contact [-].", Number::at_least(0.));
  entries.leave();
}

void declare(discrete::ContactBond &bond, Declarations &entries)
{
  entries.enter("Contact bond");
  entries.number("Effective modulus", bond.effective_modulus,
                 "E*, of the glued contact [Pa].", moduli());
  entries.number("Stiffness ratio", bond.stiffness_ratio,
                 "kappa, normal over shear stiffness [-].", stiffness_ratios());
  entries.number("Tensile strength", bond.tensile_strength,
                 "Tension at which the glue breaks, over the width 2 min(R) [Pa].",
                 Number::at_least(0.));
  entries.number("Shear strength", bond.shear_strength,
                 "Shear force at which it breaks, over the same width [Pa].",
                 Number::at_least(0.));
  entries.number("Residual friction", bond.residual_friction,
                 "mu, friction coefficient of the contact that stays [-].",
                 Number::at_least(0.));
  entries.leave();
}

void declare(discrete::JointTypes &types, Declarations &entries)
{
  entries.enter("Joint types");
  entries.number("Slit fraction", types.slit_fraction,
                 "Share of the joints that begin without bonds, their faces touching "
                 "(type S of PFC) [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number(
      "Gapped fraction", types.gapped_fraction,
      "Share of the joints that begin without bonds, their faces apart (type G) "
      "[-].",
      Number::at_least(0.).up_to(1.));
  entries.number("Gap ratio", types.gap_ratio,
                 "Mean gap of the gapped joints over the mean grain radius [-].",
                 Number::at_least(0.).up_to(1.));
  entries.number("Gap deviation", types.gap_deviation,
                 "Standard deviation of those gaps over their mean; normal, cut off at 0 "
                 "[-].",
                 Number::at_least(0.));
  entries.leave();
}

void declare(discrete::StrengthScatter &scatter, Declarations &entries)
{
  entries.enter("Strength scatter");
  entries.number("Tensile strength deviation", scatter.tension,
                 "Standard deviation over the mean of the tensile strength from joint to "
                 "joint; normal, within three deviations and not below 0.05 of the "
                 "mean (which is so 3 % higher at 0.5) [-].",
                 Number::at_least(0.).up_to(0.5));
  entries.number("Cohesion deviation", scatter.cohesion,
                 "The same of the cohesion (the shear strength of a contact bond) [-].",
                 Number::at_least(0.).up_to(0.5));
  entries.leave();
}
} // namespace

void declare(LayerParameters &layer, Declarations &entries)
{
  entries.enter("Layer");
  entries.choice("Representation", layer.representation,
                 "Flat-jointed grains that may break, or finite elements that do not.",
                 "grains|continuum");
  entries.number("Thickness", layer.thickness,
                 "h, the length that all ratios are multiples of [m].",
                 Number::above(0.).up_to(1e5));
  entries.choice(
      "Shape", layer.shape,
      "straight, or cosine: bent beforehand into one anticline between straight "
      "ends.",
      "straight|cosine");
  entries.number(
      "Slenderness ratio", layer.slenderness_ratio,
      "Lambda, slenderness sqrt(12) L/h over the critical one, pi sqrt(E/UCS), at "
      "which buckling and shear failure coincide [-].",
      Number::above(0.));
  entries.number(
      "Length ratio", layer.length_ratio,
      "L/h, wavelength (cosine) or length (straight) over thickness; 0: from the "
      "slenderness ratio [-].",
      Number::at_least(0.));
  entries.number(
      "Amplitude ratio", layer.amplitude_ratio,
      "a0/h, height of the crest above the troughs (cosine) over thickness [-].",
      Number::at_least(0.));
  entries.number(
      "Straight end ratio", layer.straight_end_ratio,
      "Length of each straight end over L (cosine); without them the walls decide "
      "where the layer breaks [-].",
      Number::at_least(0.));
  entries.number(
      "Young modulus", layer.young_modulus,
      "E of the rock as a laboratory measures it; grains have theirs from the flat "
      "joint [Pa].",
      moduli());
  entries.number("Poisson ratio", layer.poisson_ratio,
                 "nu of the rock, plane strain [-].", Number::at_least(0.).below(0.5));
  entries.number(
      "UCS", layer.compressive_strength,
      "Uniaxial compressive strength of the rock; the slenderness ratio needs it "
      "[Pa].",
      Number::between(1e4, 1e11));
  entries.number("Grains across", layer.grains_across,
                 "h over the mean grain diameter: the resolution of the scene [-].",
                 Number::at_least(2.));
  entries.number("Radius ratio", layer.radius_ratio,
                 "Largest over smallest grain radius, uniform by number [-].",
                 Number::between(1., 3.));
  entries.number("Installation gap ratio", layer.installation_gap,
                 "Largest gap that is bonded, over the mean grain radius [-].",
                 Number::between(0.1, 1.));
  entries.number("Porosity", layer.porosity,
                 "Of the packing; 0: as dense as the grains jam, about 0.16. Looser, the "
                 "grains are apart and bonded across their gaps [-].",
                 Number::at_least(0.).below(1.));
  entries.number("Coordination number", layer.coordination_number,
                 "Joints a grain, by the installation gap that gives them; 0: the "
                 "installation gap ratio decides [-].",
                 Number::at_least(0.));
  entries.number("Locked-in stress", layer.locked_in_stress,
                 "Isotropic pressure that the bonds keep from the packing of a specimen; "
                 "0: they are free of stress [Pa].",
                 Number::at_least(0.));
  entries.number("Grain density", layer.grain_density,
                 "Of the solid; the rock's is less by the porosity [kg/m^3].",
                 Number::between(100., 3e4));
  entries.whole("Seed", layer.seed,
                "Of the random packing; the same seed gives the same bits [-].",
                Number::at_least(0.));
  entries.flag("Breakable", layer.joint.breakable,
               "May joints break? If not, would-be breaks are counted (not by the "
               "event driver).");
  entries.choice("Bond model", layer.bond_model,
                 "Law that joins the grains: flat joints, as the source; the older "
                 "parallel bonds and contact bonds, which leave round grains behind when "
                 "they break.",
                 "flat joint|parallel bond|contact bond");
  declare(layer.joint, entries);
  declare(layer.types, entries);
  declare(layer.scatter, entries);
  declare(layer.parallel_bond, entries);
  declare(layer.contact_bond, entries);
  entries.leave();
}
} // namespace antiform::cases
