#pragma once

#include "cases/parameters.h"
#include "discrete/vec2.h"

#include <vector>

namespace antiform::cases
{
/// The undeformed section: competent layer between two curves, matrix above up to a flat
/// surface and below down to a flat base. x is 0 at the crest, y is 0 at the layer's axis
/// beside the fold. The burial depth H is measured above the crest.
class SectionGeometry
{
public:
  explicit SectionGeometry(const Parameters &parameters);

  double x_min() const { return -0.5 * length_; }
  double x_max() const { return 0.5 * length_; }
  double length() const { return length_; }
  double thickness() const { return thickness_; }
  double amplitude() const { return amplitude_; }
  double wavelength() const { return wavelength_; }
  double surface() const { return surface_; }
  double base() const { return base_; }
  double diameter() const { return diameter_; }
  bool has_matrix() const { return has_matrix_; }
  /// Grains reach up to the surface: the core has no rim above the layer.
  bool has_grain_cover() const { return has_grain_cover_; }

  /// Axis of the layer, a0/2 (1 + cos(2 pi x / L)) within half a wavelength of the crest.
  double axis(double x) const;
  double layer_top(double x) const { return axis(x) + 0.5 * thickness_; }
  double layer_bottom(double x) const { return axis(x) - 0.5 * thickness_; }

  /// Columns of the mesh; the rims of the core are straight between them, so that cells
  /// and core share their faces exactly.
  unsigned int n_columns() const { return n_columns_; }
  double core_top(double x) const;
  double core_bottom(double x) const;
  /// Distance to the core: the layer and the buffer (or the cover) of matrix grains
  /// beside it [m].
  double distance_to_core(const Vec2 &point) const;

  /// Outline of the layer, counter-clockwise, a vertex a grain diameter along the curves.
  std::vector<Vec2> layer_outline() const;

private:
  double rim(double x, bool top) const;

  double length_, thickness_, amplitude_ = 0., wavelength_, surface_, base_, diameter_;
  double buffer_ = 0.;
  bool has_matrix_, has_grain_cover_;
  unsigned int n_columns_;
};
} // namespace antiform::cases
