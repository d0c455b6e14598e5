#pragma once

#include <optional>
#include <vector>

/// Closed forms for the buckling of a competent layer: what `antiform check` and
/// `antiform theory` print and what tests measure the program against. Plane strain;
/// axial force and stress are positive in compression; forces are per metre of thickness.
/// Derivations and sources: docs/theory/continuum.md.
namespace antiform::continuum::theory
{
/// E' = E / (1 - nu^2) [Pa].
double plane_modulus(double young_modulus, double poisson_ratio);
/// Oedometer modulus M = E (1 - nu) / ((1 + nu)(1 - 2 nu)) [Pa].
double oedometer_modulus(double young_modulus, double poisson_ratio);

/// The competent layer as a beam of unit width.
struct Layer
{
  double young_modulus; ///< E [Pa]
  double poisson_ratio; ///< nu [-]
  double thickness;     ///< h [m]

  double plane_modulus() const; ///< E' [Pa]
  /// D = E' h^3 / 12 [N m].
  double bending_stiffness() const;
  /// Bending resistance D k^2 of a wave k [1/m] to an axial force, lowered by shear and
  /// by the rotation of the sections: D k^2 / (1 + D k^2 / (5/6 G h) + (k h)^2 / 12)
  /// [N/m] (Timoshenko & Gere 1961; the second term for an initial stress that turns with
  /// the section, as in a geometric stiffness grad N . S grad N).
  double thick_bending_force(double wavenumber) const;
};

// --- strut: thesis pre-modelling plot (Gioiello 2018, 5.1)
// ------------------------------

/// lambda = sqrt(12) L / h [-].
double slenderness(double length, double thickness);
/// Euler stress pi^2 E / lambda^2 of ends that may turn [Pa]; E is the plane modulus in
/// plane strain.
double euler_stress_pinned(double modulus, double length, double thickness);
/// 4 times as much: ends that neither turn nor move sideways, a full wave in the length.
double euler_stress_guided(double modulus, double length, double thickness);
/// lambda_c = pi sqrt(E / UCS): slenderness at which the strut buckles as it crushes [-].
double critical_slenderness(double modulus, double compressive_strength);
/// Lambda = lambda / lambda_c [-]; buckling comes before failure above 1.
double slenderness_ratio(double modulus,
                         double compressive_strength,
                         double length,
                         double thickness);
/// gamma = sigma_1 / UCS at buckling of an unsupported strut, Lambda^-2 [-].
double stress_ratio_at_buckling(double slenderness_ratio);

// --- Winkler foundation (Hetenyi 1946; Timoshenko & Gere 1961)
// --------------------------

/// N_m = D (m pi / L)^2 + k_w (L / m pi)^2 of m half waves between pinned ends [N/m].
double winkler_mode_force(double bending_stiffness,
                          double foundation_stiffness,
                          double length,
                          unsigned int half_waves);

struct Mode
{
  unsigned int half_waves;
  double force; ///< [N/m]
};
/// The mode of least force for pinned ends.
Mode winkler_critical_mode(double bending_stiffness,
                           double foundation_stiffness,
                           double length);
/// 2 sqrt(k_w D) of a long layer [N/m]; with free ends it is half of that.
double winkler_critical_force(double bending_stiffness, double foundation_stiffness);

// --- matrix beside the layer: elastic layer in smooth contact
// ---------------------------

/// Phi of a matrix layer in smooth contact whose far face is free, smooth and rigid, or
/// rough and rigid: K = E0' k / 2 Phi(k H) [-].
double phi_free(double k_times_thickness);
double phi_smooth_rigid(double k_times_thickness);
double phi_rough_rigid(double k_times_thickness, double poisson_ratio);

/// The matrix on one side of the layer, with what lies beyond it.
struct Side
{
  enum class FarFace
  {
    half_space, ///< no far face; thickness unused
    free,
    smooth_rigid,
    rough_rigid,
    spring ///< no shear, pressure far_spring times displacement
  };

  double young_modulus; ///< E0 [Pa]; 0: nothing beside the layer
  double poisson_ratio; ///< nu0 [-]
  double thickness;     ///< H [m]
  FarFace far_face = FarFace::half_space;
  double far_spring =
      0.; ///< Winkler stiffness, or rho g of a free top with gravity [Pa/m]
  double far_shear = 0.; ///< G_p of a Pasternak foundation [Pa m]

  /// Pressure on the springs beyond per displacement of a wave k, k_w + G_p k^2 [Pa/m].
  double beyond(double wavenumber) const
  {
    return far_spring + far_shear * wavenumber * wavenumber;
  }

  /// Pressure on the layer per displacement of a wave k into this side, K(k) [Pa/m].
  double stiffness(double wavenumber) const;
};

// --- layer between two sides
// ------------------------------------------------------------

/// Least axial force over all waves, and that wave.
struct CriticalState
{
  double force;      ///< N [N/m]
  double stress;     ///< N / h [Pa]
  double wavenumber; ///< k [1/m]
  double wavelength; ///< 2 pi / k [m]
};

struct SupportedLayer
{
  Layer layer;
  std::vector<Side> sides;       ///< none, one or two (above and below)
  double direct_foundation = 0.; ///< springs or buoyancy on the layer itself [Pa/m]
  bool thick = false;            ///< with thick_bending_force() for D k^2
  bool bonded = false;           ///< the sides stick to the layer; else they slide on it
  double direct_shear = 0.;      ///< G_p of a Pasternak foundation on it [Pa m]

  /// K(k): all sides and the direct foundation [Pa/m].
  double support_stiffness(double wavenumber) const;
  /// N(k) = D k^2 + K(k) / k^2 [N/m].
  double buckling_force(double wavenumber) const;
  /// The least N(k) for wavelengths between 1e-1 and 1e6 thicknesses; nothing if N(k)
  /// falls towards the longest wave: then the length of the layer decides. The wave is
  /// found to some 1e-8 of itself: a minimum is flat.
  std::optional<CriticalState> critical() const;
  /// The least N among m half waves between pinned ends (wavelength above h / 10).
  Mode critical_mode(double length) const;
  /// gamma = N / (h UCS) at buckling, with the least N of critical() [-].
  std::optional<double> stress_ratio_at_buckling(double compressive_strength) const;

private:
  double bending_force(double wavenumber) const; ///< D k^2 or its thick form [N/m]
  double shortest_wave() const;                  ///< 2 pi over a tenth of h [1/m]
};

/// Deep limit, matrix half-spaces in smooth contact on one or two sides (Biot 1961;
/// Currie, Patnode & Trump 1962): sigma_cr = (9/16)^(1/3) E'^(1/3) E0'^(2/3) and lambda_w
/// = 2 pi h (E'/6E0')^(1/3) for two sides, 9/64 and 3 for one.
CriticalState
deep_limit(const Layer &layer, double matrix_plane_modulus, bool both_sides);

/// Theta = H/h (E0'/E')^(1/3): the one variable of a cover with a free top on a deep
/// base; below 0.3 it does not count (1 %), above 3 the layer is deep (0.1 %) [-].
double cover_variable(double cover_ratio,
                      double layer_plane_modulus,
                      double matrix_plane_modulus);

/// Growth of an initial wave of amplitude w0 under an axial force: 1 / (1 - N / N(k))
/// [-]. Throws std::domain_error at or above N(k), where there is no equilibrium near by.
double amplification(double force, double buckling_force);
} // namespace antiform::continuum::theory
