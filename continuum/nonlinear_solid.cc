#include "continuum/nonlinear_solid.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe_values.h>

#include <array>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
using namespace dealii;
using TrilinosMatrix = TrilinosWrappers::SparseMatrix;

namespace
{
/// From here on Q1 cells lock: in a bent cell the volume resists 10 times as much as the
/// shape.
constexpr double largest_poisson_ratio_of_q1 = 0.45;

std::string text_of(const Point<2> &place)
{
  std::ostringstream text;
  text << "(" << place[0] << ", " << place[1] << ") m";
  return text.str();
}

/// That of the material whose tangent at rest this would be; in plane strain C12 / C11 =
/// nu / (1 - nu).
double initial_poisson_ratio(const MaterialLaw &law)
{
  const std::vector<double> begin(law.n_history(), 0.);
  std::vector<double> end(law.n_history());
  const auto C = law.respond(PointInput(), begin.data(), end.data()).tangent;
  const double ratio = (C[0][1] + C[1][0]) / (C[0][0] + C[1][1]);
  return ratio / (1. + ratio);
}

double dot(const PlaneVector &a, const PlaneVector &b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

PlaneVector product(const std::array<PlaneVector, 3> &matrix, const PlaneVector &vector)
{
  return {dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)};
}

/// The text of an error without its component, value and limit.
std::string reason_of(const NumericalError &error)
{
  const std::string text = error.what();
  const std::size_t start = text.find(": ") + 2;
  return text.substr(start, text.rfind(" (value") - start);
}

/// Throw the problem of the lowest rank that has one, on all of them.
void raise_together(const std::optional<NumericalError> &own, const MPI_Comm communicator)
{
  const bool any = Utilities::MPI::max(own ? 1 : 0, communicator) != 0;
  if (!any)
    return;
  const std::string reason = own ? reason_of(*own) : "";
  const auto reasons = Utilities::MPI::all_gather(communicator, reason);
  const auto values = Utilities::MPI::all_gather(communicator, own ? own->value : 0.);
  const auto limits = Utilities::MPI::all_gather(communicator, own ? own->limit : 0.);
  for (unsigned int rank = 0; rank < reasons.size(); ++rank)
    if (!reasons[rank].empty())
      throw NumericalError("solid", reasons[rank], values[rank], limits[rank]);
}
} // namespace

/// What a quadrature point's strain and its change are made of.
struct NonlinearSolid::Kinematics
{
  PlaneVector strain;
  Tensor<2, 2> F;             ///< deformation gradient; unity at small strain
  double J = 1.;              ///< its determinant
  std::vector<PlaneVector> B; ///< strain per displacement of each dof [1/m]
};

/// Goes through this rank's cells and, in each, its quadrature points with their strain.
class NonlinearSolid::CellLoop
{
public:
  CellLoop(const NonlinearSolid &solid, const Vector &displacement)
      : solid(solid)
      , values(solid.fe(),
               QGauss<2>(solid.degree() + 1),
               update_gradients | update_quadrature_points | update_JxW_values)
      , n(solid.fe().n_dofs_per_cell())
      , dofs(n)
      , displacement_(displacement)
      , u_(n)
      , mean_gradients_(n)
  {
    point_.B.resize(n);
  }

  /// Calls begin_cell(), at_point(law, q, kinematics, input, history) for each quadrature
  /// point q, whose history begins there, and end_cell(). An error of a point is raised
  /// on all ranks after the last cell.
  template <class Begin, class AtPoint, class End>
  void run(const Begin &begin_cell, const AtPoint &at_point, const End &end_cell)
  {
    std::optional<NumericalError> problem;
    std::size_t cell_number = 0, point = 0;
    for (const auto &cell : solid.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const MaterialLaw &law = solid.law(cell->material_id());
        material = cell->material_id();
        std::size_t history = solid.history_start_[cell_number++];
        start(cell);
        begin_cell();
        for (const unsigned int q : values.quadrature_point_indices())
        {
          try
          {
            set_point(q, law.is_finite_strain());
            PointInput input;
            input.strain = point_.strain;
            if (!solid.initial_stress_.empty())
              input.initial = solid.initial_stress_[point];
            at_point(law, q, point_, input, history);
          }
          catch (const NumericalError &error)
          {
            if (!problem)
              problem = error;
          }
          history += law.n_history();
          ++point;
        }
        end_cell();
      }
    raise_together(problem, solid.dof_handler().get_communicator());
  }

  const NonlinearSolid &solid;
  FEValues<2> values;
  unsigned int n; ///< dofs of a cell
  std::vector<types::global_dof_index> dofs;
  types::material_id material = 0;

  unsigned int component(const unsigned int i) const
  {
    return solid.fe().system_to_component_index(i).first;
  }

private:
  void start(const DoFHandler<2>::active_cell_iterator &cell)
  {
    values.reinit(cell);
    cell->get_dof_indices(dofs);
    for (unsigned int i = 0; i < n; ++i)
      u_[i] = displacement_(dofs[i]);
    if (!solid.mean_dilatation_)
      return;
    double area = 0.;
    std::fill(mean_gradients_.begin(), mean_gradients_.end(), Tensor<1, 2>());
    for (const unsigned int q : values.quadrature_point_indices())
    {
      area += values.JxW(q);
      for (unsigned int i = 0; i < n; ++i)
        mean_gradients_[i] += values.JxW(q) * values.shape_grad(i, q);
    }
    for (auto &gradient : mean_gradients_)
      gradient /= area;
  }

