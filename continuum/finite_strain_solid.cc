#include "continuum/finite_strain_solid.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
/// Cells below which a thread team costs more than it saves.
constexpr long smallest_threaded_cells = 500;

PlaneVector multiply(const PlaneStiffness &C, const PlaneVector &e)
{
  PlaneVector result{};
  for (int i = 0; i < 3; ++i)
    result[i] = C[i][0] * e[0] + C[i][1] * e[1] + C[i][2] * e[2];
  return result;
}

double contract(const PlaneVector &a, const PlaneVector &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// (H + H^T + H^T H) / 2, which does not cancel where strain is small.
template <class Gradient>
PlaneVector green_lagrange(const Gradient &H)
{
  return {H.xx + 0.5 * (H.xx * H.xx + H.yx * H.yx),
          H.yy + 0.5 * (H.xy * H.xy + H.yy * H.yy),
          H.xy + H.yx + H.xx * H.xy + H.yx * H.yy};
}

template <class Gradient>
double volume_ratio(const Gradient &H)
{
  return (1. + H.xx) * (1. + H.yy) - H.xy * H.yx;
}

/// The law's own bound, J^2 > 0, to its round-off; a cell inside out has J < 0.
template <class Gradient>
bool is_in_reach(const Gradient &H, const PlaneVector &E)
{
  return volume_ratio(H) > 1e-6 && E[0] > -0.5; // not of what is not a number
}

/// Largest singular value of a 2x2 block.
double spectral_norm(const std::array<double, 4> &b)
{
  const double sum = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3];
  const double determinant = b[0] * b[3] - b[1] * b[2];
  const double root =
      std::sqrt(std::max(0., 0.25 * sum * sum - determinant * determinant));
  return std::sqrt(0.5 * sum + root);
}
} // namespace

FiniteStrainSolid::FiniteStrainSolid(
    const parallel::distributed::Triangulation<2> &triangulation,
    std::vector<ElasticMaterial> materials,
    const unsigned int degree,
    std::function<double(const Point<2> &)> weight,
    const FiniteElasticity form)
    : ElasticSolid(triangulation, std::move(materials), degree, std::move(weight))
    , n_points_((degree + 1) * (degree + 1))
{
  for (const ElasticMaterial &material : this->materials())
    laws_.emplace_back(material, form);
  lay_out_cells();
  lay_out_nodes();
}

void FiniteStrainSolid::lay_out_cells()
{
  FEValues<2> values(fe(), QGauss<2>(degree() + 1),
                     update_gradients | update_quadrature_points | update_JxW_values);
  std::vector<types::global_dof_index> dofs(fe().n_dofs_per_cell());
  for (const bool owned : {true, false})
    for (const auto &cell : dof_handler().active_cell_iterators())
    {
      if (cell->is_artificial() || cell->is_locally_owned() != owned)
        continue;
      n_owned_cells_ += owned ? 1 : 0;
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      material(cell->material_id()); // throws for a cell without one
      material_of_.push_back(static_cast<std::uint8_t>(cell->material_id()));
      centre_.push_back(cell->center());
      for (unsigned int k = 0; k < n_points_; ++k)
        nodes_.push_back(
            partitioner().global_to_local(dofs[fe().component_to_system_index(0, k)]) /
            2);
      for (const unsigned int q : values.quadrature_point_indices())
      {
        weighted_area_.push_back(weight(values.quadrature_point(q)) * values.JxW(q));
        for (unsigned int k = 0; k < n_points_; ++k)
          for (const unsigned int d : {0u, 1u})
            shape_gradient_.push_back(
                values.shape_grad(fe().component_to_system_index(0, k), q)[d]);
      }
    }
  cell_force_.resize(2 * nodes_.size());
}

void FiniteStrainSolid::lay_out_nodes()
{
  const std::size_t n_nodes = partitioner().locally_owned_size() / 2;
  start_.assign(n_nodes + 1, 0);
  for (const std::uint32_t node : nodes_)
    if (node < n_nodes)
      ++start_[node + 1];
  for (std::size_t node = 0; node < n_nodes; ++node)
    start_[node + 1] += start_[node];
  corner_.resize(start_.back());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t corner = 0; corner < nodes_.size(); ++corner)
    if (nodes_[corner] < n_nodes)
      corner_[next[nodes_[corner]]++] = corner;
}

