#pragma once

#include <cmath>

namespace antiform
{
/// A vector of the plane. Grains, joints, walls and polygons use it everywhere; the
/// continuum uses dealii::Point and coupling/conversion.h joins the two.
struct Vec2
{
  double x = 0.;
  double y = 0.;

  Vec2 &operator+=(const Vec2 &b)
  {
    x += b.x;
    y += b.y;
    return *this;
  }
};

inline Vec2 operator+(const Vec2 &a, const Vec2 &b)
{
  return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(const Vec2 &a, const Vec2 &b)
{
  return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator-(const Vec2 &a)
{
  return {-a.x, -a.y};
}
inline Vec2 operator*(const double s, const Vec2 &a)
{
  return {s * a.x, s * a.y};
}
inline double dot(const Vec2 &a, const Vec2 &b)
{
  return a.x * b.x + a.y * b.y;
}
/// z component of the cross product of two vectors of the plane.
inline double cross(const Vec2 &a, const Vec2 &b)
{
  return a.x * b.y - a.y * b.x;
}
/// The vector turned counter-clockwise by a right angle: z x a.
inline Vec2 perpendicular(const Vec2 &a)
{
  return {-a.y, a.x};
}
inline double norm(const Vec2 &a)
{
  return std::sqrt(dot(a, a));
}
/// The vector turned counter-clockwise by @p angle [rad].
inline Vec2 rotated(const Vec2 &a, const double angle)
{
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * a.x - s * a.y, s * a.x + c * a.y};
}
} // namespace antiform
