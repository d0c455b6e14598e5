#pragma once
// A stiff layer of lattice grains in a soft matrix, one wavelength between two walls:
// all of it grains, or grains around the layer and mesh beyond. Slow shortening with
// damping. Unit of length is the grain diameter, of stress the layer's modulus E*.
#include "continuum/finite_strain_solid.h"
#include "coupling/mesh_step_check.h"
#include "support/coupling_loop.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

namespace antiform::coupling::test
{
enum class FoldMatrix
{
  grains,
  linear_mesh,
  neo_hookean_mesh,
  semi_linear_mesh
};

/// Heights in rows of the lattice, of sqrt(3)/2, above the middle of the layer.
struct FoldShape
{
  double contrast = 50.; ///< of the moduli of layer and matrix
  int length = 66;       ///< between the walls: the wavelength [d]
  int layer = 3;         ///< half the layer
  int core = 8;          ///< layer and buffer: grains alone
  int overlap = 10;      ///< its width: four cells
  int surface = 38;
  double amplitude = 0.15; ///< of the layer as it is laid down, free of stress [d]
  double row_height = 0.5 * std::sqrt(3.);
  double cell_height() const { return 2.5 * row_height; }
  double wave_number() const { return 2. * M_PI / length; }
  /// By how much grains are shifted upward: the layer in full, the rim of the core not
  /// at all, so that grains and mesh beyond it are regular in every model.
  double shift(const Vec2 &x) const
  {
    const double height = std::abs(x.y) / row_height;
    const double share =
        std::clamp((core - height) / static_cast<double>(core - layer), 0., 1.);
    return share * share * (3. - 2. * share) * amplitude *
           std::cos(wave_number() * (x.x + 0.5));
  }
};

/// What a fold looks like at a moment.
struct FoldState
{
  double shortening = 0.; ///< of the section between the walls [-]
  double amplitude = 0.;  ///< of the layer's first harmonic [d]
  double dip = 0.;        ///< of the steepest 4 d of the layer [degrees]
  double force = 0.;      ///< of the walls on the section
  double ledger = 0.;     ///< error of the energy balance over the largest energy [-]
  double unbalanced = 0.; ///< ratio
};

class Fold
{
public:
  /// \param n_steps of the loop per millistrain of shortening
  Fold(const FoldShape &shape, const FoldMatrix matrix, const double n_steps);

  /// Shorten until @p done, which is asked at every sample (a tenth of a millistrain).
  void shorten(const std::function<bool(const FoldState &)> &done);
  const std::vector<FoldState> &history() const { return history_; }
  std::size_t n_grains() const { return model_.state.grains.size(); }
  std::size_t n_mesh_dofs() const { return model_.solid ? model_.n_mesh_dofs() : 0; }
  Bridged &model() { return model_; }
  /// Grains with their centre on a wall, which do not turn.
  const std::vector<std::int32_t> &on_plane() const { return on_plane_; }
  /// Amplitude and dip as the grains are now; nothing else.
  FoldState shape_now() const;
  /// Largest rotation of a cell [degrees]; of the mesh of finite strain.
  double largest_mesh_rotation() const;

private:
  bool is_finite() const
  {
    return matrix_ == FoldMatrix::neo_hookean_mesh ||
           matrix_ == FoldMatrix::semi_linear_mesh;
  }
  void make_grains(bool all);
  void make_mesh();
  void scale_masses(double n_steps);
  void make_loop();
  FoldState look() const;

