"""What 'antiform study' has left: its members, and which of its entries is the axis."""

import itertools
import json
import os
import sys

import numpy as np
from theory_lines import TheoryError, theory_along

MOST_SAMPLES = 121  # of a closed form between the first member and the last
SAME = 1e-6  # closed forms of a member and of the line through it agree to that
# What runs call theory_stress and theory_wavelength, by what 'antiform theory' calls it.
LONG_LAYER = [f"theory_critical_{name}" for name in ("scene_smooth", "scene_bonded",
                                                     "on_foundation")]
BY_THEORY = {"theory_stress": [f"{name}_critical_stress_Pa" for name in LONG_LAYER],
             "theory_wavelength": [f"{name}_wavelength_m" for name in LONG_LAYER]}


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def words(name):
    return name.replace("_", " ").replace("/", " ")


def is_logarithmic(values, span=30.):
    return 0. < min(values) and max(values) > span * min(values)


def is_theory(figure):
    return figure["name"].startswith(("theory_", "theory/"))


def kind_of(figure):
    """What can stand in one picture: stresses along the layer, wavelengths, ..."""
    name = figure["name"]
    if "wavelength" in name:
        return "wavelength"
    is_load = name.startswith("theory/loads_across/")
    if figure["unit"] == "Pa" and not is_load and (is_theory(figure) or
                                                   name.endswith(("stress", "strength"))):
        return "stress"
    return words(name).split()[-1]


class Study:
    """study.json, and which of its entries is the axis and which tell curves apart."""

    def __init__(self, directory, program=None):
        path = os.path.join(directory, "study.json")
        if not os.path.exists(path):
            sys.exit(f"study_page.py: there is no '{path}'. Give the directory that "
                     "'antiform study' has written.")
        with open(path) as file:
            self.record = json.load(file)
        self.directory, self.program = directory, program
        self.members = self.record["members"]
        self.paths = {entry["column"]: entry["entry"] for entry in self.record["vary"]}
        texts = {c: list(dict.fromkeys(m["values"][c] for m in self.members))
                 for c in self.paths}
        varied = [c for c in self.paths if len(texts[c]) > 1 and c != "seed"]
        numeric = [c for c in varied if all(number(t) is not None for t in texts[c])]
        self.axis = max(numeric, key=lambda c: len(texts[c])) if numeric else None
        self.apart = [c for c in varied if c != self.axis]
        for column in reversed(list(self.apart)):
            # What is zipped to others, one or several of them, says nothing more.
            others = [self.axis] + [c for c in self.apart if c != column]
            if self.n_different(others) == self.n_different(others + [column]):
                self.apart.remove(column)
        self.values = {c: texts[c] for c in self.apart}
        self.missed = False  # a closed form that is known at the members alone
        self.samples_ = {}

    def n_different(self, columns):
        return len({tuple(m["values"].get(c) for c in columns) for m in self.members})

    def key_of(self, member):
        return tuple(member["values"][c] for c in self.apart)

    def keys(self):
        return list(dict.fromkeys(map(self.key_of, self.members)))

    def points(self, column, key):
        """Of the curve @p key: places and values of its members, ascending."""
        found = [(number(m["values"][self.axis]), m["figures"][column])
                 for m in self.members if self.key_of(m) == key
                 and m["status"] == "completed" and column in m["figures"]]
        return tuple(np.array(values) for values in zip(*sorted(found))) or None

    def places(self):
        """All values of the axis."""
        return np.unique([number(m["values"][self.axis]) for m in self.members])

    def with_gaps(self, at, values):
        """With NaN where the study has members of other curves between two of this one."""
        places = self.places()
        all_values = np.full(len(places), np.nan)
        all_values[np.searchsorted(places, at)] = values
        return places, all_values

    def samples(self, key):
        """Columns of the closed forms along the curve @p key by the program, candidates: as
        the first member's scene with another value of the axis; the same with numbers
        that are zipped to the axis between their neighbours'. Each is found once, when it
        is asked for."""
        found, others = self.samples_.setdefault(key, ([], self.sampled(key)))
        yield from found
        for sample in others:
            found.append(sample)
            yield sample

    def sampled(self, key):
        of = sorted((m for m in self.members if self.key_of(m) == key),
                    key=lambda m: number(m["values"][self.axis]))
        at = np.array([number(m["values"][self.axis]) for m in of])
        deck = os.path.join(self.directory, "members", of[0]["name"] + ".prm")
        if not self.program or len(np.unique(at)) < 2 or not os.path.exists(deck):
            return
        between = np.geomspace if is_logarithmic(at) else np.linspace
        x = np.unique(np.concatenate([at, between(at[0], at[-1], MOST_SAMPLES)]))
        zipped = {}
        for column, path in self.paths.items():
            values = [number(m["values"][column]) for m in of]
            if column not in (self.axis, "seed") and None not in values \
                    and len(set(values)) > 1:
                zipped[path] = np.interp(x, at, values)
        for entries in ({}, zipped) if zipped else ({},):
            try:
                yield x, theory_along(self.program, deck,
                                      {self.paths[self.axis]: x, **entries})
            except TheoryError:
                continue

    def theory(self, figure, key):
        """Of the curve @p key: the closed form @p figure, finely, where the program has
        one that meets all members; else at these. Places, values; None without any."""
        points = self.points(figure["column"], key)
        if points is None:
            return None
        at, values = points
        columns = BY_THEORY.get(figure["name"], [figure["column"]])
        # Those of another curve often serve this one too.
        of_others = [sample for found, _ in self.samples_.values() for sample in found]
        for x, lines in itertools.chain(of_others, self.samples(key)):
            for line in (lines[c] for c in columns if c in lines):
                if np.isin(at, x).all() and np.allclose(np.interp(at, x, line), values,
                                                        rtol=SAME, atol=0.):
                    return x, line
        self.missed = self.missed or len(np.unique(at)) > 1
        at, which = np.unique(at, return_index=True)
        return self.with_gaps(at, values[which])

    def theta_per_axis(self, key):
        """Theta over the axis where that is H/h, else None."""
        if self.paths.get(self.axis) != "Matrix/Burial depth ratio":
            return None
        for x, columns in self.samples(key):
            if "theory_regime_theta" in columns:
                return float(columns["theory_regime_theta"][-1] / x[-1])
        return None
