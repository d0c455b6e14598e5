// antiform compare: what it finds between runs whose differences are known.
#include "support/tiny_run.h"

#include <filesystem>
#include <fstream>
#include <memory>

namespace compared_runs_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
class ComparedRuns : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    folder_ = std::make_unique<TemporaryFolder>();
    const Outcome outcome = run_tiny(folder_->path("run"));
    ASSERT_EQ(outcome.status, 0) << outcome.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// A copy of the run with another entry in its deck, its stresses @p factor as large
  /// and its cracks, or those after the peak alone, @p shift further along the layer [m].
  static std::string altered(const std::string &name,
                             const std::string &entry,
                             const double factor,
                             const double shift,
                             const bool late_alone = false)
  {
    const std::string copy = folder_->path(name);
    fs::copy(folder_->path("run"), copy, fs::copy_options::recursive);
    const std::string script = R"(
import csv, re, sys
folder, entry = sys.argv[1:3]
factor, shift, late_alone = map(float, sys.argv[3:6])
name, value = entry.split('=')
with open(folder + '/deck.prm') as file: text = file.read()
text, n = re.subn(r'(set %s *= ).*' % name, r'\g<1>' + value, text, count=1)
assert n == 1, entry
with open(folder + '/deck.prm', 'w') as file: file.write(text)
with open(folder + '/history.csv') as file:
    peak = max(csv.DictReader(file), key=lambda row: float(row['axial_stress_Pa']))
begin = float(peak['shortening']) if late_alone else -1.
for table, column, change in (('history', 'axial_stress_Pa', lambda x: x * factor),
                              ('cracks', 'reference_x_m', lambda x: x + shift)):
    path = f'{folder}/{table}.csv'
    with open(path) as file: rows = list(csv.DictReader(file))
    for row in rows:
        if table == 'history' or float(row['shortening']) > begin:
            row[column] = repr(change(float(row[column])))
    with open(path, 'w') as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
)";
    const std::string file = folder_->path("alter.py");
    std::ofstream(file) << script;
    const Outcome outcome =
        run_command("/usr/bin/python3 -B " + file + " " + copy + " '" + entry + "' " +
                    std::to_string(factor) + " " + std::to_string(shift) +
                    (late_alone ? " 1" : " 0"));
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return copy;
  }

  static Outcome compare(const std::string &runs, const std::string &out)
  {
    return draw_page("compare " + runs + " -o " + out, folder_->path("matplotlib"));
  }

  /// The line of @p measure in the last group of a comparison.
  static nlohmann::json measure_of(const std::string &out, const std::string &measure)
  {
    const nlohmann::json all =
        nlohmann::json::parse(contents(out + "/comparison.json"));
    nlohmann::json found;
    for (const nlohmann::json &row : all.at("measures"))
      if (row.at("measure") == measure)
        found = row;
    return found;
  }

  /// The lines of a table below its names, text by text.
  static std::vector<std::vector<std::string>> cells(const std::string &path)
  {
    std::istringstream lines(contents(path));
    std::vector<std::vector<std::string>> rows;
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);)
    {
      rows.emplace_back();
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');)
        rows.back().push_back(cell);
    }
    return rows;
  }

  /// Mean diameter of the run's grains [m].
  static double grain_diameter()
  {
    const std::string file = folder_->path("diameter.py");
    std::ofstream(file) << "import sys\n"
                           "sys.path.insert(0, sys.argv[1] + '/cases')\n"
                           "from run_files import Run\n"
                           "run = Run(sys.argv[2])\n"
                           "print(2. * run.frame(0).grains.field('radius_m').mean())\n";
    const Outcome diameter =
        run_command("/usr/bin/python3 -B " + file + " " ANTIFORM_SOURCE_DIR " " +
                    folder_->path("run"));
    EXPECT_EQ(diameter.status, 0) << diameter.output;
    return std::stod(diameter.output);
  }

  static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> ComparedRuns::folder_;
} // namespace

