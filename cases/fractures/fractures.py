#!/usr/bin/python3
"""Fractures and beds: peak, cracks and limb dip against dip, spacing and friction.

    /usr/bin/python3 cases/fractures/fractures.py DIP SPACING [FRICTION] [--close CLOSE] [-o DIR]

Takes the directories of study-dip.prm, study-spacing.prm and, where run, of
study-friction.prm and study-close.prm; writes fractures.svg/.png (means over packings with their range) and the
table fractures.md. The limb dip is the steeper limb's where the run ended, at a shortening
of 0.3 %, less what the layer was laid down with.
"""
import argparse
import csv
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import save  # noqa: E402

LAID_DOWN = 7.46  # limb dip of a0 = h/2 in L = 12 h: atan(pi a0/L) [degrees]
FIGURES = [("peak_stress_Pa", 1e-6, 0., "peak stress  [MPa]"),
           ("crack_count", 1., 0., "cracks at the end"),
           ("limb_dip_deg", 1., LAID_DOWN, "limb dip gained  [degrees]")]


def rows_of(directory):
    with open(os.path.join(directory, "study.csv"), newline="") as file:
        return [row for row in csv.DictReader(file) if row["status"] == "completed"]


def grouped(rows, column):
    """Rows by the value of a column, in its order."""
    groups = {}
    for row in rows:
        groups.setdefault(float(row[column]), []).append(row)
    return dict(sorted(groups.items()))


def values(rows, figure):
    name, scale, origin = figure[:3]
    return np.array([float(row[name]) * scale - origin for row in rows])


def plot(axes, groups, figure, colour, marker, text, line="-"):
    x = list(groups)
    found = [values(rows, figure) for rows in groups.values()]
    mean = np.array([v.mean() for v in found])
    off = [mean - [v.min() for v in found], [v.max() for v in found] - mean]
    axes.errorbar(x, mean, yerr=off, color=colour, marker=marker, markersize=6,
                  markerfacecolor="white", markeredgewidth=1.5, linewidth=1.1,
                  linestyle=line, capsize=3, label=text)


def draw(dip, spacing, friction, close, directory):
    columns = 3 if friction else 2
    figure, axes = plt.subplots(3, columns, figsize=(0.6 + 3.8 * columns, 8.8),
                                sharex="col")
    left = 0.9 / (0.6 + 3.8 * columns)
    figure.subplots_adjust(left=left, right=0.985, top=0.87, bottom=0.07, hspace=0.1,
                           wspace=0.22)
    for row, what in enumerate(FIGURES):
        plot(axes[row, 0], grouped(dip, "orientation"), what, "#c0392b", "o", None)
        for (angle, rows), colour, marker in zip(
                grouped(spacing, "orientation").items(), ("#2e8b57", "#1f4fa8"), "Ds"):
            plot(axes[row, 1], grouped(rows, "spacing_ratio"), what, colour, marker,
                 f"dip {angle:g} degrees")
            fine = [one for one in close if float(one["orientation"]) == angle]
            if fine:
                plot(axes[row, 1], grouped(fine, "spacing_ratio"), what, colour, marker,
                     f"{angle:g}, 20 grains across", line=":")
        if friction:
            plot(axes[row, 2], grouped(friction, "friction"), what, "#762a83", "^", None)
        axes[row, 0].set_ylabel(what[3])
        for one in axes[row]:
            if what[0] != "limb_dip_deg":
                one.set_ylim(bottom=0.)
            one.grid(color="#e5e5e5", linewidth=0.6)
    axes[0, 1].legend(frameon=False, fontsize=8, loc="center right")
    axes[2, 0].set(xlabel="dip of the fractures  [degrees]", xticks=range(0, 91, 15))
    axes[2, 1].set(xlabel="spacing over thickness  [-]")
    titles = ["Dip, half a thickness apart", "Spacing", "Three beds in a membrane"]
    if friction:
        axes[2, 2].set(xlabel="friction between beds  [-]")
    for one, text in zip(axes[0], titles):
        one.set_title(text, fontsize=10.5, loc="left")
    figure.suptitle("Fractures weaken a layer where they slide, not where they cross it",
                    x=left, ha="left", fontsize=13, weight="bold", y=0.975)
    figure.text(left, 0.912, "Rock 1, L/h = 12, bent by h/2, shortened by 0.3 %. Healed "
                "fractures (c = 10 MPa,\n3 MPa in tension, 30 degrees). Mean and range of "
                "packings.", fontsize=9.5)
    save(figure, directory, "fractures")


def with_range(numbers, form):
    mean = form.format(numbers.mean())
    if len(numbers) == 1:
        return mean
    return f"{mean} ({form.format(numbers.min())} to {form.format(numbers.max())})"


def report(studies, directory):
    lines = []
    for title, rows, columns in studies:
        lines += ["| " + " | ".join(title) +
                  " | packings | peak, MPa | cracks in tension | in shear | limb dip gained, degrees"
                  " | ledger | CPU s |", "| --- " * (len(columns) + 7) + "|"]
        groups = {}
        for row in rows:
            groups.setdefault(tuple(float(row[c]) for c in columns), []).append(row)
        for key, of in sorted(groups.items()):
            peak, dip = values(of, FIGURES[0]), values(of, FIGURES[2])
            mean = {name: np.mean([float(row[name]) for row in of])
                    for name in ("cracks_tensile", "cracks_shear", "cpu_seconds")}
            ledger = max(float(row["energy_closure_error"]) for row in of)
            lines.append("| " + " | ".join(f"{k:g}" for k in key) +
                         f" | {len(of)} | {with_range(peak, '{:.1f}')}"
                         f" | {mean['cracks_tensile']:.0f} | {mean['cracks_shear']:.0f}"
                         f" | {with_range(dip, '{:+.1f}')}"
                         f" | {ledger:.0e} | {mean['cpu_seconds']:.0f} |")
        lines.append("")
    text = "\n".join(lines)
    with open(os.path.join(directory, "fractures.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("dip")
    parser.add_argument("spacing")
    parser.add_argument("friction", nargs="?")
    parser.add_argument("--close", help="of study-close.prm")
    parser.add_argument("-o", default=".", help="for the picture and the table")
    arguments = parser.parse_args()
    dip, spacing = rows_of(arguments.dip), rows_of(arguments.spacing)
    friction = rows_of(arguments.friction) if arguments.friction else []
    close = rows_of(arguments.close) if arguments.close else []
    os.makedirs(arguments.o, exist_ok=True)
    studies = [(["dip, degrees"], dip, ["orientation"]),
               (["dip, degrees", "spacing/h"], spacing,
                ["orientation", "spacing_ratio"])]
    if close:
        studies.append((["dip, degrees", "spacing/h, 20 grains across"], close,
                        ["orientation", "spacing_ratio"]))
    if friction:
        studies.append((["friction"], friction, ["friction"]))
    report(studies, arguments.o)
    draw(dip, spacing, friction, close, arguments.o)


if __name__ == "__main__":
    main()
