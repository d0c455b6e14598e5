"""Curves of a run: stress (moment of walls that turn) and cracks against shortening (their
rotation), fold amplitude or gauge strains."""

import sys

import matplotlib.pyplot as plt
import numpy as np
from picture_style import DPI, SHEAR_CRACK, TENSION_CRACK


MOST_MARKS = 15


def mark_steps(axes, run, x, y):
    """The numbers of the field files on a curve; of very many files every so many."""
    every = -(-len(run.times) // MOST_MARKS)
    for number, row in list(zip(run.step_numbers, run.history_rows()))[::every]:
        axes.annotate(f"({number})", (x[row], y[row]), fontsize=9, xytext=(0, 9),
                      textcoords="offset points", ha="center", zorder=5,
                      bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none",
                            "alpha": 0.8})
        axes.plot(x[row], y[row], "o", color="black", markersize=4, clip_on=False)


def curves(run, path):
    history = run.history
    if not history or not len(history.get("shortening", ())):
        print(f"{path}: not drawn, history.csv has no lines yet", file=sys.stderr)
        return
    sign = run.sign()
    loading, response = run.loading(), run.response()
    x = loading.drawn
    is_specimen = "gauge_strain_axial" in history
    has_second = is_specimen or "fold_amplitude_m" in history
    figure, panels = plt.subplots(2 if has_second else 1, 1, sharex=True, squeeze=False,
                                  figsize=(9., 8. if has_second else 5.5),
                                  gridspec_kw={"height_ratios": [2, 1][:1 + has_second]})
    top = panels[0, 0]
    handles = []
    if response is not None:
        y = response.drawn
        handles += top.plot(x, y, color="#1f4fa8", linewidth=1.8, label=response.name)
        mark_steps(top, run, x, y)
        positive = ("" if run.bends() else ", compression +" if sign > 0. else ", tension +")
        top.set_ylabel(response.label + positive)
        top.margins(y=0.1)
        if y.min() >= 0.:
            top.set_ylim(bottom=0.)
    if "cracks_tensile" in history:
        counts = top.twinx()
        for name, colour, label in (("cracks_tensile", TENSION_CRACK, "tension cracks"),
                                    ("cracks_shear", SHEAR_CRACK, "shear cracks")):
            handles += counts.plot(x, history[name], color=colour, linewidth=1.2,
                                   linestyle="--", label=label)
        counts.set_ylabel("cracks so far")
        counts.set_ylim(0., max(1.05 * counts.dataLim.y1, 1.))
        top.set_zorder(counts.get_zorder() + 1)  # the marks stay above the crack counts
        top.patch.set_visible(False)
    top.legend(handles=handles, frameon=False, fontsize=10, loc="lower center",
               bbox_to_anchor=(0.5, 1.), ncol=3)
    if is_specimen:
        axial, lateral = (history[f"gauge_strain_{which}"] for which in ("axial", "lateral"))
        low = high = 0.
        for values, colour, label in ((axial, "#1f4fa8", "axial"), (lateral, "#d95f02", "lateral"),
                                      (axial + lateral, "#666666", "of the area")):
            panels[1, 0].plot(x, 100. * values, color=colour, label=label)
            seen = 100. * values[:np.argmax(sign * history["axial_stress_Pa"]) + 1]
            low, high = min(low, seen.min()), max(high, seen.max())
        # What flies off after the peak must not flatten what was measured before it.
        panels[1, 0].set_ylim(1.5 * low - 1e-6, 1.5 * high + 1e-6)
        panels[1, 0].set_ylabel("gauge strain (%), extension +")
        panels[1, 0].legend(frameon=False, fontsize=10)
    elif has_second:
        panels[1, 0].plot(x, history["fold_amplitude_m"], color="#7b3294")
        panels[1, 0].set_ylabel("fold amplitude (m)")
    for axes in panels[:, 0]:
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.set_xlim(0. if x.min() >= 0. else None, max(1.02 * x.max(), 1e-6))
    panels[-1, 0].set_xlabel(loading.label)
    figure.suptitle(run.summary.get("title", ""), fontsize=13, weight="bold")
    figure.tight_layout()
    figure.savefig(path, dpi=DPI)
    plt.close(figure)
    print(path)


COLOURS = ("black", "#1f4fa8", "#d95f02", "#1a9641", "#7b3294", "#a6761d", "#e7298a", "#666666")


def overlaid_curves(groups, path):
    """Stress or moment, cracks where there are any, and fold amplitude of many runs: groups of
    (name, runs), a colour each; a first one of one run is a wide band, to be seen below others
    that meet it."""
    first = groups[0][1][0]
    cracked = any(run.history[name][-1] > 0. for _, runs in groups for run in runs
                  for name in ("cracks_tensile", "cracks_shear") if name in run.history)
    stress = (("wall_moment_Nm", 1e-6, "wall moment (MN m per metre)") if first.bends()
              else ("axial_stress_Pa", 1e-6, "axial stress (MPa)"))
    kinds = (stress, (("cracks_tensile", "cracks_shear"), 1., "cracks so far"),
             ("fold_amplitude_m", 1., "fold amplitude (m)"))
    kinds = [kind for kind in kinds
             if np.atleast_1d(kind[0])[0] in first.history
             and not (kind[0] == "fold_amplitude_m" and "gauge_strain_axial" in first.history)
             and (cracked or kind[2] != "cracks so far")]
    figure, panels = plt.subplots(len(kinds), 1, sharex=True, squeeze=False,
                                  figsize=(5.8, 2.4 * len(kinds)))
    for axes, (names, factor, label) in zip(panels[:, 0], kinds):
        for n, (group, runs) in enumerate(groups):
            for k, run in enumerate(runs):
                columns = [run.history[name] for name in np.atleast_1d(names)
                           if name in run.history]
                if not columns:
                    continue
                sign = run.sign() if names == "axial_stress_Pa" else 1.
                axes.plot(run.loading().drawn,
                          factor * sign * sum(columns), color=COLOURS[n % len(COLOURS)],
                          linewidth=1. if len(runs) > 1 else 1.6 if n > 0 else 4.,
                          alpha=0.35 if n == 0 and len(runs) == 1 else 1.,
                          linestyle="-" if n < len(COLOURS) else "--",
                          label=group if k == 0 else None)
        axes.set_ylabel(label)
        axes.grid(color="#dddddd", linewidth=0.6)
    longest = max(len(group) for group, _ in groups)
    panels[0, 0].legend(frameon=False, fontsize=9, loc="lower center",
                        ncol=2 if longest < 28 else 1, bbox_to_anchor=(0.45, 1.))
    panels[-1, 0].set_xlabel(first.loading().label)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
