#include "coupling/surface_contact.h"

#include "continuum/errors.h"
#include "continuum/require.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace antiform::coupling
{
using continuum::ContactPhase;
using continuum::require;

namespace
{
/// The normal turned by -90 degrees, as the laws have it.
Vec2 tangent_of(const Vec2 &normal)
{
  return {normal.y, -normal.x};
}
} // namespace

SurfaceContact::SurfaceContact(SurfaceInterface interface,
                               const continuum::ContactLaw &law,
                               const InitialTraction &initial)
    : interface_(std::move(interface))
    , law_(law)
    , normal_stiffness_(std::visit([](const auto &l) { return l.normal_stiffness; }, law))
{
  require(normal_stiffness_ > 0., "surface interface: the normal stiffness",
          normal_stiffness_, "Pa/m", "> 0");
  if (const auto *frictional = std::get_if<continuum::FrictionalContact>(&law))
  {
    shear_stiffness_ = frictional->shear_stiffness;
    require(shear_stiffness_ > 0., "surface interface: the shear stiffness",
            shear_stiffness_, "Pa/m", "> 0");
    require(frictional->tan_friction >= 0., "surface interface: the friction",
            frictional->tan_friction, "", ">= 0");
    require(frictional->cohesion >= 0., "surface interface: the cohesion",
            frictional->cohesion, "Pa", ">= 0");
  }
  for (const SurfacePoint &point : interface_.points())
  {
    const Vec2 along = interface_.edge().tangent(point.place, nullptr);
    const Vec2 normal = (-1. / norm(along)) * perpendicular(along);
    require(point.distance > 0.,
            "surface interface: the distance of a grain's centre from the edge",
            point.distance, "m",
            "> 0 where they are in contact: move the edge out of the layer");
    State state;
    state.place = point.place;
    state.normal = normal;
    states_.push_back(state);
    initial_.emplace_back();
    if (initial)
    {
      const Vec2 traction =
          initial(interface_.edge().point(point.place, nullptr), normal);
      initial_.back() = {dot(traction, normal), dot(traction, tangent_of(normal))};
    }
    respond(states_.size() - 1);
    const continuum::ContactTraction &carried = states_.back().traction;
    // Stress fields balance to round-off.
    const double tolerance =
        1e-9 * std::hypot(initial_.back().normal, initial_.back().shear);
    if (std::abs(carried.normal - initial_.back().normal) > tolerance ||
        std::abs(carried.shear - initial_.back().shear) > tolerance)
      throw std::invalid_argument("surface interface: the law does not carry the initial "
                                  "traction, " +
                                  std::to_string(initial_.back().normal) +
                                  " Pa normal and " +
                                  std::to_string(initial_.back().shear) + " Pa shear.");
  }
}

/// Traction from the gap, and the new slip at rest.
void SurfaceContact::respond(const std::size_t point)
{
  State &state = states_[point];
  const continuum::ContactPoint at{state.gap, initial_[point], state.slip_at_rest};
  const continuum::ContactResponse response =
      std::visit([&](const auto &law) { return law.respond(at); }, law_);
  state.traction = response.traction;
  state.phase = response.phase;
  if (shear_stiffness_ > 0.) // the other laws leave slip alone
    state.slip_at_rest = response.slip_at_rest;
}

/// Way of the grain's material at the edge over the edge's in a step that began with the
/// state @p before: along the tangent and with the arm between then and now, so that
/// finite rigid rotations make none.
double SurfaceContact::slip_increment(const discrete::Grains &grains,
                                      const std::size_t point,
                                      const State &before,
                                      const double *const velocity,
                                      const double dt) const
{
  const State &now = states_[point];
  const SurfacePoint &at = interface_.points()[point];
  const EdgeCurve::Shape shape = interface_.edge().shape(now.place);
  Vec2 of_edge;
  for (unsigned int k = 0; k < shape.n; ++k)
    of_edge +=
        shape.value[k] * Vec2{velocity[shape.dofs[k][0]], velocity[shape.dofs[k][1]]};
  const Vec2 sum = before.normal + now.normal;
  const Vec2 normal = (1. / norm(sum)) * sum;
  const double distance = at.distance + 0.5 * (before.gap.opening + now.gap.opening);
  const Vec2 of_grain = grains.velocity(at.grain) -
                        grains.spin[at.grain] * distance * perpendicular(normal);
  return dt * dot(of_grain - of_edge, tangent_of(normal));
}

void SurfaceContact::add_forces(discrete::Grains &grains,
                                const continuum::Vector &displacement,
                                const continuum::Vector &mesh_velocity,
                                const double dt,
                                continuum::Vector &mesh_force)
{
  const double *const u = displacement.begin();
  for (std::size_t p = 0; p < states_.size(); ++p)
  {
    State &state = states_[p];
    const SurfacePoint &point = interface_.points()[p];
    const EdgeCurve::Nearest seen =
        interface_.edge().nearest(grains.position(point.grain), u, state.place);
    const State before = state;
    if (dot(before.normal, seen.normal) < 0.)
      throw NumericalError("surface interface",
                           "a grain has gone through the mesh's edge: take a stiffer "
                           "contact; its opening over its distance",
                           state.gap.opening / point.distance, -1.);
    state.place = seen.place;
    state.normal = seen.normal;
    state.gap.opening = seen.distance - point.distance;
    if (shear_stiffness_ > 0. && dt > 0.)
      state.gap.slip += slip_increment(grains, p, before, mesh_velocity.begin(), dt);
    respond(p);
    state.dissipated += 0.5 * point.length *
                        (before.traction.shear + state.traction.shear) *
                        (state.slip_at_rest - before.slip_at_rest);
    if (state.phase == ContactPhase::open)
      continue;
    const Vec2 on_mesh = point.length * (state.traction.normal * seen.normal +
                                         state.traction.shear * tangent_of(seen.normal));
    grains.force_x[point.grain] -= on_mesh.x;
    grains.force_y[point.grain] -= on_mesh.y;
    grains.torque[point.grain] -=
        cross(seen.point - grains.position(point.grain), on_mesh);
    const EdgeCurve::Shape shape = interface_.edge().shape(seen.place);
    for (unsigned int k = 0; k < shape.n; ++k)
    {
      mesh_force.begin()[shape.dofs[k][0]] += shape.value[k] * on_mesh.x;
      mesh_force.begin()[shape.dofs[k][1]] += shape.value[k] * on_mesh.y;
    }
  }
}

double SurfaceContact::elastic_energy() const
{
  double energy = 0.;
  for (std::size_t p = 0; p < states_.size(); ++p)
  {
    const auto grown = [](const double now, const double before, const double stiffness)
    { return stiffness > 0. ? 0.5 * (now * now - before * before) / stiffness : 0.; };
    energy += interface_.points()[p].length *
              (grown(states_[p].traction.normal, initial_[p].normal, normal_stiffness_) +
               grown(states_[p].traction.shear, initial_[p].shear, shear_stiffness_));
  }
  return energy;
}

double SurfaceContact::slip_energy() const
{
  double energy = 0.;
  for (const State &state : states_)
    energy += state.dissipated;
  return energy;
}

SurfaceContact::Springs SurfaceContact::springs(const std::size_t point) const
{
  const SurfacePoint &at = interface_.points()[point];
  const State &state = states_[point];
  const Vec2 tangent = tangent_of(state.normal);
  const double arm = at.distance + state.gap.opening; // from the edge to the centre
  Springs springs;
  springs.normal.grains = {{at.grain, 0, state.normal.x}, {at.grain, 1, state.normal.y}};
  springs.tangential.grains = {{at.grain, 0, tangent.x},
                               {at.grain, 1, tangent.y},
                               {at.grain, 2, cross(-arm * state.normal, tangent)}};
  const EdgeCurve::Shape shape = interface_.edge().shape(state.place);
  for (unsigned int k = 0; k < shape.n; ++k)
    for (const unsigned int c : {0u, 1u})
    {
      const double N = shape.value[k];
      springs.normal.mesh.push_back(
          {shape.dofs[k][c], -N * (c == 0 ? state.normal.x : state.normal.y)});
      springs.tangential.mesh.push_back(
          {shape.dofs[k][c], -N * (c == 0 ? tangent.x : tangent.y)});
    }
  return springs;
}

void SurfaceContact::add_to(StaticSystem &system) const
{
  for (std::size_t p = 0; p < states_.size(); ++p)
  {
    const Springs form = springs(p);
    const double length = interface_.points()[p].length;
    system.add_spring(form.normal, length * normal_stiffness_);
    if (shear_stiffness_ > 0.)
      system.add_spring(form.tangential, length * shear_stiffness_);
  }
}

double SurfaceContact::node_stiffness(const std::size_t point) const
{
  return 2. * interface_.points()[point].length * (normal_stiffness_ + shear_stiffness_);
}

void SurfaceContact::add_stiffness(discrete::StiffnessSums &grain_sums,
                                   std::vector<double> &mesh_row_sums) const
{
  for (std::size_t p = 0; p < states_.size(); ++p)
  {
    const SurfacePoint &point = interface_.points()[p];
    const double lever = point.distance;
    grain_sums.translation[point.grain] +=
        point.length * (normal_stiffness_ + shear_stiffness_);
    grain_sums.rotation[point.grain] += point.length * shear_stiffness_ * lever * lever;
    const EdgeCurve::Shape shape = interface_.edge().shape(states_[p].place);
    for (unsigned int k = 0; k < shape.n; ++k)
      for (const std::uint32_t dof : shape.dofs[k])
        mesh_row_sums[dof] += std::abs(shape.value[k]) * node_stiffness(p);
  }
}

double SurfaceContact::square_of_frequency(const std::size_t point,
                                           const discrete::Grains &grains,
                                           const discrete::StiffnessSums &grain_sums,
                                           const continuum::Vector &inverse_mass,
                                           const std::vector<double> &row_sums) const
{
  const SurfacePoint &at = interface_.points()[point];
  const std::array<double, 2> k{at.length * normal_stiffness_,
                                at.length * shear_stiffness_};
  // Inverse of the inertia that the contact's share of stiffness gives it.
  const double in_translation =
      grain_sums.translation[at.grain] * grains.inverse_mass[at.grain] / (k[0] + k[1]);
  const double in_rotation = k[1] > 0. ? grain_sums.rotation[at.grain] *
                                             grains.inverse_inertia[at.grain] /
                                             (k[1] * at.distance * at.distance)
                                       : 0.;
  const EdgeCurve::Shape shape = interface_.edge().shape(states_[point].place);
  const Vec2 n = states_[point].normal, t = tangent_of(n);
  // The two springs as one element: the larger eigenvalue of sqrt(k_a k_b) r_a Mi r_b.
  double nn = in_translation,
         tt = in_translation + in_rotation * at.distance * at.distance, nt = 0.;
  for (unsigned int m = 0; m < shape.n; ++m)
  {
    const double N = std::abs(shape.value[m]);
    if (N == 0.)
      continue;
    const auto inverse = [&](const unsigned int c)
    {
      const std::uint32_t dof = shape.dofs[m][c];
      return N * row_sums[dof] * inverse_mass(dof) / node_stiffness(point); // N^2 / N
    };
    const double x = inverse(0), y = inverse(1);
    nn += n.x * n.x * x + n.y * n.y * y;
    tt += t.x * t.x * x + t.y * t.y * y;
    nt += n.x * t.x * x + n.y * t.y * y;
  }
  const double a = k[0] * nn, b = k[1] * tt, c2 = k[0] * k[1] * nt * nt;
  return 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + c2);
}

