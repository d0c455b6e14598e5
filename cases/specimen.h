#pragma once

#include "cases/scene.h"
#include "cases/summary.h"
#include "coupling/state_file.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What a laboratory measures on a specimen: strains of gauges, moduli, the
/// stress at which cracks become unstable. Loading is positive: shortening in
/// compression, extension in tension.
class SpecimenRecord
{
public:
  explicit SpecimenRecord(const Scene &scene);

  static const std::vector<std::string> &columns();
  /// Of the present state, for columns().
  std::vector<double> measure(const Scene &scene) const;
  /// Keep a sample. \param values of measure() \param stress in the direction of loading,
  /// [Pa]
  void keep(const Scene &scene, const std::vector<double> &values, double stress);
  /// \param peak_stress [Pa]
  void fill(const Scene &scene, double peak_stress, Summary &summary) const;
  void visit_state(coupling::StateArchive &archive);

private:
  /// \param peak its sample
  void fill_moduli(const Scene &scene, std::size_t peak, Summary &summary) const;
  /// Grains about a place: their mean motion is that of a gauge point.
  struct Gauge
  {
    std::vector<std::int32_t> grains;
    double place = 0.; ///< mean reference coordinate [m]
  };
  static Gauge gauge(const std::vector<double> &coordinate,
                     const std::function<bool(double, double)> &holds,
                     const discrete::Grains &grains);
  double elongation(const Scene &scene, const Gauge (&pair)[2], bool axial) const;
  std::size_t peak_sample(double peak_stress) const;

  Gauge axial_[2], lateral_[2];
  // Samples since shortening began.
  std::vector<double> axial_strain_, lateral_strain_, stress_;
  double off_pressure_ = 0.; ///< share by which confinement was missed when it began
};
} // namespace antiform::cases
