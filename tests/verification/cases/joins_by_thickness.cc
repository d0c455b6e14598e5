// What a cover's thickness makes of the join of layer and matrix, and the one join that
// only thin covers have: matrix grains up to the surface on a base of mesh.
// tests/decks/tiny.prm (d = h/6, buffer 2 d, overlap 4 d, cells 2 d: 8 d in all) and
// cases/burial-depth/buckling_grains.prm.
#include "support/tiny_run.h"

#include "cases/scene.h"

#include <mpi.h>

#include <fstream>

namespace joins_by_thickness_tests
{
using namespace antiform;
using namespace antiform::test;

namespace
{
const std::string automatic = "Matrix/Join=automatic";
const std::string grain_cover = "Matrix/Join=grain cover";

cases::MatrixParameters chosen(const std::vector<std::string> &more)
{
  std::vector<std::string> entries{automatic};
  entries.insert(entries.end(), more.begin(), more.end());
  return cases::read_deck(tiny_deck(), entries).matrix;
}
} // namespace

TEST(JoinsByThickness, AreTheFirstThatTheCoverHolds)
{
  struct Expected
  {
    const char *cover, *join;
    int rows; ///< a cover thinner than a cell of h/3 has one
  };
  for (const Expected &one : std::vector<Expected>{{"100", "bridging domain", 0},
                                                   {"1.334", "bridging domain", 0},
                                                   {"1.333", "grain cover", 0},
                                                   {"0.667", "grain cover", 0},
                                                   {"0.666", "surface interface", 0},
                                                   {"0.334", "surface interface", 0},
                                                   {"0.333", "surface interface", 1},
                                                   {"0.01", "surface interface", 1}})
  {
    SCOPED_TRACE(one.cover);
    const cases::MatrixParameters matrix =
        chosen({std::string("Matrix/Burial depth ratio=") + one.cover});
    EXPECT_EQ(matrix.join, one.join);
    EXPECT_EQ(matrix.cover_rows, one.rows);
    EXPECT_NE(matrix.why_join.find("the cover of "), std::string::npos) << matrix.why_join;
  }
  // 8 d are exactly that, whatever the rounding of h/6.
  EXPECT_EQ(chosen({"Matrix/Burial depth ratio=1.3333333333333333"}).join,
            "bridging domain");
  // Both sides have one join where it is that of the surface.
  EXPECT_EQ(chosen({"Matrix/Base depth ratio=1.3"}).join, "surface interface");
  EXPECT_EQ(chosen({"Matrix/Interface=sliding"}).join, "surface interface");
  // Nothing to choose, and no reason.
  const cases::MatrixParameters grains = chosen({"Matrix/Representation=grains"});
  EXPECT_EQ(grains.join, "bridging domain");
  EXPECT_EQ(grains.why_join, "");
  // A row that the deck asks for is the deck's.
  EXPECT_EQ(chosen({"Matrix/Burial depth ratio=0.1", "Matrix/Cover rows=2"}).cover_rows,
            2);
}

TEST(JoinsByThickness, AreToldAndStandInTheEffectiveDeck)
{
  const TemporaryFolder folder;
  const std::vector<std::string> entries{automatic, "Matrix/Burial depth ratio=1",
                                         "Layer/Breakable=false",
                                         "Run/End shortening=1e-5"};
  const std::string why = "grain cover, since the cover of 10 m (6 d) is thinner than "
                          "buffer, overlap and a row of cells, 13.33 m (8 d), but not "
                          "than 4 d, the least of grains";
  const Outcome check = run_program("check " + tiny_deck() + set(entries));
  EXPECT_NE(check.output.find(why), std::string::npos) << check.output;
  const std::string one = folder.path("one"), again = folder.path("again");
  const Outcome first = run_tiny(one, set(entries));
  EXPECT_EQ(first.status, 0) << first.output;
  EXPECT_NE(contents(one + "/log.txt").find(why), std::string::npos);
  EXPECT_NE(contents(one + "/deck.prm").find("set Join                    = grain cover"),
            std::string::npos)
      << contents(one + "/deck.prm");
  const Outcome second = run_program("run " + one + "/deck.prm -o " + again);
  EXPECT_EQ(second.status, 0) << second.output;
  expect_same_answers(one, again);
}

TEST(JoinsByThickness, WhatDoesNotFitIsRefusedWithTheRemedy)
{
  const auto refused = [](const std::vector<std::string> &entries)
  {
    const Outcome outcome = run_program("check " + tiny_deck() + set(entries));
    EXPECT_EQ(outcome.status, 1) << outcome.output;
    return outcome.output;
  };
  const std::string thin = refused({grain_cover, "Matrix/Burial depth ratio=0.5"});
  EXPECT_NE(thin.find("thinner than 4 grains of 1.667 m"), std::string::npos) << thin;
  EXPECT_NE(thin.find("Give 'surface interface' or 'automatic'"), std::string::npos);
  const std::string middling = refused({"Matrix/Burial depth ratio=1"});
  EXPECT_NE(middling.find("'Matrix/Join' = 'grain cover' or 'surface interface' (or "
                          "'automatic')"),
            std::string::npos)
      << middling;
  const std::string held =
      refused({grain_cover, "Matrix/Burial depth ratio=1", "Foundation/Faces=base and top",
               "Components=layer, matrix, foundation, walls, damping"});
  EXPECT_NE(held.find("the cover is grains. Give base"), std::string::npos) << held;
  // The event driver knows no surface, which is what this cover asks for.
  const std::string events = refused({automatic, "Matrix/Burial depth ratio=0.1",
                                      "Walls/Loading=event driver"});
  EXPECT_NE(events.find("'constant rate'"), std::string::npos) << events;
}

// The same question of one section, asked in four ways: one packing of the layer, and what
// is around it as grains, as mesh, or as both. Coupling is asked for 2 %; on a random
// packing the surface is off by up to a percent more (surface_interface.md 6).
TEST(JoinsByThickness, BuckleAsGrainsAlone)
{
  const TemporaryFolder folder;
  const std::string deck = ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling_grains.prm";
  const auto modes = [&](const std::string &name, const std::vector<std::string> &more)
  {
    std::vector<std::string> entries{"Matrix/Burial depth ratio=1",
                                     "Matrix/Base depth ratio=4", "Run/Modes=2"};
    entries.insert(entries.end(), more.begin(), more.end());
    const Outcome outcome =
        run_program("run " + deck + " -o " + folder.path(name) + set(entries));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return CsvTable(folder.path(name) + "/modes.csv");
  };
  const CsvTable grains = modes("grains", {"Matrix/Representation=grains"}),
                 cover = modes("cover", {grain_cover}),
                 surface = modes("surface", {"Matrix/Join=surface interface"});
  for (std::size_t k = 0; k < 2; ++k)
  {
    const auto over_grains = [&](const CsvTable &table) {
      return table.column("layer_stress_Pa")[k] / grains.column("layer_stress_Pa")[k];
    };
    EXPECT_NEAR(over_grains(cover), 1., 0.02);
    EXPECT_NEAR(over_grains(surface), 1., 0.03);
    EXPECT_EQ(cover.column("half_waves")[k], grains.column("half_waves")[k]);
  }
}

// A bent layer lifts its cover: its fold, the rise of the surface above it, and what the
// section carries are those of grains alone.
TEST(JoinsByThickness, AGrainCoverRisesAsInGrainsAlone)
{
  const TemporaryFolder folder;
  const auto run = [&](const std::string &name, const std::string &as)
  {
    const std::vector<std::string> entries =
        unbreakable({as, "Matrix/Burial depth ratio=1", "Layer/Shape=cosine",
                     "Layer/Amplitude ratio=0.3", "Walls/Transits per millistrain=100"});
    const Outcome outcome = run_tiny(folder.path(name), set(entries));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(folder.path(name));
  };
  const nlohmann::json cover = run("cover", grain_cover),
                       grains = run("grains", "Matrix/Representation=grains");
  // Above the layer there is one and the same packing.
  EXPECT_LT(cover.at("sizes").at("grains"), grains.at("sizes").at("grains"));
  for (const char *name : {"section_stiffness", "peak_stress"})
    EXPECT_NEAR(result(cover, name) / result(grains, name), 1., 0.02) << name;
  const double bent = 3.; // crest over trough before [m]
  EXPECT_NEAR((result(cover, "fold_amplitude") - bent) /
                  (result(grains, "fold_amplitude") - bent),
              1., 0.05);
  EXPECT_GT(result(grains, "surface_uplift"), 1e-3);
  EXPECT_NEAR(result(cover, "surface_uplift") / result(grains, "surface_uplift"), 1.,
              0.05);
  EXPECT_LT(cover.at("energy").at("closure_error"), 1e-3);
}

// The prestress is one of rest to round-off: nothing is left over on grains that a
// pressure lies on, nor on nodes below.
TEST(JoinsByThickness, AGrainCoverRestsUnderThePrestress)
{
  const auto scene = cases::build(
      cases::read_deck(tiny_deck(),
                       {grain_cover, "Matrix/Burial depth ratio=1", "Layer/Shape=cosine",
                        "Layer/Amplitude ratio=0.3", "Layer/Breakable=true",
                        "Components=layer, matrix, surface pressure, gravity, walls, "
                        "damping",
                        "Surface pressure/Pressure=20e6",
                        "Walls/Transits per millistrain=1e12"}),
      MPI_COMM_SELF, [](const std::string &) {});
  scene->simulation->set_sampler([](const coupling::Clock &) { return true; });
  for (int step = 0; step < 100; ++step)
  {
    scene->simulation->step();
    ASSERT_LT(scene->unbalanced_ratio(), 1e-10) << step;
  }
  EXPECT_TRUE(scene->grains->state.cracks.empty());
  const cases::SectionGeometry &g = scene->geometry;
  const double weight = 0.84 * 2500. * 9.81;
  EXPECT_NEAR(scene->wall_motion->grain_reaction(cases::layer_region) / g.thickness(),
              20e6 + weight * (g.surface() - g.axis(g.x_min())),
              weight * g.diameter() + 1e-3);
}
} // namespace joins_by_thickness_tests
