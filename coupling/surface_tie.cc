#include "coupling/surface_tie.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace antiform::coupling
{
namespace
{
/// A vertex has a multiplier when the layer covers more than this share of its function:
/// those beyond the layer's ends have none.
constexpr double smallest_share = 0.1;

/// What the grains demand of a vertex, in one direction.
struct Row
{
  double length = 0.; ///< of the edge, weighted by the vertex' function [m]
  std::map<std::pair<std::int32_t, unsigned int>, double> grains;
  std::map<std::uint32_t, double> mesh;

  LinearForm form() const
  {
    LinearForm form;
    for (const auto &[unknown, value] : grains)
      if (value != 0.)
        form.grains.push_back({unknown.first, unknown.second, value / length});
    for (const auto &[dof, value] : mesh)
      if (value != 0.)
        form.mesh.push_back({dof, value / length});
    return form;
  }
};

struct Vertex
{
  double hat = 0.; ///< integral of its function over the edge [m]
  Vec2 place;
  std::array<std::uint32_t, 2> dofs{};
  std::array<Row, 2> rows;
};

/// A Gauss point of the edge, and the grains between which it lies with their shares.
struct Sample
{
  EdgeCurve::Place place;
  double length; ///< of the edge that it stands for [m]
  std::array<std::pair<std::int32_t, double>, 2> grains;
};

/// Grains by their places along the edge.
using Chain = std::vector<std::pair<double, std::int32_t>>;

/// The grains between which a place lies and their linear functions there. Beyond the
/// last one these go on with a grain at least as far inward as the layer reaches outward,
/// so that a share is not above 2: even stretch along the edge must leave no gap there.
std::array<std::pair<std::int32_t, double>, 2> shares(const Chain &grains,
                                                      const double at)
{
  auto right = std::lower_bound(grains.begin(), grains.end(), std::pair(at, -1));
  auto left = right;
  if (right == grains.begin())
    while (right + 1 != grains.end() && right->first - left->first < left->first - at)
      ++right;
  else if (right == grains.end())
    for (left = --right;
         left != grains.begin() && right->first - left->first < at - right->first;)
      --left;
  else
    --left;
  const double span = right->first - left->first;
  const double share = span > 0. ? (at - left->first) / span : 0.;
  return {std::pair(left->second, 1. - share), std::pair(right->second, share)};
}

/// Between nodes and grains, where all functions are polynomials: exact.
std::vector<Sample> samples(const SurfaceInterface &interface,
                            const std::vector<EdgeCurve::Place> &places)
{
  const EdgeCurve &edge = interface.edge();
  Chain grains;
  for (std::size_t k = 0; k < places.size(); ++k)
    grains.emplace_back(edge.distance_along(places[k]), interface.points()[k].grain);
  std::sort(grains.begin(), grains.end());
  const auto [begin, end] = interface.margins();
  std::vector<double> cuts{std::max(0., grains.front().first - begin),
                           std::min(edge.length(), grains.back().first + end)};
  for (const auto &[at, grain] : grains)
    cuts.push_back(at);
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(edge.n_faces()); ++f)
    if (const double at = edge.distance_along({f, 1.}); at > cuts[0] && at < cuts[1])
      cuts.push_back(at);
  std::sort(cuts.begin(), cuts.end());

  std::vector<Sample> all;
  const std::array<double, 3> nodes{0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)},
      weights{5. / 18., 8. / 18., 5. / 18.};
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
    for (unsigned int q = 0; q < nodes.size(); ++q)
    {
      const double length = cuts[k + 1] - cuts[k], at = cuts[k] + nodes[q] * length;
      if (length <= 0.)
        continue;
      all.push_back({edge.place_at(at), weights[q] * length, shares(grains, at)});
    }
  return all;
}
} // namespace

