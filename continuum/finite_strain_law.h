#pragma once

#include "continuum/elastic_laws.h"
#include "continuum/semi_linear_law.h"

#include <array>

namespace antiform::continuum
{
struct ElasticMaterial;

/// Plane stiffness in Voigt order [Pa].
using PlaneStiffness = std::array<PlaneVector, 3>;

/// How the isotropic part of a material goes on from its stiffness at rest.
enum class FiniteElasticity
{
  neo_hookean, ///< resists without bound as J -> 0
  semi_linear  ///< as bonded grains do: what belongs beside them
};

/// Elastic law of finite strain with any stiffness at rest, in total Lagrangian form: its
/// isotropic part is that of a neo-Hookean or semi-linear solid, 1/2 E : R : E the rest R
/// of it, which turns with the material. S and energy derive from one potential.
class FiniteStrainLaw
{
public:
  /// \param material its stiffness is that at rest
  /// Throws std::invalid_argument where R is more than a tenth of the isotropic part: it
  /// would soften under compression as St Venant and Kirchhoff's solid does.
  FiniteStrainLaw(const ElasticMaterial &material, FiniteElasticity form);

  /// S [Pa], energy [J/m^3] and dS/dE [Pa] at a Green-Lagrange strain.
  PlaneVector stress(const PlaneVector &strain) const;
  double energy(const PlaneVector &strain) const;
  PlaneStiffness tangent(const PlaneVector &strain) const;

private:
  FiniteElasticity form_;
  NeoHookean neo_hookean_;
  SemiLinear semi_linear_;
  PlaneStiffness rest_; ///< R [Pa]
};
} // namespace antiform::continuum
