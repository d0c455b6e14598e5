#include "cases/nonlinear_section.h"

#include "cases/mesh_strips.h"
#include "cases/section_foundation.h"
#include "cases/solid_laws.h"
#include "cases/solid_run.h"
#include "continuum/loads.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace antiform::cases
{
using continuum::Vector;
using dealii::Point;

namespace
{
void add_dead(const Vector &force, continuum::Loads &loads)
{
  if (loads.dead)
    *loads.dead += force;
  else
    loads.dead = force;
}
} // namespace

NonlinearSection::NonlinearSection(const Parameters &p, const MPI_Comm communicator)
    : p_(p)
    , geometry_(p)
    , mesh_(make_mesh(p, geometry_, communicator))
    , solid_(*mesh_, solid_laws(p), options())
{
  if (p.has("foundation"))
    add_foundation();
  if (p.has_mesh_contact())
    add_interface();
  loaded_.emplace(solid_, constant_loads(), shortening_to(end_shortening()));
}

/// Pressure under which the section was laid down, at a height [Pa].
double NonlinearSection::pressure_at(const double y) const
{
  if (p_.has("membrane"))
    return p_.membrane.pressure;
  // A bare layer takes up its own weight in the first equilibrium.
  const double weight = p_.has("gravity") && p_.has("matrix")
                            ? p_.matrix_density() * p_.gravity.acceleration
                            : 0.;
  return p_.pressure_on_top() + weight * (geometry_.surface() - y);
}

bool NonlinearSection::is_in_layer(const Point<2> &x, const double slack) const
{
  return x[1] < geometry_.core_top(x[0]) + slack &&
         x[1] > geometry_.core_bottom(x[0]) - slack;
}

continuum::NonlinearSolid::Options NonlinearSection::options() const
{
  continuum::NonlinearSolid::Options options;
  options.degree = static_cast<unsigned int>(p_.matrix.element_degree);
  if (p_.has("gravity") || p_.has("surface pressure") || p_.has("membrane"))
    options.initial_stress = [this](const Point<2> &x)
    {
      const double P = pressure_at(x[1]);
      return continuum::PointStress{-P, -P, -P, 0.};
    };
  return options;
}

void NonlinearSection::add_foundation()
{
  if (!p_.foundation.lifts_off)
    return solid_.add_springs(section_foundation(p_, solid_));
  continuum::UnilateralFoundation::Options options;
  if (p_.has("matrix")) // laid down on it; a bare layer comes to rest in its first step
    options.gap = [this](const Point<2> &x)
    { return -pressure_at(x[1]) / p_.foundation_stiffness(); };
  base_ = std::make_shared<continuum::UnilateralFoundation>(
      solid_, foundation_faces(p_), p_.foundation_stiffness(), options);
  solid_.add(base_);
}

void NonlinearSection::add_interface()
{
  const double cell = p_.matrix.cell_size * geometry_.diameter();
  const double cover =
      p_.matrix.cover_rows > 0
          ? (geometry_.surface() - geometry_.core_top(0.)) / p_.matrix.cover_rows
          : cell;
  using continuum::LameConstants;
  const continuum::ContactStiffness stiffness = continuum::contact_stiffness(
      {LameConstants::from_young_poisson(p_.matrix_modulus(), p_.matrix.poisson_ratio),
       std::min(cell, cover)},
      {LameConstants::from_young_poisson(p_.layer.young_modulus, p_.layer.poisson_ratio),
       cell},
      p_.matrix.contact_stiffness);
  continuum::ContactLaw law = continuum::SlidingContact{stiffness.normal};
  if (p_.matrix.interface == "frictionless")
    law = continuum::FrictionlessContact{stiffness.normal};
  else if (p_.matrix.interface == "frictional")
    law = continuum::FrictionalContact{stiffness.normal, stiffness.shear,
                                       p_.matrix.friction, p_.matrix.interface_cohesion};
  continuum::StripContact::Options options;
  options.initial_traction = [this](const Point<2> &x, const dealii::Tensor<1, 2> &normal)
  { return -pressure_at(x[1]) * normal; };
  interface_ = std::make_shared<continuum::StripContact>(solid_, law, options);
  solid_.add(interface_);
}

continuum::Loads NonlinearSection::constant_loads() const
{
  continuum::Loads loads;
  loads.displacements = section_supports(p_, geometry_, solid_, 0.);
  if (p_.has("gravity"))
    loads.dead = continuum::body_force(
        solid_,
        [this](const Point<2> &x)
        {
          const double density =
              is_in_layer(x, 0.) ? p_.layer_density() : p_.matrix_density();
          return dealii::Tensor<1, 2>({0., -density * p_.gravity.acceleration});
        });
  if (p_.has("surface pressure") || p_.has("membrane"))
    add_pressure(loads);
  // What the springs of the base bore when the section was laid down on them.
  if (p_.has("matrix") && p_.has_foundation_under("base") && !p_.foundation.lifts_off &&
      (p_.has("gravity") || p_.has("surface pressure")))
    add_dead(continuum::boundary_traction(
                 solid_, {continuum::boundary::bottom},
                 [this](const Point<2> &x, const dealii::Tensor<1, 2> &normal)
                 { return -pressure_at(x[1]) * normal; }),
             loads);
  return loads;
}

/// On the top, or by a membrane on both faces of a bare layer.
void NonlinearSection::add_pressure(continuum::Loads &loads) const
{
  continuum::BoundaryIds faces{continuum::boundary::top};
  if (p_.has("membrane"))
    faces.insert(continuum::boundary::bottom);
  const double pressure =
      p_.has("membrane") ? p_.membrane.pressure : p_.pressure_on_top();
  if (p_.run.strain == "finite")
  {
    loads.pressures.emplace_back(solid_, faces, pressure);
    return;
  }
  add_dead(continuum::pressure(solid_, faces, pressure), loads);
}

continuum::Loads NonlinearSection::shortening_to(const double shortening) const
{
  continuum::Loads loads;
  loads.displacements = section_supports(p_, geometry_, solid_, shortening);
  return loads;
}

double NonlinearSection::rise(const Vector &displacement, const double x) const
{
  const double reach =
      0.5 * geometry_.length() / geometry_.n_columns() + 1e-9 * geometry_.length();
  double sum = 0., n = 0.;
  for (const auto dof : solid_.locally_owned())
    if (solid_.component(dof) == 1)
      if (const Point<2> place = solid_.support_point(dof);
          std::abs(place[0] - x) <= reach && is_in_layer(place, 1e-9))
      {
        sum += displacement(dof);
        n += 1.;
      }
  const MPI_Comm communicator = mesh_->get_communicator();
  return dealii::Utilities::MPI::sum(sum, communicator) /
         dealii::Utilities::MPI::sum(n, communicator);
}

Reading NonlinearSection::read(const Vector &displacement) const
{
  const MPI_Comm communicator = mesh_->get_communicator();
  const double small = 1e-9 * geometry_.length();
  const Vector &reactions = loaded_->reactions();
  double force = 0.;
  for (const auto dof : solid_.locally_owned())
    if (solid_.component(dof) == 0 &&
        solid_.support_point(dof)[0] < geometry_.x_min() + small)
      force += reactions(dof);
  double yielded = 0., area = 0., pressed = 0., beside_wall = 0.;
  const double first_column =
      geometry_.x_min() + geometry_.length() / geometry_.n_columns();
  for (const auto &point : solid_.point_states(displacement))
    if (point.material == layer_material_id)
    {
      yielded += point.plastic_strain > 0. ? point.area : 0.;
      area += point.area;
      const double of_wall = point.place[0] < first_column ? point.area : 0.;
      pressed -= of_wall * point.stress.xx;
      beside_wall += of_wall;
    }
  Reading reading;
  reading.wall_force = dealii::Utilities::MPI::sum(force, communicator);
  // Nodes between layer and matrix react for both; without a matrix the force is exact.
  pressed = dealii::Utilities::MPI::sum(pressed, communicator) /
            dealii::Utilities::MPI::sum(beside_wall, communicator);
  reading.axial_stress =
      p_.has("matrix") ? pressed : reading.wall_force / geometry_.thickness();
  const double half = 0.5 * geometry_.wavelength();
  reading.fold_amplitude = geometry_.amplitude() + rise(displacement, 0.) -
                           0.5 * (rise(displacement, -half) + rise(displacement, half));
  reading.plastic_share = dealii::Utilities::MPI::sum(yielded, communicator) /
                          dealii::Utilities::MPI::sum(area, communicator);
  if (base_)
  {
    reading.crest_height = geometry_.amplitude() + rise(displacement, 0.);
    reading.lifted_length = base_->support(displacement).lifted;
  }
  if (interface_)
  {
    double open = 0.;
    for (const auto &point : interface_->point_states(displacement))
      open += point.phase == continuum::ContactPhase::open ? point.length : 0.;
    reading.open_length = dealii::Utilities::MPI::sum(open, communicator);
    reading.relative_slip = interface_->relative_slip(displacement);
  }
  return reading;
}
} // namespace antiform::cases
