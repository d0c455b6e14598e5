#!/usr/bin/env python3
"""Picture of a calibration: strength envelope against its targets, and the search.

  python3 cases/calibration_plot.py DIR [--out FILE]

DIR is the output directory of 'antiform calibrate'; the picture is DIR/calibration.png.
"""

import argparse
import json
import os
import sys

try:
    import matplotlib
    import numpy as np
except ImportError as missing:
    sys.exit(f"calibration_plot.py: {missing}. Install python3-numpy and "
             f"python3-matplotlib, and use the python3 that has them (this one is "
             f"{sys.executable}).")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import MaxNLocator  # noqa: E402

TARGET, REACHED, PACKING = "#b2182b", "#2166ac", "#92c5de"
COLOURS = ["#1b1b1b", "#1b7837", "#2166ac", "#762a83", "#b35806", "#5a9bd4", "#8c6d31"]
LABELS = {"young_modulus": "Young's modulus", "tensile_strength": "tensile strength",
          "ucs": "UCS"}
MARKERS = "osD^vP*"


def label_of(target):
    name = target["name"]
    if name.startswith("strength_at_"):
        return rf"$\sigma_1$ at {1e-6 * target['sigma3_Pa']:g} MPa"
    return LABELS.get(name, name)


def is_strength(target):
    return target["test"] not in ("elastic",) and target["name"] != "young_modulus"


def point_of(target, value):
    """sigma_3, sigma_1 [MPa], compression positive."""
    if target["name"] == "tensile_strength":
        return -1e-6 * value, 0.
    return 1e-6 * target["sigma3_Pa"], 1e-6 * value


def hoek_brown(points):
    """Line through the compression tests: (sigma_1 - sigma_3)^2 over sigma_3."""
    points = [p for p in points if p[0] >= 0.]
    if len({p[0] for p in points}) < 2:
        return None
    s3, s1 = np.array(points).T
    slope, intercept = np.polyfit(s3, (s1 - s3) ** 2, 1)
    if intercept <= 0. or slope <= 0.:
        return None
    return slope / np.sqrt(intercept), np.sqrt(intercept)


def draw_hoek_brown(axes, points, largest, colour, name):
    fit = hoek_brown(points)
    if fit is None:
        return
    mi, sci = fit
    apex = -0.5 * sci * (np.sqrt(mi ** 2 + 4.) - mi)
    s3 = np.linspace(apex, largest, 400)
    inside = np.maximum(mi * sci * s3 + sci ** 2, 0.)
    axes.plot(s3, s3 + np.sqrt(inside), color=colour, linewidth=1.4, zorder=1,
              label=rf"{name}: $\sigma_{{ci}}$ = {sci:.4g} MPa, $m_i$ = {mi:.3g}")


def last_check(record):
    checks = [e for e in record["evaluations"] if e["stage"] == "check"]
    return checks[-1] if checks else None


def draw_envelope(axes, record):
    strengths = [t for t in record["targets"] if is_strength(t)]
    check = last_check(record)
    largest = 1.15 * max([1e-6 * t["sigma3_Pa"] for t in strengths] + [1.])
    wanted = [point_of(t, t["target"]) for t in strengths]
    draw_hoek_brown(axes, wanted, largest, TARGET, "targets")
    reached = []
    if check is not None:
        for t in strengths:
            values = check["results"][t["name"]]
            s3, s1 = np.array([point_of(t, v) for v in values]).T
            axes.plot(s3, s1, "o", color=PACKING, markersize=6, zorder=3,
                      label="packings of the check" if t is strengths[0] else None)
            reached.append((s3.mean(), s1.mean()))
        draw_hoek_brown(axes, reached, largest, REACHED, "reached")
        axes.plot(*np.array(reached).T, "D", color=REACHED, markersize=7, zorder=4,
                  label="their mean")
    for t, (s3, s1) in zip(strengths, wanted):
        along_x = t["name"] == "tensile_strength"
        bar = t["tolerance"] * (abs(s3) if along_x else s1)
        axes.errorbar(s3, s1, xerr=bar if along_x else None, yerr=None if along_x else bar,
                      color=TARGET, fmt="_" if not along_x else "|", markersize=16,
                      capsize=5, linewidth=1.6, zorder=5,
                      label="targets and tolerances" if t is strengths[0] else None)
    axes.axhline(0., color="#888888", linewidth=0.8)
    axes.axvline(0., color="#888888", linewidth=0.8)
    axes.set_xlabel(r"confinement $\sigma_3$ (MPa), compression +")
    axes.set_ylabel(r"strength $\sigma_1$ (MPa)")
    axes.legend(frameon=False, fontsize=9, loc="upper left")
    axes.grid(color="#dddddd", linewidth=0.6)


