// Speed of the whole explicit step of bonded grains: joint forces with strengths looked
// at, kick, drift; its plain twin in the same run; what contraction and the fixed order
// of sums cost; memory. Prints tables; never fails on time.
//
//   joint_forces_benchmark [repetitions]
//
// ANTIFORM_COMMIT in the environment is printed as the commit.
#include "discrete/joint_kernel.h"

#include "support/grain_fixtures.h"
#include "support/plain_damage.h"
#include "support/plain_joint.h"
#include "support/processor.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>

namespace antiform::discrete::level_contracted
{
KernelLevel kernel_level(); // as x86-64-v3, but with a*b+c contracted
}

namespace
{
using namespace antiform::discrete;
using namespace antiform::discrete::test;

enum class State
{
  intact,
  damaged ///< one element of every joint is broken
};

/// A rock that vibrates a little and does not break. @p scattered: grains numbered at
/// random instead of row by row.
Sample rock(const int columns,
            const int rows,
            const int n_elements,
            const State state,
            const bool scattered = false)
{
  const Grains ordered = random_pack(columns, rows, 71);
  std::vector<std::size_t> number(ordered.size());
  for (std::size_t i = 0; i < number.size(); ++i)
    number[i] = i;
  Random random(72);
  for (std::size_t k = number.size(); scattered && k > 1; --k)
    std::swap(number[k - 1], number[random.index(k)]);
  Sample sample;
  for (const std::size_t i : number)
    sample.grains.add(ordered.reference(i), ordered.radius[i], 1., 0);
  bond_all(sample, strong_law(n_elements));
  shake(sample.grains, 1e-3, 1e-3, 73);
  for (std::size_t j = 0; state == State::damaged && j < sample.joints.size(); ++j)
    break_element(sample.grains, sample.joints, j, static_cast<int>(j) % n_elements,
                  Bond::broken_in_tension);
  return sample;
}

double seconds(const bool of_processor)
{
  if (of_processor)
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// One who takes part: steps that do so many units each, on so many threads.
struct Runner
{
  std::function<void()> step;
  double units;
  int n_steps; ///< of a slice
  int threads;
};

/// Million units per second of each, slice by slice: of the processor on one thread, of
/// the clock on more. Slices are taken in turn, so that what disturbs the machine for
/// longer than a slice does not bear on the ratio of two of the same turn.
std::vector<std::vector<double>> measure_in_turn(const std::vector<Runner> &runners,
                                                 const int repetitions)
{
  std::vector<std::vector<double>> speeds(runners.size());
  for (int r = -1; r < repetitions; ++r) // the first turn: caches, clock, threads
    for (std::size_t k = 0; k < runners.size(); ++k)
    {
      const Runner &runner = runners[k];
      omp_set_num_threads(runner.threads);
      runner.step(); // its data are in the cache again
      const double start = seconds(runner.threads == 1);
      for (int n = 0; n < runner.n_steps; ++n)
        runner.step();
      const double taken = seconds(runner.threads == 1) - start;
      if (r >= 0)
        speeds[k].push_back(runner.units * runner.n_steps / taken * 1e-6);
    }
  return speeds;
}

struct Spread
{
  double median, least, most;
};
Spread spread(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.front(), values.back()};
}
/// Of two in the same turn.
Spread ratio(const std::vector<double> &a, const std::vector<double> &b)
{
  std::vector<double> values;
  for (std::size_t r = 0; r < a.size(); ++r)
    values.push_back(a[r] / b[r]);
  return spread(std::move(values));
}
std::string text(const Spread &s, const int digits = 2)
{
  char line[80];
  std::snprintf(line, sizeof line, "%6.*f [%.*f, %.*f]", digits, s.median, digits,
                s.least, digits, s.most);
  return line;
}

int steps_for(const Sample &sample)
{
  return std::max(20, static_cast<int>(3e6 / static_cast<double>(sample.grains.size())));
}

Runner runner(Sample &sample, const int threads)
{
  const double dt = 0.5 * stable_step(sample.grains, sample.joints);
  return {[&sample, dt]
          {
            compute_joint_forces(sample.grains, sample.joints, {0, 0., dt},
                                 &sample.cracks, false);
            kick(sample.grains, dt);
            drift(sample.grains, dt);
          },
          static_cast<double>(sample.grains.size()), steps_for(sample), threads};
}

/// With combined damping, so weak that the rock goes on vibrating.
Runner damped_runner(Sample &sample, GrainDamping &damping, const int threads)
{
  const double dt = 0.5 * stable_step(sample.grains, sample.joints);
  damping.coefficient = 1e-6;
  damping.combined = true;
  return {[&sample, &damping, dt]
          {
            compute_joint_forces(sample.grains, sample.joints, {0, 0., dt},
                                 &sample.cracks, false);
            damped_kick(sample.grains, dt, damping);
            drift(sample.grains, dt);
          },
          static_cast<double>(sample.grains.size()), steps_for(sample), threads};
}

/// The same step with the plain twin, a joint at a time.
Runner plain_runner(Sample &sample)
{
  Grains &grains = sample.grains;
  Joints &joints = sample.joints;
  const double dt = 0.5 * stable_step(grains, joints);
  std::vector<PlainDamagedJoint> twins;
  for (std::size_t k = 0; k < joints.damaged.size(); ++k)
  {
    twins.push_back(plain_damaged(joints, joints.damaged.joint[k]));
    for (std::size_t e = 0; e < twins.back().bond.size(); ++e)
      twins.back().bond[e] = joints.damaged.bond(k, static_cast<int>(e));
  }
  const auto step = [&sample, &grains, &joints, dt, twins]() mutable
  {
    for (std::vector<double> *v : {&grains.force_x, &grains.force_y, &grains.torque})
      std::fill(v->begin(), v->end(), 0.);
    for (std::size_t j = 0; j < joints.size(); ++j)
    {
      JointForce f;
      if (joints.damage[j] < 0)
        f = plain_joint_force<double>(grains, joints, j);
      else
      {
        PlainDamagedJoint &twin = twins[joints.damage[j]];
        plain_evaluate(grains, joints, twin, deformation(grains, joints, j),
                       {twin.gap, twin.shear, twin.rotation}, {0, 0., dt},
                       &sample.cracks);
        f = twin.force;
      }
      const std::size_t one = joints.first[j], two = joints.second[j];
      grains.force_x[one] -= f.x;
      grains.force_y[one] -= f.y;
      grains.torque[one] += f.torque1;
      grains.force_x[two] += f.x;
      grains.force_y[two] += f.y;
      grains.torque[two] += f.torque2;
    }
    kick(grains, dt);
    drift(grains, dt);
  };
  return {step, static_cast<double>(grains.size()), std::max(5, steps_for(sample) / 8),
          1};
}

const char *name(const State state)
{
  return state == State::intact ? "intact" : "full";
}

/// Rocks of one law: 1500, 15,000 and 60,000 grains, and for three elements 15,000
/// numbered at random.
void print_steps(const State state, const int n_elements, const int repetitions)
{
  std::vector<Sample> samples{rock(30, 50, n_elements, state),
                              rock(100, 150, n_elements, state),
                              rock(200, 300, n_elements, state)};
  if (n_elements == 3)
    samples.push_back(rock(100, 150, n_elements, state, true));
  std::vector<Sample> twins = samples;
  Sample damped_rock = samples[1];
  GrainDamping damping;
  std::vector<Runner> runners;
  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    runners.push_back(runner(samples[k], 1));
    runners.push_back(runner(samples[k], 2));
    runners.push_back(plain_runner(twins[k]));
  }
  for (const int threads : {1, 2})
    runners.push_back(damped_runner(damped_rock, damping, threads));
  const auto speeds = measure_in_turn(runners, repetitions);

