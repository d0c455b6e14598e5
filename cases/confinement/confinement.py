#!/usr/bin/python3
"""Confinement: a slender layer buckles, a stout one crushes, under 0 to 20 MPa around it.

    /usr/bin/python3 cases/confinement/confinement.py ANTIFORM DIRECTORY [--jobs N]

Runs strut.prm over pressures for two lengths; makes what is not in DIRECTORY yet, then
writes confinement.csv (a line a run), confinement.md and confinement.svg/.png: axial stress
at failure against the pressure, beside the closed forms sigma_E + p and UCS + N_phi p. The
buckling stress is where the amplitude would grow without bound (Southwell: sigma_1 - p
against 1/amplitude, to 1/amplitude = 0). 10 runs took a minute on two cores.
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
PRESSURES = [0., 5e6, 10e6, 15e6, 20e6]
LENGTHS = {"slender": 80., "stout": 16.}  # L/h
MODULUS = 56e9 / (1. - 0.2 ** 2)  # E' of the deck
PHI = math.radians(42.)
UCS = 2. * 36.06e6 * math.cos(PHI) / (1. - math.sin(PHI))
SLOPE = (1. + math.sin(PHI)) / (1. - math.sin(PHI))  # N_phi
THICKNESS = 10.


def euler(length_ratio):
    """Buckling stress between walls that keep the ends from turning [Pa]."""
    return math.pi ** 2 * MODULUS / 12. * (2. / length_ratio) ** 2


def southwell(history, pressure):
    """sigma_1 - p at which the wave would grow without bound, from its growth [Pa]."""
    amplitude = np.array([float(row["fold_amplitude_m"]) for row in history])
    stress = np.array([float(row["axial_stress_Pa"]) for row in history]) - pressure
    yielded = np.array([float(row["plastic_share"]) for row in history])
    # Grown five times, and of small slopes: below half of the thickness.
    use = (amplitude > 5. * amplitude[0]) & (amplitude < 0.5 * THICKNESS) & (yielded == 0.)
    return np.polyfit(1. / amplitude[use], stress[use], 1)[1]


def one(antiform, directory, kind, pressure):
    """A line of the table; None where the run has no peak."""
    length = LENGTHS[kind]
    crushing = UCS + SLOPE * pressure
    target = os.path.join(directory, f"{kind}-{pressure / 1e6:g}-MPa")
    strain = euler(length) / MODULUS if kind == "slender" else crushing / MODULUS
    entries = {"Components": "layer, walls" + (", membrane" if pressure > 0. else ""),
               "Layer/Length ratio": length,
               "Matrix/Cell aspect ratio": max(1., length / 16.),
               "Run/End shortening": (1.4 if kind == "slender" else 1.1) * strain,
               "Run/Load steps": 60,
               "Title": f"{kind.capitalize()} layer under {pressure / 1e6:g} MPa"}
    if pressure > 0.:
        entries["Membrane/Pressure"] = pressure
    found = run(antiform, target, DECK, entries, may_give_way=True)
    if found is None:
        return None
    with open(os.path.join(target, "history.csv")) as file:
        history = list(csv.DictReader(file))
    peak = found["results"]["peak_stress"]["value"]
    stress = pressure + southwell(history, pressure) if kind == "slender" else peak
    theory = pressure + euler(length) if kind == "slender" else crushing
    return {"kind": kind, "length_ratio": length, "pressure_Pa": pressure,
            "failure_stress_Pa": stress, "closed_form_Pa": theory, "peak_stress_Pa": peak,
            "status": found["status"], "seconds": found["wall_seconds"]}


def draw(rows, directory):
    p = np.linspace(0., 20e6, 50)
    figure, axes = plt.subplots(figsize=(8.4, 5.6))
    figure.subplots_adjust(left=0.1, right=0.97, top=0.86, bottom=0.11)
    for kind, colour, marker, text in (
            ("stout", "#c0392b", "s", r"crushes: UCS + N$_\varphi$ p"),
            ("slender", "#1f4fa8", "o", r"buckles: $\sigma_E$ + p")):
        length = LENGTHS[kind]
        line = p + euler(length) if kind == "slender" else UCS + SLOPE * p
        axes.plot(p / 1e6, line / 1e6, color=colour, linewidth=1.4,
                  label=f"L/h = {length:g}, closed form, {text}")
        of = [row for row in rows if row["kind"] == kind]
        axes.plot([row["pressure_Pa"] / 1e6 for row in of],
                  [row["failure_stress_Pa"] / 1e6 for row in of], color=colour,
                  marker=marker, linestyle="none", markersize=7.5,
                  markerfacecolor="white", markeredgewidth=1.7,
                  label=f"L/h = {length:g}, finite elements")
    axes.set(xlim=(-0.5, 21.), ylim=(0., None),
             xlabel="confining pressure  p  [MPa]",
             ylabel=r"axial stress at failure  $\sigma_1$  [MPa]")
    axes.legend(frameon=False, fontsize=10, loc="upper left")
    figure.suptitle("Confinement strengthens a layer and does not keep it from buckling",
                    x=0.1, ha="left", fontsize=13, weight="bold", y=0.965)
    figure.text(0.1, 0.885, "Mohr-Coulomb, UCS 162 MPa, friction 42 degrees; the pressure"
                " follows the faces, ends guided.", fontsize=10)
    save(figure, directory, "confinement")


def report(rows, directory):
    lines = ["| L/h | p, MPa | sigma_1 at failure, MPa | closed form, MPa | | s |",
             "| --- | --- | --- | --- | --- | --- |"]
    for r in rows:
        p = r["pressure_Pa"]
        # Of buckling what counts is sigma_1 - p.
        base = p if r["kind"] == "slender" else 0.
        off = (r["failure_stress_Pa"] - base) / (r["closed_form_Pa"] - base) - 1.
        lines.append(f"| {r['length_ratio']:g} | {p / 1e6:g}"
                     f" | {r['failure_stress_Pa'] / 1e6:.2f}"
                     f" | {r['closed_form_Pa'] / 1e6:.2f} | {100 * off:+.2f} %"
                     f" | {r['seconds']:.1f} |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "confinement.md"), "w") as file:
        file.write(text)
    print(text)


def main():
    arguments = arguments_of(__doc__)
    keys = [(kind, pressure) for kind in LENGTHS for pressure in PRESSURES]
    rows = rows_of(lambda *key: one(arguments.antiform, arguments.directory, *key), keys,
                   arguments.jobs)
    write_table(rows, os.path.join(arguments.directory, "confinement.csv"))
    report(rows, arguments.directory)
    draw(rows, arguments.directory)


if __name__ == "__main__":
    main()
