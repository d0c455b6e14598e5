#!/usr/bin/python3
"""Upheaval: a layer on hard rock, lifted by its own axial force against its weight.

    /usr/bin/python3 cases/burial-depth/upheaval.py ANTIFORM DIRECTORY

Runs upheaval.prm for bumps of some heights; makes what is not in DIRECTORY yet, then writes
upheaval.md and upheaval.svg/.png: axial stress against the rise of the crest, beside the
closed form of a layer that has lifted from a flat base, P l^2 = 80.76 D with the rise
2.407e-3 q l^4 / D. Three runs took half a minute on two cores.
"""
import csv
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, rows_of, run, save  # noqa: E402

DECK = os.path.join(HERE, "upheaval.prm")
BUMPS = [0.15, 0.3, 0.5]  # height over h
COLOURS = ["#1f4fa8", "#2e8b57", "#c0392b"]
THICKNESS = 10.
MODULUS = 56e9 / (1. - 0.2 ** 2)
BENDING = MODULUS * THICKNESS ** 3 / 12.
WEIGHT = 0.84 * 2500. * 9.81 * THICKNESS


def closed_form(rise):
    """Axial stress [Pa] of a layer whose crest has risen from a flat base [m]."""
    length = (rise * BENDING / (2.4068e-3 * WEIGHT)) ** 0.25
    return 80.763 * BENDING / length ** 2 / THICKNESS


def lifted_length(rise):
    return (rise * BENDING / (2.4068e-3 * WEIGHT)) ** 0.25


def one(antiform, directory, bump):
    """Rise [m], axial stress [Pa] and lifted length [m] along the path; None: failed."""
    target = os.path.join(directory, f"bump-{bump:g}")
    if run(antiform, target, DECK, {"Layer/Amplitude ratio": bump,
                                    "Title": f"Bump of {bump:g} h"}) is None:
        return None
    with open(os.path.join(target, "history.csv")) as file:
        rows = list(csv.DictReader(file))
    return tuple(np.array([float(row[name]) for row in rows]) for name in
                 ("crest_height_m", "axial_stress_Pa", "lifted_length_m", "shortening"))


def draw(found, directory):
    figure, axes = plt.subplots(figsize=(8.4, 5.6))
    figure.subplots_adjust(left=0.1, right=0.97, top=0.86, bottom=0.11)
    rise = np.linspace(0.5, 30., 400)
    axes.plot(rise, closed_form(rise) / 1e6, color="black", linewidth=1.4,
              label="closed form, from a flat base")
    for bump, colour in zip(BUMPS, COLOURS):
        amplitude, stress = found[(bump,)][:2]
        axes.plot(amplitude, stress / 1e6, color=colour, linewidth=1.6,
                  label=f"finite elements, bump of {bump * THICKNESS:g} m")
    axes.set(xlim=(0., 30.), ylim=(0., 190.), xlabel="height of the crest  [m]",
             ylabel="axial stress of the layer  [MPa]")
    axes.legend(frameon=False, fontsize=10)
    figure.suptitle("A layer that rests on hard rock snaps up from a bump", x=0.1,
                    ha="left", fontsize=13, weight="bold", y=0.965)
    figure.text(0.1, 0.885, "h = 10 m under its own weight on a base that only pushes;"
                " shortened by walls, followed by arc length.", fontsize=10)
    save(figure, directory, "upheaval")


def report(found, directory):
    lines = ["| bump, m | peak stress, MPa | at 20 m: stress, MPa | closed form | "
             "| lifted length, m | closed form | |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for bump in BUMPS:
        amplitude, stress, lifted = found[(bump,)][:3]
        top = int(np.argmax(stress))
        s, l = (float(np.interp(20., amplitude[top:], v[top:])) for v in (stress, lifted))
        s0, l0 = closed_form(20.), lifted_length(20.)
        lines.append(f"| {bump * THICKNESS:g} | {stress[top] / 1e6:.1f} | {s / 1e6:.2f} |"
                     f" {s0 / 1e6:.2f} | {100 * (s / s0 - 1):+.2f} % | {l:.1f} | {l0:.1f} |"
                     f" {100 * (l / l0 - 1):+.2f} % |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "upheaval.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    arguments = arguments_of(__doc__)
    keys = [(bump,) for bump in BUMPS]
    paths = rows_of(lambda bump: one(arguments.antiform, arguments.directory, bump), keys,
                    arguments.jobs)
    found = dict(zip(keys, paths))
    report(found, arguments.directory)
    draw(found, arguments.directory)


if __name__ == "__main__":
    main()