double surface_stable_step(const discrete::Grains &grains,
                           const discrete::Joints &joints,
                           const continuum::ElasticSolid &solid,
                           const continuum::Vector &inverse_mass,
                           const std::vector<const SurfaceContact *> &contacts)
{
  const discrete::StiffnessSums of_joints = stiffness_sums(grains, joints, true);
  const continuum::Vector of_cells = solid.absolute_row_sums();
  discrete::StiffnessSums grain_sums = of_joints;
  const std::size_t n_dofs = inverse_mass.locally_owned_size();
  std::vector<double> row_sums(of_cells.begin(), of_cells.begin() + n_dofs);
  for (const SurfaceContact *contact : contacts)
    contact->add_stiffness(grain_sums, row_sums);

  discrete::Grains for_joints = grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    if (of_joints.translation[i] > 0.)
      for_joints.inverse_mass[i] *= grain_sums.translation[i] / of_joints.translation[i];
    if (of_joints.rotation[i] > 0.)
      for_joints.inverse_inertia[i] *= grain_sums.rotation[i] / of_joints.rotation[i];
  }
  continuum::Vector for_cells = inverse_mass;
  for (std::size_t d = 0; d < n_dofs; ++d)
    for_cells.begin()[d] *= row_sums[d] / of_cells.begin()[d];
  double largest = 0.;
  for (const SurfaceContact *contact : contacts)
    for (std::size_t p = 0; p < contact->states().size(); ++p)
      largest = std::max(largest, contact->square_of_frequency(p, grains, grain_sums,
                                                               inverse_mass, row_sums));
  return std::min({discrete::stable_step(for_joints, joints),
                   solid.stable_step(for_cells), 2. / std::sqrt(largest)});
}
} // namespace antiform::coupling
