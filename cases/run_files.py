"""Read what a run leaves in its directory (docs/output.md): needs numpy only."""

import base64
import csv
import json
import math
import os
import re
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

VTK_TYPES = {"Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4",
             "UInt32": "u4", "Int64": "i8", "UInt64": "u8", "Float32": "f4",
             "Float64": "f8"}
VTK_QUADS = (9, 70)  # plain and Lagrange quadrilateral: the corners come first in both


class RunError(Exception):
    """A file of the run is missing or cannot be used; the text says which and why."""


def _decode(text, header_type, is_compressed):
    """Bytes of an inline base64 array: a length, or a table of zlib blocks, and the data."""
    text = "".join(text.split())
    if not text:
        return b""
    size = np.dtype(header_type).itemsize
    if not is_compressed:
        raw = base64.b64decode(text)
        n_bytes = int(np.frombuffer(raw, header_type, 1)[0])
        if len(raw) < size + n_bytes:
            raise ValueError(f"{len(raw) - size} of {n_bytes} bytes")
        return raw[size:size + n_bytes]

    # The header [blocks, block size, last block size, compressed sizes...] is encoded on
    # its own; its first three numbers fill 4 * size characters exactly.
    n_blocks = int(np.frombuffer(base64.b64decode(text[:4 * size]), header_type, 1)[0])
    n_characters = 4 * math.ceil((3 + n_blocks) * size / 3)
    header = np.frombuffer(base64.b64decode(text[:n_characters]), header_type, 3 + n_blocks)
    raw = base64.b64decode(text[n_characters:])
    blocks, begin = [], 0
    for compressed in header[3:].astype(int):
        blocks.append(zlib.decompress(raw[begin:begin + compressed]))
        begin += compressed
    return b"".join(blocks)


def _read_array(node, header_type, is_compressed):
    kind = "<" + VTK_TYPES[node.get("type")]
    form = node.get("format", "ascii")
    if form == "ascii":
        values = np.array((node.text or "").split(), dtype=kind)
    elif form == "binary":
        values = np.frombuffer(_decode(node.text or "", header_type, is_compressed), kind)
    else:
        raise ValueError(f"format '{form}' is not read here, only inline arrays are")
    n_components = int(node.get("NumberOfComponents", "1"))
    return values.reshape(-1, n_components) if n_components > 1 else values


class Grid:
    """A VTU file: points, cells and their fields. Pieces are joined."""

    def __init__(self, path):
        self.path = path
        try:
            root = ElementTree.parse(path).getroot()
            header_type = "<" + VTK_TYPES[root.get("header_type", "UInt32")]
            is_compressed = root.get("compressor") is not None
            pieces = [{section.tag: {node.get("Name", "Points"): _read_array(
                node, header_type, is_compressed) for node in section.iter("DataArray")}
                for section in piece} for piece in root.iter("Piece")]
            self._join(pieces)
        except OSError as error:
            raise RunError(f"'{path}' cannot be read: {error.strerror}.") from error
        except (ElementTree.ParseError, ValueError, KeyError, IndexError,
                zlib.error) as error:
            raise RunError(f"'{path}' is not a whole VTU file ({error}). "
                           "Run the case again or take another --step.") from error

    def _join(self, pieces):
        points, connectivity, ends, types = [], [], [], []
        n_points = n_corners = 0
        for piece in pieces:
            place, cells = next(iter(piece["Points"].values())), piece["Cells"]
            points.append(place.reshape(-1, 3).astype(float))
            connectivity.append(cells["connectivity"].astype(int) + n_points)
            ends.append(cells["offsets"].astype(int) + n_corners)
            types.append(cells["types"])
            n_points += len(points[-1])
            n_corners += len(connectivity[-1])
        self.points = np.concatenate(points)[:, :2]
        self.connectivity = np.concatenate(connectivity)
        self.ends = np.concatenate(ends)
        self.types = np.concatenate(types)
        self.point_fields = self._join_fields(pieces, "PointData", len(self.points))
        self.cell_fields = self._join_fields(pieces, "CellData", len(self.types))

    @staticmethod
    def _join_fields(pieces, section, n_items):
        names = list(pieces[0].get(section, {}))
        fields = {}
        for name in names:
            values = np.concatenate([piece[section][name] for piece in pieces])
            if values.ndim > 1 and n_items == len(values.ravel()):
                values = values.ravel()
            if len(values) != n_items:
                raise ValueError(f"field '{name}' has {len(values)} of {n_items} values")
            fields[name] = values.astype(float)
        return fields

    def field(self, *names):
        """The first point field of these names, or None."""
        return next((self.point_fields[n] for n in names if n in self.point_fields), None)

    def lines(self):
        """The ends of two-point cells: (n, 2, 2)."""
        return self.points[self.connectivity.reshape(-1, 2)]

    def quads(self):
        """The corners' point numbers of quadrilaterals: (n, 4)."""
        if not np.isin(self.types, VTK_QUADS).all():
            raise RunError(f"'{self.path}' has cells that are no quadrilaterals.")
        begins = np.concatenate([[0], self.ends[:-1]])
        return self.connectivity[begins[:, None] + np.arange(4)]

    def deformed_quads(self):
        """The corners of the cells where they are now: (n, 4, 2)."""
        displacement = self.field("displacement", "displacement_m")
        points = self.points if displacement is None else self.points + displacement[:, :2]
        return points[self.quads()]

    def cell_values(self, name):
        """A field of the cells; of a point field the mean of the corners; or None."""
        if name in self.cell_fields:
            return self.cell_fields[name]
        if name in self.point_fields:
            return self.point_fields[name][self.quads()].mean(axis=1)
        return None


