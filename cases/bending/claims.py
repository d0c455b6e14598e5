#!/usr/bin/python3
"""What is claimed of three beds, stiff, weak and stiff, that turning walls bend.

    /usr/bin/python3 cases/bending/claims.py RUN_DIR [RUN_DIR ...]

Runs of multilayer.prm, one a packing ('Layer/Seed'). Prints a table: claim, what was measured
in each run, the limit, and in how many runs the claim holds. Claims and limits were fixed
before the first run:

  weak      at least 80 % of the first 50 cracks are in the weak bed (the middle one)
  ends      of its first 5 cracks, at least 4 lie within one thickness of the bed of the
            layer's ends, before bending
  slower    cracks a degree while the walls turn from 1 to 2.8 degrees, over those before
            that: below 1
  faster    the same over those after it, to the end of the run: below 1
"""
import argparse
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from run_files import Run, RunError, read_deck  # noqa: E402

FIRST, OF_ENDS = 50, 5
SLOW = (1., 2.8)  # [degrees]
WEAK = 2  # of the column layer of cracks.csv: 0, 2 and 3 are the beds from below


def ends_of(run):
    """Where the layer begins and ends along x before bending [m]."""
    grains = run.frame(run.step_numbers[0]).grains
    x, radius = grains.points[:, 0], grains.field("radius_m")
    return (x - radius).min(), (x + radius).max()


def bed_thickness(run):
    """Of the weak bed [m]."""
    deck = read_deck(os.path.join(run.directory, "deck.prm"))
    ratios = [float(ratio) for ratio in deck["Beds/Thickness ratios"].split(",")]
    return float(deck["Layer/Thickness"]) * ratios[1] / sum(ratios)


def crack_rate(run, begin, end):
    """Cracks a degree of wall rotation; None where the walls have not turned that far."""
    last = run.history["wall_rotation_deg"].max()
    if last <= begin:
        return None
    rotation = run.cracks["wall_rotation_deg"]
    return np.count_nonzero((rotation >= begin) & (rotation < end)) / (min(end, last) - begin)


def share(part, whole):
    return None if part is None or not whole else part / whole


def weak_share(run):
    first = run.cracks["layer"][:FIRST]
    return np.count_nonzero(first == WEAK) / FIRST if len(first) == FIRST else None


def cracks_at_ends(run):
    x = run.cracks["reference_x_m"][run.cracks["layer"] == WEAK][:OF_ENDS]
    begin, end = ends_of(run)
    near = np.minimum(x - begin, end - x) <= bed_thickness(run)
    return float(np.count_nonzero(near)) if len(x) == OF_ENDS else None


def slow_over(run, begin, end):
    return share(crack_rate(run, *SLOW), crack_rate(run, begin, end))


CLAIMS = (
    ("weak", "share of the first 50 cracks in the weak bed", weak_share, ">= 0.8",
     lambda x: x >= 0.8),
    ("ends", "of its first 5, within its thickness of the ends", cracks_at_ends, ">= 4",
     lambda x: x >= 4),
    ("slower", "crack rate from 1 to 2.8 degrees over that before",
     lambda run: slow_over(run, 0., SLOW[0]), "< 1", lambda x: x < 1.),
    ("faster", "the same over that after",
     lambda run: slow_over(run, SLOW[1], np.inf), "< 1", lambda x: x < 1.))


def table_of(runs):
    """The lines of the table, in Markdown."""
    names = [os.path.basename(os.path.abspath(run.directory)) for run in runs]
    yield "| claim | measure | limit | " + " | ".join(names) + " | holds in |"
    yield "| --- " * (4 + len(runs)) + "|"
    for name, measure, value_of, limit, holds in CLAIMS:
        values = [value_of(run) for run in runs]
        cells = ["-" if value is None else f"{value:.3g}" for value in values]
        n = sum(value is not None and bool(holds(value)) for value in values)
        yield " | ".join([f"| {name}", measure, limit, *cells, f"{n} of {len(runs)} |"])


def read(directory):
    run = Run(directory)
    if (run.history is None or run.cracks is None
            or "wall_rotation_deg" not in run.history):
        raise RunError(f"'{directory}' holds no run of turning walls: history.csv has no "
                       "wall_rotation_deg. Give directories of runs of multilayer.prm.")
    return run


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directories", nargs="+", help="runs of multilayer.prm")
    directories = parser.parse_args().directories
    try:
        print("\n".join(table_of([read(directory) for directory in directories])))
    except RunError as error:
        sys.exit(f"claims.py: {error}")


if __name__ == "__main__":
    main()
