#!/usr/bin/python3
"""Crush or buckle: strength of a layer of yielding rock against its slenderness.

    /usr/bin/python3 cases/shortening/strength_sweep.py ANTIFORM DIRECTORY [--jobs N]

Runs strut.prm over slenderness ratios Lambda; makes what is not in DIRECTORY yet, then
writes strength_sweep.csv (a line a run), strength_sweep.md and strength_sweep.svg/.png:
the thesis' plot of the stress ratio gamma against Lambda with the computed strengths on
it. A layer buckles that has bent tenfold at its peak, else it crushes. Runs that stop where
the layer gives way have had their peak before and count. 14 runs took a minute on two cores.
"""
import csv
import math
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, rows_of, run, save, write_table  # noqa: E402

DECK = os.path.join(HERE, "strut.prm")
SLENDERNESS = [0.5, 0.7, 0.8, 0.9, 0.95, 1., 1.05, 1.1, 1.2, 1.5, 2., 2.5, 3., 4.]
MODULUS = 56e9 / (1. - 0.2 ** 2)  # E' of the deck
UCS = 2. * 36.06e6 * math.cos(math.radians(42.)) / (1. - math.sin(math.radians(42.)))
IMPERFECTION = 1e-3  # of the wave about its mean, over h


def first_yield(slenderness):
    """Perry and Robertson: stress ratio at which the inner arc yields."""
    euler = slenderness ** -2.
    # s (1 + 6 a / (1 - s / euler)) = 1
    b = 1. + euler * (1. + 6. * IMPERFECTION)
    return 0.5 * (b - math.sqrt(b * b - 4. * euler))


def one(antiform, directory, slenderness):
    """A line of the table; None where the run has no peak."""
    length = 2. * slenderness * math.pi * math.sqrt(MODULUS / (12. * UCS))
    strain = UCS / MODULUS * min(1., slenderness ** -2.)
    target = os.path.join(directory, f"lambda-{slenderness:g}")
    found = run(antiform, target, DECK,
                {"Layer/Length ratio": length,
                 # 24 columns or more: a third of h to three times h wide
                 "Matrix/Cell aspect ratio": max(1., 4. * length / 64.),
                 # Stout layers give way at once, slender ones bend on.
                 "Run/End shortening": (1.08 if slenderness < 1. else 1.4) * strain,
                 "Run/Load steps": 100,
                 "Title": f"Strut of yielding rock Lambda = {slenderness:g}"},
                may_give_way=True)
    if found is None:
        return None
    with open(os.path.join(target, "history.csv")) as file:
        stress = [float(row["axial_stress_Pa"]) for row in csv.DictReader(file)]
    result = {name: entry["value"] for name, entry in found["results"].items()}
    growth = result["fold_amplitude_at_peak"] / (2. * IMPERFECTION * 10.)
    return {"slenderness_ratio": slenderness, "length_ratio": length,
            "stress_ratio": result["peak_stress"] / UCS,
            "first_yield": first_yield(slenderness),
            "amplitude_growth": growth,
            "plastic_share_at_peak": result["plastic_share_at_peak"],
            # Grown tenfold: within 10 % of the Euler load.
            "mode": "buckles" if growth > 10. else "crushes",
            "stress_at_end_over_peak": stress[-1] / max(stress),
            "status": found["status"], "seconds": found["wall_seconds"]}


def draw(rows, directory):
    x = np.linspace(0.4, 4.2, 400)
    figure, axes = plt.subplots(figsize=(8.4, 5.6))
    figure.subplots_adjust(left=0.1, right=0.97, top=0.86, bottom=0.11)
    axes.plot(x[x <= 1.], np.ones(np.count_nonzero(x <= 1.)), color="black",
              linewidth=1.6)
    axes.plot(x[x >= 1.], x[x >= 1.] ** -2., color="black", linewidth=1.6,
              label=r"thesis' plot: crushes at $\gamma = 1$, buckles at $1/\Lambda^2$")
    axes.plot(x, [first_yield(v) for v in x], color="#7a7a7a", linewidth=1.2,
              linestyle="--", label="first yield of the inner arc (Perry and Robertson)")
    for mode, colour, marker in (("crushes", "#c0392b", "s"), ("buckles", "#1f4fa8", "o")):
        of = [row for row in rows if row["mode"] == mode]
        axes.plot([row["slenderness_ratio"] for row in of],
                  [row["stress_ratio"] for row in of], color=colour, marker=marker,
                  linestyle="none", markersize=7.5, markerfacecolor="white",
                  markeredgewidth=1.7, label=f"finite elements: {mode}")
    axes.axvspan(0.9, 1.1, color="#f0f0f0", zorder=0)
    axes.set(xlim=(0.4, 4.2), ylim=(0., 1.12),
             xlabel=r"slenderness ratio  $\Lambda = \lambda/\lambda_c$",
             ylabel=r"strength over UCS  $\gamma$")
    axes.legend(frameon=False, fontsize=10)
    figure.suptitle("A layer crushes or buckles", x=0.1, ha="left", fontsize=13,
                    weight="bold", y=0.965)
    figure.text(0.1, 0.885, "Mohr-Coulomb, UCS 162 MPa, bent beforehand by h/1000; finite"
                " strain, quadratic elements.", fontsize=10)
    save(figure, directory, "strength_sweep")


def report(rows, directory):
    lines = ["| Lambda | L/h | gamma | first yield | | wave grown, at the peak | layer yielded"
             " there | mode | s |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        lines.append(
            f"| {r['slenderness_ratio']:g} | {r['length_ratio']:.1f}"
            f" | {r['stress_ratio']:.4f} | {r['first_yield']:.4f}"
            f" | {100 * (r['stress_ratio'] / r['first_yield'] - 1):+.1f} %"
            f" | {r['amplitude_growth']:.1f} times"
            f" | {100 * r['plastic_share_at_peak']:.0f} % | {r['mode']} | {r['seconds']:.1f} |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "strength_sweep.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    arguments = arguments_of(__doc__)
    keys = [(value,) for value in SLENDERNESS]
    rows = rows_of(lambda *key: one(arguments.antiform, arguments.directory, *key), keys,
                   arguments.jobs)
    write_table(rows, os.path.join(arguments.directory, "strength_sweep.csv"))
    report(rows, arguments.directory)
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
