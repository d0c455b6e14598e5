// A layer of grains in a mesh, joined as the deck says: in an overlap, or on the mesh's
// edges. tests/decks/tiny.prm and cases/burial-depth/buckling_grains.prm.
#include "support/tiny_run.h"

#include "cases/scene.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>

namespace joins_of_decks_tests
{
using namespace antiform;
using namespace antiform::test;

namespace
{
const std::string on_surface = "Matrix/Join=surface interface";

/// Of the tiny deck: thicknesses of layer and matrix, plane moduli of the closed form.
constexpr double layer_height = 10., matrix_height = 40.;
double matrix_plane_modulus(const double contrast)
{
  return 56e9 / contrast / (1. - 0.2 * 0.2);
}

std::vector<std::string> slow(std::vector<std::string> more)
{
  std::vector<std::string> entries =
      unbreakable({"Walls/Transits per millistrain=300"});
  entries.insert(entries.end(), more.begin(), more.end());
  return entries;
}

struct Stiffness
{
  double layer, matrix; ///< force on the walls a unit of shortening [N]
};

Stiffness stiffness_of(const std::string &directory,
                       const std::vector<std::string> &entries,
                       const double height = layer_height + matrix_height)
{
  const Outcome outcome = run_tiny(directory, set(slow(entries)));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(directory);
  const double all = height * result(summary, "section_stiffness"),
               share = result(summary, "matrix_share_at_peak");
  return {(1. - share) * all, share * all};
}

std::unique_ptr<cases::Scene> scene_of(const std::vector<std::string> &overrides)
{
  return cases::build(cases::read_deck(tiny_deck(), overrides), MPI_COMM_SELF,
                      [](const std::string &) {});
}
} // namespace

// Side by side under even shortening, both free across, layer and matrix carry what each
// does alone: the layer what the same packing does without a matrix, the mesh E' of its
// height. On the edge the mesh holds the layer's outer grains, which the bare layer's
// are free of: half a percent of it at most, a contrast of 20. Near the walls the
// cemented mesh takes over what the layer's ends lag behind the walls by the springs of
// their contact, half a grain or so: G d of force on each corner, of 40 E0' in all 5 %.
TEST(JoinsOfDecks, LayerAndMatrixCarryWhatEachDoesAlone)
{
  const TemporaryFolder folder;
  const double alone =
      stiffness_of(folder.path("bare"), {"Components=layer, walls, damping"},
                   layer_height)
          .layer;
  for (const char *interface : {"cemented", "sliding", "frictional", "frictionless"})
    for (const double contrast : {20., 1e4})
    {
      const std::string name = interface + std::to_string(contrast);
      SCOPED_TRACE(name);
      const Stiffness k = stiffness_of(
          folder.path(name), {on_surface, std::string("Matrix/Interface=") + interface,
                              "Matrix/Stiffness contrast=" + std::to_string(contrast)});
      const double matrix = matrix_plane_modulus(contrast) * matrix_height;
      EXPECT_NEAR(k.layer / alone, 1., 0.1 / contrast + 1e-4);
      // Where no shear is carried the mesh is even; it rings a little, 60 transits long.
      const bool holds = std::string(interface) == "cemented";
      EXPECT_NEAR(k.matrix / matrix, 1., holds ? 0.08 : 0.03);
    }
}

// The homogenised stiffness of a tile is that of a section within 1 to 2 %.
TEST(JoinsOfDecks, AgreeWithEachOtherAndWithGrainsAlone)
{
  const TemporaryFolder folder;
  const auto whole = [&](const std::string &name, const std::vector<std::string> &entries)
  {
    const Stiffness k = stiffness_of(folder.path(name), entries);
    return k.layer + k.matrix;
  };
  const double surface = whole("surface", {on_surface}), overlap = whole("overlap", {}),
               grains = whole("grains", {"Matrix/Representation=grains"});
  EXPECT_NEAR(surface / overlap, 1., 0.01);
  EXPECT_NEAR(surface / grains, 1., 0.02);
}

TEST(JoinsOfDecks, RestUnderThePrestress)
{
  for (const char *interface : {"cemented", "sliding", "frictional", "frictionless"})
    for (const bool weighs : {false, true})
    {
      SCOPED_TRACE(std::string(interface) + (weighs ? " with gravity" : ""));
      const auto scene = scene_of(
          {on_surface, std::string("Matrix/Interface=") + interface,
           "Layer/Shape=cosine", "Layer/Amplitude ratio=0.3", "Layer/Breakable=true",
           std::string("Components=layer, matrix, surface pressure, walls, damping") +
               (weighs ? ", gravity" : ""),
           "Surface pressure/Pressure=20e6", "Walls/Transits per millistrain=1e12"});
      scene->simulation->set_sampler([](const coupling::Clock &) { return true; });
      for (int step = 0; step < 100; ++step)
      {
        scene->simulation->step();
        // Round-off of forces that leave nothing over.
        ASSERT_LT(scene->unbalanced_ratio(), 1e-10) << step;
      }
      EXPECT_TRUE(scene->grains->state.cracks.empty());
      EXPECT_LT(scene->displacement_gap(), 1e-15);
      // The walls feel the pressure at the height of the grains that stand at them: by
      // less than a diameter of weight another one than in the middle of the layer.
      const cases::SectionGeometry &g = scene->geometry;
      const double weight = weighs ? 0.84 * 2500. * 9.81 : 0.;
      EXPECT_NEAR(scene->wall_motion->grain_reaction(cases::layer_region) /
                      g.thickness(),
                  20e6 + weight * (g.surface() - g.axis(g.x_min())),
                  weight * g.diameter() + 1e-3);
      // Of the mesh exactly: it integrates a pressure that is linear in the depth.
      const double height = g.surface() - g.base(), h = g.thickness();
      const double below_axis = g.axis(g.x_min()) - g.base(),
                   all = height * (20e6 + 0.5 * weight * height),
                   of_layer = h * (20e6 + weight * (height - below_axis));
      EXPECT_NEAR(scene->wall_motion->mesh_reaction() / (all - of_layer), 1., 1e-10);
    }
}

// Beside a mesh layer the linear theory knows how much a smooth contact takes from the
// critical stress. The packing's modulus and bending stiffness, which a mesh does not
// have, are in both figures alike.
TEST(JoinsOfDecks, SmoothContactLowersTheCriticalStress)
{
  const TemporaryFolder folder;
  const auto critical = [&](const std::string &name, std::vector<std::string> entries)
  {
    const std::string directory = folder.path(name);
    entries.push_back("Run/Modes=1");
    const Outcome outcome = run_program("run " ANTIFORM_SOURCE_DIR
                                        "/cases/burial-depth/buckling_grains.prm -o " +
                                        directory + set(entries));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return result(summary_of(directory), "critical_stress");
  };
  const std::vector<std::string> mesh{"Layer/Representation=continuum",
                                      "Matrix/Element degree=2"};
  const double smooth = critical("smooth", {on_surface, "Matrix/Interface=sliding"}),
               cemented = critical("cemented", {on_surface});
  std::vector<std::string> sliding_mesh = mesh;
  sliding_mesh.push_back("Matrix/Interface=sliding");
  const double of_mesh = critical("sliding_mesh", sliding_mesh) / critical("mesh", mesh);
  EXPECT_LT(of_mesh, 0.85);
  // 2 %, of what is a difference of 19 %: an outer grain of six holds on half a
  // diameter inside of the edge.
  EXPECT_NEAR(smooth / cemented, of_mesh, 0.03);
  // What the mesh adds to the outer grains, whose neighbours are not matrix grains.
  EXPECT_NEAR(cemented / critical("grains", {"Matrix/Representation=grains"}), 1., 0.04);
}

// c + mu p on every grain that is dragged along the edge, whatever its length.
TEST(JoinsOfDecks, FrictionAndCohesionAreTheDecks)
{
  const double pressure = 5e6, friction = 0.3, cohesion = 4e5;
  const auto scene =
      scene_of({on_surface, "Matrix/Interface=frictional",
                "Matrix/Interface friction=0.3", "Matrix/Interface cohesion=4e5",
                "Components=layer, matrix, surface pressure, walls, damping",
                "Surface pressure/Pressure=5e6"});
  discrete::Grains &grains = scene->grains->state.grains;
  ASSERT_EQ(scene->surface->contacts.size(), 2u);
  for (const double way : {1e-3, -5e-2})
  {
    for (std::size_t i = 0; i < grains.size(); ++i)
    {
      grains.displacement_x[i] += way;
      grains.velocity_x[i] = way;
    }
    for (const auto &contact : scene->surface->contacts)
    {
      contact->add_forces(grains, scene->mesh->displacement, scene->mesh->velocity, 1.,
                          scene->mesh->force);
      ASSERT_GT(contact->states().size(), 30u);
      for (const auto &state : contact->states())
      {
        // Places at a straight edge: no grain comes nearer to it.
        EXPECT_NEAR(state.traction.normal, -pressure, 1e-6 * pressure);
        if (way > 0.)
          continue; // not far enough for every grain to slide
        EXPECT_NEAR(std::abs(state.traction.shear), cohesion + friction * pressure,
                    1e-6 * pressure);
      }
    }
  }
}

TEST(JoinsOfDecks, ContactsTellWhatTheyDo)
{
  const TemporaryFolder folder;
  const auto run = [&](const std::string &friction)
  {
    const Outcome outcome = run_tiny(
        folder.path(friction),
        set(slow({on_surface, "Matrix/Interface=frictional", "Layer/Shape=cosine",
                  "Components=layer, matrix, surface pressure, walls, damping",
                  "Surface pressure/Pressure=1e6",
                  "Matrix/Interface friction=" + friction})));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(folder.path(friction));
  };
  const nlohmann::json slips = run("0.01"), sticks = run("100");
  EXPECT_GT(result(slips, "interface_sliding_share"), 0.5);
  EXPECT_EQ(result(sticks, "interface_sliding_share"), 0.);
  EXPECT_GT(slips.at("energy").at("slip"), 0.);
  EXPECT_EQ(sticks.at("energy").at("slip"), 0.);
  EXPECT_GT(result(slips, "interface_largest_slip"),
            5. * result(sticks, "interface_largest_slip")); // of its springs
  // 2e-4 of the bent layer does not lift the cover against 1 MPa.
  EXPECT_EQ(result(sticks, "interface_open_share"), 0.);
}

TEST(JoinsOfDecks, CarryACoverTooThinForAnOverlap)
{
  const TemporaryFolder folder;
  const std::vector<std::string> thin = unbreakable(
      {"Matrix/Burial depth ratio=0.2", "Matrix/Cover rows=1", "Layer/Shape=cosine"});
  const Outcome overlap = run_tiny(folder.path("overlap"), set(thin)),
                surface = run_tiny(folder.path("surface"), set(thin) + set({on_surface}));
  EXPECT_EQ(overlap.status, 1);
  EXPECT_NE(overlap.output.find("'Matrix/Join' = 'surface interface'"), std::string::npos)
      << overlap.output;
  EXPECT_EQ(surface.status, 0) << surface.output;
  const nlohmann::json summary = summary_of(folder.path("surface"));
  EXPECT_EQ(summary.at("effects").at("surface interface").at("calls"),
            summary.at("steps"));
  EXPECT_EQ(summary.at("effects").at("bridging domain").at("calls"), 0);
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-9);
}

