#pragma once

#include "cases/parameters.h"

#include <functional>
#include <string>
#include <vector>

namespace antiform::cases
{
/// What a calibration may change of a rock, in the units of a deck.
struct MicroParameters
{
  double effective_modulus = 0.;               ///< E* [Pa]
  double tensile_strength = 0., cohesion = 0.; ///< sigma_b, c_b [Pa]
  double friction_angle = 0.;                  ///< phi_b [degrees]
  double residual_friction = 0.;               ///< mu [-]
  double slit_fraction = 0.;                   ///< [-]
};

/// One of them, by its name in the entry Free.
struct MicroName
{
  std::string name;   ///< "effective modulus"
  std::string entry;  ///< path in a deck
  std::string column; ///< in tables, with unit
  double MicroParameters::*value;
};
const std::vector<MicroName> &micro_names();

MicroParameters micro_parameters_of(const LayerParameters &layer);
/// With four significant digits: what is printed is what was tested.
MicroParameters rounded(const MicroParameters &micro);
/// May a flat joint have them? The Coulomb line must reach the tensile strength.
bool is_possible(const MicroParameters &micro);

/// A test of a laboratory.
struct Test
{
  enum class Kind
  {
    elastic, ///< a small shortening without cracks: E
    tension,
    compression
  };
  Kind kind = Kind::compression;
  double confinement = 0.; ///< sigma_3 in compression [Pa]

  std::string name() const; ///< "uniaxial", "biaxial-10MPa"
  bool operator==(const Test &other) const
  {
    return kind == other.kind && confinement == other.confinement;
  }
};

/// A test of one specimen.
struct Trial
{
  Test test;
  int seed = 1;
  MicroParameters micro;
};

/// What it has given.
struct Measurement
{
  double young_modulus = 0.; ///< [Pa]
  double strength = 0.;      ///< tensile strength, or sigma_1 at the peak [Pa]
};

/// Tests specimens, in any order; gives a measurement for each. Throws what stops it.
using Laboratory = std::function<std::vector<Measurement>(const std::vector<Trial> &)>;

/// The deck of a trial: the specimen of the calibration's, under one test.
Parameters deck_of(const Trial &trial, const Parameters &calibration);

/// A name for a trial that no other has: test, seed, and a checksum of its deck.
std::string trial_name(const Trial &trial, const Parameters &deck);

/// Read what a trial left in @p directory; false when it is not finished.
/// \param longest_shortening where its run was to be given up [-]
/// Throws std::runtime_error with the reason when it has finished without a result.
bool read_measurement(const Trial &trial,
                      double longest_shortening,
                      const std::string &directory,
                      Measurement &measurement,
                      double &cpu_seconds);
} // namespace antiform::cases
