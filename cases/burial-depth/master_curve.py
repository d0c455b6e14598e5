#!/usr/bin/python3
"""One curve for every burial depth: critical stress of a layer under a cover.

    /usr/bin/python3 cases/burial-depth/master_curve.py ANTIFORM DIRECTORY [--jobs N]

Buckling runs of buckling.prm over covers H/h and stiffness contrasts, each in a section
of eight half waves and three wavelengths of base; makes what is not in DIRECTORY yet, then
writes master_curve.csv (a line a run), master_curve.md and master_curve.svg/.png, theory
and computation in one picture. 24 runs took 2 minutes on two cores.
"""
import csv
import json
import math
import os
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, rows_of, run, save, write_table  # noqa: E402

DECK = os.path.join(HERE, "buckling.prm")
CURVE = os.path.join(HERE, "..", "..", "tests", "data", "cover_master_curve.csv")
COVERS = [0.01, 1., 3., 10., 14., 20., 30., 100.]
CONTRASTS = [1e3, 1e4, 1e5]
COLOURS = {1e3: "#c0392b", 1e4: "#1f4fa8", 1e5: "#2e8b57"}
MARKERS = {1e3: "^", 1e4: "o", 1e5: "s"}


def closed_form(antiform, entries):
    """Stress [Pa] and wavelength [m] of the cover on a half-space."""
    command = [antiform, "theory", DECK, "--json"]
    for name, value in entries.items():
        command += ["--set", f"{name}={value}"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    state = json.loads(text)["critical"]["cover_on_half_space_smooth"]
    return state["critical_stress"]["value"], state["wavelength"]["value"]


def one(antiform, directory, contrast, cover):
    """A line of the table; None where the run failed."""
    entries = {"Matrix/Stiffness contrast": contrast, "Matrix/Burial depth ratio": cover,
               "Matrix/Cover rows": 1 if cover < 0.25 else 0}
    stress, wavelength = closed_form(antiform, entries)
    h = 10.
    # Even cells measured in quarters of h: 16 columns a wavelength, far rows of a tenth.
    entries |= {"Layer/Length ratio": 4. * wavelength / h,
                "Matrix/Cell size ratio": 1, "Matrix/Refinement rounds": 0,
                "Matrix/Base depth ratio": 3. * wavelength / h,
                "Matrix/Cell aspect ratio": max(1., 4. * wavelength / h / 16.),
                "Matrix/Largest cell ratio": max(1., 4. * wavelength / h / 10.),
                "Title": f"E/E0 = {contrast:g} H/h = {cover:g}"}
    name = f"contrast-{contrast:g}-cover-{cover:g}"
    summary = run(antiform, os.path.join(directory, name), DECK, entries)
    if summary is None:
        return None
    found = {k: v["value"] for k, v in summary["results"].items()}
    E = 56e9 / (1. - 0.25 ** 2)
    E0 = E / contrast
    return {"contrast": contrast, "cover_ratio": cover,
            "theta": cover * (E0 / E) ** (1. / 3.),
            "F": found["critical_stress"] / (E * E0 * E0) ** (1. / 3.),
            "F_theory": stress / (E * E0 * E0) ** (1. / 3.),
            "wave": found["dominant_wavelength"] / h * (E0 / E) ** (1. / 3.),
            "wave_theory": wavelength / h * (E0 / E) ** (1. / 3.),
            "dofs": summary["sizes"]["dofs"], "seconds": summary["wall_seconds"]}


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
    lines = ["| E/E0 | H/h | Theta | F | closed form | | wave | closed form | | dofs | s |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        lines.append(
            f"| {r['contrast']:g} | {r['cover_ratio']:g} | {r['theta']:.4f} | {r['F']:.4f}"
            f" | {r['F_theory']:.4f} | {100 * (r['F'] / r['F_theory'] - 1):+.2f} %"
            f" | {r['wave']:.3f} | {r['wave_theory']:.3f}"
            f" | {100 * (r['wave'] / r['wave_theory'] - 1):+.2f} %"
            f" | {r['dofs']:.0f} | {r['seconds']:.1f} |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "master_curve.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    arguments = arguments_of(__doc__)
    keys = [(contrast, cover) for contrast in CONTRASTS for cover in COVERS]
    rows = rows_of(lambda *key: one(arguments.antiform, arguments.directory, *key), keys,
                   arguments.jobs)
    write_table(rows, os.path.join(arguments.directory, "master_curve.csv"))
    report(rows, arguments.directory)
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