// Other spaces of multipliers are other ways to the same section.
TEST(JoinsOfDecks, MultipliersAreTheDecks)
{
  const TemporaryFolder folder;
  const auto run = [&](const std::string &name, const std::vector<std::string> &entries)
  {
    const Outcome outcome = run_tiny(folder.path(name), set(slow(entries)));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return summary_of(folder.path(name));
  };
  const std::vector<std::string> fine{"Matrix/Cell size ratio=1",
                                      "Bridging domain/Multipliers=coarsened"};
  const auto mesh = run("mesh", {}), coarsened = run("coarsened", fine),
             per_grain = run("per_grain", {"Bridging domain/Multipliers=per grain"});
  const auto multipliers = [](const nlohmann::json &summary)
  { return summary.at("sizes").at("multipliers").get<double>(); };
  // Lines two diameters apart, as those of the mesh of such cells.
  EXPECT_EQ(multipliers(coarsened), multipliers(mesh));
  EXPECT_GT(multipliers(per_grain), 1.5 * multipliers(mesh)); // 2 a grain of the overlap
  // The overlap is 4 d wide, where patch tests leave errors of 2 to 4 % in the joints
  // beside it (bridging.md, 11), and its part of the section's stiffness is a twentieth.
  for (const auto &other : {coarsened, per_grain})
    EXPECT_NEAR(result(other, "section_stiffness") / result(mesh, "section_stiffness"),
                1., 3e-3);
}

