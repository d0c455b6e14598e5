#!/usr/bin/python3
"""What joining grains and mesh costs: error of critical stress and bond forces, seconds.

    /usr/bin/python3 cases/comparison/joins.py ANTIFORM DIRECTORY

Buckling runs of buried.prm, its layer straight: the overlap, the surface interface and
finite elements throughout, against grains alone of the same packing. Three packings at
each contrast, and one at each depth of cover and base for the seconds, one run after the
other. The bent layer of buried.prm as it is, at three contrasts, cemented and frictionless,
for the forces of the outer grains' bonds, which are compared one by one. Makes what is not
in DIRECTORY yet, then writes joins.csv, bonds.csv, joins.md and joins.svg/.png.
"""
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from run_files import Run  # noqa: E402
from study_runs import arguments_of, run, save, write_table  # noqa: E402

DECK = os.path.join(HERE, "buried.prm")
KINDS = {"grains": {"Matrix/Representation": "grains"},
         "overlap": {"Matrix/Join": "bridging domain"},
         "surface": {"Matrix/Join": "surface interface"},
         "continuum": {"Layer/Representation": "continuum", "Matrix/Element degree": 2}}
COLOURS = {"overlap": "#1f4fa8", "surface": "#c0392b", "continuum": "#888888",
           "grains": "black"}
CONTRASTS = (10., 20., 50., 100., 300., 1000., 1e4)
SEEDS = (1, 2, 3)
DEPTHS = (1., 2., 5., 10.)  # of cover and base, over h
MIDDLE = 100.  # contrast of the runs by depth
BENT = (20., 100., 1e4)  # contrasts of the bent layer
CONTACTS = ("cemented", "frictionless")
FROM_WALLS = 10.  # bonds nearer to a wall are left out [grain diameters]


def one(arguments, kind, contrast, depth, seed):
    entries = {"Run/Driver": "buckling", "Layer/Shape": "straight", "Run/Modes": 1,
               "Matrix/Stiffness contrast": contrast, "Matrix/Burial depth ratio": depth,
               "Matrix/Base depth ratio": depth, "Layer/Seed": seed, **KINDS[kind]}
    name = f"{kind}-{contrast:g}-{depth:g}-{seed}"
    summary = run(arguments.antiform, os.path.join(arguments.directory, name), DECK, entries)
    if summary is None:
        sys.exit("a run failed, see above")
    return {"kind": kind, "contrast": contrast, "depth": depth, "seed": seed,
            "grains": summary["sizes"].get("grains", 0),
            "stress": summary["results"]["critical_stress"]["value"],
            "seconds": summary["cpu_seconds"]}


def layer_bonds(directory):
    """Of the layer's bonds, by the middle between their grains before shortening: normal and
    shear force at the end, and whether a grain of theirs has a bond to the matrix."""
    of = Run(directory)
    first, last = of.frame(of.step_numbers[0]), of.frame(of.step_numbers[-1])
    region = first.grains.field("region")
    pairs = first.joints.connectivity.reshape(-1, 2)
    sides = region[pairs]
    outer = np.zeros(len(region), bool)
    outer[pairs[sides[:, 0] != sides[:, 1]]] = True  # matrix grains too, at no matter
    inside = np.flatnonzero((sides == 0).all(axis=1))
    middle = first.joints.lines()[inside].mean(axis=1)
    force = np.column_stack([last.joints.cell_fields[f"{which}_force_N"][inside]
                             for which in ("normal", "shear")])
    return {tuple(np.round(m, 6)): (f, o)
            for m, f, o in zip(middle, force, outer[pairs[inside]].any(axis=1))}


def bent_directory(arguments, kind, contact, contrast):
    return os.path.join(arguments.directory, f"bent-{kind}-{contact}-{contrast:g}")


def bent(arguments, contact, contrast):
    """Error of the bonds of the layer's outer grains and seconds, of overlap and surface.
    Which grains are outer tells the run that is cemented, made before the others."""
    directories, seconds = {}, {}
    for kind in ("grains", "overlap", "surface"):
        directories[kind] = bent_directory(arguments, kind, contact, contrast)
        summary = run(arguments.antiform, directories[kind], DECK,
                      {"Matrix/Stiffness contrast": contrast, "Matrix/Interface": contact,
                       **KINDS[kind]})
        if summary is None:
            sys.exit("a run failed, see above")
        seconds[kind] = summary["cpu_seconds"]
    alone = layer_bonds(directories["grains"])
    cemented = layer_bonds(bent_directory(arguments, "grains", CONTACTS[0], contrast))
    x = np.array([place[0] for place in alone])
    diameter = 2. * np.mean(Run(directories["grains"]).frame(0).grains.field("radius_m"))
    low, high = x.min() + FROM_WALLS * diameter, x.max() - FROM_WALLS * diameter
    rows = []
    for kind in ("overlap", "surface"):
        other = layer_bonds(directories[kind])
        own, moved = [], []
        for place, (force, _) in alone.items():
            if cemented[place][1] and low < place[0] < high:
                own.append(force)
                moved.append(other[place][0] - force)
        rows.append({"kind": kind, "contact": contact, "contrast": contrast,
                     "bonds": len(own), "seconds": seconds[kind],
                     "seconds_grains": seconds["grains"],
                     "error": float(np.linalg.norm(moved) / np.linalg.norm(own))})
    return rows


