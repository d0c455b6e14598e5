#!/usr/bin/python3
"""Influence of micro-parameters on the strength of rock 1: a study of small specimens.

    /usr/bin/python3 cases/laboratory/influence.py ANTIFORM DIRECTORY [--seeds N] [--jobs N]

Runs what is not in DIRECTORY yet, then writes influence.csv (a line a specimen),
influence.md (slopes, rank correlations, against what Wu & Xu 2016 found) and
influence.png. One seed took 277 core seconds.
"""
import argparse
import csv
import os
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from specimen_runs import HERE, add_arguments, run, run_all, write_table

# Small, fast specimens: signs are wanted, not strengths. The gap is one that both the
# densest and the loosest bonding of the study are within.
COMMON = {"Layer/Grains across": 16, "Walls/Transits per millistrain": 75,
          "Run/Stress ratio of peak": 0.7, "Run/Strain multiple of peak": 1.2,
          "Run/Longest shortening": 6e-3, "Output/Fields interval": 1.}
TESTS = {"tension": {"Walls/Transits per millistrain": 500},
         "uniaxial": {},
         "biaxial-2.5": {"Servo walls/Pressure": 2.5e6},
         "biaxial-5": {"Servo walls/Pressure": 5e6},
         "biaxial-10": {"Servo walls/Pressure": 10e6}}
TENSILE = 15e6  # sigma_b of rock 1

# name: (entries of a value, values); the second is what rock 1 has, but for CN.
PARAMETERS = {
    "CN": (lambda v: {"Layer/Coordination number": v}, [4.4, 4.8, 5.2, 5.6]),
    "CD": (lambda v: {"Layer/Joint types/Slit fraction": v}, [0., 0.1, 0.2, 0.3]),
    "c_b/sigma_b": (lambda v: {"Layer/Flat joint/Cohesion": v * TENSILE},
                    [2., 4., 6., 8.]),
    "phi_b": (lambda v: {"Layer/Flat joint/Friction angle": v}, [0., 10., 20., 30.]),
    "mu": (lambda v: {"Layer/Flat joint/Residual friction": v}, [0.1, 0.2, 0.4, 0.6]),
}
# Signs of Wu & Xu (2016), table 4.2 of Gioiello (2018).
EXPECTED = [("UCS/TS", "CN", 1), ("UCS/TS", "c_b/sigma_b", 1),
            ("m_i", "CD", 1), ("m_i", "c_b/sigma_b", 1), ("m_i", "phi_b", 1),
            ("m_i", "CN", -1), ("phi", "CD", 1), ("phi", "c_b/sigma_b", 1),
            ("phi", "phi_b", 1)]


def residual(directory):
    """Last axial stress over the largest."""
    with open(os.path.join(directory, "history.csv")) as file:
        stress = [float(row["axial_stress_Pa"]) for row in csv.DictReader(file)]
    return stress[-1] / max(stress)


def envelope(antiform, directories):
    """m_i and friction angle of the fits through these runs."""
    done = subprocess.run([antiform, "envelope", *directories], capture_output=True,
                          text=True, check=True)
    values = {}
    for line in done.stdout.splitlines():
        words = line.split()
        if len(words) >= 2 and words[0] in ("hoek_brown_mi", "friction_angle"):
            values[words[0]] = float(words[1])
    return values


def specimens(arguments):
    """One dictionary a specimen: parameter, value, seed, UCS, TS, m_i, phi."""
    def job(name, value, seed, test):
        entries = {**COMMON, **TESTS[test], **PARAMETERS[name][0](value),
                   "Layer/Seed": seed}
        if name == "mu" and test == "biaxial-5":
            entries["Run/Strain multiple of peak"] = 1.6  # its end is of interest
            entries["Run/Stress ratio of peak"] = 0.
        path = os.path.join(arguments.directory, name.replace("/", "_over_"),
                            f"{value}-seed{seed}-{test}")
        deck = os.path.join(HERE, test.split("-")[0] + ".prm")
        return path, run(arguments.antiform, path, deck, entries)

    keys = [(name, value, seed, test) for name, (_, values) in PARAMETERS.items()
            for value in values for seed in range(1, arguments.seeds + 1)
            for test in TESTS]
    results = run_all(job, keys, arguments.jobs)
    rows = []
    for name, (_, values) in PARAMETERS.items():
        for value in values:
            for seed in range(1, arguments.seeds + 1):
                one = {test: results[name, value, seed, test] for test in TESTS}
                if any(summary is None for _, summary in one.values()):
                    print(f"{name} = {value}, seed {seed}: left out", file=sys.stderr)
                    continue
                figure = lambda test, result: one[test][1]["results"][result]["value"]
                fits = envelope(arguments.antiform,
                                [path for test, (path, _) in one.items()
                                 if test != "tension"])
                ucs, ts = figure("uniaxial", "peak_stress"), figure("tension",
                                                                    "tensile_strength")
                rows.append({"parameter": name, "value": value, "seed": seed,
                             "UCS": ucs, "TS": ts, "UCS/TS": ucs / ts,
                             "m_i": fits["hoek_brown_mi"],
                             "phi": fits["friction_angle"],
                             "residual": residual(one["biaxial-5"][0])})
    return rows


