"""Uncertain values of the bonded main bearing: cheap sensitivities against the assembly's own.

The assembly of solids stands beside a beam on springs. Moduli and springs: from the strain energy
of one solution, and by differences. Dimensions: by differences on a mesh whose nodes move with
them, see `moved_meshes`.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.energy_sensitivities import (
    compliance,
    energy_slopes,
    hub_elasticities,
    moment_elasticities,
    total,
)
from fe_drivetrain.cases.fidelity.moved_meshes import BORE, FRONT, OUTER, PEDESTAL, WALL, moved
from fe_drivetrain.common import FORCES, MOTIONS
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.mesh import Mesh, volume_weights
from fe_drivetrain.geometry import MeshSizes, unit_solids
from fe_drivetrain.pages import bands
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.fidelity import MIN_ORDER, unit_numbers
from fe_drivetrain.shafts.response import (
    LOADS,
    bearing_unit_stiffness,
    build_model,
    mesh_scene,
    unit_load_response,
    without_gearbox,
)
from fe_drivetrain.shafts.uncertainty import (
    Study,
    first_order,
    nominal_value,
    relative_spread,
    spreads_of,
    study,
    with_values,
)
from fe_drivetrain.studies.input_effects import input_effects

SCENE = "main_bearing_bonded_uncertain"
BEARING, LOAD = "main_bearing", "hub.My"
FORGED, RING, IRON = (
    f"materials.{name}.youngs_modulus" for name in ("forged_steel", "bearing_steel", "cast_iron")
)
SPRINGS = ("gearbox.stiffness.1", "gearbox.stiffness.2")

#: Of the assembly: the finer of two meshes, of the two runs in full and quick.
SIZES = {False: 0.1, True: 0.14}
RATIO = 1.35

#: Of their difference: the error of the finer one, to element size zero.
TO_ZERO = 1.0 / (RATIO**MIN_ORDER - 1.0)

#: Relative step of the differences.
STEP = 1e-3

_MINIMUM = 1e-3

#: What is looked at: its name at the cheap level.
HUB = tuple(f"hub.stiffness.{m}" for m in MOTIONS)
MOMENT = f"{BEARING}.My"
Slopes = dict[str, dict[str, float]]
"""By quantity and by value."""


@case(
    "Uncertain values: sensitivities of the cheap level against the assembly's",
    source="Stirling 2023, Table 3.1; spreads: ISO 286-1, ISO 8062-3, JCSS 2001, some assumed",
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """The study at the cheap level, the assembly's sensitivities, and both side by side."""
    scene = change_scene(library_scene(SCENE), run.settings)
    size = SIZES[run.quick]
    scene = _meshed(scene, size)
    page.about(scene)
    load = np.zeros(len(LOADS))
    load[LOADS.index(LOAD)] = 1e6
    samples = 64 if run.quick else 128
    if run.quick:
        known = {key: scene.uncertainty[key] for key in (FORGED, RING, IRON, *SPRINGS)}
        scene = scene.model_copy(update={"uncertainty": known})
    with run.step("cheap level"):
        found = study(scene, [MOMENT], load, level=1, count=samples, report=run.report)
    dimensions = () if run.quick else (OUTER, BORE, FRONT, PEDESTAL)
    with run.step("assembly"):
        top, sums = _top(scene, dimensions, run)
    with run.step("assembly, coarser"):
        coarse, _ = _top(_meshed(scene, size * RATIO), dimensions, run)
    again = (IRON,) if run.quick else (IRON, SPRINGS[1])
    with run.step("assembly, moduli by differences"):
        checked = _differences(scene, mesh_scene(scene), again)
    _check_energy(page, top, checked, sums)
    _check_moves(page, scene)
    _check_deviations(page, found, top, coarse)
    _check_homogeneous(page, found)
    _check_samples(page, found, samples)
    _answer(page, found, top)
    _show_elasticities(page, found, top, coarse)
    if not run.quick:
        with run.step("K_R of the assembly"):
            tilt = _tilt(scene)
        _show_tilt(page, found, tilt)
    page.sections.append(bands(input_effects(found)))
    page.data("cheap", {q: dict(found.slopes[q]) for q in (*HUB, MOMENT)})
    page.data("assembly", top)
    page.data("assembly, coarser", coarse)


HERO = "Elasticities of hub stiffness and of the bearing's moment: beam against solids"


