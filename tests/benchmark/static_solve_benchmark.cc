// A static solve of the elastic continuum beside the same in plain deal.II, a function as
// its tutorials have it: seconds from the mesh to the displacements, at 1e4, 1e5 and 1e6
// unknowns. Arguments: rounds (3), largest number of unknowns (1e6).
#include "continuum/elastic_solid.h"
#include "continuum/loads.h"
#include "continuum/section_mesh.h"
#include "continuum/static_solver.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/lac/trilinos_vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace dealii;
using antiform::continuum::ElasticMaterial;

namespace
{
using Mesh = parallel::distributed::Triangulation<2>;

constexpr double E = 56e9, E0 = 56e6, nu = 0.25, g = 9.81, density = 2500.;
constexpr double tolerance = 1e-8; // of the residual over the load

double seconds()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// Of one solve: seconds by stage, iterations, and an answer to compare.
struct Timing
{
  double assembly = 0., set_up = 0., solve = 0.;
  unsigned int iterations = 0, dofs = 0;
  double energy = 0.; ///< u.f of the two must agree

  double total() const { return assembly + set_up + solve; }
};

/// A layer in its matrix, square cells, about @p n_dofs unknowns; under its weight, base
/// and sides held.
void make_mesh(Mesh &triangulation, const double n_dofs, const unsigned int degree)
{
  using namespace antiform::continuum;
  // 3 n columns of square cells, n rows: a fifth of them layer.
  const auto n = static_cast<unsigned int>(std::sqrt(n_dofs / 6.) / degree / 5.) * 5;
  const auto level = [](const double y) { return [y](double) { return y; }; };
  const auto rows = [](const unsigned int count)
  {
    std::vector<double> fractions;
    for (unsigned int i = 0; i <= count; ++i)
      fractions.push_back(static_cast<double>(i) / count);
    return fractions;
  };
  make_section(triangulation, 0., 15., 3 * n,
               {{level(0.), level(2.), rows(2 * n / 5), 0, false},
                {level(2.), level(3.), rows(n / 5), 1, true},
                {level(3.), level(5.), rows(2 * n / 5), 0, true}});
}

Timing ours(const Mesh &triangulation, const unsigned int degree)
{
  using namespace antiform::continuum;
  Timing timing;
  double begin = seconds();
  const auto lap = [&begin]
  {
    const double now = seconds(), passed = now - begin;
    begin = now;
    return passed;
  };
  const ElasticSolid solid(triangulation,
                           {ElasticMaterial::isotropic(E0, nu, density),
                            ElasticMaterial::isotropic(E, nu, density)},
                           degree);
  const auto load = gravity(solid, Tensor<1, 2>({0., -g}));
  timing.assembly = lap();
  DirichletValues values;
  const auto zero = [](const Point<2> &) { return 0.; };
  prescribe(solid, boundary::bottom, 1, zero, values);
  prescribe(solid, boundary::left, 0, zero, values);
  prescribe(solid, boundary::right, 0, zero, values);
  StaticSolver::Options options;
  options.method = StaticSolver::Method::conjugate_gradients;
  options.tolerance = tolerance;
  const StaticSolver solver(solid, solid.stiffness(), values, options);
  timing.set_up = lap();
  auto u = solid.make_vector();
  timing.iterations = solver.solve(load, u);
  timing.solve = lap();
  timing.dofs = static_cast<unsigned int>(solid.dof_handler().n_dofs());
  timing.energy = u * load;
  return timing;
}

Timing plain(const Mesh &triangulation, const unsigned int degree)
{
  Timing timing;
  double begin = seconds();
  const auto lap = [&begin]
  {
    const double now = seconds(), passed = now - begin;
    begin = now;
    return passed;
  };
  const FESystem<2> fe(FE_Q<2>(degree), 2);
  DoFHandler<2> dof_handler(triangulation);
  dof_handler.distribute_dofs(fe);
  const IndexSet owned = dof_handler.locally_owned_dofs();
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  AffineConstraints<double> constraints(relevant);
  const auto hold = [&](const types::boundary_id side, const unsigned int component)
  {
    ComponentMask mask(2, false);
    mask.set(component, true);
    VectorTools::interpolate_boundary_values(
        dof_handler, side, Functions::ZeroFunction<2>(2), constraints, mask);
  };
  hold(antiform::continuum::boundary::bottom, 1);
  hold(antiform::continuum::boundary::left, 0);
  hold(antiform::continuum::boundary::right, 0);
  constraints.close();

  TrilinosWrappers::SparsityPattern pattern(owned, owned, relevant, MPI_COMM_WORLD);
  DoFTools::make_sparsity_pattern(dof_handler, pattern, constraints, false);
  pattern.compress();
  TrilinosWrappers::SparseMatrix matrix(pattern);
  TrilinosWrappers::MPI::Vector rhs(owned, MPI_COMM_WORLD), u(owned, MPI_COMM_WORLD);

  const QGauss<2> quadrature(degree + 1);
  FEValues<2> values(fe, quadrature,
                     update_values | update_gradients | update_JxW_values);
  const unsigned int n = fe.n_dofs_per_cell();
  FullMatrix<double> cell_matrix(n, n);
  dealii::Vector<double> cell_rhs(n);
  std::vector<types::global_dof_index> dofs(n);
  const FEValuesExtractors::Vector displacement(0);
  std::vector<SymmetricTensor<2, 2>> strain(n);
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell_matrix = 0.;
      cell_rhs = 0.;
      const double modulus = cell->material_id() == 1 ? E : E0;
      const double lambda = modulus * nu / ((1. + nu) * (1. - 2. * nu)),
                   mu = modulus / (2. * (1. + nu));
      for (const unsigned int q : values.quadrature_point_indices())
      {
        for (unsigned int i = 0; i < n; ++i)
          strain[i] = values[displacement].symmetric_gradient(i, q);
        for (unsigned int i = 0; i < n; ++i)
        {
          const SymmetricTensor<2, 2> stress =
              lambda * trace(strain[i]) * unit_symmetric_tensor<2>() +
              2. * mu * strain[i];
          for (unsigned int j = 0; j < n; ++j)
            cell_matrix(i, j) += stress * strain[j] * values.JxW(q);
          cell_rhs(i) -=
              density * g * values[displacement].value(i, q)[1] * values.JxW(q);
        }
      }
      cell->get_dof_indices(dofs);
      constraints.distribute_local_to_global(cell_matrix, cell_rhs, dofs, matrix, rhs);
    }
  matrix.compress(VectorOperation::add);
  rhs.compress(VectorOperation::add);
  timing.assembly = lap();

