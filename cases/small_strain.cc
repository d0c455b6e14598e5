#include "cases/small_strain.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
namespace
{
constexpr double rotation_limit = 5. * M_PI / 180.;
constexpr double strain_limit = 0.1;
} // namespace

void SmallStrainWatch::look(const continuum::ElasticSolid &solid,
                            const continuum::Vector &displacement,
                            const long step)
{
  for (const auto &cell : solid.cell_states(displacement))
  {
    if (cell.weight < 0.2)
      continue; // where the mesh has little weight its strain says nothing
    largest_rotation = std::max(largest_rotation, std::abs(cell.rotation));
    const double half_difference = 0.5 * (cell.strain[0] - cell.strain[1]);
    const double radius = std::hypot(half_difference, 0.5 * cell.strain[2]);
    const double mean = 0.5 * (cell.strain[0] + cell.strain[1]);
    largest_strain = std::max(largest_strain, std::abs(mean) + radius);
  }
  const MPI_Comm comm = solid.dof_handler().get_communicator();
  largest_rotation = dealii::Utilities::MPI::max(largest_rotation, comm);
  largest_strain = dealii::Utilities::MPI::max(largest_strain, comm);
  if (largest_rotation > 2. * rotation_limit)
    throw NumericalError(
        "mesh",
        "the mesh has turned by more than 10 degrees, beyond small-strain "
        "theory: end the run earlier (Run / End shortening); rotation [rad]",
        largest_rotation, 2. * rotation_limit, step);
  if (largest_strain > 2. * strain_limit)
    throw NumericalError("mesh",
                         "the mesh is strained by more than 20 %, beyond small-strain "
                         "theory: end the run earlier (Run / End shortening); strain",
                         largest_strain, 2. * strain_limit, step);
}

std::vector<std::string> SmallStrainWatch::warnings() const
{
  std::vector<std::string> texts;
  if (largest_rotation > rotation_limit)
    texts.push_back("the mesh turned by up to " +
                    std::to_string(largest_rotation * 180. / M_PI) +
                    " degrees; small-strain theory holds to about 5");
  if (largest_strain > strain_limit)
    texts.push_back("the mesh was strained by up to " +
                    std::to_string(100. * largest_strain) +
                    " %; small-strain theory holds to about 10");
  return texts;
}
} // namespace antiform::cases
