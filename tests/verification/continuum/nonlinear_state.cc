// What points of a body of laws start with and remember.
#include "continuum/errors.h"
#include "continuum/newton_solver.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

namespace nonlinear_state_tests
{
using namespace antiform;
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
/// Hooke's law that writes down what it is given: its strain xx and how many steps were
/// accepted before. Beyond a strain it has no answer.
class DiaryLaw : public LinearElastic
{
public:
  static constexpr double largest_strain = 0.1;

  DiaryLaw()
      : LinearElastic(LameConstants::from_young_poisson(1., 0.2))
  {
  }
  unsigned int n_history() const override { return 2; }
  PointResponse
  respond(const PointInput &input, const double *begin, double *end) const override
  {
    if (input.strain[0] > largest_strain)
      throw NumericalError("diary", "too much strain", input.strain[0], largest_strain);
    end[0] = input.strain[0];
    end[1] = begin[1] + 1.;
    return LinearElastic::respond(input, begin, end);
  }
};

/// Loads that stretch a square along x by the load factor, the more the higher.
Loads stretching(const NonlinearSolid &solid)
{
  Loads loads;
  loads.displacements =
      prescribe_all_sides(solid, [](const Point<2> &p, const unsigned int c)
                          { return c == 0 ? p[0] * (1. + p[1] * p[1]) : 0.; });
  return loads;
}
} // namespace

TEST(NonlinearState, PointsRememberAcceptedStepsAlone)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_distorted_square(triangulation, 4);
  // The diary is kept in the upper half: the history of other cells is empty.
  for (const auto &cell : triangulation.active_cell_iterators())
    if (!cell->is_artificial())
      cell->set_material_id(cell->center()[1] > 0.5 ? 1 : 0);
  NonlinearSolid solid(triangulation,
                       {make_law<LinearElastic>(1., 0.2), std::make_shared<DiaryLaw>()},
                       NonlinearSolid::Options());
  LoadedSolid body(solid, {}, stretching(solid));
  NewtonSolver newton(body, NewtonSolver::Options());
  auto u = solid.make_vector();
  newton.advance(0., 0.03, 3, u);

  const auto expect_diary = [&](const double n_steps)
  {
    std::size_t entry = 0;
    for (const auto &state : solid.point_states(u))
      if (state.material == 1)
      {
        EXPECT_EQ(solid.history()[entry++], state.strain[0]);
        EXPECT_EQ(solid.history()[entry++], n_steps);
      }
    EXPECT_EQ(entry, solid.history().size());
    EXPECT_GT(dealii::Utilities::MPI::sum(entry, MPI_COMM_WORLD), 0u);
  };
  expect_diary(3.);

  // Steps get as far as the law has an answer; those that failed leave no trace.
  EXPECT_THROW(newton.advance(0.03, 0.5, 1, u), NumericalError);
  expect_diary(static_cast<double>(newton.steps().size()));
  EXPECT_GT(newton.steps().size(), 3u);
  EXPECT_LT(newton.steps().back().factor, DiaryLaw::largest_strain);
}

TEST(NonlinearState, LithostaticStressIsInEquilibrium)
{
  const double height = 100., weight = 2500. * 9.81, ratio = 0.4;
  struct Body
  {
    const char *name;
    Law law;
    unsigned int degree;
    StrainForm form;
  };
  const Law hooke = make_law<LinearElastic>(20e9, 0.3),
            neo_hookean = make_law<NeoHookean>(20e9, 0.3);
  for (const Body &body :
       {Body{"Q1", hooke, 1, StrainForm::displacement},
        Body{"mean dilatation", hooke, 1, StrainForm::mean_dilatation},
        Body{"Q2", hooke, 2, StrainForm::displacement},
        Body{"finite strain", neo_hookean, 2, StrainForm::displacement}})
  {
    SCOPED_TRACE(body.name);
    Triangulation triangulation(MPI_COMM_WORLD);
    make_rectangle(triangulation, 50., height, 4, 5);
    NonlinearSolid::Options options;
    options.degree = body.degree;
    options.strain_form = body.form;
    options.initial_stress = [=](const Point<2> &p)
    {
      const double vertical = -weight * (0.5 * height - p[1]);
      return PointStress{ratio * vertical, vertical, ratio * vertical, 0.};
    };
    NonlinearSolid solid(triangulation, {body.law}, options);
    const auto zero = [](const Point<2> &) { return 0.; };
    Loads loads;
    prescribe(solid, boundary::left, 0, zero, loads.displacements);
    prescribe(solid, boundary::right, 0, zero, loads.displacements);
    prescribe(solid, boundary::bottom, 1, zero, loads.displacements);
    loads.dead = body_force(solid,
                            [=](const Point<2> &) {
                              return dealii::Tensor<1, 2>({0., -weight});
                            });
    LoadedSolid loaded(solid, loads, {});
    auto u = solid.make_vector();
    u.update_ghost_values();
    loaded.assemble(u, 0., 0., nullptr);
    EXPECT_LT(loaded.residual().l2_norm(), 1e-13 * loaded.force_scale());
    // The base carries the weight.
    double base = 0.;
    for (const auto dof : solid.locally_owned())
      if (solid.component(dof) == 1)
        base += loaded.reactions()(dof);
    base = dealii::Utilities::MPI::sum(base, MPI_COMM_WORLD);
    EXPECT_NEAR(base, weight * 50. * height, 1e-12 * weight * 50. * height);
    for (const auto &state : solid.point_states(u))
      EXPECT_NEAR(state.stress.zz, ratio * state.stress.yy, 1e-12 * weight * height);
  }
}
} // namespace nonlinear_state_tests
