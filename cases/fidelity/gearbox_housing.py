"""A gearbox housing on torque arms: which level its suspension needs, and when arms matter."""

from collections.abc import Callable

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
    check_rigid_motion,
    show_files,
    show_ladder,
    show_picture,
)
from fe_drivetrain.common import (
    Floats,
    wrench_transport,
)
from fe_drivetrain.drivetrain_file import (
    HousingComponent,
    change_component,
    change_scene,
    library_component,
    library_scene,
    material_of,
)
from fe_drivetrain.elasticity.solve import (
    Condensed,
    supported,
)
from fe_drivetrain.export import component_superelement
from fe_drivetrain.report import Cell, trace
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Run, column
from fe_drivetrain.shafts.beam import rectangle
from fe_drivetrain.shafts.fidelity import (
    GearboxSprings,
    LevelModel,
    coarser,
    frame_level,
    gearbox_springs,
    housing_frame,
    loads_of,
    rigid_level,
    shaft_level,
)
from fe_drivetrain.shafts.fidelity import Quantity as SceneQuantity

#: Bushing stiffness is varied by these factors, decades about the one given.
DECADES = (-2.0, 3.0)
TORQUE = 1e6  # N m, for pictures and reactions

#: Scene whose gearbox springs are replaced by the housing's.
SCENE = "main_bearing_spherical"


def ring_stiffness(motion: int) -> Callable[[LevelModel], float]:
    """Force over motion at the ring, its other motions free."""
    return lambda model: float(1.0 / model.compliance[motion, motion])


@case(
    "Gearbox housing on torque arms: which level its suspension needs",
    source="bushings from the gearbox springs of Stirling 2023, Table 3.1; dimensions assumed",
    changes="gearbox_housing",
)
def run(run: Run, page: Page) -> None:
    """Climb the ladder, vary the bushings, export."""
    component = library_component("gearbox_housing")
    assert isinstance(component, HousingComponent)
    component = change_component(component, run.settings)
    if run.quick:
        component = coarser(component, QUICK)
    ladder = all_levels(run, component)
    torsion = ring_stiffness(3)
    compared = show_ladder(
        run,
        page,
        ladder,
        [
            Quantity("torsion of the suspension about x", "N m/rad", torsion),
            Quantity("stiffness along z", "N/m", ring_stiffness(2)),
            Quantity("stiffness along y", "N/m", ring_stiffness(1)),
            Quantity("stiffness along x", "N/m", ring_stiffness(0)),
        ],
    )
    _check_beams(page, component)
    _check_solid(page, component, ladder)
    body = component_superelement(component, solids=(ladder.solids[-1], ladder.solids[-2]))
    check_rigid_motion(page, body)
    _show_reactions(page, ladder, component)
    ratio, own = _vary_bushings(page, ladder, component)
    springs = gearbox_springs(ladder.top.stiffness(["ring"]))
    with run.step("springs in a scene"):
        softer = _put_in_a_scene(page, springs, component)
    show_files(run, page, body)
    if not run.quick:
        torque = np.zeros(len(ladder.top.compliance))
        torque[3] = TORQUE
        what = f"Torque of {TORQUE:g} N m at the ring"
        show_picture(run, page, component, ladder.solid, ladder.top.compliance @ torque, what)
    band = ladder.band(torsion)
    whole = torsion(ladder.top) / 1e6
    page.found(
        "torsion of the suspension about x [MN m/rad]", whole, whole * band.relative_uncertainty
    )
    answer(page, compared, torsion(ladder.models[0]) / 1e6, softer)
    page.say(
        "Bushings and housing stand in series, so that rigid arms overstate the stiffness by "
        f"what the bushings have over the housing, here {100 * ratio:.2g} %; in the housing's "
        "own stiffness, which counts with stiff bushings, beams have an error of "
        f"{100 * own:.2g} %.",
    )
    page.data("gearbox.stiffness", list(springs.stiffness))
    page.data("left out", springs.left_out)
    page.data("torsion", {model.title: torsion(model) for model in ladder.models})
    page.data("torsion band", band.uncertainty)
    assume_dimensions(page, component)
    _assume_bushings(page, component)


