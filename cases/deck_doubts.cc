#include "cases/deck_doubts.h"

#include "cases/formatted.h"
#include "cases/mechanism.h"

#include <algorithm>

namespace antiform::cases
{
namespace
{
/// Too few columns of cells for the waves in which a layer of finite elements should
/// buckle by the closed forms; empty: enough, or nothing buckles there. A mesh that
/// cannot show its wave finds another one, at a stress of its own.
std::string doubt_of_columns(const Parameters &p, const SectionGeometry &g)
{
  if (p.run.driver != "buckling" || !p.has_layer_mesh() || p.has("beds"))
    return "";
  // Refinement makes better what the first mesh shows, and that must show the wave.
  const bool refined = p.matrix.refinement_rounds > 0;
  const double fewest = refined ? 4. : 12., wanted = refined ? 8. : 16.;
  const unsigned int n =
      std::max(1u, supported_layer(p).critical_mode(g.length()).half_waves);
  const double columns = 2. * g.n_columns() / n; // a wavelength
  if (columns >= fewest)
    return "";
  const double aspect = p.matrix.cell_aspect * columns / wanted;
  const std::string remedy =
      aspect >= 1.
          ? formatted("Cell aspect ratio' = %.3g", aspect)
          : formatted("Cell size ratio' = %.3g and 'Matrix/Cell aspect ratio' = 1",
                      p.matrix.cell_size * aspect);
  return formatted(
      "%.3g columns of cells in each wavelength of %.4g m that the closed "
      "form expects: too few for a load to trust. Give 'Matrix/%s, for %.0f of "
      "them",
      columns, 2. * g.length() / n, remedy.c_str(), wanted);
}

/// Masses that are free to choose say nothing of vibrations, which do not die out of
/// themselves.
std::string doubt_of_damping(const Parameters &p)
{
  if (p.run.driver != "quasi-static" || p.follows_events() || p.has("damping"))
    return "";
  return "the quasi-static driver without damping: what the walls set in motion rings "
         "on, "
         "and forces do not come to balance. Add 'damping' to 'Components', or give "
         "'Run/Driver' = 'dynamic'";
}
} // namespace

std::vector<std::string> doubts_of(const Parameters &p, const SectionGeometry &g)
{
  std::vector<std::string> texts;
  for (const std::string &text : {doubt_of_columns(p, g), doubt_of_damping(p)})
    if (!text.empty())
      texts.push_back(text);
  return texts;
}
} // namespace antiform::cases
