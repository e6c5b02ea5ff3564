"""Where components of a REXS model are, in the frame of a drivetrain's file.

Each has the place of its own axes u, v, w in those of another component (spec.rexs.info 1.6,
"Position and orientation in space"). Gravity of the gear unit is along -z here, where it is stated.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.rexs_model import Model, Part

PARALLEL = 1e-6
"""Sine of the angle between axes that are parallel."""
_DEEPEST = 50  # components that one is placed by, each by the next


class Places:
    """Positions along and across the common axis of all shafts, x from the slow to the fast side.

    Parameters
    ----------
    model : Model
        The model.
    main : Part
        The shaft whose axis is x.
    """

    def __init__(self, model: Model, main: Part) -> None:
        self.model = model
        self._poses: dict[str, tuple[Floats, Floats] | None] = {}
        found = self._pose(main)
        axis = np.array([1.0, 0.0, 0.0]) if found is None else found[1][:, 0]
        up = self._up()
        across = up - (up @ axis) * axis
        if np.linalg.norm(across) < PARALLEL:
            across = np.eye(3)[int(np.argmin(np.abs(axis)))]
            across = across - (across @ axis) * axis
        self._axis, self._vertical = axis, across / np.linalg.norm(across)

    def turn_round(self) -> None:
        """Look from the other side: x and y change their signs."""
        self._axis = -self._axis

    def of(self, part: Part) -> Floats:
        """Position (3,) of a component [m].

        Raises
        ------
        InputError
            It has none.
        """
        found = self._pose(part)
        if found is None:
            raise InputError(
                f"{part} has no place: give support_vector, and what it refers to, "
                "reference_component_for_position"
            )
        rows = np.array([self._axis, np.cross(self._vertical, self._axis), self._vertical])
        return np.asarray(rows @ found[0])

    def along(self, part: Part) -> float:
        """Sense of a component's own axis u along x: 1 or -1.

        Raises
        ------
        InputError
            It is not parallel to x.
        """
        found = self._pose(part)
        if found is None:
            return 1.0
        u = found[1][:, 0]
        if float(np.linalg.norm(np.cross(u, self._axis))) > PARALLEL:
            raise InputError(
                f"{part} has an axis that is not parallel to that of the first shaft, but a "
                "drivetrain's file has parallel axes: model the drivetrain by hand"
            )
        return float(np.sign(u @ self._axis))

    def _up(self) -> Floats:
        """Against gravity, in the axes of the gear unit; w where none is stated."""
        for unit in self.model.of_type("gear_unit"):
            keys = [f"direction_vector_gravity_{axis}" for axis in "uvw"]
            if all(unit.has(key) for key in keys):
                down = np.array([unit.number_of(key, "number") for key in keys], dtype=float)
                size = float(np.linalg.norm(down))
                pose = self._pose(unit)
                if size > 0:
                    turned = down if pose is None else pose[1] @ down
                    return np.asarray(-turned / size)
        return np.array([0.0, 0.0, 1.0])

    def _pose(self, part: Part, depth: int = 0) -> tuple[Floats, Floats] | None:
        """Origin (3,) and axes (3, 3), in columns; None of what has no place."""
        if part.number in self._poses:
            return self._poses[part.number]
        if depth > _DEEPEST:
            raise InputError(
                f"{part} is placed by a component that is placed by it, in a circle: correct "
                "reference_component_for_position"
            )
        place = part.vector("support_vector")
        if place is None:
            self._poses[part.number] = None
            return None
        axes = _axes(part)
        origin = np.array(place)
        name = part.word("reference_component_for_position")
        if name is not None and name != part.number:
            other = self.model.parts.get(name)
            if other is None:
                raise InputError(
                    f"{part} is placed by component {name}, which there is not: correct "
                    "reference_component_for_position"
                )
            base = self._pose(other, depth + 1)
            if base is not None:
                origin, axes = base[0] + base[1] @ origin, base[1] @ axes
        self._poses[part.number] = origin, axes
        return origin, axes


def _axes(part: Part) -> Floats:
    """Axes u, v, w of a component in columns (3, 3)."""
    u, w = (part.vector(f"{axis}_axis_vector", "direction") for axis in "uw")
    if u is None or w is None:
        return np.eye(3)
    a, c = np.array(u), np.array(w)
    sizes = float(np.linalg.norm(a)), float(np.linalg.norm(c))
    if min(sizes) == 0 or abs(a @ c) > 1e-3 * sizes[0] * sizes[1]:
        raise InputError(
            f"{part}: u_axis_vector and w_axis_vector must be perpendicular and not zero: correct "
            "them"
        )
    a = a / sizes[0]
    c = c / sizes[1]
    c = c - (a @ c) * a
    c = c / np.linalg.norm(c)
    return np.column_stack([a, np.cross(c, a), c])
