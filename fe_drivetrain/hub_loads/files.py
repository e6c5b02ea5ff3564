"""Hub loads from a file of any supported format."""

from __future__ import annotations

import os
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.csv_table import read_csv
from fe_drivetrain.hub_loads.histories import LoadHistory, require_variation
from fe_drivetrain.hub_loads.openfast import read_openfast


def read_hub_loads(path: str | os.PathLike[str]) -> LoadHistory:
    """Read a history, its format determined by the suffix: .out or .outb (OpenFAST), or .csv.

    Raises
    ------
    InputError
        If the file is missing, of another kind, or unsound, or if its loads never vary.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in (".out", ".outb", ".csv"):
        raise InputError(
            f"hub loads '{file}': the suffix '{file.suffix}' is not one of .out, .outb (OpenFAST) "
            "and .csv; convert the file or rename it"
        )
    history = read_csv(file) if suffix == ".csv" else read_openfast(file)
    require_variation(f"hub loads '{file}'", history.loads)
    return history
