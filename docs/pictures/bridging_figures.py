#!/usr/bin/python3
"""The figures of docs/theory/bridging.md, from what its tests measure.

  ANTIFORM_FIGURES=DIR build/tests/verification_coupling    (and stability_coupling)
  /usr/bin/python3 docs/pictures/bridging_figures.py DIR

With ANTIFORM_FIGURES set the tests write their tables into DIR (tests/support/figures.h):
patch_error, joint_forces_1 to _3, reflection, reflection_lattice, energy_smooth,
energy_noise, buckling_*. This writes bridging_*.svg beside itself, and .png into DIR.
"""
import argparse
import csv
import glob
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

BLUE, RED, GREY = "#1f4fa8", "#c0392b", "#777777"
COLOUR, RAMP = {0: BLUE, 1: RED}, {0: "linear ramp", 1: "cubic ramp"}


def table(directory, name):
    """The rows of a test's table: dictionaries of numbers."""
    path = os.path.join(directory, name + ".csv")
    if not os.path.exists(path):
        sys.exit(f"{path} is missing: run the tests, Long ones too, with ANTIFORM_FIGURES "
                 f"set to {directory}")
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()}
                for row in csv.DictReader(file)]


def paper(title, note, n_panels=1, size=(7.6, 4.8)):
    figure, axes = plt.subplots(1, n_panels, figsize=size, squeeze=False)
    figure.subplots_adjust(left=0.11, right=0.97, top=0.83, bottom=0.13, wspace=0.28)
    figure.suptitle(title, x=0.11, ha="left", fontsize=13, weight="bold", y=0.965)
    figure.text(0.11, 0.88, note, fontsize=9.5, color="#444444")
    for axis in axes[0]:
        axis.grid(color="#dddddd", linewidth=0.6)
        axis.set_axisbelow(True)
        for side in ("top", "right"):
            axis.spines[side].set_visible(False)
    return figure, axes[0]


def save(figure, directory, name):
    here = os.path.dirname(os.path.abspath(__file__))
    figure.savefig(os.path.join(here, name + ".svg"), metadata={"Date": None})
    figure.savefig(os.path.join(directory, name + ".png"), dpi=110)
    plt.close(figure)


def marker(axis, x, y, colour, face="white", **more):
    return axis.plot(x, y, color=colour, marker="o", markersize=6, markerfacecolor=face,
                     markeredgewidth=1.5, **more)[0]


def draw_patch(directory):
    rows = table(directory, "patch_error")
    figure, axes = paper(
        "Patch test: what the overlap adds",
        "Hexagonal lattice, core 16 d, cells of 2 d; worst of three unit strains. "
        "Bars: demanded at four cells.", 2, (9., 4.6))
    for axis, key, what, demand in (
            (axes[0], "core_strain", "error of the core's strain [-]", (1.5e-3, 5e-4)),
            (axes[1], "joint_force", "RMS error of the joint forces [-]",
             (4e-3, 1.5e-3))):
        for cubic in (0, 1):
            of = [row for row in rows if row["cubic"] == cubic]
            marker(axis, [row["width_over_cell"] for row in of],
                   [row[key] for row in of], COLOUR[cubic], label=RAMP[cubic])
            axis.plot([3.5, 4.6], [demand[cubic]] * 2, color=COLOUR[cubic], linewidth=3,
                      alpha=0.45, solid_capstyle="butt")
        start = max(row[key] for row in rows)
        for power, at in ((1, 1.55), (2, 0.62)):
            x = [2.6, 8.]
            axis.plot(x, [at * start * (1. / v) ** power for v in x], color=GREY,
                      linewidth=0.9, linestyle=":")
            axis.annotate("1/w" if power == 1 else "1/w²",
                          (x[1], at * start / x[1] ** power), xytext=(3, -2),
                          textcoords="offset points", fontsize=9, color=GREY)
        axis.set(xscale="log", yscale="log", xlabel="width of the overlap [cells]",
                 ylabel=what, xlim=(0.9, 10.5))
        axis.set_xticks([1, 2, 3, 4, 6, 8], ["1", "2", "3", "4", "6", "8"])
        axis.set_xticks([], minor=True)
    axes[0].legend(frameon=False, fontsize=10, loc="lower left")
    save(figure, directory, "bridging_patch")


