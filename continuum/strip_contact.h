#pragma once

#include "continuum/contact_laws.h"
#include "continuum/loads.h"
#include "continuum/surface_force.h"

#include <functional>
#include <vector>

namespace antiform::continuum
{
/// Touch of the strips whose faces lie on one another without being joined
/// (section_mesh.h), by a law of opening and slip at points along each pair of faces. A
/// pair stays one: slip must be small compared with a face (relative_slip()), rotation
/// may be of any size. Penalty, not multipliers: sides in touch give way by traction over
/// stiffness (contact_stiffness()).
///
/// Opening and slip are those of u(upper) - u(lower) in the frame of the surface midway
/// between the sides, which turns with them; forces and tangent are the exact first and,
/// with the law's, second derivatives. So rigid motion changes nothing, and moments
/// balance as forces do. Tractions are per length of the reference interface.
class StripContact : public SurfaceForce
{
public:
  struct Options
  {
    /// Of a body that was laid down in touch: what the upper side does to the lower one
    /// at gap 0 by place, S0 n for the normal n from the lower to the upper side [Pa],
    /// asked once. Empty: 0.
    Traction initial_traction;
    /// Whether the pair of faces with this middle is of this contact; empty: all are.
    std::function<bool(const dealii::Point<2> &)> is_included;
    /// Gauss points of a face, each open or closed by itself; 0: degree + 3. Degree + 1
    /// are exact where all of a face is closed; more let Newton's method find faster what
    /// is.
    unsigned int points_per_face = 0;
  };

  /// The space must outlive the contact; add it to the body (NonlinearSolid::add()).
  /// Throws std::invalid_argument on all ranks for a face without partner, stiffnesses
  /// that are not > 0, friction or cohesion below 0, and an initial traction that the law
  /// does not carry.
  StripContact(const DisplacementSpace &space,
               const ContactLaw &law,
               const Options &options);

  bool has_symmetric_tangent() const override;
  std::vector<DofGroup> couplings() const override;
  void add(const Vector &displacement,
           Vector &internal_force,
           dealii::TrilinosWrappers::SparseMatrix *tangent) override;
  void accept() override { slip_at_rest_ = next_slip_at_rest_; }
  std::vector<double> *history() override { return &slip_at_rest_; }

  struct PointState
  {
    dealii::Point<2> place;      ///< in the reference body [m]
    double length;               ///< of the reference interface that it stands for [m]
    dealii::Tensor<1, 2> normal; ///< now, from the lower to the upper side
    ContactGap gap;
    ContactTraction traction;
    ContactPhase phase;
  };
  /// At the points of this rank, after a step from the last accepted one; changes
  /// nothing.
  std::vector<PointState> point_states(const Vector &displacement) const;

  /// Greatest |slip| over the length of its face, of all ranks [-]. The pairing errs by a
  /// share of this size where pressure or curvature change from face to face; beyond some
  /// 0.3 take larger cells or another model.
  double relative_slip(const Vector &displacement) const;

private:
  /// A face of the lower side with its partner. Nodes go along the tangent.
  struct Pair
  {
    DofGroup dofs; ///< of the lower side then of the upper, node by node, x then y
    dealii::Point<2> start;
    dealii::Tensor<1, 2> along; ///< from the first vertex to the second [m]
  };
  struct Kinematics;
  class Side;

  void check(const ContactLaw &law) const;
  void find_pairs(const Options &options);
  void lay_out_points(const Options &options);
  ContactResponse respond(const ContactGap &gap, std::size_t point) const;

  const DisplacementSpace &space_;
  ContactLaw law_;
  std::vector<Pair> pairs_; ///< of the lower faces in this rank's cells
  /// Gauss points along a face: place in [0, 1], weight, and shape functions of the nodes
  /// with their derivatives.
  std::vector<double> places_, weights_;
  std::vector<std::vector<double>> shape_, slope_;
  /// One entry a point, pair by pair.
  std::vector<ContactTraction> initial_;
  std::vector<double> slip_at_rest_, next_slip_at_rest_;
};
} // namespace antiform::continuum