SurfaceTie::SurfaceTie(const discrete::Grains &grains,
                       std::vector<SurfaceInterface> interfaces,
                       const Kind kind,
                       std::vector<std::uint32_t> shared)
    : kind_(kind)
    , shared_(std::move(shared))
    , interfaces_(std::move(interfaces))
{
  std::sort(shared_.begin(), shared_.end());
  for (const SurfaceInterface &interface : interfaces_)
  {
    places_.emplace_back();
    for (const SurfacePoint &point : interface.points())
      places_.back().push_back(point.place);
  }
  discrete::Grains reference = grains;
  for (auto *field : {&reference.displacement_x, &reference.displacement_y})
    std::fill(field->begin(), field->end(), 0.);
  build_rows(reference, nullptr);
}

void SurfaceTie::follow(const discrete::Grains &grains,
                        const continuum::Vector &displacement)
{
  if (kind_ == Kind::sliding)
    for (std::size_t n = 0; n < interfaces_.size(); ++n)
      for (std::size_t k = 0; k < places_[n].size(); ++k)
        places_[n][k] = interfaces_[n]
                            .edge()
                            .nearest(grains.position(interfaces_[n].points()[k].grain),
                                     displacement.begin(), places_[n][k])
                            .place;
  build_rows(grains, displacement.begin());
  solver_.reset();
}

void SurfaceTie::build_rows(const discrete::Grains &grains, const double *displacement)
{
  rows_.clear();
  row_names_.clear();
  for (std::size_t n = 0; n < interfaces_.size(); ++n)
    build_rows(interfaces_[n], places_[n], grains, displacement);
  number_unknowns();
}

void SurfaceTie::number_unknowns()
{
  tied_grains_.clear();
  tied_dofs_.clear();
  for (const LinearForm &row : rows_)
  {
    for (const LinearForm::GrainTerm &term : row.grains)
      tied_grains_.push_back(term.grain);
    for (const LinearForm::MeshTerm &term : row.mesh)
      tied_dofs_.push_back(term.dof);
  }
  const auto make_unique = [](auto &list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  make_unique(tied_grains_);
  make_unique(tied_dofs_);
  const auto index = [](const auto &list, const auto value)
  { return std::lower_bound(list.begin(), list.end(), value) - list.begin(); };
  const auto n_grain_unknowns = static_cast<Eigen::Index>(3 * tied_grains_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rows_.size(); ++r)
  {
    for (const LinearForm::GrainTerm &term : rows_[r].grains)
      entries.emplace_back(
          static_cast<int>(r),
          static_cast<int>(3 * index(tied_grains_, term.grain) + term.component),
          term.value);
    for (const LinearForm::MeshTerm &term : rows_[r].mesh)
      entries.emplace_back(
          static_cast<int>(r),
          static_cast<int>(n_grain_unknowns + index(tied_dofs_, term.dof)), term.value);
  }
  matrix_.resize(static_cast<Eigen::Index>(rows_.size()),
                 n_grain_unknowns + static_cast<Eigen::Index>(tied_dofs_.size()));
  matrix_.setFromTriplets(entries.begin(), entries.end());
  impulse_ = Eigen::VectorXd::Zero(matrix_.cols());
}

void SurfaceTie::build_rows(const SurfaceInterface &interface,
                            const std::vector<EdgeCurve::Place> &places,
                            const discrete::Grains &grains,
                            const double *const displacement)
{
  const EdgeCurve &edge = interface.edge();
  std::map<std::uint32_t, Vertex> vertices; // by x dof: a fixed order
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(edge.n_faces()); ++f)
    for (const unsigned int end : {0u, 1u})
    {
      Vertex &vertex = vertices[edge.dofs(f)[end][0]];
      vertex.dofs = edge.dofs(f)[end];
      vertex.hat += 0.5 * (edge.distance_along({f, 1.}) - edge.distance_along({f, 0.}));
      vertex.place = edge.point({f, static_cast<double>(end)}, nullptr);
    }

  const unsigned int n_directions = kind_ == Kind::cemented ? 2 : 1;
  for (const Sample &sample : samples(interface, places))
  {
    const EdgeCurve::Shape shape = edge.shape(sample.place);
    const Vec2 point = edge.point(sample.place, displacement),
               along = edge.tangent(sample.place, displacement);
    const std::array<Vec2, 2> directions =
        kind_ == Kind::cemented
            ? std::array<Vec2, 2>{Vec2{1., 0.}, Vec2{0., 1.}}
            : std::array<Vec2, 2>{(-1. / norm(along)) * perpendicular(along), Vec2{}};
    for (const unsigned int end : {0u, 1u})
      for (unsigned int c = 0; c < n_directions; ++c)
      {
        const double hat = end == 0 ? 1. - sample.place.s : sample.place.s;
        const double weight = sample.length * hat;
        const Vec2 &direction = directions[c];
        Row &row = vertices[shape.dofs[end][0]].rows[c];
        row.length += weight;
        for (const auto &[i, share] : sample.grains)
        {
          const double w = weight * share;
          row.grains[{i, 0}] += w * direction.x;
          row.grains[{i, 1}] += w * direction.y;
          row.grains[{i, 2}] += w * cross(point - grains.position(i), direction);
        }
        for (unsigned int m = 0; m < shape.n; ++m)
        {
          row.mesh[shape.dofs[m][0]] -= weight * shape.value[m] * direction.x;
          row.mesh[shape.dofs[m][1]] -= weight * shape.value[m] * direction.y;
        }
      }
  }

  for (const auto &[dof, vertex] : vertices)
    for (unsigned int c = 0; c < n_directions; ++c)
    {
      const Row &row = vertex.rows[c];
      if (row.length <= smallest_share * vertex.hat ||
          (kind_ == Kind::cemented &&
           std::binary_search(shared_.begin(), shared_.end(), vertex.dofs[c])))
        continue;
      rows_.push_back(row.form());
      row_names_.push_back("vertex (" + std::to_string(vertex.place.x) + " m, " +
                           std::to_string(vertex.place.y) + " m) of the edge");
    }
}

