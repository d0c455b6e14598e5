#include "cases/mechanism.h"

#include "continuum/layer_theory.h"

#include <cmath>
#include <vector>

namespace antiform::cases
{
namespace theory = continuum::theory;

Mechanism expect_mechanism(const Parameters &p, const SectionGeometry &g)
{
  const LayerParameters &l = p.layer;
  const theory::Layer layer{l.young_modulus, l.poisson_ratio, l.thickness};
  Mechanism e{};
  // The thesis' plot uses E and not the plane modulus; so do its ratios here.
  e.slenderness_ratio = theory::slenderness_ratio(l.young_modulus, l.compressive_strength,
                                                  g.wavelength(), l.thickness);
  e.critical_length_ratio =
      theory::critical_slenderness(l.young_modulus, l.compressive_strength) /
      std::sqrt(12.);
  std::vector<theory::Side> sides;
  if (p.has("matrix"))
  {
    const double E0 = p.matrix_modulus(), nu0 = p.matrix.poisson_ratio;
    sides.push_back({E0, nu0, p.matrix.burial_depth_ratio * l.thickness,
                     theory::Side::FarFace::free, 0.});
    theory::Side base{E0, nu0, p.matrix.base_depth_ratio * l.thickness,
                      theory::Side::FarFace::smooth_rigid, 0.};
    if (p.has("foundation"))
    {
      base.far_face = theory::Side::FarFace::spring;
      base.far_spring = p.foundation.stiffness_ratio * E0 / l.thickness;
    }
    else if (p.matrix.base == "fixed")
      base.far_face = theory::Side::FarFace::rough_rigid;
    sides.push_back(base);
  }
  const theory::SupportedLayer bare{layer, {}, 0., false};
  const theory::SupportedLayer buried{layer, sides, 0., false};
  // Ends that may turn: half a wave in L; ends guided by the walls: a full wave.
  const double half = M_PI / g.wavelength(), full = 2. * half;
  const double crushing = l.compressive_strength * l.thickness;
  e.bare_pinned = bare.buckling_force(half) / crushing;
  e.bare_guided = bare.buckling_force(full) / crushing;
  e.pinned = buried.buckling_force(half) / crushing;
  e.guided = buried.buckling_force(full) / crushing;
  e.crushes_first = e.guided > 1.5;
  return e;
}
} // namespace antiform::cases
