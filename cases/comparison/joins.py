#!/usr/bin/python3
"""What joining grains and mesh costs: error of the critical stress and seconds.

    /usr/bin/python3 cases/comparison/joins.py ANTIFORM DIRECTORY

Buckling runs of buried.prm, its layer straight: the overlap, the surface interface and
finite elements throughout, against grains alone of the same packing. Three packings at
each contrast, and one at each depth of cover and base for the seconds, one run after the
other. Makes what is not in DIRECTORY yet, then writes joins.csv, joins.md and
joins.svg/.png.
"""
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, run, save, write_table  # noqa: E402

DECK = os.path.join(HERE, "buried.prm")
KINDS = {"grains": {"Matrix/Representation": "grains"},
         "overlap": {"Matrix/Join": "bridging domain"},
         "surface": {"Matrix/Join": "surface interface"},
         "continuum": {"Layer/Representation": "continuum", "Matrix/Element degree": 2}}
COLOURS = {"overlap": "#1f4fa8", "surface": "#c0392b", "continuum": "#888888",
           "grains": "black"}
CONTRASTS = (10., 20., 50., 100., 300., 1000., 1e4)
SEEDS = (1, 2, 3)
DEPTHS = (1., 2., 5., 10.)  # of cover and base, over h
MIDDLE = 100.  # contrast of the runs by depth


def one(arguments, kind, contrast, depth, seed):
    entries = {"Run/Driver": "buckling", "Layer/Shape": "straight", "Run/Modes": 1,
               "Matrix/Stiffness contrast": contrast, "Matrix/Burial depth ratio": depth,
               "Matrix/Base depth ratio": depth, "Layer/Seed": seed, **KINDS[kind]}
    name = f"{kind}-{contrast:g}-{depth:g}-{seed}"
    summary = run(arguments.antiform, os.path.join(arguments.directory, name), DECK, entries)
    if summary is None:
        sys.exit("a run failed, see above")
    return {"kind": kind, "contrast": contrast, "depth": depth, "seed": seed,
            "grains": summary["sizes"].get("grains", 0),
            "stress": summary["results"]["critical_stress"]["value"],
            "seconds": summary["cpu_seconds"]}


def compare(rows):
    """Error of each run against grains alone in the same scene."""
    key = [(row["contrast"], row["depth"], row["seed"]) for row in rows]
    alone = {k: row["stress"] for k, row in zip(key, rows) if row["kind"] == "grains"}
    for k, row in zip(key, rows):
        row["error"] = row["stress"] / alone[k] - 1.


def errors(rows, kind, contrast):
    return [row["error"] for row in rows if row["kind"] == kind
            and row["contrast"] == contrast and row["depth"] == 2.]


def table(rows):
    text = "| contrast | overlap | surface | continuum |\n| --- | --- | --- | --- |\n"
    for contrast in CONTRASTS:
        text += f"| {contrast:g} |"
        for kind in ("overlap", "surface", "continuum"):
            of = errors(rows, kind, contrast)
            text += f" {100. * min(of):+.2f} to {100. * max(of):+.2f} % |"
        text += "\n"
    text += "\n| cover and base | " + " | ".join(
        f"{kind}: grains, s" for kind in ("grains", "overlap", "surface")) + " |\n"
    text += "| --- | --- | --- | --- |\n"
    for depth in DEPTHS:
        text += f"| {depth:g} h |"
        for kind in ("grains", "overlap", "surface"):
            row = next(row for row in rows if row["kind"] == kind and row["depth"] == depth
                       and row["contrast"] == MIDDLE)
            text += f" {row['grains']:,}, {row['seconds']:.1f} |"
        text += "\n"
    return text


def draw(rows, directory):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.4, 4.6))
    figure.subplots_adjust(left=0.08, right=0.98, top=0.84, bottom=0.13, wspace=0.24)
    for kind in ("overlap", "surface", "continuum"):
        of = [errors(rows, kind, contrast) for contrast in CONTRASTS]
        left.fill_between(CONTRASTS, [100. * min(e) for e in of],
                          [100. * max(e) for e in of], color=COLOURS[kind], alpha=0.2)
        left.plot(CONTRASTS, [100. * sum(e) / len(e) for e in of], color=COLOURS[kind],
                  marker="o", label=kind)
    left.axhline(0., color="black", linewidth=0.8)
    left.set(xscale="log", xlabel="stiffness contrast E/E0 [-]",
             ylabel="error of the critical stress [%]")
    for kind in ("grains", "overlap", "surface"):
        of = [row for row in rows if row["kind"] == kind and row["contrast"] == MIDDLE
              and row["seed"] == SEEDS[0]]
        of.sort(key=lambda row: row["depth"])
        right.plot([row["depth"] for row in of], [row["seconds"] for row in of],
                   color=COLOURS[kind], marker="o",
                   label="grains alone" if kind == "grains" else kind)
    right.set(xscale="log", yscale="log", xlabel="cover and base over h [-]",
              ylabel="processor time of a run [s]")
    for axes in (left, right):
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(frameon=False, fontsize=10)
    figure.suptitle("Joining grains and mesh", x=0.08, ha="left", fontsize=13,
                    weight="bold", y=0.965)
    figure.text(0.08, 0.875, "Buckling of a cemented layer, 10 grains across, L/h = 16,"
                f" three packings; cover and base 2 h. Right: contrast {MIDDLE:g}.",
                fontsize=10)
    save(figure, directory, "joins")


def main():
    arguments = arguments_of(__doc__)
    scenes = [(contrast, 2., seed) for contrast in CONTRASTS for seed in SEEDS]
    scenes += [(MIDDLE, depth, SEEDS[0]) for depth in DEPTHS if depth != 2.]
    rows = [one(arguments, kind, *scene) for scene in scenes for kind in KINDS]
    compare(rows)
    write_table(rows, os.path.join(arguments.directory, "joins.csv"))
    with open(os.path.join(arguments.directory, "joins.md"), "w") as file:
        file.write(table(rows))
    print(table(rows))
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
