// What a deck may say of a study.
#include "cases/declarations.h"

namespace antiform::cases
{
void declare(StudyParameters &study, Declarations &entries)
{
  entries.enter("Study");
  entries.text(
      "Vary", study.vary,
      "Entries and their values: `Section/Entry = 1, 2, 5`. A value may be a range, "
      "`1 to 5 in 9` (values, ends included), `0.01 to 100 in 9 logarithmic`, or "
      "`seeds 1 to 5`. `&` before an entry that changes with the one before it, `;` "
      "before one that is crossed with all before; braces around a value with commas.");
  entries.list("Collect", study.collect,
               "What study.csv has of each member's summary.json: names of its results, "
               "its other numbers (wall_seconds, steps, sizes/grains, energy/fracture), "
               "what 'antiform theory' says (theory/critical/scene_smooth/wavelength), "
               "or ratios of two (`critical_stress over theory_stress`). Empty: all "
               "results.");
  entries.whole("Most members", study.most_members,
                "A study of more is refused, before it fills a disk [-].",
                Number::between(1, 100000));
  entries.leave();
}
} // namespace antiform::cases
