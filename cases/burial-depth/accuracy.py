#!/usr/bin/python3
"""What accuracy costs: error of the critical stress against seconds, Q1 and Q2 cells.

    /usr/bin/python3 cases/burial-depth/accuracy.py ANTIFORM DIRECTORY

Buckling runs of buckling.prm, two wavelengths long, in ever finer cells, one after the
other on one thread; makes what is not in DIRECTORY yet, then writes accuracy.csv,
accuracy.md and accuracy.svg/.png. Errors are against the load that the two finest meshes
of Q2 cells tend to (order 4). Bilinear cells more than a fifth of h long are refused by the
program, so their curve begins there.
"""
import argparse
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import run, write_table  # noqa: E402

DECK = os.path.join(HERE, "buckling.prm")
WAVE = 96.4  # wavelength over h
# Cells near the layer and columns, over h; far rows are a tenth of a wavelength at n = 2.
MESHES = [(2, 1 / (2 * n), WAVE / (8 * n), 0.2 * WAVE / n) for n in (1, 2, 4, 8)]
MESHES += [(1, 0.2 / n, 0.2 / n, 0.1 * WAVE) for n in (1, 2)]
DEFAULT = 1  # of MESHES: what the deck has


def one(antiform, directory, degree, cell, column, far):
    quarter = 4.  # cells of the deck are measured in h/4
    entries = {"Layer/Length ratio": 2. * WAVE, "Run/Modes": 1,
               "Matrix/Element degree": degree, "Matrix/Cell size ratio": cell * quarter,
               "Matrix/Cell aspect ratio": column / cell,
               "Matrix/Largest cell ratio": far * quarter,
               "Title": f"Accuracy Q{degree} columns of {column:g} h"}
    summary = run(antiform, os.path.join(directory, f"q{degree}-{column:.4g}"), DECK,
                  entries)
    if summary is None:
        sys.exit("a run failed, see above")
    return {"degree": degree, "cell": cell, "column": column,
            "dofs": summary["sizes"]["dofs"],
            "stress": summary["results"]["critical_stress"]["value"],
            "seconds": summary["cpu_seconds"]}


def draw(rows, directory):
    figure, axes = plt.subplots(figsize=(7.6, 5.2))
    figure.subplots_adjust(left=0.12, right=0.96, top=0.86, bottom=0.12)
    for degree, colour, marker in ((2, "#1f4fa8", "o"), (1, "#c0392b", "s")):
        of = [row for row in rows if row["degree"] == degree and row["error"] > 0.]
        axes.plot([row["seconds"] for row in of], [100. * row["error"] for row in of],
                  color=colour, marker=marker, markerfacecolor="white", markersize=7.5,
                  markeredgewidth=1.6, label=f"Q{degree} cells, even refinement")
        for row in of:
            axes.annotate(f"{row['dofs']:,.0f} dofs", (row["seconds"], 100. * row["error"]),
                          textcoords="offset points", xytext=(8, 4), fontsize=9,
                          color=colour)
    knee = rows[DEFAULT]
    axes.plot([knee["seconds"]], [100. * knee["error"]], marker="o", markersize=16,
              markerfacecolor="none", markeredgecolor="black", linestyle="none",
              label="the deck's cells: 16 columns a wave, 4 rows in the layer")
    axes.set(xscale="log", yscale="log", xlabel="processor time of the run [s]",
             ylabel="error of the critical stress [%]")
    axes.margins(x=0.25, y=0.12)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.legend(frameon=False, fontsize=10)
    figure.suptitle("What accuracy costs", x=0.12, ha="left", fontsize=13, weight="bold",
                    y=0.965)
    figure.text(0.12, 0.885, "Buckling of a layer sliding in its matrix, E/E0 = 10000,"
                " H/h = 10, two waves long.", fontsize=10)
    for suffix in ("svg", "png"):
        figure.savefig(os.path.join(directory, "accuracy." + suffix), dpi=130,
                       metadata={"Date": None} if suffix == "svg" else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("antiform", help="the program")
    parser.add_argument("directory", help="for the runs and the picture")
    arguments = parser.parse_args()
    os.makedirs(arguments.directory, exist_ok=True)
    rows = [one(arguments.antiform, arguments.directory, *mesh) for mesh in MESHES]
    fine, finest = rows[2]["stress"], rows[3]["stress"]
    limit = finest + (finest - fine) / (2. ** 4 - 1.)
    for row in rows:
        row["error"] = row["stress"] / limit - 1.
    write_table(rows, os.path.join(arguments.directory, "accuracy.csv"))
    text = "| cells | of the layer (h) | columns (h) | dofs | error | s |\n"
    text += "| --- | --- | --- | --- | --- | --- |\n"
    for row in rows:
        text += (f"| Q{row['degree']} | {row['cell']:.3g} | {row['column']:.3g}"
                 f" | {row['dofs']:,} | {100. * row['error']:+.3f} %"
                 f" | {row['seconds']:.1f} |\n")
    with open(os.path.join(arguments.directory, "accuracy.md"), "w") as file:
        file.write(text)
    print(text)
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
