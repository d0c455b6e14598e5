#pragma once

#include "continuum/elastic_solid.h"
#include "continuum/finite_strain_law.h"

#include <array>
#include <cstdint>
#include <vector>

namespace antiform::continuum
{
/// An elastic body whose strains and rotations may be large, for steps in time
/// (docs/theory/finite_strain_in_time.md): exact forces, energy and states of
/// FiniteStrainLaw in each material, weighted as those of the linear body. What it
/// inherits else (stiffness(), mass, geometric stiffness) is that at rest.
class FiniteStrainSolid : public ElasticSolid
{
public:
  /// Parameters as of ElasticSolid. Throws as FiniteStrainLaw for a material.
  FiniteStrainSolid(const dealii::parallel::distributed::Triangulation<2> &triangulation,
                    std::vector<ElasticMaterial> materials,
                    unsigned int degree,
                    std::function<double(const dealii::Point<2> &)> weight = {},
                    FiniteElasticity form = FiniteElasticity::semi_linear);

  /// Forces are not those of the matrix: springs are for components of their own.
  void add_to_stiffness(const dealii::TrilinosWrappers::SparseMatrix &) = delete;

  /// Add -integral w_C B^T S to @p force (owned entries). @p displacement must have its
  /// ghosts set. Throws NumericalError on all ranks where a cell is turned inside out.
  /// Uses OpenMP; sums over a node's cells in a fixed order. Collective.
  void add_internal_force(const Vector &displacement, Vector &force) const override;
  /// integral w_C psi over this rank's cells [J]. Throws NumericalError of the law, on
  /// this rank, where det C <= 0.
  double strain_energy_share(const Vector &displacement) const override;
  /// Green-Lagrange strain of the cell's mean displacement gradient, Cauchy's stress and
  /// the rotation (of the polar decomposition) there.
  std::vector<CellState> cell_states(const Vector &displacement) const override;

  /// sum_K |K_JK| over a node's 2x2 blocks of the tangent, their spectral norm, for both
  /// dofs of the node: at rest, and at a displacement (ghosts set) [N/m]. They do not
  /// change as the body turns. Throw as add_internal_force(). Collective.
  Vector absolute_row_sums() const override;
  Vector absolute_row_sums(const Vector &displacement) const;
  using ElasticSolid::stable_step;
  /// Rigorous stable step of the body's tangent at @p displacement: omega^2 <= max over
  /// nodes of the row sums / M_J, the circles of Gershgorin in blocks. @p extra: sums of
  /// further springs by local dof [N/m], or empty. Collective.
  double stable_step(const Vector &displacement,
                     const Vector &inverse_mass,
                     const std::vector<double> &extra = {}) const;
  /// Length of the shortest edge of a cell, at rest [m]. Collective.
  double smallest_edge() const;

private:
  /// Gradient of the displacement, xy = du_x / dy.
  struct Gradient
  {
    double xx = 0., xy = 0., yx = 0., yy = 0.;
  };
  /// Place [-] of a quadrature point in the arrays.
  std::size_t point(std::size_t cell, std::size_t q) const
  {
    return cell * n_points_ + q;
  }

  void lay_out_cells();
  void lay_out_nodes();
  Gradient gradient(std::size_t point, const std::vector<double> &u) const;
  void nodal(std::size_t cell, const double *displacement, std::vector<double> &u) const;
  /// Forces of one cell's nodes into its part of cell_force_.
  /// \return false for a cell that is turned inside out
  bool
  evaluate(std::size_t cell, const double *displacement, std::vector<double> &u) const;
  /// Blocks K_JK of one cell, node by node, xx xy yx yy.
  /// \return as evaluate()
  bool tangent(std::size_t cell,
               const double *displacement,
               std::vector<double> &u,
               double *blocks) const;
  /// Throw on all ranks the smallest volume ratio, one of @p displacement being <= 0.
  [[noreturn]] void refuse(const Vector &displacement) const;

  std::vector<FiniteStrainLaw> laws_; ///< by material id
  std::size_t n_points_;              ///< of a cell, and its nodes: (degree + 1)^2
  std::size_t n_owned_cells_ = 0;     ///< these come first, then the ghosts
  // Of each cell: material, local numbers of its nodes (half that of the x dof); of each
  // of its points the weighted area and, for each node, the gradient of N there.
  std::vector<std::uint8_t> material_of_;
  std::vector<std::uint32_t> nodes_;
  std::vector<double> weighted_area_, shape_gradient_;
  std::vector<dealii::Point<2>> centre_;
  /// Owned node J belongs to the corners corner_[start_[J]] ... of cells, numbered
  /// cell * n_points_ + k, in the order of cells.
  std::vector<std::size_t> start_, corner_;
  mutable std::vector<double> cell_force_; ///< scratch: x, y by corner [N]
};
} // namespace antiform::continuum
