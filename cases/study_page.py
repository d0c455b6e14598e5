#!/usr/bin/env python3
"""One page of a study: its curves, with theory where members have it, and its table.

  python3 cases/study_page.py DIR

DIR is the output directory of 'antiform study'. Writes DIR/study.html, which needs no
other file and no network, and the curves alone as DIR/study.svg. The entry with the most
values is the axis; the others make a curve each, seeds a mean and its points.
"""

import argparse
import html
import io
import json
import os
import sys

try:
    import matplotlib
    import numpy as np
except ImportError as missing:
    sys.exit(f"study_page.py: {missing}. Install python3-numpy and python3-matplotlib, "
             f"and use the python3 that has them (this one is {sys.executable}).")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from accuracy_page import add_accuracy  # noqa: E402
from report_page import Page, write  # noqa: E402

COLOURS = ["#1f4fa8", "#c0392b", "#2e8b57", "#762a83", "#b35806", "#1b1b1b"]
MARKERS = "os^Dv*"
LEAST_SPAN = 0.1  # of an axis of figures over the largest of them
SCALES = {"Pa": (1e-6, "MPa"), "s": (1., "s")}


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def words(name):
    return name.replace("_", " ").replace("/", " ")


def kind_of(name):
    """The last word: stress, wavelength."""
    return words(name).split()[-1]


class Study:
    """study.json, and which of its entries is the axis and which tell curves apart."""

    def __init__(self, directory):
        path = os.path.join(directory, "study.json")
        if not os.path.exists(path):
            sys.exit(f"study_page.py: there is no '{path}'. Give the directory that "
                     "'antiform study' has written.")
        with open(path) as file:
            self.record = json.load(file)
        self.members = self.record["members"]
        columns = [entry["column"] for entry in self.record["vary"]]
        texts = {c: list(dict.fromkeys(m["values"][c] for m in self.members))
                 for c in columns}
        numeric = [c for c in columns if all(number(t) is not None for t in texts[c])]
        varied = [c for c in numeric if len(texts[c]) > 1 and c != "seed"]
        self.axis = max(varied, key=lambda c: len(texts[c])) if varied else None
        self.apart = []
        for column in columns:
            # An entry that is zipped to one before it says nothing more.
            said = [c for c in [self.axis] + self.apart if c is not None]
            follows = any(len({(m["values"][c], m["values"][column])
                               for m in self.members}) == len(texts[c]) for c in said)
            if len(texts[column]) > 1 and column not in ("seed", self.axis) \
                    and not follows:
                self.apart.append(column)

    def label(self, key):
        return ", ".join(f"{words(c)} {v}" if number(v) is not None else v
                         for c, v in zip(self.apart, key)) or "members"

    def curves(self, column):
        """Of each curve: its label, points, and their means by the axis."""
        groups = {}
        for member in self.members:
            if member["status"] == "completed" and column in member["figures"]:
                key = tuple(member["values"][c] for c in self.apart)
                groups.setdefault(key, []).append((number(member["values"][self.axis]),
                                                   member["figures"][column]))
        for key, points in groups.items():
            x, y = (np.array(values) for values in zip(*sorted(points)))
            at = np.unique(x)
            yield self.label(key), x, y, at, np.array([y[x == a].mean() for a in at])

    def panels(self):
        """Figures to draw, each with its closed form or None, and what 'antiform theory'
        says of its kind: a stress beside a stress."""
        figures = self.record["collect"]
        theory = {f["name"][len("theory_"):]: f for f in figures
                  if f["name"].startswith("theory_")}
        said = [f for f in figures if f["name"].startswith("theory/")]
        for figure in figures:
            name = figure["name"]
            if not name.startswith(("theory_", "theory/")) and " over theory" not in name:
                yield (figure, next((theory[end] for end in theory
                                     if name.endswith("_" + end)), None),
                       [f for f in said if kind_of(f["name"]) == kind_of(name)])


