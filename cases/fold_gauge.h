#pragma once

#include "cases/scene.h"

#include <cstdint>
#include <vector>

namespace antiform::cases
{
/// Reads the shape of the fold: how far crest, troughs and surface have moved. Windows of
/// width() average over a few grains or nodes. Collective: the mesh may be on many ranks.
class FoldGauge
{
public:
  struct Reading
  {
    double fold_amplitude = 0.; ///< crest over troughs, mean of the thickness [m]
    double limb_dip = 0.;       ///< of the steeper limb, where it is straight [degrees]
    double surface_uplift = 0.; ///< of the section's top above the crest [m]
  };

  explicit FoldGauge(const Scene &scene);
  Reading measure() const;

private:
  double half_width() const; ///< of a window [m]
  void find_surface();
  double surface_uplift() const;
  double mean_uplift(double x_reference, double half_width) const;
  double over_ranks(double share) const;

  const Scene &scene_;
  bool surface_is_mesh_;
  /// Top of the section above the crest: mesh dofs, or grains where there is no mesh.
  std::vector<std::uint32_t> surface_;
};
} // namespace antiform::cases
