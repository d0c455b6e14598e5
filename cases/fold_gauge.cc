#include "cases/fold_gauge.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
FoldGauge::FoldGauge(const Scene &scene)
    : scene_(scene)
    , surface_is_mesh_(scene.mesh && !scene.geometry.has_grain_cover())
{
  find_surface();
}

double FoldGauge::over_ranks(const double share) const
{
  return dealii::Utilities::MPI::sum(share, scene_.communicator());
}

double FoldGauge::half_width() const
{
  const SectionGeometry &g = scene_.geometry;
  return std::max(1.5 * g.diameter(), g.wavelength() / 40.);
}

void FoldGauge::find_surface()
{
  const SectionGeometry &g = scene_.geometry;
  if (surface_is_mesh_)
  {
    const auto partitioner = scene_.mesh->displacement.get_partitioner();
    for (const auto dof : scene_.solid->locally_owned())
    {
      const dealii::Point<2> x = scene_.solid->support_point(dof);
      if (scene_.solid->component(dof) == 1 && std::abs(x[0]) <= half_width() &&
          x[1] >= g.surface() - 1e-9 * g.thickness())
        surface_.push_back(partitioner->global_to_local(dof));
    }
    return;
  }
  for (const auto &[grain, width] : surface_grains(*scene_.grains, g))
    if (std::abs(scene_.grains->state.grains.reference_x[grain]) <= half_width())
      surface_.push_back(static_cast<std::uint32_t>(grain));
}

double FoldGauge::surface_uplift() const
{
  double sum = 0., n = static_cast<double>(surface_.size());
  for (const std::uint32_t i : surface_)
    sum += surface_is_mesh_ ? scene_.mesh->displacement.begin()[i]
                            : scene_.grains->state.grains.displacement_y[i];
  sum = over_ranks(sum);
  n = over_ranks(n);
  return n > 0. ? sum / n : 0.;
}

double FoldGauge::mean_uplift(const double x_reference, const double half_width) const
{
  double sum = 0., n = 0.;
  if (scene_.grains)
  {
    const discrete::Grains &grains = scene_.grains->state.grains;
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (is_layer(grains.region[i]) &&
          std::abs(grains.reference_x[i] - x_reference) <= half_width)
      {
        sum += grains.displacement_y[i];
        n += 1.;
      }
  }
  else
  {
    const SectionGeometry &g = scene_.geometry;
    const double eps = 1e-9 * g.thickness();
    for (const auto dof : scene_.solid->locally_owned())
    {
      const dealii::Point<2> x = scene_.solid->support_point(dof);
      if (scene_.solid->component(dof) == 1 &&
          std::abs(x[0] - x_reference) <= half_width && x[1] <= g.layer_top(x[0]) + eps &&
          x[1] >= g.layer_bottom(x[0]) - eps)
      {
        sum += scene_.mesh->displacement(dof);
        n += 1.;
      }
    }
  }
  sum = over_ranks(sum);
  n = over_ranks(n);
  return n > 0. ? sum / n : 0.;
}

FoldGauge::Reading FoldGauge::measure() const
{
  const SectionGeometry &g = scene_.geometry;
  Reading reading;
  // Crest over the two troughs, each a window of one cell of a fortieth of the wave.
  const double half_width = this->half_width();
  const double trough = std::min(0.5 * g.wavelength(), 0.5 * g.length() - half_width);
  const double crest_uplift = mean_uplift(0., half_width);
  const double trough_uplift =
      0.5 * (mean_uplift(-trough, half_width) + mean_uplift(trough, half_width));
  reading.fold_amplitude = g.amplitude() + crest_uplift - trough_uplift;
  // Dip between an eighth and three eighths of the wave, where the limb is straight.
  const double inner = 0.25 * trough, outer = 0.75 * trough;
  double steepest = 0.;
  for (const double side : {-1., 1.})
  {
    const double rise = g.axis(side * inner) + mean_uplift(side * inner, half_width) -
                        g.axis(side * outer) - mean_uplift(side * outer, half_width);
    steepest = std::max(steepest, std::atan(rise / (outer - inner)));
  }
  reading.limb_dip = steepest * 180. / M_PI;
  reading.surface_uplift = surface_uplift();
  return reading;
}
} // namespace antiform::cases
