#include "cases/effects.h"

#include <stdexcept>

namespace antiform::cases
{
namespace
{
using State = Effect::State;

Effect choose(const std::string &name,
              const bool present,
              const std::string &why,
              const std::string &why_not)
{
  return {name, present ? State::present : State::absent, present ? why : why_not};
}

/// Effects that wait for the first broken bond.
Effect after_breakage(const Parameters &p,
                      const std::string &name,
                      const bool possible,
                      const std::string &what)
{
  if (p.run.driver == "buckling")
    return {name, State::absent, "the buckling driver is linear: bonds stay whole"};
  return {name, possible ? State::when_needed : State::absent,
          possible ? what + " from the first broken bond on"
                   : "no bond of this scene can break"};
}
} // namespace

std::vector<Effect> list_effects(const Parameters &p)
{
  const bool grains = p.layer.representation == "grains";
  const bool matrix = p.has("matrix");
  const bool mesh = !grains || (matrix && p.matrix.representation == "continuum");
  bool layer_breaks = false;
  for (int bed = 0; bed < p.n_beds(); ++bed)
    layer_breaks |= p.bed(bed).joint.breakable;
  const bool events = p.follows_events();
  const bool matrix_breaks = grains && matrix && !p.has_surface_interface() &&
                             p.matrix.breakable;
  const bool breakable = matrix_breaks || (grains && layer_breaks);
  const bool slips = grains && matrix && !p.has_surface_interface() &&
                     p.matrix.interface == "frictionless";
  const bool beside = grains && discrete::has_contact_beside(p.layer.law());
  const bool flat = (grains && p.layer.bond_model == "flat joint" && layer_breaks) ||
                    matrix_breaks;

  const std::string unbonded = "joints of the layer begin without bonds";
  const auto at_breakage = [&](const std::string &name, const std::string &what)
  {
    return p.has_unbonded_joints() ? Effect{name, State::present, unbonded}
                                   : after_breakage(p, name, breakable, what);
  };

  std::vector<Effect> list;
  list.push_back(choose("bonds", grains, "the layer is grains", "nothing is grains"));
  list.push_back(
      flat || !breakable
          ? at_breakage("friction", "broken elements close and slide")
          : Effect{"friction", State::absent,
                   "nothing is left of a broken bond but the grains' contact"});
  if (events)
    for (const std::string name : {"contacts", "search"})
      list.push_back({name, Effect::State::absent,
                      "the event driver knows joints and walls, no loose grains"});
  else if (beside)
  {
    const std::string why = "the grains' contacts act beside the parallel bonds";
    list.push_back({"contacts", State::present, why});
    list.push_back({"search", State::present, why});
  }
  else if (p.has_smooth_joints())
  {
    const std::string what = p.has("fractures") ? "fractures" : "beds";
    list.push_back({"contacts", State::present, "blocks between " + what + " may meet"});
    list.push_back({"search", State::present, "grains slide along " + what});
  }
  else if (slips)
  {
    list.push_back({"contacts", State::present, "layer and matrix may slide and part"});
    list.push_back({"search", State::present, "grains slide along the interface"});
  }
  else
  {
    list.push_back(at_breakage("contacts", "loose grains meet"));
    list.push_back(at_breakage("search", "loose grains move"));
  }
  list.push_back(choose("smooth joints", grains && p.has_smooth_joints(),
                        p.has("fractures") ? "fractures are listed in Components"
                                           : "beds slide on one another",
                        "no fractures are listed in Components, and no beds that slide"));
  list.push_back(choose("mesh", mesh, "the matrix is continuum",
                        "no part of the section is continuum"));
  list.push_back(choose("bridging domain", p.is_bridged() && p.bridging.constraint,
                        "grains and mesh overlap",
                        p.is_bridged() ? "'Bridging domain / Constraint' is false"
                        : p.has_surface_interface()
                            ? "grains and mesh meet without an overlap"
                            : "grains and mesh do not meet"));
  const bool joined = p.is_bridged() && p.bridging.constraint;
  list.push_back(choose("overlap damping", joined && p.bridging.damping > 0.,
                        "'Bridging domain / Overlap damping' is above 0",
                        joined ? "'Bridging domain / Overlap damping' is 0"
                               : "no bridging domain"));
  list.push_back(choose("sub-cycling", joined && p.bridging.sub_cycles > 1,
                        "'Bridging domain / Sub-cycles' is above 1",
                        joined ? "'Bridging domain / Sub-cycles' is 1"
                               : "no bridging domain"));
  list.push_back(choose("surface interface", p.has_surface_interface(),
                        "the mesh ends at the layer's outer grains: " +
                            p.matrix.interface,
                        p.is_bridged() ? "grains and mesh overlap"
                                       : "grains and mesh do not meet"));
  list.push_back(choose("foundation", p.has("foundation"), "listed in Components",
                        "not listed in Components"));
  list.push_back(choose("lift-off", p.has("foundation") && p.foundation.lifts_off,
                        "'Foundation / Lifts off' is true",
                        "no foundation that only pushes"));
  list.push_back(choose("absorbing boundary", p.has("absorbing boundary"),
                        "listed in Components", "not listed in Components"));
  list.push_back(choose("interface", p.has_mesh_contact(),
                        "layer and matrix of finite elements are not cemented",
                        "no finite elements slide on one another"));
  list.push_back(choose("refinement", mesh && p.matrix.refinement_rounds > 0,
                        "'Matrix / Refinement rounds' is above 0",
                        "no cells are refined"));
  list.push_back(choose(
      "base",
      grains && matrix && p.matrix.representation == "grains" && !p.has("foundation"),
      "base grains rest on a roller",
      !matrix ? "there is no matrix" : "the base is held by the mesh or the foundation"));
  for (const std::string name : {"gravity", "surface pressure", "walls", "damping"})
    list.push_back(
        choose(name, p.has(name),
               name == "walls" && p.bends() ? "listed in Components; they turn"
                                            : "listed in Components",
               "not listed in Components"));
  list.push_back(choose("servo walls", p.has("servo walls"), "listed in Components",
                        "not listed in Components"));
  list.push_back(choose("membrane", p.has("membrane"), "listed in Components",
                        "not listed in Components"));
  list.push_back(choose("prestress", p.has("gravity") || p.has("surface pressure"),
                        "gravity or surface pressure: the section was laid down under it",
                        "neither gravity nor surface pressure"));
  list.push_back(choose("finite strain", mesh && p.run.strain == "finite",
                        "'Run / Strain' is finite",
                        mesh ? "'Run / Strain' is small" : "nothing is finite elements"));
  const auto any = [&](const auto &is)
  {
    return (p.has_layer_mesh() && is(p.layer_material)) ||
           (p.has_matrix_mesh() && is(p.matrix_material));
  };
  list.push_back(choose("yielding", any([](const auto &m) { return m.yields(); }),
                        "finite elements of a plastic law",
                        "no finite elements have a plastic law"));
  list.push_back(choose("creep", any([](const auto &m) { return m.law == "Maxwell"; }),
                        "finite elements of a viscous law",
                        "no finite elements have a viscous law"));
  const bool steps = p.run.steps_in_time() && !events;
  const std::string no_steps = "the " + (events ? std::string("event") : p.run.driver) +
                               " driver takes no steps in time";
  list.push_back(choose("motion of the grains", grains && steps,
                        "the grains step in time",
                        grains ? no_steps : "nothing is grains"));
  list.push_back(choose("unbalanced force", steps,
                        "damping and the record of equilibrium need it", no_steps));
  list.push_back(choose("load steps", p.has("walls") && p.walls.steps_and_relaxes(),
                        "the walls wait for the forces to balance",
                        events ? no_steps : "walls at a constant rate, or none"));
  list.push_back(choose("event driver", events, "'Walls/Loading' asks for it",
                        "the walls move in time, or there are none"));
  list.push_back(
      choose("record", steps || events, "history, cracks and fields", "written after each solve"));
  list.push_back(choose("measurement circles", p.has("measurement circles"),
                        "listed in Components", "not listed in Components"));
  list.push_back(choose("density scaling", p.run.driver == "quasi-static" && !events,
                        "quasi-static driver: inertia is free to choose",
                        events ? no_steps
                               : "only the quasi-static driver may scale densities"));
  return list;
}

std::string reason_for(const Parameters &parameters, const std::string &effect)
{
  for (const Effect &one : list_effects(parameters))
    if (one.name == effect)
      return one.reason;
  throw std::logic_error("no effect is called " + effect);
}
} // namespace antiform::cases
