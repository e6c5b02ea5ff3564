"""A scene solved at a cheap level again and again: only what a change affects is solved again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeVar

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.jobs import Pool, pool
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import cores
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness, unit_stiffnesses
from fe_drivetrain.shafts.fidelity.ladder import shaft_level
from fe_drivetrain.shafts.fidelity.quantities import Solved
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft, ringed_shaft

UnitStiffness = Callable[[Scene], Floats]
"""(6, 6) stiffness of one bearing unit of a scene."""


def unit_content(scene: Scene, name: str) -> str:
    """All that the stiffness of a bearing unit depends on; its position is not included."""
    unit = scene.bearing_unit(name)
    bearing = unit.bearing
    return repr(
        (
            unit.model_copy(update={"bearing": bearing.model_copy(update={"x": 0.0})}),
            scene.seat_diameter(name),
            scene.material_of(name),
            [scene.material_of(part) for part in unit.housing_parts],
            scene.mesh,
        )
    )


def shaft_content(scene: Scene) -> str:
    """All that a condensed shaft depends on, but for its modulus, which it is proportional to."""
    rings = ringed_shaft(scene)[1]
    material = scene.material_of("shaft").model_copy(update={"youngs_modulus": 1.0})
    bearings = [
        (u.bearing if u.bearing.name in rings else u.bearing.span, u.bearing.name in rings)
        for u in scene.bearing_units
    ]
    return repr((scene.shaft, bearings, scene.seats, material))


@dataclass
class Resolver:
    """Solves a scene at level 1 or 2, housings as springs.

    Attributes
    ----------
    level : int
        1 beam, 2 meridian.
    units : Mapping[str, UnitStiffness]
        What gives the stiffness of a bearing unit, by its name; solved where not given.
    coupling : Coupling
        Coupling of the units' faces, where solved.
    springs, bodies : dict[str, Floats], dict[str, tuple[float, Condensed]]
        What was solved before, by what it depends on; a body with the modulus that it had.
    coming : dict[str, Future]
        Both bounds of bearing units that are being solved, see `solve_ahead`.
    """

    level: int
    units: Mapping[str, UnitStiffness] = field(default_factory=dict)
    coupling: Coupling = "rigid"
    springs: dict[str, Floats] = field(default_factory=dict, repr=False)
    bodies: dict[str, tuple[float, Condensed]] = field(default_factory=dict, repr=False)
    coming: dict[str, Future[dict[Coupling, Floats]]] = field(default_factory=dict, repr=False)

    def __call__(self, scene: Scene) -> Solved:
        """The scene at that level.

        Raises
        ------
        InputError
            See `ladder.shaft_level` and `bearing_units.unit_stiffness`.
        """
        names = [unit.bearing.name for unit in scene.bearing_units]
        springs = {name: self.spring(scene, name) for name in names}
        body = self._body(scene)
        return Solved(body, springs, shaft_level(scene, self.level, springs, body))

    def spring(self, scene: Scene, name: str) -> Floats:
        """(6, 6) stiffness of a bearing unit."""
        known = self.units.get(name)
        if known is not None:
            return known(scene)
        return self._kept_spring(scene, name)

    def solve_ahead(self, scenes: Sequence[Scene], name: str, workers: Pool) -> None:
        """Begin to solve a bearing unit in each of several scenes, beside everything else.

        Both bounds are solved on each mesh. What asks for one waits for it.

        Parameters
        ----------
        scenes : sequence of Scene
            Which.
        name : str
            Name of the bearing.
        workers : Pool
            Solves them, and stays until they are asked for.
        """
        for scene in scenes:
            content = unit_content(scene, name)
            if content not in self.coming and f"{self.coupling} {content}" not in self.springs:
                self.coming[content] = workers.start(_unit_bounds, scene, name)

    def solve_springs(
        self, scenes: Sequence[Scene], name: str, report: Callable[[int], object]
    ) -> list[Floats]:
        """(6, 6) stiffness of a bearing unit in each of several scenes.

        Parameters
        ----------
        scenes : sequence of Scene
            Which.
        name : str
            Name of the bearing.
        report : callable
            Called with the number of a scene before its stiffness is there, the first being 1.
        """
        found = []
        # side by side, since most of the time goes into meshes, which take one core each
        with pool(min(cores(), len(scenes))) as workers:
            self.solve_ahead(scenes, name, workers)
            for number, scene in enumerate(scenes, 1):
                report(number)
                found.append(self._kept_spring(scene, name))
        return found

    def _kept_spring(self, scene: Scene, name: str) -> Floats:
        content = unit_content(scene, name)
        if (job := self.coming.pop(content, None)) is not None:
            for coupling, stiffness in job.result().items():
                self.springs[f"{coupling} {content}"] = stiffness
        solve = partial(unit_stiffness, scene, name, coupling=self.coupling)
        return _kept(self.springs, f"{self.coupling} {content}", solve)

    def _body(self, scene: Scene) -> Condensed:
        modulus = scene.material_of("shaft").youngs_modulus
        first, body = _kept(
            self.bodies,
            shaft_content(scene),
            lambda: (modulus, condensed_shaft(scene, self.level)),
        )
        return replace(body, stiffness=body.stiffness * (modulus / first))


def _unit_bounds(_report: Progress, scene: Scene, name: str) -> dict[Coupling, Floats]:
    return unit_stiffnesses(scene, name)


_T = TypeVar("_T")


def _kept(memory: dict[str, _T], content: str, solve: Callable[[], _T]) -> _T:
    if content not in memory:
        memory[content] = solve()
    return memory[content]
