"""Exported matrices, read by libraries that know nothing of this project."""

from __future__ import annotations

import csv
import json
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.io import mmread

from fe_drivetrain.common import Floats

if TYPE_CHECKING:
    from collections.abc import Callable


def by_json(path: Path, kind: str) -> Floats:
    """A matrix of a JSON file."""
    return np.array(json.loads(path.read_text())[kind])


def by_csv(path: Path, kind: str) -> Floats:
    """A matrix of a CSV file: rows that begin with its kind and a degree of freedom."""
    with path.open(newline="") as file:
        return np.array([row[2:] for row in csv.reader(file) if row[0] == kind], dtype=float)


def by_scipy(path: Path, kind: str) -> Floats:
    """The matrix of a Matrix Market file."""
    return np.asarray(mmread(path))


def by_h5py(path: Path, kind: str) -> Floats:
    """A matrix of an HDF5 file."""
    with import_module("h5py").File(path) as file:
        return np.asarray(file[kind])


READERS: tuple[tuple[str, str, tuple[str, ...], Callable[[Path, str], Floats]], ...] = (
    ("json", "json of Python", ("stiffness", "mass"), by_json),
    ("csv", "csv of Python", ("stiffness", "mass"), by_csv),
    ("mtx", "scipy.io.mmread", ("stiffness",), by_scipy),
    ("mtx-mass", "scipy.io.mmread", ("mass",), by_scipy),
    ("hdf5", "h5py", ("stiffness", "mass"), by_h5py),
)
"""Format, library, matrices of the file, reader."""
