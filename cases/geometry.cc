#include "cases/geometry.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
SectionGeometry::SectionGeometry(const Parameters &p)
    : length_(p.section_length())
    , thickness_(p.layer.thickness)
    , wavelength_(p.layer_length())
    , diameter_(p.grain_diameter())
    , has_matrix_(p.has("matrix"))
    , has_grain_cover_(p.has_grain_cover())
{
  if (p.layer.shape == "cosine")
    amplitude_ = p.layer.amplitude_ratio * thickness_;
  surface_ = amplitude_ + 0.5 * thickness_;
  base_ = -0.5 * thickness_;
  if (has_matrix_)
  {
    surface_ += p.matrix.burial_depth_ratio * thickness_;
    base_ -= p.matrix.base_depth_ratio * thickness_;
  }
  if (p.is_bridged())
    buffer_ = p.bridging.buffer * diameter_;
  const double width = p.matrix.cell_aspect * p.matrix.cell_size * diameter_;
  n_columns_ = std::max(1u, static_cast<unsigned int>(std::lround(length_ / width)));
}

double SectionGeometry::axis(const double x) const
{
  if (amplitude_ == 0. || std::abs(x) >= 0.5 * wavelength_)
    return 0.;
  return 0.5 * amplitude_ * (1. + std::cos(2. * M_PI * x / wavelength_));
}

double SectionGeometry::rim(const double x, const bool top) const
{
  if (top && has_grain_cover_)
    return surface_;
  const double width = length_ / n_columns_;
  const double column =
      std::clamp(std::floor((x - x_min()) / width), 0., n_columns_ - 1.);
  const double x0 = x_min() + column * width, s = (x - x0) / width;
  const auto at = [&](const double place)
  { return top ? layer_top(place) + buffer_ : layer_bottom(place) - buffer_; };
  return (1. - s) * at(x0) + s * at(x0 + width);
}

double SectionGeometry::core_top(const double x) const
{
  return rim(x, true);
}
double SectionGeometry::core_bottom(const double x) const
{
  return rim(x, false);
}

double SectionGeometry::distance_to_core(const Vec2 &point) const
{
  const double above = point.y - core_top(point.x),
               below = core_bottom(point.x) - point.y;
  const double height = std::max(above, below);
  if (height <= 0.)
    return 0.;
  // The nearest point of the rim lies within the vertical distance of it.
  const bool top = above > 0.;
  const double width = length_ / n_columns_;
  const auto column = [&](const double x)
  {
    return std::clamp(static_cast<long>(std::floor((x - x_min()) / width)), 0l,
                      long(n_columns_) - 1);
  };
  double nearest = height;
  for (long c = column(point.x - height); c <= column(point.x + height); ++c)
  {
    const double x0 = x_min() + static_cast<double>(c) * width;
    const Vec2 a{x0, rim(x0, top)};
    const Vec2 b{x0 + width, rim(std::min(x0 + width, x_max()), top)};
    const Vec2 edge = b - a;
    const double s = std::clamp(dot(point - a, edge) / dot(edge, edge), 0., 1.);
    nearest = std::min(nearest, norm(point - (a + s * edge)));
  }
  return nearest;
}

std::vector<Vec2> SectionGeometry::layer_outline() const
{
  const int n = amplitude_ == 0.
                    ? 1
                    : std::max(1, static_cast<int>(std::ceil(length_ / diameter_)));
  std::vector<Vec2> outline;
  for (int k = 0; k <= n; ++k)
  {
    const double x = x_min() + length_ * k / n;
    outline.push_back({x, layer_bottom(x)});
  }
  for (int k = n; k >= 0; --k)
  {
    const double x = x_min() + length_ * k / n;
    outline.push_back({x, layer_top(x)});
  }
  return outline;
}
} // namespace antiform::cases