def _answer(page: Page, found: Study, top: Slopes) -> None:
    """Standard deviations by the assembly's sensitivities, and by both bounds of the beam's."""
    hub, keys = "hub.stiffness.uz", top[MOMENT]
    stiff, soft, exact = (
        {q: 100 * _deviation(found, slopes[q], keys) for q in (hub, MOMENT)}
        for slopes in (found.slopes, found.soft_slopes, top)
    )
    low, high = sorted((stiff[MOMENT], soft[MOMENT]))
    held = 0.9 * low <= exact[MOMENT] <= 1.1 * high  # as the checks ask
    names = {MOMENT: "bearing's moment", hub: "hub's stiffness"}
    page.answer(
        "Can a beam model tell how uncertain the moment on a main bearing is?",
        f"By the solid model the bearing's moment has a standard deviation of "
        f"{exact[MOMENT]:.2g}\u00a0%; the beam's two estimates, {low:.2g} and {high:.2g}\u00a0%, "
        f"{'bracket it' if held else 'do not bracket it'}.",
        [
            figure
            for q, name in names.items()
            for figure in (
                page.value(f"standard deviation of the {name}, solid model [%]", exact[q]),
                page.value(
                    f"{name}, beam, seat faces stay plane [%]",
                    stiff[q],
                    beside=exact[q],
                    by="solid model",
                ),
                page.value(
                    f"{name}, beam, seat faces plane on average [%]",
                    soft[q],
                    beside=exact[q],
                    by="solid model",
                ),
            )
        ],
        hero=HERO,
        cautions=[
            "Scatter of the inputs is in part assumed; only inputs of both models are counted.",
            "In a beam model, ring and housing have another share of the flexibility than in a "
            "solid one.",
        ],
    )
    off = {q: 100 * (stiff[q] / exact[q] - 1.0) for q in (hub, MOMENT)}
    page.say(
        f"The moment's two bounds are a factor of {soft[MOMENT] / stiff[MOMENT]:.2g} apart, and "
        f"its band by the first alone has an error of {off[MOMENT]:+.2g} %; that of the stiffness "
        f"has {off[hub]:+.2g} %."
    )


def _meshed(scene: Scene, size: float) -> Scene:
    sizes = MeshSizes(
        shaft=3 * size, bearing=size, housing=size, bearing_edge=size, elements_per_turn=6
    )
    return scene.model_copy(update={"mesh": sizes})


def _top(scene: Scene, dimensions: Sequence[str], run: Run) -> tuple[Slopes, list[float]]:
    """Sensitivities of the assembly, and what the energies of its compliances leave over."""
    mesh = mesh_scene(scene)
    model = build_model(scene, mesh)
    response = unit_load_response(model)
    hub = hub_elasticities(model, response)
    moment = moment_elasticities(model, response, LOAD)
    found: Slopes = {q: {} for q in (*HUB, MOMENT)}
    for key in (FORGED, RING, IRON, *SPRINGS):
        for k, q in enumerate(HUB):
            found[q][key] = float(hub[key][k])
        found[MOMENT][key] = moment[key]
    given = compliance(response)
    left = total(energy_slopes(model, response))[[*range(6), LOADS.index("gearbox.weight")]] + given
    for key in dimensions:
        run.report(f"assembly, {key}")
        one = _differences(scene, mesh, (key,))
        for q, slopes in one.items():
            found[q] |= slopes
    return found, (np.abs(left).max(axis=1) / np.abs(given).max(axis=1)).tolist()


def _differences(scene: Scene, mesh: Mesh, keys: Sequence[str]) -> Slopes:
    """Central differences of the assembly."""
    found: Slopes = {q: {} for q in (*HUB, MOMENT)}
    for key in keys:
        low, high = (np.log(_values(*_changed(scene, mesh, key, s))) for s in (-STEP, STEP))
        slopes = (high - low) / (np.log1p(STEP) - np.log1p(-STEP))
        for q, slope in zip(found, slopes.tolist(), strict=True):
            found[q][key] = slope
    return found


def _changed(scene: Scene, mesh: Mesh, key: str, step: float) -> tuple[Scene, Mesh]:
    value = nominal_value(scene, key) * (1.0 + step)
    if key in (OUTER, BORE, FRONT, PEDESTAL, WALL):
        return moved(scene, mesh, key, value)
    return with_values(scene, {key: value}), mesh


def _values(scene: Scene, mesh: Mesh) -> list[float]:
    """Stiffness of the hub, and the bearing's moment."""
    response = unit_load_response(build_model(scene, mesh))
    moment = response.reactions[BEARING][FORCES.index("My"), LOADS.index(LOAD)]
    return [*(1.0 / response.motions["hub"][:, :6].diagonal()).tolist(), float(moment)]


