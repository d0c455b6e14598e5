#pragma once

#include "cases/declarations.h"
#include "cases/geometry.h"
#include "cases/parameters.h"
#include "discrete/fractures.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// Fractures of a table with columns x1_m, y1_m, x2_m, y2_m and, where wanted,
/// friction_angle_deg, dilation_angle_deg, cohesion_Pa, tensile_strength_Pa (a fracture
/// with one of the last two is bonded) and dip_deg, which must agree with the end points.
/// What a fracture leaves open is as in @p law. Appends to @p problems.
std::vector<discrete::Fracture> read_fracture_table(const std::string &file,
                                                    const discrete::SmoothJoint &law,
                                                    std::vector<std::string> &problems);

/// All fractures of a deck: of its list, its table, its sets, in that order. Throws
/// InputError for a network that cannot be drawn.
std::vector<discrete::Fracture> make_fractures(const Parameters &parameters,
                                               const SectionGeometry &geometry);

/// What of fractures lies in a part of the section.
struct FractureTraces
{
  std::size_t number = 0; ///< fractures with a trace there
  double length = 0.;     ///< of their traces there [m]
  double intensity = 0.;  ///< P21 there, length per area [1/m]
};
FractureTraces traces_in_layer(const std::vector<discrete::Fracture> &fractures,
                               const SectionGeometry &geometry);

/// What is wrong with the fractures of a deck, before anything is built.
void check_fractures(const Parameters &parameters, std::vector<Finding> &findings);
/// Whether the network can be drawn and parts any grains. \pre nothing else is wrong
void check_drawn_fractures(const Parameters &parameters, std::vector<Finding> &findings);
} // namespace antiform::cases
