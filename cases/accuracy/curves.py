#!/usr/bin/python3
"""What accuracy costs: error against processor time of every knob, and the record of it.

    /usr/bin/python3 cases/accuracy/curves.py ANTIFORM DIRECTORY

Runs the studies of this folder into DIRECTORY, one thread, one run after the other, packings
made anew; what has ended is not run again. Then writes record.csv (which the program chooses
by, 'set Accuracy = 5 %'), accuracy.md (its tables) and accuracy.svg/.png there, and says
where an error does not fall as the time grows, beyond the scatter.
"""
import csv
import datetime
import math
import os
import statistics
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from study_runs import arguments_of, save, write_table  # noqa: E402

FINER = {"grains-fine": ("grains", "Layer/Grains across = 30, 30, 30, 40, 40, 40, 60 & "
                         "Layer/Seed = 1, 2, 3, 1, 2, 3, 1"),
         "strength-fine": ("strength",
                           "Layer/Grains across = 30 ; Layer/Seed = seeds 1 to 5"),
         "rate-slow": ("rate", "Walls/Transits per millistrain = 800 ; "
                       "Layer/Seed = seeds 1 to 3"),
         "specimen-events": ("specimen-rate", "Walls/Loading = event driver ; "
                             "Layer/Seed = seeds 1 to 10"),
         "slender-events": ("slender-rate", "Walls/Balance tolerance = 9e-3, 3e-3, 1e-3, "
                            "3e-4 ; Layer/Seed = seeds 1 to 3",
                            "Walls/Loading=event driver")}
STUDIES = ("grains", "strength", "balance", "rate", "specimen-rate", "slender-rate",
           "relaxation", "damping", "cells", "overlap", "joins", "elements", *FINER)
# The layer of slender-rate.prm, seed 1, at other walls: transits per millistrain, peak [Pa]
# and steps by the table in cases/shortening/README.md.
OTHER_WALLS = ((282., 31.24e6, 293121), (940., 26.36e6, 785313), (1880., 24.29e6, 1331617),
               (3760., 22.38e6, 2355799), (7520., 21.34e6, 4370177))
MACHINE = "AMD EPYC (shared)"  # no commas in the record
PEAK, CRITICAL = "peak_stress_Pa", "critical_stress_Pa"


def make(antiform, directory, name):
    """The study, gone on with where it was left; its lines."""
    deck, *extra = FINER.get(name, (name,))
    command = [antiform, "study", os.path.join(HERE, deck + ".prm"), "-o",
               os.path.join(directory, name), "--jobs", "1"]
    if extra:
        command += ["--set", "Study/Vary=" + extra[0]]
    for entry in extra[1:]:
        command += ["--set", entry]
    done = subprocess.run(command, env={**os.environ, "ANTIFORM_CACHE": "off",
                                        "OMP_THREAD_LIMIT": "1"})
    if done.returncode not in (0, 2):
        sys.exit(f"the study {name} has not been made")
    return lines_of(directory, name)


def lines_of(directory, name):
    with open(os.path.join(directory, name, "study.csv")) as file:
        lines = [line for line in csv.DictReader(file) if line["status"] == "completed"]
    for line in lines:
        for key, text in line.items():
            try:
                line[key] = float(text)
            except ValueError:
                pass
    return lines


class Knob:
    """Errors of one entry's values, packing by packing: a curve in a panel, which others of
    the same panel share. They speak of layers with L/h of up to @p largest_length_ratio."""

    def __init__(self, name, entry, of, truth, default, panel=None, curve="",
                 largest_length_ratio="any"):
        self.name, self.entry, self.of, self.truth = name, entry, of, truth
        self.default, self.panel = default, panel or entry.split("/")[-1].lower()
        self.curve, self.largest_length_ratio = curve, largest_length_ratio
        self.label = self.panel + (", " + curve if curve else "")
        self.rows = []

    def add(self, value, errors, lines):
        """From coarse to fine. A single packing scatters no less than those before it."""
        scatter = statistics.stdev(errors) if len(errors) > 1 else 0.
        if len(errors) == 1 and self.rows:
            scatter = 0.01 * self.rows[-1]["scatter_percent"]
        self.rows.append({
            "knob": self.name, "entry": self.entry,
            "value": value if isinstance(value, str) else f"{value:g}",
            "error_percent": round(100. * statistics.mean(errors), 4) + 0.,  # no -0
            "scatter_percent": round(100. * scatter, 4), "packings": len(errors),
            "cpu_seconds": round(statistics.median(l["cpu_seconds"] for l in lines), 3),
            "grains": round(statistics.mean(l.get("sizes_grains", 0.) for l in lines)),
            "default": "yes" if value == self.default else "no", "of": self.of,
            "truth": self.truth, "largest_length_ratio": self.largest_length_ratio,
            "measured": f"{datetime.date.today()} {MACHINE}"})

    def by(self, column, lines, quantity, truth_of, coarse_to_fine):
        """A row of each value of @p column; truth_of(line) is what it should be, None where
        that is not known (a run at the finest tolerance may find no balance)."""
        for value in coarse_to_fine:
            of = [line for line in lines
                  if line[column] == value and truth_of(line) is not None]
            if of:
                self.add(value, [line[quantity] / truth_of(line) - 1. for line in of], of)
        return self


