#include "continuum/strip_contact.h"

#include "continuum/by_place.h"
#include "continuum/require.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
std::string text_of(const Point<2> &place)
{
  std::ostringstream text;
  text << "x = " << place[0] << " m, y = " << place[1] << " m";
  return text.str();
}

/// Throw the problem of the lowest rank that has one, on all of them.
void raise_together(const std::string &problem, const MPI_Comm communicator)
{
  for (const std::string &of_rank : Utilities::MPI::all_gather(communicator, problem))
    if (!of_rank.empty())
      throw std::invalid_argument("contact: " + of_rank);
}

/// By 90 degrees: of a tangent, the normal.
Tensor<1, 2> turned_left(const Tensor<1, 2> &v)
{
  return Tensor<1, 2>({-v[1], v[0]});
}
} // namespace

/// A face of an inner boundary, its nodes ascending in x.
class StripContact::Side
{
public:
  DofGroup dofs; ///< node by node, x then y
  std::vector<Point<2>> nodes;
  bool looks_up = false; ///< is of the lower side

  template <class Archive>
  void serialize(Archive &archive, unsigned int)
  {
    archive &dofs &nodes &looks_up;
  }

  double length() const { return nodes.front().distance(nodes.back()); }
  Point<2> middle() const { return 0.5 * (nodes.front() + nodes.back()); }

  bool is_at(const Side &other) const
  {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].distance(other.nodes[i]) > same_place * length())
        return false;
    return true;
  }

  /// Of the cells that this rank owns.
  static std::vector<Side> own(const DisplacementSpace &space,
                               const std::function<bool(const Point<2> &)> &is_included)
  {
    std::vector<Side> sides;
    for (const auto &cell : space.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) && cell->face(f)->boundary_id() == boundary::inner &&
              (!is_included || is_included(cell->face(f)->center())))
            sides.push_back(make(space, cell, f));
    return sides;
  }

private:
  static Side make(const DisplacementSpace &space,
                   const DoFHandler<2>::active_cell_iterator &cell,
                   const unsigned int f)
  {
    const auto &fe = space.fe();
    DofGroup dofs(fe.n_dofs_per_face());
    cell->face(f)->get_dof_indices(dofs);
    struct Node
    {
      Point<2> place;
      std::array<types::global_dof_index, 2> dofs;
    };
    std::vector<Node> nodes(dofs.size() / 2);
    for (unsigned int i = 0; i < dofs.size(); ++i)
    {
      const auto [component, shape] = fe.face_system_to_component_index(i, f);
      nodes[shape].dofs[component] = dofs[i];
      nodes[shape].place = space.support_point(dofs[i]);
    }
    std::sort(nodes.begin(), nodes.end(),
              [](const Node &a, const Node &b) { return a.place[0] < b.place[0]; });
    Side side;
    for (const Node &node : nodes)
    {
      side.dofs.insert(side.dofs.end(), node.dofs.begin(), node.dofs.end());
      side.nodes.push_back(node.place);
    }
    // The face looks up if the cell lies to the right of its tangent.
    const Tensor<1, 2> along = nodes.back().place - nodes.front().place;
    side.looks_up = turned_left(along) * (cell->center() - side.middle()) < 0.;
    return side;
  }
};

/// What opening, slip and their changes at a point are made of.
struct StripContact::Kinematics
{
  explicit Kinematics(const std::size_t n)
      : opening(n)
      , slip(n)
      , normal_part(n)
      , tangent_part(n)
      , turn(n)
      , stretch(n)
  {
  }

  /// \param s, ds shape functions and derivatives of the nodes of a side
  void set(const Pair &pair,
           const std::vector<double> &s,
           const std::vector<double> &ds,
           const Vector &displacement)
  {
    const std::size_t n_nodes = s.size();
    Tensor<1, 2> t = pair.along, g; // dx/ds of the middle surface; relative displacement
    for (std::size_t i = 0; i < pair.dofs.size(); ++i)
    {
      const std::size_t node = (i / 2) % n_nodes;
      const double u = displacement(pair.dofs[i]);
      t[i % 2] += 0.5 * ds[node] * u;
      g[i % 2] += (i < 2 * n_nodes ? -1. : 1.) * s[node] * u;
    }
    const double length = t.norm();
    tangent = t / length;
    normal = turned_left(tangent);
    gap = {g * normal, g * tangent};
    for (std::size_t i = 0; i < pair.dofs.size(); ++i)
    {
      const std::size_t node = (i / 2) % n_nodes, c = i % 2;
      const double side = (i < 2 * n_nodes ? -1. : 1.) * s[node];
      normal_part[i] = side * normal[c];
      tangent_part[i] = side * tangent[c];
      turn[i] = 0.5 * ds[node] * normal[c] / length;
      stretch[i] = 0.5 * ds[node] * tangent[c] / length;
      opening[i] = normal_part[i] - gap.slip * turn[i];
      slip[i] = tangent_part[i] + gap.opening * turn[i];
    }
  }

