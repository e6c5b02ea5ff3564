"""Loads and motions of a bearing over load cases, and beams on springs of several forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing_life.coupled import factors_of
from fe_drivetrain.cases.main_bearing import (
    bands,
    bearing_scenes,
)
from fe_drivetrain.common import FORCES, Floats, InputError, stiffness_transport
from fe_drivetrain.drivetrain_file import Scene, change_scene
from fe_drivetrain.report.suite import Run
from fe_drivetrain.shafts.beam import beam_of_scene, shaft
from fe_drivetrain.shafts.response import (
    bearing_unit_stiffness,
    entering,
    secant_stiffness,
    without_gearbox,
)
from fe_drivetrain.studies.tilt_secants import loads_and_motions
from fe_drivetrain.turbine_loads.hub_loads import (
    SHEARS,
    WIND_SPEEDS,
    Condition,
    LoadHistory,
    PointLoads,
    hub_load_set,
)

QUANTITIES = ("Fx", "Fy", "Fz", "My", "Mz")

SINGLE = "single springs (diagonal of the compliance)"
SECANT = "single springs, K_R the secant"
LEAN = "single springs at the elastic centre (thrust with tilt)"
FULL = "full 6x6"

OF_FORM = "My of the form"


@dataclass(frozen=True)
class Reacted:
    """A bonded bearing over load cases.

    Attributes
    ----------
    scene : Scene
        As it was solved.
    loads, motions : Floats
        (m, 6) what the drivetrain puts on the housing's base, about the bearing's centre [N, N m],
        and the mean motion of the seat [m, rad].
    stiffness : Floats
        (6, 6) condensed, from unit loads without a gearbox.
    fit : secant_stiffness.Spring
        The spring that the load cases show.
    """

    scene: Scene
    loads: Floats
    motions: Floats
    stiffness: Floats
    fit: secant_stiffness.Spring

    def secant(self, component: int) -> secant_stiffness.Secant:
        """Secant stiffness over the load cases, about one axis."""
        return secant_stiffness.secant(self.loads, self.motions, component)


@dataclass(frozen=True)
class Cases:
    """Load cases.

    Attributes
    ----------
    hub : PointLoads
        (m, 6) at the hub, then six columns more for each load point, with its weight [N, N m].
    statement : str
        What they are.
    """

    hub: PointLoads
    statement: str


def hub_loads(run: Run, every: int, scene: Scene) -> Cases:
    """Load cases at the hub: every n-th sample of made histories."""
    speeds = WIND_SPEEDS[1:2] if run.quick else WIND_SPEEDS
    conditions = [Condition(speed, "medium", shear, 1) for speed in speeds for shear in SHEARS]
    with run.step("hub loads"):
        history = hub_load_set(conditions)
    chosen = history.loads[:, ::every].reshape(-1, 6)
    samples = LoadHistory("samples", np.arange(float(len(chosen))), chosen, about="front face")
    return Cases(
        entering(scene, samples),
        f"Load cases: {len(chosen):,} samples of {len(conditions)} made ten-minute histories (wind "
        f"of {', '.join(f'{s:g}' for s in speeds)} m/s, medium turbulence, both shear exponents, "
        "one seed), each with the gearbox's weight.",
    )


def tall(scene: Scene, centre_height: float) -> Scene:
    """The scene with the centre of its bearing higher over the base [m]."""
    return change_scene(scene, {"bearing_units.0.housing.centre_height": centre_height})


def reacted(run: Run, scene: Scene, factor: float, hub: PointLoads) -> tuple[Floats, Floats, Scene]:
    """Loads and motions (m, 6) of the bearing of a scene on its gearbox, on a coarser mesh."""
    scene = bands.coarser(scene, factor)
    label = f"{scene.bearing_units[0].interface}, sizes x {factor:g}"
    solved = bearing_scenes.solve(run, scene, label)
    factors = factors_of(hub, scene.gearbox.weight).values
    return *loads_and_motions(solved.response, solved.bearing, factors), scene


def solved(run: Run, scene: Scene, factor: float, cases: Cases) -> Reacted:
    """A bonded bearing over load cases, with its condensed stiffness."""
    on_bearing, motions, coarser = reacted(run, scene, factor, cases.hub)
    free = bearing_scenes.solve(
        run, without_gearbox(coarser), f"without gearbox, sizes x {factor:g}"
    )
    stiffness = bearing_unit_stiffness(free.response, free.bearing)
    fit = secant_stiffness.fitted_spring(on_bearing, motions)
    return Reacted(coarser, on_bearing, motions, stiffness, fit)


def series(run: Run, scene: Scene, factors: tuple[float, float], cases: Cases) -> list[Reacted]:
    """`solved` on two meshes, the finer last; on that alone if the other is too coarse to mesh."""
    coarse, fine = factors
    found = []
    try:
        found.append(solved(run, scene, coarse, cases))
    except InputError as reason:
        run.report(f"no coarser mesh: {reason}")
    return [*found, solved(run, scene, fine, cases)]


def at_centre(unit: Reacted) -> tuple[Floats, Floats]:
    """Loads and motions at the elastic centre."""
    arm = np.array([0.0, 0.0, secant_stiffness.elastic_centre(unit.stiffness)])
    return secant_stiffness.moved(unit.loads, unit.motions, arm)


def vertical_scatter(unit: Reacted) -> float:
    """Scatter of the secant about y, at the shaft's axis."""
    return unit.secant(4).scatter


