#pragma once

#include "coupling/elastic_factor.h"
#include "coupling/grain_components.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <array>
#include <optional>
#include <vector>

namespace antiform::coupling
{
/// How far a body is from balance, by the unbalanced forces on its free degrees of
/// freedom. Torques count as forces at the rim of their grain.
struct BalanceRatios
{
  /// Their mean over the mean force of a joint, or over a twentieth of the largest that
  /// this has been, where joints carry less: rubble carries next to nothing [-].
  double mean = 0.;
  double largest = 0.;     ///< their largest over the same [-]
  double of_strength = 0.; ///< their largest over what an element carries when it breaks
                           ///< in tension, in the mean of the breakable joints [-]
  bool within(const BalanceRatios &limits) const
  {
    return mean < limits.mean && largest < limits.largest &&
           of_strength < limits.of_strength;
  }
};

class GrainBalance;

/// What a quasi-static driver needs of a body: the exact unbalanced force at the
/// present state, and a symmetric elastic operator, no softer than the body, to correct
/// it with. The vectors have an entry for each of its unknowns, prescribed ones
/// included; what they mean is the body's business. A body of grains, mesh and bridging
/// domain has its saddle point inside correction().
class BalanceOperator
{
public:
  virtual ~BalanceOperator() = default;

  virtual Eigen::Index n_unknowns() const = 0;
  /// Unbalanced force [N], [N m]: external minus internal, 0 where motion is
  /// prescribed. History (slip) is committed; no bond is tested.
  virtual const Eigen::VectorXd &residual() = 0;
  /// Of the last residual().
  virtual BalanceRatios ratios() const = 0;
  /// Force conjugate to the load parameter, that is, the work per unit of it that the
  /// prescribed motion does at the last residual() [J].
  virtual double conjugate_force() const = 0;
  /// Correction for the unbalanced force @p r: the operator's, to a hundredth of it in
  /// the norm of energy; 0 where motion is prescribed.
  virtual Eigen::VectorXd correction(const Eigen::VectorXd &r) = 0;
  /// Motion per unit of the load parameter: prescribed, and what follows elastically.
  virtual const Eigen::VectorXd &tangent() const = 0;
  /// Add @p increment to the displacements.
  virtual void move(const Eigen::VectorXd &increment) = 0;
  /// Work of the constant loads in such a move [J].
  virtual double load_work(const Eigen::VectorXd &increment) const = 0;
  /// Largest deformation of a joint in a move, over sigma_b / k_n [-]; where it is at
  /// most @p negligible, anything up to that.
  virtual double deformation(const Eigen::VectorXd &increment,
                             double negligible) const = 0;
  /// Lengths that turn the unknowns into displacements: 1, or radii of grains [m].
  virtual const Eigen::VectorXd &levers() const = 0;
  /// Add what is stored beside the joints and the walls' contacts: in a mesh.
  virtual void add_energies(Energies &) const {}
  /// The same body where it is nothing but grains, parts of which can be balanced apart;
  /// null otherwise.
  virtual GrainBalance *grains_alone() { return nullptr; }
};

/// A prescribed displacement (component 0, 1) or rotation (2) of a grain.
struct PrescribedMotion
{
  std::int32_t grain = 0;
  unsigned int component = 0;
  double rate = 0.; ///< per unit of the load parameter [m] or [rad]; 0: held
};

/// A spring of the operator, not of the body, from a grain to the ground: for who takes
/// it off again, since the grains alone would be loose (BridgedBalance).
struct OperatorSpring
{
  std::int32_t grain = 0;
  unsigned int component = 0; ///< 0: x, 1: y, 2: rotation
  double stiffness = 0.;      ///< [N/m], [N m]
};

/// Bonded grains in balance. Unknown 3 i + c is component c of grain i. The operator is
/// the stiffness of the material as it was made, all bonds whole, weighted as the
/// joints are: an upper bound of the damaged one, friction included, so that each
/// correction descends.
class GrainBalance : public BalanceOperator
{
public:
  /// \param state      referred to; no joint of a brittle law, no prestress loads but
  ///                   those in @p loads
  /// \param loads      constant (dead) loads on grains
  /// Grains without any joint are held. Throws NumericalError when the operator is
  /// singular, std::invalid_argument for a load on a grain without joints.
  GrainBalance(GrainState &state,
               const std::vector<PrescribedMotion> &prescribed,
               std::vector<GrainLoad> loads = {});