def _tilt(scene: Scene) -> Slopes:
    """Sensitivities of K_R as the assembly has it, without the gearbox."""
    mesh = mesh_scene(scene)
    found: Slopes = {"tilt": {}, "yaw": {}}
    for key in (FORGED, RING, IRON, OUTER, PEDESTAL):
        ends = []
        for step in (-STEP, STEP):
            changed, points = _changed(scene, mesh, key, step)
            response = unit_load_response(build_model(without_gearbox(changed), points))
            ends.append(unit_numbers(bearing_unit_stiffness(response, BEARING)))
        for name, slopes in found.items():
            change = np.log(ends[1][name] / ends[0][name])
            slopes[key] = float(change / (np.log1p(STEP) - np.log1p(-STEP)))
    return found


def _check_energy(page: Page, top: Slopes, checked: Slopes, sums: list[float]) -> None:
    for q in ("hub.stiffness.uz", MOMENT):
        for key, slope in checked[q].items():
            page.equals(
                f"{q}: elasticity to {key}, energy against differences",
                top[q][key],
                slope,
                within=1e-4,
                why="a step of 1e-3 leaves 1e-6, the solver 1e-8 over the step",
                source="central differences of the assembly",
                relative=False,
                measure="identity",
            )
    page.vanishes(
        "shares of energy, all parts and springs, less the whole",
        max(sums),
        within=1e-8,
        why="an identity of the solution, to what the solver leaves of the energy",
        source="Euler: stiffness is homogeneous of degree 1 in moduli and springs",
    )


def _check_moves(page: Page, scene: Scene) -> None:
    """Volumes of the parts that a move changes, against those of the changed solids."""
    mesh = mesh_scene(scene)
    for key, part in {OUTER: "shaft", BORE: "shaft", PEDESTAL: f"{BEARING}.housing"}.items():
        ends, exact = [], []
        for step in (-STEP, STEP):
            changed, points = _changed(scene, mesh, key, step)
            ends.append(_volume(points, part))
            exact.append(_exact_volume(changed, part))
        page.equals(
            f"volume of {part} with {key}, moved mesh",
            (ends[1] - ends[0]) / (2 * STEP * _exact_volume(scene, part)),
            (exact[1] - exact[0]) / (2 * STEP * _exact_volume(scene, part)),
            within=2e-3,
            why="six curved elements round a cylinder hold its volume to 1e-3 and less",
            source="the solid's closed form",
            measure="identity",
        )


def _volume(mesh: Mesh, part: str) -> float:
    return float(
        volume_weights(mesh.points, mesh.cells[mesh.part_cells(part)], len(mesh.points)).sum()
    )


def _exact_volume(scene: Scene, part: str) -> float:
    if part == "shaft":
        (s,) = scene.shaft.sections
        return float(np.pi / 4 * (s.outer_diameter**2 - s.inner_diameter**2) * s.length)
    unit = scene.bearing_units[0]
    seat = scene.seat_diameter(BEARING)
    return float(unit_solids(unit.bearing, unit.block, seat)[1].volume)


def _check_deviations(page: Page, found: Study, top: Slopes, coarse: Slopes) -> None:
    """Standard deviation of first order, over the values that both levels know."""
    for q in (*HUB, MOMENT):
        both = found.slopes[q], found.soft_slopes[q]
        bounds = sorted(_deviation(found, slopes, top[q]) for slopes in both)
        exact = _deviation(found, top[q], top[q])
        page.at_most(
            f"{q}: standard deviation for the inputs, how far outside of the two bounds of "
            f"level 1, {100 * bounds[0]:.3g} and {100 * bounds[1]:.3g} % [%]",
            100 * max(bounds[0] - exact, exact - bounds[1]),
            10 * exact,
            why="a tenth of the assembly's: the samples themselves know a band to that",
            source=f"sensitivities of the assembly: {100 * exact:.3g} %",
            band=100 * TO_ZERO * abs(exact - _deviation(found, coarse[q], top[q])),
        )


def _deviation(found: Study, slopes: Mapping[str, float], keys: Iterable[str]) -> float:
    """Relative standard deviation for the spreads of some values."""
    spreads = spreads_of(found.scene)
    return float(np.linalg.norm([slopes[key] * relative_spread(spreads[key]) for key in keys]))


