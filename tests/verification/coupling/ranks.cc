// Grains on every rank, joined to a mesh of one rank and of all of them.
#include "support/coupling_loop.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

#include <boost/serialization/map.hpp>
#include <boost/serialization/vector.hpp>

#include <gtest/gtest.h>

namespace antiform::coupling::test::ranks_tests
{
namespace
{
/// Values of a field at the nodes, x and y. Ranks number dofs in ways of their own, so
/// nodes are told apart by place, in units of 1e-6.
using Nodes = std::map<std::vector<long>, double>;

Nodes at_nodes(const Bridged &model, const continuum::Vector &field)
{
  Nodes own;
  for (const auto dof : model.solid->locally_owned())
  {
    const Vec2 x = model.mesh_place(dof);
    own[{std::lround(1e6 * x.x), std::lround(1e6 * x.y),
         static_cast<long>(
             model.solid->component(static_cast<unsigned int>(dof)))}] = field(dof);
  }
  Nodes all;
  for (const Nodes &part :
       dealii::Utilities::MPI::all_gather(model.mesh->communicator(), own))
    all.insert(part.begin(), part.end());
  return all;
}

struct Result
{
  std::vector<std::vector<double>> grains; ///< fields by grain
  std::vector<Nodes> nodes;                ///< fields by node
  std::vector<Energies> ledger;            ///< at samples
  std::vector<double> reaction;            ///< of the mesh' supports, at samples [N]
  std::vector<double> gap;                 ///< at samples [m]
  double largest = 0.;                     ///< displacement [m]
};

double largest_of(const std::vector<double> &values)
{
  double largest = 0.;
  for (const double v : values)
    largest = std::max(largest, std::abs(v));
  return largest;
}

/// Largest difference of a value over the largest of its field.
void compare_grains(const Result &one, const Result &all, double &worst)
{
  worst = 0.;
  ASSERT_EQ(one.grains.size(), all.grains.size());
  for (std::size_t f = 0; f < one.grains.size(); ++f)
  {
    ASSERT_EQ(one.grains[f].size(), all.grains[f].size());
    const double largest = largest_of(one.grains[f]);
    EXPECT_GT(largest, 0.);
    for (std::size_t i = 0; i < one.grains[f].size(); ++i)
      worst = std::max(worst,
                       std::abs(one.grains[f][i] - all.grains[f][i]) / largest);
  }
}

void compare_nodes(const Result &one, const Result &all, double &worst)
{
  worst = 0.;
  ASSERT_EQ(one.nodes.size(), all.nodes.size());
  for (std::size_t f = 0; f < one.nodes.size(); ++f)
  {
    ASSERT_EQ(one.nodes[f].size(), all.nodes[f].size());
    double largest = 0., difference = 0.;
    for (const auto &[place, value] : one.nodes[f])
    {
      largest = std::max(largest, std::abs(value));
      difference = std::max(difference, std::abs(value - all.nodes[f].at(place)));
    }
    EXPECT_GT(largest, 0.);
    worst = std::max(worst, difference / largest);
  }
}

void expect_equal(const Result &one, const Result &all, const double tolerance)
{
  double grains = 0., nodes = 0.;
  compare_grains(one, all, grains);
  compare_nodes(one, all, nodes);
  EXPECT_LE(grains, tolerance);
  EXPECT_LE(nodes, tolerance);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::printf("  %u ranks against one: grains %.1e, nodes %.1e\n",
                dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD), grains, nodes);
}

/// The same bits of the grains on every rank.
void expect_same_on_all_ranks(const Result &result)
{
  const auto of_ranks = dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, result.grains);
  for (const auto &grains : of_ranks)
    EXPECT_TRUE(grains == of_ranks.front());
}

/// Mesh that ends with the overlap, so that its supports carry multipliers.
BlockShape shape_of(const MultiplierSpace space, const unsigned int degree)
{
  BlockShape shape;
  shape.core_x = 12.;
  shape.core_y = 8.;
  shape.rim = 0.;
  shape.h = space == MultiplierSpace::per_grain   ? 4.
            : space == MultiplierSpace::coarsened ? 1.
                                                  : 2.;
  shape.degree = degree;
  return shape;
}

/// \param n_tied grains of the overlap that follow the mesh in all
void make_block(Bridged &model,
                const MultiplierSpace space,
                const unsigned int degree,
                const int n_tied)
{
  model.options.multipliers = space;
  for (int k = 0; k < n_tied; ++k)
    model.options.tied_grains.push_back(3 + 7 * k); // of the lowest rows
  make_lattice_block(model, shape_of(space, degree));
  model.state.tells_energies =
      dealii::Utilities::MPI::this_mpi_process(model.mesh->communicator()) == 0;
}

