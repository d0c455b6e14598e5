// The page of a study: which curves it draws, how it tells them apart, and closed forms
// between the members. Studies of figures that are known, none of which is run.
#include "support/files.h"
#include "support/table.h"
#include "support/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace study_pages_tests
{
using namespace antiform::test;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace
{
/// Run a script that has the modules of the page at hand, Study and charts.
Outcome run_script(const TemporaryFolder &folder,
                   const std::string &script,
                   const std::string &arguments)
{
  const std::string file = folder.path("script.py");
  std::ofstream(file) << "import sys\n"
                         "sys.path.insert(0, '" ANTIFORM_SOURCE_DIR "/cases')\n"
                         "import matplotlib\n"
                         "matplotlib.use('Agg')\n"
                         "import numpy as np\n"
                         "from study_file import Study\n"
                         "import study_charts as charts\n"
                      << script;
  return run_command(clean_environment() + "MPLCONFIGDIR=" + folder.path("matplotlib") +
                     " /usr/bin/python3 -B " + file + " " + arguments);
}

/// study.json of members that have all been completed.
class StudyRecord
{
public:
  /// \param entries and their columns \param figures names, columns and units
  StudyRecord(const std::vector<std::array<std::string, 2>> &entries,
              const std::vector<std::array<std::string, 3>> &figures)
      : json_({{"title", "known"},
               {"version", "0"},
               {"status", "completed"},
               {"warnings", Json::array()},
               {"vary", Json::array()},
               {"collect", Json::array()},
               {"members", Json::array()}})
  {
    for (const auto &[path, column] : entries)
      json_["vary"].push_back({{"entry", path}, {"column", column}});
    for (const auto &[name, column, unit] : figures)
      json_["collect"].push_back({{"name", name}, {"column", column}, {"unit", unit}});
  }
  /// \return its name
  std::string add(const std::vector<std::string> &values,
                  const std::vector<double> &figures)
  {
    Json member = {{"name", "m" + std::to_string(json_["members"].size())},
                   {"values", Json::object()},
                   {"status", "completed"},
                   {"figures", Json::object()}};
    for (std::size_t i = 0; i < values.size(); ++i)
      member["values"][json_["vary"][i]["column"].get<std::string>()] = values[i];
    for (std::size_t i = 0; i < figures.size(); ++i)
      member["figures"][json_["collect"][i]["column"].get<std::string>()] = figures[i];
    json_["members"].push_back(member);
    return member["name"];
  }
  void write(const std::string &directory) const
  {
    fs::create_directories(directory + "/members");
    std::ofstream(directory + "/study.json") << json_;
  }

private:
  Json json_;
};

/// The values of cases/burial-depth/study-fracture.prm: 36 members, whose cell size is
/// zipped to cover and join together.
StudyRecord fracture_study()
{
  StudyRecord record(
      {{"Matrix/Stiffness contrast", "stiffness_contrast"},
       {"Layer/Length ratio", "length_ratio"},
       {"Matrix/Burial depth ratio", "burial_depth_ratio"},
       {"Matrix/Join", "join"},
       {"Matrix/Cell size ratio", "cell_size_ratio"}},
      {{"peak_stress", "peak_stress_Pa", "Pa"},
       {"theory/at_length/perry_robertson/guided", "theory_crushing_Pa", "Pa"},
       {"theory/at_length/with_matrix/guided", "theory_buckling_Pa", "Pa"},
       {"crack_initiation_stress", "crack_initiation_stress_Pa", "Pa"},
       {"theory/regime/theta", "theory_regime_theta", "-"},
       {"fold_amplitude", "fold_amplitude_m", "m"},
       {"energy/closure_error", "energy_closure_error", "-"}});
  const std::vector<std::array<std::string, 3>> covers{
      {"0.01", "automatic", "9"}, {"0.03", "automatic", "9"},
      {"0.1", "automatic", "9"},  {"0.3", "automatic", "9"},
      {"1", "automatic", "2"},    {"1", "surface interface", "6"},
      {"3", "automatic", "2"},    {"3", "grain cover", "2"},
      {"10", "automatic", "2"},   {"30", "automatic", "2"},
      {"100", "automatic", "2"},  {"100", "surface interface", "6"}};
  for (const auto &[contrast, length] : std::vector<std::array<std::string, 2>>{
           {"1e3", "24"}, {"3e3", "34"}, {"1e4", "50"}})
    for (const auto &[cover, join, cells] : covers)
      record.add({contrast, length, cover, join, cells},
                 {90e6, 95e6, contrast == "1e4" ? 105e6 : 400e6, 45e6,
                  std::stod(cover) / std::cbrt(std::stod(contrast)), 5., 1e-4});
  return record;
}
} // namespace

TEST(StudyPage, TellsCurvesApartByWhatIsNotZipped)
{
  const TemporaryFolder folder;
  fracture_study().write(folder.path("study"));
  const Outcome outcome = run_script(folder, R"(
study = Study(sys.argv[1])
assert study.axis == 'burial_depth_ratio', study.axis
assert study.apart == ['stiffness_contrast', 'join'], study.apart
# Three contrasts in three joins, none torn where the cell size changes.
assert len(study.keys()) == 9
assert len(study.points('peak_stress_Pa', ('1e3', 'automatic'))[0]) == 9
style = charts.Style(study)
looks = {key: style.of(key) for key in study.keys()}
assert len({tuple(sorted(look.items())) for look in looks.values()}) == 9
assert len({look['color'] for look in looks.values()}) == 3
for key, look in looks.items(): # of one contrast one colour, of one join one marker
    assert look['color'] == looks[key[0], 'automatic']['color']
    assert look['marker'] == looks['1e3', key[1]]['marker']
# A place between two members of a curve that others have is no line.
at, values = study.with_gaps(*study.points('peak_stress_Pa', ('1e3', 'surface interface')))
assert len(at) == 9 and np.isfinite(values).sum() == 2
)",
                                     folder.path("study"));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(StudyPage, HasNoTwoCurvesThatLookAlike)
{
  // More of either key than there are colours or markers.
  StudyRecord record({{"Layer/Length ratio", "length_ratio"},
                      {"Layer/Shape", "shape"},
                      {"Matrix/Interface", "interface"}},
                     {{"peak_stress", "peak_stress_Pa", "Pa"}});
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 11; ++j)
      for (int x = 0; x < 13; ++x)
        record.add({std::to_string(x), "a" + std::to_string(i), "b" + std::to_string(j)},
                   {1e6});
  const TemporaryFolder folder;
  record.write(folder.path("study"));
  const Outcome outcome = run_script(folder, R"(
study = Study(sys.argv[1])
assert study.apart == ['shape', 'interface'], study.apart
style = charts.Style(study)
assert len({tuple(sorted(style.of(key).items())) for key in study.keys()}) == 132
)",
                                     folder.path("study"));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

