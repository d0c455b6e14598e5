#include "discrete/fractures.h"

#include "discrete/packing.h"
#include "discrete/random.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace antiform::discrete
{
bool crosses(const Fracture &fracture, const Vec2 &a, const Vec2 &b)
{
  const Vec2 along = fracture.end - fracture.begin, branch = b - a;
  const double side_a = cross(along, a - fracture.begin);
  const double side_b = cross(along, b - fracture.begin);
  if ((side_a < 0.) == (side_b < 0.))
    return false;
  const double begin = cross(branch, fracture.begin - a);
  const double end = cross(branch, fracture.end - a);
  return (begin <= 0. && end >= 0.) || (begin >= 0. && end <= 0.);
}

Vec2 crossing(const Fracture &fracture, const Vec2 &a, const Vec2 &b)
{
  const Vec2 along = fracture.end - fracture.begin;
  const double side_a = cross(along, a - fracture.begin);
  const double side_b = cross(along, b - fracture.begin);
  return a + (side_a / (side_a - side_b)) * (b - a);
}

std::int32_t
crossed_by(const std::vector<Fracture> &fractures, const Vec2 &a, const Vec2 &b)
{
  for (std::size_t f = 0; f < fractures.size(); ++f)
    if (crosses(fractures[f], a, b))
      return static_cast<std::int32_t>(f);
  return -1;
}

namespace
{
/// Where, as shares of the way from @p a to @p b, the segment is inside the polygon:
/// entries and exits in turn.
std::vector<double>
spans_inside(const std::vector<Vec2> &polygon, const Vec2 &a, const Vec2 &b)
{
  std::vector<double> cuts = {0., 1.};
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Vec2 p = polygon[k], edge = polygon[(k + 1) % polygon.size()] - p;
    const double across = cross(b - a, edge);
    if (across == 0.)
      continue; // along the edge: whichever side it counts for has no area
    const double on_segment = cross(p - a, edge) / across;
    const double on_edge = cross(p - a, b - a) / across;
    if (on_segment > 0. && on_segment < 1. && on_edge >= 0. && on_edge < 1.)
      cuts.push_back(on_segment);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<double> spans;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
    if (contains(polygon, a + 0.5 * (cuts[k] + cuts[k + 1]) * (b - a)))
    {
      spans.push_back(cuts[k]);
      spans.push_back(cuts[k + 1]);
    }
  return spans;
}

double standard_normal(Random &random)
{
  // Box and Muller; 1 - u is never 0.
  const double u = 1. - random.uniform(), v = random.uniform();
  return std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * v);
}

double draw_length(const LengthDistribution &d, Random &random)
{
  using Form = LengthDistribution::Form;
  if (d.form == Form::constant)
    return d.mean;
  if (d.form == Form::power_law)
  {
    const double u = random.uniform(), one = 1. - d.exponent;
    if (std::abs(one) < 1e-12)
      return d.least * std::pow(d.largest / d.least, u);
    const double low = std::pow(d.least, one), high = std::pow(d.largest, one);
    return std::pow(low + u * (high - low), 1. / one);
  }
  for (int trial = 0; trial < 10000; ++trial)
  {
    double length = 0.;
    if (d.form == Form::exponential)
      length = -d.mean * std::log(1. - random.uniform());
    else
    {
      const double ratio = d.deviation / d.mean;
      const double variance = std::log1p(ratio * ratio);
      length = std::exp(std::log(d.mean) - 0.5 * variance +
                        std::sqrt(variance) * standard_normal(random));
    }
    if (length >= d.least && length <= d.largest)
      return length;
  }
  throw std::invalid_argument("the bounds leave next to nothing of the distribution of "
                              "fracture lengths");
}

double longest(const LengthDistribution &d)
{
  using Form = LengthDistribution::Form;
  return d.form == Form::constant      ? d.mean
         : d.form == Form::power_law   ? d.largest
         : d.form == Form::exponential ? std::min(d.largest, 5. * d.mean)
                                       : std::min(d.largest, d.mean + 3. * d.deviation);
}
} // namespace

