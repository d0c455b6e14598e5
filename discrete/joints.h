#pragma once

#include "discrete/flat_joint.h"
#include "discrete/grains.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// A run of consecutive joints that obey one law: layer, interface, matrix.
struct JointGroup
{
  std::size_t begin = 0; ///< first joint
  std::size_t end = 0;   ///< one past the last
  FlatJoint law;
  int layer = 0; ///< region that a crack of this group is attributed to
  std::string name;
};

/// What a joint gives to its grains: force on the second grain (the first gets the
/// opposite) and the torque on each about its own centre.
struct JointForce
{
  double x, y;    ///< [N]
  double torque1; ///< on the first grain [N m]
  double torque2; ///< on the second grain [N m]
};

/// State of the elements of a joint that has lost at least one bond. An intact joint has
/// none: its forces follow from the displacements of its grains alone.
struct DamagedJoint
{
  std::size_t joint = 0;
  std::vector<Bond> bond;   ///< per element
  std::vector<double> slip; ///< plastic slip p per element: tau = k_s (u_s - p) [m]
  std::vector<double> shear_stress;  ///< force over full element area [Pa]
  std::vector<double> normal_stress; ///< mean over the full element [Pa]
  double gap = 0.;                   ///< at the last evaluation [m]
  double shear = 0.;                 ///< u_s at the last evaluation [m]
  double rotation = 0.;              ///< at the last evaluation [rad]
  double slip_energy = 0.;           ///< dissipated by sliding so far, weighted [J]
  double fracture_energy = 0.;       ///< lost with broken elements so far, weighted [J]
  bool removed = false;              ///< faces parted for good; contact may take over
  JointForce force{0., 0., 0., 0.};  ///< of the last evaluation
};

/// A bond that broke: one line of cracks.csv.
struct Crack
{
  std::uint64_t step = 0;
  double time = 0.;
  Vec2 place;              ///< centre of the element [m]
  Vec2 reference_place;    ///< the same in the reference section [m]
  double orientation = 0.; ///< of the crack's line, from x, in (-pi/2, pi/2] [rad]
  double length = 0.;      ///< [m]
  Bond mode = Bond::broken_in_tension;
  int layer = 0;
  std::size_t joint = 0;
  int element = 0;
};

/// Parallel arrays: entry j is joint j, an interface of two grains. Joints are numbered
/// once, when the scene is built, and summed in that order. The interface is placed where
/// the grains stand then, stress-free whether they overlap or leave a gap.
///
/// Kinematics are total, not incremental. With phi the mean rotation of the two grains,
/// n and t the installed normal and tangent turned by phi, L the branch vector,
/// theta = rotation_2 - rotation_1, d0 the installed distance:
///   gap   = L.n - d0 cos(theta/2),  shear = L.t - (r2 - r1) sin(theta/2).
/// They vanish for every rigid motion, do not depend on which end is first, and derive
/// from a potential when the forces act at the midpoint of the two faces.
struct Joints
{
  std::vector<std::int32_t> first;
  std::vector<std::int32_t> second;
  std::vector<double> normal_x; ///< installed unit normal, from first to second
  std::vector<double> normal_y;
  std::vector<double> length;           ///< d0: installed distance of the centres [m]
  std::vector<double> lever_difference; ///< r2 - r1: centre-to-face distances [m]
  std::vector<double> stiffness;        ///< k_n, stress per opening [Pa/m]
  std::vector<double> half_length;      ///< R of the interface [m]
  std::vector<double> weight; ///< bridging weight of force and energy [-]; empty: all 1
  /// Deformation that the prestress stands for; all three empty without prestress.
  std::vector<double> initial_gap;      ///< [m]
  std::vector<double> initial_shear;    ///< [m]
  std::vector<double> initial_rotation; ///< [rad]

  std::vector<JointGroup> groups; ///< cover all joints, in order

  // State.
  std::vector<std::int32_t> damage;  ///< index into damaged, or -1 while intact
  std::vector<DamagedJoint> damaged; ///< in the order in which they lost their first bond
  std::vector<unsigned char> would_break; ///< unbreakable joints that exceeded a strength

  // Result of a step.
  std::vector<JointForce> force;

