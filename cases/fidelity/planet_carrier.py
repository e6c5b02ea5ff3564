"""A planet carrier with its pins: how far it winds up, and how far beams are from that."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: N m. Rated torque of the NREL 5 MW turbine: generator torque 43 093.55 N m at a ratio of 97
#: (Jonkman 2009, NREL/TP-500-38060, Table 1-1 and section 7).
RATED = 43_093.55 * 97.0
FACE_WIDTH = 0.491  # m, of the planets, by the tables that the component's file names


def run(run: Run) -> Any:
    """Climb the ladder with two walls, compare with one, export."""
    import numpy as np

    from fe_drivetrain.cases.fidelity import (
        component_page as page,
    )
    from fe_drivetrain.export import component_superelement
    from fe_drivetrain.fidelity import pin_motions, torque_share
    from fe_drivetrain.scene import CarrierComponent, change_component, library_component

    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    component = change_component(component, run.settings)
    if run.quick:
        component = page.coarser(component, page.QUICK)
    ladder = page.climb(run, component)

    def wind_up(model: Any) -> float:
        return pin_motions(component, model).wind_up if model.points else float("nan")

    def tilt(model: Any) -> float:
        return 1e12 * pin_motions(component, model).tilt if model.points else float("nan")

    def pin(axis: int) -> Any:
        """Force over motion at the middle of the first pin, along x, its circle or its radius."""

        def of(model: Any) -> float:
            if not model.points:
                return float("nan")
            row = 6 * model.points.index("pin_1") + axis
            return float(1.0 / model.compliance[row, row])

        return of

    quantities = [
        page.Quantity("wind-up of the pins about the hub", "N m/rad", wind_up),
        page.Quantity("tilt of a pin under torque", "µrad/(MN m)", tilt),
        page.Quantity("one pin, along its circle", "N/m", pin(1)),
        page.Quantity("one pin, along its radius", "N/m", pin(2)),
        page.Quantity("one pin, along x", "N/m", pin(0)),
    ]
    levels, verdict, sentence = page.ladder_section(ladder, quantities)
    body = component_superelement(component, solids=(ladder.solids[-1], ladder.solids[-2]))
    files, read_back = page.files_section(run, body)
    bands = [ladder.band(q.of) for q in quantities[:2]]
    more = []
    if not run.quick:
        if component.planet_carrier.walls == 2:
            more.append(_walls(run, component, ladder, bands))
        forces = np.zeros(len(ladder.top.compliance))
        forces[6:] = RATED * torque_share(component)
        said = f"Rated torque of {RATED:.4g} N m, shared alike by the pins; the flange is held"
        motions = ladder.top.compliance @ forces
        more.append(page.picture_section(run, ladder.solid, motions, said))
    top = pin_motions(component, ladder.top)
    skew = 1e6 * RATED * top.tilt * FACE_WIDTH
    return CASE.results(
        run,
        summary=[
            f"{sentence}.",
            f"The pins wind up by {1e3 * RATED / top.wind_up:.3g} mrad at the rated torque "
            f"(± {100 * bands[0].relative_uncertainty:.2g} %) and tilt by "
            f"{1e6 * RATED * top.tilt:.3g} µrad (± {100 * bands[1].relative_uncertainty:.2g} %): "
            f"{skew:.3g} µm over the planets' face width.",
            f"Beams between rigid cheeks are {_percent(ladder, wind_up):.3g} % too stiff in "
            f"wind-up, and {abs(_percent(ladder, tilt)):.3g} % off in tilt: the cheeks bend where "
            "hub, webs and pins stand on them, and only the solid knows that.",
        ],
        verdicts=[
            verdict,
            *_checks(ladder, component),
            page.rigid_verdict(body),
            read_back,
        ],
        sections=[levels, files, *more],
        figures={
            "wind-up": {m.title: wind_up(m) for m in ladder.models if m.points},
            "tilt at 1 N m": {m.title: 1e-12 * tilt(m) for m in ladder.models if m.points},
            "wind-up band": bands[0].uncertainty,
        },
        assumptions=page.assumption_rows(component),
    )


def _percent(ladder: Any, quantity: Any) -> float:
    """How far the frame is from the solid [%]."""
    return float(100 * (quantity(ladder.models[-2]) / quantity(ladder.top) - 1.0))


def _walls(run: Run, component: Any, ladder: Any, bands: Any) -> Any:
    """Two walls, with the bands of their wind-up and tilt, against pins on one."""
    from fe_drivetrain.cases.fidelity import (
        component_page as page,
    )
    from fe_drivetrain.fidelity import frame_level, pin_motions, solid_component, solid_level
    from fe_drivetrain.report import Section, Table, Text
    from fe_drivetrain.scene import change_component

    single = change_component(component, {"planet_carrier.walls": 1})
    with run.step("pins on one wall"):
        beams = frame_level(single)
        factors = (*page.COARSER, 1.0)
        meshed = [solid_component(page.coarser(single, factor)) for factor in factors]
        solids = [pin_motions(single, solid_level(single, solid)) for solid in meshed]
    sizes = [solid.sizes.edge for solid in meshed]
    own = [
        page.band_of(sizes, values)
        for values in ([s.wind_up for s in solids], [s.tilt for s in solids])
    ]
    rows: list[list[Any]] = [
        [2, "1 beams", *_row(pin_motions(component, ladder.models[-2]))],
        [2, "3 solid", *_row(pin_motions(component, ladder.top), bands)],
        [1, "1 beams", *_row(pin_motions(single, beams))],
        [1, "3 solid", *_row(solids[-1], own)],
    ]
    table = Table(
        caption="Pins between two cheeks, and standing on one; bands from three meshes each",
        columns=[
            "walls",
            "level",
            "wind-up [N m/rad]",
            "tilt at rated torque [µrad]",
            "over the face width [µm]",
            "wind-up ± [%]",
            "tilt ± [%]",
        ],
        rows=rows,
    )
    text = Text(
        text="With two walls a pin tilts because the rear cheek lags behind the front one, by what "
        "the webs give. On one wall it stands out as a cantilever, on a cheek that gives too."
    )
    return Section(title="Two walls or one", items=[text, table])


def _row(found: Any, bands: Any = None) -> list[Any]:
    tilt = RATED * found.tilt
    known = [None, None] if bands is None else [100 * b.relative_uncertainty for b in bands]
    return [found.wind_up, 1e6 * tilt, 1e6 * tilt * FACE_WIDTH, *known]


def _checks(ladder: Any, component: Any) -> list[Any]:
    """Symmetry of n planets, balance, recovered motions, and beams against their closed form."""
    import numpy as np

    from fe_drivetrain.beam import round_section
    from fe_drivetrain.cases.fidelity.component_page import (
        SOLVED,
        SOLVED_REASON,
    )
    from fe_drivetrain.fidelity import frame_level, pin_motions, torque_share
    from fe_drivetrain.interfaces import averaged_point
    from fe_drivetrain.mesh import MEANS, face_weights, turns
    from fe_drivetrain.report import judge
    from fe_drivetrain.scene import change_component, material_of

    top, carrier = ladder.top, component.planet_carrier
    rows = [6 * top.points.index(name) + np.arange(6) for name in component.loaded]
    first = top.compliance[np.ix_(rows[0], rows[0])]
    size = np.sqrt(np.diag(first))
    uneven = 0.0
    for row, Q in zip(rows, turns(carrier.planets), strict=True):
        turn = np.kron(np.eye(2), Q)
        own = turn.T @ top.compliance[np.ix_(row, row)] @ turn
        uneven = max(uneven, float(np.abs((own - first) / np.outer(size, size)).max()))
    share = torque_share(component)
    held = top.reaction_matrices["hub"][:, : len(share)] @ share

    # the motion of the first pin that the displacements of the solid have
    forces = np.zeros(len(top.compliance))
    forces[6:] = share
    motions = top.compliance @ forces
    mesh, u = ladder.solid.mesh, ladder.solid.displacements(motions)
    nodes = mesh.face_nodes("carrier.pin_1")
    weights = face_weights(mesh.points, mesh.faces["carrier.pin_1"], len(mesh.points), MEANS)
    position = np.array(carrier.pin_centres()[0])
    mean = averaged_point("pin", nodes, weights[nodes], mesh.points, position, u.size)
    recovered = float((mean.motion @ u.ravel())[1])

    # pins on one wall: cheek and hub turn, and cantilevers bend under an even load
    single = change_component(component, {"planet_carrier.walls": 1})
    material, radius = material_of(component), carrier.pin_circle_diameter / 2
    E, G = material.youngs_modulus, material.shear_modulus
    pin = round_section(carrier.pin_diameter, material.poisson_ratio)
    hub = round_section(carrier.hub_diameter, material.poisson_ratio, carrier.hub_bore_diameter)
    give = carrier.gap**3 / (20 * E * pin.inertias[0]) + carrier.gap / (3 * G * pin.shear_areas[0])
    closed = carrier.hub_length / (G * hub.torsion) + give / (carrier.planets * radius**2)
    beams = pin_motions(single, frame_level(single)).wind_up
    checks = [
        judge(
            "pins on one wall, as beams: wind-up",
            beams,
            1.0 / closed,
            tolerance=1e-3,
            unit="N m/rad",
            source="twist of the hub, and cantilevers with shear under an even load, "
            "l / GJ + (l^3/20EI + l/3kGA) / (n r^2)",
            reason="the load stands on the nodes of 8 pieces, by Simpson's rule",
            measure="stiffness",
        ),
        judge(
            "solid: stiffness of the pins, each in its own frame, largest difference",
            uneven,
            0.0,
            tolerance=SOLVED,
            relative=False,
            unit="-",
            source=f"the mesh is {carrier.planets} times the same sector",
            reason=SOLVED_REASON,
            measure="identity",
        ),
        judge(
            "solid: torque at the hub under 1 N m on the pins",
            float(held[3]),
            1.0,
            tolerance=SOLVED,
            unit="N m",
            source="equilibrium",
            reason=SOLVED_REASON,
            measure="reaction",
        ),
    ]
    if component.pins.coupling == "averaged":
        checks.append(
            judge(
                "solid: way of the first pin along its circle, from displacements",
                recovered,
                float(motions[7]),
                tolerance=SOLVED,
                unit="m",
                source="the condensed stiffness, which was found without them",
                reason=SOLVED_REASON,
                measure="identity",
            )
        )
    return checks


CASE = Case(
    name="fidelity/planet_carrier",
    title="Planet carrier with pins: wind-up and tilt, and how far beams are from them",
    source="first stage of the 5 MW reference gearbox (Nejad, Guo, Gao and Moan 2016); cheeks and "
    "webs assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
