// The explicit side of ElasticSolid: its own rows of K, forces and the stable step.
#include "continuum/elastic_solid.h"

#include <deal.II/base/mpi.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
// Below this many nodes a thread team costs more than it saves. The number of threads
// never changes a result: each row is summed by one thread, in the order of its columns.
constexpr long smallest_threaded_loop = 2000;
} // namespace

void ElasticSolid::build_rows()
{
  const Epetra_CrsMatrix &matrix = stiffness_.trilinos_matrix();
  const int n_nodes = static_cast<int>(partitioner().locally_owned_size() / 2);
  rows_ = {};
  rows_.start.assign(1, 0);
  std::vector<std::pair<types::global_dof_index, int>> order; // of the x columns
  for (int node = 0; node < n_nodes; ++node)
  {
    int n = 0, n_second = 0;
    double *x_row = nullptr, *y_row = nullptr;
    int *columns = nullptr, *second_columns = nullptr;
    matrix.ExtractMyRowView(2 * node, n, x_row, columns);
    matrix.ExtractMyRowView(2 * node + 1, n_second, y_row, second_columns);
    AssertThrow(n == n_second && std::equal(columns, columns + n, second_columns),
                ExcInternalError());

    order.clear();
    for (int k = 0; k < n; ++k)
      order.emplace_back(matrix.ColMap().GID(columns[k]), k);
    std::sort(order.begin(), order.end());
    for (std::size_t k = 0; k < order.size(); k += 2)
    {
      const int x = order[k].second, y = order[k + 1].second;
      const unsigned int local = partitioner().global_to_local(order[k].first);
      AssertThrow(order[k].first % 2 == 0 && order[k + 1].first == order[k].first + 1 &&
                      local % 2 == 0,
                  ExcInternalError());
      rows_.column.push_back(local / 2);
      rows_.block.push_back({x_row[x], x_row[y], y_row[x], y_row[y]});
    }
    rows_.start.push_back(rows_.column.size());
  }
}

void ElasticSolid::add_to_stiffness(const TrilinosWrappers::SparseMatrix &matrix)
{
  stiffness_.add(1., matrix);
  build_rows();
}

void ElasticSolid::add_internal_force(const Vector &displacement, Vector &force) const
{
  AssertDimension(displacement.locally_owned_size(), partitioner().locally_owned_size());
  const double *u = displacement.begin();
  double *f = force.begin();
  const auto n_nodes = static_cast<long>(rows_.start.size()) - 1;
#pragma omp parallel for schedule(static) if (n_nodes > smallest_threaded_loop)
  for (long node = 0; node < n_nodes; ++node)
  {
    double x = 0., y = 0.;
    for (std::size_t k = rows_.start[node]; k < rows_.start[node + 1]; ++k)
    {
      const auto &block = rows_.block[k];
      const double *at_node = u + std::size_t{2} * rows_.column[k];
      const double ux = at_node[0], uy = at_node[1];
      x += block[0] * ux + block[1] * uy;
      y += block[2] * ux + block[3] * uy;
    }
    f[2 * node] -= x;
    f[2 * node + 1] -= y;
  }
}

Vector ElasticSolid::absolute_row_sums() const
{
  Vector sums = make_vector();
  for (std::size_t node = 0; node + 1 < rows_.start.size(); ++node)
    for (std::size_t k = rows_.start[node]; k < rows_.start[node + 1]; ++k)
    {
      const auto &block = rows_.block[k];
      sums.local_element(2 * node) += std::abs(block[0]) + std::abs(block[1]);
      sums.local_element(2 * node + 1) += std::abs(block[2]) + std::abs(block[3]);
    }
  sums.update_ghost_values();
  return sums;
}

double ElasticSolid::stable_step(const Vector &inverse_mass) const
{
  // Gershgorin's circles of M^-1 K, whose eigenvalues are those of the symmetric
  // M^-1/2 K M^-1/2: the squared frequencies.
  const Vector sums = absolute_row_sums();
  double squared_frequency = 0.;
  for (unsigned int i = 0; i < sums.locally_owned_size(); ++i)
    squared_frequency = std::max(squared_frequency,
                                 sums.local_element(i) * inverse_mass.local_element(i));
  squared_frequency =
      Utilities::MPI::max(squared_frequency, dof_handler().get_communicator());
  return squared_frequency > 0. ? 2. / std::sqrt(squared_frequency)
                                : std::numeric_limits<double>::infinity();
}

double ElasticSolid::strain_energy(const Vector &displacement) const
{
  return Utilities::MPI::sum(strain_energy_share(displacement),
                             dof_handler().get_communicator());
}

double ElasticSolid::strain_energy_share(const Vector &displacement) const
{
  Vector force = make_vector();
  add_internal_force(displacement, force);
  double work = 0.;
  for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
    work -= 0.5 * force.local_element(i) * displacement.local_element(i);
  return work;
}
} // namespace antiform::continuum
