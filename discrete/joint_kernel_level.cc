// Compiled once per vector level (ANTIFORM_LEVEL names the namespace). Every level does
// the same IEEE operations in the same order, so all give the same bits.
#include "discrete/joint_kernel.h"
#include "discrete/joint_law.h"

namespace antiform::discrete::ANTIFORM_LEVEL
{
namespace
{
static_assert(sizeof(GrainLine) == 64 && sizeof(GrainSum) == 32 &&
              sizeof(JointForce) == 32);

/// Up to four entries; those beyond @p n repeat the first.
inline Lanes load_some(const double *from, const std::size_t n)
{
  if (n >= n_lanes)
    return load(from);
  Lanes v = Lanes{} + from[0];
  for (std::size_t l = 1; l < n; ++l)
    v[l] = from[l];
  return v;
}
inline Lanes gather(const double *from, const std::int32_t *at)
{
  return Lanes{from[at[0]], from[at[1]], from[at[2]], from[at[3]]};
}

void lines(const double *x,
           const double *y,
           const double *rotation,
           GrainLine *line,
           const std::size_t begin,
           const std::size_t end)
{
  for (std::size_t i = begin; i < end; i += n_lanes)
  {
    const std::size_t n = end - i < n_lanes ? end - i : n_lanes;
    Lanes row[4] = {
        load_some(x + i, n), load_some(y + i, n), load_some(rotation + i, n), {}};
    Lanes sine, cosine;
    sine_cosine<Lanes>(0.5 * row[2], sine, cosine);
    transpose(row[0], row[1], row[2], row[3]);
    const Lanes even = evens(cosine, sine), odd = odds(cosine, sine);
    const Lanes half[4] = {lower_halves(even, Lanes{}), lower_halves(odd, Lanes{}),
                           upper_halves(even, Lanes{}), upper_halves(odd, Lanes{})};
    for (std::size_t l = 0; l < n; ++l)
    {
      store(&line[i + l].x, row[l]);
      store(&line[i + l].half_cos, half[l]);
    }
  }
}

/// Motion of four joints' grains against one another.
struct PairMotion
{
  Lanes ux, uy, theta;
  HalfAngles<Lanes> half;
};
inline PairMotion pair_motion(const GrainLine *grains,
                              const std::int32_t *first,
                              const std::int32_t *second,
                              const std::size_t n)
{
  const GrainLine *one[4], *two[4];
  for (std::size_t l = 0; l < n_lanes; ++l)
  {
    one[l] = grains + first[l < n ? l : 0];
    two[l] = grains + second[l < n ? l : 0];
  }
  PairMotion motion;
  Lanes row[4];
  for (std::size_t l = 0; l < n_lanes; ++l)
    row[l] = load(&two[l]->x) - load(&one[l]->x);
  transpose(row[0], row[1], row[2], row[3]);
  motion.ux = row[0];
  motion.uy = row[1];
  motion.theta = row[2];
  const auto cosine_sine = [](const GrainLine *const *line, Lanes &cosine, Lanes &sine)
  {
    const Lanes even = join(load_pair(&line[0]->half_cos), load_pair(&line[2]->half_cos));
    const Lanes odd = join(load_pair(&line[1]->half_cos), load_pair(&line[3]->half_cos));
    cosine = evens(even, odd);
    sine = odds(even, odd);
  };
  cosine_sine(one, motion.half.cos1, motion.half.sin1);
  cosine_sine(two, motion.half.cos2, motion.half.sin2);
  return motion;
}

template <bool weighted, bool prestressed, bool scattered, bool full>
inline LaneMask intact_lanes(const IntactKernelInput &in,
                             const std::size_t j,
                             const std::size_t n,
                             JointForce *force)
{
  const auto get = [n](const double *from)
  { return full ? load(from) : load_some(from, n); };
  const PairMotion motion =
      pair_motion(in.grains, in.first + j, in.second + j, full ? n_lanes : n);
  const InstalledFrame<Lanes> at{get(in.normal_x + j), get(in.normal_y + j),
                                 get(in.length + j), get(in.lever_difference + j)};
  const JointGeometry<Lanes> now = joint_geometry(at, motion.half, motion.ux, motion.uy);
  Lanes gap = now.gap, shear = now.shear, rotation = motion.theta;
  if (prestressed)
  {
    gap += get(in.initial_gap + j);
    shear += get(in.initial_shear + j);
    rotation += get(in.initial_rotation + j);
  }

  const Lanes stiffness = get(in.stiffness + j), half_length = get(in.half_length + j);
  // Tension first, then Coulomb: of a flat joint the outer element in tension is the
  // first for both.
  const Lanes normal_stress = stiffness * gap;
  const Lanes edge = absolute(stiffness * rotation) * half_length;
  const Lanes worst = normal_stress + edge * in.tension_arm;
  const Lanes coulomb = absolute(stiffness * in.shear_ratio * shear) +
                        (normal_stress + edge * in.coulomb_arm) * in.tan_friction;
  const Lanes length = 2. * half_length;
  Lanes area_stiffness = stiffness * length;
  if (weighted)
    area_stiffness *= get(in.weight + j);
  const JointResultant<Lanes> sum{
      area_stiffness * gap, area_stiffness * in.shear_ratio * shear,
      -(area_stiffness * length * length * in.moment_factor * rotation)};
  const GrainForces<Lanes> f = grain_forces(sum, at, now);
  Lanes row[4] = {f.x, f.y, f.torque1, f.torque2};
  transpose(row[0], row[1], row[2], row[3]);
  for (std::size_t l = 0; l < (full ? n_lanes : n); ++l)
    store(&force[l].x, row[l]);
  if (scattered)
    return (worst >= in.tensile_strength * get(in.tension_factor + j)) |
           (coulomb > in.cohesion * get(in.cohesion_factor + j));
  return (worst >= in.tensile_strength) | (coulomb > in.cohesion);
}

template <bool weighted, bool prestressed, bool scattered>
std::size_t intact_law(const IntactKernelInput &in,
                       const std::size_t begin,
                       const std::size_t end,
                       JointForce *force,
                       std::int32_t *over)
{
  const std::size_t n = end - begin, whole = n - n % n_lanes;
  LaneMask mask[intact_block / n_lanes], some{};
  for (std::size_t k = 0; k < whole; k += n_lanes)
    some |= mask[k / n_lanes] = intact_lanes<weighted, prestressed, scattered, true>(
        in, begin + k, n_lanes, force + k);
  if (whole < n)
    some |= mask[whole / n_lanes] = intact_lanes<weighted, prestressed, scattered, false>(
        in, begin + whole, n - whole, force + whole);
  std::size_t n_over = 0;
  if (any(some))
    for (std::size_t k = 0; k < n; ++k)
      if (mask[k / n_lanes][k % n_lanes] != 0)
        over[n_over++] = static_cast<std::int32_t>(begin + k);
  return n_over;
}

template <bool weighted, bool prestressed>
std::size_t intact_scattered_or_not(const IntactKernelInput &in,
                                    const std::size_t begin,
                                    const std::size_t end,
                                    JointForce *force,
                                    std::int32_t *over)
{
  return in.tension_factor != nullptr
             ? intact_law<weighted, prestressed, true>(in, begin, end, force, over)
             : intact_law<weighted, prestressed, false>(in, begin, end, force, over);
}

std::size_t intact(const IntactKernelInput &in,
                   const std::size_t begin,
                   const std::size_t end,
                   JointForce *force,
                   std::int32_t *over)
{
  if (in.weight != nullptr)
    return in.initial_gap != nullptr
               ? intact_scattered_or_not<true, true>(in, begin, end, force, over)
               : intact_scattered_or_not<true, false>(in, begin, end, force, over);
  return in.initial_gap != nullptr
             ? intact_scattered_or_not<false, true>(in, begin, end, force, over)
             : intact_scattered_or_not<false, false>(in, begin, end, force, over);
}

void sum(const std::int32_t *first,
         const std::int32_t *second,
         const JointForce *force,
         const std::size_t n,
         GrainSum *sums)
{
  const Lanes opposite{-1., -1., 1., 1.};
  for (std::size_t k = 0; k < n; ++k)
  {
    double *const one = &sums[first[k]].x, *const two = &sums[second[k]].x;
    const Lanes f = load(&force[k].x);
    store(one, load(one) + f * opposite);
    store(two, load(two) + __builtin_shufflevector(f, f, 0, 1, 3, 2));
  }
}

/// Lanes whose byte is @p code.
inline LaneMask lanes_with(const void *codes, const signed char code)
{
#ifdef __AVX2__ // g++ 12 would do this byte by byte
  using Sixteen = char __attribute__((vector_size(16)));
  std::int32_t word;
  std::memcpy(&word, codes, sizeof word);
  using Words = std::int32_t __attribute__((vector_size(16)));
  return (LaneMask)__builtin_ia32_pmovsxbq256((Sixteen)Words{word, 0, 0, 0}) == code;
#else
  using Four = signed char __attribute__((vector_size(4)));
  Four four;
  std::memcpy(&four, codes, sizeof four);
  return __builtin_convertvector(four, LaneMask) == code;
#endif
}

/// @p get: a constant of the four joints' groups.
template <class Get>
inline ElementLaw<Lanes>
element_laws(const DamagedKernelInput &in, const std::int32_t *joint, const Get &get)
{
  ElementLaw<Lanes> law;
  law.normal_stiffness = gather(in.stiffness, joint);
  law.half_length = gather(in.half_length, joint);
  law.shear_stiffness = law.normal_stiffness * get(&ElementConstants::shear_ratio);
  law.shear_compliance = 1. / law.shear_stiffness;
  law.n_elements = get(&ElementConstants::n_elements);
  law.element_length = 2. * law.half_length / law.n_elements;
  law.moment = get(&ElementConstants::moment);
  law.residual_friction = get(&ElementConstants::residual_friction);
  law.residual_cohesion = get(&ElementConstants::residual_cohesion);
  law.tensile_strength = get(&ElementConstants::tensile_strength);
  law.cohesion = get(&ElementConstants::cohesion);
  law.tan_friction = get(&ElementConstants::tan_friction);
  if (in.tension_factor != nullptr)
  {
    law.tensile_strength *= gather(in.tension_factor, joint);
    law.cohesion *= gather(in.cohesion_factor, joint);
  }
  return law;
}
inline ElementLaw<Lanes> element_laws(const DamagedKernelInput &in,
                                      const std::int32_t *joint,
                                      const std::int32_t *group)
{
  const ElementConstants *const l[4] = {in.laws + group[0], in.laws + group[1],
                                        in.laws + group[2], in.laws + group[3]};
  if (l[0] == l[1] && l[0] == l[2] && l[0] == l[3])
    return element_laws(in, joint,
                        [&l](const double ElementConstants::*member)
                        { return Lanes{} + l[0]->*member; });
  return element_laws(
      in, joint,
      [&l](const double ElementConstants::*member) {
        return Lanes{l[0]->*member, l[1]->*member, l[2]->*member, l[3]->*member};
      });
}

inline bool all_have(const ElementLaw<Lanes> &law, const double n)
{
  return !any(law.n_elements != n);
}

/// All elements of four joints, whose bonds and slips begin at @p slots; @p N of each, or
/// 0: up to in.n_elements, not the same number of each.
template <int N>
inline void add_elements(const DamagedKernelInput &in,
                         const std::size_t slots,
                         const ElementLaw<Lanes> &law,
                         const Deformation<Lanes> &before,
                         const Deformation<Lanes> &now,
                         Lanes *new_slip,
                         ElementSums<Lanes> &sums)
{
  const int n = N > 0 ? N : in.n_elements;
#pragma GCC unroll 3
  for (int e = 0; e < n; ++e)
  {
    const std::size_t slot = slots + n_lanes * static_cast<std::size_t>(e);
    Stretch<Lanes> whole;
    if (N > 0)
      whole = {e * 1. * law.element_length - law.half_length,
               e + 1 == N ? law.half_length
                          : (e + 1.) * law.element_length - law.half_length};
    else
      whole = element(law, e);
    const LaneMask bonded =
        lanes_with(in.bond + slot, static_cast<signed char>(Bond::bonded));
    new_slip[e] =
        add_element<false>(law, whole, bonded, before, now, load(in.slip + slot), sums);
  }
}

constexpr int max_elements = 32; ///< joints with more go one by one

bool damaged(const DamagedKernelInput &in, const std::size_t begin)
{
  if (in.n_elements > max_elements)
    return true;
  const LaneMask removed = ~lanes_with(in.removed + begin, 0);
  if (!any(~removed))
    return false;
  const std::int32_t *const joint = in.joint + begin;
  std::int32_t first[4], second[4];
  for (std::size_t l = 0; l < n_lanes; ++l)
  {
    first[l] = in.first[joint[l]];
    second[l] = in.second[joint[l]];
  }
  const PairMotion motion = pair_motion(in.grains, first, second, n_lanes);
  const InstalledFrame<Lanes> at{gather(in.normal_x, joint), gather(in.normal_y, joint),
                                 gather(in.length, joint),
                                 gather(in.lever_difference, joint)};
  const JointGeometry<Lanes> place =
      joint_geometry(at, motion.half, motion.ux, motion.uy);
  Lanes gap = place.gap, shear = place.shear, rotation = motion.theta;
  Lanes parted = Lanes{};
  if (in.initial_gap != nullptr)
  {
    const Lanes made = gather(in.initial_gap, joint);
    gap += made;
    shear += gather(in.initial_shear, joint);
    rotation += gather(in.initial_rotation, joint);
    parted = larger(parted, made);
  }
  const Deformation<Lanes> now = seen_by_law(gap, shear, rotation);
  const Deformation<Lanes> before =
      seen_by_law(load(in.gap + begin), load(in.shear + begin), load(in.turn + begin));
  const ElementLaw<Lanes> law = element_laws(in, joint, in.group + begin);
  const Lanes weight = in.weight != nullptr ? gather(in.weight, joint) : Lanes{} + 1.;

  Lanes new_slip[max_elements];
  ElementSums<Lanes> sums;
  const std::size_t slots = begin * static_cast<std::size_t>(in.n_elements);
  if (in.n_elements == 3 && all_have(law, 3.))
    add_elements<3>(in, slots, law, before, now, new_slip, sums);
  else
    add_elements<0>(in, slots, law, before, now, new_slip, sums);

  const LaneMask event = (sums.over | parts(law, sums, now, parted)) & ~removed;
  if (any(event))
    return true;
  for (int e = 0; e < in.n_elements; ++e)
  {
    double *const slip = in.slip + slots + n_lanes * static_cast<std::size_t>(e);
    store(slip, select(removed, load(slip), new_slip[e]));
  }
  store(in.gap + begin, select(removed, before.gap, now.gap));
  store(in.shear + begin, select(removed, before.shear, now.shear));
  store(in.turn + begin, select(removed, before.rotation, now.rotation));
  store(in.slip_energy + begin, load(in.slip_energy + begin) +
                                    select(removed, Lanes{}, weight * sums.dissipated));
  const JointResultant<Lanes> resultant{weight * sums.normal, weight * sums.shear,
                                        weight * sums.moment};
  const GrainForces<Lanes> f = grain_forces(resultant, at, place);
  Lanes row[4] = {select(removed, Lanes{}, f.x), select(removed, Lanes{}, f.y),
                  select(removed, Lanes{}, f.torque1),
                  select(removed, Lanes{}, f.torque2)};
  transpose(row[0], row[1], row[2], row[3]);
  for (std::size_t l = 0; l < n_lanes; ++l)
    store(&in.force[begin + l].x, row[l]);
  return false;
}
} // namespace

double
damped_kick(const DampedKick &, std::size_t, std::size_t); // motion_kernel_level.cc

#define ANTIFORM_TEXT(x) #x
#define ANTIFORM_NAME(x) ANTIFORM_TEXT(x)
KernelLevel kernel_level()
{
  return {ANTIFORM_NAME(ANTIFORM_LEVEL) + 6, intact, lines, sum, damaged, damped_kick};
}
} // namespace antiform::discrete::ANTIFORM_LEVEL
