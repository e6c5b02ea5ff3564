"""Stress below the flanks of the NREL 750 kW gearbox, and the constants of a line contact."""

from math import cos

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_meshes import own_meshes
from fe_drivetrain.cases.references.published_gears import nrel_750kw
from fe_drivetrain.dynamics.bodies.gear_pairs import STEELS
from fe_drivetrain.gear import (
    LineContact,
    LoadFactors,
    Pair,
    contact_stress,
    reduced_modulus,
    shear_stress,
    tooth_contact,
    von_mises,
)
from fe_drivetrain.report import gear_pair, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

STEEL = reduced_modulus()
TORQUE = 325e3  # N m of the low-speed shaft
PLANETS, STAGE = 3, 1.0 + 99.0 / 21.0
SOURCE = (
    "teeth, modules, helix angles and face widths of the GRC gearbox, NREL/TP-5000-47773 and 66594 "
    "as digested in gfsReboucas/Drivetrain; pressures recomputed independently from them"
)
HERTZ = "Hertz; Johnson 1985, Contact mechanics, section 4.2"


def meshes() -> dict[str, tuple[Pair, float, float, float]]:
    """By name: pair, force per face width [N/m], and what was recomputed [MPa, mm]."""
    pairs = nrel_750kw()
    sun, ring, second, third = (pairs[n] for n in ("sun", "ring", "intermediate", "high speed"))
    planet = TORQUE / (2 * PLANETS) / sun.centre_distance / cos(sun.working_angle)
    shaft = TORQUE / STAGE
    high = shaft * second.first.teeth / second.second.teeth
    return {
        "ring and planet": (ring, planet / ring.face_width, 484, 0.87),
        "sun and planet": (sun, planet / sun.face_width, 1070, 0.41),
        "intermediate": (
            second,
            shaft / second.second.base_radius / second.face_width,
            1123,
            0.46,
        ),
        "high speed": (third, high / third.second.base_radius / third.face_width, 1200, 0.28),
    }


def check_constants(page: Page, unit: LineContact) -> None:
    """Stress below a line contact, over its pressure and half width."""
    shear, depth = unit.max_shear
    mises, deep = unit.max_von_mises()
    for name, ours, exact in (
        ("largest shear stress over the pressure", shear / unit.pressure, 0.3003),
        ("its depth over the half width", depth / unit.half_width, 0.7862),
        ("largest von Mises stress over the pressure", mises / unit.pressure, 0.5575),
        ("depth of that over the half width", deep / unit.half_width, 0.704),
    ):
        page.equals(
            name,
            ours,
            exact,
            within=5e-4,
            why="the digits of the constant",
            source=HERTZ,
        )


def contact_rows(page: Page, found: dict[str, LineContact]) -> list[Record]:
    """Contact at the pitch point of each mesh, as recomputed from the publication."""
    rows: list[Record] = []
    for name, (mesh, load, pressure, at) in meshes().items():
        contact = found[name]
        rows.append(row_of(name, mesh, load, contact))
        page.equals(
            f"{name}: pressure at the pitch point [MPa]",
            contact.pressure / 1e6,
            pressure,
            within=0.5 / pressure + 2e-4,
            why="three or four digits, and a centre distance read from a drawing",
            source=SOURCE,
        )
        page.equals(
            f"{name}: depth of the largest shear stress [mm]",
            rows[-1]["depth of it [mm]"],
            at,
            within=0.005,
            relative=False,
            why="half of the last of the two digits that are printed",
            source=SOURCE,
        )
    return rows


def row_of(name: str, mesh: Pair, load: float, contact: LineContact) -> Record:
    """Contact of a mesh at the pitch point under a force per face width [N/m]."""
    return {
        "mesh": name,
        "load [kN/m]": load / 1e3,
        "radius [mm]": 1e3 * contact.radius,
        "half width [mm]": 1e3 * contact.half_width,
        "pressure [MPa]": contact.pressure / 1e6,
        "largest shear stress [MPa]": contact.max_shear[0] / 1e6,
        "depth of it [mm]": 1e3 * contact.max_shear[1],
        "working angle [deg]": float(np.degrees(mesh.working_angle)),
    }


