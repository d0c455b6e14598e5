#include "cases/calibrate.h"

#include "cases/directory_lock.h"
#include "cases/interrupt.h"
#include "cases/output_directory.h"
#include "cases/predicted_cost.h"
#include "cases/run_log.h"
#include "cases/trial_pool.h"
#include "coupling/output/whole_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <thread>
#include <unistd.h>

namespace antiform::cases
{
namespace
{
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string today()
{
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::localtime(&now));
  return text;
}

int jobs_of(const Parameters &p)
{
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return p.calibration.jobs > 0 ? p.calibration.jobs : std::max(1, cores);
}

/// Settle where a calibration writes, before any work: see prepare_output_directory() for
/// a run's. Throws InputError when the directory holds something else.
void prepare(RunOptions &options)
{
  if (options.output.empty())
    options.output = fs::path(options.deck).replace_extension("").string() + "-output";
  const std::string begin = "output directory '" + options.output + "': ";
  const fs::path directory(options.output);
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw InputError({begin + "cannot be created (" + error.message() +
                      "). Give one that can be written to with -o DIR."});
  prove_writable(options.output);
  for (const char *name : {"state.h5", "history.csv", "summary.json"})
    if (fs::exists(directory / name, error))
      throw InputError({begin + "holds another run (" + name +
                        "). Give another directory with -o DIR."});
  if (fs::exists(directory / "trials.csv", error) && !options.resume)
    throw InputError({begin +
                      "holds another calibration (trials.csv). Go on with it with "
                      "--resume (finished trials are not run again), give another "
                      "directory with -o DIR, or remove this one."});
}

Json to_json(const MicroParameters &micro)
{
  Json json;
  for (const MicroName &name : micro_names())
    json[name.column] = micro.*name.value;
  return json;
}

/// calibration.json, complete after each evaluation.
class Record
{
public:
  Record(std::string path, const Parameters &p, const CalibrationProblem &problem)
      : path_(std::move(path))
      , problem_(problem)
  {
    json_ = {{"title", p.title},
             {"version", ANTIFORM_VERSION},
             {"status", "running"},
             {"met", false},
             {"message", ""},
             {"wall_seconds", 0.},
             {"cpu_seconds", 0.},
             {"trials", 0},
             {"grains_across", p.layer.grains_across},
             {"free", Json::array()},
             {"targets", Json::array()},
             {"evaluations", Json::array()}};
    for (const FreeParameter &free : problem.free)
      json_["free"].push_back({{"name", free.micro.name},
                               {"column", free.micro.column},
                               {"lower", free.lower},
                               {"upper", free.upper}});
    for (const Target &target : problem.targets)
      json_["targets"].push_back({{"name", target.name},
                                  {"unit", "Pa"},
                                  {"test", target.test.name()},
                                  {"sigma3_Pa", target.test.confinement},
                                  {"target", target.value},
                                  {"tolerance", target.tolerance}});
  }

  void add(const Evaluation &e)
  {
    Json json = {{"stage", e.stage},
                 {"seeds", e.seeds},
                 {"parameters", to_json(e.micro)},
                 {"results", Json::object()}};
    for (std::size_t i = 0; i < problem_.targets.size(); ++i)
      if (e.has(i))
        json["results"][problem_.targets[i].name] = e.results[i];
    json_["evaluations"].push_back(json);
  }

  void add(const CalibrationResult &result)
  {
    json_["met"] = result.met;
    json_["parameters"] = to_json(result.micro);
    json_["checks"] = result.rounds;
    json_["packings_before_check"] = result.packings_before;
    for (std::size_t i = 0; i < problem_.targets.size(); ++i)
    {
      Json &target = json_["targets"][i];
      target["expected"] = result.expected[i];
      target["reached"] = result.check.mean(i);
      target["standard_deviation"] = result.check.deviation(i);
      target["met"] = is_met(result.check, problem_.targets, i);
    }
  }

