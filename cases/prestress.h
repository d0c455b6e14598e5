#pragma once

#include "cases/scene.h"

namespace antiform::cases
{
/// Isotropic stress under which the section was laid down: -P(y), with
/// P(y) = p + rho g (y_surface - y), rho the bulk density of the matrix.
struct Prestress
{
  double surface_pressure = 0.; ///< p [Pa]
  double unit_weight = 0.;      ///< rho g [N/m^3]
  double surface = 0.;          ///< y_surface [m]

  double pressure(const double y) const
  {
    return surface_pressure + unit_weight * (surface - y);
  }
};

/// The prestress that the deck's surface pressure and gravity call for.
Prestress prestress_of(const Scene &scene);

/// Forces on mesh dofs that the installed prestress stands for.
struct InstalledPrestress
{
  continuum::Vector mesh_force;         ///< -integral w_C B^T S, S as installed [N]
  std::vector<double> grain_base_force; ///< upward, per base grain [N]
};

/// Install the prestress instead of loading it: joints and walls carry its forces as a
/// shift of their stress-free deformation, the mesh as an initial stress, all at zero
/// displacement. Matrix joints take those of the periodic tile; what the cuts leave out
/// of balance is removed by one linear static solve that shifts deformations further.
/// Throws NumericalError when more than 1e-6 of the pressure's force on a grain stays out
/// of balance. \param loads external forces of gravity and surface pressure on the mesh
/// (empty without)
InstalledPrestress install_prestress(Scene &scene, const continuum::Vector &loads);
} // namespace antiform::cases