def read_table(path):
    """A CSV file as {column: array}; columns that are no numbers stay text."""
    with open(path, newline="", encoding="utf-8") as lines:
        rows = [row for row in csv.reader(lines) if row]
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        raise RunError(f"'{path}' is not a table: a line differs from the first in length.")
    table = {}
    for i, name in enumerate(rows[0]):
        column = [row[i] for row in rows[1:]]
        try:
            table[name] = np.array(column, dtype=float)
        except ValueError:
            table[name] = np.array(column)
    return table


def read_deck(path):
    """The entries of an effective deck: {"Section/Entry": value}."""
    entries, sections = {}, []
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            line = line.split("#")[0].strip()
            if line.startswith("subsection "):
                sections.append(line[11:].strip())
            elif line == "end":
                sections.pop()
            elif match := re.match(r"set\s+(.+?)\s*=\s*(.*)", line):
                entries["/".join(sections + [match[1]])] = match[2]
    return entries


class Frame:
    """All fields that were written at one time; what a run does not have is None."""

    def __init__(self, number, time, files):
        self.number = number  # as in the files' names
        self.time = time
        grids = {group: Grid(file) for group, file in files.items()}
        self.grains = grids.get("grains")
        self.joints = grids.get("joints")
        self.cracks = grids.get("cracks")
        self.fractures = grids.get("fractures")
        self.continuum = grids.get("continuum")


class Quantity:
    """A column of history.csv, growing as the run is loaded, and how it is drawn."""

    def __init__(self, values, factor, name, unit):
        self.values, self.factor, self.name, self.unit = values, factor, name, unit
        self.drawn = factor * values
        self.label = f"{name} ({unit})"

    def text(self, value):
        """A value of it in words."""
        return f"{self.name} {self.factor * value:.4g}{'°' if self.unit == '°' else ' ' + self.unit}"


