#include "continuum/finite_strain_law.h"

#include "continuum/elastic_solid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
namespace
{
/// The isotropic part of a plane stiffness: the projection that keeps the resistance to
/// a change of area, (C_xx + C_yy + 2 C_xy) / 4 = lambda + mu, and the mean over all
/// directions of that to shear.
LameConstants isotropic_part(const PlaneStiffness &C)
{
  const double area = 0.25 * (C[0][0] + C[1][1] + 2. * C[0][1]);
  const double shear = 0.125 * (C[0][0] + C[1][1] - 2. * C[0][1] + 4. * C[2][2]);
  return {area - shear, shear};
}

PlaneStiffness rest_of(const ElasticMaterial &material)
{
  const LameConstants isotropic = isotropic_part(material.stiffness);
  const PlaneStiffness part = isotropic.plane_stiffness();
  PlaneStiffness rest = material.stiffness;
  double largest = 0.;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      rest[i][j] -= part[i][j];
      largest = std::max(largest, std::abs(rest[i][j]));
    }
  if (!(isotropic.mu > 0. && isotropic.lambda + isotropic.mu > 0. &&
        largest <= 0.1 * part[0][0]))
    throw std::invalid_argument(
        "material '" + material.name +
        "': its stiffness differs from an isotropic one by " +
        std::to_string(100. * largest / part[0][0]) +
        " %; the law of finite strain is for up to 10 %. Take a larger tile of the "
        "packing, or small strain.");
  // Round-off of an isotropic material is none of its own.
  if (largest < 1e-12 * part[0][0])
    rest = {};
  return rest;
}

PlaneVector stress_of_rest(const PlaneStiffness &rest, const PlaneVector &e)
{
  PlaneVector result{};
  for (int i = 0; i < 3; ++i)
    result[i] = rest[i][0] * e[0] + rest[i][1] * e[1] + rest[i][2] * e[2];
  return result;
}
} // namespace

FiniteStrainLaw::FiniteStrainLaw(const ElasticMaterial &material,
                                 const FiniteElasticity form)
    : form_(form)
    , neo_hookean_(isotropic_part(material.stiffness))
    , semi_linear_(isotropic_part(material.stiffness))
    , rest_(rest_of(material))
{
}

PlaneVector FiniteStrainLaw::stress(const PlaneVector &strain) const
{
  const PointStress S = form_ == FiniteElasticity::semi_linear
                            ? semi_linear_.stress(strain)
                            : neo_hookean_.stress(strain);
  const PlaneVector more = stress_of_rest(rest_, strain);
  return {S.xx + more[0], S.yy + more[1], S.xy + more[2]};
}

double FiniteStrainLaw::energy(const PlaneVector &strain) const
{
  const double isotropic = form_ == FiniteElasticity::semi_linear
                               ? semi_linear_.energy(strain)
                               : neo_hookean_.energy(strain);
  const PlaneVector more = stress_of_rest(rest_, strain);
  return isotropic +
         0.5 * (strain[0] * more[0] + strain[1] * more[1] + strain[2] * more[2]);
}

PlaneStiffness FiniteStrainLaw::tangent(const PlaneVector &strain) const
{
  PointInput input;
  input.strain = strain;
  PlaneStiffness C = form_ == FiniteElasticity::semi_linear
                         ? semi_linear_.respond(input, nullptr, nullptr).tangent
                         : neo_hookean_.respond(input, nullptr, nullptr).tangent;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      C[i][j] += rest_[i][j];
  return C;
}
} // namespace antiform::continuum
