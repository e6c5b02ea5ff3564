"""OpenFAST's ElastoDyn input: `DTTorSpr` and `DTTorDmp` of an existing file, and nothing else.

openfast_io can write ElastoDyn files, but rewrites them: comments, columns and the digits of
every other value change. So the two values are put into their lines here, and openfast_io reads
the result.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.reading import require_readable, unreadable
from fe_drivetrain.common.regular_files import content_of
from fe_drivetrain.export.formats.openfast_inputs import openfast_reader

SPRING, DAMPER = "DTTorSpr", "DTTorDmp"

# any byte is one character in it, so that what is not touched stays as it is
_ENCODING = "latin-1"


class Torsion(NamedTuple):
    """Spring [N m/rad] and damper [N m s/rad] of the drivetrain, on the low-speed side."""

    spring: float
    damper: float


def write_torsion(
    source: str | Path,
    target: str | Path,
    torsion: Torsion,
    overwrite: bool = False,
    stated: str = "",
) -> Torsion:
    """Write an ElastoDyn input with another drivetrain spring and damper.

    All bytes but those of the two values and the blanks before them stay as they are. The value of
    `DrTrDOF`, which switches the degree of freedom on, stays too.

    Parameters
    ----------
    source : str or Path
        An ElastoDyn input of any version that has the two values.
    target : str or Path
        Where the new one goes; may be ``source``.
    torsion : Torsion
        The new values.
    overwrite : bool
        Whether an existing ``target`` is replaced.
    stated : str
        What the values are of, in brackets at the end of the spring's line, where ElastoDyn reads
        nothing; in place of what an earlier export stated there.

    Returns
    -------
    Torsion
        What stood in ``source``.

    Raises
    ------
    InputError
        ``source`` is no such file, ``target`` exists, or a value is out of its range.
    """
    target = Path(target)
    _check(torsion)
    if target.exists() and not overwrite:
        raise InputError(f"{target} exists: name another file, or allow to overwrite it")
    content, before = with_torsion(source, torsion, stated)
    with atomic_path(target) as unfinished:
        unfinished.write_bytes(content)
    return before


def with_torsion(source: str | Path, torsion: Torsion, stated: str = "") -> tuple[bytes, Torsion]:
    """The content of an ElastoDyn input with another drivetrain spring and damper.

    Parameters
    ----------
    source, torsion, stated : str or Path, Torsion, str
        The same as for `write_torsion`, and so is what is refused.

    Returns
    -------
    bytes
        The new content.
    Torsion
        What stood in ``source``.
    """
    _check(torsion)
    source = Path(source)
    text = _text(source)
    before = _torsion_of(source, text)
    for key, value in zip((SPRING, DAMPER), torsion, strict=True):
        line = _line(source, text, key)
        # the new value ends where the old one did, where there is room for it
        new = repr(float(value)).rjust(line.end("value") - line.start())
        text = text[: line.start()] + new + text[line.end("value") :]
    if stated:
        text = _with_statement(text, _line(source, text, SPRING), " ".join(stated.split()))
    return text.encode(_ENCODING, "replace"), before


def _check(torsion: Torsion) -> None:
    if not 0 < torsion.spring < np.inf or not 0 <= torsion.damper < np.inf:
        raise InputError(
            f"{SPRING} {torsion.spring:g} must be positive and {DAMPER} {torsion.damper:g} not "
            "negative, and both finite"
        )


def _with_statement(text: str, line: re.Match[str], stated: str) -> str:
    """The text with what the values are of at the end of a line."""
    rest = re.compile(r"[^\r\n]*").match(text, line.end())
    assert rest is not None
    kept = re.sub(r" \[program: .*\]$", "", rest[0])
    return f"{text[: line.end()]}{kept} [{stated}]{text[rest.end() :]}"


def read_torsion(path: str | Path) -> Torsion:
    """The drivetrain spring and damper of an ElastoDyn input.

    Raises
    ------
    InputError
        The file is not there, or does not have them once each.
    """
    return _torsion_of(Path(path), _text(Path(path)))


def read_elastodyn(path: str | Path) -> dict[str, Any]:
    """All values of an ElastoDyn input by name, as openfast_io reads them.

    Raises
    ------
    MissingToolError
        openfast_io is not installed.
    InputError
        openfast_io cannot read the file; each of its versions reads the ElastoDyn of one version
        of OpenFAST.
    """
    require_readable(path, "ElastoDyn input")
    reader = openfast_reader()
    reader.FAST_directory = str(Path(path).parent)
    try:
        reader.read_ElastoDyn(str(path))
    # whatever a line that cannot be read makes openfast_io raise
    except Exception as error:
        raise InputError(
            f"openfast_io cannot read {path} as ElastoDyn input: {type(error).__name__} {error}"
        ) from error
    values = dict(reader.fst_vt["ElastoDyn"])
    values["outlist"] = reader.fst_vt["outlist"]["ElastoDyn"]
    return values


def _text(path: Path) -> str:
    try:
        return content_of(path).decode(_ENCODING)
    except (OSError, ValueError) as error:
        raise unreadable(path, "ElastoDyn input", error) from error


def _line(path: Path, text: str, key: str) -> re.Match[str]:
    """The start of the line of a key: blanks, value."""
    found = list(re.finditer(rf"(?m)^[ \t]*(?P<value>[^\s\"]+)(?=[ \t]+{key}(?:\s|$))", text))
    if len(found) != 1:
        raise InputError(
            f"{path} has {len(found)} lines of {key}: an ElastoDyn input has one, the value first"
        )
    return found[0]


def _torsion_of(path: Path, text: str) -> Torsion:
    values = []
    for key in (SPRING, DAMPER):
        word = _line(path, text, key)["value"]
        try:
            # Fortran may write the exponent with a D
            values.append(float(re.sub("[dD]", "e", word)))
        except ValueError as error:
            raise InputError(f"{path}: {key} is {word!r}, which is no number") from error
    return Torsion(*values)
