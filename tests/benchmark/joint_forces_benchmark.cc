// Speed of the whole explicit step of bonded grains: joint forces with strengths looked
// at, kick, drift. Prints a table; never fails on time.
//
//   joint_forces_benchmark [repetitions]
//
// ANTIFORM_COMMIT in the environment is printed as the commit.
#include "support/grain_fixtures.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace
{
using namespace antiform::discrete;
using namespace antiform::discrete::test;

std::string processor()
{
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0)
      return line.substr(line.find(':') + 2);
  return "unknown";
}

/// A rock that vibrates a little and does not break. @p scattered: grains numbered at
/// random instead of row by row.
Sample rock(const int columns, const int rows, const int n_elements, const bool scattered)
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
  return sample;
}

struct Speed
{
  double median, slowest, fastest; ///< million grain-steps per second
};

Speed measure(Sample &sample, const int threads, const int repetitions)
{
  omp_set_num_threads(threads);
  Grains &grains = sample.grains;
  const double dt = 0.5 * stable_step(grains, sample.joints);
  const auto n = static_cast<double>(grains.size());
  const int steps = std::max(20, static_cast<int>(2e6 / n));
  const auto run = [&](const int how_many)
  {
    for (int step = 0; step < how_many; ++step)
    {
      compute_joint_forces(grains, sample.joints, {0, 0., dt}, &sample.cracks);
      kick(grains, dt, nullptr);
      drift(grains, dt);
    }
  };
  run(steps / 4); // caches, clock, threads
  std::vector<double> speed;
  for (int r = 0; r < repetitions; ++r)
  {
    const auto start = std::chrono::steady_clock::now();
    run(steps);
    const std::chrono::duration<double> seconds =
        std::chrono::steady_clock::now() - start;
    speed.push_back(n * steps / seconds.count() * 1e-6);
  }
  std::sort(speed.begin(), speed.end());
  return {speed[speed.size() / 2], speed.front(), speed.back()};
}
} // namespace

int main(int argc, char **argv)
{
  const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
  const char *commit = std::getenv("ANTIFORM_COMMIT");
  std::printf("%s, kernel level %s, commit %s\n", processor().c_str(),
              joint_kernel_level().c_str(), commit != nullptr ? commit : "unknown");
  std::printf("million grain-steps per second: median of %d [slowest, fastest]\n",
              repetitions);
  std::printf("%8s %8s %3s %-10s %7s  %s\n", "grains", "joints", "N", "numbering",
              "threads", "speed");
  for (const auto &[columns, rows] :
       {std::pair(30, 50), std::pair(100, 150), std::pair(200, 300)})
    for (const int n_elements : {1, 3})
      for (const bool scattered : {false, true})
        for (const int threads : {1, 2})
        {
          Sample sample = rock(columns, rows, n_elements, scattered);
          const Speed speed = measure(sample, threads, repetitions);
          std::printf("%8zu %8zu %3d %-10s %7d  %7.2f [%.2f, %.2f]\n",
                      sample.grains.size(), sample.joints.size(), n_elements,
                      scattered ? "scattered" : "by rows", threads, speed.median,
                      speed.slowest, speed.fastest);
          std::fflush(stdout);
        }
}
