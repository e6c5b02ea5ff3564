"""HDF5: matrices and positions as datasets, the statement as attributes of the file."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.export.formats.statement import dof_labels, element_of, statement
from fe_drivetrain.export.superelement import Superelement


def write(path: Path, element: Superelement) -> None:
    """Write a superelement; numbers keep every bit.

    Raises
    ------
    MissingToolError
        h5py is not installed.
    """
    # an unfinished file is locked already, by `files.atomic_path`
    with h5py_module().File(path, "w", locking=False) as file:
        file.attrs.update(statement(element))
        file["positions"] = element.positions
        file["positions"].attrs["units"] = "m"
        file["points"] = list(element.points)
        file["degrees_of_freedom"] = dof_labels(element)
        for kind, matrix in (("stiffness", element.stiffness), ("mass", element.mass)):
            if matrix is not None:
                file[kind] = matrix
                file[kind].attrs["units"] = _UNITS[kind]


def read(path: Path) -> Superelement:
    """Read a superelement.

    Raises
    ------
    InputError
        The file is no HDF5, or not a superelement's.
    MissingToolError
        h5py is not installed.
    """
    h5py = h5py_module()
    try:
        with h5py.File(path, "r") as file:
            entries = {key: str(value) for key, value in file.attrs.items()}
            matrices = {
                key: np.asarray(file[key], dtype=float)
                for key in ("stiffness", "mass")
                if key in file
            }
    except (OSError, RuntimeError, ValueError, TypeError, KeyError) as error:
        raise InputError(f"{path} is no HDF5 file: {error}") from error
    if "stiffness" not in matrices:
        raise InputError(f"{path} has no dataset 'stiffness': it is no superelement's")
    return element_of(path, entries, matrices["stiffness"], matrices.get("mass"))


_UNITS = {"stiffness": "N/m, N, N m/rad", "mass": "kg, kg m, kg m^2"}


def h5py_module() -> ModuleType:
    try:
        return import_module("h5py")
    except ImportError as error:
        raise MissingToolError(
            'HDF5 needs h5py: install it with pip install "fe-drivetrain[hdf5]"'
        ) from error
