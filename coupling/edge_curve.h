#pragma once

#include "continuum/displacement_space.h"
#include "discrete/vec2.h"

#include <deal.II/base/types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// The boundary of a mesh that faces grains: its faces with one boundary id, joined to a
/// chain that has the body on its left. Moves with the mesh. One rank; faces that are
/// straight in the reference mesh.
class EdgeCurve
{
public:
  /// A material point of the edge.
  struct Place
  {
    std::int32_t face = 0; ///< index along the chain
    double s = 0.;         ///< along the face, in [0, 1]
  };
  /// What a grain that is near sees of the edge.
  struct Nearest
  {
    Place place;
    Vec2 point;           ///< [m]
    Vec2 normal;          ///< unit, from there to the seeing point
    double distance = 0.; ///< [m]
    bool beyond = false;  ///< the chain ends there, the point lies past its end
  };
  /// Shape functions of a place over its nodes.
  struct Shape
  {
    unsigned int n = 0;                               ///< nodes of the face, 2 or 3
    std::array<std::array<std::uint32_t, 2>, 3> dofs; ///< x, y
    std::array<double, 3> value;                      ///< N_k [-]
    std::array<double, 3> slope;                      ///< dN_k/ds [-]
  };

  /// \param space must outlive the edge. Throws std::invalid_argument when no face has
  ///              the id, or the faces with it are not one open chain.
  EdgeCurve(const continuum::DisplacementSpace &space, dealii::types::boundary_id id);

  std::size_t n_faces() const { return faces_.size(); }
  double length() const { return begin_.back(); } ///< of the reference chain [m]
  /// Distance of a place from the chain's start, in the reference mesh [m].
  double distance_along(const Place &place) const
  {
    return begin_[place.face] + place.s * (begin_[place.face + 1] - begin_[place.face]);
  }
  /// The place at such a distance from the start; beyond the ends, these.
  Place place_at(double distance) const;
  /// Mean direction away from the body, in the reference mesh, unit.
  const Vec2 &outward() const { return outward_; }
  /// A point of each cell behind the faces, its material and its height over the face
  /// [m].
  struct Cell
  {
    dealii::types::material_id material;
    double height;
  };
  const std::vector<Cell> &cells() const { return cells_; }

  Shape shape(const Place &place) const;
  /// Dofs of the vertices at the start and the end of a face, with which shape() begins.
  const std::array<std::array<std::uint32_t, 2>, 3> &dofs(const std::int32_t face) const
  {
    return faces_[face].dofs;
  }
  /// Where a place is, @p displacement [m] by local dof; null: in the reference mesh.
  Vec2 point(const Place &place, const double *displacement) const;
  /// dx/ds there [m].
  Vec2 tangent(const Place &place, const double *displacement) const;

  /// The place nearest to @p from, of all the chain.
  Nearest nearest(const Vec2 &from, const double *displacement) const;
  /// The same by walking along the chain from @p hint, as long as it comes nearer.
  Nearest nearest(const Vec2 &from, const double *displacement, const Place &hint) const;

private:
  struct Face
  {
    std::array<std::array<std::uint32_t, 2>, 3> dofs; ///< start, end, middle (Q2)
    std::array<Vec2, 3> nodes;                        ///< their reference places [m]
  };
  void collect(const continuum::DisplacementSpace &space, dealii::types::boundary_id id);
  void chain_up(dealii::types::boundary_id id);
  std::array<Vec2, 3> nodes_now(std::int32_t face, const double *displacement) const;
  double
  nearest_on(std::int32_t face, const Vec2 &from, const double *displacement) const;
  Nearest seen(const Place &place, const Vec2 &from, const double *displacement) const;

  unsigned int n_nodes_; ///< of a face
  std::vector<Face> faces_;
  std::vector<Cell> cells_;
  std::vector<double> begin_; ///< of each face from the chain's start, and its end [m]
  Vec2 outward_;
};
} // namespace antiform::coupling
