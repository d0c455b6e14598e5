#include "continuum/section_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
namespace
{
using dealii::CellData;
using dealii::Point;

void require(const bool fine, const std::string &problem)
{
  if (!fine)
    throw std::invalid_argument("section mesh: " + problem);
}

/// Total height of @p n rows that grow from @p cell by @p growth, none above @p largest.
double height_of_rows(const unsigned int n,
                      const double cell,
                      const double growth,
                      const double largest)
{
  double sum = 0., row = cell;
  for (unsigned int i = 0; i < n; ++i)
  {
    row = std::min(row * growth, largest);
    sum += row;
  }
  return sum;
}

/// The growth in [1, growth] with which @p n rows fill @p height; the caller has made
/// sure that there is one.
double fitting_growth(const unsigned int n,
                      const double cell,
                      const double growth,
                      const double largest,
                      const double height)
{
  double low = 1., high = growth;
  for (unsigned int i = 0; i < 60; ++i)
  {
    const double middle = 0.5 * (low + high);
    (height_of_rows(n, cell, middle, largest) < height ? low : high) = middle;
  }
  return high;
}

/// Heights of the rows from the fine face on; their sum is @p height to round-off.
std::vector<double> row_heights(const double height,
                                const double cell,
                                const double uniform,
                                const double growth,
                                const double largest)
{
  constexpr double round_off = 1e-9;
  const auto n_uniform =
      static_cast<unsigned int>(std::max(1., std::ceil(uniform / cell - round_off)));
  const double rest = height - n_uniform * cell;
  if (rest <= round_off * height)
  {
    const auto n = std::max(1., std::ceil(height / cell - round_off));
    return std::vector<double>(static_cast<std::size_t>(n), height / n);
  }

  unsigned int n = 1;
  while (height_of_rows(n, cell, growth, largest) < rest * (1. - round_off))
    ++n;
  // Even rows of the first size may be too high together (rest below n cells): then all
  // rows shrink by the same ratio below.
  const double factor =
      n * cell < rest ? fitting_growth(n, cell, growth, largest, rest) : 1.;

  std::vector<double> rows(n_uniform, cell);
  double row = cell;
  for (unsigned int i = 0; i < n; ++i)
    rows.push_back(row = std::min(row * factor, largest));

  double sum = 0.;
  for (const double r : rows)
    sum += r;
  for (double &r : rows)
    r *= height / sum;
  return rows;
}

/// Vertices, cells and boundary lines of the section while it grows strip by strip.
class SectionBuilder
{
public:
  SectionBuilder(const double x_min, const double x_max, const unsigned int n_columns)
      : x_min_(x_min)
      , x_max_(x_max)
      , n_columns_(n_columns)
  {
  }

  void add(const Strip &strip, const std::string &name)
  {
    check(strip, name);
    const bool first = vertices_.empty();
    // The row of vertices on the last strip's upper face is the last one in the list.
    const auto last_row = static_cast<unsigned int>(vertices_.size()) - (n_columns_ + 1);
    const unsigned int start =
        strip.joined_to_previous ? last_row : static_cast<unsigned int>(vertices_.size());

    for (unsigned int r = strip.joined_to_previous ? 1 : 0; r < strip.rows.size(); ++r)
      for (unsigned int c = 0; c <= n_columns_; ++c)
        vertices_.push_back(place(strip, r, c));
    for (unsigned int r = 0; r + 1 < strip.rows.size(); ++r)
      add_row_of_cells(start + r * (n_columns_ + 1), strip.material);

    if (!strip.joined_to_previous)
    {
      if (!first)
        add_face(last_row, boundary::inner);
      add_face(start, first ? boundary::bottom : boundary::inner);
    }
  }

  void finish(dealii::parallel::distributed::Triangulation<2> &triangulation)
  {
    add_face(static_cast<unsigned int>(vertices_.size()) - (n_columns_ + 1),
             boundary::top);
    triangulation.create_triangulation(vertices_, cells_, lines_);
  }

private:
  double x(const unsigned int column) const
  {
    return column == n_columns_ ? x_max_
                                : x_min_ + (x_max_ - x_min_) * column / n_columns_;
  }

  static Point<2>
  between(const double x, const double lower, const double upper, const double fraction)
  {
    return Point<2>(x, fraction == 1. ? upper : lower + fraction * (upper - lower));
  }

