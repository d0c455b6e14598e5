// Density scaling changes inertia only: equilibrium stays, and the bound on the step with
// the scaled masses holds.
#include "support/column_fixture.h"
#include "support/coupling_loop.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::density_scaling_tests
{
namespace
{
/// Largest step at which no grain is made heavier.
double softest_step(const Bridged &model)
{
  const auto sums =
      discrete::stiffness_sums(model.state.grains, model.state.joints, false);
  double step = 0.;
  for (std::size_t i = 0; i < sums.translation.size(); ++i)
    step = std::max(step, std::sqrt(model.state.grains.mass[i] / sums.translation[i]));
  return step;
}

continuum::Vector end_traction(const Column &column, const double force)
{
  continuum::Vector load = column.model.solid->make_vector();
  for (const unsigned int dof : column.end_dofs)
    load(dof) = force / static_cast<double>(column.end_dofs.size());
  return load;
}

/// Displacements of the column under a force on its end, relaxed with masses scaled at
/// @p ratio times the softest step.
std::vector<double> relaxed(const double ratio, std::int64_t &steps)
{
  Column column;
  const double dt0 = ratio * softest_step(column.model);
  column.support(dt0, true);
  Loop::Options options;
  options.damping = 0.7;
  Loop run(column.model, 0.8 * column.model.stable_step(), options);
  run.add(std::make_unique<MeshLoads>(*column.model.mesh, end_traction(column, 1e-8)),
          {Stage::forces}, 60, "traction");
  run.probe(100, [](const Clock &) {});
  run.advance(1); // at first no joint carries anything, which gives no ratio
  do
    run.advance(100);
  while (run.unbalanced_ratio() > 1e-13 && run.simulation.clock().step < 200000);
  steps = run.simulation.clock().step;
  EXPECT_LE(run.unbalanced_ratio(), 1e-13); // softest mode: 1e3 times the joints' error
  std::vector<double> values = column.model.state.grains.displacement_x;
  const continuum::Vector &u = column.model.mesh->displacement;
  values.insert(values.end(), u.begin(), u.end());
  return values;
}

double difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double worst = 0., size = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return worst / size;
}
} // namespace

TEST(DensityScaling, LeavesTheEquilibrium)
{
  Column column;
  StaticSystem system = column.static_system(true, 0.);
  const continuum::Vector load = end_traction(column, 1e-8);
  for (unsigned int dof = 0; dof < column.model.n_mesh_dofs(); ++dof)
    if (load(dof) != 0.)
      system.add_mesh_force(dof, load(dof));
  const StaticSolution solution = system.solve();
  std::vector<double> exact = solution.ux;
  exact.insert(exact.end(), solution.mesh.begin(), solution.mesh.end());

  std::int64_t steps = 0;
  const std::vector<double> reference = relaxed(0.1, steps);
  EXPECT_LE(difference(reference, exact), 1e-8);
  for (const double ratio : {1., 10.})
  {
    const double d = difference(relaxed(ratio, steps), reference);
    std::printf("  dt0 = %g of the softest step: %.1e after %ld steps\n", ratio, d,
                static_cast<long>(steps));
    EXPECT_LE(d, 1e-8);
  }
}

TEST(DensityScaling, StaysBoundedBelowTheLimit)
{
  for (const double ratio : {1., 3., 10.})
  {
    Column column;
    Bridged &model = column.model;
    column.support(ratio * softest_step(model), true);
    const double step = model.stable_step();
    // Scaled masses allow about the step that they are made for.
    EXPECT_GE(step, 0.8 * ratio * softest_step(model));
    white_noise(model, 1e-9, 4);
    Loop run(model, 0.99 * step, {});
    double first = 0., last = 0.;
    run.probe(100,
              [&](const Clock &)
              {
                const Energies e = run.simulation.energies();
                last = e.kinetic + e.strain_grains + e.strain_continuum;
                if (first == 0.)
                  first = last;
              });
    run.advance(10001);
    EXPECT_NEAR(last / first, 1., 1e-6);
    EXPECT_GE(2. / largest_frequency(model, true), (1. - 1e-3) * step);
  }
}
} // namespace antiform::coupling::test::density_scaling_tests