  FoldShape shape_;
  FoldMatrix matrix_;
  Bridged model_;
  std::vector<std::int32_t> on_plane_; ///< grains with their centre on a wall
  double dt_ = 0., speed_ = 0.;
  std::int64_t sample_interval_ = 0;
  std::unique_ptr<Simulation> simulation_;
  ConstrainedForces *constrained_ = nullptr;
  Walls *walls_ = nullptr;
  std::vector<FoldState> history_;
};

inline Fold::Fold(const FoldShape &shape, const FoldMatrix matrix, const double n_steps)
    : shape_(shape)
    , matrix_(matrix)
{
  make_grains(matrix == FoldMatrix::grains);
  model_.finite_strain = is_finite();
  if (matrix == FoldMatrix::neo_hookean_mesh)
    model_.form = continuum::FiniteElasticity::neo_hookean;
  if (matrix != FoldMatrix::grains)
    make_mesh();
  scale_masses(n_steps);
  make_loop();
}

inline void Fold::make_grains(const bool all)
{
  const double rows = all ? shape_.surface : shape_.core + shape_.overlap;
  const double top = (rows - 0.4) * shape_.row_height;
  const discrete::Grains flat =
      hexagonal_lattice({-0.5, shape_.length - 0.5, -top, top},
                        {0., 0.5 * shape_.row_height}, [](const Vec2 &) { return true; });
  discrete::Grains &grains = model_.state.grains;
  for (std::size_t i = 0; i < flat.size(); ++i)
  {
    const Vec2 x = flat.reference(i);
    const int region = std::abs(x.y) < shape_.layer * shape_.row_height ? 0 : 1;
    grains.add({x.x, x.y + shape_.shift(x)}, 0.5, 1., region);
  }
  const FlatJoint law = elastic_law();
  const std::vector<double> modulus{1., 1. / shape_.contrast};
  discrete::Joints &joints = model_.state.joints;
  for (const auto &[a, b, name] :
       {std::tuple{0, 0, "layer"}, std::tuple{0, 1, "interface"},
        std::tuple{1, 1, "matrix"}})
  {
    joints.begin_group(law, a, name);
    for (const auto &[i, j] : discrete::pairs_within(grains, 0.1, a, b))
      joints.add(grains, i, j, modulus[grains.region[i]], modulus[grains.region[j]]);
  }
  joints.finish(grains.size());
  model_.state.breaking = false;

  for (const double side : {-1., 1.})
  {
    discrete::Wall wall;
    wall.point = {side < 0. ? -0.5 : shape_.length - 0.5, 0.};
    wall.normal = {-side, 0.};
    // Planes of symmetry of an endless lattice: every other row ends half a spacing
    // before the wall, on springs of that length, the rows between with a grain on it.
    discrete::install_wall_contacts(grains, wall, 0.1, 0.1, modulus);
    for (discrete::WallContact &contact : wall.contacts)
      if (contact.reference_gap < -0.25)
      {
        contact.stiffness *= 10.;
        on_plane_.push_back(contact.grain);
      }
    model_.walls.push_back(wall);
  }
}

inline void Fold::make_mesh()
{
  const double core = shape_.core * shape_.row_height,
               top = shape_.surface * shape_.row_height;
  model_.weight.distance_to_core = [core](const Vec2 &x)
  { return std::max(0., std::abs(x.y) - core); };
  // The outermost grains stand half a row below the rim.
  model_.weight.width = shape_.overlap * shape_.row_height;
  model_.weight.cubic = true; // four cells
  const auto n = static_cast<int>(std::lround((top - core) / shape_.cell_height()));
  std::vector<double> y = lines(-top, -core, n);
  const std::vector<double> upper = lines(core, top, n);
  y.insert(y.end(), upper.begin(), upper.end());
  make_cells(model_.triangulation, lines(-0.5, shape_.length - 0.5, shape_.length / 2), y,
             [core](const Vec2 &centre) { return std::abs(centre.y) > core; });
  const FlatJoint law = elastic_law();
  continuum::ElasticMaterial material = lattice_material(law);
  for (auto &row : material.stiffness)
    for (double &c : row)
      c /= shape_.contrast;
  model_.join_bonded(material, 2. * shape_.cell_height());
  for (discrete::Wall &wall : model_.walls)
    for (discrete::WallContact &contact : wall.contacts)
      contact.weight = model_.weight.grains(model_.state.grains.reference(contact.grain));
  for (unsigned int dof = 0; dof < model_.n_mesh_dofs(); dof += 2)
  {
    const double x = model_.mesh_place(dof).x;
    if (x < -0.5 + 1e-9)
      model_.mesh->prescribe(dof, 0);
    else if (x > shape_.length - 0.5 - 1e-9)
      model_.mesh->prescribe(dof, 1);
  }
}

/// Grains and mesh get the matrix's step: layer and matrix then move about one grain in a
/// step alike.
inline void Fold::scale_masses(const double n_steps)
{
  discrete::Grains &grains = model_.state.grains;
  discrete::StiffnessSums sums =
      discrete::stiffness_sums(grains, model_.state.joints, false);
  std::vector<double> ground(grains.size(), 0.);
  for (const discrete::Wall &wall : model_.walls)
    for (const discrete::WallContact &contact : wall.contacts)
    {
      sums.translation[contact.grain] += contact.stiffness;
      ground[contact.grain] += contact.stiffness * contact.weight;
    }
  double dt0 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (grains.region[i] == 1)
      dt0 = std::min(dt0, std::sqrt(grains.mass[i] / sums.translation[i]));
  const std::vector<double> weight =
      model_.domain ? model_.domain->grain_mass_weight() : std::vector<double>();
  discrete::scale_density(grains, sums, weight, dt0);
  for (const std::int32_t i : on_plane_)
    grains.inverse_inertia[i] = 0.; // no rotation
  double step = discrete::stable_step(grains, model_.state.joints, ground);
  if (model_.solid)
  {
    model_.mesh->scale_density(model_.domain->mesh_mass(), {}, step);
    step = std::min(step, model_.mesh_step());
    model_.factorise();
  }
  constexpr double safety = 0.8, damping_factor = 0.766965; // 1 / sqrt(1.7)
  dt_ = safety * damping_factor * step;
  speed_ = 0.5 * 1e-3 * shape_.length / (n_steps * dt_); // of each wall
  sample_interval_ = std::max<std::int64_t>(1, std::lround(0.1 * n_steps));
}

inline void Fold::make_loop()
{
  GrainState &grains = model_.state;
  MeshState *const mesh = model_.mesh ? &*model_.mesh : nullptr;
  BridgingDomain *const domain = model_.domain.get();
  simulation_ = std::make_unique<Simulation>(dt_);
  const auto add = [&](auto component, const std::vector<Stage> &stages, const int rank,
                       const std::string &name) -> auto &
  {
    return simulation_->add(std::move(component), stages, rank, name, "fold");
  };
  add(std::make_unique<Bonds>(grains), {Stage::forces}, 20, "bonds");
  constrained_ = &add(std::make_unique<ConstrainedForces>(&grains, mesh, domain, false),
                      {Stage::damp}, 95, "unbalanced force");
  auto &damping = add(std::make_unique<LocalDamping>(&grains, mesh, 0.7, true),
                      {Stage::damp, Stage::kick}, 96, "damping");
  const double speed = speed_, ramp = 20. * static_cast<double>(sample_interval_) * dt_;
  const auto wall_speed = [speed, ramp](const double t)
  { return t > ramp ? speed : 0.5 * speed * (1. - std::cos(M_PI * t / ramp)); };
  walls_ = &add(std::make_unique<Walls>(model_.walls, &grains, mesh, domain, wall_speed),
                {Stage::forces, Stage::react, Stage::drift}, 40, "walls");
  add(std::make_unique<GrainMotion>(grains), {Stage::kick, Stage::drift}, 50, "grains")
      .damped = true;
  if (mesh != nullptr)
  {
    add(std::make_unique<MeshMotion>(*mesh, model_.walls),
        {Stage::forces, Stage::kick, Stage::drift}, 5, "mesh")
        .damping = damping.mesh_forces();
    add(std::make_unique<Bridging>(*domain, grains, *mesh), {Stage::constrain}, 0,
        "bridging domain");
  }
  if (is_finite())
    add(std::make_unique<MeshStepCheck>(
            *mesh, dynamic_cast<continuum::FiniteStrainSolid &>(*model_.solid), 0.766965),
        {Stage::forces}, 6, "mesh step");
  add(std::make_unique<Probe>([this](const Clock &) { history_.push_back(look()); }),
      {Stage::sample}, 0, "probe");
  simulation_->set_sampler([this](const Clock &clock)
                           { return clock.step % sample_interval_ == 0; });
}

inline FoldState Fold::shape_now() const
{
  const discrete::Grains &g = model_.state.grains;
  FoldState state;
  double product = 0., square = 0., height = 0., cosine = 0., n = 0.;
  std::vector<double> rotation(shape_.length / 4 + 1, 0.), count(rotation.size(), 0.);
  for (std::size_t i = 0; i < g.size(); ++i)
  {
    if (g.region[i] != 0)
      continue;
    const double X = g.reference_x[i] + 0.5, c = std::cos(shape_.wave_number() * X);
    const double y = g.reference_y[i] + g.displacement_y[i];
    product += c * y;
    square += c * c;
    height += y;
    cosine += c;
    n += 1.;
    const auto bin = static_cast<std::size_t>(X / 4.);
    rotation[bin] += g.rotation[i] + std::atan(-shape_.wave_number() * shape_.amplitude *
                                               std::sin(shape_.wave_number() * X));
    count[bin] += 1.;
  }
  state.amplitude =
      (product - height * cosine / n) / (square - cosine * cosine / n); // least squares
  for (std::size_t bin = 0; bin < rotation.size(); ++bin)
    if (count[bin] > 0.)
      state.dip = std::max(state.dip, std::abs(rotation[bin] / count[bin]) * 180. / M_PI);
  return state;
}

inline FoldState Fold::look() const
{
  FoldState state = shape_now();
  state.shortening = walls_->closure() / shape_.length;
  state.force = walls_->grain_reaction(0) + walls_->grain_reaction(1) +
                (model_.mesh ? walls_->mesh_reaction() : 0.);
  const Energies e = simulation_->energies();
  double largest = 0.;
  for (const double term : {e.boundary_work, e.strain_grains, e.strain_continuum})
    largest = std::max(largest, std::abs(term));
  if (largest > 0.)
    state.ledger = (e.stored_and_spent() - e.boundary_work) / largest;
  state.unbalanced = constrained_->unbalanced_ratio();
  return state;
}

inline void Fold::shorten(const std::function<bool(const FoldState &)> &done)
{
  while (history_.empty() || !done(history_.back()))
    for (std::int64_t i = 0; i < sample_interval_; ++i)
      simulation_->step();
}

inline double Fold::largest_mesh_rotation() const
{
  double largest = 0.;
  for (const auto &cell : model_.solid->cell_states(model_.mesh->displacement))
    largest = std::max(largest, std::abs(cell.rotation));
  return largest * 180. / M_PI;
}
} // namespace antiform::coupling::test
