#include "cases/recorder.h"

#include "cases/bending_record.h"
#include "cases/field_output.h"
#include "cases/fracture_record.h"
#include "cases/scene_events.h"
#include "continuum/errors.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
using coupling::Clock;
using coupling::Energies;
using coupling::Stage;

namespace
{
const std::vector<std::string> history_columns{"step",
                                               "time_s",
                                               "shortening",
                                               "axial_stress_Pa",
                                               "wall_force_N",
                                               "matrix_share",
                                               "cracks_tensile",
                                               "cracks_shear",
                                               "fold_amplitude_m",
                                               "limb_dip_deg",
                                               "unbalanced_ratio",
                                               "displacement_gap_m",
                                               "surface_uplift_m",
                                               "boundary_work_J",
                                               "kinetic_J",
                                               "strain_grains_J",
                                               "strain_continuum_J",
                                               "slip_J",
                                               "damping_J",
                                               "fracture_J"};

// A peak counts when the curve has stayed below it over so much shortening.
constexpr double settled = 2e-4;
// The stress has fallen for good when it has stayed down over so many axial transits and
// samples.
constexpr double fallen_transits = 2., fallen_samples = 3.;
// Rotations of walls are sums of their steps.
constexpr double round_off = 1. - 1e-9;
} // namespace

Recorder::Recorder(Scene &scene, std::string directory, const bool resumed)
    : scene_(scene)
    , directory_(std::move(directory))
    , fold_(scene)
{
  const Parameters &p = scene.parameters;
  const double per_step = scene.shortening_rate * scene.simulation->clock().dt;
  if (per_step > 0.)
    sample_interval_ = std::max<std::int64_t>(
        1, std::llround(1e-3 / (p.output.samples_per_millistrain * per_step)));
  if (p.is_bridged()) // its ledger is that of steps in which the mesh acts
    sample_interval_ += (p.bridging.sub_cycles - sample_interval_ % p.bridging.sub_cycles) %
                        p.bridging.sub_cycles;
  if (p.is_specimen() && !p.bends())
    specimen_.emplace(scene);
  if (!resumed && writes_tables())
  {
    history_.emplace(directory_ + "/history.csv", columns());
    if (scene.grains)
      crack_table_.emplace(directory_ + "/cracks.csv", crack_columns());
  }
}

std::vector<std::string> Recorder::columns() const
{
  std::vector<std::string> names = history_columns;
  if (specimen_)
    names.insert(names.end(), SpecimenRecord::columns().begin(),
                 SpecimenRecord::columns().end());
  if (scene_.parameters.bends())
    names.insert(names.end(), bending_columns().begin(), bending_columns().end());
  if (scene_.events != nullptr)
    names.insert(names.end(), {"largest_unbalanced_ratio", "unbalanced_over_strength"});
  return names;
}

const std::vector<std::string> &Recorder::crack_columns() const
{
  static const std::vector<std::string> none, rotation{bending_columns().front()};
  return scene_.parameters.bends() ? rotation : none;
}

bool Recorder::writes_tables() const
{
  return dealii::Utilities::MPI::this_mpi_process(scene_.communicator()) == 0;
}

double Recorder::over_ranks(const double share) const
{
  return dealii::Utilities::MPI::sum(share, scene_.communicator());
}

Recorder::Sample Recorder::measure() const
{
  const SectionGeometry &g = scene_.geometry;
  Sample sample;
  sample.shortening = scene_.shortening();
  if (scene_.wall_motion != nullptr)
  {
    double layer = scene_.wall_motion->mesh_reaction(true);
    double matrix = scene_.wall_motion->mesh_reaction() - layer;
    if (scene_.grains)
    {
      for (int bed = 0; bed < scene_.parameters.n_beds(); ++bed)
        layer += scene_.wall_motion->grain_reaction(bed_region(bed));
      matrix += scene_.wall_motion->grain_reaction(matrix_region);
    }
    sample.wall_force = layer + matrix;
    sample.axial_stress = layer / g.thickness();
    sample.matrix_share = sample.wall_force != 0. ? matrix / sample.wall_force : 0.;
  }
  if (scene_.pulls())
  {
    sample.wall_force = -scene_.tension();
    sample.axial_stress = sample.wall_force / g.thickness();
  }
  sample.strain = scene_.strain();
  sample.stress = scene_.parameters.bends()
                      ? bending_stress(scene_)
                      : scene_.loading_sign() * sample.axial_stress;
  if (specimen_)
    sample.gauges = specimen_->measure(scene_);
  if (scene_.parameters.bends())
    sample.gauges = measure_bending(scene_);
  sample.fold = fold_.measure();
  return sample;
}

