"""Housings by a few dimensions, in forms that differ in how they stand, and the K_R of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.cases.main_bearing.calibration import (
    Calibrated,
    Surface,
    calibrated,
    fitted,
    hypercube,
    nearest,
)
from fe_drivetrain.common import Floats, InputError, Progress, silent
from fe_drivetrain.drivetrain_file import Scene, change_scene
from fe_drivetrain.geometry import MeshSizes, Section, Shaft, unit_solids
from fe_drivetrain.shafts.response import (
    ESTIMATORS,
    build_model,
    mesh_scene,
    tilt_by_plane,
    unit_load_response,
    without_gearbox,
)

#: K_R of the vertical and of the horizontal plane (Stirling 2023, section 3.3.1) [N m/rad].
PUBLISHED = np.array([145e6, 392e6])

#: Shaft before and behind the bearing's centre [m]: twice the seat's radius beyond the ring.
_STUB = 0.35

#: Of the samples: of the order of a wall, one element of the second order through it.
#: Eight elements a turn, which gmsh can still curve, tell round the bolts alone.
COARSE = MeshSizes(shaft=0.3, bearing=0.1, housing=0.1, bearing_edge=0.1, elements_per_turn=8)


class Dimension(NamedTuple):
    """A dimension of the housing that is free, and what a drawing office would accept of it [m]."""

    name: str
    low: float
    high: float
    reason: str


DIMENSIONS = (
    Dimension(
        "width",
        0.106,
        0.30,
        "least width of a bearing of 400 mm bore (dimension series 39 of ISO 15), to nearly "
        "three times that",
    ),
    Dimension("wall", 0.05, 0.16, "25 mm of outer ring and as much iron, to half of the raceway's"),
    Dimension(
        "centre_height", 0.42, 0.90, "the library's, with 20 mm of iron over the foot, to twice it"
    ),
    Dimension("pedestal_width", 0.65, 1.60, "as wide as the raceway, to twice the shell"),
    Dimension("foot_thickness", 0.06, 0.16, "one to three diameters of a bolt M48"),
)
LOW = np.array([d.low for d in DIMENSIONS])
HIGH = np.array([d.high for d in DIMENSIONS])
WIDTH, WALL, CENTRE, PEDESTAL, FOOT = range(len(DIMENSIONS))

#: What the foot is longer than the pedestal and wider than the body [m], as the library's.
_FOOT_BEYOND_PEDESTAL, _FOOT_BEYOND_BODY = 0.43, 0.06
#: Of the bolts, to the ends and the sides of the foot [m], as the library's.
_BOLT_FROM_END, _BOLT_FROM_SIDE = 0.095, 0.08


@dataclass(frozen=True)
class Form:
    """How a housing is made and held.

    Attributes
    ----------
    title : str
        In words.
    bolted : bool
        Held at four washers instead of the whole underside.
    ring : float or None
        Width of the ring on the shaft [m]; None for as wide as the housing.
    steel : bool
        Whether the housing is of the bearing's steel.
    """

    title: str
    bolted: bool = False
    ring: float | None = None
    steel: bool = False

    @property
    def low(self) -> Floats:
        """(d,) least dimensions: no housing is narrower than its ring."""
        low = LOW.copy()
        low[WIDTH] = max(low[WIDTH], self.ring or 0.0)
        return low


#: As in the thesis: bearing and housing are one body, and its whole underside is fixed.
ONE_BODY = Form("underside fixed, ring as wide as the housing")
WIDE_RING = Form("underside fixed, ring of 0.2 m", ring=0.2)
BOLTED = Form("held at four washers, ring of 0.2 m", bolted=True, ring=0.2)
STEEL = Form("underside fixed, ring as wide as the housing, all of steel", steel=True)


@dataclass(frozen=True)
class Unit:
    """A housing that was solved.

    Attributes
    ----------
    K_R : Floats
        (2, 3) by plane (vertical, horizontal) and one of `ESTIMATORS` [N m/rad].
    nodes : int
        Of the mesh.
    """

    K_R: Floats
    nodes: int


def housed(scene: Scene, form: Form, x: Floats) -> Scene:
    """The scene with other housing dimensions (d,) [m]; the foot follows the body.

    Raises
    ------
    InputError
        They make no housing.
    """
    key = "bearing_units.0"
    width, pedestal = float(x[WIDTH]), float(x[PEDESTAL])
    foot = {
        "foot_length": pedestal + _FOOT_BEYOND_PEDESTAL,
        "foot_width": width + _FOOT_BEYOND_BODY,
    }
    changes: dict[str, Any] = {
        f"{key}.bearing.width": width if form.ring is None else form.ring,
        f"{key}.housing.base": "bolted" if form.bolted else "fixed",
        f"{key}.housing.bolt_spacing_y": foot["foot_length"] - 2 * _BOLT_FROM_END,
        f"{key}.housing.bolt_spacing_x": foot["foot_width"] - 2 * _BOLT_FROM_SIDE,
    }
    dimensions = {d.name: float(v) for d, v in zip(DIMENSIONS, x, strict=True)} | foot
    changes |= {f"{key}.housing.{name}": value for name, value in dimensions.items()}
    if form.steel:
        changes[f"{key}.housing.material"] = scene.bearing_units[0].bearing.material
    return change_scene(scene, changes)


def stub(scene: Scene, mesh: MeshSizes) -> Scene:
    """The bearing unit on a short piece of its shaft, without gearbox: what K_R needs."""
    bearing = scene.bearing_units[0].bearing
    seat = scene.seat_diameter(bearing.name)
    shaft = Shaft(
        front=bearing.x - _STUB,
        sections=(Section(length=2 * _STUB, outer_diameter=seat),),
        material=scene.shaft.material,
    )
    return without_gearbox(scene.model_copy(update={"shaft": shaft, "mesh": mesh}))


def solved(scene: Scene, mesh: MeshSizes) -> Unit:
    """K_R of a scene's bearing unit on a stub of its shaft.

    Raises
    ------
    InputError
        Its parts or its mesh are unsound.
    """
    scene = stub(scene, mesh)
    model = build_model(scene, mesh_scene(scene))
    response = unit_load_response(model)
    name = scene.bearing_units[0].bearing.name
    by_plane = tilt_by_plane(model, response, name).values()
    K_R = np.array([[values[e] for e in ESTIMATORS] for values in by_plane])
    return Unit(K_R, len(model.mesh.points))


def solved_coarsely(scene: Scene) -> Unit:
    """`solved` on the mesh of the samples, or a finer one where that folds over."""
    try:
        return solved(scene, COARSE)
    except InputError:
        return solved(scene, COARSE.scaled(0.8))


@dataclass(frozen=True)
class Sampled:
    """Housings of one form over the bounds.

    Attributes
    ----------
    x, K_R : Floats
        (n, d) dimensions [m] and (n, 2, 3) K_R [N m/rad].
    refused : int
        Combinations that are no housing.
    surfaces : tuple[Surface, ...]
        Of both planes, by estimator.
    """

    x: Floats
    K_R: Floats
    refused: int
    surfaces: tuple[Surface, ...]


def sampled(scene: Scene, form: Form, count: int, order: int, report: Progress = silent) -> Sampled:
    """Solve a Latin hypercube of housings on the coarse mesh.

    Parameters
    ----------
    scene : Scene
        Its bearing unit's housing is replaced.
    form : Form
        Of the housings.
    count : int
        Of the samples.
    order : int
        Of the polynomials of the logarithms that are fitted to their K_R.
    report : Progress
        Called with each housing that is begun.

    Returns
    -------
    found : Sampled
        Without those that the program refuses to build.
    """
    kept, K_R = [], []
    points = hypercube(form.low, HIGH, count)
    for k, x in enumerate(points):
        report(f"{form.title}: housing {k + 1} of {count}")
        try:
            unit = solved_coarsely(housed(scene, form, x))
        except InputError:
            continue
        kept.append(x)
        K_R.append(unit.K_R)
    found, values = np.array(kept), np.array(K_R)
    surfaces = tuple(fitted(found, values[:, :, e], order) for e in range(len(ESTIMATORS)))
    return Sampled(found, values, count - len(kept), surfaces)


@dataclass(frozen=True)
class Member:
    """A housing of a family.

    Attributes
    ----------
    form, x : Form, Floats
        What it is: (d,) dimensions [m].
    K_R : Floats
        (2, 3) [N m/rad].
    miss : float
        Largest relative distance of what was calibrated from what was wanted.
    solutions : int
        How many it took.
    """

    form: Form
    x: Floats
    K_R: Floats
    miss: float
    solutions: int

    def over(self, surface: Surface, estimator: int) -> Floats:
        """(2,) the surface over the K_R found here."""
        return np.asarray(surface(self.x) / self.K_R[:, estimator])


@dataclass(frozen=True, eq=False)
class Aim:
    """What is wanted of the housings of a form, and how it is looked for.

    Attributes
    ----------
    scene : Scene
        Its bearing unit's housing is replaced.
    form : Form
        Form of the housings.
    surface : Surface
        Through K_R of samples by the estimator.
    wanted : Floats
        (2,) K_R [N m/rad].
    tolerance : float
        Relative, of both values.
    estimator : int
        Place in `fe_drivetrain.shafts.response.ESTIMATORS`.
    mesh : MeshSizes or None
        Sizes; those of the samples where not given.
    most : int
        Rounds; the best one is the answer.
    """

    scene: Scene
    form: Form
    surface: Surface
    wanted: Floats
    tolerance: float
    estimator: int = 0
    mesh: MeshSizes | None = None
    most: int = 6

    def solved(self, x: Floats) -> Unit:
        """A housing with dimensions (d,) [m], solved.

        Raises
        ------
        InputError
            They make no housing, or its mesh is unsound.
        """
        housing = housed(self.scene, self.form, x)
        return solved_coarsely(housing) if self.mesh is None else solved(housing, self.mesh)

    def nearest(self, start: Floats, free: Sequence[int]) -> Floats:
        """Dimensions (d,) [m] that the surface takes to be nearest to what is wanted."""
        return nearest(self.surface, start, free, self.wanted, self.form.low, HIGH)

    def met_by(self, x: Floats) -> bool:
        """Whether the surface takes a housing to give what is wanted, and it can be built."""
        if np.abs(self.surface(x) / self.wanted - 1.0).max() > 1e-6:
            return False
        try:
            housed(self.scene, self.form, x)
        except InputError:
            return False
        return True


def member(aim: Aim, start: Floats, free: Sequence[int], ratio: Floats | float = 1.0) -> Member:
    """The housing whose K_R by one estimator is what is wanted.

    Parameters
    ----------
    aim : Aim
        What is wanted.
    start, free, ratio : Floats, Sequence[int], Floats or float
        As for `calibrated`.
    """
    known: dict[bytes, Floats] = {}

    def evaluate(x: Floats) -> Floats:
        known[x.tobytes()] = aim.solved(x).K_R
        return np.asarray(known[x.tobytes()][:, aim.estimator])

    found: Calibrated = calibrated(
        evaluate,
        aim.surface,
        start,
        free,
        aim.wanted,
        aim.form.low,
        HIGH,
        aim.tolerance,
        aim.most,
        ratio,
    )
    return Member(aim.form, found.x, known[found.x.tobytes()], found.miss, found.evaluations)


def reach(aim: Aim, start: Floats, swept: int, free: Sequence[int]) -> Floats | None:
    """Least and largest value of one dimension at which two others still give what is wanted.

    Parameters
    ----------
    aim : Aim
        What is wanted.
    start : Floats
        (d,) dimensions [m]; what is neither free nor swept stays there.
    swept : int
        The dimension.
    free : Sequence[int]
        The two others.
    """
    possible = []
    for value in np.linspace(aim.form.low[swept], HIGH[swept], 49):
        x = start.copy()
        x[swept] = value
        if aim.met_by(aim.nearest(x, free)):
            possible.append(value)
    return np.array([possible[0], possible[-1]]) if possible else None


def projected(aim: Aim, count: int, seed: int = 1) -> Floats:
    """Housings (m, d) all over the bounds that the surface takes to give what is wanted.

    Each of a Latin hypercube moves to a solution near it, all dimensions free; those that find none
    within the bounds, or none that can be built, are left out.
    """
    free = range(len(DIMENSIONS))
    found = [aim.nearest(x, free) for x in hypercube(aim.form.low, HIGH, count, seed)]
    return np.array([x for x in found if aim.met_by(x)])


def mass(scene: Scene) -> float:
    """Mass of the housing [kg], outer ring included, exact."""
    unit = scene.bearing_units[0]
    bearing = unit.bearing
    bore = scene.seat_diameter(bearing.name)
    volume = unit_solids(bearing, unit.block, bore)[1].volume
    return float(volume * scene.material_of(f"{bearing.name}.housing").density)


def stress_at_foot(scene: Scene, moment: float = 1e6) -> float:
    """Nominal bending stress [Pa] where the pedestal meets the foot, under a tilting moment [N m].

    sigma = 6 M / (b t^2) of the section b by t, the pedestal's width along y and the housing's
    along x; no notch.
    """
    housing = scene.bearing_units[0].block
    return float(6.0 * moment / (housing.pedestal_width * housing.width**2))


def with_moduli(scene: Scene, factor: float) -> Scene:
    """The scene with Young's modulus of every part times a factor."""
    unit = scene.bearing_units[0]
    parts = {
        "shaft": "shaft",
        unit.bearing.name: "ring",
        f"{unit.bearing.name}.housing": "housing",
    }
    materials = dict(scene.materials)
    for part, name in parts.items():
        material = scene.material_of(part)
        materials[f"scaled_{name}"] = material.model_copy(
            update={"youngs_modulus": factor * material.youngs_modulus}
        )
    return change_scene(
        scene,
        {
            "materials": {name: m.model_dump() for name, m in materials.items()},
            "shaft.material": "scaled_shaft",
            "bearing_units.0.bearing.material": "scaled_ring",
            "bearing_units.0.housing.material": "scaled_housing",
        },
    )
