#include "continuum/error_indicator.h"

#include "continuum/by_place.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/fe/fe_interface_values.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>

namespace antiform::continuum
{
using namespace dealii;

namespace
{
using Cell = DoFHandler<2>::active_cell_iterator;

const UpdateFlags on_faces = update_values | update_gradients | update_quadrature_points |
                             update_normal_vectors | update_JxW_values;

std::array<double, 3> product(const ElasticMaterial &material,
                              const std::array<double, 3> &strain)
{
  std::array<double, 3> stress{};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      stress[i] += material.stiffness[i][j] * strain[j];
  return stress;
}

Tensor<2, 2> stress_of(const ElasticMaterial &material, const Tensor<2, 2> &gradient)
{
  const auto s = product(
      material, {gradient[0][0], gradient[1][1], gradient[0][1] + gradient[1][0]});
  Tensor<2, 2> stress;
  stress[0][0] = s[0];
  stress[1][1] = s[1];
  stress[0][1] = stress[1][0] = s[2];
  return stress;
}

/// Of the stress, from the second derivatives [component][place][place].
Tensor<1, 2> divergence(const ElasticMaterial &material, const Tensor<3, 2> &hessian)
{
  Tensor<1, 2> result;
  for (unsigned int k = 0; k < 2; ++k)
  {
    const auto along = product(material, {hessian[0][0][k], hessian[1][1][k],
                                          hessian[0][1][k] + hessian[1][0][k]});
    result[0] += along[k == 0 ? 0 : 2];
    result[1] += along[k == 0 ? 2 : 1];
  }
  return result;
}

/// Least eigenvalue of the plane stiffness in Mandel's notation: 2 mu of an isotropic
/// material with a Poisson's ratio >= 0 [Pa].
double least_stiffness(const ElasticMaterial &material)
{
  SymmetricTensor<2, 3> C;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j)
      C[i][j] = material.stiffness[i][j] * (i == 2 ? std::sqrt(2.) : 1.) *
                (j == 2 ? std::sqrt(2.) : 1.);
  return eigenvectors(C)[2].first; // eigenvalues() alone is only half as exact
}

/// Height of a cell across one of its faces [m].
double height(const Cell &cell, const unsigned int face)
{
  return cell->measure() / cell->face(face)->measure();
}

/// A quadrature point of a face that lies on another.
struct ContactPoint
{
  double x, y;
  double pressure; ///< n.P n [Pa]
  double height, stiffness;
  bool looks_up;

  template <class Archive>
  void serialize(Archive &archive, unsigned int)
  {
    archive &x &y &pressure &height &stiffness &looks_up;
  }
};

/// The residual of a solution, cell by cell.
class Residual
{
public:
  /// \param straight of a mode's body, whose stress times @p factor counts; null: none
  Residual(const ElasticSolid &solid,
           const Vector &displacement,
           const Vector *straight,
           const double factor,
           const Surroundings &surroundings)
      : solid_(solid)
      , displacement_(displacement)
      , straight_(straight)
      , factor_(factor)
      , surroundings_(surroundings)
      , held_(complete(solid, surroundings.displacements))
      , of_cell_(solid.fe(),
                 QGauss<2>(solid.degree() + 1),
                 update_gradients | update_hessians | update_quadrature_points |
                     update_JxW_values)
      , of_face_(solid.fe(), QGauss<1>(solid.degree() + 1), on_faces)
      , of_faces_(solid.fe(), QGauss<1>(solid.degree() + 1), on_faces)
  {
    for (const ElasticMaterial &material : solid.materials())
      stiffness_.push_back(least_stiffness(material));
    if (surroundings.slides)
      exchange_contact();
  }

  std::vector<double> squares()
  {
    std::vector<double> result;
    for (const auto &cell : solid_.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        double square = interior(cell);
        for (const unsigned int f : cell->face_indices())
          square += cell->at_boundary(f) ? outside(cell, f) : between(cell, f);
        result.push_back(square);
      }
    return result;
  }

private:
  const ElasticMaterial &material(const Cell &cell) const
  {
    return solid_.materials()[cell->material_id()];
  }
  double stiffness(const Cell &cell) const { return stiffness_[cell->material_id()]; }