def answer(page: Page, compared: Compared, rigid: float, softer: float) -> None:
    """State which level the suspension needs; torsion of rigid arms [MN m/rad], hub softer [%]."""
    solid = page.judged("torsion of the suspension about x", "torsion about x, solid")
    models, errors = compared.ladder.models, compared.errors[0]
    error, band = 100 * errors[compared.chosen], 100 * compared.own
    chosen, times = models[compared.chosen], compared.ladder.seconds
    name = chosen.title.replace(", ", " and ")
    name = f"A {name}" if name.startswith("rigid") else f"A model with {name}"
    about_x, allowed = certain_value(solid), f"{100 * TOLERANCE:g}\u00a0%"
    verdict = (
        f"{name} is enough: it gives the suspension's torsional stiffness, "
        f"{about_x}, with an error of {value_text(error, '%', band, False)} ({allowed} allowed)."
    )
    if chosen is compared.ladder.top:
        which = (
            "Only the solid model gives" if compared.own <= TOLERANCE else "No model surely gives"
        )
        verdict = f"{which} the suspension's torsional stiffness, {about_x}, within {allowed}."
    page.answer(
        "Which model does the suspension of a gearbox on torque arms need?",
        verdict,
        [
            solid,
            page.value(
                "torsion about x, rigid arms [MN m/rad]",
                rigid,
                beside=solid.value,
                by="solid",
            ),
            *(
                page.value(
                    f"error, {model.title} [%]",
                    100 * one,
                    band,
                    beside=100 * TOLERANCE,
                    by="allowed",
                )
                for model, one in zip(models[:-1], errors[:-1], strict=True)
                if np.isfinite(one)
            ),
            page.value(
                "computing time of the solid model over that of the chosen one",
                times[-1] / times[compared.chosen],
            ),
            page.value("taken off the hub's torsional stiffness [%]", softer),
        ][:6],
        hero=compared.caption,
        cautions=[
            "Bushings are softer than the housing here: with stiff bushings the housing's own "
            "stiffness counts, and beams err by more."
        ],
    )
    page.say(
        f"As the gearbox springs of {SCENE}, whose gearbox is held about x, the suspension lowers "
        f"the hub's torsional stiffness by {softer:.2g} %."
    )


def _vary_bushings(page: Page, ladder: Ladder, component: HousingComponent) -> tuple[float, float]:
    """Error of the cheap levels in torsion, over the stiffness of the bushings.

    Returns
    -------
    given, stiffest : float
        Error of rigid arms with the bushings given, and of beams with the stiffest ones.
    """
    bodies = {
        "arms as beams, rigid ring": housing_frame(component, ring_gives=False),
        "arms and ring as beams": housing_frame(component, ring_gives=True),
    }
    factors = np.logspace(*DECADES, 41)
    rows = []
    for factor in factors:
        stiffness = (factor * np.array(component.bushings.stiffness)).tolist()
        changed = change_component(component, {"bushings.stiffness": stiffness})
        solid = _torsion(ladder.solid.body, changed)
        rigid = 1.0 / rigid_level(changed).compliance[3, 3]
        rows.append(
            {
                # bushings and housing give one after the other
                "ratio": rigid * (1.0 / solid - 1.0 / rigid),
                "rigid body": rigid / solid - 1.0,
                **{name: _torsion(body, changed) / solid - 1.0 for name, body in bodies.items()},
            }
        )
    ratios = column(rows, "ratio")
    now = float(np.interp(0.0, np.log10(factors), ratios))
    page.section("When do the arms matter?")
    page.text(
        "Bushings and housing stand in series, so that a rigid housing is too stiff by just "
        "the ratio of the bushings' stiffness to the housing's: that is the rule for when arms "
        f"matter. With the bushings given it is {now:.2g}. Stiff bushings show how far the beams "
        "are from the solid in the housing's own stiffness."
    )
    page.chart(
        "Error of the torsional stiffness against the solid, where the bushings are all softer or "
        f"stiffer than given; shaded, rigid arms are within {100 * TOLERANCE:g} %",
        [trace(name, ratios, 100 * np.abs(column(rows, name))) for name in ("rigid body", *bodies)],
        "stiffness of the bushings over that of the housing [-]",
        "error [%]",
        "xy",
        safe=(None, float(np.interp(TOLERANCE, column(rows, "rigid body"), ratios))),
    )
    return now, abs(rows[-1]["arms and ring as beams"])


