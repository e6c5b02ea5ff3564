"""What the temperatures of a scene do, as rows of a table: reactions, motions and seats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.ladder import housing_springs
from fe_drivetrain.shafts.fidelity.thermal_levels import thermal_level
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.thermal import ThermalState, thermal_state

CAPTION = (
    "What temperatures alone do: reactions that they add, motions of the shaft there, and growth "
    "of its seats. Each part has one temperature; the ground, and the gearbox's springs, have "
    "none. A beam has its inner rings as warm as the shaft, whatever they are"
)

_RIGID = "1 beam, rigid housings that rise"
_LEAST = 1.0  # kN: what is less is not spoken of


def thermal_tables(scene: Scene, model: Model | None = None) -> dict[str, list[Record]]:
    """A table of what temperatures do, by the beam, and by the assembly where it is to be solved.

    Parameters
    ----------
    scene : Scene
        The scene.
    model : Model or None
        Its assembly, to be solved; with housings as springs below a beam, too.

    Returns
    -------
    tables : dict
        By caption; none of a scene without temperatures.
    """
    if not scene.temperatures:
        return {}
    found = {_RIGID: thermal_level(scene)}
    if model is not None:
        springs, _ = housing_springs(scene)
        found["1 beam, housings as springs"] = thermal_level(scene, 1, springs)
        found["4 assembly of solids"] = thermal_state(model)
    return {CAPTION: [row for level, state in found.items() for row in _rows(scene, level, state)]}


def thermal_caution(tables: Mapping[str, Sequence[Record]]) -> str | None:
    """The largest force of temperatures along the axis, as a sentence; None without any.

    Parameters
    ----------
    tables : mapping
        Those of `thermal_tables`, among others.
    """
    forces = {
        str(row["at"]): abs(float(row["Fx [kN]"]))
        for row in tables.get(CAPTION, ())
        if row["level"] == _RIGID and row["at"] != "gearbox"
    }
    if not forces:
        return None
    name = max(forces, key=lambda one: forces[one])
    if forces[name] < _LEAST:
        return None
    return (
        f"Temperatures alone push {name} with {formatted(forces[name], 3)} kN along the axis, by "
        "a beam on rigid housings: let one bearing float, or state how each one is held."
    )


def _without_round_off(value: float) -> float:
    """A value of kN or kN m, to a thousandth of a N or N m."""
    return round(float(value), 6)


def _rows(scene: Scene, level: str, state: ThermalState) -> list[Record]:
    rows: list[Record] = []
    for name in (*scene.bearing_names, "gearbox"):
        force = state.reactions[name]
        at = f"{name}.seat" if f"{name}.seat" in state.motions else name
        moved, growth = state.motions[at], state.seats.get(name)
        rows.append(
            {
                "level": level,
                "at": name,
                "Fx [kN]": _without_round_off(1e-3 * force[0]),
                "Fz [kN]": _without_round_off(1e-3 * force[2]),
                "My [kN m]": _without_round_off(1e-3 * force[4]),
                "moves along x [mm]": 1e3 * float(moved[0]),
                "moves along z [mm]": 1e3 * float(moved[2]),
                "radial growth of the seat [µm]": None if growth is None else 1e6 * growth,
            }
        )
    return rows
