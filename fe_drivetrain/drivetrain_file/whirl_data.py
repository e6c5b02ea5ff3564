"""What whirl of shafts needs beside the machine: unbalance, damping, bearings over the speed."""

from __future__ import annotations

from itertools import pairwise
from typing import Self

from pydantic import Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import LONGEST, MAX_DAMPING, Six
from fe_drivetrain.geometry.part import Part, dimension, rows_of

#: Largest speed of a shaft [rad/s].
MAX_SPEED = 1e4


class UnbalanceData(Part):
    """An unbalance of a shaft at a place."""

    shaft: str = Field(description="name of the shaft")
    at: float = dimension(
        0.0,
        of="x from where the shaft begins, at its nearest node",
        ge=0,
        le=LONGEST,
        source="assumed: where the shaft begins",
    )
    moment: float = dimension(
        of="mass times its distance from the axis (1 kg m is 1e6 g mm)", unit="kg m", gt=0, le=1e4
    )
    angle: float = dimension(
        0.0,
        of="angle about the shaft",
        unit="deg",
        ge=-360,
        le=360,
        source="assumed: all in one plane",
    )


class AtSpeed(Part):
    """Stiffness of a bearing at a speed of its shaft."""

    speed: float = dimension(of="speed of the shaft", unit="rad/s", ge=0, le=MAX_SPEED)
    stiffness: Six = Field(description="along x, y, z and about them, N/m, N m/rad")


class WhirlBearing(Part):
    """What a bearing has beside the stiffness of its row."""

    name: str = Field(description="name of the bearing")
    damping: tuple[float, float, float, float, float, float] = Field(
        default=(0.0,) * 6,
        description="viscous damping along x, y, z and about them, N s/m, N m s/rad",
        json_schema_extra={"unit": "N s/m", "source": "assumed: without damping"},
    )
    over_speed: tuple[AtSpeed, ...] = Field(
        default=(),
        description="stiffness at speeds of the shaft, ascending, in place of that of its row",
    )

    _rows = field_validator("over_speed", mode="before")(rows_of("speed", AtSpeed))

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        for value in self.damping:
            if not 0.0 <= value <= MAX_DAMPING:
                raise InputError(
                    f"bearing {self.name!r}: damping {value:g} N s/m must be from 0 to "
                    f"{MAX_DAMPING:g} N s/m: change it"
                )
        for one, two in pairwise(self.over_speed):
            if not one.speed < two.speed:
                raise InputError(
                    f"bearing {self.name!r}: over_speed has {one.speed:g} rad/s before "
                    f"{two.speed:g} rad/s but speeds must ascend: sort its rows"
                )
        return self


class WhirlData(Part):
    """What whirl of the shafts needs beside the machine."""

    balance_grade: float = dimension(
        6.3,
        of="balance quality grade G of ISO 21940-11 of shafts without an unbalance of their own",
        unit="mm/s",
        gt=0,
        le=4000,
        source="assumed: G 6.3 of ISO 21940-11, machinery in general",
    )
    unbalance: tuple[UnbalanceData, ...] = Field(
        default=(), description="unbalance of shafts, in place of the balance grade"
    )
    viscous: float = dimension(
        0.0,
        of="damping that turns with the shafts, over their stiffness",
        unit="s",
        ge=0,
        le=1.0,
        source="assumed: without damping of the shafts' material",
    )
    loss_factor: float = dimension(
        0.0,
        of="loss factor of the shafts' material, the same at all frequencies",
        unit="-",
        ge=0,
        le=1.0,
        source="assumed: without damping of the shafts' material",
    )
    bearings: tuple[WhirlBearing, ...] = Field(
        default=(), description="damping of bearings, and their stiffness over the speed"
    )

    _unbalance = field_validator("unbalance", mode="before")(rows_of("unbalance", UnbalanceData))
    _bearings = field_validator("bearings", mode="before")(rows_of("bearing", WhirlBearing))

    def of_bearing(self, name: str) -> WhirlBearing | None:
        """What is stated of a bearing; None where nothing is."""
        return next((row for row in self.bearings if row.name == name), None)


def check_whirl(whirl: WhirlData | None, table: MachineTable) -> None:
    """Refuse what is stated of shafts and bearings that there are not.

    Parameters
    ----------
    whirl : WhirlData or None
        What is stated.
    table : MachineTable
        Rows of the machine.

    Raises
    ------
    InputError
        See above; or a bearing is named twice, or an unbalance is beyond the end of its shaft.
    """
    if whirl is None:
        return
    lengths = {shaft.name: shaft.length for shaft in table.shafts}
    known = [bearing.name for bearing in table.bearings]
    names = [row.name for row in whirl.bearings]
    for name in names:
        if name not in known:
            raise InputError(
                f"whirl: bearing {name!r} is none: use one of {', '.join(known) or 'none'}"
            )
        if names.count(name) > 1:
            raise InputError(f"whirl: bearing {name!r} has two rows: make them one")
    for row in whirl.unbalance:
        if row.shaft not in lengths:
            raise InputError(
                f"whirl: unbalance is of shaft {row.shaft!r}, which is none: use one of "
                f"{', '.join(lengths)}"
            )
        if row.at > lengths[row.shaft]:
            raise InputError(
                f"whirl: unbalance of shaft {row.shaft!r} is at {row.at:g} m but the shaft is "
                f"{lengths[row.shaft]:g} m long: lower at"
            )