def limit_of(lines, quantity, power):
    """The value that (1 - c/n)^power tends to, by least squares over the means."""
    sizes = sorted({line["grains_across"] for line in lines})
    means = [statistics.mean(line[quantity] for line in lines if line["grains_across"] == n)
             for n in sizes]
    # A straight line of mean^(1/power) over 1/n; its value at 0.
    x, y = [1. / n for n in sizes], [m ** (1. / power) for m in means]
    mx, my = statistics.mean(x), statistics.mean(y)
    slope = sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)
    top = my - slope * mx
    print(f"{quantity}: limit {top ** power:.5g}, c = {-slope / top:.3f}; measured over "
          "fitted less 1: " + ", ".join(
              f"{n:g}: {100. * (m / (top + slope / n) ** power - 1.):+.2f} %"
              for n, m in zip(sizes, means)))
    return top ** power


def paired(lines, quantity, *columns):
    """By seed (and other columns): the truth of the same packing."""
    of = {tuple(line[c] for c in columns): line[quantity] for line in lines}
    return lambda line: of.get(tuple(line[c] for c in columns))


def grains_knobs(studies):
    entry, default = "Layer/Grains across", 12.
    elastic = studies["grains"] + studies["grains-fine"]
    sizes = sorted({line["grains_across"] for line in elastic})
    knobs = []
    for name, quantity, of, power in (
            ("grains in bending", CRITICAL, "critical stress", 3.),
            ("grains in stiffness", "layer_plane_modulus_Pa", "modulus of the section", 1.)):
        limit = limit_of(elastic, quantity, power)
        truth = f"the limit of (1 - c/n)^{power:g}" if power > 1. else "the limit of 1 - c/n"
        knobs.append(Knob(name, entry, of, truth, default, name).by(
            "grains_across", elastic, quantity, lambda line, limit=limit: limit, sizes))
    strong = studies["strength"] + studies["strength-fine"]
    sizes = sorted({line["grains_across"] for line in strong})
    finest = statistics.mean(line[PEAK] for line in strong
                             if line["grains_across"] == sizes[-1])
    knobs.append(Knob("grains in strength", entry, "peak stress of a specimen",
                      f"the mean of {sizes[-1]:g} grains across", default,
                      "grains in strength").by(
        "grains_across", strong, PEAK, lambda line: finest, sizes))
    return knobs


def rate_and_balance(rates, balance, **scene):
    """Of one layer: what its walls' speed does, and the tolerance of its event driver; the
    truth of both."""
    *tolerances, finest = sorted({line["balance_tolerance"] for line in balance})[::-1]
    truth = paired([line for line in balance if line["balance_tolerance"] == finest], PEAK,
                   "seed")
    of = "peak stress of a bent layer"
    finest_text = f"{finest:.0e}".replace("e-0", "e-")
    words = f"the event driver at a tolerance of {finest_text} (same packings)"
    return (Knob("loading rate of a layer", "Walls/Transits per millistrain", of, words,
                 300., "loading rate of a bent layer", **scene).by(
                     "transits_per_millistrain", rates, PEAK, truth,
                     sorted({line["transits_per_millistrain"] for line in rates})),
            Knob("balance tolerance", "Walls/Balance tolerance", of, words, 1e-3,
                 **scene).by("balance_tolerance", balance, PEAK, truth, tolerances), truth)


