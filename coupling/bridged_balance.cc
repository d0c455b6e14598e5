#include "coupling/bridged_balance.h"

#include "coupling/static_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace antiform::coupling
{
namespace
{
using discrete::Grains;
using discrete::Joints;

/// Sets of numbers that have been joined.
class Sets
{
public:
  explicit Sets(const std::size_t n)
      : parent_(n)
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::size_t root(std::size_t i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(const std::size_t a, const std::size_t b) { parent_[root(a)] = root(b); }

private:
  std::vector<std::size_t> parent_;
};

/// Springs at the stiffest grain of each part of the grains that joints hold together:
/// with the supports, if there are any, they leave it no motion as a rigid body.
std::vector<OperatorSpring> pins_of(const GrainState &state)
{
  const Grains &grains = state.grains;
  const Joints &joints = state.joints;
  Sets parts(grains.size());
  std::vector<double> stiffness(grains.size(), 0.);
  for (std::size_t j = 0; j < joints.size(); ++j)
  {
    parts.join(joints.first[j], joints.second[j]);
    for (const std::int32_t i : {joints.first[j], joints.second[j]})
      stiffness[i] += joint_stiffness(joints, j)[0];
  }
  std::vector<std::int32_t> stiffest(grains.size(), -1); // of the part with this root
  for (std::size_t i = 0; i < grains.size(); ++i)
  {
    std::int32_t &chosen = stiffest[parts.root(i)];
    if (stiffness[i] > 0. && (chosen < 0 || stiffness[i] > stiffness[chosen]))
      chosen = static_cast<std::int32_t>(i);
  }
  std::vector<OperatorSpring> pins;
  for (const std::int32_t i : stiffest)
    if (i >= 0)
    {
      const double r = grains.radius[i];
      pins.push_back({i, 0, stiffness[i]});
      pins.push_back({i, 1, stiffness[i]});
      pins.push_back({i, 2, stiffness[i] * r * r});
    }
  return pins;
}
} // namespace

BridgedBalance::BridgedBalance(GrainState &state,
                               std::vector<BearingWall> walls,
                               const std::vector<PrescribedMotion> &held,
                               MeshState &mesh,
                               BridgingDomain &domain)
    : grain_pins_(pins_of(state))
    , grains_(state, std::move(walls), held, grain_pins_)
    , mesh_(mesh)
    , domain_(domain)
{
  refuse_what_cannot_be();
  const Eigen::Index n =
      grains_.n_unknowns() + static_cast<Eigen::Index>(mesh.mass.locally_owned_size());
  levers_ = Eigen::VectorXd::Ones(n);
  levers_.head(grains_.n_unknowns()) = grains_.levers();
  is_prescribed_ = residual_ = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < grains_.n_unknowns(); ++i)
    is_prescribed_[i] = grains_.is_prescribed(i) ? 1. : 0.;
  for (const PrescribedDof &entry : mesh.prescribed)
  {
    is_prescribed_[unknown(entry.dof)] = 1.;
    double rate = 0.;
    if (entry.wall >= 0)
    {
      const BearingWall &bearing = grains_.walls()[static_cast<std::size_t>(entry.wall)];
      rate = bearing.rate * bearing.wall->normal.x;
    }
    mesh_rate_.push_back(rate);
  }
  scale_masses(); // the domain's factor refuses multipliers that depend on each other
  assemble_mesh();
  assemble();
}

void BridgedBalance::refuse_what_cannot_be()
{
  const auto refuse = [](const std::string &what) { throw std::invalid_argument(what); };
  for (const std::int32_t i : domain_.overlap_grains())
    for (const Eigen::Index c : {0, 1})
      if (grains_.is_prescribed(3 * i + c))
        refuse("grain " + std::to_string(i) +
               " of the overlap is held or has no joint, and cannot follow the mesh in "
               "the mean: tie it to the mesh or take it out");
  for (const BearingWall &bearing : grains_.walls())
    if (bearing.is_loaded)
      refuse("a wall of grains with a mesh goes with the load; one under a constant "
             "force is for grains alone");
}

void BridgedBalance::scale_masses()
{
  Grains &grains = grains_.state().grains;
  const Joints &joints = grains_.state().joints;
  const std::vector<double> &weight = domain_.grain_mass_weight();
  discrete::StiffnessSums sums = discrete::stiffness_sums(grains, joints, false);
  const std::vector<double> ground = grains_.ground_stiffness();
  for (std::size_t i = 0; i < ground.size(); ++i)
    sums.translation[i] += ground[i] / weight[i];
  const double step = common_step(grains, sums);
  discrete::scale_density(grains, sums, weight, step);
  mesh_.scale_density(
      domain_.mesh_mass(),
      domain_.ties().absolute_row_sums(grains, joints, mesh_.mass.locally_owned_size()),
      step);
  domain_.ties().hold(grains);
  domain_.factorise(grains, mesh_.inverse_mass);
}

void BridgedBalance::assemble_mesh()
{
  const auto n = static_cast<std::size_t>(n_mesh());
  const auto &stiffness = mesh_.solid.stiffness();
  const Eigen::VectorXd is_held = is_prescribed_.tail(n_mesh());
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(n_mesh()), right = rate, diagonal = rate;
  for (std::size_t k = 0; k < mesh_rate_.size(); ++k)
    rate[mesh_.prescribed[k].dof] = mesh_rate_[k];

  std::vector<Eigen::Triplet<double>> entries;
  Sets parts(n);
  for (unsigned int row = 0; row < n; ++row)
    for (auto it = stiffness.begin(row); it != stiffness.end(row); ++it)
    {
      const auto column = static_cast<unsigned int>(it->column());
      parts.join(row, column);
      if (row == column)
        diagonal[row] = it->value();
      if (is_held[row] > 0.)
        continue;
      if (is_held[column] > 0.)
        right[row] -= it->value() * rate[column];
      else if (row >= column)
        entries.emplace_back(row, column, it->value());
    }
  for (int i = 0; i < is_held.size(); ++i)
    if (is_held[i] > 0.)
      entries.emplace_back(i, i, 1.);

  // Two nodes of each part, the second the farthest from the first.
  std::vector<std::array<std::size_t, 2>> ends(n, {n, n});
  const auto place = [&](const std::size_t dof)
  { return mesh_.solid.support_point(dof); };
  for (std::size_t dof = 0; dof < n; ++dof)
  {
    auto &[first, second] = ends[parts.root(dof)];
    if (first == n)
      first = second = dof;
    else if (place(dof).distance(place(first)) > place(second).distance(place(first)))
      second = dof;
  }
  for (std::size_t dof = 0; dof < n; ++dof)
    for (const std::size_t end : ends[parts.root(dof)])
      if (is_held[dof] == 0. && place(dof).distance(place(end)) == 0. &&
          (mesh_pins_.empty() || mesh_pins_.back().unknown != unknown(dof)))
      {
        mesh_pins_.push_back({unknown(dof), diagonal[dof]});
        entries.emplace_back(dof, dof, diagonal[dof]);
      }

  Eigen::SparseMatrix<double> matrix(n_mesh(), n_mesh());
  matrix.setFromTriplets(entries.begin(), entries.end());
  mesh_factor_.emplace(matrix);
  mesh_tangent_ = mesh_factor_->solve(right) + rate;
}

/// Rows of the multipliers over the mean of their grains, x then y, and of tied grains.
Eigen::SparseMatrix<double, Eigen::RowMajor> BridgedBalance::constraint() const
{
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  const auto add = [&](const Eigen::Index column, const double value)
  { entries.emplace_back(row, static_cast<int>(column), value); };
  const SparseRows &of_grains = domain_.grain_rows(), &of_mesh = domain_.mesh_rows();
  for (const unsigned int c : {0u, 1u})
    for (std::size_t r = 0; r < of_grains.n_rows(); ++r, ++row)
    {
      const auto first = of_grains.value.begin() + of_grains.begin[r],
                 last = of_grains.value.begin() + of_grains.begin[r + 1];
      const double scale = 1. / std::accumulate(first, last, 0.);
      for (std::int32_t k = of_grains.begin[r]; k < of_grains.begin[r + 1]; ++k)
        add(3 * domain_.overlap_grains()[of_grains.column[k]] + c,
            scale * of_grains.value[k]);
      for (std::int32_t k = of_mesh.begin[r]; k < of_mesh.begin[r + 1]; ++k)
        add(unknown(domain_.node_dofs()[of_mesh.column[k]][c]), scale * of_mesh.value[k]);
    }
  for (const GrainTie &tie : domain_.ties().ties())
    for (const Eigen::Index c : {0, 1, 2})
    {
      if (grains_.is_prescribed(3 * tie.grain + c)) // without a joint: moves nothing
        continue;
      add(3 * tie.grain + c, 1.);
      for (const GrainTie::Node &node : tie.nodes)
        if (c < 2)
          add(unknown(c == 0 ? node.dof_x : node.dof_y), -node.value);
        else
        {
          add(unknown(node.dof_x), 0.5 * node.by_y);
          add(unknown(node.dof_y), -0.5 * node.by_x);
        }
      ++row;
    }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(row, n_unknowns());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void BridgedBalance::assemble()
{
  const auto solve_apart = [this](const Eigen::VectorXd &r)
  {
    Eigen::VectorXd x(n_unknowns());
    x.head(grains_.n_unknowns()) = grains_.solve(r.head(grains_.n_unknowns()));
    x.tail(n_mesh()) = mesh_factor_->solve(
        (is_prescribed_.tail(n_mesh()).array() > 0.).select(0., r.tail(n_mesh())));
    return x;
  };
  std::vector<ConstrainedInverse::Pin> pins = mesh_pins_;
  for (const OperatorSpring &pin : grain_pins_)
  {
    const Eigen::Index i = 3 * pin.grain + pin.component;
    if (!grains_.is_prescribed(i))
      pins.push_back({i, pin.stiffness});
  }
  inverse_.emplace(solve_apart, constraint(), pins,
                   [this](const Eigen::Index i) { return name(i); });
  Eigen::VectorXd apart(n_unknowns());
  apart << grains_.tangent(), mesh_tangent_;
  tangent_ = inverse_->complete(apart);
}

std::string BridgedBalance::name(const Eigen::Index unknown) const
{
  const auto of = [](const double x, const double y)
  { return " at (" + std::to_string(x) + ", " + std::to_string(y) + ") m"; };
  if (unknown < grains_.n_unknowns())
  {
    const auto i = static_cast<std::size_t>(unknown / 3);
    const Vec2 x = grains_.state().grains.reference(i);
    return "grain " + std::to_string(i) + of(x.x, x.y);
  }
  const auto x = mesh_.solid.support_point(
      static_cast<unsigned int>(unknown - grains_.n_unknowns()));
  return "the node" + of(x[0], x[1]);
}

void BridgedBalance::add_forces(const discrete::StepTime &now,
                                std::vector<discrete::Crack> *cracks,
                                const bool keep_forces)
{
  grains_.add_forces(now, cracks, keep_forces);
  add_mesh_forces();
}

void BridgedBalance::add_mesh_forces()
{
  Grains &grains = grains_.state().grains;
  mesh_.force = 0.;
  mesh_.solid.add_internal_force(mesh_.displacement, mesh_.force);
  domain_.ties().move_forces(grains, mesh_.force);
  domain_.constrain_forces(grains, mesh_.inverse_mass, grains.force_x, grains.force_y,
                           mesh_.force);
  for (PrescribedDof &entry : mesh_.prescribed)
  {
    entry.reaction = -mesh_.force.begin()[entry.dof];
    mesh_.force.begin()[entry.dof] = 0.;
  }
}

const Eigen::VectorXd &BridgedBalance::residual()
{
  residual_.head(grains_.n_unknowns()) = grains_.residual(); // walls as they are
  add_mesh_forces();
  const Grains &grains = grains_.state().grains;
  for (std::size_t i = 0; i < grains.size(); ++i)
    residual_.segment<3>(static_cast<Eigen::Index>(3 * i)) << grains.force_x[i],
        grains.force_y[i], grains.torque[i];
  residual_.tail(n_mesh()) =
      Eigen::Map<const Eigen::VectorXd>(mesh_.force.begin(), n_mesh());
  return residual_;
}

BalanceRatios BridgedBalance::ratios() const
{
  double sum = 0., largest = 0.;
  const auto n = static_cast<std::size_t>(n_mesh());
  for (std::size_t i = 0; i < n; ++i)
  {
    const double force = std::abs(mesh_.force.begin()[i]);
    sum += force;
    largest = std::max(largest, force);
  }
  const auto n_free = static_cast<double>(n - mesh_.prescribed.size());
  const BalanceRatios grains = grains_.ratios(),
                      mesh = grains_.over_joint_forces(sum / n_free, largest);
  return {std::max(grains.mean, mesh.mean), std::max(grains.largest, mesh.largest),
          std::max(grains.of_strength, mesh.of_strength)};
}

double BridgedBalance::conjugate_force() const
{
  double sum = grains_.conjugate_force();
  for (std::size_t k = 0; k < mesh_rate_.size(); ++k)
    sum += mesh_.prescribed[k].reaction * mesh_rate_[k];
  return sum;
}

void BridgedBalance::move(const Eigen::VectorXd &increment)
{
  grains_.move(increment.head(grains_.n_unknowns()));
  Eigen::Map<Eigen::VectorXd>(mesh_.displacement.begin(), n_mesh()) +=
      increment.tail(n_mesh());
  mesh_.displacement.update_ghost_values();
}

double BridgedBalance::load_work(const Eigen::VectorXd &increment) const
{
  return grains_.load_work(increment.head(grains_.n_unknowns()));
}

double BridgedBalance::deformation(const Eigen::VectorXd &increment,
                                   const double negligible) const
{
  return grains_.deformation(increment.head(grains_.n_unknowns()), negligible);
}

void BridgedBalance::add_energies(Energies &energies) const
{
  energies.strain_continuum += mesh_.solid.strain_energy(mesh_.displacement);
}

double BridgedBalance::gap() const
{
  return domain_.displacement_gap(grains_.state().grains, mesh_.displacement);
}

void BridgedBalance::find_contacts(const double reach, const std::vector<double> &modulus)
{
  if (grains_.find_contacts(reach, modulus))
    assemble();
}

void BridgedBalance::visit_state(StateArchive &archive)
{
  grains_.visit_state(archive);
  if (!archive.is_loading())
    return;
  domain_.factorise(grains_.state().grains, mesh_.inverse_mass); // as they were
  assemble();
}
} // namespace antiform::coupling
