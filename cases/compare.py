#!/usr/bin/env python3
"""Finished runs of one scene side by side: what differs, by how much, and what each cost.

  python3 cases/compare.py RUN_DIR RUN_DIR [RUN_DIR ...] [--out DIR]

The first run is what the others are held against. Runs whose decks differ in seeds alone are
one row: their mean, and a difference is called more than scatter where it exceeds twice its
standard error; two packings of one deck are needed for that. Writes comparison.html,
comparison.csv and comparison.json.
"""

import argparse
import csv
import html
import itertools
import json
import os
import sys
import tempfile
from contextlib import redirect_stderr, redirect_stdout

import pictures
import matplotlib.pyplot as plt
import numpy as np
from comparison_measures import BETWEEN, MEASURES, measures
from curves_page import overlaid_curves
from report_page import Page, counted, write
from run_files import Run, RunError, read_deck

SEEDS = {"Layer/Seed", "Fractures/Seed"}
UNSEEN = SEEDS | {"Title"}  # entries that make no other scene


class Group:
    """Runs of one deck, with one seed or more."""

    def __init__(self, deck):
        self.deck, self.runs, self.name = deck, [], ""

    def add(self, run):
        self.runs.append(run)

    def values(self, measure):
        """Of the runs that have it."""
        found = [run.measures[measure] for run in self.runs]
        return np.array([value for value in found if value is not None])


def read_run(directory):
    run = Run(directory)
    deck = os.path.join(directory, "deck.prm")
    if not os.path.exists(deck) or not run.summary:
        raise RunError(f"'{directory}' holds no finished run: it has no "
                       + ("summary.json" if os.path.exists(deck) else "deck.prm") + ".")
    if run.summary.get("status") != "completed":
        raise RunError(f"'{directory}' holds a run that is {run.summary.get('status')}: only "
                       "completed runs can be compared. Go on with --resume.")
    if not run.history or len(run.history.get("shortening", ())) < 3:
        raise RunError(f"'{directory}' has no curve (history.csv): runs that step, and static "
                       "ones, can be compared.")
    run.deck = read_deck(deck)
    return run


def grouped(runs):
    groups = {}
    for run in runs:
        key = tuple(sorted((k, v) for k, v in run.deck.items() if k not in UNSEEN))
        groups.setdefault(key, Group(run.deck)).add(run)
    return list(groups.values())


def name_groups(groups):
    """By the entries in which the decks differ; \\return these entries."""
    names = sorted({name for group in groups for name in group.deck} - UNSEEN)
    differing = [name for name in names
                 if len({group.deck.get(name) for group in groups}) > 1]
    telling = [name for name in differing
               if all(name in group.deck for group in groups)] or differing
    for n, group in enumerate(groups):
        text = ", ".join(f"{name} = {group.deck.get(name, '-')}"
                         for name in telling[:3])
        if len(telling) > 3 or not text:
            text = os.path.basename(os.path.abspath(group.runs[0].directory))
        group.name = text
    return differing


def demand_one_scene(groups):
    """The layer's size and shape must be the same."""
    problems = []
    for name in ("Layer/Thickness", "Layer/Length ratio", "Layer/Shape",
                 "Layer/Amplitude ratio"):
        values = {group.deck.get(name) for group in groups}
        if len(values) > 1:
            problems.append(f"'{name}' is {' and '.join(sorted(map(str, values)))}")
    if problems:
        raise RunError("these are runs of different scenes: " + "; ".join(problems)
                       + ". Compare runs of one layer.")


def scatter(first, other):
    """Standard error of the difference of two means; None where no group has two seeds."""
    def variance(values):
        return np.var(values, ddof=1) if len(values) > 1 else None
    a, b = variance(first), variance(other)
    if a is None and b is None:
        return None
    a = b if a is None else a
    b = a if b is None else b
    return float(np.sqrt(a / len(first) + b / len(other)))


def verdict(difference, error):
    if error is None:
        return "unknown"
    return "more than scatter" if abs(difference) > 2. * error else "within scatter"


def compare(groups):
    """One dictionary a group and measure."""
    rows = []
    first = groups[0]
    for group in groups:
        for measure in MEASURES:
            values, reference = group.values(measure.name), first.values(measure.name)
            if not len(values):
                continue
            row = {"group": group.name, "runs": len(group.runs), "measure": measure.name,
                   "unit": measure.unit, "value": float(values.mean()),
                   "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
                   "difference": None, "scatter": None, "verdict": None}
            if group is not first and len(reference) and reference.mean() != 0.:
                row["difference"] = float(values.mean() / reference.mean() - 1.)
                error = scatter(reference, values)
                row["scatter"] = None if error is None else error / abs(reference.mean())
                row["verdict"] = (verdict(row["difference"], row["scatter"])
                                  if measure.scatters else "")
            rows.append(row)
        if group is not first:
            rows += field_rows(first, group)
    return rows


