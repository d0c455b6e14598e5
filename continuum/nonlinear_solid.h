#pragma once

#include "continuum/displacement_space.h"
#include "continuum/material_law.h"
#include "continuum/surface_force.h"

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <functional>
#include <memory>
#include <vector>

namespace antiform::continuum
{
/// How strain follows from displacements.
enum class StrainForm
{
  displacement, ///< theirs; Q1 cells lock as the volume resists, Q2 cells do not
  /// B-bar (Hughes 1980) for Q1 cells at small strain: the dilatation e_xx + e_yy is the
  /// cell's mean, half of the difference going to either normal strain so that e_zz
  /// stays 0. Never locks.
  mean_dilatation
};

/// A body whose materials are laws, which may remember, in plane strain. Where a law is
/// of finite strain the cell's description is total Lagrangian: integrals over the
/// reference body, Green-Lagrange strain and second Piola-Kirchhoff stress (Bonet & Wood
/// 2008); else strain is small. Internal forces carry the weight w_C.
class NonlinearSolid : public DisplacementSpace
{
public:
  using Laws = std::vector<std::shared_ptr<const MaterialLaw>>;

  struct Options
  {
    unsigned int degree = 2;
    StrainForm strain_form = StrainForm::displacement;
    /// Stress at strain 0 by place [Pa], asked once; of finite strain second
    /// Piola-Kirchhoff's. Empty: none.
    std::function<PointStress(const dealii::Point<2> &)> initial_stress;
    std::function<double(const dealii::Point<2> &)> weight; ///< w_C; empty: 1
    bool allow_locking = false; ///< Q1 cells whatever the Poisson's ratio
  };

  /// \param laws indexed by the cells' material id
  /// Throws std::invalid_argument on all ranks where a cell of the mesh is inverted or
  /// has no law, and for a form that locks or is not for these cells: Q1 with a law that
  /// answers at first like a Poisson's ratio of 0.45 or more. Collective, as all that
  /// follows.
  NonlinearSolid(const dealii::parallel::distributed::Triangulation<2> &triangulation,
                 Laws laws,
                 const Options &options);

  bool has_symmetric_tangent() const;

  /// Add linear springs to the body, of the form of make_matrix() [N/m]: a foundation.
  void add_springs(const dealii::TrilinosWrappers::SparseMatrix &springs);
  /// Add forces on the surface: a base that does not pull, the touch of strips. Before
  /// vectors and matrices of the body are made, and what holds some (LoadedSolid,
  /// NewtonSolver): assemble() throws std::invalid_argument for a displacement that does
  /// not know the dofs in touch.
  void add(std::shared_ptr<SurfaceForce> force);

  /// \param displacement   at the end of the step, ghosts set [m]
  /// \param time_step      [s]; 0 in problems without time
  /// \param internal_force f = integral B^T S (owned entries): what the nodes must be
  ///                       pushed with to stay there [N]
  /// \param tangent        df/du, consistent with the laws' updates [N/m]; may be null
  /// History at the end of the step is kept until the next call or accept(). Throws
  /// NumericalError on all ranks where a cell is turned inside out or a law has no
  /// answer; the former history is then still there.
  void assemble(const Vector &displacement,
                double time_step,
                Vector &internal_force,
                dealii::TrilinosWrappers::SparseMatrix *tangent);
  /// The step that was assembled last is done: its history is where the next begins.
  void accept();

  /// Numbers that the quadrature points of this rank remember from the last accepted
  /// step, cell by cell and point by point: what a checkpoint must hold, with the
  /// histories of surface forces.
  std::vector<double> &history() { return history_; }

  struct PointState
  {
    dealii::Point<2> place; ///< in the reference body [m]
    double area;            ///< of the reference body [m^2]
    dealii::types::material_id material;
    PlaneVector strain;    ///< as the law gets it
    PointStress stress;    ///< Cauchy's, with the initial one [Pa]
    double volume_ratio;   ///< J; 1 at small strain
    double plastic_strain; ///< equivalent [-]
  };
  /// Of the quadrature points in this rank's cells, after a step of @p time_step from the
  /// accepted history. Throws as assemble(); changes nothing.
  std::vector<PointState> point_states(const Vector &displacement,
                                       double time_step = 0.) const;

private:
  struct Kinematics;
  class CellLoop;

  void check_laws(const Options &options) const;
  void lay_out_points(const Options &options);
  const MaterialLaw &law(dealii::types::material_id id) const { return *laws_[id]; }

  Laws laws_;
  bool mean_dilatation_;
  /// Of the points of this rank's cells, in cell order: initial stress (empty: none), and
  /// where the history of a cell's first point begins (one entry a cell).
  std::vector<PointStress> initial_stress_;
  std::vector<std::size_t> history_start_;
  std::vector<double> history_, next_history_;
  std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> springs_;
  std::vector<std::shared_ptr<SurfaceForce>> surface_forces_;
};
} // namespace antiform::continuum
