#include "cases/summary.h"

#include "coupling/output/whole_file.h"

#include <deal.II/base/mpi.h>

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <cmath>
#include <stdexcept>

namespace antiform::cases
{
namespace
{
using Json = nlohmann::ordered_json;

/// @p x, which a run that came to its end has; what a failed one has lost is null.
Json number(const std::string &path,
            const std::string &entry,
            const double x,
            const bool failed)
{
  if (!std::isfinite(x) && failed)
    return nullptr;
  if (!std::isfinite(x))
    throw std::runtime_error("'" + path + "' is not written: '" + entry + "' is " +
                             (std::isnan(x) ? "not a number" : "infinite") +
                             ". The run has no such result; look at history.csv and "
                             "log.txt for the step where it was lost.");
  return x;
}

double seconds(const timeval &time)
{
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}
} // namespace

Usage measure_usage(const MPI_Comm communicator)
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  using dealii::Utilities::MPI::sum;
  return {sum(seconds(usage.ru_utime) + seconds(usage.ru_stime), communicator),
          static_cast<std::int64_t>(sum(
              static_cast<unsigned long long>(usage.ru_maxrss) * 1024, communicator))};
}

void write_summary(const std::string &path, const Summary &summary)
{
  if (summary.status != "completed" && summary.status != "failed" &&
      summary.status != "interrupted")
    throw std::logic_error("The status of a run cannot be '" + summary.status + "'.");

  Json json;
  json["title"] = summary.title;
  json["version"] = summary.version;
  json["status"] = summary.status;
  json["warnings"] = summary.warnings;
  const auto finite = [&](const std::string &entry, const double x)
  { return number(path, entry, x, summary.status == "failed"); };
  json["wall_seconds"] = finite("wall_seconds", summary.wall_seconds);
  json["cpu_seconds"] = finite("cpu_seconds", summary.cpu_seconds);
  json["peak_memory_bytes"] = summary.peak_memory;
  json["ranks"] = summary.ranks;
  json["threads"] = summary.threads;
  json["sizes"] = summary.sizes;
  json["steps"] = summary.steps;
  json["solves"] = summary.solves;
  json["results"] = Json::object();
  for (const auto &[name, result] : summary.results)
    json["results"][name] = {{"value", finite("results/" + name, result.value)},
                             {"unit", result.unit}};
  json["energy"] = Json::object();
  for (const auto &[name, value] : summary.energy)
    json["energy"][name] = finite("energy/" + name, value);
  json["effects"] = Json::object();
  for (const auto &[name, effect] : summary.effects)
    json["effects"][name] = {
        {"active", effect.active},
        {"reason", effect.reason},
        {"calls", effect.calls},
        {"seconds", finite("effects/" + name + "/seconds", effect.seconds)}};
  if (summary.accuracy.percent > 0.)
    json["accuracy"] = Json::parse(accuracy_json(summary.accuracy));
  // A title may come in any encoding; JSON is UTF-8.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
  coupling::replace_file(path, text + '\n');
}
} // namespace antiform::cases
