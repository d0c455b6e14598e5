#!/usr/bin/python3
"""One curve for every burial depth: critical stress of a layer under a cover.

    antiform study cases/burial-depth/study-contrasts.prm -o DIRECTORY
    /usr/bin/python3 cases/burial-depth/master_curve.py DIRECTORY

Draws the layers of that study that slide in their matrix, theory and computation in one
picture: writes master_curve.md (a line a run) and master_curve.svg/.png.
"""
import argparse
import csv
import json
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

CURVE = os.path.join(HERE, "..", "..", "tests", "data", "cover_master_curve.csv")
CONTRASTS = [1e3, 1e4, 1e5]
COLOURS = {1e3: "#c0392b", 1e4: "#1f4fa8", 1e5: "#2e8b57"}
MARKERS = {1e3: "^", 1e4: "o", 1e5: "s"}
THICKNESS = 10.
MODULUS = 56e9 / (1. - 0.25 ** 2)  # E' of the deck


def rows_of(directory):
    """A line a member that slides: contrast, H/h, Theta, F, wavelength, with theory."""
    path = os.path.join(directory, "study.json")
    if not os.path.exists(path):
        sys.exit(f"master_curve.py: there is no '{path}'. Make it with 'antiform study "
                 f"cases/burial-depth/study-contrasts.prm -o {directory}'.")
    with open(path) as file:
        members = json.load(file)["members"]
    rows = []
    for member in members:
        values, found = member["values"], member["figures"]
        if values["interface"] != "sliding" or member["status"] != "completed":
            continue
        contrast, cover = (float(values[name]) for name in ("stiffness_contrast",
                                                            "burial_depth_ratio"))
        # Stress and length that all contrasts have in common.
        stress = (MODULUS * (MODULUS / contrast) ** 2) ** (1. / 3.)
        length = THICKNESS * contrast ** (1. / 3.)
        rows.append({"contrast": contrast, "cover_ratio": cover,
                     "theta": cover * contrast ** (-1. / 3.),
                     "F": found["critical_stress_Pa"] / stress,
                     "F_theory": found["theory_stress_Pa"] / stress,
                     "wave": found["dominant_wavelength_m"] / length,
                     "wave_theory": found["theory_wavelength_m"] / length})
    return rows


def theory_curve():
    """Theta, F, wavelength: minima of the closed form, computed independently."""
    with open(CURVE) as file:
        lines = [line for line in file if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return [np.array([float(row[name]) for row in rows]) for name in ("Theta", "F", "Lam")]


def draw(rows, directory):
    theta, F, wave = theory_curve()
    figure, (top, low) = plt.subplots(2, 1, figsize=(8.4, 8.2), sharex=True,
                                      height_ratios=[3, 2])
    figure.subplots_adjust(left=0.11, right=0.97, top=0.9, bottom=0.08, hspace=0.07)
    for axes, values in ((top, F), (low, wave)):
        x = np.concatenate([[1e-4], theta])
        axes.plot(x, np.concatenate([[values[0]], values]), color="black", linewidth=1.6,
                  label="closed form, smooth contact")
        axes.axvspan(1e-4, 0.3, color="#f3ead8", zorder=0)
        axes.axvspan(2., 12., color="#dfe9f3", zorder=0)
    for contrast in CONTRASTS:
        of = sorted((r for r in rows if r["contrast"] == contrast),
                    key=lambda r: r["theta"])
        style = {"color": COLOURS[contrast], "marker": MARKERS[contrast],
                 "linestyle": "none", "markersize": 7, "markerfacecolor": "white",
                 "markeredgewidth": 1.6}
        exponent = round(math.log10(contrast))
        top.plot([r["theta"] for r in of], [r["F"] for r in of], **style,
                 label=f"finite elements, $E/E_0 = 10^{exponent}$")
        low.plot([r["theta"] for r in of], [r["wave"] for r in of], **style)
        # Where H/h = 0.1 and 10 fall with this contrast.
        for cover, text in ((0.1, "0.1"), (10., "10")):
            place = cover * contrast ** (-1. / 3.)
            top.plot([place, place], [0.44, 0.452], color=COLOURS[contrast],
                     linewidth=2.4)
            top.annotate(text, (place, 0.455), color=COLOURS[contrast], fontsize=9,
                         ha="center", va="bottom")
    top.text(1.02 * 1.5e-4, 0.49, "  where H/h = 0.1 and 10, the thesis' limits, fall with"
             " each contrast:", fontsize=9, color="#444444", va="center")
    for x, text in ((8e-3, "shallow"), (0.78, "transition"), (4.9, "deep")):
        top.text(x, 0.86, text, fontsize=11, ha="center", color="#555555")
    top.set(xscale="log", xlim=(1.5e-4, 12.), ylim=(0.44, 0.89),
            ylabel=r"critical stress  $F = \sigma_{cr} / (E'^{\,1/3} E_0'^{\,2/3})$")
    low.set(ylim=(3.2, 5.4), ylabel=r"wavelength  $(\lambda/h)\,(E_0'/E')^{1/3}$",
            xlabel=r"burial depth  $\Theta = (H/h)\,(E_0'/E')^{1/3}$")
    top.legend(frameon=False, loc="upper left", bbox_to_anchor=(0.01, 0.93), fontsize=10)
    figure.suptitle("Buckling of a strong layer under a cover H: one curve for all depths",
                    x=0.11, ha="left", fontsize=13, weight="bold", y=0.965)
    figure.text(0.11, 0.915, "Matrix of one kind above and below, free top, deep base;"
                " eight half waves of quadratic elements.", fontsize=10)
    save(figure, directory, "master_curve")


def report(rows, directory):
    lines = ["| E/E0 | H/h | Theta | F | closed form | | wave | closed form | |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        lines.append(
            f"| {r['contrast']:g} | {r['cover_ratio']:g} | {r['theta']:.4f} | {r['F']:.4f}"
            f" | {r['F_theory']:.4f} | {100 * (r['F'] / r['F_theory'] - 1):+.2f} %"
            f" | {r['wave']:.3f} | {r['wave_theory']:.3f}"
            f" | {100 * (r['wave'] / r['wave_theory'] - 1):+.2f} % |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "master_curve.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory", help="of the study; for the picture too")
    directory = parser.parse_args().directory
    rows = rows_of(directory)
    report(rows, directory)
    draw(rows, directory)


if __name__ == "__main__":
    main()
