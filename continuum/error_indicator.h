#pragma once

#include "continuum/elastic_solid.h"
#include "continuum/linear_buckling.h"
#include "continuum/loads.h"
#include "continuum/static_solver.h"

#include <functional>
#include <vector>

namespace antiform::continuum
{
/// What holds and loads a body, as far as it is not in its stiffness; absent parts are
/// empty or 0.
struct Surroundings
{
  DirichletValues displacements;     ///< prescribed; only of which dofs counts here
  dealii::Tensor<1, 2> acceleration; ///< of the weight, as in gravity() [m/s^2]
  /// Further force by place [N/m^3].
  std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> body_force;
  /// On a boundary by place and outward normal [Pa]; empty: none anywhere.
  std::function<dealii::Tensor<1, 2>(
      dealii::types::boundary_id, const dealii::Point<2> &, const dealii::Tensor<1, 2> &)>
      traction;
  BoundaryIds sprung;           ///< boundaries on a winkler_foundation() ...
  double spring_stiffness = 0.; ///< ... of so much [Pa/m]
  bool slides = false; ///< inner faces that lie on one another do: sliding_interfaces()
};

/// Squared error indicators of a solution [J/m], one for each active cell that this rank
/// owns, in cell order: by how far the stresses fail to be in equilibrium (Babuska &
/// Rheinboldt 1978; Verfuerth 2013). Of a cell of area A and degree p
///   eta^2 = b^2 / (p^2 c) |div sigma + f|^2 + sum over faces h / (p C) |jump|^2
/// in L2 of the cell and of the face: b is the cell's least height, h the mean height
/// across the face of the cells beside it, c the least stiffness of the material (2 mu)
/// and C the sum of those on both sides, so that contrasts do not spoil it (Petzoldt
/// 2002). The jump is that of tractions inside; at the boundary what they differ from
/// the load by, in the components that are not prescribed; where parts slide, the whole
/// shear of either side and the jump across. The sum of all is the squared error in the
/// norm of the energy (twice the strain energy of the error) times a factor that depends
/// on the shapes of cells, some 10 to 17 for squares; where long cells make up a slender
/// layer it is less, so it is no bound. The weight w_C of a bridging domain must be 1.
/// \param displacement ghosts set. Collective.
std::vector<double> error_indicators(const ElasticSolid &solid,
                                     const Vector &displacement,
                                     const Surroundings &surroundings);

/// The same of a buckling mode, whose stress is sigma(phi) + factor grad phi S with S
/// that of the @p straight section, over phi.K phi [-]: the sum of all is the relative
/// error of the load factor, times such a factor. It does not see errors of S itself. Of
/// the surroundings what prescribes, springs and slides counts; loads are S's.
std::vector<double> error_indicators(const ElasticSolid &solid,
                                     const Vector &straight,
                                     const BucklingMode &mode,
                                     const Surroundings &surroundings);
} // namespace antiform::continuum
