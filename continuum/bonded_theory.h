#pragma once

#include "continuum/layer_theory.h"

/// A matrix that sticks to the layer: it resists the layer's wave along the contact too.
/// Signs as in layer_theory.h; derivation: docs/theory/continuum.md, section 6.
namespace antiform::continuum::theory
{
/// What a matrix layer answers to its loaded face, which moves into it by V cos kx and
/// along it by U sin kx: a pressure p cos kx and a shear q sin kx (-sigma_yy, -sigma_xy),
/// (p, q) = [normal, coupling; coupling, shear] (V, U). Positive definite where there is
/// a matrix.
struct FaceStiffness
{
  double normal;   ///< K_yy [Pa/m]; the whole K of a layer that cannot be stretched
  double coupling; ///< K_yx [Pa/m]
  double shear;    ///< K_xx [Pa/m]
};

/// The answer of @p side to a wave k [1/m], for all of its far faces; of nothing where E0
/// is 0. Exact for any k H > 0, without cancellation and without overflow.
FaceStiffness bonded_stiffness(const Side &side, double wavenumber);

/// K(k) of the sides of a layer that they stick to [Pa/m]: the layer's faces move along
/// by u0 + k h W / 2 and u0 - k h W / 2, and its axis follows by the u0 of least energy
/// (E' h k^2 against the sides). \param sides above and below, in any order
double bonded_support_stiffness(const Layer &layer,
                                const std::vector<Side> &sides,
                                double wavenumber);
} // namespace antiform::continuum::theory
