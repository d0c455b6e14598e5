#!/usr/bin/python3
"""Confinement of layers of grains: peaks and cracks under 0 to 50 MPa, three ways.

    /usr/bin/python3 cases/confinement/grains.py --rigid DIR --stout DIR --matrix DIR
        [--membrane DIR] [-o DIR]

Takes the directories of the studies here of those names; writes confinement_grains.svg/.png
and the table confinement_grains.md. Lines of theory: the rock's own strength, UCS + N p by
least squares through the peaks of the straight piece in its membrane; of bent layers that
at which their inner arc, under (sigma_1 - p)(1 + 6 e/h g) + p, has this strength (Perry and
Robertson), with the wave's growth g = 1/(1 - (sigma_1 - p)/sigma_E). Nothing is fitted to
them.
"""
import argparse
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
from study_runs import save  # noqa: E402

MODULUS = 56e9      # E of rock 1, plane stress as disks have it [Pa]
ECCENTRICITY = 0.25  # of a wave of h/2 about its mean, over h
LENGTHS = {"membrane": 12.}  # L/h of bent layers in a membrane
WAYS = {"rigid": ("straight, rigid walls", "#7f7f7f", "s"),
        "stout": ("straight, membrane", "#c0392b", "o"),
        "matrix": ("bent, L/h = 12, matrix", "#2e8b57", "D"),
        "membrane": ("bent, L/h = 12, membrane", "#1f4fa8", "^")}


def euler(length_ratio):
    """Between walls that keep the ends from turning [Pa]."""
    return math.pi ** 2 * MODULUS / 12. * (2. / length_ratio) ** 2


def curve(directory):
    """Pressure and peak [MPa], cracks in tension and shear of a study's members."""
    with open(os.path.join(directory, "study.csv"), newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["status"] == "completed"]
    rows.sort(key=lambda row: float(row["pressure_Pa"]))
    return {"p": np.array([float(row["pressure_Pa"]) for row in rows]) / 1e6,
            "peak": np.array([float(row["peak_stress_Pa"]) for row in rows]) / 1e6,
            "tension": np.array([float(row["cracks_tensile"]) for row in rows]),
            "shear": np.array([float(row["cracks_shear"]) for row in rows]),
            "rows": rows}


def bent_strength(p, line, length_ratio):
    """Peak of a bent layer whose inner arc fails at the rock's strength [MPa]."""
    limit = euler(length_ratio) / 1e6
    strength = np.polyval(line, p) - p  # of sigma_1 - p at a point
    low, high = np.zeros_like(p), np.full_like(p, limit * (1. - 1e-9))
    for _ in range(80):
        y = 0.5 * (low + high)
        fails = y * (1. + 6. * ECCENTRICITY / (1. - y / limit)) > strength
        low, high = np.where(fails, low, y), np.where(fails, y, high)
    return p + low


def draw(curves, line, directory):
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.6, 5.4))
    figure.subplots_adjust(left=0.07, right=0.985, top=0.8, bottom=0.11, wspace=0.2)
    p = np.linspace(0., 52., 120)
    left.plot(p, np.polyval(line, p), color="#c0392b", linewidth=1.3)
    for way, length in LENGTHS.items():
        left.plot(p, bent_strength(p, line, length), color=WAYS[way][1], linewidth=1.3)
    for way, of in curves.items():
        text, colour, marker = WAYS[way]
        style = dict(color=colour, marker=marker, markersize=7, markerfacecolor="white",
                     markeredgewidth=1.6, label=text)
        left.plot(of["p"], of["peak"], linestyle="none", **style)
        share = of["tension"] / np.maximum(1., of["tension"] + of["shear"])
        right.plot(of["p"], 100. * share, linewidth=1.1, **style)
    left.set(xlim=(-1., 52.), ylim=(0., None), xlabel="confining pressure  p  [MPa]",
             ylabel=r"peak of the axial stress  $\sigma_1$  [MPa]")
    right.set(xlim=(-1., 52.), ylim=(0., 105.), xlabel="confining pressure  p  [MPa]",
              ylabel="share of cracks in tension  [%]")
    right.legend(frameon=False, fontsize=9.5, loc="lower left")
    figure.suptitle("Pressure makes a layer stronger, and makes it shear where it split",
                    x=0.07, ha="left", fontsize=13, weight="bold", y=0.965)
    figure.text(0.07, 0.835, "Rock 1, grains. Red line: UCS + N p through the straight "
                "piece's strengths in its membrane; other lines: the inner arc of a bent "
                "layer without matrix\nhas that strength, nothing fitted. Where there is "
                "no peak up to a shortening of 0.6 %: the stress there.", fontsize=9.5)
    save(figure, directory, "confinement_grains")


def report(curves, line, directory):
    lines = ["| | p, MPa | peak, MPa | peak - p | line | cracks in tension | in shear "
             "| limb dip | ledger | CPU s |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for way, of in curves.items():
        theory = np.polyval(line, of["p"])
        if way in LENGTHS:
            theory = bent_strength(of["p"], line, LENGTHS[way])
        for k, row in enumerate(of["rows"]):
            text = f"{theory[k]:.0f}" if way != "matrix" else ""
            dip = f"{float(row['limb_dip_deg']):.1f}" if "bent" in WAYS[way][0] else ""
            lines.append(
                f"| {WAYS[way][0]} | {of['p'][k]:g} | {of['peak'][k]:.1f}"
                f" | {of['peak'][k] - of['p'][k]:.1f} | {text} | {of['tension'][k]:.0f}"
                f" | {of['shear'][k]:.0f} | {dip}"
                f" | {float(row['energy_closure_error']):.1e}"
                f" | {float(row['cpu_seconds']):.0f} |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "confinement_grains.md"), "w") as file:
        file.write(text)
    print(text)
    print(f"straight in the membrane: {line[1]:.0f} MPa + {line[0]:.2f} p")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for way in WAYS:
        parser.add_argument(f"--{way}", metavar="DIR", required=way not in LENGTHS,
                            help=f"of study-{way}.prm")
    parser.add_argument("-o", default=".", help="for the picture and the table")
    arguments = parser.parse_args()
    curves = {way: curve(getattr(arguments, way)) for way in WAYS
              if getattr(arguments, way) is not None}
    line = np.polyfit(curves["stout"]["p"], curves["stout"]["peak"], 1)
    os.makedirs(arguments.o, exist_ok=True)
    report(curves, line, arguments.o)
    draw(curves, line, arguments.o)


if __name__ == "__main__":
    main()
