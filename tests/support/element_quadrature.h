#pragma once

#include <utility>

namespace antiform::discrete::test
{
/// Normal resultants of an element by quadrature of its stress: an open broken part
/// carries nothing. Knows nothing of the closed form; the end of the open part is found
/// by bisection, and the three-point Gauss rule is exact on either side of it.
struct QuadratureResult
{
  double force, moment, energy;
};
inline QuadratureResult element_by_quadrature(const double stiffness,
                                              const double gap,
                                              const double rotation,
                                              const double a,
                                              const double b,
                                              const bool bonded)
{
  using Real = long double;
  const auto opening = [&](const Real s) { return gap - rotation * s; };
  Real cut = b;
  if ((opening(a) < 0) != (opening(b) < 0))
  {
    Real low = a, high = b;
    for (int i = 0; i < 80; ++i)
    {
      const Real middle = (low + high) / 2;
      ((opening(middle) < 0) == (opening(a) < 0) ? low : high) = middle;
    }
    cut = low;
  }
  constexpr Real root = 0.774596669241483377035853079956L;
  const Real point[] = {-root, 0, root}, share[] = {5.L / 18, 8.L / 18, 5.L / 18};
  Real force = 0, moment = 0, energy = 0;
  for (const auto &[from, to] : {std::pair<Real, Real>(a, cut), {cut, Real(b)}})
    for (int q = 0; q < 3; ++q)
    {
      const Real s = (from + to) / 2 + point[q] * (to - from) / 2, g = opening(s);
      const Real stress = bonded || g < 0 ? stiffness * g : Real(0);
      force += share[q] * (to - from) * stress;
      moment += share[q] * (to - from) * stress * s;
      energy += share[q] * (to - from) * stress * g / 2;
    }
  return {static_cast<double>(force), static_cast<double>(moment),
          static_cast<double>(energy)};
}
} // namespace antiform::discrete::test
