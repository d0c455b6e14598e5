#include "support/solid_fixtures.h"

#include <gtest/gtest.h>

#include <map>

namespace section_mesh_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
std::function<double(double)> flat(const double y)
{
  return [=](double) { return y; };
}

std::function<double(double)> wavy(const double y)
{
  return [=](const double x) { return y + 0.3 * std::sin(x); };
}

/// Length of the boundary by id, over all ranks.
std::map<unsigned int, double> boundary_lengths(const Triangulation &triangulation)
{
  std::map<unsigned int, double> lengths;
  for (unsigned int id = 0; id < 5; ++id)
  {
    double length = 0.;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == id)
            length += face->measure();
    lengths[id] = dealii::Utilities::MPI::sum(length, MPI_COMM_WORLD);
  }
  return lengths;
}
} // namespace

TEST(GradedRows, StartFineStaySoAndGrowToTheLargest)
{
  const double height = 100., cell = 1., uniform = 5., growth = 1.2, largest = 6.;
  const auto rows = graded_rows(height, cell, uniform, growth, largest, false);
  EXPECT_EQ(rows.front(), 0.);
  EXPECT_EQ(rows.back(), 1.);
  double former = 0., coarsest = 0.;
  for (std::size_t i = 1; i < rows.size(); ++i)
  {
    const double row = (rows[i] - rows[i - 1]) * height;
    if (i <= 5)
    {
      EXPECT_NEAR(row, cell, 1e-10);
    }
    else
    {
      EXPECT_LE(row, growth * former * (1. + 1e-10));
      EXPECT_GE(row, former * (1. - 1e-10));
    }
    EXPECT_LE(row, largest * (1. + 1e-10));
    coarsest = std::max(coarsest, row);
    former = row;
  }
  EXPECT_GT(coarsest, 5.);
}

TEST(GradedRows, AreMirroredWhenFineAtTheTop)
{
  const auto up = graded_rows(20., 1., 3., 1.3, 5., false),
             down = graded_rows(20., 1., 3., 1.3, 5., true);
  EXPECT_EQ(up.size(), down.size());
  for (std::size_t i = 0; i < std::min(up.size(), down.size()); ++i)
    EXPECT_NEAR(down[i], 1. - up[up.size() - 1 - i], 1e-14);
}

TEST(GradedRows, NeverExceedTheFirstHeightInAThinStrip)
{
  // 2.5 cells, less than the uniform part; and a rest too low for a row of its own.
  for (const double uniform : {10., 2., 0.})
  {
    const auto rows = graded_rows(2.5, 1., uniform, 1.2, 6., false);
    EXPECT_LE(rows[1] * 2.5, 1. + 1e-12) << uniform;
    EXPECT_EQ(rows.size(), 4u) << uniform; // three rows
  }
  EXPECT_EQ(graded_rows(0.4, 1., 0., 1.2, 6., false).size(), 2u);
}

TEST(GradedRows, RefuseNumbersWithoutSense)
{
  EXPECT_THROW(graded_rows(0., 1., 0., 1.2, 6., false), std::invalid_argument);
  EXPECT_THROW(graded_rows(1., 1., 0., 0.9, 6., false), std::invalid_argument);
  EXPECT_THROW(graded_rows(1., 1., 0., 1.2, 0.5, false), std::invalid_argument);
}

TEST(SectionMesh, JoinedStripsShareNodesAndSeparateOnesDoNot)
{
  const auto n_vertices = [](const bool joined)
  {
    Triangulation triangulation(MPI_COMM_WORLD);
    make_section(triangulation, 0., 6., 4,
                 {{flat(-2.), wavy(0.), even_rows(3), 0, false},
                  {wavy(0.), flat(2.), even_rows(2), 1, joined}});
    EXPECT_EQ(triangulation.n_global_active_cells(), 20u);
    return triangulation.n_vertices();
  };
  EXPECT_EQ(n_vertices(true), 5u * 6u);
  EXPECT_EQ(n_vertices(false), 5u * 7u);
}

TEST(SectionMesh, MarksSidesFacesAndGaps)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  make_section(triangulation, 1., 7., 4,
               {{flat(-3.), flat(-1.), even_rows(2), 0, false},
                {flat(-1.), flat(0.), even_rows(1), 1, true},
                {flat(0.5), flat(2.), even_rows(3), 2, false}});
  auto lengths = boundary_lengths(triangulation);
  EXPECT_NEAR(lengths[boundary::left], 4.5, 1e-12); // exact up to round-off
  EXPECT_NEAR(lengths[boundary::right], 4.5, 1e-12);
  EXPECT_NEAR(lengths[boundary::bottom], 6., 1e-12);
  EXPECT_NEAR(lengths[boundary::top], 6., 1e-12);
  EXPECT_NEAR(lengths[boundary::inner], 12., 1e-12);

  std::array<double, 3> areas{};
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      areas[cell->material_id()] += cell->measure();
  const std::array<double, 3> expected{{12., 6., 9.}};
  for (unsigned int m = 0; m < 3; ++m)
    EXPECT_NEAR(dealii::Utilities::MPI::sum(areas[m], MPI_COMM_WORLD), expected[m],
                1e-12);
}

TEST(SectionMesh, RefusesStripsThatCrossOrDoNotMeet)
{
  Triangulation triangulation(MPI_COMM_WORLD);
  const Strip base{flat(-2.), flat(0.), even_rows(2), 0, false};
  const auto refused = [&](const Strip &strip)
  {
    EXPECT_THROW(make_section(triangulation, 0., 6., 4, {base, strip}),
                 std::invalid_argument);
  };
  refused({wavy(0.), flat(2.), even_rows(2), 1, false});      // into the base
  refused({flat(0.1), flat(2.), even_rows(2), 1, true});      // joined across a gap
  refused({flat(0.), wavy(0.), even_rows(2), 1, true});       // upside down in part
  refused({flat(0.), flat(2.), {0., 0.5, 0.5, 1.}, 1, true}); // a row of no height
  EXPECT_EQ(triangulation.n_levels(), 0u);
}
} // namespace section_mesh_tests
