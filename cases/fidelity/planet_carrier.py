"""A planet carrier with its pins: how far it winds up, and what the error of beams is."""

from collections.abc import Callable, Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.component_page import (
    QUICK,
    SOLVED,
    SOLVED_REASON,
    TOLERANCE,
    Compared,
    Ladder,
    Quantity,
    all_levels,
    assume_dimensions,
    band_of,
    check_rigid_motion,
    show_files,
    show_ladder,
    show_picture,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import GridConvergence
from fe_drivetrain.drivetrain_file import (
    CarrierComponent,
    change_component,
    library_component,
    material_of,
)
from fe_drivetrain.elasticity.interfaces import averaged_point
from fe_drivetrain.elasticity.mesh import MEANS, face_weights, mean_size, turns
from fe_drivetrain.export import component_superelement
from fe_drivetrain.report import Cell
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.beam import round_section
from fe_drivetrain.shafts.fidelity import (
    COARSER,
    LevelModel,
    PinMotions,
    coarser,
    frame_level,
    pin_motions,
    solid_component,
    solid_level,
    torque_share,
)

#: N m. Rated torque of the NREL 5 MW turbine: generator torque 43 093.55 N m at a ratio of 97
#: (Jonkman 2009, NREL/TP-500-38060, Table 1-1 and section 7).
RATED = 43_093.55 * 97.0
FACE_WIDTH = 0.491  # m, of the planets, by the tables that the component's file names


def stiffness_of_pin(axis: int) -> Callable[[LevelModel], float]:
    """Force over motion at the middle of the first pin, along x, its circle or its radius."""

    def of(model: LevelModel) -> float:
        if not model.points:
            return float("nan")
        row = 6 * model.points.index("pin_1") + axis
        return float(1.0 / model.compliance[row, row])

    return of


@case(
    "Planet carrier with pins: wind-up and tilt, and the error of beams",
    source="first stage of the 5 MW reference gearbox (Nejad, Guo, Gao and Moan 2016); cheeks and "
    "webs assumed",
    changes="planet_carrier",
)
def run(run: Run, page: Page) -> None:
    """Climb the ladder with two walls, compare with one, export."""
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    component = change_component(component, run.settings)
    if run.quick:
        component = coarser(component, QUICK)
    ladder = all_levels(run, component)

    def wind_up(model: LevelModel) -> float:
        return pin_motions(component, model).wind_up if model.points else float("nan")

    def tilt(model: LevelModel) -> float:
        return 1e12 * pin_motions(component, model).tilt if model.points else float("nan")

    compared = show_ladder(
        run,
        page,
        ladder,
        [
            Quantity("wind-up of the pins about the hub", "N m/rad", wind_up),
            Quantity("tilt of a pin under torque", "µrad/(MN m)", tilt),
            Quantity("one pin, along its circle", "N/m", stiffness_of_pin(1)),
            Quantity("one pin, along its radius", "N/m", stiffness_of_pin(2)),
            Quantity("one pin, along x", "N/m", stiffness_of_pin(0)),
        ],
    )
    bands = [ladder.band(of) for of in (wind_up, tilt)]
    top = pin_motions(component, ladder.top)
    skew = 1e6 * RATED * top.tilt * FACE_WIDTH
    off = {of: 100 * (of(ladder.models[-2]) / of(ladder.top) - 1.0) for of in (wind_up, tilt)}
    wound = 1e3 * RATED / top.wind_up
    band = wound * bands[0].relative_uncertainty
    page.found("wind-up of the pins at the rated torque [mrad]", wound, band)
    answer(page, compared, skew, bands[1].relative_uncertainty, (off[wind_up], off[tilt]))
    _check_beams(page, component)
    _check_solid(page, component, ladder)
    body = component_superelement(component, solids=(ladder.solids[-1], ladder.solids[-2]))
    check_rigid_motion(page, body)
    show_files(run, page, body)
    if not run.quick:
        if component.planet_carrier.walls == 2:
            _compare_walls(run, page, component, ladder, bands)
        what = f"Rated torque of {RATED:.4g} N m, shared equally by the pins; the flange is held"
        motions = under_torque(component, ladder.top, RATED)
        show_picture(run, page, component, ladder.solid, motions, what)
    page.data("wind-up", {m.title: wind_up(m) for m in ladder.models if m.points})
    page.data("tilt at 1 N m", {m.title: 1e-12 * tilt(m) for m in ladder.models if m.points})
    page.data("wind-up band", bands[0].uncertainty)
    assume_dimensions(page, component)


def answer(
    page: Page, compared: Compared, skew: float, tilt_band: float, off: tuple[float, float]
) -> None:
    """State how far the pins wind up and tilt, and how far beams are off.

    Parameters
    ----------
    page : Page
        Takes the answer.
    compared : Compared
        All levels.
    skew, tilt_band : float
        Tilt of a pin over the face width [µm], and its relative band.
    off : tuple of float
        By how much beams are too stiff in wind-up, and wrong in tilt [%].
    """
    wound = page.judged(
        "wind-up of the pins at the rated torque", "wind-up of the pins at rated torque"
    )
    solid = compared.chosen == len(compared.ladder.models) - 1
    beams = f"beams are {abs(off[0]):.2g}\u00a0% too {'stiff' if off[0] > 0.0 else 'soft'}"
    if compared.own > TOLERANCE:
        beams = "beams cannot be judged"
        which = f"as the solid model is uncertain by ±\u00a0{100 * compared.own:.2g}\u00a0%"
    else:
        which = "which is not enough" if solid else "which is enough"
    page.answer(
        "How far does a planet carrier wind up, and are beams enough for it?",
        f"At rated torque the planet pins wind up by {certain_value(wound)}; {beams}, {which}.",
        [
            wound,
            page.value("tilt of a pin over the face width [µm]", skew, abs(skew) * tilt_band),
            page.value(
                "error of beams in wind-up [%]",
                abs(off[0]),
                100 * compared.own * (1 + abs(off[0]) / 100),
                beside=100 * TOLERANCE,
                by="allowed",
            ),
            page.value("error of beams in tilt [%]", abs(off[1])),
            page.value("computing time of the solid model [s]", compared.ladder.seconds[-1]),
        ],
        hero=compared.caption,
        cautions=[
            "The cheeks bend where hub, webs and pins meet them, which only the solid model shows; "
            "dimensions of cheeks and webs are assumed.",
        ],
    )


def under_torque(component: CarrierComponent, model: LevelModel, torque: float) -> Floats:
    """Motions of all points under a torque [N m] that the pins share equally."""
    forces = np.zeros(len(model.compliance))
    forces[6:] = torque * torque_share(component)
    return model.compliance @ forces


def _compare_walls(
    run: Run,
    page: Page,
    component: CarrierComponent,
    ladder: Ladder,
    bands: Sequence[GridConvergence],
) -> None:
    """Two walls, with the bands of their wind-up and tilt, against pins on one."""
    single = change_component(component, {"planet_carrier.walls": 1})
    with run.step("pins on one wall"):
        beams = frame_level(single)
        meshed = [solid_component(coarser(single, factor)) for factor in (*COARSER, 1.0)]
        solids = [pin_motions(single, solid_level(single, solid)) for solid in meshed]
    sizes = [mean_size(solid.mesh) for solid in meshed]
    own = [
        band_of(sizes, values) for values in ([s.wind_up for s in solids], [s.tilt for s in solids])
    ]
    page.section("Two walls or one")
    page.text(
        "With two walls a pin tilts because the rear cheek lags behind the front one, by what "
        "the webs give. On one wall it stands out as a cantilever, on a cheek that gives too."
    )
    page.table(
        "Pins between two cheeks, and standing on one; bands from three meshes each",
        [
            [2, "1 beams", *_row(pin_motions(component, ladder.models[-2]))],
            [2, "3 solid", *_row(pin_motions(component, ladder.top), bands)],
            [1, "1 beams", *_row(pin_motions(single, beams))],
            [1, "3 solid", *_row(solids[-1], own)],
        ],
        [
            "walls",
            "level",
            "wind-up [N m/rad]",
            "tilt at rated torque [µrad]",
            "over the face width [µm]",
            "wind-up ± [%]",
            "tilt ± [%]",
        ],
    )


def _row(found: PinMotions, bands: Sequence[GridConvergence] = ()) -> list[Cell]:
    tilt = RATED * found.tilt
    known: list[Cell] = [100 * band.relative_uncertainty for band in bands]
    known = known or [None, None]
    return [found.wind_up, 1e6 * tilt, 1e6 * tilt * FACE_WIDTH, *known]


def _check_beams(page: Page, component: CarrierComponent) -> None:
    """Pins on one wall: cheek and hub turn, and cantilevers bend under an even load."""
    carrier = component.planet_carrier
    single = change_component(component, {"planet_carrier.walls": 1})
    material, radius = material_of(component), carrier.pin_circle_diameter / 2
    E, G = material.youngs_modulus, material.shear_modulus
    pin = round_section(carrier.pin_diameter, material.poisson_ratio)
    hub = round_section(carrier.hub_diameter, material.poisson_ratio, carrier.hub_bore_diameter)
    give = carrier.gap**3 / (20 * E * pin.inertias[0]) + carrier.gap / (3 * G * pin.shear_areas[0])
    closed = carrier.hub_length / (G * hub.torsion) + give / (carrier.planets * radius**2)
    page.equals(
        "pins on one wall, as beams: wind-up [N m/rad]",
        pin_motions(single, frame_level(single)).wind_up,
        1.0 / closed,
        within=1e-3,
        why="the load acts on the nodes of 8 pieces, by Simpson's rule",
        source="twist of the hub, and cantilevers with shear under an even load, "
        "l / GJ + (l^3/20EI + l/3kGA) / (n r^2)",
    )


def _check_solid(page: Page, component: CarrierComponent, ladder: Ladder) -> None:
    """Symmetry of n planets, balance, and motions recovered from displacements."""
    top, carrier = ladder.top, component.planet_carrier
    rows = [6 * top.points.index(name) + np.arange(6) for name in component.loaded]
    first = top.compliance[np.ix_(rows[0], rows[0])]
    size = np.sqrt(np.diag(first))
    uneven = 0.0
    for row, Q in zip(rows, turns(carrier.planets), strict=True):
        turn = np.kron(np.eye(2), Q)
        own = turn.T @ top.compliance[np.ix_(row, row)] @ turn
        uneven = max(uneven, float(np.abs((own - first) / np.outer(size, size)).max()))
    page.vanishes(
        "solid: stiffness of the pins, each in its own frame, largest difference [-]",
        uneven,
        within=SOLVED,
        why=SOLVED_REASON,
        source=f"the mesh is {carrier.planets} times the same sector",
    )
    share = torque_share(component)
    page.equals(
        "solid: torque at the hub under 1 N m on the pins [N m]",
        float((top.reaction_matrices["hub"][:, : len(share)] @ share)[3]),
        1.0,
        within=SOLVED,
        why=SOLVED_REASON,
        source="equilibrium",
        measure="reaction",
    )
    if component.pins.coupling != "averaged":
        return
    motions = under_torque(component, top, 1.0)
    mesh, u = ladder.solid.mesh, ladder.solid.displacements(motions)
    nodes = mesh.face_nodes("carrier.pin_1")
    weights = face_weights(mesh.points, mesh.faces["carrier.pin_1"], len(mesh.points), MEANS)
    position = np.array(carrier.pin_centres()[0])
    mean = averaged_point("pin", nodes, weights[nodes], mesh.points, position, u.size)
    page.equals(
        "solid: way of the first pin along its circle, from displacements [m]",
        float((mean.motion @ u.ravel())[1]),
        float(motions[7]),
        within=SOLVED,
        why=SOLVED_REASON,
        source="the condensed stiffness, which was found without them",
        measure="identity",
    )