/// Ends that move inward as walls, without grains on them.
void support_ends(Bridged &model, const BlockShape &shape)
{
  const double out = shape.w + shape.rim;
  for (const double normal : {1., -1.})
  {
    discrete::Wall wall;
    wall.normal = {normal, 0.};
    model.walls.push_back(wall);
  }
  const auto &partitioner = model.solid->partitioner();
  for (const auto dof : model.solid->locally_owned())
  {
    const double x = model.mesh_place(dof).x;
    if (model.solid->component(static_cast<unsigned int>(dof)) == 0 &&
        (x < -out + 1e-9 || x > shape.core_x + out - 1e-9))
      model.mesh->prescribe(partitioner.global_to_local(dof), x < 0. ? 0 : 1);
  }
}

/// A smooth motion that does not obey the constraint.
void set_velocities(Bridged &model)
{
  const auto field = [](const Vec2 &x, const unsigned int component)
  { return 1e-3 * std::sin(0.4 * x.x + 0.9 * x.y + 1.3 * component); };
  discrete::Grains &g = model.state.grains;
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    g.velocity_x[i] = 1.2 * field(g.reference(i), 0);
    g.velocity_y[i] = field(g.reference(i), 1);
    g.spin[i] = field(g.reference(i), 2);
  }
  for (const auto dof : model.solid->locally_owned())
    model.mesh->velocity(dof) = field(
        model.mesh_place(dof), model.solid->component(static_cast<unsigned int>(dof)));
}

Energies summed(Energies share, const MPI_Comm communicator)
{
  for (double *const term : share.terms())
    *term = dealii::Utilities::MPI::sum(*term, communicator);
  return share;
}

struct Motion
{
  MultiplierSpace space = MultiplierSpace::mesh;
  unsigned int degree = 1;
  double damping = 0.;
  int n_tied = 0;
};

/// 300 steps between closing walls.
Result move_on(const MPI_Comm communicator, const Motion &motion)
{
  Bridged model(communicator);
  make_block(model, motion.space, motion.degree, motion.n_tied);
  support_ends(model, shape_of(motion.space, motion.degree));
  model.factorise();
  set_velocities(model);
  Loop::Options options;
  options.damping = motion.damping;
  options.wall_speed = [](const double) { return 1e-3; };
  Loop loop(model, 0.8 * model.stable_step(), options);
  Result result;
  loop.probe(25,
             [&](const Clock &)
             {
               result.ledger.push_back(summed(loop.simulation.energies(), communicator));
               result.reaction.push_back(loop.walls().mesh_reaction());
               result.gap.push_back(model.domain->displacement_gap(
                   model.state.grains, model.mesh->displacement));
             });
  loop.advance(300);
  const discrete::Grains &g = model.state.grains;
  result.grains = {g.displacement_x, g.displacement_y, g.rotation, g.velocity_x,
                   g.velocity_y,     g.spin,           g.force_x,  g.force_y};
  result.nodes = {at_nodes(model, model.mesh->displacement),
                  at_nodes(model, model.mesh->velocity),
                  at_nodes(model, model.mesh->force)};
  result.largest = std::max(largest_of(g.displacement_x), largest_of(g.displacement_y));
  return result;
}

void expect_equal_motion(const Motion &motion)
{
  const Result one = move_on(MPI_COMM_SELF, motion),
               all = move_on(MPI_COMM_WORLD, motion);
  // Round-off of 300 steps, some 1e-12, with room for damping, which turns at a sign.
  constexpr double tolerance = 1e-8;
  expect_equal(one, all, tolerance);
  expect_same_on_all_ranks(all);
  ASSERT_EQ(one.ledger.size(), all.ledger.size());
  for (std::size_t k = 0; k < one.ledger.size(); ++k)
  {
    Energies a = one.ledger[k], b = all.ledger[k];
    for (std::size_t t = 0; t < a.terms().size(); ++t)
      EXPECT_NEAR(*a.terms()[t], *b.terms()[t], tolerance * a.magnitude())
          << "term " << t << " of sample " << k;
    EXPECT_NEAR(one.reaction[k], all.reaction[k], tolerance * largest_of(one.reaction));
    EXPECT_NEAR(one.gap[k], all.gap[k], tolerance * one.largest);
  }
  EXPECT_GT(one.ledger.back().kinetic, 0.);
  EXPECT_GT(largest_of(one.reaction), 0.);
}

