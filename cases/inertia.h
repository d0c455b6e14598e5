#pragma once

#include "discrete/joints.h"

#include <vector>

namespace antiform::cases
{
struct Parameters;
struct Scene;

/// By what damping shortens the stable step [-]. Each dof is pulled by r + d with
/// |d| <= alpha |r|: as if it were stiffer by at most 1 + alpha. It is where it vibrates
/// from step to step, at the bound.
double damping_factor(const Parameters &parameters);

/// Sums of contact stiffness on each grain, walls and contacts included, without the
/// bridging weights: for density scaling.
discrete::StiffnessSums grain_stiffness(const Scene &scene);

/// Set the inertial masses of grains and mesh, scaled where the driver is quasi-static.
/// \param foundation_rows absolute row sums of the foundation [N/m], or empty
/// \return the step that they allow, the deck's safety factor included [s]
double choose_step(Scene &scene, const std::vector<double> &foundation_rows);

/// Rigorous stable step of the mesh alone with the inertial masses that it has [s].
double mesh_stable_step(Scene &scene);

/// What follows a search for contacts: walls hold the grains that have come near them,
/// and the inertial masses of a quasi-static run follow the contacts that grains carry
/// now, so that none is too light for the step (discrete::rescale_density()); the
/// bridging domain knows of it. Throws NumericalError when the step is no longer below
/// the rigorous bound. \return kinetic energy lost [J]
double after_search(Scene &scene);

/// Time of an axial wave along the layer with its inertial masses [s].
double layer_transit(const Scene &scene);
} // namespace antiform::cases
