#include "cases/small_strain.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
namespace
{
constexpr double rotation_limit = 5. * M_PI / 180.;
constexpr double strain_limit = 0.1;
} // namespace

void SmallStrainWatch::look(const continuum::DisplacementSpace &space,
                            const continuum::Vector &displacement,
                            const long step)
{
  measure(space, displacement);
  demand(step);
}

void SmallStrainWatch::measure(const continuum::DisplacementSpace &space,
                               const continuum::Vector &displacement)
{
  dealii::FEValues<2> values(space.fe(), dealii::QMidpoint<2>(),
                             dealii::update_gradients | dealii::update_quadrature_points);
  const dealii::FEValuesExtractors::Vector u(0);
  std::vector<dealii::Tensor<2, 2>> gradients(1);
  for (const auto &cell : space.dof_handler().active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    values.reinit(cell);
    if (space.weight(values.quadrature_point(0)) < 0.2)
      continue; // where the mesh has little weight its strain says nothing
    values[u].get_function_gradients(displacement, gradients);
    const dealii::Tensor<2, 2> &H = gradients[0];
    largest_rotation = std::max(largest_rotation, 0.5 * std::abs(H[1][0] - H[0][1]));
    const double radius =
        std::hypot(0.5 * (H[0][0] - H[1][1]), 0.5 * (H[0][1] + H[1][0]));
    largest_strain = std::max(largest_strain, 0.5 * std::abs(H[0][0] + H[1][1]) + radius);
  }
  const MPI_Comm comm = space.dof_handler().get_communicator();
  largest_rotation = dealii::Utilities::MPI::max(largest_rotation, comm);
  largest_strain = dealii::Utilities::MPI::max(largest_strain, comm);
}

bool SmallStrainWatch::is_beyond() const
{
  return largest_rotation > 2. * rotation_limit || largest_strain > 2. * strain_limit;
}

void SmallStrainWatch::demand(const long step) const
{
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
