#pragma once

#include <string>
#include <vector>

namespace antiform::cases
{
/// A scene in the diagram.
struct DiagramMark
{
  std::string label;        ///< in the legend
  double slenderness_ratio; ///< Lambda [-]
  double gamma;             ///< [-]
  bool filled;
};

/// The thesis' dimensionless diagram (Gioiello 2018, 5.1): stress ratio gamma against
/// slenderness ratio Lambda, failure a level, buckling Lambda^-2, scenes marked.
struct StrengthDiagram
{
  std::string title, subtitle;
  std::vector<DiagramMark> marks;
  double failure_ratio = 1.; ///< gamma at failure; above 1 under confinement
  double imperfection = 0.;  ///< of the Perry-Robertson curve; 0: not drawn [-]
  std::string imperfection_label;
  double strength = 0.;     ///< UCS, for the axis in MPa; 0: none [Pa]
  double length_ratio = 0.; ///< L/h at Lambda = 1, for the axis above; 0: none [-]
};

/// The diagram as a picture (SVG).
std::string draw(const StrengthDiagram &diagram);
} // namespace antiform::cases