double length_inside(const std::vector<Vec2> &polygon, const Vec2 &a, const Vec2 &b)
{
  double share = 0.;
  const std::vector<double> spans = spans_inside(polygon, a, b);
  for (std::size_t k = 0; k + 1 < spans.size(); k += 2)
    share += spans[k + 1] - spans[k];
  return share * norm(b - a);
}

std::vector<Fracture> draw_fractures(const std::vector<Vec2> &polygon,
                                     const FractureSet &set,
                                     const std::uint64_t seed)
{
  const LengthDistribution &d = set.length;
  if (d.form == LengthDistribution::Form::power_law &&
      !(d.least > 0. && d.largest < 1e300 && d.least < d.largest))
    throw std::invalid_argument("a power law of lengths needs two bounds above 0");
  if (d.form != LengthDistribution::Form::power_law && !(d.mean > 0.))
    throw std::invalid_argument("fractures need a mean length above 0");
  Vec2 low = polygon.front(), high = low;
  for (const Vec2 &p : polygon)
  {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double rim = 0.5 * longest(d);
  const double wanted = set.intensity * area(polygon);
  Random random(seed, 0x66726163); // "frac"
  std::vector<Fracture> fractures;
  double total = 0.;
  for (int missed = 0; total < wanted;)
  {
    const Vec2 centre{low.x - rim + random.uniform() * (high.x - low.x + 2. * rim),
                      low.y - rim + random.uniform() * (high.y - low.y + 2. * rim)};
    const double angle = set.orientation + set.angle_deviation * standard_normal(random);
    const double length = draw_length(d, random);
    const Vec2 half = (0.5 * length) * Vec2{std::cos(angle), std::sin(angle)};
    Fracture fracture{centre + -1. * half, centre + half, set.law};
    const std::vector<double> spans = spans_inside(polygon, fracture.begin, fracture.end);
    if (spans.empty())
    {
      if (++missed > 1000000)
        throw std::invalid_argument("fractures of this set do not meet the region");
      continue;
    }
    missed = 0;
    for (std::size_t k = 0; k + 1 < spans.size(); k += 2)
    {
      const double inside = (spans[k + 1] - spans[k]) * length;
      if (total + inside > wanted)
      {
        const double end = spans[k] + (wanted - total) / length;
        fracture.end = fracture.begin + end * (fracture.end - fracture.begin);
        total = wanted;
        break;
      }
      total += inside;
    }
    fractures.push_back(fracture);
  }
  return fractures;
}

std::vector<Fracture> parallel_fractures(const std::vector<Vec2> &polygon,
                                         const ParallelSet &set)
{
  const Vec2 along{std::cos(set.orientation), std::sin(set.orientation)};
  const Vec2 across = perpendicular(along);
  // Lines of the set are told by their distance from the origin, of which they have some
  // whole number of spacings and the phase.
  double nearest = 1e300, farthest = -1e300, reach = 0.;
  for (const Vec2 &p : polygon)
  {
    nearest = std::min(nearest, dot(p, across));
    farthest = std::max(farthest, dot(p, across));
    reach = std::max(reach, norm(p));
  }
  std::vector<Fracture> fractures;
  for (double k = std::ceil(nearest / set.spacing - set.phase);
       (k + set.phase) * set.spacing <= farthest; ++k)
  {
    const Vec2 middle = ((k + set.phase) * set.spacing) * across;
    const Vec2 begin = middle - 2. * reach * along, end = middle + 2. * reach * along;
    const std::vector<double> spans = spans_inside(polygon, begin, end);
    for (std::size_t s = 0; s + 1 < spans.size(); s += 2)
    {
      const Vec2 enters = begin + spans[s] * (end - begin);
      const Vec2 leaves = begin + spans[s + 1] * (end - begin);
      if (norm(leaves - enters) <= 1e-9 * reach)
        continue; // touches a vertex
      if (s > 0 && spans[s] - spans[s - 1] <= 1e-12)
        fractures.back().end = leaves; // passes one
      else
        fractures.push_back({enters, leaves, set.law});
    }
  }
  return fractures;
}
} // namespace antiform::discrete