def steps_of(record):
    """Evaluations of all targets: those of the search, then the checks."""
    return [e for e in record["evaluations"] if e["stage"] in ("search", "check")]


def shade_checks(axes, steps):
    for k, step in enumerate(steps):
        if step["stage"] == "check":
            axes.axvspan(k + 0.5, k + 1.5, color="#eef4fa", zorder=0, linewidth=0)
    axes.set_xlim(0.5, len(steps) + 0.5)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(color="#dddddd", linewidth=0.6)


def draw_trace(axes, record, steps):
    x = np.arange(1, len(steps) + 1)
    for k, t in enumerate(record["targets"]):
        off = [(np.mean(s["results"][t["name"]]) / t["target"] - 1.) / t["tolerance"]
               for s in steps]
        axes.plot(x, off, marker=MARKERS[k % len(MARKERS)], color=COLOURS[k % len(COLOURS)],
                  linewidth=1.2, markersize=5,
                  label=f"{label_of(t)} ({100. * t['tolerance']:g} %)")
    for edge in (-1., 1.):
        axes.axhline(edge, color=TARGET, linewidth=1., linestyle="--")
    axes.axhline(0., color="#888888", linewidth=0.8)
    axes.set_ylabel("off target (tolerances)")
    shade_checks(axes, steps)
    axes.legend(frameon=False, fontsize=9, loc="center left", bbox_to_anchor=(1.01, 0.5))


def draw_parameters(axes, record, steps):
    x = np.arange(1, len(steps) + 1)
    for k, free in enumerate(record["free"]):
        values = np.array([s["parameters"][free["column"]] for s in steps])
        last = values[-1] if values[-1] else 1.
        unit = free["column"].rsplit("_", 1)[-1]
        shown = f"{values[-1]:.4g}" + (r"$\degree$" if unit == "deg" else "")
        if unit == "Pa":
            is_modulus = values[-1] >= 1e9
            shown = f"{values[-1] * (1e-9 if is_modulus else 1e-6):.4g} " + (
                "GPa" if is_modulus else "MPa")
        axes.plot(x, values / last, marker=MARKERS[k % len(MARKERS)],
                  color=COLOURS[k % len(COLOURS)], linewidth=1.2, markersize=5,
                  label=f"{free['name']}: {shown}")
    axes.set_ylabel("micro-parameters / last")
    axes.set_xlabel("evaluation (shaded: checks on fresh packings)")
    shade_checks(axes, steps)
    axes.legend(frameon=False, fontsize=9, loc="center left", bbox_to_anchor=(1.01, 0.5))


def draw(record, path):
    steps = steps_of(record)
    if not steps:
        sys.exit("calibration_plot.py: no evaluation is finished yet.")
    figure = plt.figure(figsize=(14.5, 6.6))
    grid = figure.add_gridspec(2, 2, width_ratios=[1.15, 1.], wspace=0.2, hspace=0.18,
                               left=0.055, right=0.835, top=0.9, bottom=0.09)
    draw_envelope(figure.add_subplot(grid[:, 0]), record)
    trace = figure.add_subplot(grid[0, 1])
    draw_trace(trace, record, steps)
    trace.tick_params(labelbottom=False)
    draw_parameters(figure.add_subplot(grid[1, 1]), record, steps)
    verdict = ("all targets met on fresh packings" if record["met"] else
               {"completed": "not all targets met on fresh packings"}.get(
                   record["status"], record["status"]))
    figure.suptitle(f"{record['title']}: {verdict}", fontsize=13, weight="bold")
    figure.savefig(path, dpi=150)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", metavar="DIR", help="of a calibration")
    parser.add_argument("--out", metavar="FILE", help="DIR/calibration.png by default")
    options = parser.parse_args()
    try:
        with open(os.path.join(options.directory, "calibration.json"),
                  encoding="utf-8") as file:
            record = json.load(file)
    except (OSError, json.JSONDecodeError) as error:
        sys.exit(f"calibration_plot.py: {error}. Give the output directory of 'antiform "
                 "calibrate'.")
    draw(record, options.out or os.path.join(options.directory, "calibration.png"))


if __name__ == "__main__":
    main()