FiniteStrainSolid::Gradient
FiniteStrainSolid::gradient(const std::size_t point, const std::vector<double> &u) const
{
  const double *const g = shape_gradient_.data() + 2 * n_points_ * point;
  Gradient H;
  for (std::size_t k = 0; k < n_points_; ++k)
  {
    H.xx += u[2 * k] * g[2 * k];
    H.xy += u[2 * k] * g[2 * k + 1];
    H.yx += u[2 * k + 1] * g[2 * k];
    H.yy += u[2 * k + 1] * g[2 * k + 1];
  }
  return H;
}

void FiniteStrainSolid::nodal(const std::size_t cell,
                              const double *displacement,
                              std::vector<double> &u) const
{
  u.resize(2 * n_points_);
  for (std::size_t k = 0; k < n_points_; ++k)
  {
    const double *const at_node =
        displacement + std::size_t{2} * nodes_[cell * n_points_ + k];
    u[2 * k] = at_node[0];
    u[2 * k + 1] = at_node[1];
  }
}

bool FiniteStrainSolid::evaluate(const std::size_t cell,
                                 const double *displacement,
                                 std::vector<double> &u) const
{
  const FiniteStrainLaw &law = laws_[material_of_[cell]];
  double *const f = cell_force_.data() + 2 * n_points_ * cell;
  std::fill(f, f + 2 * n_points_, 0.);
  nodal(cell, displacement, u);
  for (std::size_t q = 0; q < n_points_; ++q)
  {
    const std::size_t p = point(cell, q);
    const Gradient H = gradient(p, u);
    const PlaneVector E = green_lagrange(H);
    if (!is_in_reach(H, E))
      return false;
    const PlaneVector S = law.stress(E);
    const double w = weighted_area_[p];
    // P = F S, the force on node k is P grad N_k.
    const double xx = w * ((1. + H.xx) * S[0] + H.xy * S[2]),
                 xy = w * ((1. + H.xx) * S[2] + H.xy * S[1]),
                 yx = w * (H.yx * S[0] + (1. + H.yy) * S[2]),
                 yy = w * (H.yx * S[2] + (1. + H.yy) * S[1]);
    const double *const g = shape_gradient_.data() + 2 * n_points_ * p;
    for (std::size_t k = 0; k < n_points_; ++k)
    {
      f[2 * k] += xx * g[2 * k] + xy * g[2 * k + 1];
      f[2 * k + 1] += yx * g[2 * k] + yy * g[2 * k + 1];
    }
  }
  return true;
}

void FiniteStrainSolid::add_internal_force(const Vector &displacement,
                                           Vector &force) const
{
  const double *const u = displacement.begin();
  double *const f = force.begin();
  const auto n_cells = static_cast<long>(material_of_.size());
  const auto n_nodes = static_cast<long>(start_.size()) - 1;
  int n_bad = 0;
#pragma omp parallel if (n_cells > smallest_threaded_cells)
  {
    std::vector<double> of_cell;
#pragma omp for schedule(static) reduction(+ : n_bad)
    for (long cell = 0; cell < n_cells; ++cell)
      n_bad += evaluate(cell, u, of_cell) ? 0 : 1;
#pragma omp for schedule(static)
    for (long node = 0; node < n_nodes; ++node)
      for (std::size_t k = start_[node]; k < start_[node + 1]; ++k)
      {
        f[2 * node] -= cell_force_[2 * corner_[k]];
        f[2 * node + 1] -= cell_force_[2 * corner_[k] + 1];
      }
  }
  if (Utilities::MPI::max(n_bad, dof_handler().get_communicator()) > 0)
    refuse(displacement);
}

