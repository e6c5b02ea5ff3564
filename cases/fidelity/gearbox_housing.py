"""A gearbox housing on torque arms: which level its suspension needs, and when arms matter."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Bushing stiffness is varied by these factors, decades about the one given.
DECADES = (-2.0, 3.0)
TORQUE = 1e6  # N m, for pictures and reactions

#: Scene whose gearbox springs are replaced by the housing's.
SCENE = "main_bearing_spherical"


def run(run: Run) -> Any:
    """Climb the ladder, vary the bushings, export."""
    import numpy as np

    from fe_drivetrain.cases.fidelity import (
        component_page as page,
    )
    from fe_drivetrain.export import component_superelement
    from fe_drivetrain.fidelity import gearbox_springs
    from fe_drivetrain.scene import HousingComponent, change_component, library_component

    component = library_component("gearbox_housing")
    assert isinstance(component, HousingComponent)
    component = change_component(component, run.settings)
    if run.quick:
        component = page.coarser(component, page.QUICK)
    ladder = page.climb(run, component)

    def felt(motion: int) -> Any:
        """Force over motion at the ring, its other motions free."""
        return lambda model: float(1.0 / model.compliance[motion, motion])

    quantities = [
        page.Quantity("torsion of the suspension about x", "N m/rad", felt(3)),
        page.Quantity("stiffness along z", "N/m", felt(2)),
        page.Quantity("stiffness along y", "N/m", felt(1)),
        page.Quantity("stiffness along x", "N/m", felt(0)),
    ]
    levels, verdict, sentence = page.ladder_section(ladder, quantities)
    sweep, ratio, own = _sweep(ladder, component)
    ring = ladder.top.stiffness(["ring"])
    springs = gearbox_springs(ring)
    body = component_superelement(component, solids=(ladder.solids[-1], ladder.solids[-2]))
    files, read_back = page.files_section(run, body)
    more = []
    if not run.quick:
        torque = np.zeros(len(ladder.top.compliance))
        torque[3] = TORQUE
        motions = ladder.top.compliance @ torque
        said = f"Torque of {TORQUE:g} N m at the ring"
        more.append(page.picture_section(run, ladder.solid, motions, said))
    with run.step("springs in a scene"):
        scene_section, softer = _in_a_scene(springs, component)
    band = ladder.band(quantities[0].of)
    return CASE.results(
        run,
        summary=[
            f"{sentence}.",
            f"On the solid the suspension has {quantities[0].of(ladder.top):.4g} N m/rad about x "
            f"(± {100 * band.relative_uncertainty:.2g} %), where rigid arms would have "
            f"{quantities[0].of(ladder.models[0]):.4g}. As the gearbox springs of {SCENE}, whose "
            f"gearbox is held about x, it takes {softer:.2g} % off the hub's torsional stiffness.",
            "Bushings and housing stand in series, so that rigid arms overstate the stiffness by "
            f"what the bushings have over the housing, here {100 * ratio:.2g} %; in the housing's "
            f"own stiffness, which counts with stiff bushings, beams are {100 * own:.2g} % off.",
        ],
        verdicts=[verdict, *_checks(ladder, component), page.rigid_verdict(body), read_back],
        sections=[levels, _reactions(ladder, component), sweep, scene_section, files, *more],
        figures={
            "gearbox.stiffness": list(springs.stiffness),
            "left out": springs.left_out,
            "torsion": {m.title: quantities[0].of(m) for m in ladder.models},
            "torsion band": band.uncertainty,
        },
        assumptions=[*page.assumption_rows(component), _bushings(component)],
    )


def _sweep(ladder: Any, component: Any) -> tuple[Any, float, float]:
    """Error of the cheap levels in torsion, over the stiffness of the bushings; that of rigid arms
    with the bushings given, and of beams with the stiffest ones.
    """
    import numpy as np

    from fe_drivetrain.cases.fidelity.component_page import (
        TOLERANCE,
    )
    from fe_drivetrain.fidelity import housing_frame, rigid_level
    from fe_drivetrain.report import Section, Text, chart, trace
    from fe_drivetrain.scene import change_component
    from fe_drivetrain.solve import supported

    bodies = {
        "arms as beams, rigid ring": housing_frame(component, ring_gives=False),
        "arms and ring as beams": housing_frame(component, ring_gives=True),
    }
    factors = np.logspace(*DECADES, 41)
    given = np.array(component.bushings.stiffness)
    ratios = []
    errors: dict[str, list[float]] = {"rigid body": [], **{name: [] for name in bodies}}
    for factor in factors:
        stiffness = (factor * given).tolist()
        changed = change_component(component, {"bushings.stiffness": stiffness})

        def torsion(body: Any, supports: Any = changed.supports) -> float:
            return float(1.0 / supported(body, supports).motions[3, 3])

        solid = torsion(ladder.solid.body)
        rigid = 1.0 / rigid_level(changed).compliance[3, 3]
        # bushings and housing give one after the other
        ratios.append(rigid * (1.0 / solid - 1.0 / rigid))
        errors["rigid body"].append(rigid / solid - 1.0)
        for name, body in bodies.items():
            errors[name].append(torsion(body) / solid - 1.0)
    safe = float(np.interp(TOLERANCE, errors["rigid body"], ratios))
    traces = [
        trace(name, ratios, 100 * np.abs(found), mode="lines") for name, found in errors.items()
    ]
    figure = chart(
        "Error of the torsional stiffness against the solid, where the bushings are all softer or "
        f"stiffer than given; shaded, rigid arms are within {100 * TOLERANCE:g} %",
        traces,
        x="stiffness of the bushings over that of the housing [-]",
        y="error [%]",
        logarithmic=("x", "y"),
        safe=(None, safe),
    )
    now = float(np.interp(0.0, np.log10(factors), ratios))
    text = Text(
        text="Bushings and housing stand in series, so that a rigid housing is too stiff by just "
        "the ratio of the bushings' stiffness to the housing's: that is the rule for when arms "
        f"matter. With the bushings given it is {now:.2g}. Stiff bushings show how far the beams "
        "are from the solid in the housing's own stiffness."
    )
    own = abs(errors["arms and ring as beams"][-1])
    return Section(title="When do the arms matter?", items=[text, figure]), now, own


def _reactions(ladder: Any, component: Any) -> Any:
    """Forces on the bushings under torque and weight, at each level and by statics."""
    import numpy as np

    from fe_drivetrain.fidelity import loads_of
    from fe_drivetrain.report import Section, Table, Text

    loads = np.zeros((2, len(loads_of(component))))
    loads[0, 3] = TORQUE
    loads[1, 2] = -component.weight
    loads[1, -1] = -9.81
    rows: list[list[Any]] = [
        ["statics: torque over span", TORQUE / component.gearbox_housing.arm_span, None, None, None]
    ]
    for model in ladder.models:
        found = model.reactions(loads)
        rows.append(
            [
                f"{model.level} {model.title}",
                float(found["left"][0, 2]),
                float(found["left"][0, 3]),
                float(found["left"][1, 2]),
                float(found["left"][1, 1]),
            ]
        )
    table = Table(
        caption=f"What the housing puts on the left bushing, at +y, under {TORQUE:g} N m about x, "
        f"and under {component.weight:g} N at the ring and the housing's own weight",
        columns=["level", "torque: Fz [N]", "torque: Mx [N m]", "weight: Fz [N]", "weight: Fy [N]"],
        rows=rows,
    )
    text = Text(
        text="Equilibrium alone decides the vertical forces but for what the bushings carry in "
        "twist and, where the arms are not at the height of the axis, along y."
    )
    return Section(title="Reactions of the bushings", items=[text, table])


def _in_a_scene(springs: Any, component: Any) -> tuple[Any, float]:
    """The housing as the gearbox springs of a scene, and what that does to the hub's stiffness: how
    much softer it is in torsion [%], too.
    """
    from fe_drivetrain.fidelity import Quantity, shaft_level
    from fe_drivetrain.report import Section, Table, Text
    from fe_drivetrain.scene import change_scene, library_scene

    scene = library_scene(SCENE)
    rounded = [float(f"{k:.6g}") for k in springs.stiffness]
    changed = change_scene(scene, {"gearbox.stiffness": rounded})
    rows: list[list[Any]] = [
        [name, str(given), value]
        for name, given, value in zip(
            ("along x [N/m]", "along y [N/m]", "along z [N/m]",
             "about x [N m/rad]", "about y [N m/rad]", "about z [N m/rad]"),
            scene.gearbox.stiffness,
            springs.stiffness,
            strict=True,
        )
    ]  # fmt: skip
    table = Table(
        caption="gearbox.stiffness",
        columns=["", f"in {SCENE}", "of the housing on its bushings, solid"],
        rows=rows,
    )
    before, after = (shaft_level(s, 1) for s in (scene, changed))
    rows = []
    for motion in ("uy", "uz", "rx", "ry", "rz"):
        first, second = (Quantity(f"hub.stiffness.{motion}").of(m, 1.0)[0] for m in (before, after))
        unit = Quantity(f"hub.stiffness.{motion}").unit
        rows.append([motion, unit, float(first), float(second), 100 * float(second / first - 1)])
    hub = Table(
        caption=f"Stiffness at the hub of {SCENE}, level 1, rigid housings",
        columns=["", "unit", "springs of the scene", "springs of the housing", "change [%]"],
        rows=rows,
    )
    left_out = ", ".join(f"{name} {share:.2g}" for name, share in springs.left_out.items())
    text = Text(
        text="A scene's gearbox has six springs and no couplings. Left out are "
        f"{left_out or 'none'}: each is over the root of the product of the two stiffnesses. They "
        f"come from the arms' place: z = {component.gearbox_housing.arm_z:g} m, x = "
        f"{component.gearbox_housing.arm_x:g} m from the ring's middle; with both at 0, the six "
        "springs are all there is."
    )
    section = Section(title="Springs for a main-shaft scene", items=[text, table, hub])
    return section, next(-row[-1] for row in rows if row[0] == "rx")


def _bushings(component: Any) -> Any:
    """Where the stiffness of the bushings comes from."""
    from fe_drivetrain.report import AssumptionRow
    from fe_drivetrain.scene import library_component

    library = library_component("gearbox_housing").model_dump()
    given = component.bushings.model_dump() == library["bushings"]
    return AssumptionRow(
        name="bushings.stiffness",
        value=", ".join(f"{k:g}" for k in component.bushings.stiffness),
        unit="N/m, N m/rad",
        source="half the gearbox springs of Stirling 2023, Table 3.1, in each; tilt: the radial "
        "stiffness spread over an assumed length of 0.3 m; twist: the axial one at an assumed "
        "radius of 0.1 m"
        if given
        else "given by the user",
    )


def _checks(ladder: Any, component: Any) -> list[Any]:
    """Balances, symmetry, mass, and the beams against their closed form."""
    import numpy as np

    from fe_drivetrain.beam import rectangle
    from fe_drivetrain.cases.fidelity.component_page import (
        SOLVED,
        SOLVED_REASON,
    )
    from fe_drivetrain.common import wrench_transport
    from fe_drivetrain.fidelity import frame_level
    from fe_drivetrain.report import judge
    from fe_drivetrain.scene import change_component, material_of

    top = ladder.top
    places = {a.name: a.position for a in component.attachments}
    total = sum(wrench_transport(places[name]) @ R for name, R in top.reaction_matrices.items())
    housing, material = component.gearbox_housing, material_of(component)
    mass = material.density * housing.volume_and_centre()[0]
    # left and right under the mirrored load: x, z, and the turn about y keep their sign
    sign = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    left, right = (top.reaction_matrices[name][:, :6] for name in ("left", "right"))
    uneven = np.abs(left - np.outer(sign, sign) * right).max() / np.abs(left).max()

    # arms at the height of the axis, bushings that do not twist: springs in series
    kx, ky, kz, _, ty, tz = component.bushings.stiffness
    level_arms = {"gearbox_housing.arm_z": 0.0, "gearbox_housing.arm_x": 0.0}
    straight = change_component(
        component, level_arms | {"bushings.stiffness": [kx, ky, kz, 0.0, ty, tz]}
    )
    section = rectangle(housing.arm_width, housing.arm_height, material.poisson_ratio)
    length, half_span = housing.arm_span / 2 - housing.outer_diameter / 2, housing.arm_span / 2
    give = length**3 / (3 * material.youngs_modulus * section.inertias[0])
    give += length / (material.shear_modulus * section.shear_areas[1])
    series = 2 * half_span**2 / (1.0 / kz + give)
    beams = 1.0 / frame_level(straight, ring_gives=False).compliance[3, 3]
    return [
        judge(
            "torsion with arms as beams on a rigid ring, arms at the axis",
            float(beams),
            series,
            tolerance=1e-9,
            unit="N m/rad",
            source="cantilevers with shear in series with the bushings, "
            "2 s^2 / (1/k + l^3/3EI + l/kGA)",
            reason="the same theory: only round-off is left",
            measure="stiffness",
        ),
        judge(
            "solid: moment that the bushings carry under a torque of 1 N m",
            float(total[3, 3]),
            1.0,
            tolerance=SOLVED,
            unit="N m",
            source="equilibrium",
            reason=SOLVED_REASON,
            measure="reaction",
        ),
        judge(
            "solid: forces of the bushings under 1 m/s^2 along z",
            float(total[2, -1]),
            mass,
            tolerance=1e-3,
            unit="N",
            source="mass of ring, arms and eyes in closed form",
            reason="curved elements keep the volume of cylinders to some 1e-4",
            measure="mass",
            band=1e-3 * mass,
        ),
        judge(
            "solid: left and right bushing under mirrored loads, largest difference",
            float(uneven),
            0.0,
            tolerance=SOLVED,
            relative=False,
            unit="-",
            source="the mesh is its own mirror image",
            reason=SOLVED_REASON,
            measure="identity",
        ),
    ]


CASE = Case(
    name="fidelity/gearbox_housing",
    title="Gearbox housing on torque arms: which level its suspension needs",
    source="bushings from the gearbox springs of Stirling 2023, Table 3.1; dimensions assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
