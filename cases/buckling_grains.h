#pragma once

#include "cases/scene.h"
#include "cases/straight_section.h"
#include "coupling/coupled_buckling.h"

#include <memory>
#include <vector>

namespace antiform::cases
{
/// A straight section whose layer is grains, in a matrix of grains or of finite elements,
/// bonds whole: the scene that a stepped run of the same deck begins with. Its prestress
/// is the linear static state under the shortening; wall contacts that would pull are let
/// go. One rank.
class BucklingGrains : public StraightSection
{
public:
  /// Throws as build_bodies().
  BucklingGrains(const Parameters &parameters,
                 MPI_Comm communicator,
                 const Progress &progress);

  MPI_Comm communicator() const override { return MPI_COMM_SELF; }
  std::map<std::string, std::int64_t> sizes() const override;
  /// Throws NumericalError where a part is loose, and as lowest_coupled_modes().
  void solve(const std::function<bool()> &stop) override;
  /// Of each mode grains (mode_0001_grains) and mesh (mode_0001), at their places with
  /// the displacement to warp by; of the straight section at the lowest load
  /// straight_grains, straight_joints with their forces, straight.
  std::vector<coupling::PvdEntry>
  write_fields(const std::string &directory) const override;
  std::vector<std::string> doubts() const override;

private:
  /// Springs of wall contacts that are not @p open, by walls one after the other.
  coupling::StaticSystem supported(const std::vector<char> &open) const;
  /// Open the contacts that pull in @p state; how many.
  std::size_t open_pulling_contacts(const coupling::StaticSolution &state,
                                    std::vector<char> &open) const;
  /// Mean over the length of the force through the layer's joints and its walls'
  /// contacts, over its thickness [Pa], compression positive.
  double layer_stress(const coupling::StaticSystem &system,
                      const std::vector<char> &open) const;
  void find_half_waves();

  std::unique_ptr<Scene> scene_;
  coupling::StaticSolution straight_; ///< under the shortening of factor 1
  double straight_factor_ = 1.;       ///< of it at the lowest load
  std::size_t n_open_ = 0;            ///< wall contacts that would pull
  std::vector<coupling::CoupledMode> shapes_;
  std::vector<double> purity_; ///< of each mode: share of its main wave's amplitude [-]
};
} // namespace antiform::cases