TEST(StudyPage, DrawsClosedFormsBesideTheFiguresOfTheirKind)
{
  const TemporaryFolder folder;
  const std::string study = folder.path("study");
  fracture_study().write(study);
  const Outcome outcome = run_script(folder, R"(
study = Study(sys.argv[1])
panels = charts.panels_of(study)
beside = {panel.what['name']: [t['name'].split('/')[2] for t in panel.theory]
          for panel in panels}
assert beside['peak_stress'] == ['perry_robertson', 'with_matrix'], beside
assert beside['crack_initiation_stress'] == [] and beside['fold_amplitude'] == [], beside
assert beside['theory/regime/theta'] == ['theta'], beside # of its own, but there
charts.draw(study, panels[:1])
# What is far above all points is said, and does not flatten them.
assert len(panels[0].far) == 1 and '400' in panels[0].far[0], panels[0].far
)",
                                     study);
  EXPECT_EQ(outcome.status, 0) << outcome.output;

  const Outcome page = draw_page("report " + study, folder.path("matplotlib"));
  ASSERT_EQ(page.status, 0) << page.output;
  const std::string html = contents(study + "/study.html");
  EXPECT_EQ(occurrences(html, "<svg"), 5u); // a chart each, and that of Theta
  EXPECT_EQ(occurrences(html, "perry robertson guided<"), 1u) << "in one legend";
  EXPECT_EQ(occurrences(html, "closure error (J)"), 0u);
  EXPECT_EQ(occurrences(html, "src="), 0u);
  // A phone of 412 px shows 380 px of the page: text of 8 points at 9 px or more.
  for (std::size_t at = html.find("<svg"); at != std::string::npos;
       at = html.find("<svg", at + 1))
    EXPECT_LE(std::stod(html.substr(html.find("width=\"", at) + 7)), 330.);
  // Names that a chart refers to are in the page once.
  std::set<std::string> names;
  std::size_t n_names = 0;
  for (std::size_t at = html.find(" id=\""); at != std::string::npos;
       at = html.find(" id=\"", at + 1), ++n_names)
    names.insert(html.substr(at, html.find('"', at + 5) - at));
  EXPECT_EQ(names.size(), n_names);
  EXPECT_TRUE(fs::exists(study + "/study.svg"));
  EXPECT_FALSE(fs::exists(study + "/study-2.svg")); // six a sheet
}

