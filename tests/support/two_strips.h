#pragma once
// Two strips, one on the other without being joined, for the tests of contact.
#include "continuum/newton_solver.h"
#include "continuum/strip_contact.h"
#include "support/nonlinear_fixtures.h"

#include <memory>
#include <optional>

namespace antiform::testing
{
/// Over [0, length] x [-height, height], parted along the line y = dip (x - length / 2).
struct TwoStrips
{
  double length = 1., height = 1., dip = 0.;
  unsigned int n_columns = 4, n_rows = 2; ///< rows of a strip
  unsigned int degree = 1;
  Law law = make_law<continuum::LinearElastic>(1e9, 0.25);
  continuum::StripContact::Options contact;
  std::function<continuum::PointStress(const Point<2> &)> initial_stress;
};

/// The body, and its contact if it is given a law; else the strips are joined.
class TwoStripBody
{
public:
  TwoStripBody(const TwoStrips &form,
               const std::optional<continuum::ContactLaw> &law,
               const MPI_Comm communicator = MPI_COMM_WORLD)
      : form_(form)
      , triangulation_(communicator)
  {
    const auto level = [](const double y) { return [=](double) { return y; }; };
    const auto interface = [=](const double x)
    { return form.dip * (x - 0.5 * form.length); };
    continuum::make_section(
        triangulation_, 0., form.length, form.n_columns,
        {{level(-form.height), interface, even_rows(form.n_rows), 0, false},
         {interface, level(form.height), even_rows(form.n_rows), 0, !law.has_value()}});
    continuum::NonlinearSolid::Options options;
    options.degree = form.degree;
    options.initial_stress = form.initial_stress;
    solid_ = std::make_unique<continuum::NonlinearSolid>(
        triangulation_, std::vector<Law>{form.law}, options);
    if (!law)
      return;
    contact_ = std::make_shared<continuum::StripContact>(*solid_, *law, form.contact);
    solid_->add(contact_);
  }

  continuum::NonlinearSolid &solid() { return *solid_; }
  continuum::StripContact &contact() { return *contact_; }
  /// Values of field(place, component, is_upper) in all dofs known here; a node of the
  /// interface is there twice.
  template <class Field>
  continuum::Vector interpolate(const Field &field) const
  {
    auto u = solid_->make_vector();
    std::vector<dealii::types::global_dof_index> dofs(solid_->fe().n_dofs_per_cell());
    for (const auto &cell : solid_->dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        for (const auto dof : dofs)
          if (solid_->locally_owned().is_element(dof))
            u(dof) =
                field(solid_->support_point(dof), solid_->component(dof), is_upper(cell));
      }
    u.update_ghost_values();
    return u;
  }

  /// Sum of a component of nodal forces on the upper strip, of all ranks [N/m].
  double on_upper(const continuum::Vector &force, const unsigned int component) const
  {
    const auto upper =
        interpolate([&](const Point<2> &, const unsigned int c, const bool up)
                    { return up && c == component ? 1. : 0.; });
    return upper * force;
  }

private:
  template <class Cell>
  bool is_upper(const Cell &cell) const
  {
    const Point<2> middle = cell->center();
    return middle[1] > form_.dip * (middle[0] - 0.5 * form_.length);
  }

  TwoStrips form_;
  Triangulation triangulation_;
  std::unique_ptr<continuum::NonlinearSolid> solid_;
  std::shared_ptr<continuum::StripContact> contact_;
};
} // namespace antiform::testing
