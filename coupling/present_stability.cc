#include "coupling/present_stability.h"

#include "continuum/finite_strain_solid.h"
#include "coupling/coupled_buckling.h"

namespace antiform::coupling
{
int n_unstable_directions(WalledGrains &body,
                          const MeshState *const mesh,
                          const BridgingDomain *const domain)
{
  const GrainState &state = body.state();
  StaticSystem system(state.grains, state.joints,
                      mesh != nullptr ? &mesh->solid : nullptr, domain);
  for (std::size_t i = 0; i < state.grains.size(); ++i)
    for (const unsigned int c : {0u, 1u, 2u})
      if (body.is_prescribed(static_cast<Eigen::Index>(3 * i + c)))
        system.fix_grain(i, c, 0.);
  for (const BearingWall &bearing : body.walls())
    for (const discrete::WallContact &contact : bearing.wall->contacts)
      if (const Vec2 &n = bearing.wall->normal;
          wall_gap(*bearing.wall, contact, state.grains) < 0.)
        system.add_spring({{{contact.grain, 0, n.x}, {contact.grain, 1, n.y}}, {}},
                          contact.weight * contact.stiffness);
  const continuum::Vector *turned = nullptr;
  if (mesh != nullptr)
  {
    for (const PrescribedDof &entry : mesh->prescribed)
      system.fix_mesh(entry.dof, 0.);
    if (dynamic_cast<const continuum::FiniteStrainSolid *>(&mesh->solid) != nullptr)
      turned = &mesh->displacement;
  }
  // Loose fragments would make the tangent singular.
  constexpr double kept_share = 1e-3;
  return n_unstable_directions(
      system,
      present_geometric_stiffness(system, turned, StrainMeasure::biot, kept_share));
}
} // namespace antiform::coupling
