#!/usr/bin/python3
"""How a layer folds and breaks under a cover of 0.01 to 100 times its thickness.

    antiform study cases/burial-depth/study-fracture.prm -o DIRECTORY
    /usr/bin/python3 cases/burial-depth/fracture_curves.py DIRECTORY [--maps CONTRAST]

Draws peak stress (theory beside it), fold, cracks and spacing against H/h and Theta, and
the fractures of five layers of one contrast. Writes fracture_curves.png and the tables
fracture_curves.md. Closed forms are those of 'antiform theory'.
"""
import argparse
import glob
import json
import os
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from PIL import Image  # comes with matplotlib

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from depth_axis import add_theta_axes  # noqa: E402
from picture_style import DPI, SHEAR_CRACK, TENSION_CRACK  # noqa: E402
from run_files import Grid, read_deck, read_table  # noqa: E402
from theory_lines import TheoryError, installed_program, theory_along  # noqa: E402

COLOURS = ("#b5651d", "#2e8b57", "#1f4fa8", "#7b3294")  # of the contrasts, ascending
MARKERS = {"surface interface": "o", "grain cover": "s", "bridging domain": "^"}
WORDS = {"surface interface": "mesh on the layer", "grain cover": "cover of grains",
         "bridging domain": "bridged to a mesh"}
SPLITTING = "#f4a582"
MAPS = (0.01, 0.1, 1., 10., 100.)
MECHANISMS = {1: "crushes", 2: "folds and cracks", 3: "buckles"}
STRETCH = 4.  # of the maps' heights
COVERS = np.geomspace(0.01, 100., 81)  # H/h of the closed forms
GUIDED = "theory_at_length_{}_guided_Pa"


def members_of(directory):
    """A dictionary a member: its values, figures, join and scene. One that the mesh has
    stopped in its collapse counts: what it tells of the peak holds."""
    path = os.path.join(directory, "study.json")
    if not os.path.exists(path):
        sys.exit(f"fracture_curves.py: there is no '{path}'. Make it with 'antiform study "
                 f"cases/burial-depth/study-fracture.prm -o {directory}'.")
    with open(path) as file:
        record = json.load(file)
    members = []
    for member in record["members"]:
        if member["status"] != "completed":
            print(f"{member['name']}: {member['status']} {member.get('reason', '')}",
                  file=sys.stderr)
        if member["status"] not in ("completed", "failed") or not member["figures"]:
            continue
        folder = os.path.join(directory, "members", member["name"])
        deck = read_deck(os.path.join(folder, "deck.prm"))
        with open(os.path.join(folder, "summary.json")) as file:
            summary = json.load(file)
        results = {name: entry["value"] for name, entry in summary["results"].items()}
        figures = member["figures"]
        members.append({
            "folder": folder, "results": results, "join": deck["Matrix/Join"],
            "H": float(deck["Matrix/Burial depth ratio"]),
            "contrast": float(deck["Matrix/Stiffness contrast"]),
            "h": float(deck["Layer/Thickness"]), "UCS": float(deck["Layer/UCS"]),
            "asked": member["values"].get("join", "automatic"),
            "crushing": figures.get(GUIDED.format("perry_robertson")),
            "closure": summary["energy"]["closure_error"],
            "seconds": summary["cpu_seconds"]})
    if not members:
        sys.exit("fracture_curves.py: no member of the study has finished.")
    return sorted(members, key=lambda m: (m["contrast"], m["H"], m["asked"] != "automatic"))


def stress_on_the_way(member, shortening):
    """Axial stress at a shortening before the peak [Pa]."""
    history = read_table(os.path.join(member["folder"], "history.csv"))
    return float(np.interp(shortening, history["shortening"], history["axial_stress_Pa"]))


def jumps(members):
    """(contrast, H, join chosen, other join, other over chosen less 1: of the peak, and of
    the stress at half of its strain, where few elements have broken)."""
    found = []
    for chosen in members:
        for other in members:
            if (chosen["asked"] == "automatic" != other["asked"] and
                    all(chosen[key] == other[key] for key in ("H", "contrast"))):
                half = 0.5 * chosen["results"]["strain_at_peak"]
                found.append((chosen["contrast"], chosen["H"], chosen["join"],
                              other["join"], other["results"]["peak_stress"] /
                              chosen["results"]["peak_stress"] - 1.,
                              stress_on_the_way(other, half) /
                              stress_on_the_way(chosen, half) - 1.))
    return found


