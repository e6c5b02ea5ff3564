"""All that turns of a drivetrain out to files: one writer for all formats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.files import atomic_paths
from fe_drivetrain.export.files import FORMATS, refuse_existing
from fe_drivetrain.export.formats.elastodyn import with_torsion
from fe_drivetrain.export.turning import Turning


class TurningFormat(NamedTuple):
    """A file format: usual ending, what reads it, its module and function, the extra it needs, and
    what of the matrices it leaves out.
    """

    suffix: str
    reader: str
    module: str
    function: str = "write"
    extra: str = ""
    left_out: str = ""


ELASTODYN = "elastodyn"
"""Name of the format that is a copy of a user's ElastoDyn file."""

_OTHERS = "the other matrices: write each with its own format"

TURNING_FORMATS: dict[str, TurningFormat] = {
    "json": TurningFormat(".json", "anything: docs/turning.schema.json", "turning_json"),
    "csv": TurningFormat(".csv", "spreadsheets, pandas", "turning_matrices", "write_csv"),
    **{
        name: TurningFormat(
            ".mtx",
            f"Matrix Market readers: the {kind}",
            "turning_matrices",
            f"write_{kind}",
            left_out=_OTHERS,
        )
        for name, kind in (
            ("mtx", "stiffness"),
            ("mtx-mass", "mass"),
            ("mtx-damping", "damping"),
            ("mtx-gyroscopic", "gyroscopic"),
        )
    },
    "hdf5": TurningFormat(".h5", "HDF5 readers", "turning_matrices", "write_hdf5", "hdf5"),
    "simpack": TurningFormat(
        ".subvar", "SIMPACK substitution variables", "turning_matrices", "write_simpack"
    ),
    "exudyn": TurningFormat(".py", "Exudyn: a script that builds the model", "turning_exudyn"),
    "ross": TurningFormat(
        ".py",
        "ROSS: a script that builds the rotor",
        "turning_ross",
        left_out="dampers; planets and rings are nodes of their own in front of the sun's shaft, "
        "and the stiffness of a stage is a matrix, since ROSS has no planetary stage, and takes "
        "another axial force of helical teeth",
    ),
    "rexs": TurningFormat(
        ".rexs",
        "REXS 1.6, gearbox programs: shafts, gears, stages, bearings",
        "rexs_gearbox",
        left_out="inertias, dampers, mesh stiffness, splines of shafts, bushings of pins, "
        "couplings between motions of a bearing, how far both directions of a bearing differ, and "
        "of a shaft that is given by its torsional stiffness all but its place",
    ),
    ELASTODYN: TurningFormat(
        ".dat",
        "OpenFAST: DTTorSpr and DTTorDmp in a copy of an ElastoDyn file",
        "elastodyn",
        left_out="inertias between rotor and generator, and all modes but the first torsional one",
    ),
}
"""Formats of all that turns, by name."""


def format_rows() -> list[dict[str, str]]:
    """Formats as records: name, what they hold, usual ending, programs that read them, extra."""
    return [
        {
            "format": name,
            "holds": what,
            "ending": one.suffix,
            "read by": one.reader,
            "needs": f"fe-drivetrain[{one.extra}]" if one.extra else "",
        }
        for what, formats in (("part", FORMATS), ("turning", TURNING_FORMATS))
        for name, one in formats.items()
    ]


def write_turning(
    path: str | Path,
    turning: Turning,
    format: str,
    overwrite: bool = False,
    template: str | Path | None = None,
) -> None:
    """Write all that turns of a drivetrain; the file appears whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file.
    turning : Turning
        What is written.
    format : str
        A name of `TURNING_FORMATS`.
    overwrite : bool
        Whether an existing file is replaced.
    template : str or Path or None
        An ElastoDyn file, of which "elastodyn" writes a copy with two other values.

    Raises
    ------
    InputError
        The format is unknown, the file exists, or the template is left out, or no ElastoDyn file.
    MissingToolError
        What the format needs is not installed.
    """
    write_turning_files({format: Path(path)}, turning, overwrite, template)


def write_turning_files(
    files: Mapping[str, Path],
    turning: Turning,
    overwrite: bool = False,
    template: str | Path | None = None,
) -> None:
    """Write all that turns in several formats; all files appear whole, or none does.

    Parameters
    ----------
    files : Mapping[str, Path]
        A file for each format, by its name in `TURNING_FORMATS`.
    turning, overwrite, template : Turning, bool, str or Path or None
        The same as for `write_turning`, and so is what is refused.
    """
    for format in files:
        require_known("format", format, TURNING_FORMATS)
    refuse_existing(files.values(), overwrite)
    with atomic_paths(list(files.values())) as unfinished:
        for format, path in zip(files, unfinished, strict=True):
            _writer(format, template)(path, turning)


def _writer(format: str, template: str | Path | None) -> Callable[[Path, Turning], object]:
    """The function that writes a format into an unfinished file."""
    if format != ELASTODYN:
        one = TURNING_FORMATS[format]
        module = import_module(f"fe_drivetrain.export.formats.{one.module}")
        return getattr(module, one.function)  # type: ignore[no-any-return]
    if template is None:
        raise InputError("format 'elastodyn' changes two values of a file: give it as template")

    def write(path: Path, turning: Turning) -> None:
        facts = "; ".join(f"{key}: {value}" for key, value in turning.source().items())
        path.write_bytes(with_torsion(template, turning.spring.torsion, facts)[0])

    return write
