"""A shaft that turns round a standing nose: two cantilevers, one inside the other."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report import shaft_with_rings, trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.beam import cowper_shear_coefficient
from fe_drivetrain.shafts.fidelity import shaft_level

#: Outer and inner diameters [m].
SHAFT, NOSE = (3.0, 2.6), (2.2, 1.8)
#: Hub to the first bearing, on to the second, and from the first to the nose's fixed end [m].
FRONT, SPAN, ROOT = 1.0, 1.2, 3.0
WIDTH = 0.3
RADIAL = [0, "rigid", "rigid", 0, 0, 0]
LEVELS = {1: "beam", 2: "meridian", 3: "solid"}
BY_LENGTH = "Deflection of the hub over that of the closed form, by the length of the tubes"
CLOSED = "closed form [nm/N]"


def scene_of(times: float, size: float) -> Scene:
    """The same tubes, all lengths so many times as long."""
    tubes = [
        {"outer_diameter": outer, "inner_diameter": inner, "length": length}
        for (outer, inner), length in (
            (SHAFT, times * (FRONT + SPAN) + WIDTH),
            (NOSE, WIDTH + times * ROOT),
        )
    ]
    bearings = [
        {"name": name, "x": x, "width": WIDTH, "stiffness": stiffness}
        for name, x, stiffness in (
            ("upwind", 0.0, ["rigid", *RADIAL[1:]]),
            ("downwind", times * SPAN, RADIAL),
        )
    ]
    return Scene.model_validate(
        {
            "title": "shaft on a nose",
            "shaft": {"front": -times * FRONT, "sections": [tubes[0]]},
            "nose": {"body": {"front": -WIDTH, "sections": [tubes[1]]}, "bearings": bearings},
            "gearbox": {"stiffness": [0, 0, 0, "rigid", 0, 0]},
            "mesh": {"shaft": size, "elements_per_turn": 16},
        }
    )


def rigidities(scene: Scene, outer: float, inner: float) -> tuple[float, float]:
    """Bending and shear rigidity of a tube [N m^2, N]."""
    steel = scene.material_of("shaft")
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    shear = float(cowper_shear_coefficient(nu, inner / outer)) * E / (2 * (1 + nu))
    second, area = np.pi / 64 * (outer**4 - inner**4), np.pi / 4 * (outer**2 - inner**2)
    return E * second, shear * area


def closed_form(scene: Scene, times: float) -> float:
    """Deflection of the hub for 1 N there: a beam with an overhang, on two points of another."""
    front, span, root = times * FRONT, times * SPAN, times * ROOT
    lever = front / span
    EI, kGA = rigidities(scene, *SHAFT)
    own = front**2 * (span + front) / (3 * EI) + (front + lever**2 * span) / kGA
    EI, kGA = rigidities(scene, *NOSE)
    arms = np.array([root, root - span])
    short, long = np.minimum.outer(arms, arms), np.maximum.outer(arms, arms)
    softness = short**2 * (3 * long - short) / (6 * EI) + short / kGA
    shares = np.array([1 + lever, -lever])
    return float(own + shares @ softness @ shares)


def hub_compliance(scene: Scene, level: int) -> float:
    """Deflection of the hub for 1 N there [m/N]."""
    model = shaft_level(scene, level)
    row = 6 * model.points.index("hub") + 2
    return float(model.compliance[row, row])


def solve_lines(run: Run) -> list[Record]:
    """Deflection of the hub by beam and meridian, over the lengths."""
    rows: list[Record] = []
    for times in (1.0, 4.0) if run.quick else (1.0, 2.0, 4.0, 8.0):
        scene = scene_of(times, 0.5)
        row: Record = {"lengths times": times, CLOSED: 1e9 * closed_form(scene, times)}
        for level in (1, 2):
            name = f"{LEVELS[level]} [nm/N]"
            row[name] = 1e9 * run.timed(LEVELS[level], hub_compliance, scene, level)
            row[f"{LEVELS[level]} over closed form - 1 [%]"] = 100 * (row[name] / row[CLOSED] - 1)
        rows.append(row)
    return rows


def check(page: Page, rows: list[Record], solid: float) -> None:
    """The beam is exact, slender tubes are beams, and the solid [nm/N] has the meridian's value."""
    short, slender = rows[0], rows[-1]
    for row in rows:
        page.equals(
            f"beam, lengths times {row['lengths times']:g}: deflection of the hub",
            row["beam [nm/N]"],
            row[CLOSED],
            within=1e-9,
            why="both are exact for Timoshenko beams: round-off",
            source="a beam with an overhang on two points of a cantilever, with shear",
            unit="nm/N",
        )
    page.equals(
        f"meridian, lengths times {slender['lengths times']:g}: deflection of the hub",
        slender["meridian [nm/N]"],
        slender[CLOSED],
        within=0.005,
        why="slender tubes are beams, but for what seats of a width do to them",
        source="the same closed form",
        unit="nm/N",
    )
    page.equals(
        "solid, lengths as they are: deflection of the hub",
        solid,
        short["meridian [nm/N]"],
        within=0.01,
        why="tetrahedra of second order in a thin wall are too stiff by tenths of a percent",
        source="the meridian, elements of order 6 graded to seats and ends",
        unit="nm/N",
    )


