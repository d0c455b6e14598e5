#include "cases/solid_laws.h"

#include "cases/mesh_strips.h"
#include "continuum/elastic_laws.h"
#include "continuum/large_rotation.h"
#include "continuum/maxwell_law.h"
#include "continuum/plastic_laws.h"

#include <cmath>

namespace antiform::cases
{
using namespace continuum;

namespace
{
using Law = std::shared_ptr<const MaterialLaw>;

Law plastic_law(const MaterialParameters &m, const LameConstants &elastic)
{
  const double phi = std::atan(m.tan_friction), psi = std::atan(m.tan_dilation);
  if (m.law == "Mohr-Coulomb")
  {
    MohrCoulombParameters rock{m.cohesion, phi, psi, std::nullopt};
    if (m.tensile_strength > 0.)
      rock.tension_cutoff = m.tensile_strength;
    return std::make_shared<MohrCoulomb>(elastic, rock);
  }
  using Match = DruckerPragerParameters::Match;
  const Match match = m.match == "outer"   ? Match::outer
                      : m.match == "inner" ? Match::inner
                      : psi > 0.           ? Match::plane_strain_associated
                                           : Match::plane_strain_isochoric;
  return std::make_shared<DruckerPrager>(
      elastic, DruckerPragerParameters{m.cohesion, phi, psi, match});
}

Law law_of(const MaterialParameters &m,
           const double young_modulus,
           const double poisson_ratio,
           const bool finite_strain)
{
  const auto elastic = LameConstants::from_young_poisson(young_modulus, poisson_ratio);
  if (m.law == "St Venant-Kirchhoff")
    return std::make_shared<StVenantKirchhoff>(elastic);
  if (m.law == "elastic")
    return finite_strain ? Law(std::make_shared<NeoHookean>(elastic))
                         : Law(std::make_shared<LinearElastic>(elastic));
  const Law law = m.law == "Maxwell"
                      ? Law(std::make_shared<MaxwellBody>(elastic, m.viscosity))
                      : plastic_law(m, elastic);
  return finite_strain ? Law(std::make_shared<LargeRotation>(law)) : law;
}
} // namespace

NonlinearSolid::Laws solid_laws(const Parameters &p)
{
  const bool finite = p.run.strain == "finite";
  NonlinearSolid::Laws laws(2);
  // Without a matrix its id is on no cell.
  if (p.has("matrix"))
    laws[matrix_material_id] =
        law_of(p.matrix_material, p.matrix_modulus(), p.matrix.poisson_ratio, finite);
  laws[layer_material_id] =
      law_of(p.layer_material, p.layer.young_modulus, p.layer.poisson_ratio, finite);
  if (!laws[matrix_material_id])
    laws[matrix_material_id] = laws[layer_material_id];
  return laws;
}
} // namespace antiform::cases
