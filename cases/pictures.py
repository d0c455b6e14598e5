#!/usr/bin/env python3
"""Pictures of a run: fracture map, force chains, displacement, stress, curves.

  python3 cases/pictures.py RUN_DIR [--step last|first|peak|N|all] [--out DIR]

Sections are drawn deformed, at true scale, in metres. N is the number in the names
of the field files; curves.png marks them. With --step all every picture gets the number in its name.
"""

import argparse
import os
import sys

try:
    import matplotlib
    import numpy as np
except ImportError as missing:
    sys.exit(f"pictures.py: {missing}. Install python3-numpy and python3-matplotlib, and "
             f"use the python3 that has them (this one is {sys.executable}).")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.collections import (  # noqa: E402
    EllipseCollection, LineCollection, PolyCollection)
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Patch, Rectangle  # noqa: E402
from curves_page import curves  # noqa: E402
from picture_style import DPI, SHEAR_CRACK, TENSION_CRACK  # noqa: E402
from run_files import Run, RunError  # noqa: E402

LAYER_COLOUR, MATRIX_COLOUR = "#a9a9a9", "#e4e4e4"
BED_COLOURS = (LAYER_COLOUR, "#cbb994", "#93a5b5")  # from below, and again
MESH_COLOUR, MESH_EDGE = "#f7f3e8", "#d5cbb0"
FRACTURE = "#08519c"
COMPRESSION, TENSION = "#1f4fa8", "#1a9641"
MATRIX_REGION = 1  # the layer, or its beds, are 0, 2, 3, ...
BROKEN_IN_TENSION = 1  # code of the field "mode"; 2 is broken in shear

LEFT, RIGHT, BELOW, ABOVE, BETWEEN, BESIDE = 0.8, 0.9, 0.6, 1.05, 0.7, 1.9  # [inch]
PANEL_WIDTH, PANEL_HEIGHT = 12., 7.  # largest [inch]


class Box:
    """A window of the section [m]."""

    def __init__(self, x0, x1, y0, y1):
        self.x0, self.x1, self.y0, self.y1 = x0, x1, y0, y1
        self.width, self.height = x1 - x0, y1 - y0

    def grown(self, share):
        d = share * max(self.width, self.height)
        return Box(self.x0 - d, self.x1 + d, self.y0 - d, self.y1 + d)


def is_layer(frame):
    """Which grains are the competent layer's; all if the file does not say."""
    region = frame.grains.field("region")
    if region is None:
        return np.ones(len(frame.grains.points), dtype=bool)
    return region != MATRIX_REGION


def beds(frame):
    """Number from below and grains of each bed of the layer; one where there is no stack."""
    layer = is_layer(frame)
    region = frame.grains.field("region")
    if region is None:
        return [(0, layer)]
    return [(0 if number == 0 else int(number) - MATRIX_REGION, region == number)
            for number in np.unique(region[layer])]


def body_range(values, gap):
    """Ends of the run of values around their median in which no two neighbours are farther
    apart than @p gap: without fragments that have flown off."""
    values = np.sort(values)
    wide = np.flatnonzero(np.diff(values) > gap)
    middle = len(values) // 2
    first = wide[wide < middle].max() + 1 if (wide < middle).any() else 0
    last = wide[wide >= middle].min() if (wide >= middle).any() else len(values) - 1
    return values[first], values[last]


def left_the_section(frame):
    """Which grains are fragments that have flown off, by gaps of four mean diameters."""
    points, gap = frame.grains.points, 8. * np.mean(frame.grains.field("radius_m"))
    away = np.zeros(len(points), dtype=bool)
    for values in points.T:
        low, high = body_range(values[~away], gap)
        away |= (values < low) | (values > high)
    return away


def whole_box(frame):
    corners = []
    if frame.grains is not None and len(frame.grains.points):
        stay = ~left_the_section(frame)
        points, r = frame.grains.points[stay], frame.grains.field("radius_m")[stay, None]
        corners += [points - r, points + r]
    if frame.continuum is not None:
        corners.append(frame.continuum.deformed_quads().reshape(-1, 2))
    if not corners:
        raise RunError(f"Step {frame.number} has neither grains nor a mesh to draw.")
    x, y = np.concatenate(corners).T
    return Box(x.min(), x.max(), y.min(), y.max())


