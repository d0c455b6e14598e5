"""Closed forms along an entry of a deck, as 'antiform theory --along' has them."""

import csv
import io
import os
import shutil
import subprocess

import numpy as np


class TheoryError(Exception):
    """The program does not run, or has no closed form for these values."""


def installed_program():
    """antiform where a shell finds it, or else as it was built beside these scripts."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    return shutil.which("antiform") or os.path.join(root, "build", "antiform")


def theory_along(program, deck, entries, overrides=()):
    """{column: values}, NaN where one does not apply: the closed forms of @p deck for
    @p entries, {"Section/Entry": values}, zipped; columns named as in study.csv."""
    along = " & ".join(f"{path} = " + ", ".join(f"{value:.12g}" for value in values)
                       for path, values in entries.items())
    command = [program, "theory", deck, "--along", along]
    for text in overrides:
        command += ["--set", text]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise TheoryError(f"{program} does not run ({error.strerror}); say with --antiform "
                          "where the program is") from error
    if done.returncode != 0:
        raise TheoryError(done.stderr or done.stdout)
    head, *rows = csv.reader(io.StringIO(done.stdout))
    table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    return dict(zip(head, table.T))
