#include "cases/machine_speed.h"

#include "continuum/elastic_solid.h"
#include "continuum/section_mesh.h"
#include "continuum/static_solver.h"
#include "discrete/integrate.h"
#include "discrete/joints.h"

#include <omp.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>

namespace antiform::cases
{
namespace
{
double processor_seconds()
{
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// One thread for the time of a scope: more would wait for one another on a machine that
/// has other work.
class OneThread
{
public:
  OneThread()
      : before_(omp_get_max_threads())
  {
    omp_set_num_threads(1);
  }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread &) = delete;
  OneThread &operator=(const OneThread &) = delete;

private:
  int before_;
};

/// Of one call of @p work [s]: the median of some slices, which neighbours may disturb.
double seconds_of(const std::function<void()> &work)
{
  constexpr int n_slices = 5;
  constexpr double slice = 0.012;
  const double begin = processor_seconds();
  work(); // caches, clock of the processor
  work();
  const double once = std::max(1e-7, 0.5 * (processor_seconds() - begin));
  const int n = std::max(1, static_cast<int>(slice / once));
  std::array<double, n_slices> taken{};
  for (double &seconds : taken)
  {
    const double start = processor_seconds();
    for (int i = 0; i < n; ++i)
      work();
    seconds = (processor_seconds() - start) / n;
  }
  std::sort(taken.begin(), taken.end());
  return taken[n_slices / 2];
}

// Beyond these the pace changes little, and making the sample would take too long.
constexpr double least_grains = 500., most_grains = 262144., most_dofs = 8000.;

/// A bonded strip of equal disks that vibrates a little and does not break, numbered
/// along it as the layers of scenes are; units of its own.
struct Strip
{
  explicit Strip(const double n_grains)
  {
    constexpr int rows = 24;
    const int columns = std::max(2, static_cast<int>(std::lround(n_grains / rows)));
    for (int c = 0; c < columns; ++c)
      for (int r = 0; r < rows; ++r)
        grains.add({0.5 * std::sqrt(3.) * c, r + 0.5 * (c % 2)}, 0.5, 1., 0);
    discrete::FlatJoint law;
    law.effective_modulus = 1e3;
    law.tensile_strength = law.cohesion = 1e9;
    joints.begin_group(law, 0, "rock");
    const auto bond = [&](const int one, const int c, const int r)
    {
      if (c < columns && r >= 0 && r < rows)
        joints.add(grains, one, c * rows + r, law.effective_modulus,
                   law.effective_modulus);
    };
    for (int c = 0; c < columns; ++c)
      for (int r = 0; r < rows; ++r)
      {
        const int one = c * rows + r, up = c % 2;
        bond(one, c, r + 1);
        bond(one, c + 1, r - 1 + up);
        bond(one, c + 1, r + up);
      }
    joints.finish(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      grains.velocity_x[i] = 1e-3 * std::sin(12.9898 * static_cast<double>(i));
      grains.velocity_y[i] = 1e-3 * std::sin(78.233 * static_cast<double>(i));
    }
    damping.coefficient = 1e-6; // so weak that it goes on vibrating
    damping.combined = true;
    damping.start(grains.size());
    dt = 0.5 * discrete::stable_step(grains, joints);
  }
  void step()
  {
    discrete::compute_joint_forces(grains, joints, {0, 0., dt}, &cracks, false);
    discrete::damped_kick(grains, dt, damping);
    discrete::drift(grains, dt);
  }

  discrete::Grains grains;
  discrete::Joints joints;
  discrete::GrainDamping damping;
  std::vector<discrete::Crack> cracks;
  double dt = 0.;
};

/// The shape with few enough dofs: fewer columns, whose number all work goes with, and
/// fewer rows where there would be less than one column a row.
MeshShape sample_of(MeshShape mesh)
{
  mesh.columns = std::max(2., std::round(mesh.columns));
  mesh.rows = std::max(1., std::round(mesh.rows));
  const double share = mesh.dofs() / most_dofs;
  if (share > 1.)
  {
    const double even = std::sqrt(mesh.cells() / share);
    const double columns = std::max(mesh.columns / share, std::min(mesh.columns, even));
    mesh.rows = std::max(1., std::round(mesh.rows * mesh.columns / columns / share));
    mesh.columns = std::max(2., std::round(columns));
  }
  return mesh;
}

std::string name_of(const MeshShape &mesh)
{
  return std::to_string(std::lround(mesh.columns)) + " x " +
         std::to_string(std::lround(mesh.rows)) + " cells of degree " +
         std::to_string(mesh.degree);
}

using Triangulation = dealii::parallel::distributed::Triangulation<2>;

void make_rectangle(const MeshShape &mesh, Triangulation &triangulation)
{
  const double height = mesh.rows, length = mesh.columns;
  continuum::Strip strip;
  strip.lower = [](double) { return 0.; };
  strip.upper = [height](double) { return height; };
  for (int r = 0; r <= static_cast<int>(mesh.rows); ++r)
    strip.rows.push_back(r / mesh.rows);
  continuum::make_section(triangulation, 0., length,
                          static_cast<unsigned int>(mesh.columns), {strip});
}

std::unique_ptr<continuum::ElasticSolid> body_on(const Triangulation &triangulation,
                                                 const int degree)
{
  return std::make_unique<continuum::ElasticSolid>(
      triangulation,
      std::vector<continuum::ElasticMaterial>{
          continuum::ElasticMaterial::isotropic(1., 0.2, 1.)},
      static_cast<unsigned int>(degree));
}
} // namespace

MachineSpeed::MachineSpeed()
    : start_seconds_(processor_seconds())
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  program_memory_ = 1024. * static_cast<double>(usage.ru_maxrss);
}

