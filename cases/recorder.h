#pragma once

#include "cases/fold_gauge.h"
#include "cases/fracture_pattern.h"
#include "cases/scene.h"
#include "cases/small_strain.h"
#include "cases/specimen.h"
#include "cases/summary.h"
#include "coupling/output/tables.h"
#include "coupling/output/vtu.h"
#include "coupling/simulation.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// Watches a run: history, cracks, fields, peak, energy ledger, warnings. Reads the scene
/// and changes nothing in it. Everything that a resumed run needs passes through
/// visit_state().
class Recorder : public coupling::Component
{
public:
  /// \param resumed tables and field files of the directory are continued, not replaced
  ///                (visit_state() must be called before the first step then)
  Recorder(Scene &scene, std::string directory, bool resumed);

  void run(coupling::Stage stage, const coupling::Clock &clock) override;
  bool acted() const override { return acted_; }
  void visit_state(coupling::StateArchive &archive) override;

  bool is_due(const coupling::Clock &clock) const
  {
    return clock.step % sample_interval_ == 0;
  }
  /// The deck's end has been reached; why() says which.
  bool finished() const { return !why_finished_.empty(); }
  const std::string &why_finished() const { return why_finished_; }
  /// Share of the run done, as far as it can be told [-].
  double share_done() const;

  /// Largest axial stress so far, in the direction of loading [Pa].
  double peak_stress() const { return peak_stress_; }
  /// The largest stress lies so far back that it counts as the peak.
  bool has_passed_peak() const;

  /// Fields of the present state, at the end of a run.
  void write_fields();
  void fill(Summary &summary) const;

private:
  struct Sample
  {
    double shortening = 0., axial_stress = 0., wall_force = 0., matrix_share = 0.;
    FoldGauge::Reading fold;
    double strain = 0., stress = 0.; ///< in the direction of loading: they grow
    std::vector<double> gauges;      ///< of a specimen, or of walls that turn
  };
  Sample measure() const;
  bool writes_tables() const; ///< the first rank does
  double over_ranks(double share) const;
  void append_history(const coupling::Clock &clock, const Sample &sample);
  void append_cracks();
  void close_ledger(const coupling::Energies &energies);
  bool falls_below_share(const Sample &sample) const; ///< wanted, of the peak
  void look_for_end(const Sample &sample);
  /// Slope of @p values over the strain while the layer is elastic.
  /// Nothing with fewer than two records there.
  std::optional<double> elastic_slope(const std::vector<double> &values) const;
  double crack_initiation_stress() const;
  std::vector<std::string> columns() const;
  const std::vector<std::string> &crack_columns() const;
  void fill_loading(Summary &summary) const;

  Scene &scene_;
  std::string directory_;
  FoldGauge fold_;
  std::int64_t sample_interval_ = 1;
  bool acted_ = false;
  std::optional<coupling::Table> history_;
  std::optional<coupling::CrackTable> crack_table_;

  // State.
  /// Samples, in the direction of loading: strain, stress and force; cracks so far.
  std::vector<double> strain_, stress_, total_, cracks_;
  std::optional<SpecimenRecord> specimen_;
  double peak_stress_ = 0., peak_strain_ = 0., peak_share_ = 0.;
  FoldAtPeak at_peak_;
  double last_high_strain_ = 0.; ///< the stress was above the share that ends the run
  double first_crack_strain_ = 0., first_crack_stress_ = 0.;
  std::int64_t n_tensile_ = 0, n_shear_ = 0;
  double next_field_ = 0.;
  std::vector<double> field_shortening_;
  double strain_origin_ = 0.;
  double largest_gap_ = 0., largest_terms_ = 0.; ///< of the ledger [J]
  SmallStrainWatch mesh_watch_;
  double ratio_ = 0.;
  coupling::Energies energies_;
  Sample last_;
  std::string why_finished_;
  bool without_peak_ = false; ///< the longest shortening came first
};
} // namespace antiform::cases