def ratio_rows(found: dict[str, LineContact]) -> list[Record]:
    """Pressures of the fast meshes over the slow ones, beside those that the thesis prints."""
    highest = found["high speed"].pressure
    return [
        {
            "ratio": f"high speed over {name}",
            "ours, GRC": highest / found[name].pressure,
            "Al-Hamadani 2018, 2 MW": printed,
        }
        for name, printed in (
            ("ring and planet", PRINTED_RATIOS[0]),
            ("sun and planet", PRINTED_RATIOS[1]),
            ("intermediate", 1.22),
        )
    ]


@case(
    "Stress below the flanks of gears: NREL 750 kW at 325 kN m",
    source="Al-Hamadani 2018, Eq 5.13 to 5.22; Johnson 1985, Contact mechanics, ch. 4",
    settings={"drivetrain": "FILE, or a name of the library (otherwise the NREL 750 kW)"},
)
def run(run: Run, page: Page) -> None:
    """Constants of the field, pressures and depths of four meshes, ratios of the thesis."""
    if SETTING in run.settings:
        own(run, page)
        return
    unit = LineContact(1e6, 0.02, STEEL)
    check_constants(page, unit)
    found = {
        name: tooth_contact(mesh, mesh.path.pitch, load, STEEL)
        for name, (mesh, load, _, _) in meshes().items()
    }
    rows = contact_rows(page, found)
    answer(page, rows)
    page.section("Four meshes")
    show_path(page, {name: (mesh, load) for name, (mesh, load, _, _) in meshes().items()})
    page.table("Contact at the pitch point", rows)
    page.table(
        "Ratios of pressures, beside those that the thesis prints of its 2 MW gearbox",
        ratio_rows(found),
    )
    page.text(
        "The thesis's 2.32 and 1.32 make sun over ring "
        f"{PRINTED_RATIOS[0] / PRINTED_RATIOS[1]:.3f}. For its teeth (29, 58, "
        "145), equal forces and equal widths Hertz leaves exactly the root of 5, "
        f"{np.sqrt(5.0):.3f}: the printed ratios "
        "contradict each other. Its Eq 5.13, half the sum of curvatures, is 1 over a length; the "
        "half width of Eq 5.14 needs the radius 1 / (1/R1 + 1/R2). Its 0.57 for von Mises' stress "
        "belongs to a Poisson ratio of 0.28 rather than 0.3, where it is 0.5575."
    )
    show_field(page, unit)
    page.image("Sun and planet", run.sketch(*gear_pair(nrel_750kw()["sun"])))


def own(run: Run, page: Page) -> None:
    """Pressures and depths of the meshes of a user's drivetrain at its rated torque."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Stress below the flanks of gears at rated torque")
    found = own_meshes(chosen, page)
    unit = LineContact(1e6, 0.02, STEEL)
    with page.of(None):
        check_constants(page, unit)
    loaded: dict[str, tuple[Pair, float]] = {}
    rows: list[Record] = []
    for name, mesh in found.meshes.items():
        pair, torque = mesh.pair, found.train.torque * mesh.torque_ratio
        load = torque / pair.first.base_radius / pair.face_width
        loaded[name] = pair, load
        contact = tooth_contact(pair, pair.path.pitch, load, STEEL)
        rows.append(row_of(name, pair, load, contact))
        iso = contact_stress(pair, torque, LoadFactors(), STEELS)
        page.equals(
            f"{name}: pressure at the pitch point [MPa]",
            contact.pressure / 1e6,
            iso.nominal / (iso.Z_epsilon * iso.Z_beta) / 1e6,
            within=1e-9,
            why="two ways to Hertz's pressure: rounding",
            source="ISO 6336-2: Z_H Z_E of one pair of teeth along the whole face",
        )
    own_answer(page, rows, found.train.torque)
    page.section("Meshes")
    show_path(page, loaded)
    page.table("Contact at the pitch point", rows)
    show_field(page, unit)


def own_answer(page: Page, rows: list[Record], torque: float) -> None:
    """State which flank of a user's gears is pressed most, and how deep its shear stress is."""
    ranked = sorted(rows, key=lambda row: -float(row["pressure [MPa]"]))
    worst = ranked[0]
    page.answer(
        "How hard do the flanks of the gears press on each other, and how deep is the stress?",
        f"{worst['mesh']} presses most, with {value_text(float(worst['pressure [MPa]']), 'MPa')}; "
        f"its largest shear stress is {float(worst['depth of it [mm]']):.2g}\u00a0mm deep.",
        [
            *(
                page.value(f"contact pressure, {row['mesh']} [MPa]", float(row["pressure [MPa]"]))
                for row in ranked[:4]
            ),
            page.value(
                f"depth of the largest shear stress, {worst['mesh']} [mm]",
                float(worst["depth of it [mm]"]),
            ),
            page.value("rated torque of the rotor [kN m]", torque / 1e3),
        ],
        hero=HERO,
        cautions=[
            "One pair of teeth carries the whole load, evenly over the face: no load factors."
        ],
    )


