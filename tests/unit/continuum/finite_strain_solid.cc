// The body of finite strain that steps in time, against the plain one that the static
// driver assembles, closed forms and its own potential.
#include "continuum/errors.h"
#include "continuum/finite_strain_solid.h"
#include "continuum/loads.h"
#include "support/nonlinear_fixtures.h"
#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace antiform::testing::finite_strain_solid_tests
{
using continuum::ElasticMaterial;
using continuum::FiniteElasticity;
using continuum::FiniteStrainSolid;

namespace
{
constexpr double young = 3., poisson = 0.3;

/// An energy weight that varies within every cell.
double ramp(const Point<2> &p)
{
  return 0.2 + 0.7 * p[0] * p[0] + 0.1 * p[1];
}

FiniteStrainSolid body(const Triangulation &mesh,
                       const unsigned int degree,
                       const ElasticMaterial &material =
                           ElasticMaterial::isotropic(young, poisson, 2., "rock"),
                       const FiniteElasticity form = FiniteElasticity::neo_hookean)
{
  return FiniteStrainSolid(mesh, {material}, degree, ramp, form);
}

/// Neither isotropic nor symmetric about an axis.
ElasticMaterial fabric()
{
  ElasticMaterial material = ElasticMaterial::isotropic(young, poisson, 2., "fabric");
  material.stiffness[0][0] *= 1.04;
  material.stiffness[0][2] = material.stiffness[2][0] = 0.03;
  return material;
}

Vector internal_force(const continuum::ElasticSolid &solid, const Vector &u)
{
  Vector force = solid.make_vector();
  solid.add_internal_force(u, force);
  return force;
}

/// x + u turned by @p angle about the origin, as a displacement.
Vector turned(const continuum::DisplacementSpace &space,
              const Vector &u,
              const double angle,
              const bool is_field = false) // of vectors: not of places
{
  Vector result = space.make_vector();
  const double c = std::cos(angle), s = std::sin(angle);
  for (unsigned int x = 0; x < u.size(); x += 2)
  {
    const Point<2> X = is_field ? Point<2>() : space.support_point(x);
    const double px = X[0] + u(x), py = X[1] + u(x + 1);
    result(x) = c * px - s * py - X[0];
    result(x + 1) = s * px + c * py - X[1];
  }
  result.update_ghost_values();
  return result;
}
} // namespace

TEST(FiniteStrainSolid, ForcesAreThoseOfTheStaticDriversBody)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_distorted_square(mesh, 4);
  const auto rock = ElasticMaterial::isotropic(young, poisson, 2., "rock");
  for (const auto &[degree, form, law] :
       {std::tuple{1u, FiniteElasticity::neo_hookean,
                   make_law<continuum::NeoHookean>(young, poisson)},
        std::tuple{2u, FiniteElasticity::neo_hookean,
                   make_law<continuum::NeoHookean>(young, poisson)},
        std::tuple{1u, FiniteElasticity::semi_linear,
                   make_law<continuum::SemiLinear>(young, poisson)}})
  {
    const FiniteStrainSolid solid = body(mesh, degree, rock, form);
    continuum::NonlinearSolid::Options options;
    options.degree = degree;
    options.weight = ramp;
    continuum::NonlinearSolid plain(mesh, {law}, options);
    const Vector u = wavy_field(solid, 0.15); // gradients of 0.4
    Vector expected = plain.make_vector();
    plain.assemble(u, 0., expected, nullptr);
    Vector difference = internal_force(solid, u);
    difference += expected; // internal forces act on the nodes with the opposite sign
    // Sums of some ten products each.
    EXPECT_LE(difference.linfty_norm(), 1e-13 * expected.linfty_norm()) << degree;
    EXPECT_GT(expected.linfty_norm(), 0.05);
  }
}

