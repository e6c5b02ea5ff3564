"""The rows of a machine from a drivetrain's file, and the gate of all that turns.

Every drivetrain passes it as it is made. What its file does not state is not checked: `table_of`
says which key a model of the whole needs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.machine_gate import check_table
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.stage_completion import NotGivenError, completed
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, ShaftData, ShaftRow
from fe_drivetrain.drivetrain_file.whirl_data import check_whirl

#: Rated power over torque times speed of the generator: losses of either side, as shares.
LEAST_POWER, MOST_POWER = 0.75, 1.15
#: Length of a shaft that is not given [m]: of bodies that only turn it does not matter.
NOMINAL_LENGTH = 1.0


def table_of(
    drivetrain: Drivetrain, main: ShaftRow, bearings: Sequence[BearingData] = ()
) -> tuple[MachineTable, Mapping[str, str]]:
    """Rows of a drivetrain from the rotor to the generator, and what was derived.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    main : ShaftRow
        Its main shaft.
    bearings : sequence of BearingData
        Bearings of the main shaft; those of the gearbox come after them.

    Returns
    -------
    table : MachineTable
        The rows.
    derived : mapping of str to str
        What was derived and how, by its name, as in "stage 1: centre_distance".

    Raises
    ------
    NotGivenError
        The file lacks a value; the message names its key.
    InputError
        What is given contradicts itself.
    """
    if drivetrain.rotor is None:
        raise NotGivenError(_lacks(drivetrain, "rotor", "{mass: ..., inertia: ...}"))
    if drivetrain.generator is None:
        raise NotGivenError(_lacks(drivetrain, "generator", "{inertia: ...}"))
    derived: dict[str, str] = {}
    lost = [] if drivetrain.rotor.mass is not None else ["rotor: mass"]
    stages = []
    for number, stage in enumerate(drivetrain.gearbox.stages, start=1):
        found = completed(stage, f"stage {number}")
        stages.append(found.stage)
        derived |= {f"stage {number}: {key}": how for key, how in found.derived.items()}
        lost += [f"stage {number}: {key}" for key in found.not_given]
    shafts = []
    for row in (main, *drivetrain.gearbox.shafts):
        if row.own_length is None:
            lost.append(f"shaft {row.name!r}: length")
        given = {key: getattr(row, key) for key in row.model_fields_set}
        shafts.append(ShaftData(**{**given, "length": row.own_length or NOMINAL_LENGTH}))
    table = MachineTable(
        title=drivetrain.title,
        sources=drivetrain.sources,
        assumed=drivetrain.assumed,
        rotor=drivetrain.rotor,
        shafts=tuple(shafts),
        stages=tuple(stages),
        generator=drivetrain.generator,
        bearings=(*bearings, *drivetrain.gearbox.bearings),
        not_given=tuple(lost),
    )
    return table, derived


def check_turning(
    drivetrain: Drivetrain, main: ShaftRow, bearings: Sequence[BearingData] = ()
) -> None:
    """Refuse a drivetrain of which something that turns does not fit; see `check_table`.

    Raises
    ------
    InputError
        See above, or a brake or a seal is on no shaft, or shafts are without stages, or the rated
        torque of the generator contradicts rated power and speed.
    """
    gears = drivetrain.gearbox
    if len(gears.shafts) != len(gears.stages):
        raise InputError(
            f"gearbox has {len(gears.stages)} stages and {len(gears.shafts)} shafts behind the "
            "main shaft but must have one behind each stage, the last to the generator: add or "
            "remove some"
        )
    names = [main.name, *(shaft.name for shaft in gears.shafts)]
    if drivetrain.brake is not None and drivetrain.brake.shaft not in names:
        raise InputError(
            f"brake is on shaft {drivetrain.brake.shaft!r}, which is none: use one of "
            f"{', '.join(names)}"
        )
    _check_limit_names(drivetrain, names)
    for seal in gears.seals:
        if seal.shaft not in names:
            raise InputError(
                f"seal {seal.name!r} rubs on shaft {seal.shaft!r}, which is none: use one of "
                f"{', '.join(names)}"
            )
    if not gears.stages and drivetrain.generator is None:
        return
    try:
        table, _ = table_of(drivetrain, main, bearings)
    except NotGivenError:
        return
    check_table(table)
    check_whirl(drivetrain.whirl, table)
    _check_torque(drivetrain, abs(table.speeds[-1]))
    _check_limits(drivetrain, table)


def _check_torque(drivetrain: Drivetrain, ratio: float) -> None:
    """Refuse a generator's rated torque that power and speed of the operation contradict."""
    generator, operation = drivetrain.generator, drivetrain.operation
    torque = None if generator is None else generator.rated_torque
    of_power = None if operation is None else operation.rated_torque
    if torque is None or of_power is None:
        return
    if not LEAST_POWER <= of_power / (torque * ratio) <= MOST_POWER:
        raise InputError(
            f"generator.rated_torque is {torque:g} N m, {torque * ratio:.4g} N m at the rotor by "
            f"the ratio {ratio:.4g} of all stages, but operation has {of_power:.4g} N m, its "
            "rated_power over the rated rotor_speed: correct one of them"
        )


def _check_limit_names(drivetrain: Drivetrain, names: Sequence[str]) -> None:
    """Refuse limits of shafts that there are not."""
    for name in {} if drivetrain.limits is None else drivetrain.limits.peak_torque:
        if name not in names:
            raise InputError(
                f"limits: peak_torque is of shaft {name!r}, which is none: use one of "
                f"{', '.join(names)}"
            )


def _check_limits(drivetrain: Drivetrain, table: MachineTable) -> None:
    """Refuse limits that the rated torque is beyond."""
    generator, rated = drivetrain.generator, None
    if drivetrain.operation is not None:
        rated = drivetrain.operation.rated_torque
    if generator is not None and generator.rated_torque is not None:
        rated = generator.rated_torque * abs(table.speeds[-1])
    if drivetrain.limits is None or rated is None:
        return
    for shaft, speed in zip(table.shafts, table.speeds, strict=True):
        limit, torque = drivetrain.peak_torque(shaft.name), rated / abs(speed)
        if limit is not None and limit < torque:
            raise InputError(
                f"limits: peak_torque of shaft {shaft.name!r} is {limit:g} N m but must be at "
                f"least its rated torque, {torque:.6g} N m: raise it, or correct the rated torque"
            )


def _lacks(drivetrain: Drivetrain, key: str, example: str) -> str:
    return (
        f"{drivetrain.title!r} does not state its {key}, which a model of all that turns needs: "
        f"add {key}: {example}"
    )