def draw_joint_forces(directory):
    packings = [table(directory, f"joint_forces_{seed}") for seed in (1, 2, 3)]
    figure, (axis,) = paper(
        "Joint forces beside the overlap, random packings",
        "RMS error in strips of 2 d, worst of stretch and shear; three packings (thin) "
        "and their mean.")
    for key, colour, label in (
            ("multipliers_per_grain", RED, "one multiplier a grain"),
            ("multipliers_of_mesh", BLUE, "multipliers of the mesh (default)")):
        depth = [row["depth"] for row in packings[0]]
        for rows in packings:
            axis.plot(depth, [100. * row[key] for row in rows], color=colour,
                      linewidth=0.8, alpha=0.45)
        marker(axis, depth, [sum(100. * rows[k][key] for rows in packings) / 3.
                             for k in range(len(depth))], colour, label=label)
    axis.axvspan(-1.2, 0., color="#eeeeee", zorder=0)
    axis.text(-0.6, 2.6, "overlap", rotation=90, ha="center", va="center", color=GREY)
    axis.set(xlabel="depth in the core, from its rim inwards [d]",
             ylabel="error of the joint forces [%]", xlim=(-1.2, 12.), ylim=(0., 5.2))
    axis.legend(frameon=False, fontsize=10)
    save(figure, directory, "bridging_joint_forces")


def draw_reflection(directory):
    rows, lattice = table(directory, "reflection"), table(directory, "reflection_lattice")
    figure, axes = paper(
        "Reflected amplitude of a wave packet that runs from grains into the mesh",
        "Cells of 2 d. Lines: chain; crosses: P-wave on the lattice. "
        "Grey: demand where the mesh resolves the wave.", 2, (10., 4.8))
    figure.subplots_adjust(left=0.09)
    for text in figure.texts:
        text.set_x(0.09)
    for axis, cells, limits in ((axes[0], 4., ((8., 2., "2 %"),)),
                                (axes[1], 8., ((6., 1.2, "1.2 % linear"),
                                               (6., 0.6, "0.6 % cubic")))):
        axis.axvspan(2.3, 3., color="#eeeeee", zorder=0)
        axis.text(2.63, 0.045, "above the mesh's\nhighest frequency", rotation=90,
                  ha="center", va="bottom", fontsize=8.5, color=GREY)
        for n, value, text in limits:
            axis.plot([n, 21.], [value] * 2, color=GREY, linewidth=1.2, linestyle="--")
            axis.text(20.8, value * 1.07, text, ha="right", fontsize=9, color=GREY)
        for cubic in (0, 1):
            of = [row for row in rows
                  if row["cubic"] == cubic and row["width_over_cell"] == cells]
            axis.plot([row["cells_per_wavelength"] for row in of],
                      [100. * row["amplitude"] for row in of], color=COLOUR[cubic],
                      marker="o", markersize=4, label=RAMP[cubic])
            of = [row for row in lattice
                  if row["cubic"] == cubic and row["width_over_cell"] == cells]
            axis.plot([row["cells_per_wavelength"] for row in of],
                      [100. * row["amplitude"] for row in of], color=COLOUR[cubic],
                      marker="x", markersize=7, linestyle="none")
        axis.set(xscale="log", yscale="log", xlim=(2.3, 21.), ylim=(0.04, 130.),
                 xlabel="cells a wavelength", ylabel="reflected amplitude [%]")
        axis.set_title(f"overlap of {cells:.0f} cells", fontsize=10.5, loc="left")
        axis.set_xticks([3, 4, 6, 8, 12, 20], ["3", "4", "6", "8", "12", "20"])
        axis.set_xticks([], minor=True)
        axis.set_yticks([0.1, 1., 10., 100.], ["0.1", "1", "10", "100"])
    axes[0].legend(frameon=False, fontsize=10)
    figure.subplots_adjust(top=0.79)
    save(figure, directory, "bridging_reflection")


