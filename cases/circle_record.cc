#include "cases/circle_record.h"

#include <cmath>
#include <sstream>

namespace antiform::cases
{
using coupling::Clock;
using coupling::Stage;

bool parse_points(const std::string &text, std::vector<Vec2> &points)
{
  points.clear();
  std::istringstream list(text);
  for (std::string one; std::getline(list, one, ';');)
  {
    std::istringstream numbers(one);
    Vec2 point;
    std::string more;
    if (!(numbers >> point.x >> point.y) || numbers >> more)
      return false;
    points.push_back(point);
  }
  return true;
}

std::vector<discrete::MeasurementCircle> measurement_circles(const Parameters &p,
                                                             const SectionGeometry &g)
{
  const MeasurementCirclesParameters &wanted = p.measurement_circles;
  const double radius = wanted.radius * g.diameter();
  std::vector<Vec2> centres;
  parse_points(wanted.centres, centres);
  if (centres.empty())
  {
    const int along =
        wanted.along > 0
            ? wanted.along
            : std::max(1, static_cast<int>(0.5 * g.length() / radius + 1e-9));
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < wanted.across; ++j)
      {
        const double x = g.x_min() + (i + 0.5) / along * g.length();
        centres.push_back(
            {x, g.axis(x) + ((j + 0.5) / wanted.across - 0.5) * g.thickness()});
      }
  }
  std::vector<discrete::MeasurementCircle> circles;
  for (const Vec2 &centre : centres)
    circles.push_back({centre, radius});
  return circles;
}

const std::vector<std::string> &CircleRecord::columns()
{
  static const std::vector<std::string> names{"step",
                                              "time_s",
                                              "shortening",
                                              "circle",
                                              "x_m",
                                              "y_m",
                                              "stress_xx_Pa",
                                              "stress_yy_Pa",
                                              "stress_xy_Pa",
                                              "strain_xx",
                                              "strain_yy",
                                              "strain_xy",
                                              "strain_rate_xx_per_s",
                                              "strain_rate_yy_per_s",
                                              "strain_rate_xy_per_s",
                                              "porosity",
                                              "coordination_number",
                                              "grains"};
  return names;
}

CircleRecord::CircleRecord(const Scene &scene,
                           const std::string &directory,
                           const bool resumed)
    : scene_(scene)
    , path_(directory + "/circles.csv")
    , circles_(measurement_circles(scene.parameters, scene.geometry))
{
  if (!resumed)
    table_.emplace(path_, columns());
}

void CircleRecord::run(const Stage, const Clock &clock)
{
  acted_ = clock.sample_due;
  if (!acted_)
    return;
  const coupling::GrainState &state = scene_.grains->state;
  const discrete::ForceCarriers carriers{
      &state.joints,
      &scene_.contacts,
      {&scene_.walls, &scene_.side_walls},
      scene_.grains->smooth ? &*scene_.grains->smooth : nullptr};
  for (std::size_t k = 0; k < circles_.size(); ++k)
  {
    const discrete::MeasurementCircle circle =
        discrete::follow(state.grains, circles_[k]);
    const discrete::CircleMeasure m = discrete::measure(state.grains, carriers, circle);
    table_->append(std::vector<double>{
        static_cast<double>(clock.step), clock.time, scene_.shortening(),
        static_cast<double>(k), circle.centre.x, circle.centre.y, m.stress.xx,
        m.stress.yy, m.stress.xy, m.strain.xx, m.strain.yy, m.strain.xy, m.strain_rate.xx,
        m.strain_rate.yy, m.strain_rate.xy, m.porosity, m.coordination_number,
        static_cast<double>(m.grains)});
  }
}

void CircleRecord::visit_state(coupling::StateArchive &archive)
{
  std::int64_t offset = table_ ? table_->offset() : 0;
  archive.value("circles/offset", offset);
  if (archive.is_loading())
    table_.emplace(coupling::Table::reopen(path_, columns(), offset));
}
} // namespace antiform::cases