def curve(axes, of, value, colour, **style):
    """Line through what the program chose, a marker a representation for all."""
    chosen = sorted((m for m in of if m["asked"] == "automatic" and
                     value(m) is not None), key=lambda m: m["H"])
    axes.plot([m["H"] for m in chosen], [value(m) for m in chosen], color=colour,
              linewidth=1.3, **style)
    for m in of:
        if value(m) is not None:
            axes.plot(m["H"], value(m), marker=MARKERS[m["join"]], color=colour,
                      markersize=6.5, markeredgewidth=1.4, linestyle="none",
                      markerfacecolor="white" if m["asked"] == "automatic" else "none",
                      alpha=1. if m["asked"] == "automatic" else 0.55)


def write_row(axes, of, row, colour):
    """A row of words below the curves: the mechanism at the thinnest cover and wherever it
    is another one than before, and the jumps where two representations are possible."""
    def word(H, text, **style):
        axes.annotate(text, (H, 0.05 + 0.075 * row), color=colour, fontsize=8.5,
                      xycoords=("data", "axes fraction"), **style)

    before = None
    for m in sorted(of, key=lambda m: m["H"]):
        mechanism = MECHANISMS[int(m["results"]["mechanism"])]
        if m["asked"] == "automatic" and mechanism != before:
            word(m["H"], mechanism, style="italic", ha="left" if before is None else "center")
            before = mechanism
    for _, H, _, _, jump, _ in jumps(of):
        word(H, f"{100. * jump:+.1f} %", ha="center")


def draw_theory(program, contrasts, members, axes):
    """Closed forms at every cover of a layer of each contrast, and Theta above."""
    ratios = []
    for colour, contrast in zip(COLOURS, contrasts):
        deck = next(m["folder"] for m in members if m["contrast"] == contrast) + ".prm"
        try:
            forms = theory_along(program, deck, {"Matrix/Burial depth ratio": COVERS})
        except TheoryError as error:
            print(f"no closed forms: {error}", file=sys.stderr)
            continue
        for name, line in (("perry_robertson", "--"), ("with_matrix", ":")):
            axes.plot(COVERS, 1e-6 * forms[GUIDED.format(name)], color=colour,
                      linewidth=1.1, linestyle=line)
        ratios.append((forms["theory_regime_theta"][-1] / COVERS[-1], colour))
    axes.set_xscale("log")
    add_theta_axes(axes, ratios)


def draw_curves(program, members, axes):
    contrasts = sorted({m["contrast"] for m in members})
    stress, fold, dip, cracks, spacing = axes
    strength = 1e-6 * members[0]["UCS"]
    stress.axhline(strength, color="black", linewidth=1.)
    stress.annotate(r"$\gamma=1$: UCS", (0.0075, strength), xytext=(0, 3), fontsize=9,
                    textcoords="offset points")
    highest = max(m["results"]["peak_stress"] for m in members)
    draw_theory(program, contrasts, members, stress)
    for row, (colour, contrast) in enumerate(zip(COLOURS, contrasts)):
        of = [m for m in members if m["contrast"] == contrast]
        curve(stress, of, lambda m: 1e-6 * m["results"]["peak_stress"], colour)
        write_row(stress, of, row, colour)
        curve(fold, of, lambda m: m["results"]["fold_amplitude_at_peak"] / m["h"], colour)
        curve(dip, of, lambda m: m["results"]["limb_dip_at_peak"], colour)
        curve(cracks, of, lambda m: m["results"]["cracks_tensile_at_peak"] +
              m["results"]["cracks_shear_at_peak"], colour)
        curve(spacing, of, lambda m: (m["results"]["crack_spacing"] / m["h"]
                                      if "crack_spacing" in m["results"] else None), colour)
    stress.set(ylim=(0., 1.22e-6 * max(highest, members[0]["UCS"])),
               ylabel="peak stress (MPa)")
    small = {"fontsize": 8.5}
    fold.set_ylabel("crest over\ntrough, peak (h)", **small)
    dip.set_ylabel("limb dip,\npeak (degrees)", **small)
    cracks.set_ylabel("broken elem-\nents, peak", **small)
    spacing.set_ylabel("fracture spac-\ning, end (h)", **small)
    spacing.set(xlabel="burial depth ratio H/h")
    for panel in (fold, dip, cracks, spacing):
        panel.set_ylim(0., 1.15 * panel.get_ylim()[1])
    for panel in axes:
        panel.set(xscale="log", xlim=(0.007, 145.))
        panel.grid(color="#e4e4e4", linewidth=0.6)
    handles = [Line2D([], [], color=c, linewidth=2., label=f"$E/E_0$ = {contrast:g}")
               for c, contrast in zip(COLOURS, contrasts)]
    handles += [Line2D([], [], color="#555555", marker=MARKERS[join], linestyle="none",
                       markerfacecolor="white", label=WORDS[join])
                for join in MARKERS if any(m["join"] == join for m in members)]
    handles += [Line2D([], [], color="#555555", linestyle="--",
                       label="closed form: inner arc crushes"),
                Line2D([], [], color="#555555", linestyle=":",
                       label="closed form: elastic buckling")]
    stress.legend(handles=handles, frameon=False, fontsize=8.5, ncol=3,
                  loc="lower center", bbox_to_anchor=(0.5, 1.33), columnspacing=1.2)


