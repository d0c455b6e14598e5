#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "continuum/elastic_solid.h"
#include "continuum/linear_buckling.h"

#include <mpi.h>

#include <functional>
#include <memory>
#include <vector>

namespace antiform::cases
{
/// One of the lowest loads of a section.
struct Mode
{
  double shortening;       ///< [-]
  double stress;           ///< of the layer [Pa]
  unsigned int half_waves; ///< along the section
};

/// A straight section of finite elements and how it buckles; its cells can be refined
/// where the lowest mode is in error. Collective.
class BucklingSection
{
public:
  BucklingSection(const Parameters &parameters, MPI_Comm communicator);

  const Parameters &parameters() const { return p_; }
  const SectionGeometry &geometry() const { return geometry_; }
  const continuum::ElasticSolid &solid() const { return *solid_; }
  MPI_Comm communicator() const { return mesh_->get_communicator(); }

  /// Lowest loads and shapes; \param stop as of BucklingOptions. Throws BucklingStopped.
  void solve(const std::function<bool()> &stop);
  /// Of the last solve(), ascending.
  const std::vector<Mode> &modes() const { return modes_; }
  const std::vector<continuum::BucklingMode> &shapes() const { return shapes_; }

  /// Estimated relative error of the lowest load times a factor of some 2 to 10
  /// (error_indicator.h) [-].
  double estimate() const;
  /// Refine the cells with the deck's share of the lowest three modes' estimates (the
  /// dominant wavelength needs the neighbours) and build the section anew: modes are
  /// gone. False: there is nothing to refine.
  bool refine();

private:
  void build();
  double layer_stress(const continuum::Vector &displacement) const;
  unsigned int half_waves(const continuum::Vector &shape) const;
  std::vector<double> indicators(const continuum::BucklingMode &mode) const;

  const Parameters &p_;
  SectionGeometry geometry_;
  std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> mesh_;
  std::unique_ptr<continuum::ElasticSolid> solid_;
  continuum::Vector straight_; ///< under the shortening of factor 1 [m]
  std::vector<continuum::BucklingMode> shapes_;
  std::vector<Mode> modes_;
};
} // namespace antiform::cases