  void set_point(const unsigned int q, const bool finite)
  {
    Tensor<2, 2> H; // displacement gradient
    for (unsigned int i = 0; i < n; ++i)
      H[component(i)] += u_[i] * values.shape_grad(i, q);
    point_.F = unit_symmetric_tensor<2>();
    point_.J = 1.;
    if (!finite)
    {
      set_strain_changes(q);
      point_.strain = {};
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int k = 0; k < 3; ++k)
          point_.strain[k] += point_.B[i][k] * u_[i];
      return;
    }
    point_.F += H;
    point_.J = determinant(point_.F);
    if (!(point_.J > 0.)) // also for not-a-number
      throw NumericalError("solid",
                           "a cell is turned inside out at " +
                               text_of(values.quadrature_point(q)) +
                               "; take smaller load steps, or smaller or less distorted "
                               "cells there. Volume ratio J",
                           point_.J, 0.);
    set_strain_changes(q);
    // (H + H^T + H^T H) / 2 does not cancel where strain is small.
    point_.strain = {H[0][0] + 0.5 * (H[0][0] * H[0][0] + H[1][0] * H[1][0]),
                     H[1][1] + 0.5 * (H[0][1] * H[0][1] + H[1][1] * H[1][1]),
                     H[0][1] + H[1][0] + H[0][0] * H[0][1] + H[1][0] * H[1][1]};
  }

  /// B at the point's F.
  void set_strain_changes(const unsigned int q)
  {
    const auto &F = point_.F;
    for (unsigned int i = 0; i < n; ++i)
    {
      const unsigned int c = component(i);
      const Tensor<1, 2> &g = values.shape_grad(i, q);
      point_.B[i] = {F[c][0] * g[0], F[c][1] * g[1], F[c][0] * g[1] + F[c][1] * g[0]};
      if (solid.mean_dilatation_)
      {
        const double half = 0.5 * (mean_gradients_[i][c] - g[c]);
        point_.B[i][0] += half;
        point_.B[i][1] += half;
      }
    }
  }

  const Vector &displacement_;
  std::vector<double> u_;
  std::vector<Tensor<1, 2>> mean_gradients_; ///< of each dof's shape function
  Kinematics point_;
};

NonlinearSolid::NonlinearSolid(
    const parallel::distributed::Triangulation<2> &triangulation,
    Laws laws,
    const Options &options)
    : DisplacementSpace(triangulation, options.degree, options.weight)
    , laws_(std::move(laws))
    , mean_dilatation_(options.strain_form == StrainForm::mean_dilatation)
{
  check_laws(options);
  lay_out_points(options);
}

void NonlinearSolid::check_laws(const Options &options) const
{
  for (std::size_t id = 0; id < laws_.size(); ++id)
  {
    const std::string name = "solid: material " + std::to_string(id);
    const double poisson_ratio = initial_poisson_ratio(*laws_[id]);
    if (mean_dilatation_ && (degree() != 1 || laws_[id]->is_finite_strain()))
      throw std::invalid_argument(
          name + ": the mean dilatation is for Q1 cells at small strain. "
                 "Take Q2 cells with the strain of the displacements.");
    if (degree() == 1 && !mean_dilatation_ && !options.allow_locking &&
        poisson_ratio >= largest_poisson_ratio_of_q1)
      throw std::invalid_argument(
          name + " answers like a Poisson's ratio of " + std::to_string(poisson_ratio) +
          ": Q1 cells lock from 0.45 on and would be far too stiff. Take Q2 cells, or at "
          "small strain the mean dilatation.");
  }
}

/// Initial stress and place in the history of every point of this rank's cells.
void NonlinearSolid::lay_out_points(const Options &options)
{
  FEValues<2> values(fe(), QGauss<2>(degree() + 1),
                     update_quadrature_points | update_JxW_values);
  std::size_t n_history = 0;
  std::string problem;
  for (const auto &cell : dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      const auto id = cell->material_id();
      if (id >= laws_.size())
        problem = "a cell has material " + std::to_string(id) + ", but only " +
                  std::to_string(laws_.size()) + " laws are given.";
      history_start_.push_back(n_history);
      n_history +=
          values.n_quadrature_points * (problem.empty() ? law(id).n_history() : 0);
      for (const unsigned int q : values.quadrature_point_indices())
      {
        const Point<2> &place = values.quadrature_point(q);
        if (!(values.JxW(q) > 0.))
          problem = "the mesh has a cell that is turned inside out at " + text_of(place) +
                    "; make its faces smoother, or its columns more or its rows fewer.";
        if (options.initial_stress)
          initial_stress_.push_back(options.initial_stress(place));
      }
    }
  for (const auto &of_rank :
       Utilities::MPI::all_gather(dof_handler().get_communicator(), problem))
    if (!of_rank.empty())
      throw std::invalid_argument("solid: " + of_rank);
  history_.assign(n_history, 0.);
  next_history_.assign(n_history, 0.);
}

