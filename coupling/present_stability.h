#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/mesh_components.h"
#include "coupling/walled_grains.h"

namespace antiform::coupling
{
/// Number of independent directions in which a body in balance would leave its place with
/// its walls held: negative eigenvalues of the symmetric tangent at present on the
/// displacements that keep supports and constraint, by the inertia of one factor
/// (docs/theory/coupled_buckling.md). Joints as they are turned and damaged, closed
/// parts of broken ones sticking, so that 0 is certain only where nothing slides; the
/// contacts of walls that press. A mesh of finite strain to first order in its stress.
/// \param mesh,domain null: grains alone
/// Throws NumericalError where the tangent is singular to round-off.
int n_unstable_directions(WalledGrains &body,
                          const MeshState *mesh,
                          const BridgingDomain *domain);
} // namespace antiform::coupling