TEST_F(ComparedRuns, FindsKnownDifferencesOfStressAndPlace)
{
  const std::string out = folder_->path("known");
  const std::string other = altered("other", "Transits per millistrain=77", 1.1, 3.);
  const Outcome outcome = compare(folder_->path("run") + " " + other, out);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *measure : {"peak_stress", "stiffness"})
    EXPECT_NEAR(measure_of(out, measure).at("difference"), 0.1, 1e-9) << measure;
  EXPECT_EQ(measure_of(out, "peak_stress").at("verdict"), "unknown"); // no other seed
  for (const char *measure : {"strain_at_peak", "fold_amplitude", "cracks_at_peak"})
    EXPECT_EQ(measure_of(out, measure).at("difference"), 0.) << measure;
  EXPECT_EQ(measure_of(out, "displacement_difference").at("value"), 0.);
  // All cracks 3 m further: that far, whatever their number.
  for (const char *measure : {"crack_zone_distance", "crack_zone_distance_at_peak"})
    EXPECT_NEAR(measure_of(out, measure).at("value"), 3. / grain_diameter(), 1e-6)
        << measure;
  // That there is one packing each is said once, with what to do about it.
  const std::string html = contents(out + "/comparison.html");
  for (const std::string &text : {outcome.output, html})
  {
    EXPECT_EQ(occurrences(text, "cannot be told"), 1u) << outcome.output;
    EXPECT_EQ(occurrences(text, "unknown"), 0u) << outcome.output;
    EXPECT_EQ(occurrences(text, "Layer/Seed="), 1u) << outcome.output;
    EXPECT_EQ(occurrences(text, "antiform compare "), 1u) << outcome.output;
  }
  EXPECT_GT(contents(out + "/comparison.html").size(), 50000u);
  EXPECT_EQ(contents(out + "/comparison.html").find("http"), std::string::npos);
}

TEST_F(ComparedRuns, TellsZonesUpToThePeaksFromThoseAtTheEnd)
{
  const std::string out = folder_->path("zones");
  const std::string late = altered("late", "Transits per millistrain=76", 1., 3., true);
  const Outcome outcome = compare(folder_->path("run") + " " + late, out);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(measure_of(out, "crack_zone_distance_at_peak").at("value"), 0.);
  // All that moves moves one way: in the mean by 3 m times the share of those that do.
  double peak = 0., at_peak = 0.;
  const CsvTable history(folder_->path("run") + "/history.csv");
  for (std::size_t k = 0; k < history.size(); ++k)
    if (const double stress = history.column("axial_stress_Pa")[k]; stress > peak)
    {
      peak = stress;
      at_peak = history.column("shortening")[k];
    }
  const std::vector<std::vector<std::string>> cracks = cells(late + "/cracks.csv");
  std::size_t n_late = 0;
  for (const std::vector<std::string> &crack : cracks)
    n_late += std::stod(crack.at(2)) > at_peak ? 1 : 0;
  ASSERT_GT(n_late, 0u);
  ASSERT_LT(n_late, cracks.size());
  // Quantiles between places are interpolated, those at the ends count once.
  EXPECT_NEAR(measure_of(out, "crack_zone_distance").at("value").get<double>() *
                  grain_diameter() * cracks.size() / n_late,
              3., 0.06);
}