/// The block squeezed by 1e-3, pulled at one grain and pushed at one node.
Result balance_on(const MPI_Comm communicator, const MultiplierSpace space)
{
  Bridged model(communicator);
  make_block(model, space, 1, 3);
  const BlockShape shape = shape_of(space, 1);
  StaticSystem system(model.state.grains, model.state.joints, model.solid.get(),
                      model.domain.get());
  const double out = shape.w + shape.rim;
  for (const auto dof : model.solid->locally_owned())
  {
    const Vec2 x = model.mesh_place(dof);
    const bool is_x = model.solid->component(static_cast<unsigned int>(dof)) == 0;
    if (x.x < -out + 1e-9 || x.x > shape.core_x + out - 1e-9)
      system.fix_mesh(dof, is_x ? -1e-3 * x.x : 0.);
    if (!is_x && std::hypot(x.x - 4., x.y + out) < 1e-6)
      system.add_mesh_force(dof, 2e-3);
  }
  system.add_grain_force(model.state.grains.size() / 2, 1, 1e-3);
  system.add_grain_spring(0, 0, 0.1);
  const StaticSolution u = system.solve();
  Result result;
  result.grains = {u.ux, u.uy, u.rotation};
  result.nodes = {at_nodes(model, u.mesh)};
  return result;
}
} // namespace

TEST(Ranks, SolveTheSumOfTheirShares)
{
  namespace mpi = dealii::Utilities::MPI;
  constexpr int n = 40;
  const unsigned int here = mpi::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = mpi::n_mpi_processes(MPI_COMM_WORLD);
  discrete::Random random(17, here);
  Eigen::MatrixXd share(n, n);
  Eigen::VectorXd right(n);
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
      share(i, j) = random.uniform() - 0.5 + (i == j ? n : 0.);
    right[i] = random.uniform();
  }
  std::vector<int> own; // in turn
  for (int i = static_cast<int>(here); i < n; i += static_cast<int>(n_ranks))
    own.push_back(i);
  DistributedSystem system(share.sparseView(), own, MPI_COMM_WORLD);
  ASSERT_TRUE(system.factorise());

  Eigen::MatrixXd whole(n, n);
  Eigen::VectorXd load(n);
  MPI_Allreduce(share.data(), whole.data(), n * n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(right.data(), load.data(), n, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  ASSERT_TRUE(system.solve(right.data()));
  const Eigen::VectorXd wanted = whole.partialPivLu().solve(load);
  EXPECT_LE((right - wanted).norm(), 1e-13 * wanted.norm()); // dominant diagonal
  EXPECT_NEAR(system.norm_one(), whole.cwiseAbs().colwise().sum().maxCoeff(), 1e-12 * n);
  const Eigen::MatrixXd gathered = system.on_first_rank();
  EXPECT_LE((gathered - (here == 0 ? whole : 0. * whole)).norm(), 1e-13 * whole.norm());
}

TEST(Ranks, DoNotChangeTheMotionOfGrainsAndMesh)
{
  expect_equal_motion({});
}

TEST(Ranks, DoNotChangeADampedMotionOfGrainsAndMesh)
{
  expect_equal_motion({MultiplierSpace::mesh, 1, 0.2});
}

TEST(Ranks, DoNotChangeTheMotionOfQuadraticCells)
{
  expect_equal_motion({MultiplierSpace::mesh, 2});
}

TEST(Ranks, DoNotChangeTheMotionOfOneMultiplierAGrain)
{
  expect_equal_motion({MultiplierSpace::per_grain, 1});
}

TEST(Ranks, DoNotChangeTheMotionOfCoarsenedMultipliers)
{
  expect_equal_motion({MultiplierSpace::coarsened, 1});
}

TEST(Ranks, DoNotChangeTheMotionOfTiedGrains)
{
  Motion motion;
  motion.n_tied = 5;
  expect_equal_motion(motion);
}

TEST(Ranks, DoNotChangeTheBalanceOfGrainsAndMesh)
{
  for (const MultiplierSpace space :
       {MultiplierSpace::mesh, MultiplierSpace::coarsened, MultiplierSpace::per_grain})
  {
    const Result one = balance_on(MPI_COMM_SELF, space),
                 all = balance_on(MPI_COMM_WORLD, space);
    expect_equal(one, all, 1e-8); // condition of the system, 1e6, times round-off
    expect_same_on_all_ranks(all);
  }
}

TEST(Ranks, AllRefuseAMultiplierSpaceThatIsTooRich)
{
  BlockShape shape;
  shape.core_x = shape.core_y = 8.;
  shape.w = 4.;
  shape.rim = 2.;
  shape.h = 1.; // cells of one diameter: some vertices share their grains
  Bridged model(MPI_COMM_WORLD);
  make_lattice_block(model, shape);
  try
  {
    model.factorise();
    FAIL() << "accepted";
  }
  catch (const NumericalError &error)
  {
    EXPECT_NE(std::string(error.what()).find("multiplier space too rich at vertex ("),
              std::string::npos)
        << error.what();
  }
}
} // namespace antiform::coupling::test::ranks_tests
