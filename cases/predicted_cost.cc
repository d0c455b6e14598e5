#include "cases/predicted_cost.h"

#include "cases/fracture_list.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
namespace
{
// What parts of a run take, in units of the paces that MachineSpeed measures: ratios of
// kernels on one machine, which differ less from machine to machine than seconds do. From
// summary.json ("effects") of the decks of cases/.

// In steps of a bonded grain.
constexpr double of_packing = 900.; ///< of a grain, over (length in grains)^0.6
constexpr double of_sample = 15.;    ///< of a grain, for a line of history.csv
constexpr double of_field_file = 500.;
constexpr double of_smooth_contact = 1.5;
constexpr double of_face_contact = 6.; ///< of a grain on a face that a mesh may leave
constexpr double of_contact = 0.2; ///< of a grain, beside parallel bonds; not measured
constexpr double of_walls = 0.03;  ///< of a grain: walls, membrane, unbalanced ratio
constexpr double of_events = 500.; ///< of grains to the power 3/2, up to the peak
constexpr double of_collapse = 1.4; ///< of a grain: most joints there are broken
/// Grains of a packing have no order across, those of the strip that is measured have.
/// That costs nothing in the last cache (of 32 MB, shared; 15,000 grains are 11 MB), and
/// this much out of it: measured on 28,000 and 115,000.
constexpr double of_disorder = 0.45, grains_in_cache = 15e3;
/// Smooth joints for a length of one grain diameter of a fracture, measured.
constexpr double smooth_contacts_per_diameter = 2.;

// In internal forces of a dof of the mesh.
constexpr double of_mesh_step = 1.3;
constexpr double of_multiplier = 13.; ///< forces and velocities projected

// In linear solutions of a dof.
constexpr double of_newton = 0.8; ///< assembly by a law, with its mesh made already
/// Buckling, with its load, its geometric stiffness and what its indicator takes.
constexpr double of_buckling = 5.5; ///< assemblies and factors, a round
constexpr double of_mode = 10.;     ///< solutions, a mode

/// Buckling of grains: factors of the saddle point, measured on 700 to 15,000 grains, in
/// steps of a grain. Two dofs of the mesh cost what two of a grain's three do.
constexpr double of_grain_solved = 15000.;

/// How much faster threads step @p n grains: measured 1.09, 1.5 and 1.6 of two threads on
/// 1500, 15,000 and 60,000 grains (docs/performance.md).
double speed_up(const int threads, const double n)
{
  const double others = threads - 1.;
  return threads == 1 ? 1. : std::max(1., 0.8 * threads / (1. + 700. * others / n));
}

MeshShape mesh_of(const Parameters &p, const Sizes &sizes)
{
  return {sizes.columns, sizes.rows, p.matrix.element_degree};
}

double smooth_contacts(const Parameters &p, const SectionGeometry &g)
{
  double length = 0.;
  if (p.has("fractures"))
    for (const discrete::Fracture &fracture : make_fractures(p, g))
      length += fracture.length();
  if (p.has("beds") && p.beds.interface == "frictional")
    length += (p.n_beds() - 1.) * g.length();
  return smooth_contacts_per_diameter * length / g.diameter();
}

bool breaks(const Parameters &p)
{
  for (int bed = 0; bed < p.n_beds(); ++bed)
    if (p.bed(bed).joint.breakable)
      return true;
  return p.has("matrix") && p.matrix.breakable;
}

/// Full law of joints that have lost a bond, over the step of the bonded grains of the
/// layer: through the peak of specimens in compression, confined ones; of layers, under
/// whatever pressure, the more, the further they go beyond it (0.17, 0.33, 0.37, 0.8 at
/// 1.2, 1.5, 1.6, 2 of its strain), and no more than 0.3 where they slide on fractures; a
/// specimen in tension has few. Measured [-].
double share_of_broken_joints(const Parameters &p, const PredictedCourse &course,
                              const double strain_at_peak)
{
  if (!breaks(p) || course.shortening < 0.6 * strain_at_peak ||
      (p.has("walls") && p.walls.action == "pull"))
    return 0.;
  if (p.walls.steps_and_relaxes())
    return 0.8;
  if (!p.is_specimen())
    return std::clamp(0.57 * (course.shortening / strain_at_peak - 0.9), 0.,
                      p.has("fractures") ? 0.3 : 0.8);
  return side_pressure(p) > 0. && !p.has("fractures") ? 0.55 : 0.3;
}

class Shares
{
public:
  Shares(const Parameters &p, const SectionGeometry &g, const Sizes &sizes,
         MachineSpeed &speed, const int threads, PredictedCost &cost)
      : p_(p)
      , g_(g)
      , sizes_(sizes)
      , speed_(speed)
      , grains_and_mesh_(sizes.grains + sizes.dofs / 3.)
      , speed_up_(speed_up(threads, grains_and_mesh_))
      , cost_(cost)
  {
  }

  void add_all()
  {
    add("start of the program", speed_.start_seconds());
    if (p_.layer.representation == "grains")
      add_packing();
    if (p_.run.driver == "buckling")
      add_buckling();
    else if (p_.run.driver == "static")
      add_static();
    else if (p_.follows_events())
      add_events();
    else
      add_steps();
  }

private:
  /// What one thread does.
  void add(const std::string &what, const double seconds, const double speed_up = 1.)
  {
    if (seconds > 0.)
      cost_.shares.push_back({what, seconds, seconds / speed_up});
  }
  void add_threaded(const std::string &what, const double seconds)
  {
    add(what, seconds, speed_up_);
  }