void SurfaceTie::visit_state(StateArchive &archive, const std::string &name)
{
  std::vector<std::int64_t> face, term_of_row, unknown;
  std::vector<double> along, value;
  for (const auto &places : places_)
    for (const EdgeCurve::Place &place : places)
    {
      face.push_back(place.face);
      along.push_back(place.s);
    }
  for (const LinearForm &row : rows_)
  {
    term_of_row.push_back(static_cast<std::int64_t>(row.grains.size()));
    term_of_row.push_back(static_cast<std::int64_t>(row.mesh.size()));
    for (const LinearForm::GrainTerm &term : row.grains)
    {
      unknown.push_back(3 * std::int64_t(term.grain) + term.component);
      value.push_back(term.value);
    }
    for (const LinearForm::MeshTerm &term : row.mesh)
    {
      unknown.push_back(term.dof);
      value.push_back(term.value);
    }
  }
  if (archive.is_loading())
    for (auto *list : {&term_of_row, &unknown})
      list->clear(); // as many as the file has: rows change as grains slide
  if (archive.is_loading())
    value.clear();
  archive.array(name + "/face", face);
  archive.array(name + "/along_face", along);
  archive.array(name + "/terms_of_rows", term_of_row);
  archive.array(name + "/unknowns", unknown);
  archive.array(name + "/values", value);
  if (!archive.is_loading())
    return;
  std::size_t k = 0;
  for (auto &places : places_)
    for (EdgeCurve::Place &place : places)
    {
      place = {static_cast<std::int32_t>(face[k]), along[k]};
      ++k;
    }
  rows_.assign(term_of_row.size() / 2, {});
  k = 0;
  for (std::size_t r = 0; r < rows_.size(); ++r)
  {
    for (std::int64_t n = 0; n < term_of_row[2 * r]; ++n, ++k)
      rows_[r].grains.push_back({static_cast<std::int32_t>(unknown[k] / 3),
                                 static_cast<unsigned int>(unknown[k] % 3), value[k]});
    for (std::int64_t n = 0; n < term_of_row[2 * r + 1]; ++n, ++k)
      rows_[r].mesh.push_back({static_cast<std::uint32_t>(unknown[k]), value[k]});
  }
  row_names_.assign(rows_.size(), "a vertex of the edge");
  number_unknowns();
  solver_.reset();
}

void SurfaceTie::add_to(StaticSystem &system) const
{
  for (const LinearForm &row : rows_)
    system.add_constraint(row);
}

