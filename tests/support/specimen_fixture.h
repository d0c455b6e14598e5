#pragma once
// A packed specimen between platens that hold the grains of its end rows. Mean grain
// diameter 1 m, otherwise the strengths and stiffnesses of a hard rock.
#include "coupling/event_driver.h"
#include "coupling/grain_balance.h"
#include "discrete/packing.h"

#include <omp.h>

#include <algorithm>
#include <vector>

namespace antiform::coupling::test
{
/// Tension strength over cohesion 1/4, Coulomb's bond, friction of broken elements.
inline discrete::FlatJoint rock_law()
{
  return {}; // the defaults: E* 50 GPa, 15 and 60 MPa, tan 0.14, mu 0.4
}

/// \p width times twice as high, in mean grain diameters: about 2.1 width^2 grains.
struct Specimen
{
  GrainState state;
  std::vector<PrescribedMotion> platens; ///< unit load: unit shortening of the height
  double width = 0., height = 0.;        ///< between the centres of the end rows [m]

  Specimen(const double size,
           const std::uint64_t seed,
           const discrete::FlatJoint &law = rock_law())
      : width(size)
  {
    omp_set_num_threads(1); // too small to share out
    discrete::PackingParameters packing;
    packing.seed = seed;
    const double top = 2. * size;
    fill({{0., 0.}, {size, 0.}, {size, top}, {0., top}}, packing, law);
    add_platens(top);
  }
  Specimen(const Specimen &) = delete;

  /// Stress for the force conjugate to the shortening, compression positive [Pa].
  double stress(const double force) const { return force / (width * height); }
  std::size_t n_grains() const { return state.grains.size(); }

protected:
  Specimen() { omp_set_num_threads(1); }

  void fill(const std::vector<Vec2> &outline,
            const discrete::PackingParameters &packing,
            const discrete::FlatJoint &law)
  {
    for (const discrete::Disk &disk : discrete::pack_polygon(outline, packing).disks)
      state.grains.add(disk.centre, disk.radius, 2600., 0);
    state.joints.begin_group(law, 0, "rock");
    for (const auto &[i, j] :
         discrete::pairs_within(state.grains, 0.5 * packing.installation_gap_ratio, 0, 0))
      state.joints.add(state.grains, i, j, law.effective_modulus, law.effective_modulus);
    state.joints.finish(state.grains.size());
  }

private:
  /// Frictionless: grains that touch an end keep to it; one of them is held sideways.
  void add_platens(const double top)
  {
    const discrete::Grains &grains = state.grains;
    height = top - 1.; // between rows of mean grains
    bool is_first = true;
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      const auto number = static_cast<std::int32_t>(i);
      const double y = grains.reference_y[i], r = grains.radius[i];
      if (y - r < 0.1)
      {
        platens.push_back({number, 1, 0.});
        if (is_first)
          platens.push_back({number, 0, 0.});
        is_first = false;
      }
      else if (y + r > top - 0.1)
        platens.push_back({number, 1, -height});
    }
  }
};

/// Pressure on both sides as forces on the grains there [N per grain].
inline std::vector<GrainLoad> side_loads(const Specimen &specimen, const double force)
{
  const discrete::Grains &grains = specimen.state.grains;
  std::vector<GrainLoad> loads;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    const auto number = static_cast<std::int32_t>(i);
    const double x = grains.reference_x[i], r = grains.radius[i];
    if (x - r < 0.1)
      loads.push_back({number, {force, 0.}, 0.});
    else if (x + r > specimen.width - 0.1)
      loads.push_back({number, {-force, 0.}, 0.});
  }
  return loads;
}
} // namespace antiform::coupling::test