  // Sum order: the joints of grain i are grain_joint[grain_begin[i]] up to
  // grain_begin[i + 1]; those whose second grain it is begin at grain_second[i]. Both
  // parts ascend.
  std::vector<std::int32_t> grain_begin;
  std::vector<std::int32_t> grain_second;
  std::vector<std::int32_t> grain_joint;

  std::size_t size() const { return first.size(); }
  const JointGroup &group_of(std::size_t joint) const;

  /// Bond grains @p i and @p j where they stand (gap or overlap alike), stress-free.
  /// Appends to the last group. The stiffness of two different moduli is that of two
  /// springs in series: k_n = 1 / (R_i / E_i + R_j / E_j).
  void add(const Grains &grains,
           std::int32_t i,
           std::int32_t j,
           double modulus_i,
           double modulus_j);
  /// Start a new group; later add() go to it.
  void begin_group(const FlatJoint &law, int layer, const std::string &name);
  /// Build the sum order. Call once, after the last add().
  void finish(std::size_t n_grains);
};

/// Deformation of joint @p j for the present displacements, prestress included.
struct JointDeformation
{
  double gap = 0.;      ///< at the joint's centre [m]
  double shear = 0.;    ///< u_s [m]
  double rotation = 0.; ///< theta_b [rad]
};
JointDeformation deformation(const Grains &grains, const Joints &joints, std::size_t j);

/// Where in time a force evaluation stands.
struct StepTime
{
  std::uint64_t step = 0;
  double time = 0.; ///< of the positions [s]
  double dt = 0.;   ///< that led from the last positions to these [s]
};

/// The full law for every joint that was damaged before this step: friction, closing and
/// opening, further breaks. Results stay in the records until sum_joint_forces().
/// \param[in,out] new_cracks breaks are appended in order of damage; null: none is tested
void evaluate_broken_joints(const Grains &grains,
                            Joints &joints,
                            const StepTime &now,
                            std::vector<Crack> *new_cracks);

/// The vector kernel of this processor for all joints, and the first break of those that
/// are over a strength.
/// \param[in,out] new_cracks breaks of this step are appended, in joint and element
/// order;
///                null: strengths are not looked at (equilibration).
void evaluate_bonds(const Grains &grains,
                    Joints &joints,
                    const StepTime &now,
                    std::vector<Crack> *new_cracks);

/// Set the grains' forces to the sums of their joints' forces. Every grain sums its
/// joints in their order, so the result has the same bits for any number of threads.
void sum_joint_forces(Grains &grains, Joints &joints);

/// The three above in their order.
void compute_joint_forces(Grains &grains,
                          Joints &joints,
                          const StepTime &now,
                          std::vector<Crack> *new_cracks);

/// Energies of the joints at the present state, weighted [J].
struct JointEnergies
{
  double strain = 0.;
  double slip = 0.;     ///< dissipated so far
  double fracture = 0.; ///< lost with broken elements so far
};
JointEnergies joint_energies(const Grains &grains, const Joints &joints);

/// \param weighted use the bridging weights (stable step), or not (density scaling)
StiffnessSums stiffness_sums(const Grains &grains, const Joints &joints, bool weighted);

/// Rigorous stable step of leapfrog, 2 / omega_max, for the joints and the grains'
/// present inverse masses: element-wise bound (Irons' theorem), the inertia of a grain
/// shared among its joints in proportion to their weighted stiffness. @p extra: further
/// springs to the ground on the grains' translation (walls, supports) [N/m]; empty: none.
/// No safety factor.
double stable_step(const Grains &grains,
                   const Joints &joints,
                   const std::vector<double> &extra = {});

/// Break element @p element of joint @p joint by decree, whatever it carries (tests,
/// pre-cracked layers). Its energy goes to the fracture sink.
void break_element(
    const Grains &grains, Joints &joints, std::size_t joint, int element, Bond mode);

/// Name of the vector level that the joint kernel uses on this processor (baseline,
/// x86_64_v3, x86_64_v4). All levels give the same bits.
std::string joint_kernel_level();

/// Joints between all pairs whose gap is at most @p installation_gap [m] and that are in
/// the regions @p region_i and @p region_j (in either order), as a sorted list of pairs
/// (smaller number first).
std::vector<std::pair<std::int32_t, std::int32_t>>
pairs_within(const Grains &grains, double installation_gap, int region_i, int region_j);
} // namespace antiform::discrete