def layer_thickness(points):
    """Median height of the layer in slices of its length, between outer centres [m]."""
    x, y = points.T
    n_slices = 60
    slice_of = np.minimum((n_slices * (x - x.min()) / np.ptp(x)).astype(int), n_slices - 1)
    return np.median([np.ptp(y[slice_of == i]) for i in np.unique(slice_of)])


def zoom_box(frame, whole, cracks):
    """Four layer thicknesses around the most cracked place, or the crest without cracks;
    None when that is most of the section anyhow."""
    if frame.grains is None or not is_layer(frame).any():
        return None
    points = frame.grains.points[is_layer(frame)]
    h = layer_thickness(points) + 2. * np.mean(frame.grains.field("radius_m"))
    if 4. * h > 0.6 * whole.width:
        return None
    if cracks is not None and len(cracks["x"]):
        x = np.sort(cracks["x"])
        in_window = np.searchsorted(x, x + 2. * h) - np.arange(len(x))  # cracks in [x, x+2h]
        first = int(np.argmax(in_window))
        centre = x[first:first + in_window[first]].mean()
    else:
        centre = points[np.argmax(points[:, 1]), 0]
    centre = np.clip(centre, whole.x0 + 2. * h, whole.x1 - 2. * h)
    near = points[abs(points[:, 0] - centre) < 2. * h, 1]
    low, high = body_range(near, np.mean(frame.grains.field("radius_m")))
    middle = (low + high) / 2.
    height = min(max(1.35 * (high - low), 1.7 * h), 2.3 * h)
    return Box(centre - 2. * h, centre + 2. * h, middle - height / 2., middle + height / 2.)


def cracks_of(run, frame):
    """Cracks up to this frame: place, direction, length, whether in tension; or None."""
    if frame.cracks is not None:
        grid = frame.cracks
        return {"x": grid.points[:, 0], "y": grid.points[:, 1],
                "angle": grid.field("orientation_rad"), "length": grid.field("length_m"),
                "tension": grid.field("mode") == BROKEN_IN_TENSION}
    if run.cracks is None:
        return None
    table = run.cracks
    past = np.asarray(table[run.loading_column()], dtype=float) <= frame.time * (1. + 1e-12)
    return {"x": table["x_m"][past], "y": table["y_m"][past],
            "angle": np.radians(table["orientation_deg"][past]),
            "length": table["length_m"][past], "tension": table["mode"][past] == "tension"}


