// A hinge that breaks within a few transits takes the mesh on it beyond small strain. A run
// that was to end in this fall ends there, and says so; one that was not has failed.
#include "support/tiny_run.h"

namespace end_of_fall_tests
{
using namespace antiform::test;

namespace
{
const std::vector<std::string> violent{"Matrix/Stiffness contrast=1e4",
                                       "Layer/Length ratio=50",
                                       "Matrix/Base depth ratio=30",
                                       "Walls/Transits per millistrain=60",
                                       "Matrix/Burial depth ratio=0.03",
                                       "Matrix/Cell size ratio=9"};

bool speaks_of_the_mesh(const std::string &text)
{
  return text.find("small-strain theory") != std::string::npos;
}
} // namespace

// Some 15 s of a core each: the member of cases/burial-depth/study-fracture.prm whose
// stress falls to a fifth, and whose mesh turns by 10 degrees, while the shortening grows
// by 1.5 %.
TEST(EndOfFall, IsWhereTheMeshLeavesSmallStrainLong)
{
  const TemporaryFolder folder;
  std::ifstream deck(ANTIFORM_SOURCE_DIR "/cases/burial-depth/study-fracture.prm");
  std::string text(std::istreambuf_iterator<char>(deck), {});
  text.erase(text.find("subsection Study")); // a run, not a study
  const std::string rocks = "include ../rocks/";
  text.replace(text.find(rocks), rocks.size(),
               "include " ANTIFORM_SOURCE_DIR "/cases/rocks/");
  std::ofstream(folder.path("member.prm")) << text;
  const std::string command = "run " + folder.path("member.prm") + set(violent);

  const Outcome ends = run_program(command + " -o " + folder.path("ends"));
  EXPECT_EQ(ends.status, 0) << ends.output;
  const nlohmann::json summary = summary_of(folder.path("ends"));
  ASSERT_FALSE(summary.at("warnings").empty());
  EXPECT_TRUE(speaks_of_the_mesh(summary.at("warnings").back().get<std::string>()));
  EXPECT_GT(result(summary, "shortening"), result(summary, "strain_at_peak"));

  const Outcome fails = run_program(command + set({"Run/Stress ratio of peak=0"}) +
                                    " -o " + folder.path("fails"));
  EXPECT_EQ(fails.status, 2) << fails.output;
  EXPECT_TRUE(speaks_of_the_mesh(fails.output)) << fails.output;
}
} // namespace end_of_fall_tests
