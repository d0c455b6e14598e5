#pragma once

#include "cases/declarations.h"
#include "cases/geometry.h"
#include "discrete/fractures.h"

#include <string>
#include <vector>

namespace antiform::cases
{
/// The planes between the beds of a layer: they follow its axis, as chords, as long
/// as the fold allows.
class BedPlanes
{
public:
  BedPlanes(const Parameters &parameters, const SectionGeometry &geometry);

  /// Number of the bed at @p place, from below.
  int bed_at(const Vec2 &place) const;
  /// The planes as fractures with @p law.
  std::vector<discrete::Fracture> traces(const discrete::SmoothJoint &law) const;

private:
  /// Height of the layer's bottom on the chord at @p x [m].
  double bottom(double x) const;

  double x_min_, chord_, thickness_;
  std::vector<double> bottom_; ///< at the ends of the chords [m]
  std::vector<double> shares_; ///< of the thickness below each plane [-]
};

/// Law of the joints between two cemented beds: of each strength the lesser.
discrete::FlatJoint joint_between(const LayerParameters &one, const LayerParameters &other);

/// Rock of @p file: what it says of the layer, everything else as in @p like. Appends to
/// @p problems.
LayerParameters read_rock(const std::string &file,
                          const LayerParameters &like,
                          std::vector<std::string> &problems);

/// The text of a rock file that says all of @p rock.
std::string rock_text(const LayerParameters &rock);

/// What is wrong with the beds of a deck.
void check_beds(const Parameters &parameters, std::vector<Finding> &findings);
} // namespace antiform::cases
