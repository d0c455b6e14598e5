"""Charts of a study: one a figure, with the closed forms of its kind."""

import io
import re

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from depth_axis import add_theta_axes, distinct
from matplotlib.lines import Line2D
from study_file import is_logarithmic, is_theory, kind_of, words

COLOURS = ["#1f4fa8", "#c0392b", "#2e8b57", "#762a83", "#b35806", "#1b1b1b"]
MARKERS = "os^Dv*PX<>"
JOINED = ["-", "--", "-.", ":"]
THEORY = ["--", ":", "-.", (0, (5, 1, 1, 1, 1, 1))]
SCALES = {"Pa": (1e-6, "MPa"), "s": (1., "s")}
LEADING = {"stress": ("peak_stress", "critical_stress", "tensile_strength")}
SIZE = (4.4, 3.0)  # of a chart, inches: what a phone shows at three quarters or more
PER_SHEET = 6
FARTHEST = 1.4  # times the highest point: closed forms all above are not drawn
LEAST_SPAN = 0.1  # of an axis of figures over the largest of them
TEXT = 9.


class Style:
    """How curves are told apart: the first key by colour, the others by marker and line.
    No two are alike up to 240."""

    def __init__(self, study):
        self.study = study
        self.first = study.values[study.apart[0]] if study.apart else [""]
        self.rest = list(dict.fromkeys(key[1:] for key in study.keys()))

    def colour(self, key):
        i = self.first.index(key[0]) if key else 0
        if len(self.first) <= len(COLOURS):
            return COLOURS[i]
        return matplotlib.colors.to_hex(plt.get_cmap("turbo")((i + 0.5) / len(self.first)))

    def of(self, key):
        i = self.first.index(key[0]) if key else 0
        j = self.rest.index(key[1:]) if len(self.rest) > 1 else i
        return {"color": self.colour(key), "marker": MARKERS[j % len(MARKERS)],
                "linestyle": JOINED[(j + j // len(MARKERS)) % len(JOINED)
                                    if len(self.rest) > 1 else 0]}

    def legend(self):
        """Rows: a title, and handles of lines with their labels."""
        keys, rows = self.study.keys(), []
        if self.study.apart:
            shown = [next(k for k in keys if k[0] == value) for value in self.first]
            alone = len(self.rest) == 1
            rows.append((words(self.study.apart[0]),
                         [handle(value, **(self.of(key) if alone else
                                           {"color": self.colour(key), "linewidth": 2.5}))
                          for value, key in zip(self.first, shown)]))
        if len(self.rest) > 1:
            title = ", ".join(map(words, self.study.apart[1:]))
            styles = [self.of(next(k for k in keys if k[1:] == rest))
                      for rest in self.rest]
            rows.append((title, [handle(", ".join(rest), **{**style, "color": "#444444"})
                                 for rest, style in zip(self.rest, styles)]))
        return rows


def handle(label, **style):
    return Line2D([], [], label=label, markerfacecolor="white", markersize=5.5, **style)


def name_of_theory(figure):
    """perry robertson guided; theory stress."""
    parts = figure["name"].split("/")
    return words(" ".join(parts[2:] if len(parts) > 2 else parts))


class Panel:
    """A figure and the closed forms beside it; no figure: closed forms that have none."""

    def __init__(self, figure, theory):
        self.figure, self.theory = figure, theory
        self.what = figure or theory[0]
        self.scale, self.unit = SCALES.get(self.what["unit"], (1., self.what["unit"]))
        self.far = []  # closed forms that do not come into the picture, in words

    def line_of(self, theory):
        """A kind each: the first that runs know of their own is solid, others dashed."""
        of_runs = [t for t in self.theory if t["name"].startswith("theory_")]
        if theory in of_runs[:1]:
            return "-"
        others = [t for t in self.theory if t not in of_runs[:1]]
        return THEORY[others.index(theory) % len(THEORY)]

    def label(self):
        name = words(self.what["name"] if self.figure else kind_of(self.what))
        return name + ("" if self.unit == "-" else f" ({self.unit})")


def panels_of(study):
    """A panel a figure; closed forms beside the figures that they are of: a stress beside
    the peak or the critical stress, where these are there."""
    collected = study.record["collect"]
    own = [f for f in collected if not is_theory(f) and " over theory" not in f["name"]]
    panels = [Panel(figure, []) for figure in own]
    alone = {}
    for theory in filter(is_theory, collected):
        kind = (kind_of(theory), theory["unit"])
        beside = [p for p in panels if (kind_of(p.what), p.what["unit"]) == kind]
        leading = [p for p in beside if p.what["name"] in LEADING.get(kind[0], ())]
        for panel in leading or beside:
            panel.theory.append(theory)
        if not beside:
            alone.setdefault(kind, []).append(theory)
    return panels + [Panel(None, theory) for theory in alone.values()]


def draw_points(study, style, panel, axes):
    """\\return lowest and highest value, lowest and highest place."""
    ends = []
    solid = any(t["name"].startswith("theory_") for t in panel.theory)
    for key in study.keys():
        points = study.points(panel.figure["column"], key) if panel.figure else None
        if points is None:
            continue
        x, y = points[0], panel.scale * points[1]
        at = np.unique(x)
        mean = np.array([y[x == a].mean() for a in at])
        look = style.of(key)
        if not solid:
            axes.plot(*study.with_gaps(at, mean), color=look["color"], linewidth=1.1,
                      linestyle=look["linestyle"], alpha=0.8)
        axes.plot(at, mean, marker=look["marker"], color=look["color"], linestyle="none",
                  markerfacecolor="white", markeredgewidth=1.4, markersize=5.5, zorder=3)
        if len(x) > len(at):
            axes.plot(x, y, ".", alpha=0.5, markersize=3.5, color=look["color"])
        ends.append((y.min(), y.max(), x.min(), x.max()))
    if not ends:
        return None
    low, high, first, last = zip(*ends)
    return min(low), max(high), min(first), max(last)


def draw_theory(study, style, panel, axes, ends):
    """Curves that have the same closed form in one colour: one line. What is far from all
    points is left out, and the panel told."""
    drawn = []
    for figure in panel.theory:
        line, left_out = panel.line_of(figure), []
        for key in study.keys():
            found = study.theory(figure, key)
            if found is None:
                continue
            x, y, colour = found[0], panel.scale * found[1], style.colour(key)
            if ends is not None and np.nanmin(y) > FARTHEST * max(ends[1], 0.):
                left_out += [np.nanmin(y), np.nanmax(y)]
                continue
            if any(c == colour and l == line and np.array_equal(x, a) and
                   np.allclose(y, b, equal_nan=True)
                   for c, l, a, b in drawn):
                continue
            drawn.append((colour, line, x, y))
            axes.plot(x, y, color=colour, linestyle=line, linewidth=1.2, zorder=1)
        if left_out:
            panel.far.append(f"{name_of_theory(figure)}, {min(left_out):.4g} to "
                             f"{max(left_out):.4g} {panel.unit}")
    return drawn


def widen(axes, ends):
    """A scatter of some percent is not to fill the panel like a trend."""
    if ends is None:
        return
    low, high = ends[:2]
    least = LEAST_SPAN * max(abs(low), abs(high))
    if high - low < least:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.55 * least, middle + 0.55 * least)


