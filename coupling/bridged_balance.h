#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/constrained_inverse.h"
#include "coupling/held_dynamics.h"
#include "coupling/mesh_components.h"
#include "coupling/walled_grains.h"

#include <optional>
#include <string>
#include <vector>

namespace antiform::coupling
{
/// Grains and mesh that share their energy in an overlap, between walls, in balance
/// (docs/theory/quasi_static_driver.md, 8). The unknowns are those of WalledGrains, then
/// the dofs of the mesh. Every move keeps the constraint of the bridging domain, and what
/// is out of balance is the constrained force r = f - C^T L: at rest f itself is not 0
/// where there are multipliers. The operator is the stiffness of intact grains and of the
/// mesh at rest, factorised apart, on the displacements that keep the constraint.
class BridgedBalance : public BalanceOperator
{
public:
  /// \param state,mesh,domain referred to. Their masses become, for good, those of
  ///               explicit motion under held supports; the domain is factorised for
  ///               them. Dofs of the mesh that belong to a wall (MeshState::prescribe) go
  ///               with it, others that are prescribed are held
  /// \param walls  as WalledGrains wants them; none that a load moves
  /// Throws std::invalid_argument for a grain of the overlap that cannot move (held, or
  /// without a joint) and for a wall under a load; NumericalError as ConstrainedInverse.
  BridgedBalance(GrainState &state,
                 std::vector<BearingWall> walls,
                 const std::vector<PrescribedMotion> &held,
                 MeshState &mesh,
                 BridgingDomain &domain);

  BridgedBalance(const BridgedBalance &) = delete; // its operator refers to it

  Eigen::Index n_unknowns() const override { return levers_.size(); }
  const Eigen::VectorXd &residual() override;
  /// The larger mean of grains and of mesh, the largest of both.
  BalanceRatios ratios() const override;
  double conjugate_force() const override;
  Eigen::VectorXd correction(const Eigen::VectorXd &r) override
  {
    return inverse_->solve(r);
  }
  const Eigen::VectorXd &tangent() const override { return tangent_; }
  void move(const Eigen::VectorXd &increment) override;
  double load_work(const Eigen::VectorXd &increment) const override;
  double deformation(const Eigen::VectorXd &increment, double negligible) const override;
  const Eigen::VectorXd &levers() const override { return levers_; }
  void add_energies(Energies &energies) const override;

  /// Constrained forces of grains and mesh at the present displacements; what acts on
  /// prescribed dofs of the mesh is left in their reactions.
  void add_forces(const discrete::StepTime &now,
                  std::vector<discrete::Crack> *cracks,
                  bool keep_forces);
  /// Explicit damped motion from rest under held supports, as settle() of grains.
  HeldResult settle(const HeldDynamics &settings, const RestGoal &goal);

  /// As WalledGrains has them. A state is loaded after the arrays of grains and mesh.
  void find_contacts(double reach, const std::vector<double> &modulus);
  void visit_state(StateArchive &archive);

  WalledGrains &grains() { return grains_; }
  const WalledGrains &grains() const { return grains_; }
  /// Displacement gap of the constraint at present [m].
  double gap() const;

private:
  void refuse_what_cannot_be();
  void assemble_mesh();
  void assemble();
  Eigen::SparseMatrix<double, Eigen::RowMajor> constraint() const;
  void scale_masses();
  void add_mesh_forces();
  Eigen::Index unknown(const std::size_t mesh_dof) const
  {
    return grains_.n_unknowns() + static_cast<Eigen::Index>(mesh_dof);
  }
  Eigen::Index n_mesh() const { return n_unknowns() - grains_.n_unknowns(); }
  std::string name(Eigen::Index unknown) const;

  std::vector<OperatorSpring> grain_pins_;
  WalledGrains grains_;
  MeshState &mesh_;
  BridgingDomain &domain_;
  std::vector<double> mesh_rate_; ///< of prescribed dofs, in their order [m]
  std::vector<ConstrainedInverse::Pin> mesh_pins_;
  std::optional<ElasticFactor> mesh_factor_;
  Eigen::VectorXd mesh_tangent_; ///< of the mesh with its pins
  std::optional<ConstrainedInverse> inverse_;
  Eigen::VectorXd is_prescribed_, levers_, residual_, tangent_;
};
} // namespace antiform::coupling