def compare(rows):
    """Error of each run against grains alone in the same scene."""
    key = [(row["contrast"], row["depth"], row["seed"]) for row in rows]
    alone = {k: row["stress"] for k, row in zip(key, rows) if row["kind"] == "grains"}
    for k, row in zip(key, rows):
        row["error"] = row["stress"] / alone[k] - 1.


def errors(rows, kind, contrast):
    return [row["error"] for row in rows if row["kind"] == kind
            and row["contrast"] == contrast and row["depth"] == 2.]


def bond_table(rows):
    text = "| contact, contrast | overlap: bonds, s | surface: bonds, s | grains alone, s |\n"
    text += "| --- | --- | --- | --- |\n"
    for overlap, surface in zip(rows[::2], rows[1::2]):
        text += f"| {overlap['contact']}, {overlap['contrast']:g} |"
        for row in (overlap, surface):
            text += f" {100. * row['error']:.2g} %, {row['seconds']:.1f} |"
        text += f" {overlap['seconds_grains']:.1f} |\n"
    return text


def table(rows):
    text = "| contrast | overlap | surface | continuum |\n| --- | --- | --- | --- |\n"
    for contrast in CONTRASTS:
        text += f"| {contrast:g} |"
        for kind in ("overlap", "surface", "continuum"):
            of = errors(rows, kind, contrast)
            text += f" {100. * min(of):+.2f} to {100. * max(of):+.2f} % |"
        text += "\n"
    text += "\n| cover and base | " + " | ".join(
        f"{kind}: grains, s" for kind in ("grains", "overlap", "surface")) + " |\n"
    text += "| --- | --- | --- | --- |\n"
    for depth in DEPTHS:
        text += f"| {depth:g} h |"
        for kind in ("grains", "overlap", "surface"):
            row = next(row for row in rows if row["kind"] == kind and row["depth"] == depth
                       and row["contrast"] == MIDDLE)
            text += f" {row['grains']:,}, {row['seconds']:.1f} |"
        text += "\n"
    return text


def draw(rows, bonds, directory):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14.4, 4.6))
    figure.subplots_adjust(left=0.055, right=0.985, top=0.84, bottom=0.13, wspace=0.26)
    for kind in ("overlap", "surface", "continuum"):
        of = [errors(rows, kind, contrast) for contrast in CONTRASTS]
        left.fill_between(CONTRASTS, [100. * min(e) for e in of],
                          [100. * max(e) for e in of], color=COLOURS[kind], alpha=0.2)
        left.plot(CONTRASTS, [100. * sum(e) / len(e) for e in of], color=COLOURS[kind],
                  marker="o", label=kind)
    left.axhline(0., color="black", linewidth=0.8)
    left.set(xscale="log", xlabel="stiffness contrast E/E0 [-]",
             ylabel="error of the critical stress [%]")
    for kind in ("overlap", "surface"):
        for contact, style in zip(CONTACTS, ("-", "--")):
            of = [row for row in bonds if row["kind"] == kind and row["contact"] == contact]
            middle.plot([row["contrast"] for row in of], [100. * row["error"] for row in of],
                        style, color=COLOURS[kind], marker="o", label=f"{kind}, {contact}")
    middle.set(xscale="log", yscale="log", xlabel="stiffness contrast E/E0 [-]",
               ylabel="RMS error of the outer grains' bonds [%]")
    for kind in ("grains", "overlap", "surface"):
        of = [row for row in rows if row["kind"] == kind and row["contrast"] == MIDDLE
              and row["seed"] == SEEDS[0]]
        of.sort(key=lambda row: row["depth"])
        right.plot([row["depth"] for row in of], [row["seconds"] for row in of],
                   color=COLOURS[kind], marker="o",
                   label="grains alone" if kind == "grains" else kind)
    right.set(xscale="log", yscale="log", xlabel="cover and base over h [-]",
              ylabel="processor time of a run [s]")
    for axes in (left, middle, right):
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(frameon=False, fontsize=10)
    figure.suptitle("Joining grains and mesh", x=0.055, ha="left", fontsize=13,
                    weight="bold", y=0.965)
    figure.text(0.055, 0.875, "10 grains across, L/h = 16, cover and base 2 h. Left: straight,"
                " cemented, three packings. Middle: bent, shortened by 5e-4. Right: buckling"
                f" runs at a contrast of {MIDDLE:g}.", fontsize=10)
    save(figure, directory, "joins")


def main():
    arguments = arguments_of(__doc__)
    scenes = [(contrast, 2., seed) for contrast in CONTRASTS for seed in SEEDS]
    scenes += [(MIDDLE, depth, SEEDS[0]) for depth in DEPTHS if depth != 2.]
    rows = [one(arguments, kind, *scene) for scene in scenes for kind in KINDS]
    compare(rows)
    bonds = [row for contact in CONTACTS for contrast in BENT
             for row in bent(arguments, contact, contrast)]
    write_table(bonds, os.path.join(arguments.directory, "bonds.csv"))
    write_table(rows, os.path.join(arguments.directory, "joins.csv"))
    with open(os.path.join(arguments.directory, "joins.md"), "w") as file:
        file.write(table(rows) + "\n" + bond_table(bonds))
    print(table(rows) + "\n" + bond_table(bonds))
    draw(rows, bonds, arguments.directory)


if __name__ == "__main__":
    main()
