#include "cases/section_contacts.h"

#include <algorithm>

namespace antiform::cases
{
using namespace discrete;

namespace
{
/// Of two springs, as one between the middles [Pa].
double in_series(const double one, const double other)
{
  return 2. / (1. / one + 1. / other);
}

void add_contacts_of_beds(const Parameters &p, Contacts &contacts)
{
  for (int one = 0; one < p.n_beds(); ++one)
    for (int other = one; other < p.n_beds(); ++other)
    {
      LinearContact law = p.bed(one).grain_contact();
      if (other != one)
      {
        const LinearContact &second = p.bed(other).grain_contact();
        law.effective_modulus = in_series(law.effective_modulus, second.effective_modulus);
        law.stiffness_ratio = 0.5 * (law.stiffness_ratio + second.stiffness_ratio);
        law.friction = p.beds.interface == "frictional"
                           ? p.beds.friction
                           : std::min(law.friction, second.friction);
      }
      contacts.groups.push_back({bed_region(one), bed_region(other), law});
    }
}
} // namespace

Contacts
make_contacts(const Parameters &p, const GrainSection &section, const ContactsFor what)
{
  // Blocks between fractures may come to lie beside any other grains.
  const bool broken = what == ContactsFor::broken_scene || p.has_smooth_joints();
  Contacts contacts;
  contacts.margin = 0.25 * p.grain_diameter();
  if (broken || has_contact_beside(p.layer.law()))
    add_contacts_of_beds(p, contacts);
  if (!section.matrix)
    return contacts;

  const double matrix_modulus = section.modulus[matrix_region];
  const bool frictionless = p.matrix.interface == "frictionless";
  LinearContact contact;
  contact.stiffness_ratio = section.matrix->law.stiffness_ratio;
  if (broken || frictionless)
  {
    contact.friction = frictionless ? 0. : p.matrix.residual_friction;
    for (int bed = 0; bed < p.n_beds(); ++bed)
    {
      contact.effective_modulus =
          in_series(section.modulus[bed_region(bed)], matrix_modulus);
      contacts.groups.push_back({bed_region(bed), matrix_region, contact});
    }
  }
  if (frictionless)
    for (const auto &[i, j] :
         pairs_with_matrix(section.state.grains, section.matrix->installation_gap, p))
    {
      const Grains &g = section.state.grains;
      contacts.installed.push_back(
          {i, j, norm(g.reference(j) - g.reference(i)) - g.radius[i] - g.radius[j]});
    }
  if ((p.matrix.breakable || p.has_smooth_joints()) && broken)
  {
    contact.effective_modulus = matrix_modulus;
    contact.friction = p.matrix.residual_friction;
    contacts.groups.push_back({matrix_region, matrix_region, contact});
  }
  return contacts;
}
} // namespace antiform::cases