  Point<2> place(const Strip &strip, const unsigned int row, const unsigned int c) const
  {
    return between(x(c), strip.lower(x(c)), strip.upper(x(c)), strip.rows[row]);
  }

  void check(const Strip &strip, const std::string &name) const
  {
    const auto &rows = strip.rows;
    require(rows.size() >= 2 && rows.front() == 0. && rows.back() == 1. &&
                std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) ==
                    rows.end(),
            name + ": row fractions must increase from exactly 0 to exactly 1.");
    require(!strip.joined_to_previous || !vertices_.empty(),
            name + " is the first one and cannot be joined to a previous one.");
    for (unsigned int c = 0; c <= n_columns_; ++c)
    {
      const double lower = strip.lower(x(c)), upper = strip.upper(x(c));
      if (!(upper > lower))
        refuse(name, "its height, which must be above 0, is", upper - lower, c);
      if (vertices_.empty())
        continue;
      const double gap = lower - vertices_[vertices_.size() - n_columns_ - 1 + c][1];
      const double tolerance = 1e-9 * (upper - lower);
      if (!(gap >= -tolerance))
        refuse(name, "it reaches into the strip below; their distance is", gap, c);
      if (strip.joined_to_previous && !(gap <= tolerance))
        refuse(name, "it is joined to the strip below, but their distance is", gap, c);
    }
  }

  [[noreturn]] void refuse(const std::string &name,
                           const char *problem,
                           const double metres,
                           const unsigned int column) const
  {
    std::ostringstream text;
    text << "section mesh: " << name << " at x = " << x(column) << " m: " << problem
         << ' ' << metres << " m.";
    throw std::invalid_argument(text.str());
  }

  void add_row_of_cells(const unsigned int start, const unsigned int material)
  {
    for (unsigned int c = 0; c < n_columns_; ++c)
    {
      CellData<2> cell;
      const unsigned int below = start + c, above = below + n_columns_ + 1;
      cell.vertices = {below, below + 1, above, above + 1};
      cell.material_id = material;
      cells_.push_back(cell);
    }
    add_line(start, start + n_columns_ + 1, boundary::left);
    add_line(start + n_columns_, start + 2 * n_columns_ + 1, boundary::right);
  }

  void add_face(const unsigned int start, const unsigned int id)
  {
    for (unsigned int c = 0; c < n_columns_; ++c)
      add_line(start + c, start + c + 1, id);
  }

  void add_line(const unsigned int a, const unsigned int b, const unsigned int id)
  {
    CellData<1> line;
    line.vertices = {a, b};
    line.boundary_id = id;
    lines_.boundary_lines.push_back(line);
  }

  double x_min_, x_max_;
  unsigned int n_columns_;
  std::vector<Point<2>> vertices_;
  std::vector<CellData<2>> cells_;
  dealii::SubCellData lines_;
};
} // namespace

std::vector<double> graded_rows(const double height,
                                const double cell,
                                const double uniform,
                                const double growth,
                                const double largest,
                                const bool fine_at_top)
{
  require(height > 0. && cell > 0., "height " + std::to_string(height) +
                                        " m and first row " + std::to_string(cell) +
                                        " m must be above 0.");
  require(uniform >= 0. && growth >= 1. && largest >= cell,
          "rows need uniform >= 0, growth >= 1 and largest >= cell; given " +
              std::to_string(uniform) + " m, " + std::to_string(growth) + ", " +
              std::to_string(largest) + " m (cell " + std::to_string(cell) + " m).");

  auto heights = row_heights(height, cell, uniform, growth, largest);
  if (fine_at_top)
    std::reverse(heights.begin(), heights.end());
  std::vector<double> fractions{0.};
  for (const double h : heights)
    fractions.push_back(fractions.back() + h / height);
  fractions.back() = 1.; // the sum is 1 to round-off
  return fractions;
}

void make_section(dealii::parallel::distributed::Triangulation<2> &triangulation,
                  const double x_min,
                  const double x_max,
                  const unsigned int n_columns,
                  const std::vector<Strip> &strips)
{
  require(x_max > x_min && n_columns > 0 && !strips.empty(),
          "needs x_max > x_min, a column and a strip.");
  SectionBuilder builder(x_min, x_max, n_columns);
  for (std::size_t i = 0; i < strips.size(); ++i)
    builder.add(strips[i], "strip " + std::to_string(i));
  builder.finish(triangulation);
}
} // namespace antiform::continuum