void Recorder::run(const Stage, const Clock &clock)
{
  acted_ = clock.sample_due;
  if (!acted_)
    return;
  const Sample sample = measure();
  energies_ = scene_.simulation->energies();
  for (double *const term : energies_.terms())
    *term = over_ranks(*term);
  if (strain_.empty())
    strain_origin_ = energies_.strain_grains + energies_.strain_continuum;
  ratio_ = scene_.unbalanced_ratio();
  if (!std::isfinite(energies_.stored_and_spent()) || !std::isfinite(sample.wall_force))
    throw NumericalError("simulation",
                         "energy or wall force is not a number: the run is unstable. " +
                             std::string(scene_.events != nullptr
                                             ? "Lower 'Walls / Load step'"
                                             : "Lower 'Run / Step safety'"),
                         energies_.kinetic, 0., clock.step);
  close_ledger(energies_);
  append_cracks();
  append_history(clock, sample);
  strain_.push_back(sample.strain);
  stress_.push_back(sample.stress);
  total_.push_back(scene_.loading_sign() * sample.wall_force);
  cracks_.push_back(static_cast<double>(n_tensile_ + n_shear_));
  if (specimen_)
    specimen_->keep(scene_, sample.gauges, sample.stress);
  if (sample.stress > peak_stress_)
  {
    peak_stress_ = sample.stress;
    peak_strain_ = sample.strain;
    peak_share_ = sample.matrix_share;
    at_peak_ = {sample.fold.fold_amplitude, sample.fold.limb_dip,
                static_cast<double>(n_tensile_), static_cast<double>(n_shear_)};
  }
  if (sample.stress >= scene_.parameters.run.stress_ratio_of_peak * peak_stress_)
    last_high_strain_ = sample.strain;
  last_ = sample;
  if (scene_.mesh && scene_.parameters.run.strain == "small")
  {
    mesh_watch_.measure(*scene_.solid, scene_.mesh->displacement);
    if (!falls_below_share(sample))
      mesh_watch_.demand(clock.step);
  }
  if (sample.strain >= next_field_)
  {
    write_fields();
    next_field_ += scene_.parameters.output.fields_interval;
  }
  look_for_end(sample);
}

void Recorder::close_ledger(const Energies &energies)
{
  const double sum = energies.stored_and_spent() - strain_origin_;
  largest_gap_ = std::max(largest_gap_, std::abs(energies.boundary_work - sum));
  largest_terms_ = std::max(largest_terms_, energies.magnitude() - strain_origin_);
}

void Recorder::append_history(const Clock &clock, const Sample &sample)
{
  const double gap = scene_.displacement_gap();
  if (!history_)
    return;
  std::vector<double> values{static_cast<double>(clock.step),
                             clock.time,
                             sample.shortening,
                             sample.axial_stress,
                             sample.wall_force,
                             sample.matrix_share,
                             static_cast<double>(n_tensile_),
                             static_cast<double>(n_shear_),
                             sample.fold.fold_amplitude,
                             sample.fold.limb_dip,
                             ratio_,
                             gap,
                             sample.fold.surface_uplift,
                             energies_.boundary_work,
                             energies_.kinetic,
                             energies_.strain_grains,
                             energies_.strain_continuum,
                             energies_.slip,
                             energies_.damping,
                             energies_.fracture};
  values.insert(values.end(), sample.gauges.begin(), sample.gauges.end());
  if (scene_.events != nullptr)
  {
    const coupling::BalanceRatios ratios = scene_.events->ratios();
    values.insert(values.end(), {ratios.largest, ratios.of_strength});
  }
  history_->append(values);
}

void Recorder::append_cracks()
{
  if (!scene_.grains)
    return;
  coupling::GrainState &state = scene_.grains->state;
  for (; state.cracks_recorded < state.cracks.size(); ++state.cracks_recorded)
  {
    const discrete::Crack &crack = state.cracks[state.cracks_recorded];
    if (state.cracks_recorded == 0)
    {
      first_crack_strain_ =
          scene_.parameters.bends() ? scene_.strain() : scene_.shortening();
      first_crack_stress_ = stress_.empty() ? 0. : stress_.back();
    }
    ++(crack.mode == discrete::Bond::broken_in_tension ? n_tensile_ : n_shear_);
    crack_table_->append(crack, scene_.shortening(),
                         scene_.parameters.bends()
                             ? std::vector<double>{scene_.field_time()}
                             : std::vector<double>{});
  }
}

bool Recorder::has_passed_peak() const
{
  return peak_strain_ > 0. && (last_.strain - peak_strain_ >= settled ||
                               last_.stress <= 0.9 * peak_stress_);
}

bool Recorder::falls_below_share(const Sample &sample) const
{
  return sample.stress < scene_.parameters.run.stress_ratio_of_peak * peak_stress_;
}