  /// Second derivatives of opening and slip to two dofs, contracted with the traction.
  double
  bend(const ContactTraction &traction, const std::size_t i, const std::size_t j) const
  {
    const double turns = turn[i] * turn[j],
                 mixed = stretch[i] * turn[j] + turn[i] * stretch[j];
    const double of_opening = gap.slip * mixed - gap.opening * turns -
                              turn[j] * tangent_part[i] - turn[i] * tangent_part[j];
    const double of_slip = turn[j] * normal_part[i] + turn[i] * normal_part[j] -
                           gap.slip * turns - gap.opening * mixed;
    return traction.normal * of_opening + traction.shear * of_slip;
  }

  Tensor<1, 2> normal, tangent; ///< of the middle surface now
  ContactGap gap;
  std::vector<double> opening, slip; ///< their derivatives to each dof [-]
  /// Of each dof: the part of the gap's change along normal and tangent; and how the
  /// middle surface turns and stretches [1/m].
  std::vector<double> normal_part, tangent_part, turn, stretch;
};

StripContact::StripContact(const DisplacementSpace &space,
                           const ContactLaw &law,
                           const Options &options)
    : space_(space)
    , law_(law)
{
  check(law);
  find_pairs(options);
  lay_out_points(options);
}

void StripContact::check(const ContactLaw &law) const
{
  const double normal = std::visit([](const auto &l) { return l.normal_stiffness; }, law);
  require(normal > 0., "contact: the normal stiffness", normal, "Pa/m", "> 0");
  if (const auto *frictional = std::get_if<FrictionalContact>(&law))
  {
    require(frictional->shear_stiffness > 0., "contact: the shear stiffness",
            frictional->shear_stiffness, "Pa/m", "> 0");
    require(frictional->tan_friction >= 0., "contact: the friction",
            frictional->tan_friction, "", ">= 0");
    require(frictional->cohesion >= 0., "contact: the cohesion", frictional->cohesion,
            "Pa", ">= 0");
  }
}

void StripContact::find_pairs(const Options &options)
{
  const MPI_Comm communicator = space_.dof_handler().get_communicator();
  const std::vector<Side> own = Side::own(space_, options.is_included);
  std::vector<Side> upper;
  std::size_t n_lower = 0;
  for (const auto &of_rank : Utilities::MPI::all_gather(communicator, own))
    for (const Side &side : of_rank)
      if (side.looks_up)
        ++n_lower;
      else
        upper.push_back(side);
  std::sort(upper.begin(), upper.end(),
            [](const Side &a, const Side &b) { return a.middle()[0] < b.middle()[0]; });

  std::string problem;
  if (n_lower != upper.size() || n_lower == 0)
    problem = std::to_string(n_lower) + " faces look up and " +
              std::to_string(upper.size()) +
              " down, but strips in touch have as many of both and some.";
  for (const Side &side : own)
    if (side.looks_up)
    {
      const double x = side.middle()[0] - same_place * side.length();
      auto partner = std::lower_bound(upper.begin(), upper.end(), x,
                                      [](const Side &other, const double value)
                                      { return other.middle()[0] < value; });
      while (partner != upper.end() && partner->middle()[0] < x + side.length() &&
             !partner->is_at(side))
        ++partner;
      if (partner == upper.end() || !partner->is_at(side))
      {
        problem = "the face at " + text_of(side.middle()) + " has no partner.";
        continue;
      }
      Pair pair{side.dofs, side.nodes.front(), side.nodes.back() - side.nodes.front()};
      pair.dofs.insert(pair.dofs.end(), partner->dofs.begin(), partner->dofs.end());
      pairs_.push_back(std::move(pair));
    }
  raise_together(problem, communicator);
}

