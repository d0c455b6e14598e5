#!/usr/bin/python3
"""Do the thesis' statements on layer-parallel shortening (its section 5.2.2) come out?

    antiform study cases/shortening/claims-single.prm -o claims-single
    antiform study cases/shortening/claims-multilayer.prm -o claims-multilayer
    /usr/bin/python3 cases/shortening/claims.py claims-single claims-multilayer

Takes directories of studies (or of runs), tells each run's model from its deck, and writes
claims.md (a line a statement, a value a packing) and claims.svg/.png (stress and cracks) into
the first of them. Thresholds were fixed before any of these runs was made, measuring windows
were not: docs/validation.md.

Measures. "Cracks" are broken joint elements. 95 % of the peak: the first sample at which the
axial stress reaches it. Distance to a wall: along x in the section before shortening.
Opening of an interface: normal separation of the grain pairs that face each other across it,
mean of what is positive, at the run's last fields. Two lines: continuous, with the kink where
they fit best; the error is the root mean square. They are fitted from the peak down to a tenth
of it: the silence after the fall would be the second line otherwise. The single layer, of which
the thesis says that it has no two slopes, is the control.
"""
import argparse
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from run_files import Run, RunError, read_deck  # noqa: E402
from study_runs import save  # noqa: E402

WEAK, LOWER, UPPER = 2, 0, 3  # regions of three beds, docs/output.md
ENOUGH = 4  # of five packings
FALLEN = 0.1  # of the peak: where the fall is over


class Model:
    """A run: which of the thesis' models it is, and its tables."""

    def __init__(self, directory):
        self.run = Run(directory)
        deck = read_deck(os.path.join(directory, "deck.prm"))
        self.seed = int(deck["Layer/Seed"])
        self.is_stack = "beds" in deck["Components"]
        self.has_ends = float(deck["Layer/Straight end ratio"]) > 0.
        self.interface = deck.get("Beds/Interface", "")
        beds = 3 if self.is_stack else 1
        self.thickness = float(deck["Layer/Thickness"]) / beds  # of one bed
        self.strain = self.run.history["shortening"]
        self.stress = self.run.history["axial_stress_Pa"]
        self.top = int(np.argmax(self.stress))
        self.near_peak = int(np.argmax(self.stress >= 0.95 * self.stress[self.top]))
        self.status = self.run.summary.get("status", "not ended")

    @property
    def name(self):
        if self.is_stack:
            return f"multilayer, {self.interface}"
        return "extended domain" if self.has_ends else "affected domain"

    def cracks_until(self, row):
        history = self.run.history
        return int(history["cracks_tensile"][row] + history["cracks_shear"][row])

    def n_cracks(self):
        return self.cracks_until(-1)

    def walls(self):
        points = self.run.frame(self.run.step_numbers[0]).grains.points
        return points[:, 0].min(), points[:, 0].max()

    def secant_over_initial(self):
        """Secant stiffness at 95 % of the peak over that of the first fifth of the stress."""
        first = self.stress <= 0.2 * self.stress[self.top]
        first[self.top:] = False
        x, y = self.strain[first], self.stress[first]
        initial = (x @ y) / (x @ x)
        return self.stress[self.near_peak] / self.strain[self.near_peak] / initial


def early_cracks(model):
    """Share of the final cracks before 95 % of the peak."""
    return model.cracks_until(model.near_peak) / model.n_cracks()


def stress_drop(model):
    return 1. - model.stress[model.top:].min() / model.stress[model.top]


def tensile_near_walls(model):
    """Share of the tensile cracks after the peak within one h of a wall."""
    left, right = model.walls()
    cracks = model.run.cracks
    later = ((cracks["mode"] == "tension")
             & (cracks["shortening"] > model.strain[model.top]))
    x = cracks["reference_x_m"][later]
    return float(np.mean(np.minimum(x - left, right - x) <= model.thickness))


def weak_bed_first(model):
    """The shortening of the weak bed's 50th crack over that of the first stiff bed's."""
    when = {}
    for bed in (LOWER, WEAK, UPPER):
        of_bed = np.sort(model.run.cracks["shortening"][model.run.cracks["layer"] == bed])
        when[bed] = of_bed[49] if len(of_bed) >= 50 else np.inf
    return when[WEAK] / min(when[LOWER], when[UPPER])


