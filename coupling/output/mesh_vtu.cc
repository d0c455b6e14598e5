#include "coupling/output/mesh_vtu.h"

#include <deal.II/numerics/data_component_interpretation.h>
#include <deal.II/numerics/data_out.h>

#include <array>
#include <fstream>
#include <stdexcept>

namespace antiform::coupling
{
namespace
{
/// Displacement by node and named numbers by cell.
class MeshFile
{
public:
  MeshFile(const continuum::DisplacementSpace &space,
           const continuum::Vector &displacement,
           const std::vector<std::string> &names)
      : space_(space)
      , names_(names)
      , values_(names.size(),
                dealii::Vector<float>(
                    space.dof_handler().get_triangulation().n_active_cells()))
  {
    using Interpretation =
        dealii::DataComponentInterpretation::DataComponentInterpretation;
    out_.attach_dof_handler(space.dof_handler());
    out_.add_data_vector(
        displacement, std::vector<std::string>(2, "displacement_m"),
        dealii::DataOut<2>::type_dof_data,
        std::vector<Interpretation>(
            2, dealii::DataComponentInterpretation::component_is_part_of_vector));
  }

  void set(const std::size_t name, const unsigned int cell, const double value)
  {
    values_[name][cell] = static_cast<float>(value);
  }

  void write(const std::string &path)
  {
    for (std::size_t f = 0; f < names_.size(); ++f)
      out_.add_data_vector(values_[f], names_[f], dealii::DataOut<2>::type_cell_data);
    out_.build_patches(space_.degree());
    const MPI_Comm comm = space_.dof_handler().get_communicator();
    if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
    {
      out_.write_vtu_in_parallel(path, comm);
      return;
    }
    std::ofstream file(path);
    out_.write_vtu(file);
    file.close();
    if (!file)
      throw std::runtime_error("cannot write '" + path +
                               "': the disk is full or the folder is not writable");
  }

private:
  const continuum::DisplacementSpace &space_;
  std::vector<std::string> names_;
  std::vector<dealii::Vector<float>> values_;
  dealii::DataOut<2> out_;
};
} // namespace

void write_mesh_vtu(const std::string &path,
                    const continuum::ElasticSolid &solid,
                    const continuum::Vector &displacement)
{
  const std::vector<continuum::ElasticSolid::CellState> states =
      solid.cell_states(displacement);
  MeshFile file(solid, displacement,
                {"stress_xx_Pa", "stress_yy_Pa", "stress_xy_Pa", "strain_xx", "strain_yy",
                 "strain_xy", "weight_C", "material"});
  std::size_t k = 0; // states are in the order of the owned cells
  for (const auto &cell : solid.dof_handler().get_triangulation().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const auto &state = states[k++];
      const unsigned int index = cell->active_cell_index();
      for (std::size_t c = 0; c < 3; ++c)
      {
        file.set(c, index, state.stress[c]);
        file.set(3 + c, index, state.strain[c]);
      }
      file.set(6, index, state.weight);
      file.set(7, index, state.material);
    }
  file.write(path);
}

void write_mesh_vtu(const std::string &path,
                    const continuum::NonlinearSolid &solid,
                    const continuum::Vector &displacement)
{
  const std::vector<continuum::NonlinearSolid::PointState> points =
      solid.point_states(displacement);
  MeshFile file(solid, displacement,
                {"stress_xx_Pa", "stress_yy_Pa", "stress_zz_Pa", "stress_xy_Pa",
                 "strain_xx", "strain_yy", "strain_xy", "plastic_strain", "material"});
  const std::size_t n_points = (solid.degree() + 1) * (solid.degree() + 1);
  std::size_t k = 0; // points are in the order of the owned cells
  for (const auto &cell : solid.dof_handler().get_triangulation().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      std::array<double, 8> mean{};
      double area = 0.;
      for (std::size_t q = 0; q < n_points; ++q, ++k)
      {
        const auto &s = points[k];
        const std::array<double, 8> of_point{s.stress.xx, s.stress.yy,     s.stress.zz,
                                             s.stress.xy, s.strain[0],     s.strain[1],
                                             s.strain[2], s.plastic_strain};
        for (std::size_t f = 0; f < mean.size(); ++f)
          mean[f] += s.area * of_point[f];
        area += s.area;
      }
      const unsigned int index = cell->active_cell_index();
      for (std::size_t f = 0; f < mean.size(); ++f)
        file.set(f, index, mean[f] / area);
      file.set(mean.size(), index, cell->material_id());
    }
  file.write(path);
}
} // namespace antiform::coupling