class Figure:
    """Panels in true proportion: long sections below each other, tall ones in a row."""

    def __init__(self, run, frame, what, boxes):
        sizes = []
        for box in boxes:
            width = min(PANEL_WIDTH, PANEL_HEIGHT * box.width / box.height)
            sizes.append((width, width * box.height / box.width))
        widths, heights = np.array(sizes).T
        in_row = all(box.height > box.width for box in boxes)
        if in_row:
            left = LEFT + np.cumsum(widths + BESIDE) - widths - BESIDE
            top = np.full(len(boxes), ABOVE)
        else:
            left = np.full(len(boxes), LEFT)
            top = ABOVE + np.cumsum(heights + BETWEEN) - heights - BETWEEN
        self.width = max((left + widths).max() + RIGHT, 8.)
        self.height = (top + heights).max() + BELOW
        self.figure = plt.figure(figsize=(self.width, self.height))
        self.axes = []
        for box, width, height, x, y in zip(boxes, widths, heights, left, top):
            axes = self.figure.add_axes([x / self.width, 1. - (y + height) / self.height,
                                         width / self.width, height / self.height])
            axes.set(xlim=(box.x0, box.x1), ylim=(box.y0, box.y1), ylabel="y (m)")
            axes.tick_params(labelsize=9)
            axes.box = box
            axes.points_per_metre = 72. * width / box.width
            self.axes.append(axes)
        for axes in self.axes if in_row else self.axes[-1:]:
            axes.set_xlabel("x (m)")
        self._title(run, frame, what)

    def _title(self, run, frame, what):
        title = run.summary.get("title", "")
        self.figure.text(LEFT / self.width, 1. - 0.3 / self.height,
                         what + (f": {title}" if title else ""), fontsize=14, weight="bold")
        if run.modes is not None:
            state = "the straight section"
            for mode, stress in zip(run.modes["mode"], run.modes["layer_stress_Pa"]):
                if mode == frame.time:
                    state = (f"mode {mode:.0f}, scaled to 1, at a mean stress of the layer of "
                             f"{stress / 1e6:.4g} MPa")
        else:
            state = f"step ({frame.number}), "
            state += (f"wall rotation {frame.time:.3g}°" if run.bends()
                      else f"shortening {100. * frame.time:.3g} %")
            response = run.response_at(frame.number)
            if response is not None:
                state += f", {response}"
        away = 0 if frame.grains is None else np.count_nonzero(left_the_section(frame))
        if away:
            state += f"; {away} {'grain has' if away == 1 else 'grains have'} flown off"
        self.figure.text(LEFT / self.width, 1. - 0.54 / self.height, state, fontsize=11)

    def legend(self, handles):
        """One row, in smaller letters where it would not fit."""
        room = (self.width - LEFT) * self.figure.dpi
        for size in (10., 9., 8., 7., 6., 5.):
            legend = self.figure.legend(
                handles=handles, ncol=len(handles), frameon=False, fontsize=size,
                loc="upper left", handlelength=1.6, columnspacing=1.6,
                bbox_to_anchor=(LEFT / self.width, 1. - 0.64 / self.height),
                borderpad=0., borderaxespad=0.)
            if legend.get_window_extent(self.figure.canvas.get_renderer()).width <= room:
                return
            if size > 5.:
                legend.remove()

    def colour_bar(self, axes, mappable, label):
        axes.set_title(label, loc="left", fontsize=11)
        place = axes.get_position()
        bar = self.figure.add_axes([place.x1 + 0.12 / self.width, place.y0,
                                    0.16 / self.width, place.height])
        scale = self.figure.colorbar(mappable, cax=bar, extend="both")
        scale.formatter.set_powerlimits((-2, 4))
        scale.update_ticks()
        bar.tick_params(labelsize=9)

    def save(self, path):
        self.figure.savefig(path, dpi=DPI)
        plt.close(self.figure)
        print(path)


def in_box(box, points, margin):
    x, y = points.T
    return ((x > box.x0 - margin) & (x < box.x1 + margin) & (y > box.y0 - margin)
            & (y < box.y1 + margin))


def draw_grains(axes, frame, colours=None, values=None, norm=None, cmap=None):
    """Grains as disks, in colours or by values; edges only where they are large enough."""
    if frame.grains is None or not len(frame.grains.points):
        return
    radius = frame.grains.field("radius_m")
    seen = in_box(axes.box, frame.grains.points, radius.max())
    size = 2. * radius[seen]
    is_large = axes.points_per_metre * np.mean(radius) > 6.
    disks = EllipseCollection(size, size, np.zeros(len(size)), units="xy",
                              offsets=frame.grains.points[seen],
                              offset_transform=axes.transData,
                              linewidths=0.4 if is_large else 0.,
                              edgecolors="white" if is_large else "none")
    if values is None:
        disks.set_facecolor(np.asarray(colours)[seen] if np.ndim(colours) else colours)
    else:
        disks.set(array=values[seen], norm=norm, cmap=cmap)
    axes.add_collection(disks)


def draw_mesh(axes, frame, values=None, norm=None, cmap=None):
    if frame.continuum is None:
        return
    quads = frame.continuum.deformed_quads()
    cells = PolyCollection(quads)
    if values is None:
        cells.set(facecolor=MESH_COLOUR, edgecolor=MESH_EDGE, linewidth=0.35)
    else:
        cells.set(array=values, norm=norm, cmap=cmap, edgecolor="face", linewidth=0.2)
    axes.add_collection(cells)


def layer_colours(frame):
    if frame.grains is None:
        return None
    colours = np.full(len(frame.grains.points), MATRIX_COLOUR)
    for bed, chosen in beds(frame):
        colours[chosen] = BED_COLOURS[bed % len(BED_COLOURS)]
    return colours