class Fall:
    """The stress over its peak from there to FALLEN, as one line and as the best of two."""

    def __init__(self, model):
        peak = model.stress[model.top]
        low = np.flatnonzero(model.stress[model.top:] < FALLEN * peak)
        end = model.top + low[0] + 1 if len(low) else len(model.stress)
        self.x = model.strain[model.top:end] - model.strain[model.top]
        self.y = model.stress[model.top:end] / peak
        line = np.stack([np.ones_like(self.x), self.x], axis=1)
        kinks = np.linspace(0., self.x[-1], 202)[1:-1]
        broken = [self._fit(np.column_stack([line, np.maximum(self.x - kink, 0.)]))
                  for kink in kinks]
        best = min(range(len(kinks)), key=lambda k: broken[k][0])
        error, (level, first, bend) = broken[best]
        self.two_over_one = error / self._fit(line)[0]
        self.kink = level + first * kinks[best]  # of the peak
        self.second_over_first = (first + bend) / first  # slopes: above 1 it steepens

    def _fit(self, columns):
        fit = np.linalg.lstsq(columns, self.y, rcond=None)[0]
        return np.sqrt(np.mean((columns @ fit - self.y) ** 2)), fit


def two_lines_over_one(model):
    return Fall(model).two_over_one


def pairs_across(grains, below, above):
    """Grain pairs that face each other across the interface of two beds."""
    region, radius = grains.field("region"), grains.field("radius_m")
    lower, upper = np.flatnonzero(region == below), np.flatnonzero(region == above)
    reach = 2. * radius.max() * 1.15
    order = lower[np.argsort(grains.points[lower, 0])]
    x = grains.points[order, 0]
    first, second = [], []
    for grain in upper:
        a, b = np.searchsorted(x, grains.points[grain, 0] + np.array([-reach, reach]))
        near = order[a:b]
        distance = np.linalg.norm(grains.points[near] - grains.points[grain], axis=1)
        met = near[distance <= 1.15 * (radius[near] + radius[grain])]
        first += list(met)
        second += [grain] * len(met)
    return np.array(first), np.array(second)


def opening(model, below, above):
    """Mean opening of an interface at the last fields [m]."""
    steps = model.run.step_numbers
    start, end = model.run.frame(steps[0]).grains, model.run.frame(steps[-1]).grains
    a, b = pairs_across(start, below, above)
    before = np.linalg.norm(start.points[b] - start.points[a], axis=1)
    after = np.linalg.norm(end.points[b] - end.points[a], axis=1)
    return float(np.mean(np.maximum(after - before, 0.)))


def upper_over_lower_opening(model):
    return opening(model, WEAK, UPPER) / opening(model, LOWER, WEAK)


CLAIMS = [  # statement, model, measure, limit, does a smaller value hold
    ("(a) cracks before 95 % of the peak, of all", "affected domain", early_cracks, 0.10, True),
    ("(a) stress drop after the peak", "affected domain", stress_drop, 0.30, False),
    ("(a) tensile cracks after the peak within h of a wall", "affected domain",
     tensile_near_walls, 0.50, False),
    ("(c) the weak bed's 50th crack: shortening over the stiff beds'", "multilayer",
     weak_bed_first, 1., True),
    ("(c) error of two lines over one in the fall", "multilayer", two_lines_over_one,
     0.50, True),
    ("(c) the same of a control that is to have one slope", "affected domain",
     two_lines_over_one, 0.50, False),
    ("(c) the same of a control that is to have one slope", "extended domain",
     two_lines_over_one, 0.50, False),
    ("(c) opening of the upper over the lower interface", "multilayer",
     upper_over_lower_opening, 1., False),
]
PAIRED = [  # the extended domain beside the affected one of the same packing
    ("(b) cracks, extended over affected domain", lambda e, a: e.n_cracks() / a.n_cracks(),
     1.1, False),
    ("(b) secant over initial stiffness at 95 %, extended over affected",
     lambda e, a: e.secant_over_initial() / a.secant_over_initial(), 1., True),
]


def directories(root):
    members = os.path.join(root, "members")
    if not os.path.isdir(members):
        return [root]
    return sorted(os.path.join(members, name) for name in os.listdir(members)
                  if os.path.exists(os.path.join(members, name, "summary.json")))