  for (std::size_t k = 0; k < samples.size(); ++k)
  {
    const std::vector<double> &one = speeds[3 * k], &two = speeds[3 * k + 1],
                              &plain = speeds[3 * k + 2];
    std::printf("%7zu %7zu %2d %-7s %-9s  %-22s %-22s %-20s %-16s %s\n",
                samples[k].grains.size(), samples[k].joints.size(), n_elements,
                name(state), k == 3 ? "scattered" : "by rows", text(spread(one)).c_str(),
                text(spread(two)).c_str(), text(spread(plain)).c_str(),
                text(ratio(one, plain), 1).c_str(), text(ratio(two, one)).c_str());
  }
  const auto &damped = speeds[3 * samples.size()],
             &damped_two = speeds[3 * samples.size() + 1];
  std::printf("  seconds a grain-step of %zu grains over those of %zu: %s, 2 threads %s\n"
              "  with damping over without, %zu grains: %s, 2 threads %s\n",
              samples[2].grains.size(), samples[1].grains.size(),
              text(ratio(speeds[3], speeds[6])).c_str(),
              text(ratio(speeds[4], speeds[7])).c_str(), samples[1].grains.size(),
              text(ratio(speeds[3], damped)).c_str(),
              text(ratio(speeds[4], damped_two)).c_str());
  std::fflush(stdout);
}

void print_steps(const int repetitions)
{
  std::printf(
      "\nmillion grain-steps per second: median of %d slices in turn [least, most]; "
      "one thread: of processor time\n%7s %7s %2s %-7s %-9s  %-22s %-22s %-20s "
      "%-16s %s\n",
      repetitions, "grains", "joints", "N", "law", "numbering", "1 thread", "2 threads",
      "plain twin, 1 thread", "1 over plain", "2 over 1");
  for (const State state : {State::intact, State::damaged})
    for (const int n_elements : {1, 3})
      print_steps(state, n_elements, repetitions);
}