def mark_zoom(figure, zoom):
    if zoom is not None:
        figure.axes[-2].add_patch(Rectangle((zoom.x0, zoom.y0), zoom.width, zoom.height,
                                           fill=False, linewidth=0.9, edgecolor="#7b3294"))
        for spine in figure.axes[-1].spines.values():
            spine.set(edgecolor="#7b3294", linewidth=1.4)


def fracture_map(run, frame, path):
    cracks = cracks_of(run, frame)
    whole = whole_box(frame)
    zoom = zoom_box(frame, whole, cracks)
    figure = Figure(run, frame, "Fractures", [whole.grown(0.01)] + ([zoom] if zoom else []))
    handles = []
    for axes in figure.axes:
        draw_mesh(axes, frame)
        draw_grains(axes, frame, layer_colours(frame))
    if cracks is not None:
        half = 0.5 * cracks["length"] * np.array([np.cos(cracks["angle"]),
                                                  np.sin(cracks["angle"])])
        centre = np.array([cracks["x"], cracks["y"]])
        ends = np.stack([centre - half, centre + half]).transpose(2, 0, 1)
        for mode, chosen, colour in (("tension", cracks["tension"], TENSION_CRACK),
                                     ("shear", ~cracks["tension"], SHEAR_CRACK)):
            handles.append(Line2D([], [], color=colour, linewidth=2.5,
                                  label=f"{mode} cracks: {np.count_nonzero(chosen)}"))
            for axes in figure.axes:
                width = 1.1 if axes.box.width > 0.5 * whole.width else 2.
                axes.add_collection(LineCollection(ends[chosen], colors=colour,
                                                   linewidths=width, zorder=3))
    if frame.fractures is not None and len(frame.fractures.types):
        lines = frame.fractures.lines()
        for axes in figure.axes:
            axes.add_collection(LineCollection(lines, colors=FRACTURE, linewidths=1.4,
                                               zorder=2.5))
        handles.append(Line2D([], [], color=FRACTURE, linewidth=2.5,
                              label="fractures, sliding beds"))
    if frame.grains is not None:
        stack = beds(frame)
        for bed, _ in stack:
            handles.append(Patch(facecolor=BED_COLOURS[bed % len(BED_COLOURS)],
                                 label="competent layer" if len(stack) == 1
                                 else f"bed {bed + 1}"))
        if not is_layer(frame).all():
            handles.append(Patch(facecolor=MATRIX_COLOUR, label="matrix grains"))
    if frame.continuum is not None:
        handles.append(Patch(facecolor=MESH_COLOUR, edgecolor=MESH_EDGE,
                             label="finite elements"))
    figure.legend(handles)
    mark_zoom(figure, zoom)
    figure.save(path)


def with_prefix(x):
    """A number with k, M or G, three digits."""
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if x >= factor:
            return f"{x / factor:.3g} {prefix}"
    return f"{x:.3g} "


def force_chains(run, frame, path):
    if frame.joints is None or not len(frame.joints.types):
        return
    force = frame.joints.cell_fields["normal_force_N"]
    lines = frame.joints.lines()
    full = np.percentile(abs(force), 99.5)
    if full == 0.:
        print(f"{path}: not drawn, no joint carries a normal force", file=sys.stderr)
        return
    whole = whole_box(frame)
    zoom = zoom_box(frame, whole, cracks_of(run, frame))
    figure = Figure(run, frame, "Force chains",
                    [whole.grown(0.01)] + ([zoom] if zoom else []))
    spacing = np.median(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1))
    for axes in figure.axes:
        draw_mesh(axes, frame)
        draw_grains(axes, frame, "#f0f0f0")
        widest = max(0.55 * spacing * axes.points_per_metre, 0.6)
        seen = in_box(axes.box, lines.mean(axis=1), spacing) & (abs(force) > 0.02 * full)
        for sign, colour in ((-1., COMPRESSION), (1., TENSION)):
            chosen = seen & (sign * force > 0.)
            axes.add_collection(LineCollection(
                lines[chosen], colors=colour, capstyle="round",
                linewidths=widest * np.minimum(abs(force[chosen]) / full, 1.)))
    figure.legend([
        Line2D([], [], color=COMPRESSION, linewidth=3., label="compression"),
        Line2D([], [], color=TENSION, linewidth=3., label="tension"),
        Line2D([], [], color="none", label="widest lines: normal force from "
               f"{with_prefix(full)}N per metre of depth")])
    mark_zoom(figure, zoom)
    figure.save(path)