def field_rows(first, group):
    """Differences that are no differences of numbers: of zones and of fields. Scatter is
    what runs of one deck differ by, the reference's where it has more than one."""
    rows = []
    for measure in BETWEEN:
        def all_of(pairs):
            found = [measure.between(a, b) for a, b in pairs]
            return [value for value in found if value is not None]
        apart = all_of(itertools.product(first.runs, group.runs))
        own = [all_of(itertools.permutations(one.runs, 2)) for one in (first, group)]
        if not apart:
            continue
        scattered = own[0] or own[1]
        rows.append({"group": group.name, "runs": len(group.runs), "measure": measure.name,
                     "unit": measure.unit, "value": float(np.mean(apart)),
                     "deviation": None, "difference": None,
                     "scatter": float(np.mean(scattered)) if scattered else None,
                     "verdict": verdict(*means_apart(apart, own, (len(first.runs),
                                                                  len(group.runs))))})
    return rows


def means_apart(apart, own, n):
    """From distances between the runs of two groups of @p n and those within each: how far
    the groups' means are apart, and the standard error of that (None without any within).
    Squares add as those of points do: the mean one between is that of the means and
    (n - 1) / n of each group's variance, which is half of the mean one within."""
    variances = [np.mean(np.square(d)) / 2. if d else None for d in own]
    within = sum((k - 1.) / k * v for k, v in zip(n, variances) if v is not None)
    means = float(np.sqrt(max(0., np.mean(np.square(apart)) - within)))
    known = [v for v in variances if v is not None]
    if not known:
        return means, None
    a, b = (known[0] if v is None else v for v in variances)
    return means, float(np.sqrt(a / n[0] + b / n[1]))


def percent(x):
    return "" if x is None else f"{100. * x:+.2g} %"


def shown(row):
    """A value with its unit, as a reader wants it."""
    measure = next((m for m in MEASURES if m.name == row["measure"]), None)
    if measure is None:
        return f"{row['value']:.3g}" + ("" if row["unit"] == "-" else f" {row['unit']}")
    text = measure.text(row["value"])
    return text + (f" ± {100. * row['deviation'] / abs(row['value']):.2g} %"
                   if row["deviation"] and row["value"] else "")


def label_of(name):
    return next(m.label for m in MEASURES + BETWEEN if m.name == name)


def in_words(row):
    """The verdict of a row; what is missing for one is said once, not in every row."""
    return "" if row["verdict"] in (None, "unknown") else row["verdict"]


def what_is_missing(groups, rows):
    """Words and commands where differences cannot be told from scatter; None where they
    can."""
    if not any(row["verdict"] == "unknown" for row in rows):
        return None
    packed = next((g for g in groups if len(g.values("grains"))), None)
    if packed is None:
        return "There are no grains, so nothing scatters with a packing.", []
    directory = os.path.normpath(packed.runs[0].directory)
    seed = int(float(packed.deck.get("Layer/Seed", 1))) + 1
    other = f"{directory}-seed-{seed}"
    named = [os.path.normpath(run.directory) for group in groups for run in group.runs]
    named.insert(named.index(directory) + 1, other)
    return ("Whether a difference is more than the scatter of packings cannot be told: there "
            "is one packing of each scene. Two "
            + ("of the reference" if packed is groups[0] else f"of {packed.name}")
            + " are needed at least:",
            [f'antiform run {directory}/deck.prm -o {other} --set "Layer/Seed={seed}"',
             "antiform compare " + " ".join(named)])


def add_table(page, groups, rows):
    names = list(dict.fromkeys(row["measure"] for row in rows))
    can_be_told = any(map(in_words, rows))
    head = ["", groups[0].name + " (reference)"]
    for group in groups[1:]:
        head += [group.name, "difference"] + ["beside the scatter"] * can_be_told
    lines = []
    for name in names:
        line = [label_of(name)]
        for group in groups:
            row = next((r for r in rows if r["measure"] == name and r["group"] == group.name),
                       None)
            line.append("" if row is None else shown(row))
            if group is not groups[0]:
                line += (["" if row is None else percent(row["difference"])]
                         + ["" if row is None else in_words(row)] * can_be_told)
        lines.append(line)
    page.table(head, lines)