TEST(FiniteStrainSolid, ForcesAreTheSlopeOfTheEnergy)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_distorted_square(mesh, 3);
  for (const auto &[degree, form] : {std::pair{1u, FiniteElasticity::neo_hookean},
                                     std::pair{2u, FiniteElasticity::semi_linear}})
  {
    const FiniteStrainSolid solid = body(mesh, degree, fabric(), form);
    const Vector u = wavy_field(solid, 0.1);
    const Vector way = interpolate(solid, [](const Point<2> &p, const unsigned int c)
                                   { return std::cos(3. * p[c] + p[1 - c]); });
    const double power = -(internal_force(solid, u) * way);
    const double h = 1e-4;
    const auto energy = [&](const double share)
    {
      Vector at = u;
      at.add(share * h, way);
      at.update_ghost_values();
      return solid.strain_energy(at);
    };
    // Fourth order in h: 1e-16; round-off of the energy (0.02) over h: 1e-13.
    const double slope =
        (8. * (energy(1.) - energy(-1.)) - energy(2.) + energy(-2.)) / (12. * h);
    EXPECT_NEAR(slope, power, 1e-10 * std::abs(power)) << degree;
  }
}

TEST(FiniteStrainSolid, IsTheLinearBodyAtSmallStrain)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_distorted_square(mesh, 3);
  const ElasticMaterial material = fabric();
  const FiniteStrainSolid solid = body(mesh, 1, material);
  const continuum::ElasticSolid linear(mesh, {material}, 1, ramp);
  double before = 0.;
  for (const double size : {1e-3, 1e-4})
  {
    const Vector u = wavy_field(solid, size);
    Vector difference = internal_force(solid, u);
    difference -= internal_force(linear, u);
    const double error =
        difference.linfty_norm() / internal_force(linear, u).linfty_norm();
    // The rest is of first order in the gradients, 3 times the size.
    EXPECT_LE(error, 20. * size);
    if (before > 0.)
    {
      EXPECT_NEAR(before / error, 10., 0.5);
    }
    before = error;
    EXPECT_NEAR(solid.strain_energy(u) / linear.strain_energy(u), 1., 20. * size);
  }
}

TEST(FiniteStrainSolid, TurnsWithItsForcesAndStates)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_distorted_square(mesh, 3);
  const FiniteStrainSolid solid = body(mesh, 1, fabric(), FiniteElasticity::semi_linear);
  const Vector u = wavy_field(solid, 0.1);
  const Vector force = internal_force(solid, u);
  const auto states = solid.cell_states(u);
  for (const double degrees : {30., 90., -170.})
  {
    const double angle = degrees * M_PI / 180.;
    const Vector v = turned(solid, u, angle);
    Vector difference = internal_force(solid, v);
    difference -= turned(solid, force, angle, true);
    // Round-off of gradients of 2 in strains of 0.2.
    EXPECT_LE(difference.linfty_norm(), 1e-13 * young);
    EXPECT_NEAR(solid.strain_energy(v) / solid.strain_energy(u), 1., 1e-13);
    const auto now = solid.cell_states(v);
    for (std::size_t k = 0; k < states.size(); ++k)
    {
      EXPECT_NEAR(std::remainder(now[k].rotation - states[k].rotation - angle, 2. * M_PI),
                  0., 1e-13);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(now[k].strain[c], states[k].strain[c], 1e-14);
      EXPECT_NEAR(now[k].stress[0] + now[k].stress[1],
                  states[k].stress[0] + states[k].stress[1], 1e-13 * young);
    }
    Vector sums = solid.absolute_row_sums(v);
    sums -= solid.absolute_row_sums(u);
    EXPECT_LE(sums.linfty_norm(), 1e-12 * young);
  }
}

