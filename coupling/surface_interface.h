#pragma once

#include "continuum/contact_laws.h"
#include "continuum/elastic_solid.h"
#include "coupling/edge_curve.h"
#include "discrete/grains.h"
#include "discrete/joints.h"

#include <array>
#include <cstdint>
#include <vector>

namespace antiform::coupling
{
/// The outer grains of a layer on the side of @p towards, counter-clockwise: the part of
/// its outer ring (discrete::outer_ring) between the two corners, which are the grains
/// furthest out in the directions half way between @p towards and the layer's ends.
/// \param layer grains of the layer, one body; empty: all
/// \param reach of the ball that finds the ring, about a diameter [m]
std::vector<std::int32_t> outer_side(const discrete::Grains &grains,
                                     const std::vector<std::int32_t> &layer,
                                     double reach,
                                     const Vec2 &towards);

/// An outer grain and the place of the mesh's edge that faces it.
struct SurfacePoint
{
  std::int32_t grain = 0;
  EdgeCurve::Place place; ///< nearest to the grain's centre as the scene is built
  double length = 0.;     ///< of the reference edge that it stands for [m]
  double distance = 0.;   ///< of the centre from the edge, stress-free; < 0 behind it [m]
};

/// A layer's outer grains on the edge of a mesh, without overlap and without grains of
/// the matrix (docs/theory/surface_interface.md). What lies between grain and edge as the
/// scene is built, gap or overlap, is stress-free. The laws that join them are
/// SurfaceTie's and SurfaceContact's.
class SurfaceInterface
{
public:
  /// \param outer outer_side() of the layer, towards the mesh; grains that face no part
  ///              of the edge are left out
  /// \param edge  boundary id of the mesh's faces
  /// Throws std::invalid_argument when no grain faces the edge.
  SurfaceInterface(const discrete::Grains &grains,
                   const std::vector<std::int32_t> &outer,
                   const continuum::ElasticSolid &solid,
                   dealii::types::boundary_id edge);

  const EdgeCurve &edge() const { return edge_; }
  const std::vector<SurfacePoint> &points() const { return points_; }
  /// What the first and the last point stand for beyond their places: up to the end of
  /// the edge where no grain has room there, else up to the grain's own end [m].
  const std::array<double, 2> &margins() const { return margins_; }

private:
  EdgeCurve edge_;
  std::array<double, 2> margins_;
  std::vector<SurfacePoint> points_; ///< along the edge
};

/// Stiffnesses of a contact of grains and mesh: k_n = min(k_n of the softest joint of the
/// outer grains, @p ratio M / h), k_t likewise with the joints' shear stiffness and the
/// shear modulus; M = C_yy or C_xx, the larger, of the softest cell at the edge, h its
/// height. So a contact is not stiffer than a joint, and where the mesh is soft the
/// contact gives way by a share 1 / ratio of what a row of cells does.
continuum::ContactStiffness surface_stiffness(const SurfaceInterface &interface,
                                              const discrete::Joints &joints,
                                              const continuum::ElasticSolid &solid,
                                              double ratio = 10.);
} // namespace antiform::coupling