def deformed_layer(folder):
    """Last grains of the layer: where they were, where they are, radii."""
    path = sorted(glob.glob(os.path.join(folder, "fields", "grains_*.vtu")))[-1]
    grid = Grid(path)
    layer = grid.field("region") != 1.
    displacement = grid.field("displacement_m")[layer, :2]
    points = grid.points[layer]
    return points - displacement, points, grid.field("radius_m")[layer]


def outline(points, radii, width):
    """Lower and upper rim of the grains, a place a column of @p width."""
    columns = np.floor((points[:, 0] - points[:, 0].min()) / width).astype(int)
    rows = []
    for c in range(columns.max() + 1):
        of = columns == c
        if of.any():
            rows.append((points[of, 0].mean(), (points[of, 1] - radii[of]).min(),
                         (points[of, 1] + radii[of]).max()))
    return np.array(rows).T


def draw_map(member, axes):
    before, now, radii = deformed_layer(member["folder"])
    h = member["h"]
    x, low, high = outline(now, radii, 2. * radii.max())
    axes.fill_between(x / h, low / h, high / h, color="#e9e5dc", linewidth=0.)
    cracks = read_table(os.path.join(member["folder"], "cracks.csv"))
    if len(cracks["step"]):
        places = np.column_stack([cracks["reference_x_m"], cracks["reference_y_m"]])
        # Carried along with the nearest grain, in parts: the table of distances is large.
        nearest = np.concatenate([
            np.argmin(((part[:, None] - before[None]) ** 2).sum(axis=2), axis=1)
            for part in np.array_split(places, max(1, len(places) // 200))])
        places = places + (now - before)[nearest]
        angle = np.radians(cracks["orientation_deg"])
        half = 0.9 * cracks["length_m"][:, None] * np.column_stack([np.cos(angle),
                                                                   np.sin(angle)])
        lines = np.stack([places - half, places + half], axis=1) / h
        shear = cracks["mode"] == "shear"
        across = np.abs(np.sin(angle)) > np.sqrt(0.5)
        for which, colour in ((~shear & ~across, SPLITTING), (~shear & across,
                                                              TENSION_CRACK),
                              (shear, SHEAR_CRACK)):
            axes.add_collection(LineCollection(lines[which], colors=colour,
                                               linewidths=0.9))
    results = member["results"]
    axes.set_aspect(STRETCH)
    axes.set(xlim=(x.min() / h - 0.3, x.max() / h + 0.3),
             ylim=(low.min() / h - 0.1, high.max() / h + 0.1))
    axes.axis("off")
    axes.text(0., 1.02, f"H/h = {member['H']:g}", transform=axes.transAxes, fontsize=9.5,
              weight="bold", va="bottom")
    axes.text(1., 1.02, f"{WORDS[member['join']]}; {1e-6 * results['peak_stress']:.1f} MPa,"
              f" {MECHANISMS[int(results['mechanism'])]}", transform=axes.transAxes,
              fontsize=8.5, va="bottom", ha="right", color="#444444")


def draw(program, members, contrast, directory):
    mapped = [next((m for m in members if m["contrast"] == contrast and m["H"] == H),
                   None) for H in MAPS]  # the chosen representation comes first
    mapped = [m for m in mapped if m is not None]
    figure = plt.figure(figsize=(12.6, 9.))
    left = figure.add_gridspec(5, 1, left=0.065, right=0.475, top=0.765, bottom=0.065,
                               height_ratios=[2.6, 1., 1., 1., 1.], hspace=0.13)
    axes = [figure.add_subplot(left[0])]
    axes += [figure.add_subplot(left[k], sharex=axes[0]) for k in range(1, 5)]
    for panel in axes[:-1]:
        panel.tick_params(labelbottom=False)
    draw_curves(program, members, axes)
    right = figure.add_gridspec(max(1, len(mapped)), 1, left=0.515, right=0.985, top=0.84,
                                bottom=0.03, hspace=0.2)
    for k, member in enumerate(mapped):
        draw_map(member, figure.add_subplot(right[k]))
    figure.suptitle("A layer of hard limestone folds and breaks under a cover", x=0.065,
                    ha="left", fontsize=14, weight="bold", y=0.985)
    figure.text(0.065, 0.93, f"rock 1, h = {members[0]['h']:g} m, bent beforehand, cemented"
                " to its matrix, shortened between guided ends", fontsize=10)
    figure.text(0.515, 0.905, f"Fractures at the end, $E/E_0$ = {contrast:g}; heights"
                f" {STRETCH:g} times too large", fontsize=10)
    figure.legend(handles=[Line2D([], [], color=TENSION_CRACK, label="opens across the"
                                  " layer"),
                           Line2D([], [], color=SPLITTING, label="splits along it"),
                           Line2D([], [], color=SHEAR_CRACK, label="shear")],
                  frameon=False, ncol=3, fontsize=9, loc="upper left",
                  bbox_to_anchor=(0.507, 0.9))
    path = os.path.join(directory, "fracture_curves.png")
    figure.savefig(path, dpi=DPI)
    Image.open(path).convert("RGB").quantize(96).save(path, optimize=True)  # a fifth


def report(members, directory):
    lines = ["| E/E0 | H/h | join | peak, MPa | closed form | | fold at the peak, h | grown |"
             " cracks at the peak | end: tension, shear | across | spacing, h | limb dip |"
             " mechanism | books | s |", "|" + " --- |" * 16]
    for m in members:
        r = m["results"]
        spacing = f"{r['crack_spacing'] / m['h']:.2f}" if "crack_spacing" in r else ""
        lines.append(
            f"| {m['contrast']:g} | {m['H']:g} | {m['join']} "
            f"| {1e-6 * r['peak_stress']:.1f} | {1e-6 * m['crushing']:.1f} "
            f"| {100. * (r['peak_stress'] / m['crushing'] - 1.):+.1f} % "
            f"| {r['fold_amplitude_at_peak'] / m['h']:.2f} "
            f"| {r['fold_growth_at_peak']:.2f} "
            f"| {r['cracks_tensile_at_peak'] + r['cracks_shear_at_peak']:.0f} "
            f"| {r['cracks_tensile']:.0f}, {r['cracks_shear']:.0f} "
            f"| {100. * r.get('cracks_across_share', 0.):.0f} % | {spacing} "
            f"| {r['limb_dip']:.1f} | {MECHANISMS[int(r['mechanism'])]} "
            f"| {m['closure']:.1e} | {m['seconds']:.0f} |")
    lines += ["", "| E/E0 | H/h | chosen | other | other over chosen: peak | stress at half"
              " of its strain |", "| --- | --- | --- | --- | --- | --- |"]
    for contrast, H, chosen, other, peak, before in jumps(members):
        lines.append(f"| {contrast:g} | {H:g} | {chosen} | {other} "
                     f"| {100. * peak:+.1f} % | {100. * before:+.2f} % |")
    text = "\n".join(lines) + "\n"
    with open(os.path.join(directory, "fracture_curves.md"), "w") as file:
        file.write(text)
    print(text)
    print(f"{len(members)} members, {sum(m['seconds'] for m in members):.0f} s of "
          "processor time")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("directory", help="of the study; for the picture too")
    parser.add_argument("--maps", type=float, help="contrast of the maps (the highest)")
    parser.add_argument("--antiform", default=installed_program(),
                        help="the program, for the closed forms")
    arguments = parser.parse_args()
    members = members_of(arguments.directory)
    report(members, arguments.directory)
    draw(arguments.antiform, members, arguments.maps or max(m["contrast"] for m in members),
         arguments.directory)


if __name__ == "__main__":
    main()
