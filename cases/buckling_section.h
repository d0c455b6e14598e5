#pragma once

#include "cases/straight_section.h"
#include "continuum/elastic_solid.h"
#include "continuum/linear_buckling.h"

#include <mpi.h>

#include <functional>
#include <memory>
#include <vector>

namespace antiform::cases
{
/// A straight section of finite elements; its cells can be refined where the lowest mode
/// is in error. Collective.
class BucklingSection : public StraightSection
{
public:
  BucklingSection(const Parameters &parameters, MPI_Comm communicator);

  MPI_Comm communicator() const override { return mesh_->get_communicator(); }
  std::map<std::string, std::int64_t> sizes() const override;
  void solve(const std::function<bool()> &stop) override;
  std::vector<coupling::PvdEntry>
  write_fields(const std::string &directory) const override;
  std::vector<std::string> doubts() const override;

  /// By error_indicator.h.
  double estimate() const override;
  /// Refine the cells with the deck's share of the lowest three modes' estimates (the
  /// dominant wavelength needs the neighbours) and build the section anew.
  bool refine() override;

private:
  void build();
  double layer_stress(const continuum::Vector &displacement) const;
  unsigned int half_waves(const continuum::Vector &shape) const;
  std::vector<double> indicators(const continuum::BucklingMode &mode) const;

  std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> mesh_;
  std::unique_ptr<continuum::ElasticSolid> solid_;
  continuum::Vector straight_; ///< under the shortening of factor 1 [m]
  std::vector<continuum::BucklingMode> shapes_;
};
} // namespace antiform::cases
