#pragma once

#include "discrete/disk_pairs.h"
#include "discrete/polygon_edges.h"

#include <cstdint>
#include <vector>

namespace antiform::discrete
{
/// What holds the disks in: either the periods of a tile or the edges of a polygon.
struct Confinement
{
  Vec2 period;                         ///< {0, 0}: not periodic
  const PolygonEdges *edges = nullptr; ///< null: periodic
};

/// State of the contacts of frictionless disks with unit stiffness.
struct ContactState
{
  double mean_overlap = 0.;     ///< over overlapping pairs of disks
  double largest_overlap = 0.;  ///< pairs and edges
  double unbalanced_ratio = 0.; ///< mean force on a disk over mean contact force
  std::size_t touching = 0;     ///< overlapping pairs
};

/// Overlap energy of disks, sum of overlap^2 / 2 over pairs and edges, and its
/// minimisation by FIRE (Bitzek et al. 2006; integration of Guenole et al. 2020). Serial:
/// the sums have one order. Lengths in units of the mean diameter.
class Relaxation
{
public:
  Relaxation(std::vector<Disk> disks, const Confinement &confinement);

  const std::vector<Disk> &disks() const { return disks_; }
  const Confinement &confinement() const { return confinement_; }
  void replace(std::vector<Disk> disks);
  /// Multiply all radii by @p factor.
  void scale(double factor);
  /// Move the disks until the unbalanced ratio is at most @p tolerance, or the mean
  /// overlap falls below @p parted: disks that are not jammed lose their contacts, and
  /// ever slower. Throws PackingError when neither comes about.
  ContactState relax(double tolerance, double parted);
  /// Contacts of the disks as they are.
  ContactState state();
  std::size_t steps() const { return steps_; } ///< taken so far

private:
  void find_neighbours();
  /// Sets force_ and the sums of the contacts; unbalanced_ratio is left alone.
  ContactState add_forces();
  double unbalanced_ratio() const;
  /// Move by velocity_ times @p dt; no disk further than the step limit.
  void drift(double dt);

  std::vector<Disk> disks_;
  Confinement confinement_;
  std::vector<Vec2> velocity_, force_;
  std::vector<DiskPair> pairs_;
  std::vector<std::int32_t> edge_disk_;  ///< disks near an edge
  std::vector<std::int32_t> edge_begin_; ///< into near_edges_, per entry of edge_disk_
  std::vector<std::int32_t> near_edges_;
  std::vector<EdgeContact> contacts_;
  double skin_ = 0.;            ///< reach of the lists beyond contact
  std::size_t last_search_ = 0; ///< step of the last search
  double travelled_ = 0.;       ///< bound on the way of any disk since the last search
  double sum_contact_force_ = 0.;
  std::size_t n_contacts_ = 0;
  std::size_t steps_ = 0;
};
} // namespace antiform::discrete