def ranks(x):
    """Ranks with ties at their mean."""
    x = np.asarray(x)
    return np.array([np.mean(np.flatnonzero(np.sort(x) == v)) for v in x])


def rank_correlation(x, y):
    return float(np.corrcoef(ranks(x), ranks(y))[0, 1])


def means(rows, name, what):
    values = PARAMETERS[name][1]
    groups = [[row[what] for row in rows
               if row["parameter"] == name and row["value"] == value]
              for value in values]
    kept = [(v, g) for v, g in zip(values, groups) if g]
    return ([v for v, _ in kept], [float(np.mean(g)) for _, g in kept],
            [float(np.std(g, ddof=1)) if len(g) > 1 else 0. for _, g in kept])


def write_report(rows, path):
    with open(path, "w") as out:
        out.write("| of | to | means | rank correlation of the means | of all specimens "
                  "| expected | |\n| --- | --- | --- | --- | --- | --- | --- |\n")
        for what, name, sign in EXPECTED:
            values, mean, _ = means(rows, name, what)
            of_means = rank_correlation(values, mean)
            chosen = [row for row in rows if row["parameter"] == name]
            of_all = rank_correlation([row["value"] for row in chosen],
                                      [row[what] for row in chosen])
            holds = sign * of_means > 0.8
            out.write(f"| {what} | {name} | {', '.join(f'{m:.3g}' for m in mean)} | "
                      f"{of_means:+.2f} | {of_all:+.2f} | {'+' if sign > 0 else '-'} | "
                      f"{'holds' if holds else 'does not hold'} |\n")
        out.write("\n| mu | UCS (MPa) | TS (MPa) | left of the peak at 5 MPa |\n"
                  "| --- | --- | --- | --- |\n")
        ucs, ts, left = (means(rows, "mu", what) for what in ("UCS", "TS", "residual"))
        for k, value in enumerate(ucs[0]):
            out.write(f"| {value} | {ucs[1][k] / 1e6:.1f} | {ts[1][k] / 1e6:.2f} | "
                      f"{100 * left[1][k]:.0f} % |\n")


def draw(rows, path):
    what = [("UCS/TS", "UCS / tensile strength"), ("m_i", "$m_i$ (Hoek-Brown)"),
            ("phi", "friction angle (degrees)")]
    names = ["CN", "CD", "c_b/sigma_b", "phi_b", "mu"]
    label = {"CN": "coordination number", "CD": "initial crack density",
             "c_b/sigma_b": "$c_b/\\sigma_b$", "phi_b": "$\\phi_b$ (degrees)",
             "mu": "residual friction"}
    figure, axes = plt.subplots(len(what), len(names), sharey="row",
                                figsize=(2.6 * len(names), 2.5 * len(what)))
    for i, (key, title) in enumerate(what):
        for j, name in enumerate(names):
            ax = axes[i][j]
            chosen = [row for row in rows if row["parameter"] == name]
            ax.plot([row["value"] for row in chosen], [row[key] for row in chosen], ".",
                    color="0.65", markersize=5)
            values, mean, deviation = means(rows, name, key)
            ax.errorbar(values, mean, deviation, color="#08519c", capsize=3, marker="o",
                        markersize=4)
            sign = [s for w, n, s in EXPECTED if w == key and n == name]
            if sign:
                ax.set_title("expected: " + ("rises" if sign[0] > 0 else "falls"),
                             fontsize=9, color="#d7191c")
            if i == len(what) - 1:
                ax.set_xlabel(label[name])
            if j == 0:
                ax.set_ylabel(title)
            ax.grid(alpha=0.3)
    figure.suptitle("Rock 1, 16 grains across: specimens (grey), means and deviations")
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_arguments(parser)
    arguments = parser.parse_args()
    os.makedirs(arguments.directory, exist_ok=True)
    rows = specimens(arguments)
    if not rows:
        sys.exit("no specimen has all of its tests")
    path = lambda name: os.path.join(arguments.directory, name)
    write_table(rows, path("influence.csv"))
    write_report(rows, path("influence.md"))
    draw(rows, path("influence.png"))
    print("written:", path("influence.md"), path("influence.png"))


if __name__ == "__main__":
    main()
