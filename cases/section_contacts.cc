#include "cases/section_contacts.h"

namespace antiform::cases
{
using namespace discrete;

Contacts
make_contacts(const Parameters &p, const GrainSection &section, const ContactsFor what)
{
  // Blocks between fractures may come to lie beside any other grains.
  const bool broken = what == ContactsFor::broken_scene || p.has("fractures");
  Contacts contacts;
  contacts.margin = 0.25 * p.grain_diameter();
  if (broken || has_contact_beside(p.layer.law()))
    contacts.groups.push_back({layer_region, layer_region, p.layer.grain_contact()});
  if (!section.matrix)
    return contacts;

  const double layer_modulus = section.modulus[layer_region];
  const double matrix_modulus = section.modulus[matrix_region];
  const bool frictionless = p.matrix.interface == "frictionless";
  LinearContact contact;
  contact.stiffness_ratio = section.matrix->law.stiffness_ratio;
  if (broken || frictionless)
  {
    contact.effective_modulus = 2. / (1. / layer_modulus + 1. / matrix_modulus); // series
    contact.friction = frictionless ? 0. : p.matrix.residual_friction;
    contacts.groups.push_back({layer_region, matrix_region, contact});
  }
  if (frictionless)
    for (const auto &[i, j] :
         pairs_within(section.state.grains, section.matrix->installation_gap,
                      layer_region, matrix_region))
    {
      const Grains &g = section.state.grains;
      contacts.installed.push_back(
          {i, j, norm(g.reference(j) - g.reference(i)) - g.radius[i] - g.radius[j]});
    }
  if ((p.matrix.breakable || p.has("fractures")) && broken)
  {
    contact.effective_modulus = matrix_modulus;
    contact.friction = p.matrix.residual_friction;
    contacts.groups.push_back({matrix_region, matrix_region, contact});
  }
  return contacts;
}
} // namespace antiform::cases
