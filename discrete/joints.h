#pragma once

#include "discrete/bond_laws.h"
#include "discrete/grains.h"
#include "discrete/linear_contact.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace antiform::discrete
{
/// A run of consecutive joints that obey one law: layer, interface, matrix.
struct JointGroup
{
  std::size_t begin = 0; ///< first joint
  std::size_t end = 0;   ///< one past the last
  JointLaw law;
  int layer = 0; ///< region that a crack of this group is attributed to
  std::string name;

  /// The law of a group of flat joints. \pre it is one
  const FlatJoint &flat() const { return std::get<FlatJoint>(law); }
};

/// What a joint gives to its grains: force on the second grain (the first gets the
/// opposite) and the torque on each about its own centre.
struct JointForce
{
  double x, y;    ///< [N]
  double torque1; ///< on the first grain [N m]
  double torque2; ///< on the second grain [N m]
};

/// State of the elements of joints that have lost at least one bond, in the order in
/// which they lost the first. An intact joint has none: its forces follow from the
/// displacements of its grains alone. Parallel arrays: entry k is damaged joint k. They
/// are filled up to a whole number of four joints, the lanes of the kernel, with joints
/// that are removed.
struct DamagedJoints
{
  std::vector<std::int32_t> joint;
  std::vector<std::int32_t> group;
  std::vector<unsigned char> removed;  ///< faces parted for good; contact may take over
  std::vector<double> gap;             ///< at the last evaluation [m]
  std::vector<double> shear;           ///< u_s at the last evaluation [m]
  std::vector<double> rotation;        ///< at the last evaluation [rad]
  std::vector<double> slip_energy;     ///< dissipated by sliding so far, weighted [J]
  std::vector<double> fracture_energy; ///< lost with broken elements so far, weighted [J]
  std::vector<JointForce> force;       ///< of the last evaluation

  std::size_t size() const { return size_; }
  /// Room for elements that every joint has: the largest N so far.
  int n_elements() const { return n_elements_; }
  Bond bond(std::size_t k, int e) const { return bonds_[slot(k, e)]; }
  void set_bond(std::size_t k, int e, Bond bond) { bonds_[slot(k, e)] = bond; }
  /// Plastic slip p of an element: tau = k_s (u_s - p) [m].
  double slip(std::size_t k, int e) const { return slips_[slot(k, e)]; }
  void set_slip(std::size_t k, int e, double slip) { slips_[slot(k, e)] = slip; }

  /// Record of joint @p j of group @p g, which has @p n elements, all of them bonded.
  /// \return its number
  std::size_t append(std::size_t j, std::size_t g, int n);
  void pop_back();
  void clear() { *this = {}; }

  // Bonds and slips of four joints lie together: element by element, four of each.
  const Bond *bonds() const { return bonds_.data(); }
  double *slips() { return slips_.data(); }

private:
  std::size_t slot(const std::size_t k, const int e) const
  {
    return 4 * (k / 4 * static_cast<std::size_t>(n_elements_) +
                static_cast<std::size_t>(e)) +
           k % 4;
  }
  void make_room(int n);

  std::size_t size_ = 0;
  int n_elements_ = 0;
  std::vector<Bond> bonds_;
  std::vector<double> slips_;
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
  std::size_t joint = 0; ///< no_joint of a smooth joint
  int element = 0;
  std::size_t grain = 0; ///< one of the two that it parts
};
constexpr std::size_t no_joint = std::size_t(-1);

/// Consecutive joints of one group that a kernel takes at a time.
struct JointBlock
{
  std::int32_t begin = 0, end = 0;
  std::int32_t group = 0;
  bool shared = false; ///< some of its grains belong to another part
  // Of the part's own grains, for which sums are begun and finished while they are near:
  std::size_t reach = 0; ///< one past the last one that a joint up to here touches
  std::size_t done = 0;  ///< no later joint touches one below
};

/// Grains begin .. end - 1 and all blocks that hold a joint of theirs, ascending: what
/// one thread works on. A block with grains of two parts is evaluated for both.
struct JointPart
{
  std::size_t begin = 0, end = 0;
  std::vector<JointBlock> blocks;
  /// Joints over a strength in this step, with the force that an intact one has.
  std::vector<std::pair<std::int32_t, JointForce>> over;

  bool has(const std::int32_t grain) const
  {
    return static_cast<std::size_t>(grain) - begin < end - begin;
  }
};

struct GrainLine;
struct GrainSum;
struct IntactKernelInput;
struct ElementConstants;
/// Memory that the kernels use within a step, kept so that no step allocates any.
struct JointWork
{
  std::vector<GrainLine> lines;
  bool lines_filled = false; ///< by evaluate_broken_joints(), for evaluate_bonds()
  std::vector<GrainSum> sums;
  std::vector<IntactKernelInput> inputs;
  std::vector<ElementConstants> laws;
  std::vector<JointPart> parts;
  std::vector<std::pair<std::int32_t, JointForce>> over;
  std::vector<std::int32_t> events;

  JointWork();
  ~JointWork();
  JointWork(const JointWork &);
  JointWork(JointWork &&) noexcept;
  JointWork &operator=(const JointWork &);
  JointWork &operator=(JointWork &&) noexcept;
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
  /// Strengths of the joint over those of its group's law; both empty without scatter.
  std::vector<double> tension_factor;  ///< of the tensile strength [-]
  std::vector<double> cohesion_factor; ///< [-]
  /// Deformation that the prestress stands for; all three empty without prestress.
  std::vector<double> initial_gap;      ///< [m]
  std::vector<double> initial_shear;    ///< [m]
  std::vector<double> initial_rotation; ///< [rad]

  std::vector<JointGroup> groups; ///< cover all joints, in order

  // State.
  std::vector<std::int32_t> damage; ///< index into damaged, or -1 while intact
  DamagedJoints damaged;            ///< in the order in which they lost their first bond
  std::vector<unsigned char> would_break; ///< unbreakable joints that exceeded a strength
  /// Contacts that bonds broken in this step leave to their grains. The record of the
  /// bond has their force until whoever owns the contacts takes them, before the next
  /// step.
  struct Released
  {
    Contact contact;
    std::int32_t damaged; ///< index of the record
  };
  std::vector<Released> released;

  /// Result of a step that was asked for them.
  std::vector<JointForce> force;

  /// The joints of grain i, ascending, are grain_joint[grain_begin[i]] up to
  /// grain_begin[i + 1].
  std::vector<std::int32_t> grain_begin;
  std::vector<std::int32_t> grain_joint;

  JointWork work; ///< of the kernels; nothing that has to be kept

  std::size_t size() const { return first.size(); }
  std::size_t group_number(std::size_t joint) const;
  const JointGroup &group_of(const std::size_t joint) const
  {
    return groups[group_number(joint)];
  }

  /// Bond grains @p i and @p j where they stand (gap or overlap alike), stress-free.
  /// Appends to the last group. The stiffness of two different moduli is that of two
  /// springs in series: k_n = 1 / (R_i / E_i + R_j / E_j). Throws std::invalid_argument
  /// when the two centres coincide.
  void add(const Grains &grains,
           std::int32_t i,
           std::int32_t j,
           double modulus_i,
           double modulus_j);
  /// Start a new group; later add() go to it.
  void begin_group(const JointLaw &law, int layer, const std::string &name);
  /// Build the sum order. Call once, after the last add().
  void finish(std::size_t n_grains);
};

/// k_n [Pa/m] of two grains of moduli E_i and E_j, springs in series:
/// 1 / (R_i / E_i + R_j / E_j).
double
joint_stiffness(double radius_i, double radius_j, double modulus_i, double modulus_j);

/// Deformation of joint @p j for the present displacements, prestress included.
struct JointDeformation
{
  double gap = 0.;      ///< at the joint's centre [m]
  double shear = 0.;    ///< u_s [m]
  double rotation = 0.; ///< theta_b [rad]
};
JointDeformation deformation(const Grains &grains, const Joints &joints, std::size_t j);
/// The same one step of @p dt [s] ago, from the half-step velocities that led here.
JointDeformation
deformation_before(const Grains &grains, const Joints &joints, std::size_t j, double dt);

/// Where in time a force evaluation stands.
struct StepTime
{
  std::uint64_t step = 0;
  double time = 0.; ///< of the positions [s]
  double dt = 0.;   ///< that led from the last positions to these [s]
};

/// The full law for every joint that was damaged before this step: friction, closing and
/// opening, further breaks. Results stay in the records for evaluate_bonds(), which
/// follows before anything moves.
/// \param[in,out] new_cracks breaks are appended in order of damage; null: none is tested
void evaluate_broken_joints(const Grains &grains,
                            Joints &joints,
                            const StepTime &now,
                            std::vector<Crack> *new_cracks);

/// Set the grains' forces to the sums of their joints' forces: the vector kernel of this
/// processor for intact joints, what evaluate_broken_joints() has left for the others,
/// and the first break of those that are over a strength. Every grain sums its joints in
/// their order, so the result has the same bits for any number of threads.
/// \param[in,out] new_cracks breaks of this step are appended, in joint and element
/// order;
///                null: strengths are not looked at (equilibration).
/// \param keep_forces fill Joints::force too
void evaluate_bonds(Grains &grains,
                    Joints &joints,
                    const StepTime &now,
                    std::vector<Crack> *new_cracks,
                    bool keep_forces);

/// The two above in their order, all forces kept unless @p keep_forces says otherwise.
void compute_joint_forces(Grains &grains,
                          Joints &joints,
                          const StepTime &now,
                          std::vector<Crack> *new_cracks,
                          bool keep_forces = true);

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
