#include "cases/buckling_section.h"

#include "cases/deck_doubts.h"
#include "cases/mesh_strips.h"
#include "cases/section_foundation.h"
#include "cases/section_materials.h"
#include "cases/sizes.h"
#include "cases/solid_run.h"
#include "continuum/error_indicator.h"
#include "continuum/refinement.h"
#include "continuum/sliding_interface.h"
#include "coupling/output/mesh_vtu.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace antiform::cases
{
namespace
{
constexpr double shortening = 1e-6; // of factor 1; any: linear

bool slides(const Parameters &p)
{
  return p.has("matrix") && p.matrix.interface == "sliding";
}
} // namespace

BucklingSection::BucklingSection(const Parameters &p, const MPI_Comm communicator)
    : StraightSection(p)
    , mesh_(make_mesh(p, geometry_, communicator))
{
  build();
}

void BucklingSection::build()
{
  solid_ = std::make_unique<continuum::ElasticSolid>(
      *mesh_, mesh_materials(p_), static_cast<unsigned int>(p_.matrix.element_degree));
  if (p_.has("foundation"))
    solid_->add_to_stiffness(section_foundation(p_, *solid_));
}

std::map<std::string, std::int64_t> BucklingSection::sizes() const
{
  return sizes_of_solid(*solid_);
}

std::vector<coupling::PvdEntry>
BucklingSection::write_fields(const std::string &directory) const
{
  std::vector<coupling::PvdEntry> fields;
  for (std::size_t k = 0; k < shapes_.size(); ++k)
  {
    char file[64];
    std::snprintf(file, sizeof file, "fields/mode_%04zu.vtu", k + 1);
    coupling::write_mesh_vtu(directory + "/" + file, *solid_, shapes_[k].shape);
    fields.push_back({static_cast<double>(k + 1), "continuum", file});
  }
  return fields;
}

std::vector<std::string> BucklingSection::doubts() const
{
  if (const auto known = doubts_of(p_, geometry_); !known.empty())
    return known;
  const unsigned int n = modes_.front().half_waves;
  const double columns = geometry_.n_columns();
  if (p_.matrix.refinement_rounds > 0 || (n > 0 && columns >= 6. * n))
    return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "%.3g columns of cells a half wave: too few for a load to trust. Give "
                "'Matrix/Cell aspect ratio' less, for 8 or more",
                n == 0 ? columns : columns / n);
  return {text};
}

/// Mean compression along the layer [Pa], tension negative.
double BucklingSection::layer_stress(const continuum::Vector &displacement) const
{
  double force = 0., area = 0.;
  for (const auto &cell : solid_->cell_states(displacement))
    if (cell.material == layer_material_id)
    {
      force -= cell.stress[0] * cell.area;
      area += cell.area;
    }
  return dealii::Utilities::MPI::sum(force, communicator()) /
         dealii::Utilities::MPI::sum(area, communicator());
}

/// Changes of sign, from column to column of the finest cells, of what the layer moves
/// across on average. Columns that hardly move do not count.
unsigned int BucklingSection::half_waves(const continuum::Vector &shape) const
{
  const SectionGeometry &g = geometry_;
  const std::size_t n_columns = static_cast<std::size_t>(g.n_columns())
                                << (mesh_->n_global_levels() - 1);
  std::vector<double> across(n_columns), number(n_columns);
  std::vector<dealii::types::global_dof_index> dofs(solid_->fe().n_dofs_per_cell());
  for (const auto &cell : solid_->dof_handler().active_cell_iterators())
    if (cell->is_locally_owned() && cell->material_id() == layer_material_id)
    {
      cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < dofs.size(); ++i)
        if (solid_->fe().system_to_component_index(i).first == 1)
        {
          const double place =
              (solid_->support_point(dofs[i])[0] - g.x_min()) / g.length();
          const std::size_t column =
              std::min(n_columns - 1, static_cast<std::size_t>(std::max(
                                          0., place * static_cast<double>(n_columns))));
          across[column] += shape(dofs[i]);
          number[column] += 1.;
        }
    }
  dealii::Utilities::MPI::sum(across, communicator(), across);
  dealii::Utilities::MPI::sum(number, communicator(), number);
  std::size_t n_met = 0; // large cells have no nodes in some of the columns
  for (std::size_t k = 0; k < n_columns; ++k)
    if (number[k] > 0.)
      across[n_met++] = across[k] / number[k];
  across.resize(n_met);
  double mean = 0., largest = 0., last = 0.; // a bare layer is held at one corner
  for (const double u : across)
    mean += u / static_cast<double>(n_met);
  for (double &u : across)
  {
    u -= mean;
    largest = std::max(largest, std::abs(u));
  }
  unsigned int n = 0;
  for (const double u : across)
    if (std::abs(u) > 1e-3 * largest)
    {
      n += last * u < 0. ? 1 : 0;
      last = u;
    }
  return n;
}

void BucklingSection::solve(const std::function<bool()> &stop)
{
  const std::vector<continuum::Tie> ties =
      slides(p_) ? continuum::sliding_interfaces(*solid_) : std::vector<continuum::Tie>();
  const continuum::DofReduction reduction(
      *solid_, section_supports(p_, geometry_, *solid_, shortening), ties);
  straight_ = continuum::solve_reduced(*solid_, reduction, solid_->make_vector());
  straight_.update_ghost_values();
  const double stress = layer_stress(straight_);
  shapes_ = continuum::lowest_buckling_modes(
      *solid_, solid_->geometric_stiffness(straight_), reduction,
      {static_cast<unsigned int>(p_.run.modes), 1e-9, 200, stop});
  modes_.clear();
  for (const continuum::BucklingMode &shape : shapes_)
    modes_.push_back({shape.load_factor * shortening, shape.load_factor * stress,
                      half_waves(shape.shape)});
}

std::vector<double> BucklingSection::indicators(const continuum::BucklingMode &mode) const
{
  continuum::Surroundings surroundings;
  surroundings.displacements = section_supports(p_, geometry_, *solid_, shortening);
  if (p_.has("foundation"))
  {
    surroundings.sprung = foundation_faces(p_);
    surroundings.spring_stiffness = p_.foundation_stiffness();
  }
  surroundings.slides = slides(p_);
  return continuum::error_indicators(*solid_, straight_, mode, surroundings);
}

double BucklingSection::estimate() const
{
  double sum = 0.;
  for (const double eta : indicators(shapes_.front()))
    sum += eta;
  return dealii::Utilities::MPI::sum(sum, communicator());
}

bool BucklingSection::refine()
{
  std::vector<double> found = indicators(shapes_.front());
  for (std::size_t k = 1; k < std::min<std::size_t>(3, shapes_.size()); ++k)
  {
    const std::vector<double> more = indicators(shapes_[k]);
    for (std::size_t i = 0; i < found.size(); ++i)
      found[i] += more[i];
  }
  shapes_.clear();
  modes_.clear();
  straight_.reinit(0);
  solid_.reset();
  continuum::RefinementOptions options;
  options.bulk_share = p_.matrix.refinement_share;
  options.max_cells = largest_mesh(p_);
  const bool refined = continuum::refine(*mesh_, found, options);
  build();
  return refined;
}
} // namespace antiform::cases
