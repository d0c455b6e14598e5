#pragma once

#include <array>
#include <vector>

namespace antiform::continuum
{
struct LameConstants;

/// Three principal stresses, greatest (most tensile) first [Pa].
using PrincipalStress = std::array<double, 3>;

/// Return of a trial stress to the Mohr-Coulomb surface with tension cut-off, in the
/// space of principal stresses, where each part of the surface is a plane and each return
/// an affine map (Clausen, Damkilde & Andersen 2006).
///
/// Six planes bound the stresses that are in order: the Mohr-Coulomb planes of the pairs
/// (I, III), (II, III), (I, II) and the cut-off of each stress. A return ends on one
/// plane, the line of two, the point of three, or the apex. Of all it takes the one whose
/// plastic multipliers are not negative and whose stress obeys the other planes.
class PrincipalReturn
{
public:
  /// \param cohesion_term c cos phi [Pa]
  /// \param cutoff        sigma_t [Pa]; infinite, or c cot phi, where there is none
  PrincipalReturn(const LameConstants &elastic,
                  double cohesion_term,
                  double sin_friction,
                  double sin_dilation,
                  double cutoff);

  struct Answer
  {
    PrincipalStress stress;
    PrincipalStress drop;                      ///< trial stress less @p stress
    std::array<PrincipalStress, 3> derivative; ///< d stress / d trial stress
    bool tied_I_II = false; ///< both equal because the surface has an edge there
    bool tied_II_III = false;
    bool is_elastic = false;
  };

  /// \param trial in order; throws NumericalError if it is not finite
  Answer operator()(const PrincipalStress &trial) const;

  /// Greatest of the six yield functions; > 0 outside of the surface [Pa].
  double yield_function(const PrincipalStress &stress) const;

private:
  /// normal . stress <= limit [Pa].
  struct Plane
  {
    PrincipalStress normal;
    PrincipalStress relief; ///< D flow: stress lost per plastic multiplier [Pa]
    double limit;
  };
  /// A return to the planes of its numbers; all else follows from them.
  struct Target
  {
    std::vector<unsigned int> planes;
    std::array<PrincipalStress, 3> inverse{};    ///< of normal . relief
    std::array<PrincipalStress, 3> derivative{}; ///< d stress / d trial stress
  };

  Target target(const std::vector<unsigned int> &planes) const;
  /// The return to @p target in @p answer; how far it is from a valid one [Pa], <= 0 if
  /// it is valid.
  double
  try_target(const Target &target, const PrincipalStress &trial, Answer &answer) const;
  /// The same for the apex: it takes what the returns to both edges carry beyond it.
  double try_apex(const PrincipalStress &trial, Answer &answer) const;

  double twice_shear_modulus_;
  double apex_; ///< c cot phi [Pa]
  bool has_cutoff_, has_apex_;
  std::vector<Plane> planes_;
  std::vector<Target> targets_;
};
} // namespace antiform::continuum