void StripContact::lay_out_points(const Options &options)
{
  const unsigned int degree = space_.degree();
  const QGauss<1> points(options.points_per_face > 0 ? options.points_per_face
                                                     : degree + 3);
  const FE_Q<1> fe(degree);
  // deal.II lists the end nodes first; here they go along.
  std::vector<unsigned int> order{0};
  for (unsigned int i = 2; i <= degree; ++i)
    order.push_back(i);
  order.push_back(1);
  for (unsigned int q = 0; q < points.size(); ++q)
  {
    places_.push_back(points.point(q)[0]);
    weights_.push_back(points.weight(q));
    shape_.emplace_back();
    slope_.emplace_back();
    for (const unsigned int i : order)
    {
      shape_.back().push_back(fe.shape_value(i, points.point(q)));
      slope_.back().push_back(fe.shape_grad(i, points.point(q))[0]);
    }
  }

  slip_at_rest_.assign(pairs_.size() * places_.size(), 0.);
  next_slip_at_rest_ = slip_at_rest_;
  initial_.resize(slip_at_rest_.size());
  std::string problem;
  if (options.initial_traction)
    for (std::size_t i = 0; i < initial_.size(); ++i)
    {
      const Pair &pair = pairs_[i / places_.size()];
      const Point<2> place = pair.start + places_[i % places_.size()] * pair.along;
      const Tensor<1, 2> tangent = pair.along / pair.along.norm(),
                         normal = turned_left(tangent);
      const Tensor<1, 2> traction = options.initial_traction(place, normal);
      initial_[i] = {traction * normal, traction * tangent};
      // Stress fields balance to round-off.
      const double tolerance = 1e-9 * traction.norm();
      const ContactTraction carried = respond(ContactGap(), i).traction;
      if (std::abs(carried.normal - initial_[i].normal) > tolerance ||
          std::abs(carried.shear - initial_[i].shear) > tolerance)
        problem = "the law does not carry the initial traction at " + text_of(place) +
                  ", " + std::to_string(initial_[i].normal) + " Pa normal and " +
                  std::to_string(initial_[i].shear) + " Pa shear.";
    }
  raise_together(problem, space_.dof_handler().get_communicator());
}

bool StripContact::has_symmetric_tangent() const
{
  return !std::holds_alternative<FrictionalContact>(law_);
}

std::vector<DofGroup> StripContact::couplings() const
{
  std::vector<DofGroup> groups;
  for (const Pair &pair : pairs_)
    groups.push_back(pair.dofs);
  return groups;
}

ContactResponse StripContact::respond(const ContactGap &gap,
                                      const std::size_t point) const
{
  const ContactPoint at{gap, initial_[point], slip_at_rest_[point]};
  return std::visit([&](const auto &law) { return law.respond(at); }, law_);
}

void StripContact::add(const Vector &displacement,
                       Vector &internal_force,
                       TrilinosWrappers::SparseMatrix *tangent)
{
  const std::size_t n = 4 * (space_.degree() + 1), n_points = places_.size();
  Kinematics at(n);
  FullMatrix<double> K(n);
  std::vector<double> f(n);
  for (std::size_t p = 0; p < pairs_.size(); ++p)
  {
    const Pair &pair = pairs_[p];
    std::fill(f.begin(), f.end(), 0.);
    K = 0.;
    for (std::size_t q = 0; q < n_points; ++q)
    {
      at.set(pair, shape_[q], slope_[q], displacement);
      const ContactResponse response = respond(at.gap, p * n_points + q);
      next_slip_at_rest_[p * n_points + q] = response.slip_at_rest;
      if (response.phase == ContactPhase::open)
        continue;
      const double w = weights_[q] * pair.along.norm();
      const auto &[normal, shear] = response.traction;
      const auto &C = response.tangent;
      for (std::size_t i = 0; i < n; ++i)
      {
        f[i] += w * (normal * at.opening[i] + shear * at.slip[i]);
        const double along_opening = C[0][0] * at.opening[i] + C[1][0] * at.slip[i],
                     along_slip = C[0][1] * at.opening[i] + C[1][1] * at.slip[i];
        for (std::size_t j = 0; j < n; ++j)
          K(i, j) += w * (along_opening * at.opening[j] + along_slip * at.slip[j] +
                          at.bend(response.traction, i, j));
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      internal_force(pair.dofs[i]) += f[i];
    if (tangent)
      tangent->add(pair.dofs, K);
  }
}

std::vector<StripContact::PointState>
StripContact::point_states(const Vector &displacement) const
{
  Kinematics at(4 * (space_.degree() + 1));
  std::vector<PointState> states;
  for (const Pair &pair : pairs_)
    for (std::size_t q = 0; q < places_.size(); ++q)
    {
      at.set(pair, shape_[q], slope_[q], displacement);
      const ContactResponse response = respond(at.gap, states.size());
      states.push_back({pair.start + places_[q] * pair.along,
                        weights_[q] * pair.along.norm(), at.normal, at.gap,
                        response.traction, response.phase});
    }
  return states;
}

double StripContact::relative_slip(const Vector &displacement) const
{
  Kinematics at(4 * (space_.degree() + 1));
  double greatest = 0.;
  for (const Pair &pair : pairs_)
    for (std::size_t q = 0; q < places_.size(); ++q)
    {
      at.set(pair, shape_[q], slope_[q], displacement);
      greatest = std::max(greatest, std::abs(at.gap.slip) / pair.along.norm());
    }
  return Utilities::MPI::max(greatest, space_.dof_handler().get_communicator());
}
} // namespace antiform::continuum
