"""What ``export`` is asked for: formats, parts and files that go together, or one sentence."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import check_writable

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.component import Component
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.studies.export_content import Kind

SHAFT, TURNING = "shaft", "turning"
"""Parts that are taken where none is asked for."""

_ENDINGS = (".inp", ".vtu", ".msh")
_AUTO, _BODY, _SUMMARY, _TORSIONAL = "auto", "body", "summary", "torsional"


@dataclass(frozen=True)
class Export:
    """What to export, and where; the options of the command.

    Attributes
    ----------
    out : Path
        The file; of several formats the beginning of their files' names, or a folder.
    formats : tuple[str, ...]
        Formats of condensed matrices; none for a mesh or a model, by the ending of the file.
    what, at, level : str or None
        Part, points and model level; None for the default.
    modes : int or None
        Number of fixed-interface modes; None for a superelement without modes.
    overwrite : bool
        Whether to replace an existing file.
    generator : str or None
        Whether it turns: "free" or "held", of all that turns; None for the default.
    template : Path or None
        An ElastoDyn file to be copied with other values.
    """

    out: Path
    formats: tuple[str, ...] = ()
    what: str | None = None
    at: str | None = None
    level: str | None = None
    modes: int | None = None
    overwrite: bool = False
    generator: str | None = None
    template: Path | None = None

    def check(self) -> None:
        """Check what does not depend on the scene.

        Raises
        ------
        InputError
            The format or the file's ending is unknown, options contradict each other, or the file
            cannot be created.
        """
        condensing = {
            "--what": self.what,
            "--at": self.at,
            "--level": self.level,
            "--modes": self.modes,
            "--generator": self.generator,
            "--template": self.template,
        }
        if not self.formats:
            given = [option for option, value in condensing.items() if value is not None]
            if given:
                raise InputError(f"{given[0]} needs --format: give one that --list shows")
            if self.out.suffix not in _ENDINGS:
                raise InputError(
                    f"--out {self.out} ends in {self.out.suffix!r}: use {', '.join(_ENDINGS)}, or "
                    "give --format"
                )
        for name in self.formats:
            if name not in _endings():
                known = ", ".join(_endings())
                raise InputError(f"--format {name!r} is unknown: use {known}")
        for name in self.formats:
            self._check_format(name)
        if len(self.formats) > 1:
            self._check_several()
            check_writable(self.out / SHAFT if self.out.is_dir() else self.out)
            return
        if self.out.is_dir() or not self.out.resolve().parent.is_dir():
            raise InputError(
                f"--out {self.out} must be a file in an existing folder: give such a file"
            )
        check_writable(self.out)

    def _check_format(self, name: str) -> None:
        """Refuse a format that is not of what is asked for."""
        from fe_drivetrain.export.files import FORMATS
        from fe_drivetrain.export.turning_files import ELASTODYN, TURNING_FORMATS

        known = ", ".join(TURNING_FORMATS if self.is_turning else FORMATS)
        if name not in (TURNING_FORMATS if self.is_turning else FORMATS):
            of = f"--what {self.what or SHAFT}"
            if self.is_turning and self.what is None:
                others = [other for other in self.formats if other not in FORMATS]
                of = f"all that turns, as {(*others, '--generator')[0]} asks for"
            raise InputError(f"--format {name} cannot hold {of}: use one of {known}")
        if (name == ELASTODYN and self.template is None) or self._template_is_idle:
            raise InputError(
                f"--format {name} does not use --template: leave it out"
                if self.template is not None
                else f"--format {name} changes two values of an ElastoDyn file: add --template FILE"
            )
        if name == ELASTODYN and (self.level not in (None, _TORSIONAL) or self.generator):
            raise InputError(
                f"--format {name} is one spring of level {_TORSIONAL}, and holds neither another "
                "level nor a state of the generator: leave --level and --generator out"
            )

    @property
    def _template_is_idle(self) -> bool:
        from fe_drivetrain.export.turning_files import ELASTODYN

        return self.template is not None and ELASTODYN not in self.formats

    def _check_several(self) -> None:
        """Refuse several formats that are one, or of two levels, or one file for all of them."""
        from fe_drivetrain.export.turning_files import ELASTODYN

        twice = [name for name in self.formats if self.formats.count(name) > 1]
        if twice:
            raise InputError(f"--format {twice[0]} is given twice: give it once")
        if ELASTODYN in self.formats and self.level is None:
            raise InputError(
                f"--format {ELASTODYN} is of level {_TORSIONAL} and the others of the finest: add "
                f"--level {_TORSIONAL}, or write it by itself"
            )
        if self.out.suffix in (*_ENDINGS, *_endings().values()):
            raise InputError(
                f"--out {self.out} is one file, but {len(self.formats)} formats need one each: "
                f"leave {self.out.suffix} out to begin their names, or give an existing folder"
            )
        if not self.out.is_dir() and not self.out.resolve().parent.is_dir():
            raise InputError(
                f"--out {self.out} must begin the names of files in an existing folder, or be "
                "such a folder: give one of these"
            )

    def files(self, found: Drivetrain | Component) -> dict[str, Path]:
        """The files to write by format; "" of a mesh or model.

        Where there are several formats, each file is named by what they share, and its format.

        Parameters
        ----------
        found : Drivetrain or Component
            What is exported.
        """
        from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain

        if len(self.formats) < 2:
            return {"".join(self.formats): self.out}
        part = SHAFT if isinstance(found, Drivetrain) else _BODY
        part = self.what or (TURNING if self.is_turning else part)
        stem = self.out / part if self.out.is_dir() else self.out
        endings = _endings()
        return {name: stem.with_name(f"{stem.name}-{name}{endings[name]}") for name in self.formats}

    @property
    def is_turning(self) -> bool:
        """Whether all that turns is written: asked for, or by a format that holds nothing else."""
        from fe_drivetrain.export.files import FORMATS

        if self.what is not None or not self.formats:
            return self.what == TURNING
        return self.generator is not None or not set(self.formats) <= set(FORMATS)

    @property
    def left_out(self) -> dict[str, str]:
        """Names of formats by what they have no room for."""
        from fe_drivetrain.export.files import FORMATS
        from fe_drivetrain.export.turning_files import TURNING_FORMATS

        known = TURNING_FORMATS if self.is_turning else FORMATS
        found: dict[str, list[str]] = {}
        for name in self.formats:
            found.setdefault(known[name].left_out, []).append(name)
        return {text: ", ".join(names) for text, names in found.items() if text}

    @property
    def points(self) -> list[str] | None:
        """Names of the points to keep; None for the default."""
        if self.at is None:
            return None
        return [name.strip() for name in self.at.split(",") if name.strip()]

    @property
    def level_number(self) -> int | str | None:
        """The level; None for the default; a word of all that turns.

        Raises
        ------
        InputError
            It is no number.
        """
        if self.level in (None, _AUTO):
            return _TORSIONAL if self.template is not None else None
        if self.is_turning:
            return self.level
        if not re.fullmatch("[0-9]+", self.level):
            raise InputError(
                f"--level {self.level!r} must be {_AUTO} or a number: write it as in --level 2"
            )
        return int(self.level)

    @property
    def kind(self) -> Kind:
        """What is written."""
        if self.is_turning:
            return "turning"
        if self.modes is not None:
            return "modes"
        if not self.formats:
            return "model" if self.out.suffix == ".inp" else "mesh"
        return "summary" if self.what == _SUMMARY else "superelement"


def _endings() -> dict[str, str]:
    """The usual ending of each format of matrices, by its name."""
    from fe_drivetrain.export.turning_files import format_rows

    return {row["format"]: row["ending"] for row in format_rows()}
