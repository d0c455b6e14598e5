#pragma once

#include "cases/parameters.h"
#include "coupling/state_file.h"

#include <cstdint>
#include <string>

namespace antiform::cases
{
struct Summary;

/// What is halved: the loading rate; or, without time, load step and tolerance.
struct Halving
{
  explicit Halving(const Parameters &parameters)
      : is_of_tolerance(parameters.follows_events())
  {
  }
  bool is_of_tolerance;
  std::string words() const; ///< "half the rate"
  std::string directory() const; ///< of the repetition, within that of the run
};

/// What a run at half the loading rate, from shortly before the peak on, has changed.
struct RateEstimate
{
  Halving halving;
  double peak = 0.;         ///< largest stress at what the deck asks for [Pa]
  double peak_at_half = 0.; ///< [Pa]

  /// Positive where the faster, or coarser, run was the stronger [-].
  double change() const { return peak / peak_at_half - 1.; }
  void fill(Summary &summary) const;
};

/// Deck of the repetition: half the rate, half the load step and relaxation tolerance, or
/// half the event driver's load step (half_load_step()) and tolerance; ends once the
/// stress has fallen by a tenth.
Parameters at_half_rate(const Parameters &parameters);

/// The states of the last rises of the stress by a tenth, each a checkpoint of the run at
/// half the rate: where the peak lies is known only after it. Two are kept.
class StatesBeforePeak
{
public:
  explicit StatesBeforePeak(std::string directory)
      : directory_(std::move(directory))
  {
  }

  /// Whether to keep a state now: something has broken, and the stress has grown by a
  /// tenth since the last.
  /// \param stress largest so far [Pa]
  bool wants(const double stress, const bool has_cracks) const
  {
    return has_cracks && stress >= 1.1 * stress_[1];
  }
  bool is_empty() const { return number_ == 0; }
  /// The file for it; that of the one before the last goes once it is written.
  std::string next_file() const { return file(number_ + 1); }
  void kept(double stress);

  /// Stress of the latest state at 0.95 of @p peak or below [Pa]; 0: there is none.
  double stress_before(double peak) const;
  std::string file_before(double peak) const;
  void remove_files() const;
  void visit_state(coupling::StateArchive &archive);

private:
  std::string file(std::int64_t number) const;
  bool latest_is_before(double peak) const { return stress_[1] <= 0.95 * peak; }

  std::string directory_;
  std::int64_t number_ = 0;     ///< of the latest; 0: none yet
  double stress_[2] = {0., 0.}; ///< of the one before the latest, of the latest [Pa]
};

/// Lay out @p directory as if the run of @p deck had been made there up to @p state: its
/// deck, the tables and fields of @p former, the checkpoint last. Throws
/// std::runtime_error when the disk is full.
void begin_from(const std::string &state,
                const std::string &former,
                const Parameters &deck,
                const std::string &directory);
} // namespace antiform::cases