Eigen::VectorXd SurfaceTie::gather(const std::vector<double> &x,
                                   const std::vector<double> &y,
                                   const std::vector<double> &rotation,
                                   const double *const mesh) const
{
  Eigen::VectorXd field(matrix_.cols());
  Eigen::Index u = 0;
  for (const std::int32_t i : tied_grains_)
    for (const auto *values : {&x, &y, &rotation})
      field[u++] = (*values)[i];
  for (const std::uint32_t dof : tied_dofs_)
    field[u++] = mesh[dof];
  return field;
}

void SurfaceTie::factorise(const discrete::Grains &grains,
                           const continuum::Vector &inverse_mass)
{
  inverse_mass_ = gather(grains.inverse_mass, grains.inverse_mass, grains.inverse_inertia,
                         inverse_mass.begin());
  const Matrix product = matrix_ * inverse_mass_.asDiagonal() *
                         Eigen::SparseMatrix<double>(matrix_.transpose());
  solver_.emplace(Eigen::SparseMatrix<double>(product),
                  [this](const Eigen::Index row) { return row_names_[row]; });
}

bool SurfaceTie::is_factorised_for(const discrete::Grains &grains) const
{
  if (!solver_)
    return false;
  Eigen::Index u = 0;
  for (const std::int32_t i : tied_grains_)
  {
    if (inverse_mass_[u] != grains.inverse_mass[i] ||
        inverse_mass_[u + 2] != grains.inverse_inertia[i])
      return false;
    u += 3;
  }
  return true;
}

std::vector<double> SurfaceTie::multipliers(const Eigen::VectorXd &field) const
{
  const Eigen::VectorXd right = matrix_ * field;
  std::vector<double> L(right.data(), right.data() + right.size());
  solver_->solve(L);
  return L;
}

void SurfaceTie::project(discrete::Grains &grains, continuum::Vector &velocity)
{
  const std::vector<double> L = multipliers(
      gather(grains.velocity_x, grains.velocity_y, grains.spin, velocity.begin()));
  impulse_ =
      matrix_.transpose() * Eigen::Map<const Eigen::VectorXd>(L.data(), matrix_.rows());
  Eigen::Index u = 0;
  for (const std::int32_t i : tied_grains_)
    for (auto *values : {&grains.velocity_x, &grains.velocity_y, &grains.spin})
    {
      (*values)[i] -= inverse_mass_[u] * impulse_[u];
      ++u;
    }
  for (const std::uint32_t dof : tied_dofs_)
  {
    velocity.begin()[dof] -= inverse_mass_[u] * impulse_[u];
    ++u;
  }
}

void SurfaceTie::for_mesh_impulses(
    const std::function<void(std::uint32_t, double)> &action) const
{
  auto u = static_cast<Eigen::Index>(3 * tied_grains_.size());
  for (const std::uint32_t dof : tied_dofs_)
    action(dof, impulse_[u++]);
}

void SurfaceTie::constrain_forces(discrete::Grains &grains,
                                  continuum::Vector &mesh_force) const
{
  const Eigen::VectorXd force =
      gather(grains.force_x, grains.force_y, grains.torque, mesh_force.begin());
  const std::vector<double> L = multipliers(inverse_mass_.cwiseProduct(force));
  const Eigen::VectorXd of_constraint =
      matrix_.transpose() * Eigen::Map<const Eigen::VectorXd>(L.data(), matrix_.rows());
  Eigen::Index u = 0;
  for (const std::int32_t i : tied_grains_)
    for (auto *values : {&grains.force_x, &grains.force_y, &grains.torque})
      (*values)[i] -= of_constraint[u++];
  for (const std::uint32_t dof : tied_dofs_)
    mesh_force.begin()[dof] -= of_constraint[u++];
}

double SurfaceTie::displacement_gap(const discrete::Grains &grains,
                                    const continuum::Vector &displacement) const
{
  const Eigen::VectorXd gap =
      matrix_ * gather(grains.displacement_x, grains.displacement_y, grains.rotation,
                       displacement.begin());
  return gap.cwiseAbs().maxCoeff();
}
} // namespace antiform::coupling