  void write(const std::string &status,
             const std::string &message,
             const double wall_seconds,
             const TrialPool &pool)
  {
    json_["status"] = status;
    json_["message"] = message;
    json_["wall_seconds"] = wall_seconds;
    json_["cpu_seconds"] = pool.cpu_seconds();
    json_["trials"] = pool.n_run() + pool.n_found();
    coupling::replace_file(path_, json_.dump(2) + '\n');
  }

private:
  std::string path_;
  const CalibrationProblem &problem_;
  Json json_;
};

std::string describe(const Evaluation &e, const CalibrationProblem &problem)
{
  char text[64];
  std::string line = e.stage + ":";
  for (const FreeParameter &free : problem.free)
  {
    const double value = e.micro.*free.micro.value;
    const bool is_pascal = free.is_logarithmic;
    std::snprintf(text, sizeof text, " %s %.4g%s,", free.micro.name.c_str(),
                  is_pascal ? 1e-6 * value : value, is_pascal ? " MPa" : "");
    line += text;
  }
  line.back() = ';';
  for (std::size_t i = 0; i < problem.targets.size(); ++i)
    if (e.has(i))
    {
      const Target &target = problem.targets[i];
      std::snprintf(text, sizeof text, " %s %+.1f %%,", target.name.c_str(),
                    100. * (e.mean(i) / target.value - 1.));
      line += text;
    }
  line.pop_back();
  return line;
}

/// Trials and core seconds of the parts of a calibration.
struct Cost
{
  double elastic = 0., evaluation = 0., differences = 0., check = 0.;
};

struct Costs
{
  Cost trials, seconds;
};

Costs predict_costs(const Parameters &p, const CalibrationProblem &problem)
{
  MachineSpeed speed; // trials have a core each
  Costs costs;
  const auto seconds_of = [&](const Test &test)
  {
    const Parameters deck = deck_of({test, problem.first_seed, problem.start}, p);
    const SectionGeometry geometry(deck);
    return predict_cost(deck, geometry, predict_sizes(deck, geometry), speed)
        .core_seconds();
  };
  const double search = problem.search_seeds, check = problem.check_seeds;
  const auto is_free = [&](const std::string &name)
  {
    return std::any_of(problem.free.begin(), problem.free.end(),
                       [&](const FreeParameter &f) { return f.micro.name == name; });
  };
  if (is_free("effective modulus"))
  {
    costs.trials.elastic = search;
    costs.seconds.elastic = search * seconds_of({Test::Kind::elastic, 0.});
  }
  // Differences of E* are known, those of the slits concern every test.
  const double columns =
      static_cast<double>(problem.free.size()) - (is_free("effective modulus") ? 1. : 0.);
  for (const Test &test : tests_of(problem.targets))
  {
    const double seconds = seconds_of(test);
    const double n = test.kind == Test::Kind::compression
                         ? columns
                         : (is_free("slit fraction") ? 1. : 0.);
    costs.trials.evaluation += search;
    costs.seconds.evaluation += search * seconds;
    costs.trials.differences += n * std::min(search, 2.);
    costs.seconds.differences += n * std::min(search, 2.) * seconds;
    costs.trials.check += check;
    costs.seconds.check += check * seconds;
  }
  return costs;
}
} // namespace

void demand_calibration(const Parameters &p, const bool wanted)
{
  if (p.has("calibration") && !wanted)
    throw InputError({"'Components' lists 'calibration': this deck is for 'antiform "
                      "calibrate DECK'. To run one test, take a deck of "
                      "cases/laboratory."});
  if (!p.has("calibration") && wanted)
    throw InputError(
        {"'Components' does not list 'calibration': this deck has no targets. "
         "Take one like cases/laboratory/calibrate-rock-1.prm, or 'antiform "
         "run DECK'."});
}