HERO = "Contact pressure along the path of contact, one pair of teeth with the whole load"
PRINTED_RATIOS = (2.32, 1.32)
"""High speed over ring and over sun, as the thesis prints them of its 2 MW gearbox."""


def answer(page: Page, rows: list[Record]) -> None:
    """State which flank is pressed most, and that the thesis's ratios contradict each other."""
    worst = max(rows, key=lambda row: float(row["pressure [MPa]"]))
    printed, exact = PRINTED_RATIOS[0] / PRINTED_RATIOS[1], float(np.sqrt(5.0))
    fits = abs(printed / exact - 1.0) < 0.01  # three digits each
    pressure = value_text(float(worst["pressure [MPa]"]), "MPa")
    at = f"{TORQUE / 1e3:.0f}\u00a0kN\u00a0m"
    name = str(worst["mesh"]).replace("high speed", "high-speed")
    most = f"{name} flanks have the highest contact pressure, {pressure}"
    page.answer(
        f"Which flanks of the NREL 750 kW gearbox have the highest contact pressure at {at}?",
        f"The {most}; the thesis's ratios of pressures hold for equal forces."
        if fits
        else f"The {most}; for equal forces sun over ring is {exact:.3g}, not {printed:.3g} as the "
        "thesis prints.",
        [
            *(
                page.judged(
                    f"{row['mesh']}: pressure at the pitch point",
                    f"contact pressure, {row['mesh']}",
                    "recomputed",
                )
                for row in sorted(rows, key=lambda row: -float(row["pressure [MPa]"]))
            ),
            page.judged(
                f"{worst['mesh']}: depth of the largest shear stress",
                f"depth of the largest shear stress, {worst['mesh']}",
                "recomputed",
                "0.28",
            ),
            page.value(
                "ratio of pressures, sun to ring, equal forces and widths",
                exact,
                beside=printed,
                by="thesis",
            ),
        ],
        hero=HERO,
        cautions=[
            "One pair of teeth carries the whole load, evenly over the face: no load factors."
        ],
        claim="holds" if fits else "does not hold",
    )


def show_path(page: Page, loaded: dict[str, tuple[Pair, float]]) -> None:
    """Show the contact pressure of each mesh from the start to the end of its path.

    Parameters
    ----------
    page : Page
        The page.
    loaded : dict
        Pair and force per face width [N/m] by the name of the mesh.
    """
    share = np.linspace(0.0, 1.0, 41)
    curves = []
    for name, (mesh, load) in loaded.items():
        places = mesh.path.start + share * (mesh.path.end - mesh.path.start)
        pressures = [tooth_contact(mesh, at, load, STEEL).pressure / 1e6 for at in places]
        curves.append(trace(name, 100.0 * share, pressures))
    page.chart(HERO, curves, "way along the path of contact [%]", "contact pressure [MPa]")


def show_field(page: Page, unit: LineContact) -> None:
    """Stress below the surface, over the pressure."""
    page.section("Below the surface")
    z = np.linspace(0.01, 3.0, 120)
    field = unit.stresses(0.0, z * unit.half_width) / unit.pressure
    aside = unit.stresses(np.sqrt(0.75) * unit.half_width, z * unit.half_width) / unit.pressure
    page.chart(
        "Stress over the pressure below the middle of the strip, and shear at its side",
        [
            trace("largest shear stress", z, shear_stress(field)),
            trace("von Mises stress", z, von_mises(field)),
            trace("shear stress xz at x = 0.866 a", z, np.abs(aside[:, 3])),
        ],
        "depth over half width",
        "stress over pressure",
    )