void Recorder::look_for_end(const Sample &sample)
{
  const RunParameters &run = scene_.parameters.run;
  const bool bends = scene_.parameters.bends();
  if (run.end_shortening > 0.)
  {
    if (sample.strain >= run.end_shortening)
      why_finished_ = "the shortening asked for";
    return;
  }
  if (bends && sample.strain >= round_off * scene_.parameters.end_bending())
    why_finished_ = "the rotation asked for";
  const double transit = 1e-3 / scene_.parameters.walls.transits_per_millistrain;
  const double between =
      scene_.load_steps != nullptr
          ? scene_.parameters.walls.load_step
          : 1e-3 / scene_.parameters.output.samples_per_millistrain;
  // What is recorded of events is in balance, and a stress that has fallen has.
  const double fallen = scene_.events != nullptr
                            ? 0.
                            : std::max(fallen_transits * transit, fallen_samples * between);
  if (falls_below_share(sample) && sample.strain - last_high_strain_ >= fallen)
    why_finished_ = std::string("the wanted share of the peak ") +
                    (bends ? "moment" : "stress");
  if (bends)
    return;
  // Nothing but the wait for it to last is missing, and the mesh can follow no further.
  if (falls_below_share(sample) && mesh_watch_.is_beyond())
    why_finished_ = "the fall of the stress, in which the mesh left small strain";
  const bool peaked = peak_strain_ > 0. && sample.strain - peak_strain_ >= settled;
  if (peaked && sample.strain >= run.strain_multiple_of_peak * peak_strain_)
    why_finished_ = "the wanted multiple of the strain at the peak";
  else if (why_finished_.empty() && sample.strain >= run.longest_shortening)
  {
    without_peak_ = !peaked;
    why_finished_ =
        std::string("the longest shortening") + (peaked ? "" : ", without a peak");
  }
}

double Recorder::share_done() const
{
  const RunParameters &run = scene_.parameters.run;
  if (run.end_shortening > 0.)
    return last_.strain / run.end_shortening;
  if (scene_.parameters.bends())
    return last_.strain / scene_.parameters.end_bending();
  if (peak_strain_ > 0. && last_.strain - peak_strain_ >= 0.25 * settled)
    return std::min(1., last_.strain / (run.strain_multiple_of_peak * peak_strain_));
  return last_.strain / run.longest_shortening;
}

void Recorder::write_fields()
{
  field_shortening_.push_back(scene_.field_time());
  write_field_files(scene_, directory_, field_shortening_);
}

void Recorder::visit_state(coupling::StateArchive &archive)
{
  archive.array("recorder/strain", strain_);
  archive.array("recorder/stress", stress_);
  archive.array("recorder/total", total_);
  archive.array("recorder/cracks", cracks_);
  if (specimen_)
    specimen_->visit_state(archive);
  archive.array("recorder/field_shortening", field_shortening_);
  std::vector<std::int64_t> integers{n_tensile_, n_shear_, 0, 0};
  if (!archive.is_loading())
  {
    integers[2] = history_ ? history_->offset() : 0;
    integers[3] = crack_table_ ? crack_table_->offset() : 0;
  }
  archive.array("recorder/integers", integers);
  n_tensile_ = integers[0];
  n_shear_ = integers[1];
  std::vector<double *> members{&peak_stress_,
                                &peak_strain_,
                                &last_high_strain_,
                                &peak_share_,
                                &at_peak_.amplitude,
                                &at_peak_.limb_dip,
                                &at_peak_.n_tensile,
                                &at_peak_.n_shear,
                                &first_crack_strain_,
                                &first_crack_stress_,
                                &next_field_,
                                &strain_origin_,
                                &largest_gap_,
                                &largest_terms_,
                                &mesh_watch_.largest_rotation,
                                &mesh_watch_.largest_strain,
                                &ratio_,
                                &last_.shortening,
                                &last_.strain,
                                &last_.stress,
                                &last_.axial_stress,
                                &last_.wall_force,
                                &last_.matrix_share,
                                &last_.fold.fold_amplitude,
                                &last_.fold.limb_dip,
                                &last_.fold.surface_uplift};
  const auto terms = energies_.terms();
  members.insert(members.end(), terms.begin(), terms.end());
  std::vector<double> values;
  for (const double *member : members)
    values.push_back(*member);
  archive.array("recorder/values", values);
  if (!archive.is_loading())
    return;
  if (values.size() != members.size())
    throw std::runtime_error("the checkpoint is of another version of the program");
  for (std::size_t k = 0; k < members.size(); ++k)
    *members[k] = values[k];
  look_for_end(last_); // a completed run has nothing left to do
  if (!writes_tables())
    return;
  history_.emplace(
      coupling::Table::reopen(directory_ + "/history.csv", columns(), integers[2]));
  if (scene_.grains)
  {
    crack_table_.emplace(directory_ + "/cracks.csv", integers[3], crack_columns());
    scene_.grains->state.cracks_recorded =
        static_cast<std::size_t>(n_tensile_ + n_shear_);
  }
}
} // namespace antiform::cases
