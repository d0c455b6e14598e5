// Linear buckling of a bonded layer in a soft matrix: grains and mesh against grains
// alone, which is all that a run of grains could do without a mesh.
#include "support/figures.h"
#include "support/layered_section.h"

#include "continuum/layer_theory.h"

#include <gtest/gtest.h>

namespace antiform::coupling::test::buckling_of_a_bonded_layer_tests
{
namespace
{
struct Load
{
  double strain; ///< critical shortening
  int half_waves;
};

std::vector<Load> lowest(const LayeredSection &section,
                         const StrainMeasure measure = StrainMeasure::biot,
                         const unsigned int n = 2)
{
  std::vector<Load> loads;
  for (const CoupledMode &mode : section.modes(n, measure))
  {
    const auto [waves, share] = section.half_waves(mode);
    if (loads.size() < 2)
    {
      EXPECT_GT(share, 0.7); // the layer's shape is mainly one wave
    }
    EXPECT_LT(mode.residual, 1e-6);
    // Round-off of the saddle point, by the processor up to 1.2e-10.
    EXPECT_LT(mode.gap, 1e-9);
    loads.push_back({mode.load_factor, waves});
  }
  EXPECT_EQ(loads.size(), n);
  return loads;
}

/// Rows of the table: loads and waves of both models, and their grains.
struct Comparison
{
  double share = 0.; ///< of the coupled model's grains in those of grains alone
  std::vector<Load> grains, coupled;