def draw_panel(study, style, panel, axes):
    ends = draw_points(study, style, panel, axes)
    drawn = draw_theory(study, style, panel, axes, ends)
    # The view is that of the points and of what is not far from them.
    if ends is not None and drawn:
        top = min(max(np.nanmax(y) for *_, y in drawn), FARTHEST * ends[1])
        low = min(ends[0], *(np.nanmin(y) for *_, y in drawn))
        high = max(ends[1], top)
        if high > low and ends[1] > 0.:
            axes.set_ylim(low - 0.1 * (high - low), high + 0.1 * (high - low))
    if is_logarithmic(study.places()):
        axes.set_xscale("log")
    if ends is not None and is_logarithmic(ends[:2], 15.):
        axes.set_yscale("log")
        axes.set_ylim(None)
    elif not drawn:
        axes.margins(y=0.1)
        widen(axes, ends)
    axes.set_xlabel(words(study.axis))
    axes.set_ylabel(panel.label())
    axes.grid(color="#dddddd", linewidth=0.6)
    if panel.theory:
        first_of = {style.colour(key): key for key in reversed(study.keys())}
        ratios = distinct([(study.theta_per_axis(key), colour)
                           for colour, key in reversed(first_of.items())])
        add_theta_axes(axes, ratios if len(ratios) > 1 else
                       [(ratio, "black") for ratio, _ in ratios], TEXT - 1.5)


def rows_of_legend(rows, width):
    """@p rows of a title and handles, broken where @p width inches are full."""
    def taken(text):
        return 0.058 * len(text)
    for title, handles in rows:
        line = [Line2D([], [], linestyle="none", label=title)]
        used = taken(title)
        for one in handles:
            more = taken(one.get_label()) + 0.5
            if used + more > width and len(line) > 1:
                yield line
                line, used = [Line2D([], [], linestyle="none", label="")], 0.
            line.append(one)
            used += more
        yield line


def finish(figure, rows, width):
    """Legends above, a row each, and the rest below them."""
    lines = list(rows_of_legend(rows, width - 0.3))
    height = figure.get_size_inches()[1] + 0.19 * len(lines)
    figure.set_size_inches(figure.get_size_inches()[0], height)
    for k, line in enumerate(lines):
        figure.legend(handles=line, loc="upper left", ncol=len(line),
                      bbox_to_anchor=(0., 1. - 0.19 * k / height), frameon=False,
                      fontsize=TEXT - 1., handlelength=1.9, columnspacing=0.9,
                      handletextpad=0.4, borderaxespad=0.2)
    figure.tight_layout(pad=0.5, w_pad=1.5, h_pad=1.2,
                        rect=(0., 0., 1., 1. - 0.19 * len(lines) / height))


def legend_of(style, panels):
    named = {name_of_theory(figure): panel.line_of(figure)
             for panel in panels for figure in panel.theory}
    handles = [Line2D([], [], color="#444444", linewidth=1.2, linestyle=line, label=name)
               for name, line in named.items()]
    return style.legend() + ([("closed forms", handles)] if handles else [])


def draw(study, panels):
    """@p panels in one figure, two beside each other."""
    style = Style(study)
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    with plt.rc_context({"font.size": TEXT, "axes.labelsize": TEXT}):
        figure, axes = plt.subplots(rows, columns, squeeze=False,
                                    figsize=(SIZE[0] * columns, SIZE[1] * rows))
        for panel, place in zip(panels, axes.flat):
            panel.far = []
            draw_panel(study, style, panel, place)
        for place in axes.flat[len(panels):]:
            place.set_visible(False)
        finish(figure, legend_of(style, panels), SIZE[0] * columns)
    return figure


def svg_of(figure, salt):
    """@p salt keeps the names in charts of one page apart."""
    text = io.StringIO()
    with plt.rc_context({"svg.hashsalt": salt, "svg.fonttype": "none"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    svg = text.getvalue()
    used = set(re.findall(r"#([\w-]+)", svg))
    return re.sub(r' id="([^"]*)"', lambda m: m[0] if m[1] in used else "", svg)
