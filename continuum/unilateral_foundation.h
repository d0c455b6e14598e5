#pragma once

#include "continuum/loads.h"
#include "continuum/surface_force.h"

#include <functional>

namespace antiform::continuum
{
/// A base that pushes and does not pull: springs along the normal of the reference
/// boundary with the pressure k_n max(0, u.n - gap), without shear. Faces lift off it and
/// come down again. Whatever the rotation of the body the base stays where it is: exact
/// for a smooth plane base, under straight faces of a straight side.
class UnilateralFoundation : public SurfaceForce
{
public:
  struct Options
  {
    /// Distance to the base by place [m], asked again and again; below 0: pressed at the
    /// start, with k_n |gap|. Empty: 0.
    std::function<double(const dealii::Point<2> &)> gap;
    /// Gauss points of a face, each up or down by itself; 0: degree + 3. Degree + 1 are
    /// exact under a face that touches all along; between, the lifted length is known to
    /// some face over the number of points.
    unsigned int points_per_face = 0;
  };

  /// \param normal_stiffness k_n [Pa/m], > 0, as of winkler_foundation()
  /// The space must outlive the base. Throws std::invalid_argument.
  UnilateralFoundation(const DisplacementSpace &space,
                       BoundaryIds boundaries,
                       double normal_stiffness,
                       Options options);
  UnilateralFoundation(const DisplacementSpace &space,
                       BoundaryIds boundaries,
                       double normal_stiffness);

  bool has_symmetric_tangent() const override { return true; }
  void add(const Vector &displacement,
           Vector &internal_force,
           dealii::TrilinosWrappers::SparseMatrix *tangent) override;

  /// What the base carries, of all ranks.
  struct Support
  {
    double force = 0.;          ///< integral of the pressure [N/m]
    double touching = 0.;       ///< length of the faces that press [m]
    double lifted = 0.;         ///< of those that do not [m]
    double greatest_depth = 0.; ///< of u.n - gap, the indentation [m]
  };
  Support support(const Vector &displacement) const;

private:
  template <class AtPoint>
  void at_points(const Vector &displacement, const AtPoint &at_point) const;

  const DisplacementSpace &space_;
  BoundaryIds boundaries_;
  double normal_stiffness_;
  Options options_;
};
} // namespace antiform::continuum