// Joints of one element bear no moment: a grain of the overlap that the cut has left with
// one of them would roll.
TEST(JoinsOfDecks, GrainsThatNothingHoldsFollowTheMesh)
{
  const TemporaryFolder folder;
  const std::vector<std::string> rolling = unbreakable(
      {"Layer/Flat joint/Elements=1", "Layer/Flat joint/Element moment=false",
       "Layer/Installation gap ratio=0.15", "Layer/Seed=4"});
  const Outcome outcome = run_tiny(folder.path("run"), set(rolling));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_LT(summary.at("energy").at("closure_error"), 1e-9);

  const auto scene = scene_of(rolling);
  const auto &ties = scene->bridging->ties().ties();
  ASSERT_GT(ties.size(), 0u);
  EXPECT_NE(outcome.output.find(std::to_string(ties.size()) + " grain"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("tied to the mesh"), std::string::npos) << outcome.output;
  for (int step = 0; step < 300; ++step)
    scene->simulation->step();
  const discrete::Grains &grains = scene->grains->state.grains;
  for (const coupling::GrainTie &tie : ties)
  {
    Vec2 at;
    for (const coupling::GrainTie::Node &node : tie.nodes)
      at += node.value * Vec2{scene->mesh->displacement(node.dof_x),
                              scene->mesh->displacement(node.dof_y)};
    const Vec2 moved{grains.displacement_x[tie.grain], grains.displacement_y[tie.grain]};
    EXPECT_GT(norm(moved), 0.);
    EXPECT_LT(norm(moved - at), 1e-12 * norm(moved));
  }
  EXPECT_TRUE(scene_of(unbreakable())->bridging->ties().empty());
}

TEST(JoinsOfDecks, OverlapDampingIsInTheLedger)
{
  const TemporaryFolder folder;
  for (const char *rate : {"0", "0.05"})
  {
    const std::string directory = folder.path(std::string("rate") + rate);
    const Outcome outcome = run_tiny(
        directory, set(unbreakable({"Components=layer, matrix, walls",
                                    "Run/Driver=dynamic", "Walls/Ramp=0.2",
                                    std::string("Bridging domain/Overlap damping=") +
                                        rate})));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
    const nlohmann::json summary = summary_of(directory);
    const bool damped = std::string(rate) != "0";
    EXPECT_EQ(summary.at("effects").at("overlap damping").at("calls"),
              damped ? summary.at("steps").get<int>() : 0);
    const double taken = summary.at("energy").at("damping");
    if (damped)
      EXPECT_GT(taken, 1e-6 * summary.at("energy").at("boundary_work").get<double>());
    else
      EXPECT_EQ(taken, 0.);
    // Leapfrog keeps the energy of linear forces; waves of 2e-4 turn joints a little.
    EXPECT_LT(summary.at("energy").at("closure_error"), 2e-8);
  }
}

// Cells of 16 d beside grains of d: their mesh may be left alone for five steps.
TEST(JoinsOfDecks, MeshMayBeSubCycled)
{
  const TemporaryFolder folder;
  const auto run = [&](const int n, const std::string &name)
  {
    return run_tiny(
        folder.path(name),
        set(unbreakable(
            {"Components=layer, matrix, walls", "Run/Driver=dynamic",
             "Matrix/Cell size ratio=16", "Matrix/Largest cell ratio=16",
             "Matrix/Burial depth ratio=9", "Matrix/Base depth ratio=9",
             "Bridging domain/Overlap width ratio=32",
             "Bridging domain/Overlap damping=0.05",
             "Bridging domain/Sub-cycles=" + std::to_string(n)})));
  };
  ASSERT_EQ(run(1, "every").status, 0);
  ASSERT_EQ(run(5, "fifth").status, 0);
  const nlohmann::json every = summary_of(folder.path("every")),
                       fifth = summary_of(folder.path("fifth"));
  EXPECT_EQ(fifth.at("steps").get<int>() % 5, 1); // it ends with a record
  const CsvTable a(folder.path("every/history.csv")), b(folder.path("fifth/history.csv"));
  // Forces of walls that bring waves with them, at one shortening. The mean over the five
  // steps before lies two steps and a half back, of some forty in a transit of the layer.
  const auto strains = a.column("shortening"), forces = a.column("wall_force_N"),
             strain = b.column("shortening"), force = b.column("wall_force_N");
  double difference = 0., largest = 0.;
  for (std::size_t k = 1, n = 1; k < strain.size(); ++k)
  {
    while (n + 1 < strains.size() && strains[n] < strain[k])
      ++n;
    const double s = (strain[k] - strains[n - 1]) / (strains[n] - strains[n - 1]);
    const double expected = forces[n - 1] + s * (forces[n] - forces[n - 1]);
    difference = std::max(difference, std::abs(force[k] - expected));
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_LT(difference, 0.05 * largest);
  EXPECT_LT(every.at("energy").at("closure_error"), 1e-6);
  // (omega n dt)^2 of the waves that the mesh carries.
  EXPECT_LT(fifth.at("energy").at("closure_error"), 1e-4);
  EXPECT_EQ(fifth.at("effects").at("sub-cycling").at("active"), true);

  const Outcome seldom = run(50, "seldom");
  EXPECT_EQ(seldom.status, 1);
  EXPECT_NE(seldom.output.find("'Bridging domain/Sub-cycles' is 50"), std::string::npos)
      << seldom.output;
  const std::size_t give = seldom.output.find("Give ");
  ASSERT_NE(give, std::string::npos);
  const int possible = std::stoi(seldom.output.substr(give + 5));
  EXPECT_EQ(run(possible, "possible").status, 0);
  EXPECT_EQ(run(possible + 1, "too_seldom").status, 1);
}
} // namespace joins_of_decks_tests
