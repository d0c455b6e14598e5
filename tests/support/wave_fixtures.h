#pragma once
// Elastic bodies that carry waves through the program's loop.
#include "coupling/absorbing_component.h"
#include "support/coupling_loop.h"
#include "support/solid_fixtures.h"

#include <limits>

namespace antiform::testing
{
using continuum::ElasticMaterial;
using continuum::ElasticSolid;
using coupling::AbsorbingBoundary;
using coupling::Clock;
using coupling::Energies;
using coupling::LocalDamping;
using coupling::MeshMotion;
using coupling::MeshState;
using coupling::Simulation;
using coupling::Stage;
using coupling::Walls;
namespace boundary = continuum::boundary;

/// A mesh, its motion, and dashpots where a test asks for them.
class WaveBody
{
public:
  WaveBody(const std::function<void(Triangulation &)> &make_mesh,
           const ElasticMaterial &material,
           const unsigned int degree = 1)
      : triangulation_(MPI_COMM_WORLD)
  {
    omp_set_num_threads(1);
    make_mesh(triangulation_);
    solid_ = std::make_unique<ElasticSolid>(
        triangulation_, std::vector<ElasticMaterial>{material}, degree);
    mesh_ = std::make_unique<MeshState>(*solid_);
  }
  WaveBody(const WaveBody &) = delete;

  ElasticSolid &solid() { return *solid_; }
  MeshState &mesh() { return *mesh_; }
  std::vector<discrete::Wall> walls;

  /// Prescribe the dofs of this component where @p is_held(place) says so.
  void hold(const unsigned int component,
            const std::function<bool(const Point<2> &)> &is_held,
            const int wall = -1)
  {
    for (std::uint32_t i = 0; i < mesh_->mass.locally_owned_size(); ++i)
    {
      const auto dof = solid_->locally_owned().nth_index_in_set(i);
      if (solid_->component(dof) == component && is_held(solid_->support_point(dof)))
        mesh_->prescribe(i, wall);
    }
  }

  using Field = std::function<double(const Point<2> &, unsigned int)>;
  /// Displacement at time 0 [m], velocity half a step before [m/s].
  void start(const Field &displacement, const Field &velocity)
  {
    mesh_->displacement = interpolate(*solid_, displacement);
    mesh_->velocity = interpolate(*solid_, velocity);
  }

  /// The loop, with dashpots on @p absorbing faces and local damping. Prescribe dofs
  /// before.
  Simulation &make_loop(const double dt,
                        const continuum::BoundaryIds &absorbing,
                        const double damping = 0.)
  {
    simulation_ = std::make_unique<Simulation>(dt);
    auto &motion =
        simulation_->add(std::make_unique<MeshMotion>(*mesh_, walls),
                         {Stage::forces, Stage::kick, Stage::drift}, 5, "mesh", "test");
    if (damping > 0.)
      motion.damping =
          simulation_
              ->add(std::make_unique<LocalDamping>(nullptr, mesh_.get(), damping),
                    {Stage::damp, Stage::kick}, 50, "damping", "test")
              .mesh_forces();
    if (!walls.empty())
      simulation_->add(std::make_unique<Walls>(walls, nullptr, mesh_.get(), nullptr,
                                               [](double) { return 1.; }),
                       {Stage::forces, Stage::react, Stage::drift}, 40, "walls", "test");
    if (!absorbing.empty())
      simulation_->add(std::make_unique<AbsorbingBoundary>(
                           *mesh_, continuum::absorbing_dashpots(*solid_, absorbing)),
                       {Stage::damp, Stage::kick, Stage::drift}, 60, "dashpots", "test");
    simulation_->add(
        std::make_unique<coupling::test::Probe>([this](const Clock &) { record(); }),
        {Stage::sample}, 0, "probe", "test");
    return *simulation_;
  }

  /// Ledger over all ranks at the first step, every @p every steps and the last of @p n.
  std::vector<Energies> advance(const std::int64_t n, const std::int64_t every)
  {
    ledger_.clear();
    const std::int64_t last = simulation_->clock().step + n - 1;
    simulation_->set_sampler([=](const Clock &clock)
                             { return clock.step % every == 0 || clock.step == last; });
    for (std::int64_t i = 0; i < n; ++i)
      simulation_->step();
    return ledger_;
  }

private:
  void record()
  {
    Energies energies = simulation_->energies();
    for (double *const term : energies.terms())
      *term = dealii::Utilities::MPI::sum(*term, MPI_COMM_WORLD);
    ledger_.push_back(energies);
  }

  Triangulation triangulation_;
  std::unique_ptr<ElasticSolid> solid_;
  std::unique_ptr<MeshState> mesh_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<Energies> ledger_;
};

/// Kinetic and strain energy [J].
inline double stored(const Energies &energies)
{
  return energies.kinetic + energies.strain_continuum;
}
} // namespace antiform::testing