def coloured_section(figure, axes, frame, mesh_values, grain_values, label, diverging):
    """Mesh and grains in one colour scale; the one without values stays pale."""
    values = np.concatenate([v for v in (mesh_values, grain_values) if v is not None])
    low, high = np.percentile(values, [0.5, 99.5])
    if diverging:
        high = max(abs(low), abs(high))
        low = -high
    if low == high:
        low, high = low - 1., high + 1.
    norm = matplotlib.colors.Normalize(low, high)
    cmap = "RdBu_r" if diverging else "viridis"
    if grain_values is None:  # where both are, what has values is on top
        draw_grains(axes, frame, MATRIX_COLOUR)
    draw_mesh(axes, frame, mesh_values, norm, cmap)
    if grain_values is not None:
        draw_grains(axes, frame, values=grain_values, norm=norm, cmap=cmap)
    figure.colour_bar(axes, matplotlib.cm.ScalarMappable(norm, cmap), label)


def displacement(run, frame, path):
    mesh = grains = None
    if frame.continuum is not None:
        for name in ("displacement", "displacement_m"):
            mesh = frame.continuum.cell_values(name) if mesh is None else mesh
    if frame.grains is not None:
        grains = frame.grains.field("displacement_m", "displacement")
    if mesh is None and grains is None:
        return
    box = whole_box(frame).grown(0.01)
    figure = Figure(run, frame, "Displacement", [box, box])
    parts = (("magnitude of the displacement (m)", lambda u: np.linalg.norm(u[:, :2], axis=1), False),
             ("vertical displacement, upward positive (m)", lambda u: u[:, 1], True))
    for axes, (label, part, diverging) in zip(figure.axes, parts):
        coloured_section(figure, axes, frame, None if mesh is None else part(mesh),
                         None if grains is None else part(grains), label, diverging)
    figure.save(path)


def stress(run, frame, path):
    """sigma_xx of the mesh and of the grains, each in a scale of its own: the layer
    carries orders of magnitude more than its matrix."""
    name = "stress_xx_Pa"
    mesh = None if frame.continuum is None else frame.continuum.cell_values(name)
    grains = None if frame.grains is None else frame.grains.field(name)
    whole = whole_box(frame)
    zoom = zoom_box(frame, whole, cracks_of(run, frame)) if grains is not None else None
    label = r"$\sigma_{xx}$ of the %s (MPa), tension positive"
    panels = []
    if mesh is not None:
        panels.append((whole.grown(0.01), mesh / 1e6, None, label % "finite elements"))
    if grains is not None:
        panels.append((whole.grown(0.01), None, grains / 1e6, label % "grains"))
    if zoom is not None:
        panels.append((zoom, None, grains / 1e6, label % "grains"))
    if not panels:
        return
    figure = Figure(run, frame, "Horizontal stress", [p[0] for p in panels])
    for axes, (_, mesh_values, grain_values, text) in zip(figure.axes, panels):
        coloured_section(figure, axes, frame, mesh_values, grain_values, text, True)
    mark_zoom(figure, zoom)
    figure.save(path)


def draw_all(run, which, folder):
    os.makedirs(folder, exist_ok=True)
    curves(run, os.path.join(folder, "curves.png"))
    for number in run.numbers(which):
        frame = run.frame(number)
        suffix = f"_{number:04d}.png" if which == "all" else ".png"
        for draw in (fracture_map, force_chains, displacement, stress):
            draw(run, frame, os.path.join(folder, draw.__name__ + suffix))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", metavar="RUN_DIR", help="directory of a run")
    parser.add_argument("--step", default="last", help="last (default), first, peak, all "
                        "or a number")
    parser.add_argument("--out", metavar="DIR", help="where to (default: RUN_DIR/pictures)")
    options = parser.parse_args()
    try:
        draw_all(Run(options.run), options.step, options.out or os.path.join(options.run, "pictures"))
    except (RunError, OSError) as error:
        sys.exit(f"pictures.py: {error}")


if __name__ == "__main__":
    main()
