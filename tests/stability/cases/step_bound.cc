// Scenes whose stiffest part alone decides about the step: the bound must hold with
// damping, which pulls each degree of freedom by up to 1 + alpha times its force.
#include "support/tiny_run.h"

namespace step_bound_tests
{
using namespace antiform::test;

namespace
{
struct Stiff
{
  std::string name;
  std::vector<std::string> entries;
};
void PrintTo(const Stiff &stiff, std::ostream *out)
{
  *out << stiff.name;
}

class StepBound : public ::testing::TestWithParam<Stiff>
{
};

TEST_P(StepBound, HoldsWithDamping)
{
  const TemporaryFolder folder;
  std::vector<std::string> entries = GetParam().entries;
  entries.insert(entries.end(), {"Run/End shortening=2e-4", "Run/Step safety=0.99"});
  const Outcome outcome = run_tiny(folder.path("run"), set(entries));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  const nlohmann::json summary = summary_of(folder.path("run"));
  EXPECT_TRUE(summary.at("warnings").empty()) << summary.at("warnings");
  // An unstable mode grows by a factor a step: nothing of it is left in equilibrium.
  EXPECT_LT(result(summary, "unbalanced_ratio"), 0.02);
  const nlohmann::json &energy = summary.at("energy");
  EXPECT_LT(energy.at("closure_error").get<double>(), 1e-5); // nothing breaks
  EXPECT_GE(energy.at("kinetic").get<double>(), 0.);
  EXPECT_LT(energy.at("kinetic").get<double>(),
            0.05 * energy.at("boundary_work").get<double>());
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    StepBound,
    ::testing::Values(
        Stiff{"StiffFoundationOfTheMesh",
              {"Components=layer, matrix, walls, damping, foundation",
               "Foundation/Stiffness ratio=1e6"}},
        Stiff{"StiffFoundationOfGrains",
              {"Components=layer, matrix, walls, damping, foundation",
               "Matrix/Representation=grains", "Matrix/Burial depth ratio=1",
               "Matrix/Base depth ratio=1", "Foundation/Stiffness ratio=1e4"}},
        Stiff{"LayerOfFiniteElements", {"Layer/Representation=continuum"}},
        Stiff{"StrongDamping", {"Damping/Coefficient=0.99"}},
        Stiff{"LocalDamping",
              {"Components=layer, matrix, walls, damping, foundation",
               "Foundation/Stiffness ratio=1e6", "Damping/Form=local"}}),
    [](const auto &instance) { return instance.param.name; });
} // namespace
} // namespace step_bound_tests
