#!/usr/bin/python3
"""May the coupled run be trusted? One breaking layer, grains everywhere and coupled.

    /usr/bin/python3 cases/comparison/trust.py ANTIFORM DIRECTORY [--depth 10]

Runs deep.prm with a cover and base of --depth times the layer's thickness: grains everywhere;
three widths of the overlap; the surface interface; and two runs that must be found out, one
without the constraint, one with a mesh of half the modulus. Writes trust.md, the differences
from grains everywhere and which are beyond what is allowed, and trust.svg/.png. What is there
is not run again. With --again grains everywhere, the default overlap and the surface interface
run twice, the second time between walls 2 % slower: what differs there is chance. The crack zone is judged at the peak; how a collapse
goes on is chaotic.
"""
import argparse
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from comparison_measures import measures, zone_distance  # noqa: E402
from run_files import Run  # noqa: E402
from study_runs import run as run_deck, save  # noqa: E402

DECK = os.path.join(HERE, "deep.prm")
REFERENCE = "grains"
RUNS = {  # name: entries
    REFERENCE: {"Matrix/Representation": "grains"},
    "surface": {"Matrix/Join": "surface interface"},
    "overlap 4 d": {},
    "no constraint": {"Bridging domain/Constraint": "false"},
    "half the modulus": {"Matrix/Mesh modulus ratio": "0.5"},
    "overlap 8 d": {"Bridging domain/Overlap width ratio": "8"},
    "overlap 12 d": {"Bridging domain/Overlap width ratio": "12"},
}
AGAIN = (REFERENCE, "overlap 4 d", "surface")  # once more with --again
SLOWER = {"Walls/Transits per millistrain": "204"}
CONTROLS = ("no constraint", "half the modulus")
LIMITS = {"stiffness": 0.03, "peak_stress": 0.05, "amplification": 0.05}
ZONE = 5.  # grain diameters
SAVING = {"overlap": (8., 6.), "surface": (15., 15.)}  # grains, CPU seconds; at a depth of 10
COLOURS = {REFERENCE: "black", "overlap 4 d": "#1f4fa8", "overlap 8 d": "#5b8def",
           "overlap 12 d": "#9dbcf5", "surface": "#c0392b", "no constraint": "#999999",
           "half the modulus": "#c9a227"}


def member(arguments, name):
    return os.path.join(arguments.directory, name.replace(" ", "-"))


def make(arguments, name, changes=None):
    """The run of that name; with @p changes of its entries, another beside it."""
    depth = {"Matrix/Burial depth ratio": arguments.depth,
             "Matrix/Base depth ratio": arguments.depth}
    directory = member(arguments, name + (" again" if changes else ""))
    if run_deck(arguments.antiform, directory, DECK,
                {**depth, **RUNS[name], **(changes or {})}) is None:
        sys.exit(f"trust.py: the run in {directory} failed.")
    print(f"{os.path.basename(directory)}: done", flush=True)
    return Run(directory)


def difference(values, reference, name):
    return values[name] / reference[name] - 1.


def row(name, run, reference_run, deep):
    last = min(run.last_loading(), reference_run.last_loading())
    values, reference = (measures(r, last) for r in (run, reference_run))
    cells, fails = [], []
    for key, limit in LIMITS.items():
        found = difference(values, reference, key)
        cells.append(f"{100. * found:+.1f} %")
        if abs(found) > limit:
            fails.append(key.replace("_", " "))
    zone = zone_distance(reference_run, run, up_to_peaks=True)
    for distance in (zone, zone_distance(reference_run, run)):
        cells.append("-" if distance is None else f"{distance:.1f} d")
    if zone is None or zone > ZONE:
        fails.append("crack zone")
    for k, key in enumerate(("grains", "cpu_seconds")):
        less = reference[key] / values[key]
        cells.append(f"{values[key]:.0f} ({less:.1f} times less)")
        wanted = next((s for kind, s in SAVING.items() if name.startswith(kind)), None)
        if deep and wanted and less < wanted[k]:
            fails.append(key.replace("_", " "))
    verdict = "within all limits" if not fails else "beyond: " + ", ".join(fails)
    if name in CONTROLS:
        verdict = f"control, {'found out' if fails else '**not found out**'}: " + verdict
    return f"| {name} | " + " | ".join(cells) + f" | {verdict} |"