/// Forces of all joints and their sums by one level's kernels, on one thread.
Runner kernel_runner(Sample &sample, const KernelLevel &level)
{
  omp_set_num_threads(1);
  compute_joint_forces(sample.grains, sample.joints, {}, &sample.cracks, false);
  const DamagedKernelInput damaged = damaged_input(sample.joints, true);
  const auto step = [&sample, level, damaged]
  {
    Grains &grains = sample.grains;
    Joints &joints = sample.joints;
    JointWork &work = joints.work;
    for (std::size_t k = 0; k < joints.damaged.size(); k += 4)
      level.damaged(damaged, k);
    if (joints.damaged.size() > 0)
      return;
    level.lines(grains.displacement_x.data(), grains.displacement_y.data(),
                grains.rotation.data(), work.lines.data(), 0, grains.size());
    for (const JointBlock &block : work.parts[0].blocks)
    {
      alignas(64) JointForce force[intact_block];
      std::int32_t over[intact_block];
      level.intact(work.inputs[0], block.begin, block.end, force, over);
      level.sum(joints.first.data() + block.begin, joints.second.data() + block.begin,
                force, block.end - block.begin, work.sums.data());
    }
  };
  return {step, static_cast<double>(sample.joints.size()), steps_for(sample), 1};
}

void print_contraction(const int repetitions)
{
  if (!__builtin_cpu_supports("fma"))
    return;
  std::printf("\nmillion joints per second of processor time, kernels alone, 15,000 "
              "grains, N = 3\n%-7s  %-22s %-22s %s\n",
              "law", "contraction off", "contraction on", "on over off");
  for (const State state : {State::intact, State::damaged})
  {
    Sample sample = rock(100, 150, 3, state);
    // The like of it without contraction, also where the processor has a higher level.
    const auto speeds =
        measure_in_turn({kernel_runner(sample, supported_kernel_levels()[1]),
                         kernel_runner(sample, level_contracted::kernel_level())},
                        repetitions);
    std::printf("%-7s  %-22s %-22s %s\n", name(state), text(spread(speeds[0])).c_str(),
                text(spread(speeds[1])).c_str(),
                text(ratio(speeds[1], speeds[0])).c_str());
  }
}

/// Joints that two threads evaluate both, since they have a grain of each: what the fixed
/// order of sums costs. On one thread the order is that of the joints anyway.
void print_shared_joints()
{
  std::printf("\n");
  for (const bool scattered : {false, true})
  {
    Sample sample = rock(100, 150, 3, State::intact, scattered);
    omp_set_num_threads(2);
    compute_joint_forces(sample.grains, sample.joints, {}, nullptr, false);
    std::size_t evaluated = 0;
    for (const JointPart &part : sample.joints.work.parts)
      for (const JointBlock &block : part.blocks)
        evaluated += block.end - block.begin;
    const auto n = static_cast<double>(sample.joints.size());
    std::printf("evaluated twice for the order of sums, 2 threads, numbering %s: %.1f %% "
                "of the joints\n",
                scattered ? "scattered" : "by rows",
                100. * (static_cast<double>(evaluated) - n) / n);
  }
}

template <class... Vectors>
double bytes(const Vectors &...vectors)
{
  return (static_cast<double>(vectors.capacity() * sizeof(vectors[0])) + ...);
}

void print_memory()
{
  Sample sample = rock(100, 150, 3, State::damaged);
  omp_set_num_threads(1);
  compute_joint_forces(sample.grains, sample.joints, {}, nullptr);
  const Grains &g = sample.grains;
  const Joints &j = sample.joints;
  const DamagedJoints &d = j.damaged;
  const double grain =
      bytes(g.reference_x, g.reference_y, g.radius, g.mass, g.inertia, g.region,
            g.displacement_x, g.displacement_y, g.rotation, g.velocity_x, g.velocity_y,
            g.spin, g.inverse_mass, g.inverse_inertia, g.force_x, g.force_y, g.torque,
            j.grain_begin, j.work.lines, j.work.sums);
  const double joint =
      bytes(j.first, j.second, j.normal_x, j.normal_y, j.length, j.lever_difference,
            j.stiffness, j.half_length, j.weight, j.initial_gap, j.initial_shear,
            j.initial_rotation, j.damage, j.would_break, j.force, j.grain_joint);
  const double damage = bytes(d.joint, d.group, d.removed, d.gap, d.shear, d.rotation,
                              d.slip_energy, d.fracture_energy, d.force) +
                        static_cast<double>(d.n_elements()) *
                            static_cast<double>(d.joint.capacity()) *
                            (sizeof(double) + sizeof(Bond));
  const auto n_joints = static_cast<double>(j.size());
  std::printf("\nmemory [bytes]: %.0f a grain, %.0f a joint, %.0f more a damaged joint "
              "(N = 3)\n",
              grain / static_cast<double>(g.size()), joint / n_joints, damage / n_joints);
}
} // namespace

int main(int argc, char **argv)
{
  const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  const char *commit = std::getenv("ANTIFORM_COMMIT");
  std::printf("%s, kernel level %s, commit %s\n", antiform::test::processor().c_str(),
              joint_kernel_level().c_str(), commit != nullptr ? commit : "unknown");
  print_steps(repetitions);
  print_contraction(repetitions);
  print_shared_joints();
  print_memory();
}
