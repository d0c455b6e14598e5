#pragma once

#include "continuum/displacement_space.h"

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/types.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace antiform::continuum
{
/// Plane-strain linear elastic material: in-plane stiffness in Voigt order
/// (xx, yy, xy with engineering shear) [Pa], bulk density [kg/m^3].
struct ElasticMaterial
{
  std::array<std::array<double, 3>, 3> stiffness{};
  double density = 0.;
  std::string name;

  static ElasticMaterial isotropic(double young_modulus,
                                   double poisson_ratio,
                                   double density,
                                   const std::string &name = "");
};

/// Small-strain elastic body. Stiffness, mass and loads carry the weight w_C(x) of the
/// bridging domain where one is given. A body of finite strain (FiniteStrainSolid) is one
/// with other forces, energies and states; stiffness() is then that at rest.
class ElasticSolid : public DisplacementSpace
{
public:
  /// \param materials indexed by the cells' material id
  /// \param weight    w_C at a point, evaluated at quadrature points; empty: 1 everywhere
  ElasticSolid(const dealii::parallel::distributed::Triangulation<2> &triangulation,
               std::vector<ElasticMaterial> materials,
               unsigned int degree,
               std::function<double(const dealii::Point<2> &)> weight = {});

  virtual ~ElasticSolid() = default;

  const std::vector<ElasticMaterial> &materials() const { return materials_; }

  /// System matrix K = integral w_C B^T C B, without boundary conditions [N/m].
  const dealii::TrilinosWrappers::SparseMatrix &stiffness() const { return stiffness_; }
  /// Geometric stiffness integral w_C grad N_a . S grad N_b of a uniform initial stress
  /// (tension positive) [N/m]; same sparsity as stiffness().
  dealii::TrilinosWrappers::SparseMatrix
  geometric_stiffness(const dealii::SymmetricTensor<2, 2> &initial_stress) const;
  /// The same of the stress that @p displacement (ghosts set) makes in the materials.
  dealii::TrilinosWrappers::SparseMatrix
  geometric_stiffness(const Vector &displacement) const;
  /// Lumped mass (Gauss-Lobatto points, so positive for Q2 too), weighted: w_C rho [kg].
  /// Throws std::invalid_argument on a mesh with hanging nodes, which have no mass of
  /// their own: motion in time is for meshes without.
  const Vector &lumped_mass() const;

  /// Add -K u to @p force (owned entries), also of hanging nodes. @p displacement must
  /// have its ghosts set. Uses OpenMP; each row is summed in a fixed order.
  virtual void add_internal_force(const Vector &displacement, Vector &force) const;
  /// Add to K and to the rows of add_internal_force() a spring on a boundary: foundation.
  void add_to_stiffness(const dealii::TrilinosWrappers::SparseMatrix &matrix);

  /// Rigorous stable step of the unconstrained body for given inverse masses (0 where the
  /// motion is prescribed): 2 / omega, omega^2 <= max over rows of sum |K_JK| / M_J. No
  /// safety factor. Collective.
  double stable_step(const Vector &inverse_mass) const;
  /// Row sums sum_K |K_JK| (owned entries) [N/m].
  virtual Vector absolute_row_sums() const;

  /// Strain (xx, yy, xy-engineering) and stress (initial stress not included) averaged
  /// over each active locally owned cell, in cell order.
  struct CellState
  {
    std::array<double, 3> strain, stress;
    double rotation; ///< of the mean displacement gradient [rad]
    double area;     ///< [m^2]
    double weight;   ///< mean w_C [-]
    unsigned int material;
  };
  virtual std::vector<CellState> cell_states(const Vector &displacement) const;

  /// 1/2 u.K u, foundation included [J]: this rank's rows of it, and all; all is
  /// collective.
  virtual double strain_energy_share(const Vector &displacement) const;
  double strain_energy(const Vector &displacement) const;

protected:
  /// Throws std::invalid_argument for an id without one.
  const ElasticMaterial &material(dealii::types::material_id id) const;

private:
  /// A rank's rows of K in blocks of one node: two rows (x, y) and two columns, since the
  /// two dofs of a node are neighbours. Columns are local node numbers (owned nodes, then
  /// ghosts), in ascending global order, which is the order of summation.
  struct NodeRows
  {
    std::vector<std::size_t> start; ///< node r has blocks start[r] ... start[r+1]
    std::vector<unsigned int> column;
    std::vector<std::array<double, 4>> block; ///< xx, xy, yx, yy [N/m]
  };

  void assemble_stiffness();
  /// \param stress of (cell, its FEValues, quadrature point)
  template <class Stress>
  dealii::TrilinosWrappers::SparseMatrix
  geometric_stiffness_of(const Stress &stress) const;
  void assemble_mass();
  void build_rows();

  std::vector<ElasticMaterial> materials_;
  dealii::TrilinosWrappers::SparseMatrix stiffness_;
  Vector lumped_mass_;
  NodeRows rows_;
};
} // namespace antiform::continuum