def _check_homogeneous(page: Page, found: Study) -> None:
    sums = {
        "hub.stiffness.uz": (FORGED, RING, IRON, *SPRINGS),
        f"{BEARING}.tilt": (RING, IRON),
        f"{BEARING}.yaw": (RING, IRON),
    }
    for q, keys in sums.items():
        page.equals(
            f"{q}: sum of elasticities to moduli and springs, level 1",
            sum(found.slopes[q][key] for key in keys),
            1.0,
            within=1e-3,
            why="the surface of the unit is solved at moduli some percent apart",
            source="Euler: stiffness is homogeneous of degree 1 in moduli and springs",
            measure="identity",
        )


def _check_samples(page: Page, found: Study, count: int) -> None:
    for number in found.numbers:
        if number.name not in ("hub.stiffness.uz", MOMENT, f"{BEARING}.tilt"):
            continue
        samples = found.samples[number.name]
        page.equals(
            f"{number.name}: standard deviation of {count} samples [%]",
            100 * samples.deviation / abs(samples.nominal),
            100 * first_order(found, number),
            within=float(2.0 / np.sqrt(2.0 * (count - 1))),
            why="two standard errors of a deviation from so many independent samples",
            source="first order: root of the sum of squares",
        )


def _show_elasticities(page: Page, found: Study, top: Slopes, coarse: Slopes) -> None:
    """Every elasticity of the cheap level over the assembly's, and both in numbers."""
    rows: list[Record] = [
        {
            "quantity": q,
            "value": key,
            "level 1, face in shape [-]": found.slopes[q][key],
            "level 1, face on average [-]": found.soft_slopes[q][key],
            "assembly [-]": slope,
            "band of its mesh ± [-]": TO_ZERO * abs(slope - coarse[q][key]),
            "the assembly's from": "energy"
            if key in (FORGED, RING, IRON, *SPRINGS)
            else "differences",
        }
        for q in (*HUB, MOMENT)
        for key, slope in top[q].items()
    ]
    numbers = [key for key in rows[0] if key.endswith("[-]")]
    exact = column(rows, "assembly [-]")
    ends = [min(exact), max(exact)]
    page.section("Cheap level against the assembly")
    page.chart(
        HERO,
        [
            trace("equal", ends, ends, line={"dash": "dash"}),
            *(trace(of[:-4], exact, column(rows, of), points=True) for of in numbers[:2]),
        ],
        "assembly of solids [-]",
        "level 1 [-]",
    )
    page.table(
        "Relative change of each quantity for the relative change of each value, where it "
        f"is {_MINIMUM:g} or more",
        [
            dict(row) | {key: round(row[key], 4) for key in numbers}
            for row in rows
            if max(abs(row[key]) for key in numbers[:3]) >= _MINIMUM
        ],
    )
    page.text(
        "Dimensions were changed by moving the nodes of one mesh, so that no noise of remeshing "
        f"is in the differences. The band is the error that a mesh {RATIO:g} times coarser in the "
        f"housing indicates to element size zero, at an order of {MIN_ORDER:g}. What is "
        "left between the levels is how the shaft holds the seat: the cheap one holds it in shape "
        "or on average, and so gives ring and housing another share of the flexibility; part of "
        "what it assigns to the ring is the shaft's."
    )


def _show_tilt(page: Page, found: Study, tilt: Slopes) -> None:
    page.equals(
        "K_R of the assembly: sum of elasticities to its three moduli",
        sum(tilt["tilt"][key] for key in (FORGED, RING, IRON)),
        1.0,
        within=1e-4,
        why="a step of 1e-3 leaves 1e-6, the solver 1e-8 over the step",
        source="Euler: stiffness is homogeneous of degree 1 in moduli",
        measure="identity",
    )
    page.section("K_R")
    page.table(
        "Relative change of K_R for the relative change of each value: the unit by itself, "
        "its seat held in shape, and in the assembly, where the shaft yields there, too",
        [
            {
                "quantity": f"{BEARING}.{name}",
                "value": key,
                "unit by itself [-]": round(found.slopes[f"{BEARING}.{name}"][key], 4),
                "in the assembly [-]": round(slope, 4),
            }
            for name, slopes in tilt.items()
            for key, slope in slopes.items()
        ],
    )
    page.text(
        f"Of the flexibility of K_R about the horizontal axis {100 * tilt['tilt'][FORGED]:.2g} % "
        "is the shaft's own, under the seat: a unit by itself assigns that to its ring."
    )