TEST(FiniteStrainSolid, CellsTellCauchysStressOfASimpleStretch)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_rectangle(mesh, 1., 1., 2, 2);
  const FiniteStrainSolid solid = body(mesh, 1);
  const double stretch = 0.8;
  const Vector u = interpolate(solid, [=](const Point<2> &p, const unsigned int c)
                               { return c == 0 ? (stretch - 1.) * p[0] : 0.; });
  const double mu = young / (2. * (1. + poisson)),
               lambda = 2. * mu * poisson / (1. - 2. * poisson);
  // sigma = (mu (B - 1) + lambda ln J) / J with B = diag(stretch^2, 1), J = stretch.
  const double xx =
      (mu * (stretch * stretch - 1.) + lambda * std::log(stretch)) / stretch;
  const double yy = lambda * std::log(stretch) / stretch;
  for (const auto &cell : solid.cell_states(u))
  {
    EXPECT_NEAR(cell.stress[0], xx, 1e-14 * young);
    EXPECT_NEAR(cell.stress[1], yy, 1e-14 * young);
    EXPECT_NEAR(cell.stress[2], 0., 1e-14 * young);
    EXPECT_NEAR(cell.rotation, 0., 1e-15);
  }
}

TEST(FiniteStrainSolid, StableStepBoundsTheTrueOneOfTheTangent)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_distorted_square(mesh, 4);
  for (const unsigned int degree : {1u, 2u})
  {
    const FiniteStrainSolid solid = body(mesh, degree);
    continuum::NonlinearSolid::Options options;
    options.degree = degree;
    options.weight = ramp;
    continuum::NonlinearSolid plain(
        mesh, {make_law<continuum::NeoHookean>(young, poisson)}, options);
    Vector inverse_mass = solid.make_vector();
    for (unsigned int dof = 0; dof < inverse_mass.size(); ++dof)
      inverse_mass(dof) = 1. / solid.lumped_mass()(dof);
    for (const double size : {0., 0.05, 0.15})
    {
      const Vector u = wavy_field(solid, size);
      Vector force = plain.make_vector();
      Matrix tangent = plain.make_matrix();
      plain.assemble(u, 0., force, &tangent);
      for (unsigned int row = 0; row < tangent.m(); ++row)
        for (auto entry = tangent.begin(row); entry != tangent.end(row); ++entry)
          entry->value() *= std::sqrt(inverse_mass(row) * inverse_mass(entry->column()));
      const double largest = eigenvalues(plain, tangent, {}).back();
      const double ratio = 2. / std::sqrt(largest) / solid.stable_step(u, inverse_mass);
      std::printf("  degree %u, gradients of %.2f: true step %.3f of the bound\n", degree,
                  3. * size, ratio);
      EXPECT_GE(ratio, 1.);
      EXPECT_LE(ratio, 2.); // circles of Gershgorin: 1.2 (Q1), 1.7 (Q2)
      if (size == 0.)
      {
        EXPECT_DOUBLE_EQ(solid.stable_step(inverse_mass),
                         solid.stable_step(u, inverse_mass));
      }
    }
  }
}

TEST(FiniteStrainSolid, RefusesWhatItCannotBe)
{
  Triangulation mesh(MPI_COMM_SELF);
  make_rectangle(mesh, 1., 1., 2, 2);
  const FiniteStrainSolid solid = body(mesh, 1);
  const auto squeezed = [&](const double stretch)
  {
    return interpolate(solid, [=](const Point<2> &p, const unsigned int c)
                       { return c == 0 ? (stretch - 1.) * p[0] : 0.; });
  };
  EXPECT_NO_THROW(internal_force(solid, squeezed(0.01)));
  for (const double stretch : {0., -0.5, std::nan("")})
  {
    EXPECT_THROW(internal_force(solid, squeezed(stretch)), NumericalError) << stretch;
    EXPECT_THROW(solid.absolute_row_sums(squeezed(stretch)), NumericalError) << stretch;
  }
  try
  {
    internal_force(solid, squeezed(-0.5));
  }
  catch (const NumericalError &error)
  {
    EXPECT_NEAR(error.value, -0.5, 1e-14);
    EXPECT_NE(std::string(error.what()).find("Run / End shortening"), std::string::npos);
  }
  ElasticMaterial schist = ElasticMaterial::isotropic(young, poisson, 2., "schist");
  schist.stiffness[0][0] *= 2.;
  EXPECT_THROW(body(mesh, 1, schist), std::invalid_argument);
}
} // namespace antiform::testing::finite_strain_solid_tests
