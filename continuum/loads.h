#pragma once

#include "continuum/elastic_solid.h"

#include <functional>
#include <set>

namespace antiform::continuum
{
/// Equivalent nodal forces [N per metre of thickness] of dead loads, as vectors of the
/// solid's dofs with ghosts set. All are collective. Volume terms carry the weight w_C,
/// boundary terms do not (a bridged body is loaded outside of its overlap).
using BoundaryIds = std::set<dealii::types::boundary_id>;
using Traction = std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &place,
                                                    const dealii::Tensor<1, 2> &normal)>;
using StressField =
    std::function<dealii::SymmetricTensor<2, 2>(const dealii::Point<2> &place)>;

/// integral w_C rho a N: weight under an acceleration a, (0, -g) for gravity [m/s^2].
Vector gravity(const ElasticSolid &solid, const dealii::Tensor<1, 2> &acceleration);

/// integral w_C f(x) N of a force per area of the section [N/m^3].
Vector
body_force(const DisplacementSpace &solid,
           const std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> &density);

/// integral t(x, n) N over boundaries [Pa]; the normal points out of the reference body.
Vector boundary_traction(const DisplacementSpace &solid,
                         const BoundaryIds &boundaries,
                         const Traction &traction);

/// Dead normal pressure on the reference faces; positive pushes into the body [Pa].
Vector
pressure(const DisplacementSpace &solid, const BoundaryIds &boundaries, double pressure);

/// - integral w_C B^T S0 of an initial stress (tension positive) [Pa]: the forces with
/// which a prestressed body pulls on its nodes. Together with boundary_traction() of S0 n
/// and without a varying weight a divergence-free S0 is in equilibrium to round-off, as
/// is one that balances gravity() if it is linear in the place (Gauss points integrate
/// it).
Vector prestress(const DisplacementSpace &solid, const StressField &initial_stress);
/// The same for a uniform S0.
Vector prestress(const DisplacementSpace &solid,
                 const dealii::SymmetricTensor<2, 2> &initial_stress);
} // namespace antiform::continuum