def add_other_walls(rate, line, truth, scatter):
    """Those of the table to the knob @p rate, which has @p line, of 300 transits. All are of
    one packing, which tells nothing of their @p scatter [%]; seconds follow from the steps,
    as many as the transits."""
    seconds = line["cpu_seconds"] / (OTHER_WALLS[0][2] * 300. / OTHER_WALLS[0][0])
    for transits, peak, steps in OTHER_WALLS:
        rate.add(transits, [peak / truth(line) - 1.],
                 [{**line, "cpu_seconds": seconds * steps}])
    rate.rows.sort(key=lambda row: float(row["value"]))
    for row in rate.rows:
        row["scatter_percent"] = scatter


def loading_knobs(studies):
    rate, balance, truth = rate_and_balance(
        studies["rate"] + studies["rate-slow"], studies["balance"], curve="L/h = 12",
        largest_length_ratio=12)
    slender, its_balance, its_truth = rate_and_balance(
        studies["slender-rate"], studies["slender-events"], curve="L/h = 33.7",
        largest_length_ratio=33.8)
    add_other_walls(slender, studies["slender-rate"][0], its_truth,
                    max(row["scatter_percent"] for row in rate.rows))
    specimen = Knob(
        "loading rate of a specimen", "Walls/Transits per millistrain",
        "peak stress of a specimen", "the event driver (same packings)", 300.,
        "loading rate of a specimen", largest_length_ratio=4).by(
            "transits_per_millistrain", studies["specimen-rate"], PEAK,
            paired(studies["specimen-events"], PEAK, "seed"),
            (5., 10., 25., 50., 100., 200., 300., 400.))
    of, stepped, damped = rate.of, studies["relaxation"], studies["damping"]
    knobs = [rate, slender, specimen, balance, its_balance]
    for name, entry, default, panel, lines, values in (
            ("load step", "Walls/Load step", 4e-5, None,
             [l for l in stepped if l["relaxation_tolerance"] == 1e-4], (1.6e-4, 8e-5, 4e-5)),
            ("relaxation tolerance", "Walls/Relaxation tolerance", 1e-4, None,
             [l for l in stepped if l["load_step"] == 4e-5], (1e-2, 1e-3, 1e-4)),
            ("damping", "Damping/Coefficient", 0.7, "damping coefficient",
             [l for l in damped if l["step_safety"] == 0.9], (0.9, 0.7, 0.5, 0.3)),
            ("step safety", "Run/Step safety", 0.9, None,
             [l for l in damped if l["coefficient"] == 0.7], (0.9, 0.3))):
        column = entry.split("/")[1].lower().replace(" ", "_")
        knobs.append(Knob(name, entry, of, rate.truth, default, panel,
                          largest_length_ratio=12).by(column, lines, PEAK, truth, values))
    return knobs


def join_knobs(studies):
    alone = [line for line in studies["joins"]
             if line["layer_representation"] == line["matrix_representation"] == "grains"]
    truth = paired(alone, CRITICAL, "seed", "stiffness_contrast")
    at_100 = paired([line for line in alone if line["stiffness_contrast"] == 100.],
                    CRITICAL, "seed")
    of, words = "critical stress of a buried layer", "grains everywhere (same packings)"
    overlap = studies["overlap"]
    knobs = [
        Knob("cells beside grains", "Matrix/Cell size ratio", of, words, 2.,
             "cells beside grains").by(
            "cell_size_ratio", studies["cells"], CRITICAL, at_100, (8., 4., 2., 1.)),
        Knob("overlap", "Bridging domain/Overlap width ratio", of, words, 4.,
             "overlap width").by(
            "overlap_width_ratio", [l for l in overlap if l["buffer_width_ratio"] == 4.],
            CRITICAL, at_100, (2., 4., 8.)),
        Knob("buffer", "Bridging domain/Buffer width ratio", of, words, 4.,
             "buffer width").by(
            "buffer_width_ratio", [l for l in overlap if l["overlap_width_ratio"] == 8.],
            CRITICAL, at_100, (1., 4., 8.))]
    for contrast in (20., 100., 1e4):
        knob = Knob(f"representation at a contrast of {contrast:g}", "Matrix/Join", of, words,
                    "overlap", "representation", f"contrast {contrast:g}")
        ways = [(way, [l for l in studies["joins"] if is_it(l)
                       and l["stiffness_contrast"] == contrast]) for way, is_it in (
            ("elements", lambda l: l["layer_representation"] == "continuum"),
            ("surface", lambda l: l["join"] == "surface interface"),
            ("overlap", lambda l: l["matrix_representation"] == "continuum"
             and l["layer_representation"] == "grains" and l["join"] == "bridging domain"))]
        for way, lines in sorted(ways, key=lambda pair: statistics.median(
                line["cpu_seconds"] for line in pair[1])):
            knob.add(way, [l[CRITICAL] / truth(l) - 1. for l in lines], lines)
        knobs.append(knob)
    return knobs


