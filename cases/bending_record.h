#pragma once

#include "cases/scene.h"
#include "cases/summary.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// What is recorded of a layer that turning walls bend. The loading's strain is h/L times
/// the rotation of the walls, its stress that of an elastic layer's faces, 6 M/h^2.
namespace antiform::cases
{
/// Of history.csv, and their values now: rotation [degrees], moment [N m].
const std::vector<std::string> &bending_columns();
std::vector<double> measure_bending(const Scene &scene);

/// Stress on the faces of an elastic layer under the moment of the walls [Pa].
double bending_stress(const Scene &scene);

/// What the record knows in the loading's terms.
struct BendingFigures
{
  double peak_strain = 0., peak_stress = 0.;
  double first_crack_strain = 0., first_crack_stress = 0.;
  double crack_initiation_stress = 0.;
  std::optional<double> slope; ///< of the stress over the strain while elastic [Pa]
};
/// Say it in rotations and moments.
void report_bending(const Scene &scene,
                    const BendingFigures &figures,
                    std::map<std::string, Result> &results);
} // namespace antiform::cases