def _torsion(body: Condensed, component: HousingComponent) -> float:
    """Stiffness about x at the ring of a housing on its bushings."""
    return float(1.0 / supported(body, component.supports).motions[3, 3])


def _show_reactions(page: Page, ladder: Ladder, component: HousingComponent) -> None:
    """Forces on the bushings under torque and weight, at each level and by statics."""
    loads = np.zeros((2, len(loads_of(component))))
    loads[0, 3] = TORQUE
    loads[1, 2] = -component.weight
    loads[1, -1] = -9.81
    columns = ("level", "torque: Fz [N]", "torque: Mx [N m]", "weight: Fz [N]", "weight: Fy [N]")
    rows: list[list[Cell]] = [
        ["statics: torque over span", TORQUE / component.gearbox_housing.arm_span, None, None, None]
    ]
    for model in ladder.models:
        left = model.reactions(loads)["left"]
        forces = (left[0, 2], left[0, 3], left[1, 2], left[1, 1])
        rows.append([f"{model.level} {model.title}", *map(float, forces)])
    page.section("Reactions of the bushings")
    page.text(
        "Equilibrium alone decides the vertical forces but for what the bushings carry in "
        "twist and, where the arms are not at the height of the axis, along y."
    )
    page.table(
        f"What the housing puts on the left bushing, at +y, under {TORQUE:g} N m about x, "
        f"and under {component.weight:g} N at the ring and the housing's own weight",
        rows,
        columns,
    )


def _put_in_a_scene(page: Page, springs: GearboxSprings, component: HousingComponent) -> float:
    """The housing as the gearbox springs of a scene, and what that does to the hub's stiffness.

    Returns
    -------
    softer : float
        How much softer the hub is in torsion [%].
    """
    scene = library_scene(SCENE)
    rounded = [float(f"{k:.6g}") for k in springs.stiffness]
    changed = change_scene(scene, {"gearbox.stiffness": rounded})
    before, after = (shaft_level(s, 1) for s in (scene, changed))
    rows = []
    for motion in ("uy", "uz", "rx", "ry", "rz"):
        quantity = SceneQuantity(f"hub.stiffness.{motion}")
        first, second = (float(quantity.of(model, 1.0)[0]) for model in (before, after))
        rows.append(
            {
                "": motion,
                "unit": quantity.unit,
                "springs of the scene": first,
                "springs of the housing": second,
                "change [%]": 100 * (second / first - 1),
            }
        )
    left_out = ", ".join(f"{name} {share:.2g}" for name, share in springs.left_out.items())
    page.section("Springs for a main-shaft scene")
    page.text(
        "A scene's gearbox has six springs and no couplings. Left out are "
        f"{left_out or 'none'}: each is over the root of the product of the two stiffnesses. They "
        f"come from the arms' place: z = {component.gearbox_housing.arm_z:g} m, x = "
        f"{component.gearbox_housing.arm_x:g} m from the ring's middle; with both at 0, the six "
        "springs are all there is."
    )
    along = [f"along {axis} [N/m]" for axis in "xyz"]
    about = [f"about {axis} [N m/rad]" for axis in "xyz"]
    both = zip(along + about, scene.gearbox.stiffness, springs.stiffness, strict=True)
    compared: list[list[Cell]] = [[name, str(given), value] for name, given, value in both]
    page.table(
        "gearbox.stiffness",
        compared,
        ["", f"in {SCENE}", "of the housing on its bushings, solid"],
    )
    page.table(f"Stiffness at the hub of {SCENE}, level 1, rigid housings", rows)
    return next(-float(row["change [%]"]) for row in rows if row[""] == "rx")


