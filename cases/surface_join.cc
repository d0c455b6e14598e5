#include "cases/surface_join.h"

#include "cases/prestress.h"
#include "cases/scene.h"
#include "cases/summary.h"

#include "continuum/section_mesh.h"

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
using namespace coupling;

namespace
{
/// Boundary ids after those of make_section().
constexpr dealii::types::boundary_id edge_below = continuum::boundary::inner + 1,
                                     edge_above = edge_below + 1;

std::vector<SurfaceInterface> make_interfaces(const Scene &scene)
{
  const discrete::Grains &grains = scene.grains->state.grains;
  std::vector<SurfaceInterface> interfaces;
  for (const auto &[towards, edge] :
       {std::pair{Vec2{0., -1.}, edge_below}, std::pair{Vec2{0., 1.}, edge_above}})
    interfaces.emplace_back(grains,
                            outer_side(grains, {}, scene.geometry.diameter(), towards),
                            *scene.solid, edge);
  return interfaces;
}

continuum::ContactLaw contact_law(const Scene &scene, const SurfaceInterface &interface)
{
  const MatrixParameters &m = scene.parameters.matrix;
  const auto [normal, shear] =
      surface_stiffness(interface, scene.grains->state.joints, *scene.solid);
  if (m.interface == "frictionless")
    return continuum::FrictionlessContact{normal};
  return continuum::FrictionalContact{normal, shear, m.friction, m.interface_cohesion};
}
} // namespace

void SurfaceJoin::add_to(StaticSystem &system) const
{
  if (tie)
    tie->add_to(system);
  for (const auto &contact : contacts)
    contact->add_to(system);
}

void SurfaceJoin::add_stiffness(discrete::StiffnessSums &grain_sums,
                                std::vector<double> &mesh_row_sums) const
{
  for (const auto &contact : contacts)
    contact->add_stiffness(grain_sums, mesh_row_sums);
}

void label_edges(dealii::parallel::distributed::Triangulation<2> &mesh,
                 const SectionGeometry &geometry)
{
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->at_boundary(f) &&
          cell->face(f)->boundary_id() == continuum::boundary::inner)
      {
        const dealii::Point<2> centre = cell->face(f)->center();
        cell->face(f)->set_boundary_id(centre[1] > geometry.axis(centre[0]) ? edge_above
                                                                           : edge_below);
      }
}

std::unique_ptr<SurfaceJoin> make_surface_join(Scene &scene)
{
  const Parameters &p = scene.parameters;
  const discrete::Grains &grains = scene.grains->state.grains;
  std::vector<SurfaceInterface> interfaces = make_interfaces(scene);
  auto join = std::make_unique<SurfaceJoin>();
  if (p.has_surface_tie())
  {
    std::vector<std::uint32_t> at_walls;
    for (const PrescribedDof &entry : scene.mesh->prescribed)
      if (entry.wall >= 0)
        at_walls.push_back(entry.dof);
    join->tie.emplace(grains, std::move(interfaces),
                      p.matrix.interface == "cemented" ? SurfaceTie::Kind::cemented
                                                       : SurfaceTie::Kind::sliding,
                      std::move(at_walls));
    return join;
  }
  SurfaceContact::InitialTraction pressure;
  if (p.has("gravity") || p.has("surface pressure"))
    pressure = [prestress = prestress_of(scene)](const Vec2 &place, const Vec2 &normal)
    { return -prestress.pressure(place.y) * normal; };
  for (SurfaceInterface &interface : interfaces)
  {
    const continuum::ContactLaw law = contact_law(scene, interface);
    join->contacts.push_back(
        std::make_unique<SurfaceContact>(std::move(interface), law, pressure));
  }
  return join;
}

void report_surface(const Scene &scene, Summary &summary)
{
  if (!scene.surface || scene.surface->contacts.empty())
    return;
  double all = 0., open = 0., slides = 0., slip = 0.;
  for (const auto &contact : scene.surface->contacts)
    for (std::size_t k = 0; k < contact->states().size(); ++k)
    {
      const SurfaceContact::State &state = contact->states()[k];
      const double length = contact->interface().points()[k].length;
      all += length;
      open += state.phase == continuum::ContactPhase::open ? length : 0.;
      slides += state.phase == continuum::ContactPhase::slides ? length : 0.;
      slip = std::max(slip, std::abs(state.gap.slip));
    }
  summary.results["interface_open_share"] = {open / all, "-"};
  if (scene.parameters.matrix.interface != "frictional")
    return; // slides wherever it is closed, and nobody counts how far
  summary.results["interface_sliding_share"] = {slides / all, "-"};
  summary.results["interface_largest_slip"] = {slip, "m"};
}
} // namespace antiform::cases