def scatter_at_centre(unit: Reacted) -> float:
    """Scatter of the secant about y, at the elastic centre."""
    return secant_stiffness.secant(*at_centre(unit), 4).scatter


def predicted_scatter(unit: Reacted) -> float:
    """Scatter of the secant about y from the condensed stiffness, thrusts and rotations alone.

    With My = theta / C_55 + z Fx, z the elastic centre's height.
    """
    theta, thrust = unit.motions[:, 4], unit.loads[:, 0]
    moment = theta / np.linalg.inv(unit.stiffness)[4, 4]
    moment = moment + secant_stiffness.elastic_centre(unit.stiffness) * thrust
    made = np.zeros_like(unit.loads)
    made[:, 4] = moment
    return secant_stiffness.secant(made, unit.motions, 4).scatter


def springs(unit: Reacted) -> dict[str, Floats]:
    """(6, 6) of a beam's support, in several forms."""
    stiffness = unit.stiffness
    single = 1.0 / np.linalg.inv(stiffness).diagonal()
    by_secant = single.copy()
    for a in (4, 5):
        by_secant[a] = unit.secant(a).stiffness
    arm = np.array([0.0, 0.0, secant_stiffness.elastic_centre(stiffness)])
    there = stiffness_transport(stiffness, -arm)
    return {
        SINGLE: np.diag(single),
        SECANT: np.diag(by_secant),
        LEAN: stiffness_transport(np.diag(there.diagonal()), arm),
        FULL: stiffness,
    }


def on_beam(scene: Scene, stiffness: Floats, hub: Floats) -> tuple[Floats, Floats]:
    """Loads and motions (m, 6) of the bearing of a beam on a spring."""
    bearing = scene.bearing_units[0].bearing
    beam = beam_of_scene(scene, {bearing.name: stiffness})
    unit = shaft.unit_load_response(beam, [scene.shaft.front, scene.shaft.rear], at=bearing.x)
    cases = np.zeros((len(hub), 2, 6))
    cases[:, 0] = hub
    cases[:, 1, 2] = -scene.gearbox.weight
    found = unit.solution(cases)
    return found.reaction(bearing.name), found.displacements


def beam_errors(unit: Reacted, hub: Floats) -> dict[str, Mapping[str, float]]:
    """Root mean square error [%] of each reaction by form of the beam's spring.

    `OF_FORM` is that of My against the beam on the full 6x6 instead of the solid.
    """
    beams = {form: on_beam(unit.scene, k, hub)[0] for form, k in springs(unit).items()}
    found: dict[str, Mapping[str, float]] = {}
    for form, beam in beams.items():
        error = _error(beam, unit.loads)
        by = {q: float(error[FORCES.index(q)]) for q in QUANTITIES}
        found[form] = by | {OF_FORM: float(_error(beam, beams[FULL])[4])}
    return found


def _error(found: Floats, reference: Floats) -> Floats:
    """(6,) root mean square over that of the reference [%]."""
    size = np.sqrt((reference**2).mean(axis=0))
    return np.asarray(100.0 * np.sqrt(((found - reference) ** 2).mean(axis=0)) / size)
