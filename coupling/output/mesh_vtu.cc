#include "coupling/output/mesh_vtu.h"

#include <deal.II/numerics/data_component_interpretation.h>
#include <deal.II/numerics/data_out.h>

#include <fstream>
#include <stdexcept>

namespace antiform::coupling
{
void write_mesh_vtu(const std::string &path,
                    const continuum::ElasticSolid &solid,
                    const continuum::Vector &displacement)
{
  using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
  dealii::DataOut<2> out;
  out.attach_dof_handler(solid.dof_handler());
  out.add_data_vector(
      displacement, std::vector<std::string>(2, "displacement_m"),
      dealii::DataOut<2>::type_dof_data,
      std::vector<Interpretation>(
          2, dealii::DataComponentInterpretation::component_is_part_of_vector));

  const std::vector<continuum::ElasticSolid::CellState> states =
      solid.cell_states(displacement);
  const auto &triangulation = solid.dof_handler().get_triangulation();
  const std::vector<std::string> names{"stress_xx_Pa", "stress_yy_Pa", "stress_xy_Pa",
                                       "strain_xx",    "strain_yy",    "strain_xy",
                                       "weight_C",     "material"};
  std::vector<dealii::Vector<float>> values(
      names.size(), dealii::Vector<float>(triangulation.n_active_cells()));
  std::size_t k = 0; // states are in the order of the owned cells
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const auto &state = states[k++];
      const unsigned int index = cell->active_cell_index();
      for (int c = 0; c < 3; ++c)
      {
        values[c][index] = static_cast<float>(state.stress[c]);
        values[3 + c][index] = static_cast<float>(state.strain[c]);
      }
      values[6][index] = static_cast<float>(state.weight);
      values[7][index] = static_cast<float>(state.material);
    }
  for (std::size_t f = 0; f < names.size(); ++f)
    out.add_data_vector(values[f], names[f], dealii::DataOut<2>::type_cell_data);
  out.build_patches(solid.degree());

  const MPI_Comm comm = solid.dof_handler().get_communicator();
  if (dealii::Utilities::MPI::n_mpi_processes(comm) > 1)
  {
    out.write_vtu_in_parallel(path, comm);
    return;
  }
  std::ofstream file(path);
  out.write_vtu(file);
  file.close();
  if (!file)
    throw std::runtime_error("cannot write '" + path +
                             "': the disk is full or the folder is not writable");
}
} // namespace antiform::coupling