class Run:
    """A run's directory. Field files are read when a frame is asked for."""

    def __init__(self, directory):
        self.directory = directory
        if not os.path.isdir(directory):
            raise RunError(f"'{directory}' is not a directory. Give that of a run (-o).")
        self.summary = self._read_summary()
        self.history = self._read_table_if_there("history.csv")
        self.cracks = self._read_table_if_there("cracks.csv")
        self.modes = self._read_table_if_there("modes.csv")  # of a buckling run
        self._files = self._read_index()  # {time: {group: path}}; of modes their number
        self.times = sorted(self._files, key=self._number_of)
        self.step_numbers = [self._number_of(time) for time in self.times]

    def _path(self, name):
        return os.path.join(self.directory, name)

    def _read_summary(self):
        try:
            with open(self._path("summary.json"), encoding="utf-8") as text:
                return json.load(text)
        except FileNotFoundError:
            return {}  # a run in progress has none yet
        except ValueError as error:
            raise RunError(f"'{self._path('summary.json')}' is no JSON: {error}.") from error

    def _read_table_if_there(self, name):
        return read_table(self._path(name)) if os.path.exists(self._path(name)) else None

    def _read_index(self):
        path = self._path("fields.pvd")
        files = {}
        if not os.path.exists(path):
            return files
        try:
            root = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            raise RunError(f"'{path}' is not a whole PVD file ({error}).") from error
        for entry in root.iter("DataSet"):
            files.setdefault(float(entry.get("timestep")), {})[entry.get("group")] = (
                self._path(entry.get("file")))
        return files

    def _number_of(self, time):
        """The number in the names of the files of one time: fields/grains_0012.vtu, 12."""
        name = next(iter(self._files[time].values()))
        digits = re.search(r"_(\d+)\.\w+$", name)
        if not digits:
            raise RunError(f"'{name}' (fields.pvd) has no number in its name.")
        return int(digits.group(1))

    def frame(self, number):
        """All fields of step @p number, as in the names of the files."""
        if number not in self.step_numbers:
            there = ", ".join(str(n) for n in self.step_numbers)
            raise RunError(f"'{self.directory}' has no fields of step {number}, but of "
                           f"{there}.")
        time = self.times[self.step_numbers.index(number)]
        return Frame(number, time, self._files[time])

    def numbers(self, which):
        """Step numbers for --step first, last, peak, all or a number."""
        steps = self.step_numbers
        if not steps:
            raise RunError(f"'{self.directory}' has no fields yet (fields.pvd).")
        named = {"first": steps[:1], "last": steps[-1:], "all": steps}
        if which in named:
            return named[which]
        if which == "peak":
            if not self.history or "axial_stress_Pa" not in self.history:
                raise RunError("--step peak needs history.csv with axial_stress_Pa.")
            # The last fields up to it: just after a peak little of it is left.
            top = int(np.argmax(self.response().values))
            return [[n for n, row in zip(steps, self.history_rows())
                     if row <= top or n == steps[0]][-1]]
        if not which.isdigit():
            raise RunError(f"--step {which}: give first, last, peak, all or a number.")
        return [int(which)]

    def bends(self):
        """Walls that turn load the section."""
        return bool(self.history) and "wall_rotation_deg" in self.history

    def loading_column(self):
        """Of history.csv and cracks.csv, by which the times of fields.pvd go."""
        return "wall_rotation_deg" if self.bends() else "shortening"

    def loading(self):
        """What the walls do, as a Quantity."""
        values = self.history[self.loading_column()]
        if self.bends():
            return Quantity(values, 1., "wall rotation", "°")
        # A specimen that is pulled: what grows is extension.
        return Quantity(self.sign() * values, 100.,
                        "extension" if self.sign() < 0. else "shortening", "%")

    def response(self):
        """What the section answers with, as a Quantity; None without such a column."""
        for column, name, unit in (("wall_moment_Nm", "wall moment", "MN m per metre"),
                                   ("axial_stress_Pa", "axial stress", "MPa"),
                                   ("wall_force_N", "force of the walls", "MN/m")):
            if column in self.history:
                return Quantity(self.sign() * self.history[column], 1e-6, name, unit)
        return None

    def sign(self):
        """1, or -1 of a specimen that is pulled: shortening and stress times it grow."""
        return -1. if self.history["shortening"].min() < 0. else 1.

    def last_loading(self):
        return float(self.loading().values.max())

    def history_rows(self):
        """The line of history.csv of each time: the nearest in loading, not before that of
        the time before, since a section may turn back (snap-back)."""
        x = self.history[self.loading_column()]
        row, rows = 0, []
        for time in self.times:
            distance = abs(x[row:] - time)
            row += int(np.argmax(distance <= distance.min() + 1e-9 * np.ptp(x)))
            rows.append(row)
        return rows

    def response_at(self, number):
        """Stress or moment at the step @p number, in words; None without history lines."""
        if not self.history or not {"axial_stress_Pa", "shortening"} <= set(self.history):
            return None
        if len(self.history["shortening"]) == 0:
            return None
        row = self.history_rows()[self.step_numbers.index(number)]
        response = self.response()
        return response.text(float(self.sign() * response.values[row]))