bool NonlinearSolid::has_symmetric_tangent() const
{
  for (const auto &law : laws_)
    if (!law->has_symmetric_tangent())
      return false;
  for (const auto &force : surface_forces_)
    if (!force->has_symmetric_tangent())
      return false;
  return true;
}

void NonlinearSolid::add(std::shared_ptr<SurfaceForce> force)
{
  couple(force->couplings());
  surface_forces_.push_back(std::move(force));
}

void NonlinearSolid::accept()
{
  history_ = next_history_;
  for (const auto &force : surface_forces_)
    force->accept();
}

void NonlinearSolid::add_springs(const TrilinosMatrix &springs)
{
  if (springs_)
    springs_->add(1., springs);
  else
  {
    springs_ = std::make_unique<TrilinosMatrix>();
    springs_->copy_from(springs);
  }
}

void NonlinearSolid::assemble(const Vector &displacement,
                              const double time_step,
                              Vector &internal_force,
                              TrilinosMatrix *tangent)
{
  if (!surface_forces_.empty() &&
      !partitioner().is_globally_compatible(*displacement.get_partitioner()))
    throw std::invalid_argument("solid: the displacement was made before a surface force "
                                "was added; add it first.");
  CellLoop loop(*this, displacement);
  const unsigned int n = loop.n;
  FullMatrix<double> K(n, n);
  std::vector<double> f(n);
  internal_force = 0.;
  if (tangent)
    *tangent = 0.;

  const auto begin_cell = [&]
  {
    K = 0.;
    std::fill(f.begin(), f.end(), 0.);
  };
  const auto at_point = [&](const MaterialLaw &law, const unsigned int q,
                            const Kinematics &at, PointInput &input,
                            const std::size_t history)
  {
    input.time_step = time_step;
    const PointResponse response =
        law.respond(input, history_.data() + history, next_history_.data() + history);
    const double w = weight(loop.values.quadrature_point(q)) * loop.values.JxW(q);
    const PointStress &s = response.stress;
    const PlaneVector S{s.xx, s.yy, s.xy};
    for (unsigned int i = 0; i < n; ++i)
      f[i] += w * dot(at.B[i], S);
    if (!tangent)
      return;
    for (unsigned int j = 0; j < n; ++j)
    {
      const PlaneVector CB = product(response.tangent, at.B[j]);
      for (unsigned int i = 0; i < n; ++i)
        K(i, j) += w * dot(at.B[i], CB);
      if (!law.is_finite_strain())
        continue;
      const Tensor<1, 2> &g = loop.values.shape_grad(j, q);
      const Tensor<1, 2> pull({S[0] * g[0] + S[2] * g[1], S[2] * g[0] + S[1] * g[1]});
      for (unsigned int i = 0; i < n; ++i)
        if (loop.component(i) == loop.component(j))
          K(i, j) += w * (loop.values.shape_grad(i, q) * pull);
    }
  };
  const auto end_cell = [&]
  {
    for (unsigned int i = 0; i < n; ++i)
      internal_force(loop.dofs[i]) += f[i];
    if (tangent)
      tangent->add(loop.dofs, K);
  };
  loop.run(begin_cell, at_point, end_cell);
  for (const auto &force : surface_forces_)
    force->add(displacement, internal_force, tangent);
  internal_force.compress(VectorOperation::add);
  if (tangent)
    tangent->compress(VectorOperation::add);

  if (springs_)
  {
    Vector of_springs = make_vector();
    springs_->vmult(of_springs, displacement);
    internal_force.add(1., of_springs);
    if (tangent)
      tangent->add(1., *springs_);
  }
}

std::vector<NonlinearSolid::PointState>
NonlinearSolid::point_states(const Vector &displacement, const double time_step) const
{
  CellLoop loop(*this, displacement);
  std::vector<PointState> states;
  std::vector<double> end;
  const auto nothing = [] {};
  loop.run(
      nothing,
      [&](const MaterialLaw &law, const unsigned int q, const Kinematics &at,
          PointInput &input, const std::size_t history)
      {
        input.time_step = time_step;
        end.resize(law.n_history());
        const PointStress S =
            law.respond(input, history_.data() + history, end.data()).stress;
        // Cauchy's is F S F^T / J; F and J are 1 at small strain.
        const auto &F = at.F;
        const auto push = [&](const unsigned int i, const unsigned int j)
        {
          return (F[i][0] * (S.xx * F[j][0] + S.xy * F[j][1]) +
                  F[i][1] * (S.xy * F[j][0] + S.yy * F[j][1])) /
                 at.J;
        };
        states.push_back({loop.values.quadrature_point(q), loop.values.JxW(q),
                          loop.material, at.strain,
                          PointStress{push(0, 0), push(1, 1), S.zz / at.J, push(0, 1)},
                          at.J, law.plastic_strain(end.data())});
      },
      nothing);
  return states;
}
} // namespace antiform::continuum