def draw_energy(directory):
    figure, axes = paper(
        "1e5 undamped steps at 0.9 of the stable step",
        "Block of lattice and mesh, held at its outer boundary. Dashed: demanded limits.", 2,
        (9.4, 4.6))
    for name, colour, label, limit in (
            ("energy_noise", RED, "white noise", 5e-4),
            ("energy_smooth", BLUE, "smooth pulse", 1e-5)):
        rows = table(directory, name)[1:]
        steps = [row["step"] / 1e5 for row in rows]
        axes[0].plot(steps, [max(abs(row["drift"]), 1e-17) for row in rows], color=colour,
                     linewidth=1., label=label)
        axes[0].axhline(limit, color=colour, linewidth=1.2, linestyle="--")
        axes[1].plot(steps, [row["gap"] for row in rows], color=colour, linewidth=1.,
                     label=label)
    axes[1].axhline(1e-10, color=GREY, linewidth=1.2, linestyle="--")
    axes[0].set(yscale="log", ylabel="change of energy over energy [-]", ylim=(1e-17, 3e-3))
    axes[1].set(yscale="log", ylabel="displacement gap over displacement [-]",
                ylim=(1e-17, 1e-9))
    for axis in axes:
        axis.set(xlabel="steps [100,000]", xlim=(0., 1.))
    axes[0].legend(frameon=False, fontsize=10, loc=(0.58, 0.55))
    save(figure, directory, "bridging_energy")


def buckling_rows(directory):
    """(label, errors of the modes in percent) of every case, by cover and contrast."""
    cases = []
    for path in sorted(glob.glob(os.path.join(directory, "buckling_*.csv"))):
        name = os.path.basename(path)[:-4]
        rows = table(directory, name)
        head = rows[0]
        label = (f"H/h {head['cover_over_thickness']:.2g}, contrast "
                 f"{head['contrast']:g}")
        for part, text in (("random", "random packing"), ("eight", "eight modes"),
                           ("no_buffer", "overlap 2 cells, no buffer")):
            if part in name:
                label += f" ({text})"
        if "_wide" not in name and "H_h_1" in name and "10000" not in name \
                and "random" not in name and "H_h_10" not in name:
            continue  # the short sections of the fast suite
        cases.append((("random" in name, "eight" in name, "buffer" in name,
                       head["cover_over_thickness"], head["contrast"], name),
                      f"{label}, {100. * head['share']:.0f} % of the grains",
                      [100. * (row["coupled"] / row["grains"] - 1.) for row in rows]))
    return [(label, errors) for _, label, errors in sorted(cases)]


def draw_buckling(directory):
    cases = buckling_rows(directory)
    if len(cases) < 6:
        sys.exit("the tables buckling_* are missing: run the Long tests")
    figure, (axis,) = paper(
        "Critical shortening of a bonded layer, coupled against grains alone",
        "Static solution, lowest modes of the constrained tangent. Shaded: demanded.",
        1, (9., 1.6 + 0.38 * len(cases)))
    figure.subplots_adjust(left=0.50, top=0.84, bottom=0.13)
    for text in figure.texts:
        text.set_x(0.03)
    axis.axvspan(-2., 2., color="#eef2f8", zorder=0)
    axis.axvline(0., color=GREY, linewidth=0.8)
    for row, (label, errors) in enumerate(cases):
        for k, error in list(enumerate(errors))[::-1]:
            axis.plot(error, row, marker="o", markersize={0: 6., 1: 9.5}.get(k, 4.5),
                      markerfacecolor=BLUE if k == 0 else "white",
                      markeredgecolor=BLUE if k < 2 else GREY, markeredgewidth=1.4,
                      linestyle="none",
                      label={0: "first mode", 1: "second", 2: "higher"}.get(k)
                      if row == max(range(len(cases)), key=lambda i: len(cases[i][1]))
                      else None)
    axis.set_yticks(range(len(cases)), [label for label, _ in cases], fontsize=9)
    axis.invert_yaxis()
    axis.set(xlabel="coupled over grains alone, less one [%]", xlim=(-2.4, 2.4))
    handles, labels = axis.get_legend_handles_labels()
    order = [labels.index(name) for name in ("first mode", "second", "higher")]
    axis.legend([handles[i] for i in order], [labels[i] for i in order], frameon=False,
                fontsize=9, loc="upper right")
    save(figure, directory, "bridging_buckling")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="with the tables of the tests, and for the .png")
    directory = parser.parse_args().directory
    for draw in (draw_patch, draw_joint_forces, draw_reflection, draw_energy,
                 draw_buckling):
        draw(directory)


if __name__ == "__main__":
    main()
