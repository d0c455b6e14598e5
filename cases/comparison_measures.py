"""What runs of one scene are compared by: numbers of their curves, crack zones, fields."""

import numpy as np
from run_files import RunError

BELOW = 0.3  # of the peak: the first part of a curve, which gives the stiffness
SHARE = 0.8  # of the peak at which folds are compared
MOST_POINTS = 400  # at which displacements are compared


class Measure:
    """A number of a run: how it is called and written."""

    def __init__(self, name, label, unit, text, scatters=True):
        self.name, self.label, self.unit, self.text = name, label, unit, text
        self.scatters = scatters  # with the packing


def in_units(factor, unit):
    return lambda x: f"{x * factor:.4g} {unit}".rstrip()


MEASURES = (
    Measure("stiffness", f"stiffness, up to {BELOW:.0%} of the peak", "Pa",
            in_units(1e-9, "GPa")),
    Measure("peak_moment", "peak moment", "N m", in_units(1e-6, "MN m")),
    Measure("rotation_at_peak", "rotation at the peak", "deg", in_units(1., "degrees")),
    Measure("peak_stress", "peak stress", "Pa", in_units(1e-6, "MPa")),
    Measure("strain_at_peak", "strain at the peak", "-", in_units(100., "%")),
    Measure("fold_amplitude", f"fold amplitude at {SHARE:.0%} of the peak", "m",
            in_units(1., "m")),
    Measure("amplification", f"growth of the fold up to there", "m", in_units(1., "m")),
    Measure("cracks_at_peak", "cracks at the peak", "-", lambda x: f"{x:.0f}"),
    Measure("cracks_at_end", "cracks at the last common loading", "-",
            lambda x: f"{x:.0f}"),
    Measure("grains", "grains", "-", lambda x: f"{x:.0f}", False),
    Measure("dofs", "degrees of freedom of the mesh", "-", lambda x: f"{x:.0f}", False),
    Measure("wall_seconds", "seconds of the clock", "s", in_units(1., "s"), False),
    Measure("cpu_seconds", "seconds of processors", "s", in_units(1., "s"), False),
    Measure("peak_memory", "memory", "B", in_units(1e-6, "MB"), False),
)


def measures(run, last_loading):
    """{measure: value or None} of a run, cracks also at @p last_loading, that of the run
    that went least far."""
    history, summary = run.history, run.summary
    values = {measure.name: None for measure in MEASURES}
    x = run.loading().values
    if "axial_stress_Pa" in history:
        stress = run.response().values
        top = int(np.argmax(stress))
        first = np.flatnonzero(stress[:top + 1] <= BELOW * stress[top])
        if run.bends():
            values["peak_moment"] = float(stress[top])
            values["rotation_at_peak"] = float(x[top])
        else:
            if len(first) > 1 and np.ptp(x[first]) > 0.:
                values["stiffness"] = float(np.polyfit(x[first], stress[first], 1)[0])
            values["peak_stress"] = float(stress[top])
            values["strain_at_peak"] = float(x[top])
        if "fold_amplitude_m" in history:
            there = int(np.argmax(stress >= SHARE * stress[top]))
            amplitude = history["fold_amplitude_m"]
            values["fold_amplitude"] = float(amplitude[there])
            values["amplification"] = float(amplitude[there] - amplitude[0])
        if "cracks_tensile" in history:
            cracks = history["cracks_tensile"] + history["cracks_shear"]
            values["cracks_at_peak"] = float(cracks[top])
            values["cracks_at_end"] = float(cracks[x <= last_loading * (1. + 1e-9)][-1])
    for name in ("grains", "dofs"):
        values[name] = float(summary["sizes"].get(name, 0)) or None
    values["wall_seconds"] = summary["wall_seconds"]
    values["cpu_seconds"] = summary["cpu_seconds"]
    values["peak_memory"] = float(summary["peak_memory_bytes"])
    return values


def grain_diameter(run):
    if not run.step_numbers:
        return None
    frame = run.frame(run.step_numbers[0])
    return None if frame.grains is None else 2. * np.mean(frame.grains.field("radius_m"))


def peak_loading(run):
    """Shortening, elongation or wall rotation at the peak."""
    return run.loading().values[np.argmax(run.response().values)]


def zone_distance(a, b, up_to_peaks=False):
    """How far the cracks of @p a along the layer must be moved in the mean to lie as those of
    @p b do (Wasserstein distance of their places before shortening), in grain diameters of
    @p a up to the last common loading, or each up to its peak; None without cracks in
    both."""
    last = min(a.last_loading(), b.last_loading())
    places = []
    for run in (a, b):
        if run.cracks is None or not len(run.cracks["x_m"]):
            return None
        until = peak_loading(run) if up_to_peaks else last
        seen = run.sign() * run.cracks[run.loading_column()] <= until
        if not seen.any():
            return None
        places.append(run.cracks["reference_x_m"][seen])
    diameter = grain_diameter(a)
    if diameter is None:
        return None
    shares = np.linspace(0., 1., 1001)
    quantiles = [np.quantile(place, shares) for place in places]
    return float(np.mean(abs(quantiles[0] - quantiles[1])) / diameter)


