"""Theta = (H/h) (E0'/E')^(1/3) as further axes above one of H/h."""

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

NAME = r"$\Theta=(H/h)\,(E_0'/E')^{1/3}$"


def add_theta_axes(axes, ratios, size=8.5):
    """Above @p axes an axis for each of @p ratios, (Theta over H/h, colour): these grow
    with the contrast, so where Theta is 0.3 (shallow up to there) or 2 (deep from there)
    differs."""
    above = []
    for k, (ratio, colour) in enumerate(ratios):
        top = axes.secondary_xaxis("top", functions=(lambda H, r=ratio: H * r,
                                                     lambda theta, r=ratio: theta / r))
        top.spines["top"].set_position(("outward", k * (size + 7.)))
        for spine in top.spines.values():
            spine.set_color(colour)
        if axes.get_xscale() == "log":
            top.xaxis.set_major_locator(LogLocator(subs=(1.,), numticks=20))
            top.xaxis.set_minor_formatter(NullFormatter())
        top.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
        top.tick_params(axis="x", which="both", colors=colour, labelsize=size, pad=1.,
                        length=2.5)
        above.append(top)
    if above:
        above[-1].set_xlabel(NAME, fontsize=size, labelpad=3.)
    return above


def distinct(ratios):
    """Those of @p ratios, (value, colour), that are there and differ, the first of each."""
    found = []
    for value, colour in ratios:
        if value is not None and not any(np.isclose(value, v) for v, _ in found):
            found.append((value, colour))
    return found