def line(statement, name, limit, smaller, values):
    """A row of the table: a column a packing, and in how many it holds."""
    holds = [v <= limit if smaller else v >= limit for v in values]
    needed = ENOUGH * len(values) / 5.
    verdict = "holds" if sum(holds) >= needed else "**does not hold**"
    return (f"| {statement} | {name} | {'<=' if smaller else '>='} {limit:g} | "
            + ", ".join(f"{v:.3g}" for v in values)
            + f" | {sum(holds)} of {len(values)} | {verdict} |")


def table(models):
    rows = ["| statement | model | wanted | packings | holds in | |",
            "| --- | --- | --- | --- | --- | --- |"]
    names = sorted({m.name for m in models})
    for statement, of, measure, limit, smaller in CLAIMS:
        for name in names:
            if name.startswith(of):
                values = [measure(m) for m in models if m.name == name]
                rows.append(line(statement, name, limit, smaller, values))
    affected = {m.seed: m for m in models if m.name == "affected domain"}
    pairs = [(m, affected[m.seed]) for m in models
             if m.name == "extended domain" and m.seed in affected]
    for statement, measure, limit, smaller in PAIRED if pairs else []:
        rows.append(line(statement, "both domains", limit, smaller,
                         [measure(*pair) for pair in pairs]))
    return "\n".join(sorted(rows[2:])), "\n".join(rows[:2])


def falls(models):
    """What the two lines are: a kink near 1 and a second one that is steeper are the peak's
    rounding; a second one that is flatter is a stage of its own."""
    rows = ["| model | packing | samples | two lines over one | kink at, of the peak | "
            "second slope over first |", "| --- | --- | --- | --- | --- | --- |"]
    for m in models:
        fall = Fall(m)
        rows.append(f"| {m.name} | {m.seed} | {len(fall.x)} | {fall.two_over_one:.2f} | "
                    f"{fall.kink:.2f} | {fall.second_over_first:.2g} |")
    return "\n".join(rows)


def runs(models):
    rows = ["| model | packing | peak (MPa) | at | cracks | closed to | status | CPU s |",
            "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for m in models:
        summary = m.run.summary
        rows.append(
            f"| {m.name} | {m.seed} | {1e-6 * m.stress[m.top]:.2f} | "
            f"{m.strain[m.top]:.3e} | {m.n_cracks()} | "
            f"{summary['energy']['closure_error']:.1e} | {m.status} | "
            f"{summary['cpu_seconds']:.0f} |")
    return "\n".join(rows)


def draw(models, directory):
    """A panel a model: stress of each packing, and its cracks on the second axis."""
    names = sorted({m.name for m in models})
    figure, panels = plt.subplots(1, len(names), figsize=(4.6 * len(names), 3.6),
                                  layout="constrained", squeeze=False)
    for panel, name in zip(panels[0], names):
        second = panel.twinx()
        for m in (m for m in models if m.name == name):
            history, x = m.run.history, 1e3 * m.strain
            panel.plot(x, 1e-6 * m.stress, color="#1f4fa8", lw=1.1)
            second.plot(x, history["cracks_tensile"] + history["cracks_shear"],
                        color="#c0392b", lw=0.9, ls="--")
        panel.set_title(name, fontsize=10)
        panel.set(xlabel="shortening (1e-3)", xlim=(0., None), ylim=(0., None))
        panel.set_ylabel("axial stress (MPa)", color="#1f4fa8")
        second.set_ylabel("partial cracks", color="#c0392b")
        second.set_ylim(bottom=0.)
        for axes in (panel, second):
            axes.spines["top"].set_visible(False)
    save(figure, directory, "claims")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directories", nargs="+")
    arguments = parser.parse_args()
    try:
        models = [Model(d) for root in arguments.directories for d in directories(root)]
        left_out = [m for m in models if m.status != "completed"]
        models = [m for m in models if m.status == "completed"]
        if not models:
            sys.exit("claims.py: no finished run in the directories given.")
        models.sort(key=lambda m: (m.name, m.seed))
        body, head = table(models)
        text = f"{head}\n{body}\n\n{falls(models)}\n\n{runs(models)}\n"
    except (RunError, OSError, KeyError) as error:
        sys.exit(f"claims.py: {error}")
    with open(os.path.join(arguments.directories[0], "claims.md"), "w",
              encoding="utf-8") as out:
        out.write(text)
    print(text)
    for m in left_out:
        print(f"left out: {m.name}, packing {m.seed}: {m.status}")
    draw(models, arguments.directories[0])


if __name__ == "__main__":
    main()