def answer(page: Page, short: Record, slender: Record) -> None:
    """State how far beams are from the tubes, short and slender."""
    less = [1 - row["beam [nm/N]"] / row["meridian [nm/N]"] for row in (short, slender)]
    times = f"{slender['lengths times']:g}"
    can = "They cannot" if less[0] > 0.01 else "They can"
    page.answer(
        "Can the short, wide tubes of a direct drive's shaft and nose be modelled as beams?",
        f"{can}: with beams the hub deflects {percent_text(less[0], 3)} less than in an "
        f"axisymmetric model; if the tubes are {times} times as long, {percent_text(less[1])} "
        "less.",
        [
            page.judged(
                "solid, lengths as they are: deflection of the hub",
                "deflection of the hub under 1 N, solid",
                "meridian",
            ),
            page.value(
                "deflection of the hub under 1 N, beams [nm/N]",
                short["beam [nm/N]"],
                beside=short["meridian [nm/N]"],
                by="meridian",
            ),
            page.value("deflection of beams too small by [%]", 100 * less[0]),
            page.value(
                f"deflection of beams too small by, {times} times the lengths [%]", 100 * less[1]
            ),
        ],
        hero=BY_LENGTH,
    )


@case(
    "A shaft round a standing nose: two coaxial cantilevers",
    source="Timoshenko beams in closed form; arrangement of direct drives as the IEA 15 MW turbine",
)
def run(run: Run, page: Page) -> None:
    """Lengths grow, so that the tubes become slender; the solid is there for the shortest."""
    rows = solve_lines(run)
    short, slender = rows[0], rows[-1]
    sizes = (0.5, 0.4) if run.quick else (0.5, 0.4, 0.3)
    solids = [1e9 * run.timed("solid", hub_compliance, scene_of(1.0, size), 3) for size in sizes]
    check(page, rows, solids[-1])
    answer(page, short, slender)
    page.section("Deflection of the hub")
    page.table("For 1 N at the hub: shaft and nose together", rows)
    times = column(rows, "lengths times")
    ratios = {
        name: [row[f"{name} [nm/N]"] / row[CLOSED] for row in rows]
        for name in (LEVELS[1], LEVELS[2])
    }
    page.chart(
        BY_LENGTH,
        [trace(name, times, ratio, marker={"size": 9}) for name, ratio in ratios.items()],
        "lengths, over those of the arrangement",
        "deflection over closed form",
        "x",
    )
    page.table(
        "The solid, all lengths as they are",
        list(zip(sizes, solids, strict=True)),
        ["mesh size [m]", "solid [nm/N]"],
    )
    page.image(
        "The shaft, its bearings and the nose that they stand on",
        run.sketch(*shaft_with_rings(scene_of(1.0, 0.5))),
    )