def grain_displacement(grains, points, reach):
    """Displacement of the rock at @p points of the undeformed section, a straight line
    through the grains within @p reach (least squares); NaN where there are fewer than five."""
    moved = grains.field("displacement_m")[:, :2]
    places = grains.points - moved
    result = np.full(points.shape, np.nan)
    for k, point in enumerate(points):
        offset = places - point
        near = np.hypot(*offset.T) <= reach
        if np.count_nonzero(near) < 5:
            continue
        matrix = np.column_stack([np.ones(np.count_nonzero(near)), offset[near]])
        result[k] = np.linalg.lstsq(matrix, moved[near], rcond=None)[0][0]
    return result


def mesh_displacement(mesh, points):
    """Likewise of the mesh, by the bilinear functions of the cell around each point; NaN
    outside."""
    corners = mesh.points[mesh.quads()]  # (n, 4, 2)
    moved = mesh.field("displacement", "displacement_m")[mesh.quads()][:, :, :2]
    low, high = corners.min(axis=1), corners.max(axis=1)
    result = np.full(points.shape, np.nan)
    for k, point in enumerate(points):
        margin = 1e-9 * (high - low)
        for cell in np.flatnonzero(np.all((point >= low - margin) & (point <= high + margin),
                                          axis=1)):
            at = local_coordinates(corners[cell], point)
            if np.all(abs(at) <= 1. + 1e-6):
                result[k] = shape_functions(at) @ moved[cell]
                break
    return result


def shape_functions(at):
    xi, eta = at
    return 0.25 * np.array([(1 - xi) * (1 - eta), (1 + xi) * (1 - eta),
                            (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)])


def local_coordinates(corners, point):
    """Of @p point in a quadrilateral with counter-clockwise corners, by Newton's method."""
    at = np.zeros(2)
    for _ in range(20):
        xi, eta = at
        slopes = 0.25 * np.array([[-(1 - eta), 1 - eta, 1 + eta, -(1 + eta)],
                                  [-(1 - xi), -(1 + xi), 1 + xi, 1 - xi]])
        step = np.linalg.solve((slopes @ corners).T, point - shape_functions(at) @ corners)
        at = at + step
        if np.max(abs(step)) < 1e-12:
            break
    return at


def displacement_at(run, points, loading):
    """At @p points and a loading between two field files, linear between them."""
    times = np.abs(np.array(run.times))
    after = int(np.clip(np.searchsorted(times, loading), 1, len(times) - 1))
    share = (loading - times[after - 1]) / (times[after] - times[after - 1])
    values = []
    for index in (after - 1, after):
        frame = run.frame(run.step_numbers[index])
        value = np.full(points.shape, np.nan)
        if frame.grains is not None:
            reach = 3. * np.mean(frame.grains.field("radius_m"))
            value = grain_displacement(frame.grains, points, reach)
        if frame.continuum is not None:
            missing = np.isnan(value[:, 0])
            value[missing] = mesh_displacement(frame.continuum, points[missing])
        values.append(value)
    return (1. - share) * values[0] + share * values[1]


def common_points(run):
    """Points of the competent layer before shortening, of a section of mesh alone of all of
    it."""
    frame = run.frame(run.step_numbers[0])
    if frame.grains is not None:
        region = frame.grains.field("region")
        layer = np.ones(len(frame.grains.points), bool) if region is None else region != 1
        points = frame.grains.points[layer]
    else:
        points = frame.continuum.points[frame.continuum.quads()].mean(axis=1)
    return points[::max(1, len(points) // MOST_POINTS)]


def displacement_difference(a, b):
    """Difference of the displacements of @p b from those of @p a in the layer, RMS over the
    RMS of @p a's own deviation from its mean, at the last fields of @p a up to both peaks;
    None where one has no fields to compare."""
    if len(a.times) < 2 or len(b.times) < 2 or "axial_stress_Pa" not in a.history:
        return None
    peaks = [peak_loading(run) for run in (a, b)]
    times = np.abs(np.array(a.times))
    early = times[times <= min(min(peaks), np.abs(b.times).max())]
    if not len(early) or early[-1] == 0.:
        return None
    points = common_points(a)
    first, other = (displacement_at(run, points, early[-1]) for run in (a, b))
    both = ~np.isnan(first[:, 0]) & ~np.isnan(other[:, 0])
    if np.count_nonzero(both) < 10:
        raise RunError(f"'{a.directory}' and '{b.directory}' have no points of the layer in "
                       "common: are these runs of one scene?")
    own = first[both] - first[both].mean(axis=0)
    return float(np.sqrt(np.sum((other[both] - first[both])**2) / np.sum(own**2)))


class Between:
    """A measure of two runs: how they differ, where no numbers can be subtracted."""

    def __init__(self, name, label, unit, between):
        self.name, self.label, self.unit, self.between = name, label, unit, between


BETWEEN = (
    Between("crack_zone_distance_at_peak", "distance of the crack zones, up to the peaks",
            "grain diameters", lambda a, b: zone_distance(a, b, up_to_peaks=True)),
    Between("crack_zone_distance", "distance of the crack zones, at the end",
            "grain diameters", zone_distance),
    Between("displacement_difference", "difference of the displacement fields, RMS", "-",
            displacement_difference),
)
