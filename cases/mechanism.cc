#include "cases/mechanism.h"

#include <cmath>

namespace antiform::cases
{
namespace theory = continuum::theory;

theory::Layer layer_of(const Parameters &p)
{
  return {p.layer.young_modulus, p.layer.poisson_ratio, p.layer.thickness};
}

std::vector<theory::Side> matrix_sides(const Parameters &p)
{
  if (!p.has("matrix"))
    return {};
  const double E0 = p.matrix_modulus(), nu0 = p.matrix.poisson_ratio;
  const double h = p.layer.thickness;
  theory::Side cover{E0, nu0, p.matrix.burial_depth_ratio * h,
                     theory::Side::FarFace::free, 0.};
  theory::Side base{E0, nu0, p.matrix.base_depth_ratio * h,
                    theory::Side::FarFace::smooth_rigid, 0.};
  if (p.has_foundation_under("top"))
  {
    cover.far_face = theory::Side::FarFace::spring;
    cover.far_spring = p.foundation_stiffness();
    cover.far_shear = p.foundation_shear();
  }
  if (p.has_foundation_under("base"))
  {
    base.far_face = theory::Side::FarFace::spring;
    base.far_spring = p.foundation_stiffness();
    base.far_shear = p.foundation_shear();
  }
  else if (p.matrix.base == "fixed")
    base.far_face = theory::Side::FarFace::rough_rigid;
  return {cover, base};
}

theory::SupportedLayer supported_layer(const Parameters &p)
{
  theory::SupportedLayer layer{layer_of(p), matrix_sides(p)};
  layer.bonded =
      p.matrix.interface == "cemented" || p.matrix.interface == "frictional";
  for (const std::string face : {"base", "top"})
    if (!p.has("matrix") && p.has_foundation_under(face) && !p.foundation.lifts_off)
    {
      layer.direct_foundation += p.foundation_stiffness();
      layer.direct_shear += p.foundation_shear();
    }
  return layer;
}

Mechanism expect_mechanism(const Parameters &p, const SectionGeometry &g)
{
  const LayerParameters &l = p.layer;
  const theory::Layer layer = layer_of(p);
  Mechanism e{};
  // The thesis' plot uses E and not the plane modulus; so do its ratios here.
  e.slenderness_ratio = theory::slenderness_ratio(l.young_modulus, l.compressive_strength,
                                                  g.wavelength(), l.thickness);
  e.critical_length_ratio =
      theory::critical_slenderness(l.young_modulus, l.compressive_strength) /
      std::sqrt(12.);
  const theory::SupportedLayer bare{layer, {}, 0., false};
  const theory::SupportedLayer buried = supported_layer(p);
  const double crushing = l.compressive_strength * l.thickness;
  if (l.shape == "straight") // free to choose among m half waves, whatever its ends
  {
    e.bare_pinned = e.bare_guided = bare.critical_mode(g.length()).force / crushing;
    e.pinned = e.guided = buried.critical_mode(g.length()).force / crushing;
    e.crushes_first = e.guided > 1.5;
    return e;
  }
  // Ends that may turn: half a wave in L; ends guided by the walls: a full wave.
  const double half = M_PI / g.wavelength(), full = 2. * half;
  e.bare_pinned = bare.buckling_force(half) / crushing;
  e.bare_guided = bare.buckling_force(full) / crushing;
  e.pinned = buried.buckling_force(half) / crushing;
  e.guided = buried.buckling_force(full) / crushing;
  e.crushes_first = e.guided > 1.5;
  return e;
}
} // namespace antiform::cases