def element_knobs(studies):
    lines = studies["elements"]
    for line in lines:
        line["cell"] = line["cell_size_ratio"] / 4.  # over the layer's thickness
    fine = {line["cell"]: line[CRITICAL] for line in lines if line["element_degree"] == 2.}
    least = min(fine)
    limit = fine[least] + (fine[least] - fine[2. * least]) / (2. ** 4 - 1.)
    cells = sorted({line["cell"] for line in lines}, reverse=True)
    default = min(cells, key=lambda cell: abs(cell - 2. / 12.))  # 2 of 12 diameters
    return [Knob(name + " cells", "Matrix/Cell size ratio", "critical stress of a buried "
                 "layer", "the limit of the two finest quadratic meshes", default,
                 "finite elements, cells over h", name).by(
        "cell", [l for l in lines if l["element_degree"] == degree], CRITICAL,
        lambda line: limit, cells) for name, degree in (("bilinear", 1.), ("quadratic", 2.))]


def where_not_monotone(knob):
    """Neighbours of which the dearer one is further off, beyond their standard errors."""
    for coarse, fine in zip(knob.rows, knob.rows[1:]):
        known = math.hypot(*(row["scatter_percent"] / math.sqrt(row["packings"])
                             for row in (coarse, fine)))
        rise = abs(fine["error_percent"]) - abs(coarse["error_percent"])
        if rise > 2. * known:
            yield (f"{knob.label}: {coarse['value']} to {fine['value']}: error "
                   f"{coarse['error_percent']:+.2f} to {fine['error_percent']:+.2f} %")


# Where labels stand that others would cover, in points from their marks.
PLACES = {("damping", "0.7"): (9, -12),
          ("representation at a contrast of 20", "elements"): (-46, -3),
          ("representation at a contrast of 20", "surface"): (6, 2),
          ("representation at a contrast of 20", "overlap"): (-20, 11),
          ("representation at a contrast of 100", "elements"): (-46, -3),
          ("representation at a contrast of 100", "surface"): (6, -3),
          ("representation at a contrast of 100", "overlap"): (-14, -18),
          ("representation at a contrast of 10000", "overlap"): (-50, -6),
          ("loading rate of a layer", "282"): (6, 4),
          ("loading rate of a layer", "940"): (4, 6),
          ("damping", "0.5"): (-22, -3), ("damping", "0.3"): (-22, -3),
          ("balance tolerance", "0.0003"): (-24, 8),
          ("grains in bending", "10"): (6, 1), ("grains in stiffness", "10"): (6, 1),
          ("loading rate of a specimen", "25"): (-14, -11),
          ("buffer", "1"): (6, -4), ("load step", "8e-05"): (-32, -4),
          ("bilinear cells", "0.1"): (-6, -14), ("bilinear cells", "0.05"): (-10, -14)}


def shown(row):
    """Its value, short."""
    try:
        return f"{float(row['value']):.3g}" if len(row["value"]) > 6 else row["value"]
    except ValueError:
        return row["value"]


def draw_one(axes, knob, colour="#1f4fa8", marker="o"):
    rows = [row for row in knob.rows if row["error_percent"] != 0.]  # not the truth itself
    x = [row["cpu_seconds"] for row in rows]
    y = [abs(row["error_percent"]) for row in rows]
    low = [max(a - row["scatter_percent"], 0.4 * a) for a, row in zip(y, rows)]
    high = [a + row["scatter_percent"] for a, row in zip(y, rows)]
    axes.errorbar(x, y, yerr=[[a - b for a, b in zip(y, low)],
                              [b - a for a, b in zip(y, high)]],
                  color=colour, marker=marker, markersize=5, markerfacecolor="white",
                  markeredgewidth=1.4, linewidth=1.2, elinewidth=0.8, capsize=2,
                  label=knob.curve)
    for a, b, row in zip(x, y, rows):
        default = row["default"] == "yes"
        place = PLACES.get((knob.name, row["value"]), (-17, -14) if default else (5, 4))
        axes.annotate(shown(row), (a, b), textcoords="offset points", xytext=place,
                      fontsize=8, color=colour)
        if default:
            axes.plot([a], [b], marker="o", markersize=13, markerfacecolor="none",
                      markeredgecolor="black", linestyle="none")


