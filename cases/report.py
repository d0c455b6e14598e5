#!/usr/bin/env python3
"""One self-contained page of a run: what was run, numbers, curves, pictures, energies, cost.

  python3 cases/report.py RUN_DIR [--out FILE.html] [--steps onset,peak,last]

The page needs no network and no file beside it. What a run does not have is left out.
Steps are onset (the first fields with a crack), peak (the last up to it), first, last or the
numbers of field files.
"""

import argparse
import html
import os
import sys
import tempfile
from contextlib import redirect_stderr, redirect_stdout

import pictures  # picks the way to draw without a screen, and says what is missing
import matplotlib.pyplot as plt
import numpy as np
import report_figures as figures
from accuracy_page import add_accuracy
from curves_page import curves
from report_page import Page, counted, with_prefix, with_unit, write
from run_files import Run, RunError, read_deck

# Results that a reader looks for first, in the field's words.
FACTS = (("peak_moment", "peak moment of the walls"), ("rotation_at_peak", "rotation at the peak"),
         ("first_crack_rotation", "rotation at the first crack"),
         ("peak_stress", "peak axial stress"), ("tensile_strength", "tensile strength"),
         ("strain_at_peak", "strain at the peak"), ("young_modulus", "Young's modulus"),
         ("poisson_ratio", "Poisson's ratio"), ("critical_stress", "critical stress"),
         ("theory_stress", "critical stress, theory"), ("dominant_wavelength", "wavelength"),
         ("first_crack_stress", "stress at the first crack"),
         ("crack_initiation_stress", "crack initiation stress"),
         ("fractures", "fractures before loading"),
         ("largest_fracture_slip", "largest slip on a fracture"),
         ("cracks_tensile", "cracks in tension"), ("cracks_shear", "cracks in shear"),
         ("fold_amplitude", "fold amplitude"), ("limb_dip", "limb dip"),
         ("surface_uplift", "uplift of the surface"), ("shortening", "shortening at the end"),
         ("wall_rotation", "rotation of the walls at the end"))
OF_LAYERS = {"fold_amplitude", "limb_dip", "surface_uplift"}  # specimens have them at no use
SCENE = ("Components", "Layer/Representation", "Layer/Thickness", "Layer/Grains across",
         "Layer/Length ratio", "Layer/Slenderness ratio", "Layer/Shape",
         "Matrix/Representation", "Matrix/Stiffness contrast", "Matrix/Burial depth ratio",
         "Matrix/Base depth ratio", "Matrix/Interface", "Matrix/Join",
         "Fractures/Spacing ratio", "Fractures/Intensity", "Fractures/Orientation",
         "Surface pressure/Pressure", "Servo walls/Pressure", "Membrane/Pressure", "Run/Driver",
         "Walls/Action", "Walls/Loading")
MODES_DRAWN = 2
UNITS = {"Layer/Thickness": " m", "Fractures/Intensity": " /m", "Fractures/Orientation": "°",
         "Surface pressure/Pressure": " Pa", "Servo walls/Pressure": " Pa",
         "Membrane/Pressure": " Pa"}
NAMES = {"onset": "cracks have begun", "peak": "up to the peak", "first": "before shortening",
         "last": "at the end"}
SECTIONS = (
    ("fracture_map", "Fractures", "Tension cracks red, shear cracks black, on the deformed "
     "section; the marked window is drawn again below."),
    ("force_chains", "Force chains", "Joints as wide as the normal force that they carry: "
     "compression blue, tension green."),
    ("displacement", "Displacement", "Magnitude and vertical part since the start."),
    ("stress", "Horizontal stress", "Tension positive; mesh and grains in scales of their own."))


def steps_of(run, wanted):
    """{number: what it is called}, in their order; a step that is two of them once."""
    if run.modes is not None:
        return {n: "" for n in run.step_numbers if 1 <= n <= MODES_DRAWN}
    names = {}
    for which in wanted.split(","):
        if which == "onset":
            if run.cracks is None or not len(run.cracks["step"]):
                continue
            cracked = np.abs(run.times) >= np.abs(run.cracks[run.loading_column()][0])
            number = run.step_numbers[int(np.argmax(cracked)) if cracked.any() else -1]
        elif which == "peak" and (not run.history or "axial_stress_Pa" not in run.history):
            continue  # a run without a curve has none
        else:
            number = run.numbers(which)[0]
        names.setdefault(number, []).append(NAMES.get(which, f"step ({which})"))
    return {number: ", ".join(names[number]) for number in sorted(names)}


