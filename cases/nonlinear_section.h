#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "continuum/loaded_solid.h"
#include "continuum/strip_contact.h"
#include "continuum/unilateral_foundation.h"

#include <mpi.h>

#include <memory>
#include <optional>

namespace antiform::cases
{
/// What a run says of one equilibrium.
struct Reading
{
  double wall_force = 0.; ///< on layer and matrix [N]
  /// Of the layer, compression > 0 [Pa]: the walls' force over its thickness; in a matrix
  /// the mean of Cauchy's stress in the cells beside a wall.
  double axial_stress = 0.;
  double fold_amplitude = 0.; ///< crest over troughs [m]
  double plastic_share = 0.;  ///< of the layer's area that has yielded [-]
  // Of a foundation that only pushes, and of layer and matrix that are not cemented; else
  // 0
  double crest_height = 0.;  ///< over the layer's troughs as it was laid down [m]
  double lifted_length = 0.; ///< of the faces that have parted from the foundation [m]
  double open_length = 0.;   ///< of the interfaces that have opened [m]
  double relative_slip = 0.; ///< greatest slip along them over the length of its face [-]
};

/// The section of a deck as a body of laws under its loads: laid down under them, then
/// shortened by the walls as the load factor goes from 0 to 1. Collective.
class NonlinearSection
{
public:
  NonlinearSection(const Parameters &parameters, MPI_Comm communicator);
  NonlinearSection(const NonlinearSection &) = delete;

  const SectionGeometry &geometry() const { return geometry_; }
  continuum::NonlinearSolid &solid() { return solid_; }
  continuum::LoadedSolid &loaded() { return *loaded_; }
  /// At load factor 1; without walls the sides are held.
  double end_shortening() const { return p_.has("walls") ? p_.run.end_shortening : 0.; }

  Reading read(const continuum::Vector &displacement) const;

private:
  double pressure_at(double y) const;
  bool is_in_layer(const dealii::Point<2> &x, double slack) const;
  continuum::NonlinearSolid::Options options() const;
  void add_foundation();
  void add_interface();
  continuum::Loads constant_loads() const;
  void add_pressure(continuum::Loads &loads) const;
  continuum::Loads shortening_to(double shortening) const;
  /// Mean rise of the layer in a column's width about @p x [m].
  double rise(const continuum::Vector &displacement, double x) const;

  const Parameters &p_;
  SectionGeometry geometry_;
  std::unique_ptr<dealii::parallel::distributed::Triangulation<2>> mesh_;
  continuum::NonlinearSolid solid_;
  std::shared_ptr<continuum::UnilateralFoundation> base_; ///< null: there is none
  std::shared_ptr<continuum::StripContact> interface_;    ///< null: cemented
  std::optional<continuum::LoadedSolid> loaded_;
};
} // namespace antiform::cases