def with_plain_ticks(axes, least_x=4., least_y=20.):
    """At 1, 2, 5 of each power of ten, over no less than these factors."""
    for axis, limits, least in ((axes.xaxis, axes.get_xlim(), least_x),
                                (axes.yaxis, axes.get_ylim(), least_y)):
        wider = max(1., math.sqrt(least * limits[0] / limits[1]))
        limits = (limits[0] / wider, limits[1] * wider)
        (axes.set_xlim if axis is axes.xaxis else axes.set_ylim)(*limits)
        subs = (1., 2., 5.) if limits[1] < 60. * limits[0] else (1.,)
        axis.set_major_locator(matplotlib.ticker.LogLocator(subs=subs))
        axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda v, _: f"{v:g}"))
        axis.set_minor_locator(matplotlib.ticker.NullLocator())


def draw(knobs, directory):
    panels = [[k for k in knobs if k.panel == panel]
              for panel in dict.fromkeys(k.panel for k in knobs)]
    columns = 3
    lines = -(-len(panels) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(11.4, 2.75 * lines + 0.7))
    for place, of in zip(axes.flat, panels):
        for knob, colour, marker in zip(of, ("#1f4fa8", "#c0392b", "#2e8b57"), "osD"):
            draw_one(place, knob, colour, marker)
        place.set(xscale="log", yscale="log")
        place.grid(color="#dddddd", linewidth=0.6)
        place.margins(x=0.2, y=0.15)
        with_plain_ticks(place)
        place.set_title(of[0].panel, fontsize=10, loc="left")
        if len(of) > 1:
            place.legend(frameon=False, fontsize=8, loc="lower right" if "rate" in of[0].panel
                         else "lower left" if "tolerance" in of[0].panel else "best")
        place.tick_params(labelsize=8)
    for place in axes.flat[len(panels):]:
        place.set_visible(False)
    for row in axes:
        row[0].set_ylabel("error [%]", fontsize=9)
    for place in axes[-1]:
        place.set_xlabel("processor time of a run [s]", fontsize=9)
    inch = 1. / figure.get_figheight()
    figure.suptitle("What accuracy costs", x=0.06, ha="left", fontsize=13, weight="bold",
                    y=1. - 0.2 * inch)
    figure.text(0.06, 1. - 0.5 * inch, "Error of the mean of several "
                "packings; bars: standard deviation of one. The ring marks the default.",
                fontsize=10, va="top")
    figure.tight_layout(rect=(0., 0., 1., 1. - 0.6 * inch))
    save(figure, directory, "accuracy")


def tables(knobs):
    text = ""
    for knob in knobs:
        text += (f"### {knob.label[0].upper() + knob.label[1:]}\n\n`{knob.entry}`; error of "
                 f"the {knob.of} against {knob.truth}.\n\n| value | error | scatter of one "
                 "packing | packings | grains | CPU s |\n"
                 "| --- | --- | --- | --- | --- | --- |\n")
        for row in knob.rows:
            mark = " (default)" if row["default"] == "yes" else ""
            text += (f"| {shown(row)}{mark} | {row['error_percent']:+.3g} % | "
                     f"{row['scatter_percent']:.2g} % | {row['packings']} | "
                     f"{row['grains']:,} | "
                     f"{float(format(row['cpu_seconds'], '.2g')):g} |\n")
        text += "\n"
    return text


def main():
    arguments = arguments_of(__doc__)
    studies = {name: make(arguments.antiform, arguments.directory, name)
               for name in STUDIES}
    knobs = (grains_knobs(studies) + loading_knobs(studies) + join_knobs(studies)
             + element_knobs(studies))
    write_table([row for knob in knobs for row in knob.rows],
                os.path.join(arguments.directory, "record.csv"))
    with open(os.path.join(arguments.directory, "accuracy.md"), "w") as file:
        file.write(tables(knobs))
    draw(knobs, arguments.directory)
    found = [text for knob in knobs for text in where_not_monotone(knob)]
    print("Errors that do not fall as the time grows:\n  " + "\n  ".join(found or ["none"]))


if __name__ == "__main__":
    main()
