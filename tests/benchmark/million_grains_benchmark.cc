// What a million bonded grains take: memory, and seconds of the clock and of the
// processor for a step. A packing so large would take hours to make, so a periodic tile
// is packed and repeated.
//
//   million_grains_benchmark [grains] [steps] [threads]
#include "discrete/integrate.h"
#include "discrete/joints.h"
#include "discrete/packing.h"

#include "support/processor.h"

#include <omp.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace
{
using namespace antiform::discrete;
using antiform::Vec2;

double peak_megabytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1.024e-3 * static_cast<double>(usage.ru_maxrss);
}

struct Seconds
{
  double clock, processor;
};
Seconds now()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return {std::chrono::duration<double>(
              std::chrono::steady_clock::now().time_since_epoch())
              .count(),
          static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)};
}

/// A part of the work and what it took, with the largest memory so far.
void report(const char *what, const Seconds &begin, const double times = 1.)
{
  const Seconds end = now();
  std::printf("%-26s %10.4f s of the clock %10.4f s of the processor %7.0f MB\n", what,
              (end.clock - begin.clock) / times,
              (end.processor - begin.processor) / times, peak_megabytes());
  std::fflush(stdout);
}

/// Copies of the tile side by side, columns of copies along x one after the other, so
/// that grains are numbered along the section.
Grains tiled(const PeriodicTile &tile, const std::size_t n_grains)
{
  constexpr int rows = 4; // a layer some 200 grains thick
  const auto copies = static_cast<int>(
      std::ceil(static_cast<double>(n_grains) / static_cast<double>(tile.disks.size())));
  Grains grains;
  for (int k = 0; k < copies; ++k)
  {
    const Vec2 shift{tile.size.x * (k / rows), tile.size.y * (k % rows)};
    for (const Disk &disk : tile.disks)
      grains.add(disk.centre + shift, disk.radius, 2500., 0);
  }
  return grains;
}
} // namespace

int main(int argc, char **argv)
{
  const auto n_grains = static_cast<std::size_t>(argc > 1 ? std::atof(argv[1]) : 1e6);
  const int n_steps = argc > 2 ? std::atoi(argv[2]) : 100;
  omp_set_num_threads(argc > 3 ? std::atoi(argv[3]) : 1);
  std::printf("%s, kernel level %s, %d threads\n", antiform::test::processor().c_str(),
              joint_kernel_level().c_str(), omp_get_max_threads());

  PackingParameters packing;
  Seconds begin = now();
  const PeriodicTile tile = pack_periodic({48., 48.}, packing);
  report("packing of the tile", begin);

  begin = now();
  Grains grains = tiled(tile, n_grains);
  FlatJoint law;
  Joints joints;
  joints.begin_group(law, 0, "rock");
  const double gap = packing.installation_gap_ratio * 0.5 * packing.mean_diameter;
  for (const auto &[i, j] : pairs_within(grains, gap, 0, 0))
    joints.add(grains, i, j, law.effective_modulus, law.effective_modulus);
  joints.finish(grains.size());
  report("tiling and bonding", begin);

  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    grains.velocity_x[i] = 1e-3 * std::sin(12.9898 * static_cast<double>(i));
    grains.velocity_y[i] = 1e-3 * std::sin(78.233 * static_cast<double>(i));
  }
  GrainDamping damping;
  damping.coefficient = 0.7;
  damping.combined = true;
  damping.start(grains.size());
  std::vector<Crack> cracks;
  const double dt = 0.5 * stable_step(grains, joints);
  const auto step = [&]
  {
    compute_joint_forces(grains, joints, {0, 0., dt}, &cracks, false);
    damped_kick(grains, dt, damping);
    drift(grains, dt);
  };
  step(); // its work arrays are made
  begin = now();
  for (int k = 0; k < n_steps; ++k)
    step();
  report("a step", begin, n_steps);
  const Seconds end = now();
  std::printf("%zu grains, %zu joints, %zu cracks: %.1f ns of the processor a "
              "grain-step\n",
              grains.size(), joints.size(), cracks.size(),
              1e9 * (end.processor - begin.processor) / n_steps /
                  static_cast<double>(grains.size()));
}
