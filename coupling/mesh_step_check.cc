#include "coupling/mesh_step_check.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace antiform::coupling
{
MeshStepCheck::MeshStepCheck(MeshState &state,
                             const continuum::FiniteStrainSolid &solid,
                             const double damping_factor,
                             std::vector<double> extra_rows,
                             std::function<void()> on_stiff)
    : state_(state)
    , solid_(solid)
    , damping_factor_(damping_factor)
    , extra_rows_(std::move(extra_rows))
    , on_stiff_(std::move(on_stiff))
    , largest_travel_(travel_share * solid.smallest_edge())
    , looked_at_(solid.make_vector())
{
}

bool MeshStepCheck::has_moved() const
{
  double travel = 0.;
  for (std::size_t i = 0; i < looked_at_.locally_owned_size(); ++i)
    travel = std::max(travel,
                      std::abs(state_.displacement.begin()[i] - looked_at_.begin()[i]));
  return dealii::Utilities::MPI::max(travel, state_.communicator()) > largest_travel_;
}

void MeshStepCheck::run(const Stage, const Clock &clock)
{
  acted_ = clock.step % interval == 0 && (bound_ == 0. || has_moved());
  if (!acted_)
    return;
  looked_at_ = state_.displacement;
  const auto look = [&]
  {
    bound_ = damping_factor_ *
             solid_.stable_step(state_.displacement, state_.inverse_mass, extra_rows_);
  };
  look();
  if (clock.dt > bound_ && on_stiff_)
  {
    on_stiff_();
    look();
  }
  if (clock.dt > bound_)
    throw NumericalError("mesh",
                         "the mesh has stiffened as it was strained, and the step has "
                         "become unstable; give a smaller 'Run / Step safety', or end "
                         "the run earlier (Run / End shortening); step [s]",
                         clock.dt, bound_, clock.step);
}
} // namespace antiform::coupling
