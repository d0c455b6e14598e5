#!/usr/bin/env python3
"""One page of a study: its curves, with theory where members have it, and its table.

  python3 cases/study_page.py DIR [--program ANTIFORM]

DIR is the output directory of 'antiform study'. Writes DIR/study.html, which needs no
other file and no network, and the curves alone as DIR/study.svg, six a sheet (study-2.svg
and so on). The entry with the most values is the axis; the others make a curve each, seeds
a mean and its points. The program (antiform, where it is found) gives closed forms between
the members.
"""

import argparse
import html
import json
import os
import shutil
import sys

try:
    import matplotlib
    import numpy  # noqa: F401
except ImportError as missing:
    sys.exit(f"study_page.py: {missing}. Install python3-numpy and python3-matplotlib, "
             f"and use the python3 that has them (this one is {sys.executable}).")
matplotlib.use("Agg")
from accuracy_page import add_accuracy  # noqa: E402
from report_page import Page, write  # noqa: E402
from study_charts import PER_SHEET, SCALES, draw, panels_of, svg_of  # noqa: E402
from study_file import Study, words  # noqa: E402


def add_charts(page, study, panels):
    page.add('<div class="charts">')
    for panel in panels:
        svg = svg_of(draw(study, [panel]), panel.what["column"])
        name = html.escape(f"{panel.label()} against {words(study.axis)}", quote=True)
        svg = svg.replace("<svg ", f'<svg role="img" aria-label="{name}" ', 1)
        page.vectors(svg, "" if not panel.far else
                     "Beyond this picture: " + "; ".join(panel.far) + ".")
    page.add("</div>")
    page.add('<p class="note">Points are runs, or means over seeds'
             + ("; lines without points closed forms" if any(p.theory for p in panels) else "")
             + ("" if not study.missed else
                "; where the program does not give one between the members, it is straight "
                "between them") + ".</p>")


def write_sheets(study, panels):
    for k in range(0, len(panels), PER_SHEET):
        name = "study.svg" if k == 0 else f"study-{k // PER_SHEET + 1}.svg"
        write_whole(os.path.join(study.directory, name),
                    svg_of(draw(study, panels[k:k + PER_SHEET]), "study"))


def add_table(page, study):
    record = study.record
    scales = [(c["column"], *SCALES.get(c["unit"], (1., c["unit"])))
              for c in record["collect"]]
    head = [words(e["column"]) for e in record["vary"]] + ["status"]
    head += [words(c["name"]) + ("" if unit == "-" else f" ({unit})")
             for c, (_, _, unit) in zip(record["collect"], scales)]
    rows = [list(member["values"].values()) + [member["status"]]
            + [f"{scale * member['figures'][c]:.6g}" if c in member["figures"] else ""
               for c, scale, _ in scales] for member in record["members"]]
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


def write_page(study, panels, path):
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
    if panels:
        add_charts(page, study, panels)
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
    parser.add_argument("--program", default=shutil.which("antiform"),
                        help="antiform, for closed forms between the members")
    arguments = parser.parse_args()
    study = Study(arguments.directory, arguments.program)
    panels = [] if study.axis is None else panels_of(study)
    write_sheets(study, panels)
    write_page(study, panels, os.path.join(arguments.directory, "study.html"))


if __name__ == "__main__":
    main()
