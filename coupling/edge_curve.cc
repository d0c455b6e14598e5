#include "coupling/edge_curve.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace antiform::coupling
{
using namespace dealii;

namespace
{
struct LineShape
{
  std::array<double, 3> value, slope;
};

/// Lagrange functions of the nodes at 0, 1 and, with three of them, 1/2.
LineShape line_shape(const unsigned int n_nodes, const double s)
{
  if (n_nodes == 2)
    return {{1. - s, s, 0.}, {-1., 1., 0.}};
  return {{(1. - s) * (1. - 2. * s), s * (2. * s - 1.), 4. * s * (1. - s)},
          {4. * s - 3., 4. * s - 1., 4. - 8. * s}};
}

/// Functions of nodes that a face has not are zero, and so are these nodes.
Vec2 sum_of(const std::array<double, 3> &factors, const std::array<Vec2, 3> &nodes)
{
  return factors[0] * nodes[0] + factors[1] * nodes[1] + factors[2] * nodes[2];
}
} // namespace

EdgeCurve::EdgeCurve(const continuum::DisplacementSpace &space,
                     const types::boundary_id id)
    : n_nodes_(space.degree() + 1)
{
  collect(space, id);
  chain_up(id);
  begin_.assign(1, 0.);
  Vec2 sum;
  for (const Face &face : faces_)
  {
    const Vec2 along = face.nodes[1] - face.nodes[0];
    begin_.push_back(begin_.back() + norm(along));
    sum += -perpendicular(along);
  }
  outward_ = (1. / norm(sum)) * sum;
}

void EdgeCurve::collect(const continuum::DisplacementSpace &space,
                        const types::boundary_id id)
{
  const auto &fe = space.fe();
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_face());
  for (const auto &cell : space.dof_handler().active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
    {
      if (!cell->at_boundary(f) || cell->face(f)->boundary_id() != id)
        continue;
      cell->face(f)->get_dof_indices(dofs);
      Face face;
      for (unsigned int i = 0; i < dofs.size(); ++i)
      {
        const auto [component, node] = fe.face_system_to_component_index(i, f);
        face.dofs[node][component] = static_cast<std::uint32_t>(dofs[i]);
        const Point<2> p = space.support_point(dofs[i]);
        face.nodes[node] = {p[0], p[1]};
      }
      const Vec2 along = face.nodes[1] - face.nodes[0];
      const Point<2> centre = cell->center();
      if (cross(along, Vec2{centre[0], centre[1]} - face.nodes[0]) < 0.)
      {
        std::swap(face.dofs[0], face.dofs[1]);
        std::swap(face.nodes[0], face.nodes[1]);
      }
      faces_.push_back(face);
      cells_.push_back({cell->material_id(), cell->measure() / norm(along)});
    }
}

void EdgeCurve::chain_up(const types::boundary_id id)
{
  const auto refuse = [id](const std::string &what)
  {
    throw std::invalid_argument("the edge of boundary id " + std::to_string(id) + ' ' +
                                what + '.');
  };
  if (faces_.empty())
    refuse("has no face");
  std::map<std::uint32_t, std::size_t> starts_at; // face by its first x dof
  for (std::size_t f = 0; f < faces_.size(); ++f)
    starts_at[faces_[f].dofs[0][0]] = f;
  std::vector<bool> follows(faces_.size(), false);
  for (const Face &face : faces_)
    if (const auto next = starts_at.find(face.dofs[1][0]); next != starts_at.end())
      follows[next->second] = true;
  const auto first = std::find(follows.begin(), follows.end(), false);
  if (first == follows.end())
    refuse("is closed: it has no end");
  std::vector<Face> faces;
  std::vector<Cell> cells;
  auto f = static_cast<std::size_t>(first - follows.begin());
  while (true)
  {
    faces.push_back(faces_[f]);
    cells.push_back(cells_[f]);
    const auto next = starts_at.find(faces_[f].dofs[1][0]);
    if (next == starts_at.end())
      break;
    f = next->second;
  }
  if (faces.size() != faces_.size())
    refuse("is not one chain of faces: " + std::to_string(faces.size()) + " of " +
           std::to_string(faces_.size()) + " hang together");
  faces_ = std::move(faces);
  cells_ = std::move(cells);
}

EdgeCurve::Place EdgeCurve::place_at(const double distance) const
{
  const auto after = std::upper_bound(begin_.begin() + 1, begin_.end() - 1, distance);
  const auto face = static_cast<std::int32_t>(after - begin_.begin() - 1);
  return {face, std::clamp((distance - begin_[face]) / (begin_[face + 1] - begin_[face]),
                           0., 1.)};
}

EdgeCurve::Shape EdgeCurve::shape(const Place &place) const
{
  const LineShape line = line_shape(n_nodes_, place.s);
  return {n_nodes_, faces_[place.face].dofs, line.value, line.slope};
}

std::array<Vec2, 3> EdgeCurve::nodes_now(const std::int32_t face,
                                         const double *const displacement) const
{
  std::array<Vec2, 3> nodes = faces_[face].nodes;
  if (displacement != nullptr)
    for (unsigned int k = 0; k < n_nodes_; ++k)
      nodes[k] += Vec2{displacement[faces_[face].dofs[k][0]],
                       displacement[faces_[face].dofs[k][1]]};
  return nodes;
}

Vec2 EdgeCurve::point(const Place &place, const double *const displacement) const
{
  return sum_of(line_shape(n_nodes_, place.s).value, nodes_now(place.face, displacement));
}

Vec2 EdgeCurve::tangent(const Place &place, const double *const displacement) const
{
  return sum_of(line_shape(n_nodes_, place.s).slope, nodes_now(place.face, displacement));
}

/// Nearest point of one face, s in [0, 1]: on the chord, and from there on the parabola
/// of a Q2 face by Newton's method; its bend is small against a grain's distance.
double EdgeCurve::nearest_on(const std::int32_t face,
                             const Vec2 &from,
                             const double *const displacement) const
{
  const std::array<Vec2, 3> nodes = nodes_now(face, displacement);
  const Vec2 chord = nodes[1] - nodes[0];
  double s = std::clamp(dot(from - nodes[0], chord) / dot(chord, chord), 0., 1.);
  if (n_nodes_ == 2)
    return s;
  const Vec2 bend = 4. * (nodes[0] + nodes[1] + -2. * nodes[2]); // d^2x/ds^2
  for (int pass = 0; pass < 20; ++pass)
  {
    const Vec2 away = point({face, s}, displacement) - from,
               along = tangent({face, s}, displacement);
    const double next =
        std::clamp(s - dot(away, along) / (dot(along, along) + dot(away, bend)), 0., 1.);
    const double change = std::abs(next - s);
    s = next;
    if (change < 1e-15)
      break;
  }
  return s;
}

EdgeCurve::Nearest EdgeCurve::seen(const Place &place,
                                   const Vec2 &from,
                                   const double *const displacement) const
{
  Nearest result;
  result.place = place;
  result.point = point(place, displacement);
  const Vec2 away = from - result.point;
  result.distance = norm(away);
  result.normal = (1. / result.distance) * away;
  // At an end of the chain the nearest point is also the foot of the normal, or the
  // seeing point lies past it by more than round-off.
  const bool at_start = place.face == 0 && place.s == 0.,
             at_end =
                 place.face + 1 == static_cast<std::int32_t>(n_faces()) && place.s == 1.;
  if (at_start || at_end)
  {
    const Vec2 along = tangent(place, displacement);
    const double past = dot(away, along) / norm(along);
    result.beyond = (at_start ? -past : past) > 1e-9 * result.distance;
  }
  return result;
}

EdgeCurve::Nearest EdgeCurve::nearest(const Vec2 &from,
                                      const double *const displacement) const
{
  Nearest best;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(n_faces()); ++f)
  {
    const Nearest here = seen({f, nearest_on(f, from, displacement)}, from, displacement);
    if (f == 0 || here.distance < best.distance)
      best = here;
  }
  return best;
}

EdgeCurve::Nearest EdgeCurve::nearest(const Vec2 &from,
                                      const double *const displacement,
                                      const Place &hint) const
{
  const auto on = [&](const std::int32_t f) {
    return seen({f, nearest_on(f, from, displacement)}, from, displacement);
  };
  Nearest best = on(hint.face);
  for (const std::int32_t direction : {-1, 1})
    for (std::int32_t f = best.place.face + direction;
         f >= 0 && f < static_cast<std::int32_t>(n_faces()); f += direction)
    {
      const Nearest here = on(f);
      if (here.distance >= best.distance)
        break;
      best = here;
    }
  return best;
}
} // namespace antiform::coupling
