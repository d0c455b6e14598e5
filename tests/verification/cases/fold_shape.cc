// What a run says of the shape of its fold, against folds of known shape that are put into
// a scene. tests/decks/fold.prm
#include "support/program.h"

#include "cases/fold_gauge.h"
#include "cases/scene.h"

#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>

namespace fold_shape_tests
{
using namespace antiform;

// A cosine of amplitude b on that of the deck: crest over troughs a0 + b, and between an
// eighth and three eighths of the wave a chord of slope 2 sqrt(2) (a0 + b)/L. Readings are
// means over windows of w = 1.5 d to either side (d = h/4, L = 10 h), which see of a cosine
// s = sin(q)/q, q = 2 pi w/L = 0.236: 0.9 % less; those of the troughs lie half in the flat
// ends. Which grains lie in a window is chance: their mean place is off by w/sqrt(3 n),
// n = 12, or less, which on the steepest part is 2 % of b.
TEST(FoldShape, AmplitudeAndDipAreThoseOfAKnownCosine)
{
  const auto scene =
      cases::build(cases::read_deck(ANTIFORM_SOURCE_DIR "/tests/decks/fold.prm", {}),
                   MPI_COMM_SELF, [](const std::string &) {});
  const cases::SectionGeometry &g = scene->geometry;
  const cases::FoldGauge gauge(*scene);
  const double a0 = g.amplitude(), L = g.wavelength();
  ASSERT_EQ(a0, 5.);
  discrete::Grains &grains = scene->grains->state.grains;
  for (const double b : {0., 10., 20.})
  {
    for (std::size_t i = 0; i < grains.size(); ++i)
      if (std::abs(grains.reference_x[i]) < 0.5 * L)
        grains.displacement_y[i] =
            0.5 * b * (1. + std::cos(2. * M_PI * grains.reference_x[i] / L));
    const cases::FoldGauge::Reading reading = gauge.measure();
    const double q = 2. * M_PI * 1.5 * g.diameter() / L, seen = std::sin(q) / q;
    EXPECT_NEAR(reading.fold_amplitude, a0 + (0.25 + 0.75 * seen) * b, 1e-9 + 0.01 * b);
    const double slope = 2. * std::sqrt(2.) * (a0 + seen * b) / L;
    // 2 % of b over L/4 and both ends of the chord: 0.06 degrees a metre, seen 0.02.
    EXPECT_NEAR(reading.limb_dip, 180. / M_PI * std::atan(slope), 1e-9 + 0.06 * b);
  }
}
} // namespace fold_shape_tests