void FiniteStrainSolid::refuse(const Vector &displacement) const
{
  double smallest = std::numeric_limits<double>::infinity();
  std::size_t where = 0;
  std::vector<double> u;
  for (std::size_t cell = 0; cell < n_owned_cells_; ++cell)
  {
    nodal(cell, displacement.begin(), u);
    for (std::size_t q = 0; q < n_points_; ++q)
      if (const double J = volume_ratio(gradient(point(cell, q), u)); !(J >= smallest))
      {
        smallest = std::isnan(J) ? -std::numeric_limits<double>::infinity() : J;
        where = cell;
      }
  }
  const MPI_Comm all = dof_handler().get_communicator();
  std::ostringstream place;
  if (n_owned_cells_ > 0)
    place << "(" << centre_[where][0] << ", " << centre_[where][1] << ") m";
  const auto values = Utilities::MPI::all_gather(all, smallest);
  const auto places = Utilities::MPI::all_gather(all, place.str());
  const auto worst = std::min_element(values.begin(), values.end()) - values.begin();
  throw NumericalError("mesh",
                       "a cell at " + places[worst] +
                           " is turned inside out or pressed to nothing. Load more "
                           "slowly, end the run earlier (Run / End shortening), or give "
                           "larger cells there; volume ratio J",
                       values[worst], 0.);
}

double FiniteStrainSolid::strain_energy_share(const Vector &displacement) const
{
  double energy = 0.;
  std::vector<double> u;
  for (std::size_t cell = 0; cell < n_owned_cells_; ++cell)
  {
    nodal(cell, displacement.begin(), u);
    for (std::size_t q = 0; q < n_points_; ++q)
    {
      const std::size_t p = point(cell, q);
      energy += weighted_area_[p] *
                laws_[material_of_[cell]].energy(green_lagrange(gradient(p, u)));
    }
  }
  return energy;
}

std::vector<ElasticSolid::CellState>
FiniteStrainSolid::cell_states(const Vector &displacement) const
{
  std::vector<CellState> states = ElasticSolid::cell_states(displacement);
  FEValues<2> values(fe(), QGauss<2>(degree() + 1), update_JxW_values);
  std::vector<double> u;
  std::size_t cell = 0; // owned cells come first, in the same order
  for (const auto &at : dof_handler().active_cell_iterators())
    if (at->is_locally_owned())
    {
      values.reinit(at);
      nodal(cell, displacement.begin(), u);
      Gradient H;
      for (std::size_t q = 0; q < n_points_; ++q)
      {
        const double share = values.JxW(static_cast<unsigned int>(q)) / states[cell].area;
        const Gradient there = gradient(point(cell, q), u);
        H.xx += share * there.xx;
        H.xy += share * there.xy;
        H.yx += share * there.yx;
        H.yy += share * there.yy;
      }
      CellState &state = states[cell];
      state.strain = green_lagrange(H);
      state.rotation = std::atan2(H.yx - H.xy, 2. + H.xx + H.yy);
      const PlaneVector S = laws_[material_of_[cell]].stress(state.strain);
      const double F[2][2] = {{1. + H.xx, H.xy}, {H.yx, 1. + H.yy}};
      const double J = volume_ratio(H); // Cauchy's stress is F S F^T / J
      const auto push = [&](const int i, const int j)
      {
        return (F[i][0] * (S[0] * F[j][0] + S[2] * F[j][1]) +
                F[i][1] * (S[2] * F[j][0] + S[1] * F[j][1])) /
               J;
      };
      state.stress = {push(0, 0), push(1, 1), push(0, 1)};
      ++cell;
    }
  return states;
}

bool FiniteStrainSolid::tangent(const std::size_t cell,
                                const double *displacement,
                                std::vector<double> &u,
                                double *blocks) const
{
  const FiniteStrainLaw &law = laws_[material_of_[cell]];
  nodal(cell, displacement, u);
  std::fill(blocks, blocks + 4 * n_points_ * n_points_, 0.);
  std::vector<std::array<PlaneVector, 2>> B(n_points_);
  for (std::size_t q = 0; q < n_points_; ++q)
  {
    const std::size_t p = point(cell, q);
    const Gradient H = gradient(p, u);
    const PlaneVector E = green_lagrange(H);
    if (!is_in_reach(H, E))
      return false;
    const PlaneVector S = law.stress(E);
    const PlaneStiffness C = law.tangent(E);
    const double w = weighted_area_[p];
    const double *const g = shape_gradient_.data() + 2 * n_points_ * p;
    const double F[2][2] = {{1. + H.xx, H.xy}, {H.yx, 1. + H.yy}};
    for (std::size_t k = 0; k < n_points_; ++k)
      for (int c = 0; c < 2; ++c)
        B[k][c] = {F[c][0] * g[2 * k], F[c][1] * g[2 * k + 1],
                   F[c][0] * g[2 * k + 1] + F[c][1] * g[2 * k]};
    for (std::size_t k = 0; k < n_points_; ++k)
    {
      const PlaneVector CBx = multiply(C, B[k][0]), CBy = multiply(C, B[k][1]);
      const double pull_x = S[0] * g[2 * k] + S[2] * g[2 * k + 1],
                   pull_y = S[2] * g[2 * k] + S[1] * g[2 * k + 1];
      for (std::size_t j = 0; j < n_points_; ++j)
      {
        double *const block = blocks + 4 * (j * n_points_ + k);
        const double geometric = g[2 * j] * pull_x + g[2 * j + 1] * pull_y;
        block[0] += w * (contract(B[j][0], CBx) + geometric);
        block[1] += w * contract(B[j][0], CBy);
        block[2] += w * contract(B[j][1], CBx);
        block[3] += w * (contract(B[j][1], CBy) + geometric);
      }
    }
  }
  return true;
}