  Eigen::Index n_unknowns() const override { return prescribed_.size(); }
  const Eigen::VectorXd &residual() override;
  BalanceRatios ratios() const override { return ratios_with(0.); }
  /// Of unbalanced forces, their mean and largest [N], over what the joints carry.
  BalanceRatios over_joint_forces(double mean, double largest) const;
  double conjugate_force() const override;
  /// Correction by the operator itself.
  Eigen::VectorXd solve(const Eigen::VectorXd &r) const;
  /// In single precision where that leaves less than a hundredth of an error.
  Eigen::VectorXd correction(const Eigen::VectorXd &r) override;
  const Eigen::VectorXd &tangent() const override { return tangent_; }
  void move(const Eigen::VectorXd &increment) override;
  double load_work(const Eigen::VectorXd &increment) const override;
  double deformation(const Eigen::VectorXd &increment, double negligible) const override;
  const Eigen::VectorXd &levers() const override { return levers_; }
  GrainBalance *grains_alone() override { return this; }

  /// Forces of joints and loads at the present displacements, into the grains; what
  /// acts on prescribed components is taken off them: it is the supports'. \param
  /// cracks      bonds break and are appended; null: none is tested \param keep_forces
  /// of joints, for ratios()
  void add_forces(const discrete::StepTime &now,
                  std::vector<discrete::Crack> *cracks,
                  bool keep_forces);
  /// Work of the constant loads from the reference to the present place [J].
  double load_potential() const;
  /// Springs to the ground beside the joints, by grain [N/m]; empty: none.
  virtual std::vector<double> ground_stiffness() const { return {}; }

  bool is_prescribed(const Eigen::Index unknown) const
  {
    return prescribed_[unknown] > 0.;
  }
  // Of a part of the body that is balanced apart (LocalMoves):
  /// The operator, lower triangle; identity where motion is prescribed.
  const Eigen::SparseMatrix<double> &matrix() const { return matrix_; }
  /// 1 where motion is prescribed, else 0.
  const Eigen::VectorXd &prescribed() const { return prescribed_; }
  /// Constant loads by unknowns [N], [N m].
  const Eigen::VectorXd &dead_loads() const { return dead_loads_; }
  /// Unbalanced force at which the largest one reaches a limit, at the last residual()
  /// [N].
  double allowed_force(const BalanceRatios &limits) const;
  /// Add to @p force, three entries a grain, what acts on the first @p n of @p grains
  /// beside joints and constant loads. \param local number in @p grains of each grain of
  /// the body, or -1
  virtual void add_outer_forces_on(const discrete::Grains &grains,
                                   const std::vector<std::int32_t> &local,
                                   std::size_t n,
                                   Eigen::VectorXd &force) const;

  GrainState &state() { return state_; }
  const GrainState &state() const { return state_; }

protected:
  /// With @p n_more unknowns behind those of the grains, free at first; assemble() is
  /// left to do.
  GrainBalance(GrainState &state,
               const std::vector<PrescribedMotion> &prescribed,
               std::vector<GrainLoad> loads,
               std::size_t n_more,
               std::vector<OperatorSpring> operator_springs = {});
  /// Operator and tangent. \param springs entries beside the joints', both triangles,
  /// rows and columns of prescribed unknowns too
  void assemble(const std::vector<Eigen::Triplet<double>> &springs = {});
  /// Forces on the grains beside those of joints and loads; called by add_forces().
  virtual void add_outer_forces() {}
  /// ratios() with @p further [N], an unbalanced force that is not a grain's.
  BalanceRatios ratios_with(double further) const;

  Eigen::VectorXd prescribed_; ///< 1 where motion is prescribed, else 0
  Eigen::VectorXd rate_, residual_, support_;
  double most_carried_ = 0.; ///< largest mean force of a joint so far [N]; state

private:
  /// What unbalanced forces are compared with [N].
  double reference_force() const;

  GrainState &state_;
  std::vector<GrainLoad> loads_;
  std::vector<OperatorSpring> operator_springs_;
  double carried_ = 0.; ///< mean force of a joint when forces were last kept [N]
  double element_strength_ = 0.; ///< mean, weighted; 0: nothing breaks [N]
  /// Largest deformation of a joint over sigma_b / k_n for a displacement of 1 [1/m].
  double most_deformation_ = 0.;
  Eigen::VectorXd levers_, tangent_, dead_loads_;
  Eigen::SparseMatrix<double> matrix_;
  std::optional<ElasticFactor> factor_;
  /// Of the present factor, at its first correction: grains of a BridgedBalance have none.
  bool is_precision_chosen_ = false;
};
} // namespace antiform::coupling
