#pragma once

#include "discrete/contacts.h"
#include "discrete/fractures.h"
#include "discrete/grains.h"
#include "discrete/joints.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// Two grains on either side of a fracture. Kinematics are total: with phi the mean
/// rotation of the two grains, n and t the fracture's normal and tangent turned by phi
/// and L the branch vector,
///   gap = L.n - distance,   shear = L.t - origin.
/// They vanish for rigid motions, and the plane turns with the sides that the grains
/// belong to. Force and torques derive from the potential of gap and shear, so that linear
/// and angular momentum are kept.
struct SmoothContact
{
  std::int32_t first = 0, second = 0; ///< second on the side that n points to
  std::int32_t fracture = 0;
  double normal_x = 0., normal_y = 0.; ///< in the reference section
  double distance = 0.;                ///< of the centres along n, stress-free [m]
  double origin = 0.;                  ///< L.t where it was made [m]
  double area = 0.;                    ///< its share of the fracture's length [m]
  double normal_stiffness = 0., shear_stiffness = 0.; ///< [Pa/m]

  // State.
  bool bonded = false;
  double slip = 0.;            ///< plastic part of the shear [m]
  double dilation = 0.;        ///< opening by slip [m]
  double gap = 0., shear = 0.; ///< at the last evaluation [m]
  double normal_stress = 0., shear_stress = 0.;  ///< [Pa]
  double slip_energy = 0., fracture_energy = 0.; ///< so far [J]
};

/// The fractures of a grain region and the pairs across them, in the order of fracture,
/// first, second.
struct SmoothJoints
{
  std::vector<Fracture> fractures;
  std::vector<double> area_ratio; ///< of each fracture: area of a pair over 2 min(R)
  /// E* by region and k_n/k_s, which give the stiffness of pairs that meet later [Pa].
  std::vector<double> modulus;
  double stiffness_ratio = 1.;

  // State.
  std::vector<SmoothContact> contacts;
  double lost_slip = 0., lost_fracture = 0.; ///< of pairs no longer listed [J]
};

/// A pair of grains that a fracture separates, with the stiffness of the joint it has
/// instead.
struct CrossedPair
{
  std::int32_t first, second;
  double stiffness; ///< k_n [Pa/m]
  double ratio;     ///< k_n / k_s [-]
};

/// Make smooth joints of @p pairs, each of which some fracture crosses; the grains stand
/// stress-free. The areas of a fracture's pairs add up to the length that they cover, so
/// that stiffness and strengths are those of the plane whatever the grains.
SmoothJoints make_smooth_joints(const Grains &grains,
                                std::vector<Fracture> fractures,
                                const std::vector<CrossedPair> &pairs);

/// Evaluate all and add to the grains' forces, in their order.
/// \param[in,out] cracks breaks of bonded joints are appended; null: none is tested
void add_smooth_joint_forces(Grains &grains,
                             SmoothJoints &joints,
                             const StepTime &now,
                             std::vector<Crack> *cracks);

/// Of the last evaluation, at the present positions [N].
Vec2 force_on_second(const Grains &grains, const SmoothContact &contact);

/// Strain energy, slip and fracture so far [J].
JointEnergies smooth_joint_energies(const SmoothJoints &joints);

/// Springs for the stable step: isotropic ones of the larger stiffness, which bound them.
std::vector<PairStiffness> pair_stiffness(const Grains &grains,
                                          const SmoothJoints &joints);

/// Candidate pairs of a contact search, as the fractures see them: pairs across one never
/// meet as round grains. Those that have come to overlap begin a smooth joint without
/// stress; those that have parted by more than @p margin [m] end theirs.
class SmoothJointSearch : public PairOwner
{
public:
  SmoothJointSearch(const Grains &grains, SmoothJoints &joints, double margin);
  bool takes(std::int32_t i, std::int32_t j) override;
  /// Put what is new in its place.
  void finish();

private:
  const Grains &grains_;
  SmoothJoints &joints_;
  std::vector<std::pair<std::int32_t, std::int32_t>> held_; ///< sorted
  std::vector<SmoothContact> born_;
};
} // namespace antiform::discrete