def table(runs, deep):
    reference = runs[REFERENCE]
    values = measures(reference, reference.last_loading())
    lines = [f"Grains everywhere: {values['grains']:.0f} grains, "
             f"{values['cpu_seconds']:.0f} CPU seconds; stiffness "
             f"{1e-9 * values['stiffness']:.2f} GPa, peak {1e-6 * values['peak_stress']:.2f} "
             f"MPa at {1e3 * values['strain_at_peak']:.3f}e-3, growth of the fold at 80 % of it "
             f"{values['amplification']:.4f} m, {values['cracks_at_peak']:.0f} cracks at the "
             f"peak, {values['cracks_at_end']:.0f} at the end.", "",
             "| | stiffness | peak | growth of the fold | crack zone to the peak | to the end "
             "| grains | CPU s | |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    lines += [row(name, runs[name], reference, deep) for name in runs if name != REFERENCE]
    return "\n".join(lines) + "\n"


def table_of_chance(runs, again):
    """Each run against the same by slower walls."""
    lines = ["| against itself, walls 2 % slower | stiffness | peak | growth of the fold "
             "| crack zone to the peak | to the end |", "| --- | --- | --- | --- | --- | --- |"]
    for name, run in again.items():
        last = min(run.last_loading(), runs[name].last_loading())
        values, reference = (measures(r, last) for r in (run, runs[name]))
        cells = [f"{100. * difference(values, reference, key):+.1f} %" for key in LIMITS]
        cells += [f"{zone_distance(runs[name], run, up_to_peaks=until):.1f} d"
                  for until in (True, False)]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def draw(runs, arguments):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10., 3.8), layout="constrained")
    for name, run in runs.items():
        x, style = 1e3 * run.history["shortening"], "--" if name in CONTROLS else "-"
        width = 2.2 if name == REFERENCE else 1.2
        cracks = run.history["cracks_tensile"] + run.history["cracks_shear"]
        left.plot(x, 1e-6 * run.history["axial_stress_Pa"], style, color=COLOURS[name],
                  lw=width, label=name)
        right.plot(x, cracks, style, color=COLOURS[name], lw=width)
    left.set(xlabel="shortening (1e-3)", ylabel="axial stress of the layer (MPa)")
    right.set(xlabel="shortening (1e-3)", ylabel="broken joint elements")
    left.legend(frameon=False, fontsize=8)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(left=0.)
        axes.set_ylim(bottom=0.)
    figure.suptitle(f"One layer, H/h = {arguments.depth:g}: grains everywhere and coupled",
                    fontsize=11)
    save(figure, arguments.directory, "trust")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("antiform", help="the program")
    parser.add_argument("directory", help="for the runs and the picture")
    parser.add_argument("--depth", type=float, default=10., help="H/h, above and below")
    parser.add_argument("--again", action="store_true",
                        help="three runs once more, by walls 2 %% slower")
    arguments = parser.parse_args()
    os.makedirs(arguments.directory, exist_ok=True)
    runs = {name: make(arguments, name) for name in RUNS}
    text = table(runs, deep=arguments.depth >= 10.)
    if arguments.again:
        text += "\n" + table_of_chance(
            runs, {name: make(arguments, name, SLOWER) for name in AGAIN})
    with open(os.path.join(arguments.directory, "trust.md"), "w", encoding="utf-8") as out:
        out.write(text)
    print(text)
    draw(runs, arguments)


if __name__ == "__main__":
    main()