  /// Stress at the points of a cell or face, with the straight section's part of a mode.
  std::vector<Tensor<2, 2>> stresses(const Cell &cell,
                                     const FEValuesBase<2> &values) const
  {
    std::vector<Tensor<2, 2>> gradients(values.n_quadrature_points), result;
    values[field_].get_function_gradients(displacement_, gradients);
    for (const auto &gradient : gradients)
      result.push_back(stress_of(material(cell), gradient));
    if (straight_ == nullptr)
      return result;
    std::vector<Tensor<2, 2>> straight(values.n_quadrature_points);
    values[field_].get_function_gradients(*straight_, straight);
    for (std::size_t q = 0; q < result.size(); ++q)
      result[q] += factor_ * gradients[q] * stress_of(material(cell), straight[q]);
    return result;
  }

  double interior(const Cell &cell)
  {
    of_cell_.reinit(cell);
    const unsigned int n = of_cell_.n_quadrature_points;
    const ElasticMaterial &law = material(cell);
    std::vector<Tensor<3, 2>> second(n), straight_second(n);
    std::vector<Tensor<2, 2>> first(n), straight_first(n);
    of_cell_[field_].get_function_hessians(displacement_, second);
    if (straight_ != nullptr)
    {
      of_cell_[field_].get_function_gradients(displacement_, first);
      of_cell_[field_].get_function_gradients(*straight_, straight_first);
      of_cell_[field_].get_function_hessians(*straight_, straight_second);
    }
    double sum = 0.;
    for (unsigned int q = 0; q < n; ++q)
    {
      Tensor<1, 2> rest = divergence(law, second[q]);
      if (straight_ != nullptr)
      {
        const auto S = stress_of(law, straight_first[q]);
        rest += factor_ * (first[q] * divergence(law, straight_second[q]));
        for (unsigned int i = 0; i < 2; ++i)
          rest[i] += factor_ * scalar_product(second[q][i], S);
      }
      else
      {
        rest += law.density * surroundings_.acceleration;
        if (surroundings_.body_force)
          rest += surroundings_.body_force(of_cell_.quadrature_point(q));
      }
      sum += rest.norm_square() * of_cell_.JxW(q);
    }
    const double least_height = std::min(height(cell, 0), height(cell, 2));
    return sum * std::pow(least_height / solid_.degree(), 2) / stiffness(cell);
  }

  /// Jumps to a neighbour, or to two that are smaller.
  double between(const Cell &cell, const unsigned int f)
  {
    constexpr unsigned int whole = numbers::invalid_unsigned_int;
    if (cell->neighbor_is_coarser(f))
    {
      const auto [face, part] = cell->neighbor_of_coarser_neighbor(f);
      return jump(cell, f, whole, cell->neighbor(f), face, part);
    }
    const unsigned int back = cell->neighbor_of_neighbor(f);
    if (!cell->neighbor(f)->has_children())
      return jump(cell, f, whole, cell->neighbor(f), back, whole);
    double sum = 0.;
    for (unsigned int part = 0; part < cell->face(f)->n_children(); ++part)
      sum += jump(cell, f, part, cell->neighbor_child_on_subface(f, part), back, whole);
    return sum;
  }

  double jump(const Cell &cell,
              const unsigned int face,
              const unsigned int part,
              const Cell &other,
              const unsigned int other_face,
              const unsigned int other_part)
  {
    of_faces_.reinit(cell, face, part, other, other_face, other_part);
    const auto here = stresses(cell, of_faces_.get_fe_face_values(0)),
               there = stresses(other, of_faces_.get_fe_face_values(1));
    double sum = 0.;
    for (unsigned int q = 0; q < here.size(); ++q)
      sum += ((here[q] - there[q]) * of_faces_.normal(q)).norm_square() *
             of_faces_.get_JxW_values()[q];
    const double h = 0.5 * (height(cell, face) + height(other, other_face));
    return sum * h / (solid_.degree() * (stiffness(cell) + stiffness(other)));
  }

  /// Whether a component of a face's displacement is prescribed.
  std::array<bool, 2> held(const Cell &cell, const unsigned int f) const
  {
    std::vector<types::global_dof_index> dofs(solid_.fe().n_dofs_per_face());
    cell->face(f)->get_dof_indices(dofs);
    std::array<bool, 2> result{true, true};
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (held_.count(dofs[i]) == 0)
        result[solid_.fe().face_system_to_component_index(i, f).first] = false;
    return result;
  }

