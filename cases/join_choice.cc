#include "cases/join_choice.h"

#include "cases/declarations.h"

namespace antiform::cases
{
namespace
{
std::string in_diameters(const double length, const Parameters &p)
{
  return short_text(length) + " m (" + short_text(length / p.grain_diameter()) + " d)";
}

struct Choice
{
  std::string join, why;
};

Choice by_thickness(const Parameters &p)
{
  const double h = p.layer.thickness, cover = p.matrix.burial_depth_ratio * h,
               base = p.matrix.base_depth_ratio * h, needed = room_of_overlap(p);
  const std::string overlap = "buffer, overlap and a row of cells, " +
                              in_diameters(needed, p);
  if (p.matrix.interface == "sliding" || p.matrix.interface == "frictional")
    return {"surface interface",
            "a " + p.matrix.interface + " interface needs no matrix grains"};
  if (!holds(base, needed))
    return {"surface interface",
            "the base of " + in_diameters(base, p) + " is thinner than " + overlap};
  const std::string of_cover = "the cover of " + in_diameters(cover, p);
  if (holds(cover, needed))
    return {"bridging domain", of_cover + " holds " + overlap};
  const std::string grains = short_text(thinnest_grain_cover) + " d, the least of grains";
  if (holds(cover, thinnest_grain_cover * p.grain_diameter()))
    return {"grain cover",
            of_cover + " is thinner than " + overlap + ", but not than " + grains};
  return {"surface interface", of_cover + " is thinner than " + grains};
}
} // namespace

double room_of_overlap(const Parameters &p)
{
  return (p.bridging.buffer + p.bridging.overlap + p.matrix.cell_size) *
         p.grain_diameter();
}

std::string join_in_words(const Parameters &p)
{
  return p.matrix.join + ", since " + p.matrix.why_join;
}

void choose_join(Parameters &p)
{
  if (p.matrix.join != "automatic")
    return;
  if (!p.joins_grains_and_mesh()) // then nothing asks for it
  {
    p.matrix.join = MatrixParameters().join;
    return;
  }
  const Choice choice = by_thickness(p);
  p.matrix.join = choice.join;
  p.matrix.why_join = choice.why;
  const double cell = p.matrix.cell_size * p.grain_diameter();
  if (p.has_surface_interface() && p.matrix.cover_rows == 0 &&
      !holds(p.matrix.burial_depth_ratio * p.layer.thickness, cell))
    p.matrix.cover_rows = 1;
}
} // namespace antiform::cases
