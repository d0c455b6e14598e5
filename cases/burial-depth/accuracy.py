#!/usr/bin/python3
"""What accuracy costs: error of the critical stress against seconds, Q1 and Q2 cells.

    /usr/bin/python3 cases/burial-depth/accuracy.py ANTIFORM DIRECTORY

Buckling runs of buckling.prm, two wavelengths long, in ever finer cells, one after the
other on one thread; makes what is not in DIRECTORY yet, then writes accuracy.csv,
accuracy.md and accuracy.svg/.png. Even cells, halved all over from run to run; and adaptive
ones, in more and more rounds of refinement from the coarsest, of which each run pays all.
Errors are against the load that the two finest meshes of even Q2 cells tend to (order 4).
"""
import math
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, run, save, write_table  # noqa: E402

DECK = os.path.join(HERE, "buckling.prm")
WAVE = 96.4  # wavelength over h
# Cells near the layer and columns, over h; far rows are a tenth of a wavelength at n = 2.
# Then rounds of refinement. Bilinear cells more than a fifth of h long are refused unless
# they are refined.
COARSEST = (1 / 2, WAVE / 8, 0.2 * WAVE)
MESHES = [(2, 1 / (2 * n), WAVE / (8 * n), 0.2 * WAVE / n, 0) for n in (1, 2, 4, 8)]
MESHES += [(1, 0.2 / n, 0.2 / n, 0.1 * WAVE, 0) for n in (1, 2)]
MESHES += [(2, *COARSEST, rounds) for rounds in (1, 2, 3, 4, 5, 6)]
MESHES += [(1, *COARSEST, rounds) for rounds in (4, 5, 6, 7, 8)]
REPEATS = 4  # of small runs, whose least time counts: others use the machine
SHARE = 0.8  # of the estimated error in the cells that a round refines
DEFAULT = (2, *COARSEST, 1)  # what the deck has


def one(antiform, directory, degree, cell, column, far, rounds):
    quarter = 4.  # cells of the deck are measured in h/4
    entries = {"Layer/Length ratio": 2. * WAVE, "Run/Modes": 1,
               "Matrix/Element degree": degree, "Matrix/Cell size ratio": cell * quarter,
               "Matrix/Cell aspect ratio": column / cell,
               "Matrix/Largest cell ratio": far * quarter,
               "Matrix/Refinement rounds": rounds, "Matrix/Refinement share": SHARE,
               "Title": f"Accuracy Q{degree} columns of {column:g} h, {rounds} rounds"}
    name = f"q{degree}-{column:.4g}" + (f"-rounds-{rounds}" if rounds else "")
    summary = run(antiform, os.path.join(directory, name), DECK, entries)
    if summary is None:
        sys.exit("a run failed, see above")
    seconds = [summary["cpu_seconds"]]
    while summary["sizes"]["dofs"] < 2e4 and len(seconds) < REPEATS:
        again = run(antiform, os.path.join(directory, f"{name}-again-{len(seconds)}"), DECK,
                    entries)
        seconds.append(again["cpu_seconds"])
    return {"degree": degree, "cell": cell, "column": column, "rounds": rounds,
            "dofs": summary["sizes"]["dofs"],
            "stress": summary["results"]["critical_stress"]["value"],
            "seconds": min(seconds)}


def knee_of(rows):
    """Of the best curve, no other run being both faster and nearer: the run furthest below
    the straight line between its ends, in logarithms."""
    best = [a for a in rows if a["error"] > 0. and not any(
        b["seconds"] < a["seconds"] and 0. < b["error"] < a["error"] for b in rows)]
    points = sorted((math.log(row["seconds"]), math.log(row["error"]), i)
                    for i, row in enumerate(rows) if row in best)
    (x0, y0, _), (x1, y1, _) = points[0], points[-1]
    below = [(y0 + (y1 - y0) * (x - x0) / (x1 - x0) - y, i) for x, y, i in points]
    return rows[max(below)[1]]


def is_default(row):
    return (row["degree"], row["column"], row["rounds"]) == (DEFAULT[0], DEFAULT[2],
                                                             DEFAULT[4])


def draw(rows, directory):
    figure, axes = plt.subplots(figsize=(7.6, 5.2))
    figure.subplots_adjust(left=0.12, right=0.96, top=0.86, bottom=0.12)
    for degree, colour, adaptive in ((2, "#1f4fa8", False), (2, "#1f4fa8", True),
                                     (1, "#c0392b", False), (1, "#c0392b", True)):
        of = [row for row in rows if row["degree"] == degree and row["error"] > 0.
              and (row["rounds"] > 0) == adaptive]
        axes.plot([row["seconds"] for row in of], [100. * row["error"] for row in of],
                  color=colour, marker="D" if adaptive else "o", markersize=6.5,
                  markerfacecolor=colour if adaptive else "white", markeredgewidth=1.6,
                  linestyle="--" if adaptive else "-",
                  label=f"Q{degree} cells, " + ("adaptive" if adaptive else "even"))
        for row in (of[0], of[-1]):
            axes.annotate(f"{row['dofs']:,.0f} dofs", (row["seconds"], 100. * row["error"]),
                          textcoords="offset points", fontsize=9,
                          xytext=(8, -13 if row is of[-1] and not adaptive else 4),
                          color=colour)
    deck, knee = next(row for row in rows if is_default(row)), knee_of(rows)
    axes.plot([deck["seconds"]], [100. * deck["error"]], marker="o", markersize=16,
              markerfacecolor="none", markeredgecolor="black", linestyle="none",
              label="the deck's cells" + (", the knee of the best curve"
                                          if deck is knee else ""))
    if deck is not knee:
        axes.plot([knee["seconds"]], [100. * knee["error"]], marker="o", markersize=16,
                  markerfacecolor="none", markeredgecolor="#888888", linestyle="none",
                  label="the knee of the best curve")
    axes.set(xscale="log", yscale="log", xlabel="processor time of the run [s]",
             ylabel="error of the critical stress [%]")
    axes.margins(x=0.25, y=0.12)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.legend(frameon=False, fontsize=10, loc="lower left")
    figure.suptitle("What accuracy costs", x=0.12, ha="left", fontsize=13, weight="bold",
                    y=0.965)
    figure.text(0.12, 0.885, "Buckling of a layer sliding in its matrix, E/E0 = 10000,"
                " H/h = 10, two waves long.", fontsize=10)
    save(figure, directory, "accuracy")


def main():
    arguments = arguments_of(__doc__)
    rows = [one(arguments.antiform, arguments.directory, *mesh) for mesh in MESHES]
    fine, finest = rows[2]["stress"], rows[3]["stress"]
    limit = finest + (finest - fine) / (2. ** 4 - 1.)
    for row in rows:
        row["error"] = row["stress"] / limit - 1.
    write_table(rows, os.path.join(arguments.directory, "accuracy.csv"))
    text = "| cells | of the layer (h) | columns (h) | rounds | dofs | error | s |\n"
    text += "| --- | --- | --- | --- | --- | --- | --- |\n"
    for row in rows:
        text += (f"| Q{row['degree']} | {row['cell']:.3g} | {row['column']:.3g}"
                 f" | {row['rounds']} | {row['dofs']:,} | {100. * row['error']:+.3f} %"
                 f" | {row['seconds']:.1f} |\n")
    with open(os.path.join(arguments.directory, "accuracy.md"), "w") as file:
        file.write(text)
    print(text)
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