def draw(study):
    panels = list(study.panels())
    if study.axis is None or not panels:
        return None
    rows = (len(panels) + 1) // 2
    columns = min(2, len(panels))
    figure, axes = plt.subplots(rows, columns, squeeze=False,
                                figsize=(5.2 * columns, 3.9 * rows + 0.3))
    for place, (what, theory, said) in zip(axes.flat, panels):
        scale, unit = SCALES.get(what["unit"], (1., what["unit"]))
        ends, heights, named = [np.inf, -np.inf], [np.inf, -np.inf], False
        for i, (label, x, y, at, mean) in enumerate(study.curves(what["column"])):
            style = {"color": COLOURS[i % len(COLOURS)]}
            ends = [min(ends[0], x.min()), max(ends[1], x.max())]
            heights = [min(heights[0], y.min()), max(heights[1], y.max())]
            joined = {} if theory is None else {"linestyle": "none"}
            place.plot(at, scale * mean, marker=MARKERS[i % len(MARKERS)], label=label,
                       markerfacecolor="white", markeredgewidth=1.5, **style, **joined)
            if len(x) > len(at):
                place.plot(x, scale * y, ".", alpha=0.5, markersize=4, **style)
        if theory is not None:
            for i, (_, _, _, at, mean) in enumerate(study.curves(theory["column"])):
                place.plot(at, scale * mean, color=COLOURS[i % len(COLOURS)],
                           linewidth=1.2, zorder=0,
                           label=None if named else "closed form (lines)")
                named = True
        for line, style in zip(said, ["--", ":", "-."] * len(said)):
            name = " ".join(words(part) for part in line["name"].split("/")[-2:])
            for i, (_, _, _, at, mean) in enumerate(study.curves(line["column"])):
                place.plot(at, scale * mean, color=COLOURS[i % len(COLOURS)], zorder=0,
                           linewidth=1.2, linestyle=style, label=None if i else name)
        if 0. < ends[0] and ends[1] > 30. * ends[0]:
            place.set_xscale("log")
        if 0. < heights[0] and heights[1] > 15. * heights[0]:
            place.set_yscale("log")
        elif heights[1] - heights[0] < LEAST_SPAN * max(map(abs, heights)):
            # A scatter of some percent is not to fill the panel like a trend.
            middle = 0.5 * scale * sum(heights)
            half = 0.55 * LEAST_SPAN * scale * max(map(abs, heights))
            place.set_ylim(middle - half, middle + half)
        place.set_xlabel(words(study.axis))
        place.set_ylabel(words(what["name"]) + ("" if unit == "-" else f" ({unit})"))
        place.grid(color="#dddddd", linewidth=0.6)
        place.margins(y=0.1)
    for place in axes.flat[len(panels):]:
        place.set_visible(False)
    handles, labels = axes.flat[0].get_legend_handles_labels()
    if labels == ["members"]:  # one curve needs no name
        figure.tight_layout()
        return figure
    # As many beside each other as the width of the page holds.
    width = 5.2 * columns
    beside = max(1, int(width / (0.09 * max(map(len, labels)) + 0.7)))
    lines = -(-len(labels) // beside)
    figure.legend(handles, labels, loc="upper center", ncol=beside, frameon=False)
    figure.tight_layout(rect=(0., 0., 1., 1. - (0.1 + 0.22 * lines) / (3.9 * rows + 0.3)))
    return figure


def svg_of(figure):
    text = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "study"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()


def add_table(page, study):
    record = study.record
    collect = [(c["column"], c["name"], *SCALES.get(c["unit"], (1., c["unit"])))
               for c in record["collect"]]
    head = [words(e["column"]) for e in record["vary"]] + ["status"]
    head += [words(name) + ("" if unit == "-" else f" ({unit})") for _, name, _, unit in collect]
    rows = [list(member["values"].values()) + [member["status"]]
            + [f"{scale * member['figures'][c]:.5g}" if c in member["figures"] else ""
               for c, _, scale, _ in collect] for member in record["members"]]
    page.table(head, rows, classes=[member["status"] for member in record["members"]])


def accuracy_of(study, directory):
    """What the first member that has ended says of it, and its seconds; no wish of any."""
    for member in study.members:
        path = os.path.join(directory, "members", member["name"], "summary.json")
        if os.path.exists(path):
            with open(path) as file:
                summary = json.load(file)
            return summary.get("accuracy"), summary["cpu_seconds"]
    return None, 0.


def write_page(study, picture, path):
    record = study.record
    n_done = sum(m["status"] == "completed" for m in study.members)
    notes = [f'{m["name"]}: {m["reason"]}' for m in study.members if "reason" in m]
    notes += record["warnings"]
    page = Page(None)
    page.title = f"Study {record['title']}"
    page.add(f"<h1>{html.escape(page.title)}</h1>")
    page.add(f'<p class="state">antiform {html.escape(record["version"])}, {n_done} of '
             f"{len(study.members)} members completed, study {record['status']}.</p>")
    if notes:
        page.add('<ul class="warnings">' + "".join(f"<li>{html.escape(n)}</li>" for n in notes)
                 + "</ul>")
    if picture:
        page.vectors(picture, "Points are runs, or means over seeds; lines closed forms where "
                     "there are any.")
    add_table(page, study)
    add_accuracy(page, *accuracy_of(study, os.path.dirname(path)))
    write(page, path)
    print(path)


def write_whole(path, text):
    with open(path + ".tmp", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".tmp", path)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory", help="output directory of 'antiform study'")
    directory = parser.parse_args().directory
    study = Study(directory)
    figure = draw(study)
    picture = svg_of(figure) if figure is not None else ""
    if picture:
        write_whole(os.path.join(directory, "study.svg"), picture)
    write_page(study, picture, os.path.join(directory, "study.html"))


if __name__ == "__main__":
    main()