def _assume_bushings(page: Page, component: HousingComponent) -> None:
    """Where the stiffness of the bushings comes from."""
    library = library_component("gearbox_housing").model_dump()
    given = component.bushings.model_dump() == library["bushings"]
    page.assume(
        "bushings.stiffness",
        ", ".join(f"{k:g}" for k in component.bushings.stiffness),
        "N/m, N m/rad",
        "half the gearbox springs of Stirling 2023, Table 3.1, in each; tilt: the radial "
        "stiffness spread over an assumed length of 0.3 m; twist: the axial one at an assumed "
        "radius of 0.1 m"
        if given
        else "given by the user",
    )


def _check_beams(page: Page, component: HousingComponent) -> None:
    """Arms at the height of the axis, bushings that do not twist: springs in series."""
    kx, ky, kz, _, ty, tz = component.bushings.stiffness
    level_arms = {"gearbox_housing.arm_z": 0.0, "gearbox_housing.arm_x": 0.0}
    straight = change_component(
        component, level_arms | {"bushings.stiffness": [kx, ky, kz, 0.0, ty, tz]}
    )
    housing, material = component.gearbox_housing, material_of(component)
    section = rectangle(housing.arm_width, housing.arm_height, material.poisson_ratio)
    length, half_span = housing.arm_span / 2 - housing.outer_diameter / 2, housing.arm_span / 2
    give = length**3 / (3 * material.youngs_modulus * section.inertias[0])
    give += length / (material.shear_modulus * section.shear_areas[1])
    page.equals(
        "torsion with arms as beams on a rigid ring, arms at the axis [N m/rad]",
        float(1.0 / frame_level(straight, ring_gives=False).compliance[3, 3]),
        2 * half_span**2 / (1.0 / kz + give),
        within=1e-9,
        why="the same theory: only round-off is left",
        source="cantilevers with shear in series with the bushings, "
        "2 s^2 / (1/k + l^3/3EI + l/kGA)",
    )


def _check_solid(page: Page, component: HousingComponent, ladder: Ladder) -> None:
    """Balances, mass and symmetry."""
    total, rough = (_on_all_bushings(component, m) for m in (ladder.top, ladder.coarse[-1]))
    housing = component.gearbox_housing
    page.equals(
        "solid: moment that the bushings carry under a torque of 1 N m [N m]",
        float(total[3, 3]),
        1.0,
        within=SOLVED,
        why=SOLVED_REASON,
        source="equilibrium",
        measure="reaction",
    )
    page.equals(
        "solid: forces of the bushings under 1 m/s^2 along z [N]",
        float(total[2, -1]),
        material_of(component).density * housing.volume_and_centre()[0],
        within=1e-3,
        why="curved elements keep the volume of cylinders to some 1e-4",
        source="mass of ring, arms and eyes in closed form",
        measure="mass",
        band=abs(float(total[2, -1] - rough[2, -1])),
    )
    # left and right under the mirrored load: x, z, and the turn about y keep their sign
    sign = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    left, right = (ladder.top.reaction_matrices[name][:, :6] for name in ("left", "right"))
    page.vanishes(
        "solid: left and right bushing under mirrored loads, largest difference [-]",
        float(np.abs(left - np.outer(sign, sign) * right).max() / np.abs(left).max()),
        within=SOLVED,
        why=SOLVED_REASON,
        source="the mesh is its own mirror image",
    )


def _on_all_bushings(component: HousingComponent, model: LevelModel) -> Floats:
    """Forces and moments about the origin that all bushings take, under each unit load."""
    places = {a.name: a.position for a in component.attachments}
    total: Floats = np.sum(
        [wrench_transport(places[name]) @ R for name, R in model.reaction_matrices.items()],
        axis=0,
    )
    return total
