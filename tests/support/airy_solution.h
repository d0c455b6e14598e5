#pragma once

#include "continuum/layer_theory.h"

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <array>
#include <utility>

/// Plain twin of the stiffnesses of continuum/layer_theory.h and bonded_theory.h: the
/// four unknowns of the Airy function (A cosh ky + B sinh ky + C ky cosh ky + F ky sinh
/// ky) cos kx of a layer 0 <= y <= H, from two conditions on each face. In 50 digits, so
/// that thin and deep layers lose none that matter.
namespace antiform::test
{
class AirySolution
{
public:
  using Real = boost::multiprecision::cpp_bin_float_50;

  AirySolution(const continuum::theory::Side &side, const double wavenumber)
      : side_(side)
      , k_(wavenumber)
      , nu_(side.poisson_ratio)
      , G_(Real(side.young_modulus) / (2 * (1 + nu_)))
  {
  }

  /// Pressure and shear of the face y = 0 that moves by V into the layer and by U along
  /// it.
  std::array<double, 2> bonded(const double V, const double U) const
  {
    const Rows near = at(0);
    return tractions(
        near, solve({near.normal_displacement, near.tangential_displacement}, {V, U}));
  }

  /// Pressure of a face without shear that moves by 1 into the layer.
  double smooth() const
  {
    const Rows near = at(0);
    return tractions(near, solve({near.normal_displacement, near.shear}, {1., 0.}))[0];
  }

private:
  using Row = std::array<Real, 4>;
  struct Rows
  {
    Row normal_stress, shear, normal_displacement, tangential_displacement;
  };

  Rows at(const Real &y) const
  {
    const Real z = k_ * y, c = cosh(z), s = sinh(z);
    const Row F{{c, s, z * c, z * s}},
        F1{{k_ * s, k_ * c, k_ * (c + z * s), k_ * (s + z * c)}},
        F2{{k_ * k_ * c, k_ * k_ * s, k_ * k_ * (2 * s + z * c),
            k_ * k_ * (2 * c + z * s)}},
        integral{{s / k_, c / k_, (z * s - c) / k_, (z * c - s) / k_}};
    Rows rows;
    for (unsigned int i = 0; i < 4; ++i)
    {
      rows.normal_stress[i] = -k_ * k_ * F[i];
      rows.shear[i] = k_ * F1[i];
      rows.normal_displacement[i] =
          (-(1 - nu_) * k_ * k_ * integral[i] - nu_ * F1[i]) / (2 * G_);
      rows.tangential_displacement[i] =
          ((1 - nu_) * F2[i] + nu_ * k_ * k_ * F[i]) / (2 * G_ * k_);
    }
    return rows;
  }

  /// The unknowns, from the rows and values of the near face and the side's far face.
  Row solve(const std::array<Row, 2> &near, const std::array<double, 2> &values) const
  {
    using FarFace = continuum::theory::Side::FarFace;
    const Rows far = at(Real(side_.thickness));
    Row normal = far.normal_displacement;
    if (side_.far_face == FarFace::free || side_.far_face == FarFace::spring)
      for (unsigned int i = 0; i < 4; ++i)
        normal[i] = far.normal_stress[i] + side_.far_spring * normal[i];
    const bool rough = side_.far_face == FarFace::rough_rigid;
    const Row &along = rough ? far.tangential_displacement : far.shear;
    std::array<std::array<Real, 5>, 4> A;
    for (unsigned int i = 0; i < 4; ++i)
    {
      A[0][i] = near[0][i];
      A[1][i] = near[1][i];
      A[2][i] = normal[i];
      A[3][i] = along[i];
    }
    A[0][4] = values[0];
    A[1][4] = values[1];
    A[2][4] = A[3][4] = 0;
    return eliminate(A);
  }

  /// Gauss and Jordan with pivots.
  static Row eliminate(std::array<std::array<Real, 5>, 4> A)
  {
    for (unsigned int column = 0; column < 4; ++column)
    {
      unsigned int pivot = column;
      for (unsigned int row = column; row < 4; ++row)
        if (abs(A[row][column]) > abs(A[pivot][column]))
          pivot = row;
      std::swap(A[column], A[pivot]);
      for (unsigned int row = 0; row < 4; ++row)
      {
        const Real factor = row == column ? Real(0) : A[row][column] / A[column][column];
        for (unsigned int i = column; i < 5; ++i)
          A[row][i] -= factor * A[column][i];
      }
    }
    Row solution;
    for (unsigned int i = 0; i < 4; ++i)
      solution[i] = A[i][4] / A[i][i];
    return solution;
  }

  std::array<double, 2> tractions(const Rows &near, const Row &unknowns) const
  {
    Real pressure = 0, shear = 0;
    for (unsigned int i = 0; i < 4; ++i)
    {
      pressure -= near.normal_stress[i] * unknowns[i];
      shear -= near.shear[i] * unknowns[i];
    }
    return {static_cast<double>(pressure), static_cast<double>(shear)};
  }

  continuum::theory::Side side_;
  Real k_, nu_, G_;
};
} // namespace antiform::test