  Comparison(const std::string &name,
             const LayerShape &shape,
             const unsigned int n = 2,
             const RandomRock *const rock = nullptr)
  {
    const LayeredSection alone(shape, false, rock), joined(shape, true, rock);
    share =
        static_cast<double>(joined.n_grains()) / static_cast<double>(alone.n_grains());
    std::printf("  %s: %zu of %zu grains (%.0f %%);", name.c_str(), joined.n_grains(),
                alone.n_grains(), 100. * share);
    ::testing::Test::RecordProperty(name + " grains alone",
                                    static_cast<int>(alone.n_grains()));
    ::testing::Test::RecordProperty(name + " grains coupled",
                                    static_cast<int>(joined.n_grains()));
    grains = lowest(alone, StrainMeasure::biot, n);
    coupled = lowest(joined, StrainMeasure::biot, n);
    for (std::size_t k = 0; k < std::min(grains.size(), coupled.size()); ++k)
      std::printf(" %.5f (%d) %+.2f %% (%d)", grains[k].strain, grains[k].half_waves,
                  100. * error(k), coupled[k].half_waves);
    std::printf("\n");
  }
  double error(const std::size_t k) const
  {
    return coupled[k].strain / grains[k].strain - 1.;
  }
};

/// Loads side by side, as a table of its own.
void draw(const std::string &name, const LayerShape &shape, const Comparison &found)
{
  std::string file = "buckling_" + name;
  for (char &c : file)
    if (c == ' ' || c == '/' || c == ',')
      c = '_';
  antiform::test::Figure figure(
      file, "contrast,cover_over_thickness,mode,grains,coupled,half_waves,share");
  for (std::size_t k = 0; k < found.coupled.size(); ++k)
    figure.add({shape.contrast, shape.cover_rows / shape.n_rows(),
                static_cast<double>(k + 1), found.grains[k].strain,
                found.coupled[k].strain, static_cast<double>(found.grains[k].half_waves),
                found.share});
}

/// \param most_grains of the coupled model, over those of grains alone
void compare(const std::string &name, const LayerShape &shape, const double most_grains)
{
  const Comparison found(name, shape);
  draw(name, shape, found);
  EXPECT_LE(found.share, most_grains);
  for (std::size_t k = 0; k < 2; ++k)
  {
    // Asked for is 2 %. What the weighted overlap leaves is the mismatch of its patch
    // test, 1e-3 of strain, in a part of the stiffness, and the mesh's cells.
    EXPECT_NEAR(found.error(k), 0., 5e-3);
    EXPECT_EQ(found.coupled[k].half_waves, found.grains[k].half_waves);
  }
}

LayerShape
shape(const double contrast, const int cover_rows, const int base_rows, const int length)
{
  LayerShape result;
  result.contrast = contrast;
  result.cover_rows = cover_rows;
  result.base_rows = base_rows;
  result.length = length;
  return result;
}

std::string named(const double contrast, const std::string &cover_over_thickness)
{
  return "contrast " + std::to_string(static_cast<int>(contrast)) + ", H/h " +
         cover_over_thickness;
}
} // namespace

// Cover as thick as the layer: it is of grains, mesh is below only.
TEST(BucklingOfABondedLayer, UnderThinCoverIsThatOfGrainsAlone)
{
  compare("contrast 20, H/h 1", shape(20., 5, 45, 60), 0.45);
  compare("contrast 100, H/h 1", shape(100., 5, 45, 70), 0.45);
}

TEST(BucklingOfABondedLayer, IsCountedByTheInertia)
{
  const LayeredSection section(shape(100., 5, 45, 70), true);
  const auto loads = lowest(section);
  for (const auto &[strain, n] :
       {std::pair{0.9999 * loads[0].strain, 0}, std::pair{1.0001 * loads[0].strain, 1},
        std::pair{0.9999 * loads[1].strain, 1}, std::pair{1.0001 * loads[1].strain, 2}})
    EXPECT_EQ(section.n_unstable(strain, StrainMeasure::biot), n);
}

namespace
{
/// Shortening at which the present state loses its stability, to 1e-3 of itself.
double limit_of_stability(LayeredSection &section, const bool mesh_turns)
{
  double stable = 0.02, unstable = 0.05;
  EXPECT_EQ(section.n_unstable_now(stable, mesh_turns), 0);
  EXPECT_GT(section.n_unstable_now(unstable, mesh_turns), 0);
  while (unstable - stable > 1e-3 * stable)
  {
    const double middle = 0.5 * (stable + unstable);
    (section.n_unstable_now(middle, mesh_turns) == 0 ? stable : unstable) = middle;
  }
  return 0.5 * (stable + unstable);
}
} // namespace

// The state itself is looked at, shortened as it is, not the linear one: both differ by
// the order of the shortening, 3 %.
TEST(BucklingOfABondedLayer, ThePresentStateLosesItsStabilityNearTheLinearLoadLong)
{
  LayeredSection alone(shape(100., 5, 45, 70), false),
      joined(shape(100., 5, 45, 70), true);
  const double linear = lowest(alone)[0].strain,
               of_grains = limit_of_stability(alone, true),
               with_mesh = limit_of_stability(joined, true),
               mesh_of_runs = limit_of_stability(joined, false);
  std::printf("  linear %.5f; present state: grains %+.2f %%; coupled over grains %+.2f "
              "%%, mesh without geometric stiffness %+.2f %%\n",
              linear, 100. * (of_grains / linear - 1.),
              100. * (with_mesh / of_grains - 1.),
              100. * (mesh_of_runs / of_grains - 1.));
  EXPECT_NEAR(of_grains / linear, 1., 0.06); // twice the shortening
  EXPECT_NEAR(with_mesh / of_grains, 1., 0.02);
  EXPECT_NEAR(mesh_of_runs / of_grains, 1., 0.06);
}

// What the comparison would show of a wrong matrix: load goes by its modulus to the power
// 2/3 where the matrix is thick, half the modulus in the mesh alone by a part of that.
TEST(BucklingOfABondedLayer, AMeshOfHalfTheModulusIsNoticed)
{
  LayerShape wrong = shape(100., 5, 45, 70);
  wrong.mesh_modulus_ratio = 0.5;
  const double right = lowest(LayeredSection(shape(100., 5, 45, 70), true))[0].strain,
               found = lowest(LayeredSection(wrong, true))[0].strain;
  std::printf("  mesh of half the modulus: %+.1f %%\n", 100. * (found / right - 1.));
  EXPECT_LT(found, 0.97 * right);
  EXPECT_GT(found, std::pow(0.5, 2. / 3.) * right);
}

// The twelve of the table: covers of 0.1, 1, 5 and 10 layers, contrasts of 20, 100, 1e4.
// Ten rows of grains make the layer under one row of cover, else five, or three where the
// wave would be longer than a section of grains alone can be. At a contrast of 1e4 even so
// the base is shallower than the wave and makes it shorter, in both models alike.
TEST(BucklingOfABondedLayer, OfTableThinCoverLong)
{
  for (const auto &[contrast, length] :
       {std::pair{20., 180}, std::pair{100., 180}, std::pair{1e4, 280}})
  {
    LayerShape thin = shape(contrast, 1, 90, length);
    thin.half_rows = 4.5;
    compare(named(contrast, "0.1"), thin, 0.3);
  }
}

TEST(BucklingOfABondedLayer, OfTableEqualCoverLong)
{
  compare("contrast 20, H/h 1, wide", shape(20., 5, 80, 160), 0.3);
  compare("contrast 100, H/h 1, wide", shape(100., 5, 80, 160), 0.3);
  LayerShape soft = shape(1e4, 3, 72, 250);
  soft.half_rows = 1.;
  compare(named(1e4, "1"), soft, 0.3);
}

TEST(BucklingOfABondedLayer, OfTableThickCoverLong)
{
  for (const auto &[contrast, length] :
       {std::pair{20., 120}, std::pair{100., 140}, std::pair{1e4, 250}})
    compare(named(contrast, "5"), shape(contrast, 25, 90, length), 0.3);
}

TEST(BucklingOfABondedLayer, OfTableVeryThickCoverLong)
{
  compare(named(20., "10"), shape(20., 50, 60, 120), 0.3);
  compare(named(100., "10"), shape(100., 50, 60, 140), 0.3);
  LayerShape soft = shape(1e4, 30, 72, 250);
  soft.half_rows = 1.;
  compare(named(1e4, "10"), soft, 0.3);
}

// Two cells of overlap and nothing between it and the layer: the mode is long beside
// both.
TEST(BucklingOfABondedLayer, NeedsNoWideOverlapLong)
{
  LayerShape narrow = shape(100., 25, 60, 140);
  narrow.overlap = 4.;
  narrow.buffer = 0.;
  compare("contrast 100, H/h 5, overlap 4, no buffer", narrow, 0.17);
}

// Eight of them: the asked 3 % beyond the second; loads by size, since waves change
// places where loads are within some tenths of a percent.
TEST(BucklingOfABondedLayer, HigherModesLong)
{
  const LayerShape eight = shape(100., 25, 60, 140);
  const std::string name = "contrast 100, H/h 5, eight";
  const Comparison found(name, eight, 8);
  draw(name, eight, found);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(found.error(k), 0., k < 2 ? 5e-3 : 1e-2) << k;
}

// A packing scatters the modulus of the mesh's cells by percents, the mesh has the mean.
TEST(BucklingOfABondedLayer, OfRandomPackingLong)
{
  for (const auto &[contrast, seed] :
       {std::pair{100., 5}, std::pair{100., 6}, std::pair{20., 7}})
  {
    const LayerShape random = shape(contrast, 5, 60, 120);
    const RandomRock rock(random, static_cast<std::uint64_t>(seed));
    const Comparison found("contrast " + std::to_string(static_cast<int>(contrast)) +
                               ", H/h 1, random " + std::to_string(seed),
                           random, 2, &rock);
    draw("random " + std::to_string(seed), random, found);
    EXPECT_LE(found.share, 0.4);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(found.error(k), 0., 0.02);
    if (found.grains[1].strain > 1.03 * found.grains[0].strain)
    {
      EXPECT_EQ(found.coupled[0].half_waves, found.grains[0].half_waves);
    }
  }
}

// Neither grains nor mesh in it: a thick beam bonded to elastic layers, free above, on a
// smooth base.
TEST(BucklingOfABondedLayer, IsThatOfAThickBeamInItsMatrixLong)
{
  LayerShape thick = shape(1000., 9, 90, 340);
  thick.half_rows = 4.;
  const LayeredSection section(thick, true);
  const auto C = lattice_material(elastic_law()).stiffness;
  const double nu = C[0][1] / (C[0][0] + C[0][1]), E = (C[0][0] - C[0][1]) * (1. + nu);
  namespace theory = continuum::theory;
  theory::SupportedLayer layer;
  layer.layer = {E, nu, thick.thickness()};
  layer.sides = {
      {E / thick.contrast, nu, thick.top() - thick.edge(), theory::Side::FarFace::free},
      {E / thick.contrast, nu, -thick.edge() - thick.bottom(),
       theory::Side::FarFace::smooth_rigid}};
  layer.thick = layer.bonded = true;
  for (const Load &load : lowest(section))
  {
    const double k = load.half_waves * M_PI / thick.length;
    const double expected =
        layer.buckling_force(k) / (layer.layer.plane_modulus() * layer.layer.thickness);
    std::printf("  %d half waves: %.6f, closed form %+.2f %%\n", load.half_waves,
                load.strain, 100. * (expected / load.strain - 1.));
    // Nine rows of grains bend as a sheet of their height up to 1/81 and the joints' own
    // moments, some percents of D; walls hold the first grain of each row.
    EXPECT_NEAR(load.strain / expected, 1., 0.03);
  }
}

// Joints answer to the stretch in their own frame, which is Biot's strain. A mesh with
// Green's is off by the order of the strain, here a tenth; and the wave may be another.
TEST(BucklingOfABondedLayer, GreensStrainInTheMeshIsWorseLong)
{
  const LayerShape strongly_strained = shape(20., 25, 60, 120);
  const double grains = lowest(LayeredSection(strongly_strained, false))[0].strain;
  const LayeredSection coupled(strongly_strained, true);
  const double biot = lowest(coupled)[0].strain / grains - 1.,
               green = lowest(coupled, StrainMeasure::green)[0].strain / grains - 1.;
  std::printf("  error with Biot's strain %+.2f %%, with Green's %+.2f %%\n", 100. * biot,
              100. * green);
  EXPECT_NEAR(biot, 0., 5e-3);
  EXPECT_LT(std::abs(biot), 0.5 * std::abs(green));
}
} // namespace antiform::coupling::test::buckling_of_a_bonded_layer_tests
