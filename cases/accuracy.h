#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace antiform::cases
{
struct Parameters;

/// What one entry does to the error of a result and to the time of a run, as measured.
struct AccuracyCurve
{
  struct Row
  {
    std::string value; ///< of the entry
    double error;      ///< of the result, no less than that of a finer row [-]
    double seconds;    ///< of processors, of the run that it was measured in
  };
  std::string entry;     ///< "Section/Entry"
  std::string of, truth; ///< what it is the error of, and against what
  std::vector<Row> rows; ///< from coarse to fine
};

/// For each curve the row to take so that the errors together are at most @p wanted: from
/// the coarsest rows on, what lowers the error most for its time is refined first. The
/// order does not depend on @p wanted, so less of it is never coarser. Empty: the finest
/// rows are not near enough.
std::vector<std::size_t> choose_rows(const std::vector<AccuracyCurve> &curves,
                                     double wanted);

/// The error of a value between two rows, straight over its logarithm; nothing
/// outside of them.
std::optional<double> error_of(const AccuracyCurve &curve, const std::string &value);

/// An entry that decides how near a run comes to what it stands for.
struct AccuracySetting
{
  std::string entry, value;
  bool is_chosen = false;      ///< by the record
  bool is_given = false;       ///< by the deck; neither: the default stands
  std::optional<double> error; ///< by the record, where it has one [-]
  std::string why_unknown;     ///< why the record has none
  std::string of, truth;
};

/// What another error would take.
struct AccuracyAlternative
{
  double wanted = 0.; ///< [-]
  /// Entries and their values; empty: not in the record.
  std::vector<std::pair<std::string, std::string>> values;
  double relative_seconds = 0.; ///< over those of the error that is wanted [-]
};

struct AccuracyPlan
{
  double percent = 0.; ///< error wanted; 0: nothing is chosen
  std::vector<AccuracySetting> settings;
  /// From large errors to small, as if the deck set none of the entries.
  std::vector<AccuracyAlternative> alternatives;
  /// Standard deviation of one packing's peak [-]; where grains may break.
  std::optional<double> packing_scatter;

  double sum_of_errors() const;              ///< of those that are known [-]
  std::vector<std::string> warnings() const; ///< of those that are not
};

/// What the record says of a scene in which @p given are the entries that its deck sets:
/// these stay, their errors count first. Reads @p p.accuracy.percent.
/// \param[out] problem why nothing can be chosen, and which entries stand in the way
AccuracyPlan plan_accuracy(const Parameters &p,
                           const std::set<std::string> &given,
                           std::string &problem);

/// A table for people, a line each; nothing where no accuracy is wanted.
std::vector<std::string> accuracy_in_words(const AccuracyPlan &plan);
/// The same for programs: a JSON object as text (docs/output.md).
std::string accuracy_json(const AccuracyPlan &plan);

/// The curve of the record (cases/accuracy/record.csv, compiled in) that @p knob names:
/// of its scenes the stoutest that is no stouter than @p length_ratio, L/h of a layer.
/// Without rows where all are stouter. Throws std::logic_error for an unknown name.
AccuracyCurve accuracy_curve(const std::string &knob, double length_ratio = 0.);
/// Standard deviation between packings over the mean, with @p grains_across, of the peak.
std::optional<double> packing_scatter(double grains_across);
} // namespace antiform::cases