int check_cost_of_calibration(const Parameters &p, const bool json, std::ostream &out)
{
  const CalibrationProblem problem = calibration_problem(p);
  const Costs costs = predict_costs(p, problem);
  const int jobs = jobs_of(p);
  // A search takes about three evaluations; with luck one check will do.
  const auto total = [&](const Cost &c, const double evaluations, const double checks)
  { return c.elastic + c.differences + evaluations * c.evaluation + checks * c.check; };
  const double usual = total(costs.seconds, 3., 2.) / jobs,
               most =
                   total(costs.seconds, problem.evaluations, problem.check_rounds) / jobs;
  const double n_usual = total(costs.trials, 3., 2.),
               n_most = total(costs.trials, problem.evaluations, problem.check_rounds);
  const Parameters specimen =
      deck_of({problem.targets.front().test, problem.first_seed, problem.start}, p);
  const Sizes sizes = predict_sizes(specimen, SectionGeometry(specimen));
  if (json)
  {
    Json all = {{"title", p.title}, {"jobs", jobs}, {"targets", Json::array()}};
    for (const Target &t : problem.targets)
      all["targets"].push_back(
          {{"name", t.name}, {"target_Pa", t.value}, {"tolerance", t.tolerance}});
    all["start"] = to_json(problem.start);
    all["trials"] = {{"usual", n_usual}, {"most", n_most}};
    all["prediction"] = {{"wall_seconds_usual", usual}, {"wall_seconds_most", most}};
    out << all.dump(2) << '\n';
    return 0;
  }
  char text[160];
  out << p.title << "\n\nTargets\n";
  for (const Target &t : problem.targets)
  {
    std::snprintf(text, sizeof text, "  %-20s %10.4g MPa within %.3g %%, by test '%s'\n",
                  t.name.c_str(), 1e-6 * t.value, 100. * t.tolerance,
                  t.test.name().c_str());
    out << text;
  }
  out << "\nFree\n";
  for (const FreeParameter &free : problem.free)
  {
    std::snprintf(text, sizeof text, "  %-20s from %.4g, within %.4g to %.4g\n",
                  free.micro.name.c_str(), problem.start.*free.micro.value, free.lower,
                  free.upper);
    out << text;
  }
  out << "\nSize and cost (predicted)\n";
  std::snprintf(text, sizeof text,
                "  specimens of %.0f grains; %d seeds in the search, %d in each check\n",
                sizes.grains, problem.search_seeds, problem.check_seeds);
  out << text;
  std::snprintf(
      text, sizeof text,
      "  trials: %.0f elastic, %.0f an evaluation, %.0f for differences, %.0f a "
      "check\n",
      costs.trials.elastic, costs.trials.evaluation, costs.trials.differences,
      costs.trials.check);
  out << text;
  std::snprintf(
      text, sizeof text,
      "  about %.0f trials and %.0f minutes, %.0f and %.0f at most, %d at once\n",
      n_usual, usual / 60., n_most, most / 60., jobs);
  out << text;
  return 0;
}

int calibrate(const Parameters &p, const RunOptions &given)
{
  RunOptions options = given;
  prepare(options);
  const DirectoryLock lock(options.output, "a calibration, or a trial that one has left,",
                           DirectoryLock::Children::hold);
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&]
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
        .count();
  };
  coupling::replace_file(options.output + "/deck.prm", effective_deck(p));
  RunLog log(options.output + "/log.txt", true, options.resume);
  log.line("antiform " ANTIFORM_VERSION ": " + p.title);
  catch_interrupts();

  const CalibrationProblem problem = calibration_problem(p);
  TrialPool pool(options.output, p, jobs_of(p),
                 [&](const std::string &text) { log.line("    " + text); });
  Record record(options.output + "/calibration.json", p, problem);
  const auto end = [&](const std::string &status, const std::string &message)
  {
    record.write(status, message, elapsed(), pool);
    if (!message.empty())
      log.line(message);
    char text[128];
    std::snprintf(text, sizeof text,
                  "%s: %d trials (%d of them found), %.0f s, %.0f core seconds",
                  status.c_str(), pool.n_run() + pool.n_found(), pool.n_found(),
                  elapsed(), pool.cpu_seconds());
    log.line(text);
  };
  try
  {
    const CalibrationResult result = calibrate(
        problem, [&](const std::vector<Trial> &trials) { return pool(trials); },
        [&](const Evaluation &e)
        {
          record.add(e);
          record.write("running", "", elapsed(), pool);
          log.line("  " + describe(e, problem));
        });
    record.add(result);
    coupling::replace_file(options.output + "/rock.prm",
                           rock_file(p, problem, result, today()));
    for (const std::string &line : table_of(problem, result))
      log.line(line);
    end("completed", result.met ? ""
                                : "not all targets are met on fresh packings. More "
                                  "'Calibration/Search seeds' or 'Check rounds' even out "
                                  "the scatter; a target that is missed each time needs "
                                  "another free parameter ('Calibration/Free')");
    log.line("rock: " + options.output + "/rock.prm");
    return result.met ? 0 : 2;
  }
  catch (const Interrupted &)
  {
    end("interrupted",
        "interrupted: trials have left checkpoints, continue with --resume");
    return 3;
  }
  catch (const TrialFailed &error)
  {
    end("failed", error.what());
    return 2;
  }
}
} // namespace antiform::cases