Vector FiniteStrainSolid::absolute_row_sums() const
{
  return absolute_row_sums(make_vector());
}

Vector FiniteStrainSolid::absolute_row_sums(const Vector &displacement) const
{
  const std::size_t per_cell = 4 * n_points_ * n_points_;
  std::vector<double> blocks(per_cell * material_of_.size());
  const auto n_cells = static_cast<long>(material_of_.size());
  const auto n_nodes = static_cast<long>(start_.size()) - 1;
  Vector sums = make_vector();
  double *const sum = sums.begin();
  int n_bad = 0;
#pragma omp parallel if (n_cells > smallest_threaded_cells)
  {
    std::vector<double> u;
#pragma omp for schedule(static) reduction(+ : n_bad)
    for (long cell = 0; cell < n_cells; ++cell)
      n_bad +=
          tangent(cell, displacement.begin(), u, blocks.data() + per_cell * cell) ? 0 : 1;
    std::vector<std::pair<std::uint32_t, std::array<double, 4>>> row; // by column
#pragma omp for schedule(static)
    for (long node = 0; node < n_nodes; ++node)
    {
      row.clear();
      for (std::size_t k = start_[node]; k < start_[node + 1]; ++k)
      {
        const std::size_t cell = corner_[k] / n_points_;
        for (std::size_t j = 0; j < n_points_; ++j)
        {
          const std::uint32_t column = nodes_[cell * n_points_ + j];
          auto entry = std::find_if(row.begin(), row.end(),
                                    [=](const auto &e) { return e.first == column; });
          if (entry == row.end())
            entry = row.insert(row.end(), {column, {}});
          const double *const block = blocks.data() + 4 * (corner_[k] * n_points_ + j);
          for (std::size_t c = 0; c < 4; ++c)
            entry->second[c] += block[c];
        }
      }
      double norms = 0.;
      for (const auto &entry : row)
        norms += spectral_norm(entry.second);
      sum[2 * node] = sum[2 * node + 1] = norms;
    }
  }
  if (Utilities::MPI::max(n_bad, dof_handler().get_communicator()) > 0)
    refuse(displacement);
  sums.update_ghost_values();
  return sums;
}

double FiniteStrainSolid::stable_step(const Vector &displacement,
                                      const Vector &inverse_mass,
                                      const std::vector<double> &extra) const
{
  const Vector sums = absolute_row_sums(displacement);
  double squared_frequency = 0.;
  for (std::size_t i = 0; i < sums.locally_owned_size(); ++i)
    squared_frequency =
        std::max(squared_frequency, (sums.begin()[i] + (extra.empty() ? 0. : extra[i])) *
                                        inverse_mass.begin()[i]);
  squared_frequency =
      Utilities::MPI::max(squared_frequency, dof_handler().get_communicator());
  return squared_frequency > 0. ? 2. / std::sqrt(squared_frequency)
                                : std::numeric_limits<double>::infinity();
}

double FiniteStrainSolid::smallest_edge() const
{
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto &cell : dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int line : cell->line_indices())
        smallest = std::min(smallest, cell->line(line)->measure());
  return Utilities::MPI::min(smallest, dof_handler().get_communicator());
}
} // namespace antiform::continuum