  double grain_step()
  {
    const double out_of_cache =
        std::clamp(std::log2(sizes_.grains / grains_in_cache), 0., 1.);
    return (1. + of_disorder * out_of_cache) * speed_.grain_step(sizes_.grains);
  }

  /// Of the grains: those of the layer alone, where the matrix may not break [-].
  double share_that_may_break() const
  {
    return p_.has("matrix") && !p_.matrix.breakable ? sizes_.layer_grains / sizes_.grains
                                                    : 1.;
  }

  void add_packing()
  {
    const double length = g_.length() / g_.diameter();
    const double work = sizes_.layer_grains * std::pow(length, 0.6) +
                        sizes_.tile_grains * std::pow(p_.matrix.tile_size, 0.6);
    add("packing, if it is not kept", of_packing * work * grain_step());
  }

  void add_record()
  {
    const double work = cost_.course.samples * of_sample +
                        cost_.course.field_files * of_field_file;
    add("record", grains_and_mesh_ * work *
                      (sizes_.grains > 0. ? grain_step()
                                          : speed_.dof_step(mesh_of(p_, sizes_))));
  }

  void add_steps()
  {
    const double steps = cost_.course.steps;
    if (sizes_.grains > 0.)
    {
      const double grains = steps * sizes_.grains * grain_step();
      add_threaded("bonds and motion", grains);
      add_threaded(
          "broken joints",
          share_of_broken_joints(p_, cost_.course, predict_strain_at_peak(p_, g_)) *
              share_that_may_break() * grains);
      if (discrete::has_contact_beside(p_.layer.law()))
        add_threaded("contacts", of_contact * grains);
      add_threaded("smooth joints",
                   steps * of_smooth_contact * smooth_contacts(p_, g_) * grain_step());
      add("walls and balance", of_walls * grains);
    }
    if (sizes_.dofs > 0.)
    {
      const double dof = speed_.dof_step(mesh_of(p_, sizes_));
      const double share = p_.is_bridged() ? 1. / p_.bridging.sub_cycles : 1.;
      add_threaded("mesh", share * of_mesh_step * steps * sizes_.dofs * dof);
      add("joining grains and mesh", of_multiplier * steps * sizes_.multipliers * dof);
      if (p_.has_surface_interface() && !p_.has_surface_tie())
        add("contact of grains and mesh",
            steps * of_face_contact * 2. * g_.length() / g_.diameter() * grain_step());
    }
    add_record();
  }

  void add_events()
  {
    add("events", of_events * std::pow(grains_and_mesh_, 1.5) * grain_step());
    add_threaded("collapse", of_collapse * cost_.course.collapse_steps *
                                 grains_and_mesh_ * grain_step());
    add_record();
  }

  void add_static()
  {
    const MeshShape mesh = mesh_of(p_, sizes_);
    if (!p_.is_nonlinear())
    {
      const SolvePace &pace = speed_.iterative_solve(mesh);
      add("assembly and preconditioner",
          sizes_.dofs * (pace.assembly + pace.factor));
      add("solutions", sizes_.dofs * cost_.course.solves * pace.solution);
      return;
    }
    const SolvePace &pace = speed_.direct_solve(mesh);
    add("Newton iterations",
        sizes_.dofs * cost_.course.solves *
            (of_newton * pace.assembly + pace.factor + pace.solution));
  }

  void add_buckling()
  {
    if (p_.layer.representation == "grains")
    {
      add("factors and modes", of_grain_solved * grains_and_mesh_ * grain_step());
      return;
    }
    const SolvePace &pace = speed_.direct_solve(mesh_of(p_, sizes_));
    const double growth = growth_by_refinement(p_), n = p_.matrix.refinement_rounds + 1.;
    // dofs are those of the last round.
    const double all = growth > 1. ? sizes_.dofs * (1. - std::pow(growth, -n)) /
                                         (1. - 1. / growth)
                                   : sizes_.dofs;
    add("assembly and factors", of_buckling * all * (pace.assembly + pace.factor));
    add("modes", all * of_mode * p_.run.modes * pace.solution);
  }

  const Parameters &p_;
  const SectionGeometry &g_;
  const Sizes &sizes_;
  MachineSpeed &speed_;
  double grains_and_mesh_; ///< three dofs of the mesh count as a grain
  double speed_up_;
  PredictedCost &cost_;
};
} // namespace

double PredictedCost::core_seconds() const
{
  double sum = 0.;
  for (const CostShare &share : shares)
    sum += share.core_seconds;
  return sum;
}

double PredictedCost::wall_seconds() const
{
  double sum = 0.;
  for (const CostShare &share : shares)
    sum += share.wall_seconds;
  return sum;
}

PredictedCost predict_cost(const Parameters &p,
                           const SectionGeometry &g,
                           const Sizes &sizes,
                           MachineSpeed &speed,
                           const int threads)
{
  PredictedCost cost;
  cost.course = predict_course(p, g);
  cost.memory = sizes.memory - program_memory + speed.program_memory();
  Shares(p, g, sizes, speed, threads, cost).add_all();
  return cost;
}
} // namespace antiform::cases