double MachineSpeed::grain_step(const double n_grains)
{
  const double n = std::clamp(n_grains, least_grains, most_grains);
  const auto [place, is_new] =
      grain_steps_.emplace(static_cast<int>(std::lround(std::log2(n))), 0.);
  if (is_new)
  {
    const OneThread scope;
    Strip strip(std::exp2(place->first));
    const auto n_sample = static_cast<double>(strip.grains.size());
    place->second = seconds_of([&] { strip.step(); }) / n_sample;
    measured_.push_back(
        {"step of bonded grains", n_sample, 1e9 * place->second, "a grain"});
  }
  return place->second;
}

double MachineSpeed::dof_step(const MeshShape &mesh)
{
  const MeshShape sample = sample_of(mesh);
  const auto [place, is_new] =
      dof_steps_.emplace(std::pair(sample.degree, std::ilogb(sample.dofs())), 0.);
  if (is_new)
  {
    const OneThread scope;
    Triangulation triangulation(MPI_COMM_SELF);
    make_rectangle(sample, triangulation);
    const auto body = body_on(triangulation, sample.degree);
    continuum::Vector displacement = body->make_vector(), force = body->make_vector();
    displacement = 1e-3;
    displacement.update_ghost_values();
    place->second =
        seconds_of([&] { body->add_internal_force(displacement, force); }) /
        sample.dofs();
    measured_.push_back({"internal force of " + name_of(sample), sample.dofs(),
                         1e9 * place->second, "a dof"});
  }
  return place->second;
}

const SolvePace &MachineSpeed::solve(const MeshShape &mesh,
                                     const bool direct,
                                     std::map<std::string, SolvePace> &known)
{
  const MeshShape sample = sample_of(mesh);
  const auto [place, is_new] = known.emplace(name_of(sample), SolvePace());
  if (!is_new)
    return place->second;
  Triangulation triangulation(MPI_COMM_SELF);
  make_rectangle(sample, triangulation);
  const OneThread scope;
  double begin = processor_seconds();
  const auto body = body_on(triangulation, sample.degree);
  SolvePace &pace = place->second;
  const double n = sample.dofs();
  pace.assembly = (processor_seconds() - begin) / n;
  begin = processor_seconds();
  continuum::DirichletValues values;
  for (const unsigned int side : {continuum::boundary::left, continuum::boundary::right})
    continuum::prescribe(
        *body, side, 0, [](const dealii::Point<2> &) { return 0.; }, values);
  continuum::prescribe(
      *body, continuum::boundary::bottom, 1, [](const dealii::Point<2> &) { return 0.; },
      values);
  continuum::StaticSolver::Options options;
  options.method = direct ? continuum::StaticSolver::Method::direct
                          : continuum::StaticSolver::Method::conjugate_gradients;
  const continuum::StaticSolver solver(*body, body->stiffness(), values, options);
  pace.factor = (processor_seconds() - begin) / n;
  begin = processor_seconds();
  continuum::Vector force = body->make_vector(), displacement = body->make_vector();
  force = 1.;
  solver.solve(force, displacement);
  pace.solution = (processor_seconds() - begin) / n;
  measured_.push_back({std::string(direct ? "direct" : "iterative") + " solution on " +
                           place->first,
                       n, 1e9 * (pace.assembly + pace.factor + pace.solution), "a dof"});
  return pace;
}

const SolvePace &MachineSpeed::direct_solve(const MeshShape &mesh)
{
  return solve(mesh, true, direct_);
}

const SolvePace &MachineSpeed::iterative_solve(const MeshShape &mesh)
{
  return solve(mesh, false, iterative_);
}
} // namespace antiform::cases
