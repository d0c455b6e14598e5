#include "coupling/absorbing_component.h"

#include "coupling/bridging_domain.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <stdexcept>

namespace antiform::coupling
{
AbsorbingBoundary::AbsorbingBoundary(MeshState &state,
                                     std::vector<continuum::NodalDashpot> dashpots,
                                     const BridgingDomain *const domain)
    : state_(state)
{
  std::vector<bool> is_bridged(state.mass.locally_owned_size(), false);
  if (domain != nullptr)
    for (const auto &dofs : domain->node_dofs())
      is_bridged[dofs[0]] = true;
  double n_bridged = 0.;
  for (const continuum::NodalDashpot &dashpot : dashpots)
  {
    n_bridged += is_bridged[dashpot.dof_x] ? 1. : 0.;
    nodes_.push_back({dashpot});
  }
  n_bridged = dealii::Utilities::MPI::sum(n_bridged, state.communicator());
  if (n_bridged > 0.)
    throw std::invalid_argument(
        "absorbing boundary: " + std::to_string(static_cast<int>(n_bridged)) +
        " of its nodes lie in the bridging domain; put it on faces outside.");
}

void AbsorbingBoundary::run(const Stage stage, const Clock &clock)
{
  const double *const v = state_.velocity.begin();
  for (Node &node : nodes_)
    switch (stage)
    {
    case Stage::damp:
      node.velocity_x = v[node.dashpot.dof_x];
      node.velocity_y = v[node.dashpot.dof_y];
      break;
    case Stage::kick:
      correct(node, clock.dt);
      energy_ -= 0.5 * clock.dt *
                 (node.force_x * node.velocity_x + node.force_y * node.velocity_y);
      break;
    case Stage::drift:
      energy_ -=
          0.5 * clock.dt *
          (node.force_x * v[node.dashpot.dof_x] + node.force_y * v[node.dashpot.dof_y]);
      break;
    default:
      throw std::logic_error("the absorbing boundary does nothing at this stage");
    }
}

void AbsorbingBoundary::correct(Node &node, const double dt)
{
  const auto &[x, y, c_xx, c_xy, c_yy] = node.dashpot;
  double *const v = state_.velocity.begin();
  // v+ = v* + dt M^-1 F, F = -C (v- + v+) / 2, with v* as it is without dashpots: so
  // (1 + A) (v* - v+) = A (v- + v*) with A = dt/2 M^-1 C, which is 0 where M^-1 is.
  const double scale_x = 0.5 * dt * state_.inverse_mass.begin()[x],
               scale_y = 0.5 * dt * state_.inverse_mass.begin()[y];
  const double sum_x = node.velocity_x + v[x], sum_y = node.velocity_y + v[y];
  const double right_x = scale_x * (c_xx * sum_x + c_xy * sum_y),
               right_y = scale_y * (c_xy * sum_x + c_yy * sum_y);
  const double a_xx = 1. + scale_x * c_xx, a_xy = scale_x * c_xy, a_yx = scale_y * c_xy,
               a_yy = 1. + scale_y * c_yy;
  const double determinant = a_xx * a_yy - a_xy * a_yx;
  v[x] -= (a_yy * right_x - a_xy * right_y) / determinant;
  v[y] -= (a_xx * right_y - a_yx * right_x) / determinant;

  const double mean_x = 0.5 * (node.velocity_x + v[x]),
               mean_y = 0.5 * (node.velocity_y + v[y]);
  node.force_x = -(c_xx * mean_x + c_xy * mean_y);
  node.force_y = -(c_xy * mean_x + c_yy * mean_y);
  state_.force.begin()[x] += node.force_x; // supports bear it
  state_.force.begin()[y] += node.force_y;
}

void AbsorbingBoundary::visit_state(StateArchive &archive)
{
  archive.owned_value("absorbing_boundary/energy", energy_);
}
} // namespace antiform::coupling
