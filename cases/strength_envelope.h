#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace antiform::cases
{
/// A test that broke: compression positive [Pa].
struct StrengthPoint
{
  double sigma3 = 0., sigma1 = 0.;
};

/// sigma_1 = UCS + N_phi sigma_3 by least squares.
struct MohrCoulombFit
{
  double ucs = 0., slope = 0.; ///< [Pa], [-]
  double cohesion = 0.;        ///< UCS / (2 sqrt(N_phi)) [Pa]
  double friction_angle = 0.;  ///< asin((N_phi - 1) / (N_phi + 1)) [rad]
  double correlation = 0.;     ///< r [-]
};

/// (sigma_1 - sigma_3)^2 = m_i sigma_ci sigma_3 + sigma_ci^2 by least squares (Hoek and
/// Brown 1980, intact rock).
struct HoekBrownFit
{
  double sigma_ci = 0., mi = 0.; ///< [Pa], [-]
  double tensile_strength = 0.;  ///< where sigma_1 = 0, a positive number [Pa]
  double correlation = 0.;       ///< r of the straight line [-]
};

/// Both throw std::invalid_argument with the reason when the points give no envelope:
/// fewer than two confinements, or a line that no rock has.
MohrCoulombFit fit_mohr_coulomb(const std::vector<StrengthPoint> &points);
HoekBrownFit fit_hoek_brown(const std::vector<StrengthPoint> &points);

/// Tests by site; by the file's name without a column of that name.
using StrengthTable = std::map<std::string, std::vector<StrengthPoint>>;
/// Read a table (.csv) with columns sigma3_MPa, sigma1_MPa and perhaps site. What cannot
/// be read is added to @p problems with file and line.
StrengthTable read_strength_table(const std::string &file,
                                  std::vector<std::string> &problems);

/// Fit and print the envelopes of each group of tests. \param sources directories of
/// finished laboratory runs (together one group), or tables (.csv) with columns
/// sigma3_MPa, sigma1_MPa and perhaps site, a group each.
/// Throws InputError. \return exit status
int print_envelopes(const std::vector<std::string> &sources,
                    bool json,
                    std::ostream &out);
} // namespace antiform::cases
