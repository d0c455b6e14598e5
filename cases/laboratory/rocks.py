#!/usr/bin/python3
"""Both rocks of the source with its own micro-parameters (Table 4.3), over several packings.

    /usr/bin/python3 cases/laboratory/rocks.py ANTIFORM DIRECTORY [--seeds N] [--jobs N]

One packing recipe: installation gap 1, radius multiplier 0.80. Runs what is not in
DIRECTORY yet, then writes rocks.csv (a line a specimen) and rocks.md (mean, deviation and
range of each figure beside its target). Five seeds took 7 minutes on one core.
"""
import argparse
import os
import sys

import numpy as np

from specimen_runs import HERE, add_arguments, run, run_all, write_table

RECIPE = {"Layer/Flat joint/Radius multiplier": 0.8,
          "Layer/Installation gap ratio": 1., "Output/Fields interval": 1.}
# Confined specimens harden on: their strength is the stress at a strain of 6e-3.
TESTS = {"uniaxial": {},
         # Of the intact rock; cracks lower the slope between 30 and 60 % of the peak.
         "uniaxial-elastic": {"Layer/Breakable": "false", "Run/End shortening": 1e-4,
                              "Run/Stress ratio of peak": 0.,
                              "Output/Samples per millistrain": 2000},
         "tension": {"Walls/Transits per millistrain": 500},
         "biaxial-10": {"Servo walls/Pressure": 10e6, "Run/End shortening": 6e-3,
                        "Walls/Transits per millistrain": 75},
         "biaxial-20": {"Servo walls/Pressure": 20e6, "Run/End shortening": 6e-3,
                        "Walls/Transits per millistrain": 75}}
ROCKS = ("rock-1", "rock-2")

# Figure: test, result, unit, scale, and of each rock target and band.
FIGURES = {
    "E": ("uniaxial-elastic", "young_modulus", "GPa", 1e9, {"rock-1": (56., .03),
                                                           "rock-2": (21.9, .03)}),
    "slope, 30 to 60 %": ("uniaxial", "young_modulus", "GPa", 1e9, None),
    "UCS": ("uniaxial", "peak_stress", "MPa", 1e6, {"rock-1": (161.7, None),
                                                   "rock-2": (50., .2)}),
    "tension": ("tension", "tensile_strength", "MPa", 1e6, {"rock-1": (11.6, .25),
                                                           "rock-2": (2.03, .25)}),
    "sigma_1 at 10 MPa": ("biaxial-10", "peak_stress", "MPa", 1e6,
                          {"rock-1": (220.8, .15), "rock-2": (120.1, .15)}),
    "sigma_1 at 20 MPa": ("biaxial-20", "peak_stress", "MPa", 1e6,
                          {"rock-1": (274.7, .15), "rock-2": (168.9, .15)})}
UCS_RANGE_OF_ROCK_1 = (125., 208.)  # of the source's laboratory data
CONTACT_MODULUS = {"rock-1": 50., "rock-2": 20.}  # E_c of Table 4.3 [GPa]


def write_deck(directory, rock, test):
    path = os.path.join(directory, f"{rock}-{test}.prm")
    with open(path, "w") as deck:
        deck.write(f"include {HERE}/{test.split('-')[0]}.prm\n"
                   f"include {HERE}/../rocks/{rock}.prm\n")
    return path


def band(figure, rock):
    target, share = FIGURES[figure][4][rock]
    return UCS_RANGE_OF_ROCK_1 if share is None else (target * (1 - share),
                                                      target * (1 + share))


def specimens(arguments):
    decks = {(rock, test): write_deck(arguments.directory, rock, test)
             for rock in ROCKS for test in TESTS}

    def job(rock, test, seed):
        return run(arguments.antiform,
                   os.path.join(arguments.directory, rock, f"{test}-seed{seed}"),
                   decks[rock, test],
                   {**RECIPE, **TESTS[test], "Layer/Seed": seed})

    seeds = range(1, arguments.seeds + 1)
    results = run_all(job, [(rock, test, seed) for rock in ROCKS for seed in seeds
                            for test in TESTS], arguments.jobs)
    rows = []
    for rock in ROCKS:
        for seed in seeds:
            row = {"rock": rock, "seed": seed}
            for name, (test, result, _, scale, _) in FIGURES.items():
                summary = results[rock, test, seed]
                if summary is not None:
                    row[name] = summary["results"][result]["value"] / scale
            if len(row) == 2 + len(FIGURES):
                rows.append(row)
            else:
                print(f"{rock}, seed {seed}: left out", file=sys.stderr)
    return rows


def write_report(rows, path):
    with open(path, "w") as out:
        out.write("| rock | figure | mean | deviation | range | wanted | |\n"
                  "| --- | --- | --- | --- | --- | --- | --- |\n")
        for rock in ROCKS:
            for name, (_, _, unit, _, targets) in FIGURES.items():
                x = np.array([row[name] for row in rows if row["rock"] == rock])
                mean = x.mean()
                figures = (f"| {rock} | {name} ({unit}) | {mean:.2f} | {x.std(ddof=1):.2f} "
                           f"| {x.min():.2f} to {x.max():.2f} | ")
                if targets is None:
                    out.write(figures + "| |\n")
                    continue
                low, high = band(name, rock)
                miss = 0. if low <= mean <= high else mean / (low if mean < low
                                                             else high) - 1.
                out.write(
                    f"{figures}{targets[rock][0]:g} "
                    f"({low:.1f} to {high:.1f}) | "
                    f"{'inside' if miss == 0. else f'outside by {100 * miss:+.1f} %'} |\n")
        ratio = [np.mean([row["E"] for row in rows if row["rock"] == rock])
                 / CONTACT_MODULUS[rock] for rock in ROCKS]
        out.write(f"\n(E_1/E_c1)/(E_2/E_c2) = {ratio[0] / ratio[1]:.4f}, wanted 1.023 +- "
                  "0.015\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_arguments(parser)
    arguments = parser.parse_args()
    os.makedirs(arguments.directory, exist_ok=True)
    rows = specimens(arguments)
    if not rows:
        sys.exit("no specimen has all of its tests")
    path = os.path.join(arguments.directory, "rocks.")
    write_table(rows, path + "csv")
    write_report(rows, path + "md")
    with open(path + "md") as file:
        print(file.read())


if __name__ == "__main__":
    main()