TEST(StudyPage, HasClosedFormsBetweenMembersToo)
{
  // Members where tests/data has the critical stress, computed independently.
  const double contrast = 1e4, layer = 56e9 / (1. - 0.25 * 0.25);
  const double stress = std::cbrt(layer * std::pow(layer / contrast, 2));
  StudyRecord record({{"Matrix/Burial depth ratio", "burial_depth_ratio"},
                      {"Matrix/Cover rows", "cover_rows"}},
                     {{"critical_stress", "critical_stress_Pa", "Pa"},
                      {"theory_stress", "theory_stress_Pa", "Pa"}});
  const TemporaryFolder folder;
  const std::string study = folder.path("study");
  double between = 0.;
  std::string first;
  for (const std::vector<std::string> &row : table("cover_master_curve.csv"))
  {
    const double F = std::stod(row[1]);
    if (row[0] == "0.8")
      between = F * stress;
    if (row[0] != "0.1" && row[0] != "0.5" && row[0] != "1.1")
      continue;
    char cover[40];
    std::snprintf(cover, sizeof cover, "%.15g", std::stod(row[0]) * std::cbrt(contrast));
    const std::string name =
        record.add({cover, row[0] == "0.1" ? "1" : "0"}, {F * stress, F * stress});
    first = first.empty() ? cover : first;
    fs::create_directories(study + "/members");
    std::ofstream(study + "/members/" + name + ".prm")
        << "include " ANTIFORM_SOURCE_DIR "/cases/burial-depth/buckling.prm\n"
        << "subsection Matrix\nset Burial depth ratio = " << cover
        << "\nset Cover rows = " << (row[0] == "0.1" ? 1 : 0) << "\nend\n";
  }
  record.write(study);
  ASSERT_GT(between, 0.);
  const std::string script = R"(
study, between, contrast = Study(sys.argv[1], sys.argv[2]), float(sys.argv[3]), 1e4
panel = charts.panels_of(study)[0]
assert [t['name'] for t in panel.theory] == ['theory_stress']
x, y = study.theory(panel.theory[0], ())
assert len(x) > 50 and not study.missed, len(x)
place = 0.8 * contrast ** (1. / 3.)
# Samples are 2 % apart; straight between the members it is 1.7 % above.
assert abs(np.interp(place, x, y) / between - 1.) < 2e-3, np.interp(place, x, y)
at = study.points('theory_stress_Pa', ())
assert np.interp(place, *at) / between - 1. > 0.015
assert abs(study.theta_per_axis(()) * contrast ** (1. / 3.) - 1.) < 1e-9
# Without the program, or where it has other closed forms: at the members.
alone = Study(sys.argv[1])
assert len(alone.theory(panel.theory[0], ())[0]) == 3 and alone.missed
for member in study.members: member['figures']['theory_stress_Pa'] *= 1.001
assert len(study.theory(panel.theory[0], ())[0]) == 3 and study.missed
)";
  const Outcome outcome = run_script(
      folder, script, study + " " ANTIFORM_PROGRAM " " + std::to_string(between));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}
} // namespace study_pages_tests
