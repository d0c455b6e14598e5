#pragma once

#include "coupling/static_system.h"
#include "coupling/surface_contact.h"
#include "coupling/surface_tie.h"
#include "discrete/joints.h"

#include <deal.II/distributed/tria.h>

#include <memory>
#include <optional>
#include <vector>

namespace antiform::cases
{
class SectionGeometry;
struct Scene;
struct Summary;

/// Holds a layer of grains on the edges of a mesh that ends where its outer grains begin,
/// below and above it, by the law of 'Matrix/Interface'. Either the tie or the contacts.
struct SurfaceJoin
{
  std::optional<coupling::SurfaceTie> tie; ///< cemented, sliding
  /// Frictional, frictionless: below the layer, above it.
  std::vector<std::unique_ptr<coupling::SurfaceContact>> contacts;

  std::size_t n_multipliers() const { return tie ? tie->n_multipliers() : 0; }
  void add_to(coupling::StaticSystem &system) const;
  /// Stiffness of the contacts: to the grains' sums and the mesh's row sums [N/m].
  void add_stiffness(discrete::StiffnessSums &grain_sums,
                     std::vector<double> &mesh_row_sums) const;
};

/// Give the mesh's faces towards the layer the boundary ids that the join knows them by.
void label_edges(dealii::parallel::distributed::Triangulation<2> &mesh,
                 const SectionGeometry &geometry);

/// The join of a scene whose grains and mesh are there. Contacts carry the scene's
/// prestress from the start.
std::unique_ptr<SurfaceJoin> make_surface_join(Scene &scene);

/// Of contacts: which share of the edges is open, which slides, and the largest slip.
void report_surface(const Scene &scene, Summary &summary);
} // namespace antiform::cases