  /// Traction on a boundary from outside, at a point of of_face_.
  Tensor<1, 2> load(const types::boundary_id id,
                    const unsigned int q,
                    const Tensor<1, 2> &displacement) const
  {
    const Tensor<1, 2> &n = of_face_.normal_vector(q);
    Tensor<1, 2> t;
    if (surroundings_.traction && straight_ == nullptr)
      t = surroundings_.traction(id, of_face_.quadrature_point(q), n);
    if (surroundings_.sprung.count(id) > 0)
      t -= surroundings_.spring_stiffness * (displacement * n) * n;
    return t;
  }

  double outside(const Cell &cell, const unsigned int f)
  {
    of_face_.reinit(cell, f);
    const auto id = cell->face(f)->boundary_id();
    const auto stress = stresses(cell, of_face_);
    std::vector<Tensor<1, 2>> displacements(stress.size());
    of_face_[field_].get_function_values(displacement_, displacements);
    const auto is_held = held(cell, f);
    double sum = 0.;
    for (unsigned int q = 0; q < stress.size(); ++q)
    {
      const Tensor<1, 2> &n = of_face_.normal_vector(q);
      const Tensor<1, 2> rest = stress[q] * n - load(id, q, displacements[q]);
      double h = height(cell, f), C = stiffness(cell);
      const ContactPoint *const other =
          surroundings_.slides && id == boundary::inner ? facing(cell, q) : nullptr;
      if (other != nullptr)
      {
        const double across = rest * n;
        sum += (rest - across * n).norm_square() * of_face_.JxW(q) * h / C;
        h = 0.5 * (h + other->height);
        C += other->stiffness;
        sum += std::pow(across - other->pressure, 2) * of_face_.JxW(q) * h / C;
        continue;
      }
      for (unsigned int c = 0; c < 2; ++c)
        if (!is_held[c])
          sum += rest[c] * rest[c] * of_face_.JxW(q) * h / C;
    }
    return sum / solid_.degree();
  }

  /// The point of the other part at one of of_face_; null where there is a gap.
  const ContactPoint *facing(const Cell &cell, const unsigned int q) const
  {
    const Point<2> &place = of_face_.quadrature_point(q);
    return at_place(contact_[of_face_.normal_vector(q)[1] > 0. ? 0 : 1], place[0],
                    place[1], same_place * cell->minimum_vertex_distance());
  }

  /// Pressures on inner faces, of all ranks.
  void exchange_contact()
  {
    std::vector<ContactPoint> own;
    for (const auto &cell : solid_.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) && cell->face(f)->boundary_id() == boundary::inner)
          {
            of_face_.reinit(cell, f);
            const auto stress = stresses(cell, of_face_);
            for (unsigned int q = 0; q < stress.size(); ++q)
            {
              const Point<2> &place = of_face_.quadrature_point(q);
              const Tensor<1, 2> &n = of_face_.normal_vector(q);
              own.push_back({place[0], place[1], n * (stress[q] * n), height(cell, f),
                             stiffness(cell), n[1] > 0.});
            }
          }
    for (const auto &part :
         Utilities::MPI::all_gather(solid_.dof_handler().get_communicator(), own))
      for (const ContactPoint &point : part)
        contact_[point.looks_up ? 1 : 0].push_back(point);
    for (auto &side : contact_)
      sort_by_place(side);
  }

  const ElasticSolid &solid_;
  const Vector &displacement_;
  const Vector *straight_;
  double factor_;
  const Surroundings &surroundings_;
  DirichletValues held_;
  FEValues<2> of_cell_;
  FEFaceValues<2> of_face_;
  FEInterfaceValues<2> of_faces_;
  const FEValuesExtractors::Vector field_{0};
  std::vector<double> stiffness_;        ///< of the materials
  std::vector<ContactPoint> contact_[2]; ///< on faces that look down, up; by place
};
} // namespace

std::vector<double> error_indicators(const ElasticSolid &solid,
                                     const Vector &displacement,
                                     const Surroundings &surroundings)
{
  return Residual(solid, displacement, nullptr, 0., surroundings).squares();
}

std::vector<double> error_indicators(const ElasticSolid &solid,
                                     const Vector &straight,
                                     const BucklingMode &mode,
                                     const Surroundings &surroundings)
{
  auto squares =
      Residual(solid, mode.shape, &straight, mode.load_factor, surroundings).squares();
  const double size = 2. * solid.strain_energy(mode.shape);
  for (double &square : squares)
    square /= size;
  return squares;
}
} // namespace antiform::continuum