  TrilinosWrappers::PreconditionAMG::AdditionalData settings;
  DoFTools::extract_constant_modes(dof_handler, ComponentMask(2, true),
                                   settings.constant_modes);
  settings.elliptic = true;
  settings.higher_order_elements = degree > 1;
  settings.smoother_sweeps = 2;
  settings.aggregation_threshold = 0.02;
  TrilinosWrappers::PreconditionAMG preconditioner;
  preconditioner.initialize(matrix, settings);
  timing.set_up = lap();

  SolverControl control(5000, tolerance * rhs.l2_norm());
  SolverCG<TrilinosWrappers::MPI::Vector> solver(control);
  solver.solve(matrix, u, rhs, preconditioner);
  constraints.distribute(u);
  timing.solve = lap();
  timing.iterations = control.last_step();
  timing.dofs = static_cast<unsigned int>(dof_handler.n_dofs());
  timing.energy = u * rhs;
  return timing;
}

Timing median(std::vector<Timing> timings)
{
  std::sort(timings.begin(), timings.end(),
            [](const Timing &a, const Timing &b) { return a.total() < b.total(); });
  return timings[timings.size() / 2];
}

void print(const char *who, const Timing &t)
{
  std::printf("    %-10s %8.3f %8.3f %8.3f %9.3f %6u %9.3f\n", who, t.assembly, t.set_up,
              t.solve, t.total(), t.iterations, 1e6 * t.total() / t.dofs);
}
} // namespace

int main(int argc, char **argv)
{
  const Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 3;
  const double most = argc > 2 ? std::atof(argv[2]) : 1e6;
  std::printf("seconds of one static solve, median of %d in turn; 1 rank\n", rounds);
  for (const unsigned int degree : {1u, 2u})
    for (double n_dofs = 1e4; n_dofs <= most * 1.001; n_dofs *= 10.)
    {
      Mesh triangulation(MPI_COMM_WORLD);
      make_mesh(triangulation, n_dofs, degree);
      std::vector<Timing> mine, bare;
      std::vector<double> ratios;
      for (int k = 0; k < rounds; ++k)
      {
        mine.push_back(ours(triangulation, degree));
        bare.push_back(plain(triangulation, degree));
        ratios.push_back(mine.back().total() / bare.back().total());
      }
      std::sort(ratios.begin(), ratios.end());
      std::printf("Q%u, %u unknowns    [s] assembly   set-up    solve     total   iter. "
                  "us/unknown\n",
                  degree, mine.front().dofs);
      print("antiform", median(mine));
      print("deal.II", median(bare));
      std::printf("    ratio %.2f [%.2f, %.2f]; u.f differs by %.1e\n",
                  ratios[ratios.size() / 2], ratios.front(), ratios.back(),
                  std::abs(mine.front().energy / bare.front().energy - 1.));
      std::fflush(stdout);
    }
}