def write_page(path, groups, differing, rows):
    with (tempfile.TemporaryDirectory() as scratch, open(os.devnull, "w") as nowhere,
          redirect_stdout(nowhere), redirect_stderr(nowhere),
          plt.rc_context({"svg.hashsalt": "antiform"})):
        page = Page(scratch)
        page.title = "Comparison: " + groups[0].runs[0].summary.get("title", "")
        page.add(f"<h1>{html.escape(page.title)}</h1>")
        page.add('<p class="state">' + html.escape(", ".join(
            f"{group.name} ({counted(len(group.runs), 'run')})" for group in groups)) + "</p>")
        missing = what_is_missing(groups, rows)
        if missing:
            page.add(f'<div class="warnings"><p>{html.escape(missing[0])}</p>'
                     + "".join(f"<pre>{html.escape(line)}</pre>" for line in missing[1])
                     + "</div>")
        add_table(page, groups, rows)
        page.add("<p>A difference is more than scatter where it exceeds twice its standard "
                 "error. That of zones and fields is the one of the groups' means.</p>")
        page.add("<h2>Curves</h2>")
        overlaid_curves([(group.name, group.runs) for group in groups],
                        page.path("curves.svg"))
        page.picture(page.path("curves.svg"), "Every run; runs of one group in one colour.")
        page.add("<h2>Fractures</h2>")
        for group in groups:
            run = group.runs[0]
            if not run.step_numbers or run.frame(run.step_numbers[-1]).grains is None:
                continue
            picture = page.path(f"fractures_{len(page.parts)}.webp")
            pictures.fracture_map(run, run.frame(run.step_numbers[-1]), picture)
            page.picture(picture, f"{group.name}, at the end.")
        page.add("<h2>In what the decks differ</h2>")
        page.table(["entry"] + [group.name for group in groups],
                   [[name] + [group.deck.get(name, "-") for group in groups]
                    for name in differing], numbers=False)
        write(page, path)


def write_tables(folder, groups, differing, rows):
    path = os.path.join(folder, "comparison.csv")
    with open(path + ".tmp", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    os.replace(path + ".tmp", path)
    path = os.path.join(folder, "comparison.json")
    with open(path + ".tmp", "w", encoding="utf-8") as file:
        json.dump({"reference": groups[0].name,
                   "groups": [{"name": group.name,
                               "runs": [os.path.abspath(run.directory) for run in group.runs],
                               "entries": {name: group.deck.get(name) for name in differing}}
                              for group in groups], "measures": rows}, file, indent=2)
        file.write("\n")
    os.replace(path + ".tmp", path)


def print_table(rows):
    for name, of_group in itertools.groupby(rows, key=lambda row: row["group"]):
        print(name)
        for row in of_group:
            print(f"  {label_of(row['measure']):46s} {shown(row):>22s} "
                  f"{percent(row['difference']):>10s}  {in_words(row)}".rstrip())


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", metavar="RUN_DIR", nargs="+", help="directory of a run")
    parser.add_argument("--out", metavar="DIR", default="comparison",
                        help="where to (default: comparison)")
    options = parser.parse_args()
    problems, runs = [], []
    for directory in options.runs:
        try:
            runs.append(read_run(directory))
        except (RunError, OSError) as error:
            problems.append(str(error))
    if len(options.runs) < 2:
        problems.append("Two runs at least are needed for a comparison.")
    if len({os.path.realpath(directory) for directory in options.runs}) < len(options.runs):
        problems.append("A run is named twice.")
    if os.path.exists(os.path.join(options.out, "deck.prm")):
        problems.append(f"'{options.out}' holds a run. Name another directory with --out.")
    try:
        if not problems:
            for run in runs:
                run.measures = measures(run, min(r.last_loading() for r in runs))
            groups = grouped(runs)
            demand_one_scene(groups)
            differing = name_groups(groups)
            rows = compare(groups)
            os.makedirs(options.out, exist_ok=True)
            write_tables(options.out, groups, differing, rows)
            page = os.path.join(options.out, "comparison.html")
            write_page(page, groups, differing, rows)
            print_table(rows)
            missing = what_is_missing(groups, rows)
            if missing:
                print("\n".join([missing[0]] + ["  " + line for line in missing[1]]))
            print(page)
    except (RunError, OSError) as error:
        problems.append(str(error))
    if problems:
        sys.exit("\n".join("compare.py: " + problem for problem in problems))


if __name__ == "__main__":
    main()
