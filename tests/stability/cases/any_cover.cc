// A deck that check accepts can be built, wherever the overlap happens to end in the
// mesh.
#include "support/tiny_run.h"

namespace any_cover_tests
{
using namespace antiform::test;

TEST(AnyCover, ThatTheChecksAcceptCanBeBuilt)
{
  // Covers that end the overlap within a cell: these two left vertices beyond the rim
  // with fewer grains than multipliers.
  const TemporaryFolder folder;
  for (const std::vector<std::string> &cover :
       {std::vector<std::string>{"Layer/Shape=straight", "Layer/Seed=1",
                                 "Matrix/Burial depth ratio=1.45",
                                 "Matrix/Base depth ratio=1.45"},
        {"Layer/Shape=cosine", "Layer/Seed=4", "Matrix/Burial depth ratio=1.5",
         "Matrix/Base depth ratio=1.5"}})
  {
    const std::string directory = folder.path(cover.front().substr(12));
    const Outcome outcome =
        run_tiny(directory, set(cover) + set(unbreakable({"Run/End shortening=1e-5"})));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
  }
}
} // namespace any_cover_tests