def has_say(entry, deck):
    """Does the deck give @p entry, and is it the one of several that decides?"""
    by_length = float(deck.get("Layer/Length ratio", 0.)) > 0.
    if entry in ("Layer/Length ratio", "Layer/Slenderness ratio"):
        return entry in deck and by_length == (entry == "Layer/Length ratio")
    return bool(deck.get(entry))


def add_head(page, run, deck):
    summary = run.summary
    title = summary.get("title") or os.path.basename(os.path.abspath(run.directory))
    page.title = title
    page.add(f"<h1>{html.escape(title)}</h1>")
    status = summary.get("status", "still running")
    page.add(f'<p class="state">antiform {html.escape(str(summary.get("version", "")))}, '
             f"run {html.escape(status)}"
             + (f", {summary['wall_seconds']:.4g} s of the clock, "
                f"{counted(summary['threads'], 'thread')}, {counted(summary['ranks'], 'rank')}"
                if "wall_seconds" in summary else "") + "</p>")
    if status == "failed":
        page.add('<p class="failed">This run failed: figures are those of its last good '
                 "state.</p>")
    if summary.get("warnings"):
        page.add('<ul class="warnings">' + "".join(
            f"<li>{html.escape(text)}</li>" for text in summary["warnings"]) + "</ul>")
    results = summary.get("results", {})
    unmeant = OF_LAYERS if "young_modulus" in results else set()
    if "wall_rotation" in results:  # that is how far the walls have come
        unmeant = unmeant | {"shortening"}
    facts = [(label, with_unit(name, results[name]["value"], results[name]["unit"]))
             for name, label in FACTS if name in results and name not in unmeant]
    page.add('<dl class="facts">' + "".join(
        f"<div><dt>{html.escape(label)}</dt><dd>{html.escape(value)}</dd></div>"
        for label, value in facts) + "</dl>")
    page.add("<h2>The scene</h2>")
    page.table(("entry", "value"), [(name, deck[name] + UNITS.get(name, ""))
                                    for name in SCENE if has_say(name, deck)], numbers=False)
    sizes = summary.get("sizes", {})
    page.add("<p>" + ", ".join(f"{n:,} {what}" for what, n in sizes.items() if n) + "</p>")


def add_curves(page, run):
    path = page.path("curves.svg")
    curves(run, path)
    if os.path.exists(path):
        page.add("<h2>Stress, cracks and fold</h2>")
        page.picture(path, "Curves of the run; numbers in brackets are those of the field "
                     "files, in which the steps below are drawn.")


def add_sections(page, run, wanted):
    if not run.step_numbers:
        return
    steps = steps_of(run, wanted)
    for name, heading, caption in SECTIONS:
        drawn = []
        for number, which in steps.items():
            frame = run.frame(number)
            if (name == "fracture_map" and frame.grains is None
                    or name != "displacement" and run.modes is not None):
                continue
            path = page.path(f"{name}_{number}.webp")  # a fifth of a PNG
            getattr(pictures, name)(run, frame, path)
            if os.path.exists(path):
                drawn.append((path, number, which))
        if drawn:
            page.add(f"<h2>{heading}</h2>")
        for path, number, which in drawn:
            page.picture(path, f"Step ({number}), {which}. {caption}" if which
                         else f"Mode {number}, scaled to a largest displacement of 1.")


def add_cracks(page, run, deck):
    cracks = run.cracks
    if cracks is None or not len(cracks["x_m"]):
        return
    page.add("<h2>Directions and spacing of cracks</h2>")
    page.add('<div class="pair">')
    figures.crack_rose(cracks, page.path("rose.svg"))
    page.picture(page.path("rose.svg"), "Rose of all cracks at the end.")
    frame = run.frame(run.step_numbers[0]) if run.step_numbers else None
    thickness = float(deck.get("Layer/Thickness", 0.))
    if frame is not None and frame.grains is not None and thickness > 0.:
        diameter = 2. * np.mean(frame.grains.field("radius_m"))
        places = figures.fractures(cracks, diameter, thickness)
        if len(places) > 2:
            figures.crack_spacing(places, thickness, page.path("spacing.svg"))
            page.picture(page.path("spacing.svg"),
                         f"{len(places)} fractures of the layer: groups of cracks in tension "
                         f"within {figures.JOINED:g} grain diameters of each other that reach "
                         f"over a fifth of the thickness; places before shortening.")
        else:
            page.add(f"<p>{len(places)} fractures (groups of tension cracks that reach over a "
                     "fifth of the layer's thickness): too few for a spacing.</p>")
    page.add("</div>")


