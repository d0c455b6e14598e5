#include "cases/fracture_pattern.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fracture_pattern_tests
{
using namespace antiform;
using namespace antiform::cases;
using discrete::Bond;
using discrete::Crack;

namespace
{
constexpr double diameter = 1., thickness = 10.;
constexpr int layer = 0, matrix = 1;

Crack crack_at(const double x,
               const double y,
               const double degrees = 90.,
               const double length = 1.,
               const Bond mode = Bond::broken_in_tension,
               const int region = layer)
{
  Crack crack;
  crack.reference_place = {x, y};
  crack.orientation = M_PI / 180. * degrees;
  crack.length = length;
  crack.mode = mode;
  crack.layer = region;
  return crack;
}

/// A fracture across the layer: @p n cracks a diameter apart.
void add_fracture(const double x,
                  const int n,
                  std::vector<Crack> &cracks,
                  const Bond mode = Bond::broken_in_tension,
                  const int region = layer)
{
  for (int k = 0; k < n; ++k)
    cracks.push_back(crack_at(x, k * diameter, 90., 1., mode, region));
}

/// A bent layer without a matrix, L = 100 m.
Parameters bent(const double amplitude_ratio)
{
  Parameters p;
  p.components = {"layer"};
  p.layer.thickness = thickness;
  p.layer.grains_across = thickness / diameter;
  p.layer.length_ratio = 10.;
  p.layer.amplitude_ratio = amplitude_ratio;
  return p;
}

Summary summary_of(const std::vector<Crack> &cracks, const FoldAtPeak &peak)
{
  Summary summary;
  report_fold(cracks, SectionGeometry(bent(0.5)), peak, summary);
  return summary;
}
} // namespace

TEST(FracturePattern, FracturesAreGroupsOfTensionCracksOfTheLayer)
{
  std::vector<Crack> cracks;
  add_fracture(25., 4, cracks);
  add_fracture(-20., 2, cracks); // from 0 to 1 m and an element wide: a fifth of h
  add_fracture(1., 3, cracks);
  cracks.push_back(crack_at(-5., 3.)); // alone: a tenth
  add_fracture(40., 5, cracks, Bond::broken_in_shear);
  add_fracture(50., 5, cracks, Bond::broken_in_tension, matrix);
  const std::vector<double> places = fracture_places(cracks, diameter, thickness);
  EXPECT_EQ(places, (std::vector<double>{-20., 1., 25.}));
  EXPECT_TRUE(fracture_places({}, diameter, thickness).empty());
}

TEST(FracturePattern, CracksWithinOneAndAHalfDiametersAreOne)
{
  for (const double apart : {1.49, 1.51})
  {
    const std::vector<Crack> cracks{crack_at(0., 0.), crack_at(apart, 0.)};
    EXPECT_EQ(fracture_places(cracks, diameter, thickness).size(), apart < 1.5 ? 1u : 0u)
        << apart;
  }
  // A chain is one, whatever the order in which its links come.
  std::vector<Crack> chain;
  for (const double x : {0., 5., 1., 4., 2., 3., -1.})
    chain.push_back(crack_at(x, -7.));
  EXPECT_EQ(fracture_places(chain, diameter, thickness), (std::vector<double>{2.}));
}

TEST(FracturePattern, AcrossIsAgainstTheDipOfTheLayer)
{
  // Slope pi a0/L at a quarter of the wave: 45 degrees with a0 = L/pi.
  const SectionGeometry steep(bent(10. / M_PI)), flat(bent(1e-9));
  const double limb = 25.; // down to the right
  const auto share = [&](const SectionGeometry &g, const double degrees) {
    return share_across({crack_at(limb, 0., degrees)}, g);
  };
  EXPECT_EQ(share(flat, 46.), 1.);
  EXPECT_EQ(share(flat, 44.), 0.);
  EXPECT_EQ(share(flat, -46.), 1.);
  EXPECT_EQ(share(steep, -1.), 0.); // 44 degrees from an axis that dips to -45
  EXPECT_EQ(share(steep, 1.), 1.);
  EXPECT_EQ(share(steep, -89.), 0.);
  // By length; cracks in shear and of the matrix do not count.
  EXPECT_DOUBLE_EQ(
      share_across({crack_at(0., 0., 90., 2.), crack_at(0., 0., 10., 1.),
                    crack_at(0., 0., 10., 5., Bond::broken_in_shear),
                    crack_at(0., 0., 10., 5., Bond::broken_in_tension, matrix)},
                   flat),
      2. / 3.);
  EXPECT_EQ(share_across({}, flat), 0.);
}

TEST(FracturePattern, MechanismFollowsTheGrowthOfTheFold)
{
  EXPECT_EQ(mechanism_of(1.), FoldMechanism::crushes);
  EXPECT_EQ(mechanism_of(1.99), FoldMechanism::crushes);
  EXPECT_EQ(mechanism_of(2.), FoldMechanism::folds_and_cracks);
  EXPECT_EQ(mechanism_of(9.99), FoldMechanism::folds_and_cracks);
  EXPECT_EQ(mechanism_of(10.), FoldMechanism::buckles);
}

TEST(FracturePattern, ResultsAreThoseOfTheCracksAndThePeak)
{
  std::vector<Crack> cracks;
  for (const double x : {-20., 1., 25.})
    add_fracture(x, 3, cracks);
  FoldAtPeak peak;
  peak.amplitude = 15.; // of 5 m as laid down
  peak.limb_dip = 12.;
  peak.n_tensile = 7.;
  peak.n_shear = 2.;
  const Summary summary = summary_of(cracks, peak);
  const auto value = [&](const std::string &name) { return summary.results.at(name).value; };
  EXPECT_EQ(value("tension_fractures"), 3.);
  EXPECT_EQ(value("crack_spacing"), 22.5);
  EXPECT_EQ(value("cracks_across_share"), 1.);
  EXPECT_EQ(value("cracks_tensile_at_peak"), 7.);
  EXPECT_EQ(value("cracks_shear_at_peak"), 2.);
  EXPECT_EQ(value("fold_amplitude_at_peak"), 15.);
  EXPECT_EQ(value("limb_dip_at_peak"), 12.);
  EXPECT_DOUBLE_EQ(value("fold_growth_at_peak"), 3.);
  EXPECT_EQ(value("mechanism"), 2.);
  // One fracture has no spacing, no crack no share.
  EXPECT_EQ(summary_of({cracks.begin(), cracks.begin() + 3}, peak)
                .results.count("crack_spacing"),
            0u);
  EXPECT_EQ(summary_of({}, peak).results.count("cracks_across_share"), 0u);
}
} // namespace fracture_pattern_tests
