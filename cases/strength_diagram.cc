#include "cases/strength_diagram.h"

#include "continuum/layer_theory.h"
#include "continuum/strut_theory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace antiform::cases
{
namespace theory = continuum::theory;

namespace
{
// Colours that stay apart for the colour-blind and on a grey print.
const std::string red = "#b2182b", blue = "#2166ac", violet = "#7b4fa3", grey = "#555555",
                  pale_red = "#fbeae6", pale_blue = "#e8f1f8", black = "#1a1a1a";

// The picture and the frame in it, in pixels; y runs downward.
constexpr double width = 900., height = 640.;
constexpr double left = 90., right = 810., top = 130., bottom = 555.;

std::string number(const double value, const char *format = "%.6g")
{
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// Around what stands below the line.
const std::string sub = "\x01", end_sub = "\x02";

std::string escaped(const std::string &text)
{
  std::string result;
  for (const char c : text)
    switch (c)
    {
    case '&':
      result += "&amp;";
      break;
    case '<':
      result += "&lt;";
      break;
    case '>':
      result += "&gt;";
      break;
    case '\x01':
      result += "<tspan font-size='75%' dy='4'>";
      break;
    case '\x02': // what follows is back on the line
      result += "</tspan><tspan dy='-4'>";
      break;
    default:
      result += c;
    }
  return text.find(end_sub) == std::string::npos ? result : result + "</tspan>";
}

/// The next of 1, 2, 2.5, 5 times a power of ten that cuts @p range into at most @p n.
double step_of_ticks(const double range, const int n)
{
  const double power = std::pow(10., std::floor(std::log10(range / n)));
  for (const double step : {1., 2., 2.5, 5.})
    if (step * power * n >= range * (1. - 1e-9))
      return step * power;
  return 10. * power;
}

struct Point
{
  double x, y;
};

/// Elements of the picture, one after the other.
class Svg
{
public:
  void line(const Point &a, const Point &b, const std::string &style)
  {
    out_ << "<line x1='" << number(a.x) << "' y1='" << number(a.y) << "' x2='"
         << number(b.x) << "' y2='" << number(b.y) << "' " << style << "/>\n";
  }
  void polyline(const std::vector<Point> &points, const std::string &style)
  {
    out_ << "<polyline points='";
    for (const Point &p : points)
      out_ << number(p.x) << ',' << number(p.y) << ' ';
    out_ << "' " << style << "/>\n";
  }
  void circle(const Point &centre, const double radius, const std::string &style)
  {
    out_ << "<circle cx='" << number(centre.x) << "' cy='" << number(centre.y) << "' r='"
         << number(radius) << "' " << style << "/>\n";
  }
  void text(const Point &place,
            const std::string &words,
            const std::string &anchor,
            const std::string &style = "",
            const double turned = 0.)
  {
    out_ << "<text x='" << number(place.x) << "' y='" << number(place.y)
         << "' text-anchor='" << anchor << "' ";
    if (turned != 0.)
      out_ << "transform='rotate(" << number(turned) << ' ' << number(place.x) << ' '
           << number(place.y) << ")' ";
    out_ << style << '>' << escaped(words) << "</text>\n";
  }

  std::string picture() const
  {
    return "<?xml version='1.0' encoding='UTF-8'?>\n"
           "<svg xmlns='http://www.w3.org/2000/svg' width='" +
           number(width) + "' height='" + number(height) + "' viewBox='0 0 " +
           number(width) + ' ' + number(height) +
           "' font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='14' "
           "fill='" +
           black + "'>\n<rect width='100%' height='100%' fill='white'/>\n" + out_.str() +
           "</svg>\n";
  }

private:
  std::ostringstream out_;
};

std::string stroke(const std::string &colour, const double width, const std::string &more)
{
  return "fill='none' stroke='" + colour + "' stroke-width='" + number(width) + "' " +
         more;
}

class Drawing
{
public:
  explicit Drawing(const StrengthDiagram &diagram)
      : d_(diagram)
      , y_max_(1.6 * diagram.failure_ratio)
  {
    double largest = 0.;
    for (const DiagramMark &mark : d_.marks)
    {
      largest = std::max(largest, mark.slenderness_ratio);
      y_max_ = std::max(y_max_, std::min(1.1 * mark.gamma, 3. * d_.failure_ratio));
    }
    x_max_ = std::max(4., 1.25 * largest);
    x_max_ =
        std::ceil(x_max_ / step_of_ticks(x_max_, 8) - 1e-9) * step_of_ticks(x_max_, 8);
  }

  std::string draw()
  {
    heading();
    regions();
    axes();
    curves();
    names_of_regions();
    marks();
    legend();
    return svg_.picture();
  }

private:
  double limit() const { return 1. / std::sqrt(d_.failure_ratio); } ///< Lambda_c
  Point at(const double x, const double y) const
  {
    return {left + x / x_max_ * (right - left), bottom - y / y_max_ * (bottom - top)};
  }

  void heading()
  {
    svg_.text({left, 34.}, d_.title, "start", "font-size='20' font-weight='bold'");
    svg_.text({left, 58.}, d_.subtitle, "start", "fill='" + grey + "'");
  }

  /// Buckling curve between two slenderness ratios.
  std::vector<Point> buckling(const double from, const double to) const
  {
    std::vector<Point> points;
    constexpr int n = 200;
    for (int i = 0; i <= n; ++i)
    {
      const double x = from * std::pow(to / from, i / double(n));
      points.push_back(at(x, theory::stress_ratio_at_buckling(x)));
    }
    return points;
  }

  void regions()
  {
    svg_.polyline({at(0., 0.), at(0., d_.failure_ratio), at(limit(), d_.failure_ratio),
                   at(limit(), 0.)},
                  "fill='" + pale_red + "'");
    std::vector<Point> folded = buckling(limit(), x_max_);
    folded.push_back(at(x_max_, d_.failure_ratio));
    svg_.polyline(folded, "fill='" + pale_blue + "'");
  }

  void axes()
  {
    const std::string thin = stroke(black, 1., ""), faint = stroke("#dddddd", 1., "");
    const double step_x = step_of_ticks(x_max_, 8), step_y = step_of_ticks(y_max_, 8);
    for (int i = 0; i * step_x <= x_max_ * (1. + 1e-9); ++i)
    {
      const Point p = at(i * step_x, 0.);
      svg_.line(p, {p.x, top}, faint);
      svg_.line(p, {p.x, p.y + 6.}, thin);
      svg_.text({p.x, p.y + 23.}, number(i * step_x, "%.4g"), "middle");
    }
    for (int i = 0; i * step_y <= y_max_ * (1. + 1e-9); ++i)
    {
      const Point p = at(0., i * step_y);
      svg_.line(p, {right, p.y}, faint);
      svg_.line(p, {p.x - 6., p.y}, thin);
      svg_.text({p.x - 10., p.y + 5.}, number(i * step_y, "%.4g"), "end");
    }
    svg_.polyline(
        {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}, thin);
    svg_.text({0.5 * (left + right), bottom + 52.},
              "slenderness ratio \u039b = \u03bb/\u03bb" + sub + "c" + end_sub + " (-)",
              "middle", "font-size='16'");
    svg_.text({left - 52., 0.5 * (top + bottom)},
              d_.failure_ratio > 1.
                  ? "stress ratio \u03b3 = (\u03c3\u2081 \u2212 p)/UCS (-)"
                  : "stress ratio \u03b3 = \u03c3\u2081/UCS (-)",
              "middle", "font-size='16'", -90.);
    if (d_.strength > 0.)
      axis_of_stress();
    if (d_.length_ratio > 0.)
      axis_of_length();
  }

  void axis_of_stress()
  {
    const double megapascals = 1e-6 * d_.strength,
                 step = step_of_ticks(y_max_ * megapascals, 8);
    for (int i = 0; i * step <= y_max_ * megapascals * (1. + 1e-9); ++i)
    {
      const Point p = at(x_max_, i * step / megapascals);
      svg_.line(p, {p.x + 6., p.y}, stroke(grey, 1., ""));
      svg_.text({p.x + 10., p.y + 5.}, number(i * step, "%.4g"), "start",
                "fill='" + grey + "'");
    }
    svg_.text({right + 62., 0.5 * (top + bottom)},
              d_.failure_ratio > 1. ? "\u03c3\u2081 \u2212 p (MPa)"
                                    : "axial stress \u03c3\u2081 (MPa)",
              "middle", "font-size='16' fill='" + grey + "'", 90.);
  }

  void axis_of_length()
  {
    const double range = x_max_ * d_.length_ratio, step = step_of_ticks(range, 8);
    for (int i = 0; i * step <= range * (1. + 1e-9); ++i)
    {
      const Point p = at(i * step / d_.length_ratio, y_max_);
      svg_.line(p, {p.x, p.y - 6.}, stroke(grey, 1., ""));
      svg_.text({p.x, p.y - 11.}, number(i * step, "%.4g"), "middle",
                "fill='" + grey + "'");
    }
    svg_.text({0.5 * (left + right), top - 33.}, "length over thickness L/h (-)",
              "middle", "font-size='16' fill='" + grey + "'");
  }

  void curves()
  {
    const double first = 1. / std::sqrt(y_max_); // there the curve enters the frame
    svg_.polyline(buckling(first, limit()), stroke(blue, 2., "stroke-dasharray='3 5'"));
    svg_.polyline(buckling(limit(), x_max_), stroke(blue, 3., ""));
    svg_.polyline({at(0., d_.failure_ratio), at(x_max_, d_.failure_ratio)},
                  stroke(red, 3., ""));
    svg_.line(at(limit(), 0.), at(limit(), d_.failure_ratio),
              stroke(grey, 1., "stroke-dasharray='6 4'"));
    if (d_.imperfection == 0.)
      return;
    std::vector<Point> bent;
    for (int i = 1; i <= 400; ++i)
    {
      const double x = x_max_ * i / 400.;
      bent.push_back(at(x, theory::perry_robertson(d_.failure_ratio,
                                                   theory::stress_ratio_at_buckling(x),
                                                   d_.imperfection)));
    }
    svg_.polyline(bent, stroke(violet, 2., "stroke-dasharray='9 4'"));
  }

  void names_of_regions()
  {
    const Point p = at(0.5 * limit(), 0.5 * d_.failure_ratio);
    const bool is_narrow = at(limit(), 0.).x - left < 150.;
    const std::string style = "font-style='italic' fill='" + red + "'";
    svg_.text({p.x + (is_narrow ? 5. : 0.), p.y}, "shear failure only", "middle", style,
              is_narrow ? -90. : 0.);
    svg_.text(at(0.5 * (limit() + x_max_), 0.88 * d_.failure_ratio),
              "buckling first, shear failure later", "middle",
              "font-style='italic' fill='" + blue + "'");
  }

  void marks()
  {
    for (const DiagramMark &mark : d_.marks)
    {
      const Point p = at(mark.slenderness_ratio, std::min(mark.gamma, y_max_));
      svg_.line(at(mark.slenderness_ratio, 0.), p,
                stroke(black, 1., "stroke-dasharray='2 3'"));
    }
    for (const DiagramMark &mark : d_.marks)
      symbol(mark, at(mark.slenderness_ratio, std::min(mark.gamma, y_max_)));
  }

  void symbol(const DiagramMark &mark, const Point &p)
  {
    svg_.circle(p, mark.filled ? 7. : 10.,
                mark.filled ? "fill='" + black + "' stroke='white' stroke-width='1.5'"
                            : stroke(black, 2., ""));
  }

  void legend()
  {
    constexpr double line_height = 21.;
    const double x = left + 0.36 * (right - left);
    double y = top + 22.;
    const auto entry = [&](const std::string &style, const std::string &text)
    {
      svg_.line({x, y - 5.}, {x + 34., y - 5.}, style);
      svg_.text({x + 44., y}, text, "start");
      y += line_height;
    };
    entry(stroke(red, 3., ""),
          d_.failure_ratio > 1.
              ? "failure under confinement, \u03b3 = " + number(d_.failure_ratio, "%.3g")
              : "shear failure, \u03b3 = 1");
    entry(stroke(blue, 3., ""), "buckling, \u03b3 = \u039b\u207b\u00b2 (ends that turn)");
    if (d_.imperfection > 0.)
      entry(stroke(violet, 2., "stroke-dasharray='9 4'"), d_.imperfection_label);
    for (const DiagramMark &mark : d_.marks)
    {
      symbol(mark, {x + 17., y - 5.});
      svg_.text({x + 44., y}, mark.label, "start");
      y += line_height;
    }
  }

  const StrengthDiagram &d_;
  double x_max_ = 0., y_max_;
  Svg svg_;
};
} // namespace

std::string draw(const StrengthDiagram &diagram)
{
  return Drawing(diagram).draw();
}
} // namespace antiform::cases
