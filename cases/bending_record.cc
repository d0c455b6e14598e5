#include "cases/bending_record.h"

#include <cmath>

namespace antiform::cases
{
namespace
{
constexpr double degrees = 180. / M_PI;

/// Moment over the stress of the faces, h^2/6 [m^2].
double section_modulus(const Scene &scene)
{
  return scene.geometry.thickness() * scene.geometry.thickness() / 6.;
}
} // namespace

const std::vector<std::string> &bending_columns()
{
  static const std::vector<std::string> names{"wall_rotation_deg", "wall_moment_Nm"};
  return names;
}

std::vector<double> measure_bending(const Scene &scene)
{
  return {degrees * scene.rotation(), scene.wall_motion->moment()};
}

double bending_stress(const Scene &scene)
{
  return scene.wall_motion->moment() / section_modulus(scene);
}

void report_bending(const Scene &scene,
                    const BendingFigures &figures,
                    std::map<std::string, Result> &results)
{
  const double per_strain = degrees / scene.parameters.strain_per_radian();
  const double modulus = section_modulus(scene);
  results["wall_rotation"] = {degrees * scene.rotation(), "deg"};
  results["peak_moment"] = {modulus * figures.peak_stress, "N m"};
  results["rotation_at_peak"] = {per_strain * figures.peak_strain, "deg"};
  if (figures.slope) // M = B 2 theta/L, and theta is the strain times L/h
    results["bending_stiffness"] = {
        0.5 * scene.geometry.thickness() * modulus * *figures.slope, "N m^2"};
  if (scene.grains->state.cracks.empty())
    return;
  results["first_crack_rotation"] = {per_strain * figures.first_crack_strain, "deg"};
  results["first_crack_moment"] = {modulus * figures.first_crack_stress, "N m"};
  results["crack_initiation_moment"] = {modulus * figures.crack_initiation_stress, "N m"};
}
} // namespace antiform::cases
