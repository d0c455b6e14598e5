"""Charts of a report: directions and spacing of cracks, energy ledger, cost by effect."""

import matplotlib.pyplot as plt
import numpy as np
from picture_style import SHEAR_CRACK, TENSION_CRACK

ENERGIES = (("kinetic_J", "kinetic", "#7f7f7f"),
            ("strain_grains_J", "strain, grains", "#1f4fa8"),
            ("strain_continuum_J", "strain, finite elements", "#8fb4e3"),
            ("slip_J", "slip", "#fdae61"),
            ("fracture_J", "fracture", TENSION_CRACK),
            ("damping_J", "damping", "#b9a7c9"))
JOINED = 1.5  # cracks nearer than that many grain diameters are one fracture
TRUNK = 0.2  # a fracture is as long as that share of the layer's thickness


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)


def crack_rose(cracks, path):
    """Length of cracks by direction, each mode apart; a half circle, since a line has two ends."""
    figure, axes = plt.subplots(figsize=(6., 3.6), subplot_kw={"projection": "polar"})
    edges = np.radians(np.arange(-90., 91., 10.))
    below = np.zeros(len(edges) - 1)
    for mode, colour in (("tension", TENSION_CRACK), ("shear", SHEAR_CRACK)):
        chosen = cracks["mode"] == mode
        length, _ = np.histogram(np.radians(cracks["orientation_deg"][chosen]), edges,
                                 weights=cracks["length_m"][chosen])
        axes.bar(edges[:-1], length, width=np.diff(edges), align="edge", bottom=below,
                 color=colour, edgecolor="white", linewidth=0.6, label=mode)
        below += length
    axes.set_thetamin(-90.)
    axes.set_thetamax(90.)
    axes.set_thetagrids(np.arange(-90, 91, 30))
    axes.tick_params(labelsize=8)
    axes.set_title("length of cracks (m) by direction; 0° along the section, ±90° across it",
                   fontsize=9)
    axes.legend(frameon=False, fontsize=9, loc="center left", bbox_to_anchor=(1.05, 0.9))
    figure.tight_layout()
    save(figure, path)


def groups(points, reach):
    """Number of the connected group of each point, those within @p reach of each other joined."""
    parent = np.arange(len(points))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    cells = {}
    for i, cell in enumerate(map(tuple, np.floor(points / reach).astype(int))):
        cells.setdefault(cell, []).append(i)
    for (x, y), members in cells.items():
        around = [j for dx in (0, 1) for dy in (-1, 0, 1) if (dx, dy) >= (0, 0)
                  for j in cells.get((x + dx, y + dy), ())]
        others = points[around]
        for i in members:
            near = np.hypot(*(others - points[i]).T) <= reach
            for j in np.asarray(around)[near]:
                parent[root(i)] = root(j)
    return np.array([root(i) for i in range(len(points))])


def fractures(cracks, diameter, thickness):
    """Places along the undeformed layer of its fractures in tension, ascending [m]: groups of
    neighbouring cracks that together reach over a fifth of the thickness."""
    layer = (cracks["layer"] != 1) & (cracks["mode"] == "tension")
    points = np.column_stack([cracks["reference_x_m"], cracks["reference_y_m"]])[layer]
    if not len(points):
        return np.array([])
    group = groups(points, JOINED * diameter)
    places = []
    for number in np.unique(group):
        members = points[group == number]
        if np.hypot(*np.ptp(members, axis=0)) + diameter >= TRUNK * thickness:
            places.append(members[:, 0].mean())
    return np.sort(places)


def crack_spacing(places, thickness, path):
    """Histogram of the spacing of fractures; at least three fractures."""
    spacing = np.diff(places) / thickness
    figure, axes = plt.subplots(figsize=(6., 3.4))
    bins = np.linspace(0., max(1.05 * spacing.max(), 1e-3), 16)
    axes.hist(spacing, bins, color="#93a5b5", edgecolor="white")
    axes.axvline(spacing.mean(), color="black", linewidth=1.2)
    axes.annotate(f" mean {spacing.mean():.2g}", (spacing.mean(), 1.), va="top", fontsize=9,
                  xycoords=("data", "axes fraction"))
    axes.set_xlabel("spacing of fractures over the layer's thickness (-)")
    axes.set_ylabel("number")
    axes.yaxis.get_major_locator().set_params(integer=True)
    figure.tight_layout()
    save(figure, path)


def energy_ledger(run, path):
    """Where the walls' work is, stacked over the loading; the work itself as a line."""
    history = run.history
    x = run.loading().drawn
    names = [entry for entry in ENERGIES if entry[0] in history and np.any(history[entry[0]])]
    if not names or "boundary_work_J" not in history or len(x) < 2:
        return
    largest = max(abs(history["boundary_work_J"]).max(),
                  max(abs(history[name]).max() for name, _, _ in names))
    factor, unit = next((f, u) for f, u in ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ"), (1., "J"),
                                            (0., "J")) if largest >= f)
    factor = factor or 1.
    figure, axes = plt.subplots(figsize=(9., 4.2))
    axes.stackplot(x, [history[name] / factor for name, _, _ in names],
                   labels=[label for _, label, _ in names],
                   colors=[colour for _, _, colour in names], linewidth=0.)
    axes.plot(x, history["boundary_work_J"] / factor, color="black", linewidth=1.4,
              linestyle="--", label="work from outside")
    axes.set_xlim(x.min(), x.max())
    axes.set_xlabel(run.loading().label)
    axes.set_ylabel(f"energy ({unit} per metre of depth)")
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.legend(frameon=False, fontsize=9, loc="upper left")
    figure.tight_layout()
    save(figure, path)


def costs(effects, wall_seconds):
    """(name, seconds, share of all) of what took time, the longest first; the rest last."""
    taken = sorted(((name, e["seconds"]) for name, e in effects.items() if e["seconds"] > 0.),
                   key=lambda pair: -pair[1])
    rest = wall_seconds - sum(seconds for _, seconds in taken)
    rows = taken + ([("the rest: building the scene, reading, writing", rest)]
                    if rest > 0. else [])
    return [(name, seconds, seconds / max(wall_seconds, 1e-12)) for name, seconds in rows]


def cost_bars(rows, path):
    rows = [row for row in rows if row[2] >= 0.002]
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(9., 0.5 + 0.32 * len(rows)))
    y = np.arange(len(rows))[::-1]
    axes.barh(y, [seconds for _, seconds, _ in rows], color="#93a5b5")
    for place, (_, seconds, share) in zip(y, rows):
        axes.annotate(f" {seconds:.3g} s, {100. * share:.0f} %", (seconds, place), va="center",
                      fontsize=9)
    axes.set_yticks(y, [name for name, _, _ in rows], fontsize=9)
    axes.set_xlim(0., 1.18 * max(seconds for _, seconds, _ in rows))
    axes.set_xlabel("seconds of the clock")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.tight_layout()
    save(figure, path)
