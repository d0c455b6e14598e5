#!/usr/bin/python3
"""Moment and cracks against the rotation of the walls, and where the beds have cracked.

    /usr/bin/python3 cases/bending/figures.py SINGLE MULTILAYER [--out DIR] [--step N]

Of a run of single-layer.prm and one of multilayer.prm: bending_curves.svg, and of the fields
N of the second (default 6) bending_fractures.png.
"""
import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import pictures  # noqa: E402  picks the way to draw without a screen
import matplotlib.pyplot as plt  # noqa: E402
from picture_style import TENSION_CRACK  # noqa: E402
from run_files import Run, RunError  # noqa: E402


def draw_curves(runs, path):
    figure, panels = plt.subplots(len(runs), 1, sharex=True, figsize=(8., 6.5))
    for axes, run in zip(panels, runs):
        loading, moment = run.loading(), run.response()
        axes.plot(loading.drawn, moment.drawn, color="#1f4fa8", linewidth=1.6)
        axes.set_ylabel(moment.label, color="#1f4fa8")
        axes.set_ylim(bottom=0.)
        axes.set_title(f"{run.summary['title']}; {run.summary['sizes']['grains']:,} grains",
                       fontsize=10, loc="left")
        axes.grid(color="#dddddd", linewidth=0.6)
        counts = axes.twinx()
        counts.plot(loading.drawn, run.history["cracks_tensile"] + run.history["cracks_shear"],
                    color=TENSION_CRACK, linewidth=1.4, linestyle="--")
        counts.set_ylabel("cracks so far", color=TENSION_CRACK)
        counts.set_ylim(bottom=0.)
    panels[-1].set_xlabel(loading.label)
    panels[-1].set_xlim(0., loading.drawn.max())
    figure.tight_layout()
    figure.savefig(path)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs=2, metavar="RUN_DIR")
    parser.add_argument("--out", default=".", metavar="DIR")
    parser.add_argument("--step", type=int, default=6, metavar="N")
    options = parser.parse_args()
    try:
        runs = [Run(directory) for directory in options.runs]
        pictures.DPI = 60  # a file below 300 kB
        draw_curves(runs, os.path.join(options.out, "bending_curves.svg"))
        pictures.fracture_map(runs[1], runs[1].frame(options.step),
                              os.path.join(options.out, "bending_fractures.png"))
    except (RunError, OSError) as error:
        sys.exit(f"figures.py: {error}")


if __name__ == "__main__":
    main()
