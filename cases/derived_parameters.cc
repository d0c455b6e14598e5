// What follows from the parameters of a scene.
#include "cases/declarations.h"
#include "cases/parameters.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
// The deck gives degrees; a tangent that no angle rounds to could not be written back.
LayerParameters::LayerParameters()
{
  joint.tan_friction = tangent_of_degrees(8.);
}

discrete::JointLaw LayerParameters::law() const
{
  if (bond_model == "parallel bond")
  {
    discrete::ParallelBond bond = parallel_bond;
    bond.breakable = joint.breakable;
    return bond;
  }
  if (bond_model == "contact bond")
  {
    discrete::ContactBond bond = contact_bond;
    bond.breakable = joint.breakable;
    return bond;
  }
  return joint;
}

discrete::LinearContact LayerParameters::grain_contact() const
{
  discrete::LinearContact contact;
  contact.effective_modulus = joint.effective_modulus;
  contact.stiffness_ratio = joint.stiffness_ratio;
  contact.friction = joint.residual_friction;
  if (bond_model == "parallel bond")
  {
    contact.effective_modulus = parallel_bond.contact_modulus;
    contact.stiffness_ratio = parallel_bond.contact_stiffness_ratio;
    contact.friction = parallel_bond.residual_friction;
  }
  else if (bond_model == "contact bond")
  {
    contact.effective_modulus = contact_bond.effective_modulus;
    contact.stiffness_ratio = contact_bond.stiffness_ratio;
    contact.friction = contact_bond.residual_friction;
  }
  return contact;
}

bool Parameters::has(const std::string &component) const
{
  return std::find(components.begin(), components.end(), component) != components.end();
}

double Parameters::bed_share(const int k) const
{
  if (!has("beds"))
    return 1.;
  double sum = 0.;
  for (const double ratio : beds.thickness_ratios)
    sum += ratio;
  return beds.thickness_ratios.at(static_cast<std::size_t>(k)) / sum;
}

namespace
{
/// Mean of @p quantity over the thickness of the beds.
double mean_of_beds(const Parameters &p, double (*quantity)(const LayerParameters &))
{
  if (!p.has("beds"))
    return quantity(p.layer);
  double sum = 0.;
  for (int k = 0; k < p.n_beds(); ++k)
    sum += p.bed_share(k) * quantity(p.bed(k));
  return sum;
}
} // namespace

double Parameters::young_modulus() const
{
  return mean_of_beds(*this,
                      [](const LayerParameters &rock) { return rock.young_modulus; });
}

double Parameters::plane_modulus() const
{
  return mean_of_beds(
      *this, [](const LayerParameters &rock)
      { return rock.young_modulus / (1. - rock.poisson_ratio * rock.poisson_ratio); });
}

bool Parameters::has_smooth_joints() const
{
  return has("fractures") || (has("beds") && beds.interface == "frictional");
}

bool Parameters::has_unbonded_joints() const
{
  if (!has("layer") || layer.representation != "grains" ||
      layer.bond_model != "flat joint")
    return false;
  for (int k = 0; k < n_beds(); ++k)
    if (bed(k).types.slit_fraction + bed(k).types.gapped_fraction > 0.)
      return true;
  return false;
}

bool Parameters::has_contacts_from_start() const
{
  return has("layer") && layer.representation == "grains" &&
         (discrete::has_contact_beside(layer.law()) || has_smooth_joints() ||
          (has("matrix") && !has_surface_interface() &&
           matrix.interface == "frictionless"));
}

const ConfinementParameters *Parameters::confinement() const
{
  if (has("servo walls"))
    return &servo_walls;
  return has("membrane") ? &membrane : nullptr;
}

bool Parameters::is_bare_grains() const
{
  return has("layer") && !has("matrix") && layer.representation == "grains";
}

bool Parameters::is_specimen() const
{
  return is_bare_grains() && layer.shape == "straight";
}

MaterialParameters::MaterialParameters()
    : tan_friction(tangent_of_degrees(42.))
{
}

bool Parameters::has_mesh_contact() const
{
  return has_layer_mesh() && has_matrix_mesh() && matrix.interface != "cemented";
}

bool Parameters::is_nonlinear() const
{
  return run.driver == "static" &&
         (run.strain == "finite" || run.path == "arc length" || has_mesh_contact() ||
          (has("foundation") && foundation.lifts_off) ||
          (has_layer_mesh() && layer_material.law != "elastic") ||
          (has_matrix_mesh() && matrix_material.law != "elastic"));
}

bool Parameters::joins_grains_and_mesh() const
{
  return has("layer") && has("matrix") && layer.representation == "grains" &&
         matrix.representation == "continuum";
}

bool Parameters::is_bridged() const
{
  return joins_grains_and_mesh() && matrix.join != "surface interface";
}

bool Parameters::has_grain_cover() const
{
  return joins_grains_and_mesh() && matrix.join == "grain cover";
}

bool Parameters::has_surface_interface() const
{
  return joins_grains_and_mesh() && matrix.join == "surface interface";
}

bool Parameters::is_bare_mesh() const
{
  return has("layer") && !has("matrix") && layer.representation == "continuum";
}

double Parameters::layer_length() const
{
  if (layer.length_ratio > 0.)
    return layer.length_ratio * layer.thickness;
  // Slenderness sqrt(12) L/h = Lambda lambda_c, lambda_c = pi sqrt(E/UCS).
  const double critical =
      M_PI * std::sqrt(layer.young_modulus / layer.compressive_strength);
  return layer.slenderness_ratio * critical * layer.thickness / std::sqrt(12.);
}

double Parameters::section_length() const
{
  const double ends = layer.shape == "cosine" ? 2. * layer.straight_end_ratio : 0.;
  return layer_length() * (1. + ends);
}

double Parameters::end_bending() const
{
  return M_PI / 180. * walls.end_rotation * strain_per_radian();
}

double Parameters::grain_diameter() const
{
  return layer.thickness / layer.grains_across;
}

double Parameters::matrix_modulus() const
{
  return young_modulus() / matrix.stiffness_contrast;
}

bool Parameters::has_foundation_under(const std::string &face) const
{
  return has("foundation") && foundation.faces.find(face) != std::string::npos;
}

bool Parameters::is_absorbing(const std::string &face) const
{
  return has("absorbing boundary") &&
         absorbing_boundary.faces.find(face) != std::string::npos;
}

double Parameters::foundation_stiffness() const
{
  return foundation.stiffness > 0.
             ? foundation.stiffness
             : foundation.stiffness_ratio * matrix_modulus() / layer.thickness;
}

double Parameters::foundation_shear() const
{
  return foundation.shear_ratio * foundation_stiffness() * layer.thickness *
         layer.thickness;
}

namespace
{
// Bulk over grain density: the solid fraction of a packing.
constexpr double solid_fraction = 0.84;
} // namespace

double Parameters::layer_density() const
{
  return solid_fraction * layer.grain_density;
}

double Parameters::matrix_density() const
{
  return solid_fraction * matrix.grain_density;
}

double Parameters::pressure_on_top() const
{
  if (!has("surface pressure"))
    return 0.;
  const double density = has("matrix") ? matrix_density() : layer_density();
  return surface_pressure.pressure +
         (has("gravity") ? surface_pressure.overburden_ratio * layer.thickness * density *
                               gravity.acceleration
                         : 0.);
}
} // namespace antiform::cases