TEST_F(ComparedRuns, TellsScatterOfSeedsFromADifference)
{
  // Peaks 1, 1.02 against 1.01, 1.03 and 1.2, 1.22 of the run's; cracks 0, 1 m further
  // against 0.5, 1.5 m and 10, 11 m.
  const std::string first =
      folder_->path("run") + " " + altered("seed", "Seed=91", 1.02, 1.) + " ";
  const std::string out = folder_->path("scatter");
  const std::string near = altered("near", "Transits per millistrain=78", 1.01, 0.5) +
                           " " +
                           altered("near_seed", "Transits per millistrain=78", 1.03, 1.5);
  // Two runs of one deck and seed are one group too.
  Outcome outcome = compare(first + near, out);
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  nlohmann::json peak = measure_of(out, "peak_stress");
  EXPECT_EQ(peak.at("runs"), 2);
  EXPECT_NEAR(peak.at("difference"), 1.02 / 1.01 - 1., 1e-9);
  // Variances 2e-4 of two runs each: sqrt(2e-4 / 2 + 2e-4 / 2), over the mean.
  EXPECT_NEAR(peak.at("scatter"), std::sqrt(2e-4) / 1.01, 1e-6);
  EXPECT_EQ(peak.at("verdict"), "within scatter");
  // Means half a metre apart, standard error sqrt(1/2 / 2 + 1/2 / 2) m.
  EXPECT_EQ(measure_of(out, "crack_zone_distance").at("verdict"), "within scatter");
  EXPECT_NEAR(measure_of(out, "crack_zone_distance").at("scatter"), 1. / grain_diameter(),
              1e-6);
  EXPECT_EQ(measure_of(out, "displacement_difference").at("verdict"), "within scatter");
  EXPECT_EQ(outcome.output.find("cannot be told"), std::string::npos) << outcome.output;

  const std::string far = altered("far", "Transits per millistrain=79", 1.20, 10.) + " " +
                          altered("far_seed", "Transits per millistrain=79", 1.22, 11.);
  outcome = compare(first + far, folder_->path("far_out"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  for (const char *measure : {"peak_stress", "crack_zone_distance"})
    EXPECT_EQ(measure_of(folder_->path("far_out"), measure).at("verdict"),
              "more than scatter")
        << measure;
}

TEST_F(ComparedRuns, ReducesDistancesToTheMeansOfTheirGroups)
{
  // Of points in a plane means and their standard errors are known without distances.
  const std::string script = R"(
import itertools, sys
sys.path.insert(0, sys.argv[1] + '/cases')
import numpy as np
from compare import means_apart
random = np.random.default_rng(1)
def check(first, other):
    def all_of(pairs): return [np.hypot(*(b - a)) for a, b in pairs]
    own = [all_of(itertools.permutations(group, 2)) for group in (first, other)]
    means, error = means_apart(all_of(itertools.product(first, other)), own,
                               (len(first), len(other)))
    assert abs(means - np.hypot(*(first.mean(0) - other.mean(0)))) < 1e-12, means
    return error
def variance(group): return group.var(0, ddof=1).sum()
a, b = random.random((4, 2)), 2. + random.random((3, 2))
assert abs(check(a, b) - np.sqrt(variance(a) / 4 + variance(b) / 3)) < 1e-12
# Where one group is a single run the other's scatter serves both.
assert abs(check(a, b[:1]) - np.sqrt(variance(a) * (1 / 4 + 1))) < 1e-12
assert abs(check(a[:1], b) - np.sqrt(variance(b) * (1 + 1 / 3))) < 1e-12
assert check(a[:1], b[:1]) is None
)";
  const std::string file = folder_->path("means.py");
  std::ofstream(file) << script;
  const Outcome outcome =
      run_command("MPLCONFIGDIR=" + folder_->path("matplotlib") +
                  " /usr/bin/python3 -B " + file + " " ANTIFORM_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST_F(ComparedRuns, MeetsALinearFieldExactlyInGrainsAndCells)
{
  // u = A x + b, of a scattered set of grains and of skew cells.
  const std::string script = R"(
import sys
sys.path.insert(0, sys.argv[1] + '/cases')
import numpy as np
from comparison_measures import grain_displacement, mesh_displacement
random = np.random.default_rng(1)
A, b = np.array([[0.01, -0.02], [0.03, 0.005]]), np.array([0.4, -0.1])
class Fields:
    def __init__(self, places, moved):
        self.points, self.u = places, np.column_stack([moved, np.zeros(len(moved))])
    def field(self, *names): return self.u
    def quads(self): return self.cells
places = 10. * random.random((400, 2))
moved = places @ A.T + b
points = 3. + 4. * random.random((50, 2))
grains = Fields(places + moved, moved)
found = grain_displacement(grains, points, 1.5)
assert np.max(abs(found - points @ A.T - b)) < 1e-12
assert np.isnan(grain_displacement(grains, np.array([[50., 50.]]), 1.5)).all()
x, y = np.meshgrid(np.arange(11.), np.arange(11.))
nodes = np.column_stack([(x + 0.2 * np.sin(y)).ravel(), (y + 0.2 * np.cos(x)).ravel()])
mesh = Fields(nodes, nodes @ A.T + b)
corner = (11 * np.arange(10)[:, None] + np.arange(10)).ravel()
mesh.cells = corner[:, None] + np.array([0, 1, 12, 11])
found = mesh_displacement(mesh, points)
assert np.max(abs(found - points @ A.T - b)) < 1e-12
assert np.isnan(mesh_displacement(mesh, np.array([[50., 50.]]))).all()
)";
  const std::string file = folder_->path("linear.py");
  std::ofstream(file) << script;
  const Outcome outcome =
      run_command("/usr/bin/python3 -B " + file + " " ANTIFORM_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST_F(ComparedRuns, RefusesOtherScenesAndUnfinishedRunsAllAtOnce)
{
  const std::string thick = altered("thick", "Thickness=11", 1., 0.);
  Outcome outcome = compare(folder_->path("run") + " " + thick, folder_->path("none"));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("Layer/Thickness"), std::string::npos) << outcome.output;

  fs::create_directory(folder_->path("empty"));
  outcome = compare(folder_->path("empty") + " " + folder_->path("nowhere"),
                    folder_->path("none"));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("empty"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("nowhere"), std::string::npos) << outcome.output;
  outcome = compare(folder_->path("run"), folder_->path("none"));
  EXPECT_EQ(outcome.status, 1) << outcome.output;
  EXPECT_FALSE(fs::exists(folder_->path("none")));
}
} // namespace compared_runs_tests