def add_energies(page, run):
    energy = run.summary.get("energy", {})
    if run.history and "boundary_work_J" in run.history:
        figures.energy_ledger(run, page.path("energy.svg"))
    if not energy and not os.path.exists(page.path("energy.svg")):
        return
    page.add("<h2>Energy ledger</h2>")
    page.picture(page.path("energy.svg"), "The terms, each from its own law, stacked; they "
                 "should reach the dashed line.")
    rows = [(name.replace("_", " "), with_prefix(value, "J") if name != "closure_error"
             else f"{value:.2g}") for name, value in energy.items() if value is not None]
    if rows:
        page.table(("at the end", "per metre of depth"), rows)


def add_cost(page, run):
    summary = run.summary
    if "effects" not in summary:
        return
    page.add("<h2>What it cost</h2>")
    rows = figures.costs(summary["effects"], summary["wall_seconds"])
    if len(rows) > 1:
        figures.cost_bars(rows, page.path("cost.svg"))
    page.picture(page.path("cost.svg"), "Seconds by effect.")
    page.add(f"<p>{summary['wall_seconds']:.4g} s of the clock, {summary['cpu_seconds']:.4g} s of "
             f"processors, {with_prefix(summary['peak_memory_bytes'], 'B')} of memory, "
             f"{summary['steps']:,} steps, {summary['solves']:,} solves.</p>")
    page.add("<details><summary>Every effect: active or not, and why</summary>")
    page.table(("effect", "active", "calls", "seconds", "why"),
               [(name, "yes" if e["active"] else "no", f"{e['calls']:,}", f"{e['seconds']:.3g}",
                 e["reason"]) for name, e in summary["effects"].items()])
    page.add("</details>")


def add_modes(page, run):
    modes = run.modes
    if modes is None:
        return
    page.add("<h2>Modes of buckling</h2>")
    page.table(("mode", "half waves", "wavelength", "stress of the layer", "shortening"),
               [(f"{int(k)}", f"{int(n)}", f"{length:.4g} m", with_unit("", stress, "Pa"),
                 f"{100. * strain:.4g} %")
                for k, n, length, stress, strain in zip(
                    modes["mode"], modes["half_waves"], modes["wavelength_m"],
                    modes["layer_stress_Pa"], modes["shortening"])])


def add_tail(page, run, deck_path):
    results = run.summary.get("results", {})
    if results:
        page.add("<details><summary>All results</summary>")
        page.table(("result", "value", "unit"),
                   [(name, "lost" if r["value"] is None else f"{r['value']:.6g}", r["unit"])
                    for name, r in results.items()])
        page.add("</details>")
    if os.path.exists(deck_path):
        with open(deck_path, encoding="utf-8", errors="replace") as text:
            page.add("<details><summary>The deck, complete</summary><pre>"
                     + html.escape(text.read()) + "</pre></details>")


def report(run, path, wanted):
    deck_path = os.path.join(run.directory, "deck.prm")
    deck = read_deck(deck_path) if os.path.exists(deck_path) else {}
    if not deck and not run.summary:
        raise RunError(f"'{run.directory}' is not the directory of a run: it has neither "
                       "deck.prm nor summary.json.")
    with (tempfile.TemporaryDirectory() as scratch, open(os.devnull, "w") as nowhere,
          redirect_stdout(nowhere), redirect_stderr(nowhere),  # where pictures were written
          plt.rc_context({"svg.hashsalt": "antiform"})):
        page = Page(scratch)
        add_head(page, run, deck)
        add_accuracy(page, run.summary.get("accuracy"),
                     run.summary.get("cpu_seconds", 0.))
        add_modes(page, run)
        add_curves(page, run)
        add_sections(page, run, wanted)
        add_cracks(page, run, deck)
        add_energies(page, run)
        add_cost(page, run)
        add_tail(page, run, deck_path)
        write(page, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", metavar="RUN_DIR", help="directory of a run")
    parser.add_argument("--out", metavar="FILE", help="(default: RUN_DIR/report.html)")
    parser.add_argument("--steps", default="onset,peak,last",
                        help="what is drawn (default: onset,peak,last)")
    options = parser.parse_args()
    try:
        path = options.out or os.path.join(options.run, "report.html")
        report(Run(options.run), path, options.steps)
        print(path)
    except (RunError, OSError) as error:
        sys.exit(f"report.py: {error}")


if __name__ == "__main__":
    main()
