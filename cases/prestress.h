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

/// Forces that stand for the installed prestress and do not change.
struct InstalledPrestress
{
  continuum::Vector mesh_force;                 ///< [N]; empty without a mesh
  std::vector<coupling::GrainLoad> grain_loads; ///< one a grain
};

/// Install the prestress instead of loading it, all at zero displacement. Breakable
/// joints and walls carry it as a shift of their stress-free deformation, so that they
/// lose contact where the total stress reaches zero: matrix joints with the forces of the
/// periodic tile, joints of the layer with a normal force that gives the layer the
/// pressure in the mean. What this leaves over on a grain is held by a constant force;
/// those forces are zero in the mean over a few grains. A linear solve for
/// self-equilibrated joint forces was tried instead: along the contact of layer and
/// matrix, where grains meet at random, it put tension of the size of the pressure into
/// the layer's edge and broke it.
///
/// Joints that cannot break and the mesh carry the prestress as forces that do not turn
/// with them: a matrix may be laid down under several times its own modulus, and a
/// hydrostatic stress that turned with the grains would overcome their shear stiffness,
/// which no hydrostatic stress does. \param loads external forces of gravity and surface
/// pressure on the mesh (empty without)
InstalledPrestress install_prestress(Scene &scene, const continuum::Vector &loads);
} // namespace antiform::cases
