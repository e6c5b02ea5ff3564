"""Published stiffness of main shafts and drivetrains, by closed forms and by finite elements."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.cases import cases
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.report import trace
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    chain_frequencies,
    polar_moment,
    rod_frequency,
    solid_diameter,
    two_mass_frequencies,
)
from fe_drivetrain.validation.twisted_tubes import TwistedTube, material_of, twisted_tube

DIGITS = "half of the last published digit"
CLOSED_FORM = "closed form G J / L"
#: Least and largest shear modulus of steels [Pa].
USUAL_G = np.array([79.3e9, 80.8e9])
STEEL_DENSITY = 7850.0

STIFFNESS = "stiffness [N m/rad]"


@dataclass(frozen=True)
class MainShaft:
    """A uniform main shaft [m, Pa], its stiffness in closed form [N m/rad] and by elements."""

    outer: float
    inner: float
    length: float
    G: float
    closed: float
    found: TwistedTube


@cases("published_shafts.yaml")
def run(run: Run, page: Page, row: Mapping[str, Any]) -> None:
    """The shaft by finite elements, and what else is published of the turbine."""
    given = {key: value for key, (_, value, _, _) in row["inputs"].items()}
    given |= {key: row[key] for key in ("hawc2_x", "hawc2_polar") if key in row}
    shaft = twisted(run, given)
    page.section(row["heading"])
    show_inputs(page, *(tuple(line) for line in row["inputs"].values()))
    sources = {key: source for key, (_, _, _, source) in row["inputs"].items()}
    TURBINES[row["turbine"]](page, given, sources, shaft)
    if row.get("no_gearbox"):
        page.assume(
            "generator and hub",
            "rigid",
            "",
            "the turbine has no gearbox: the field would hold the generator's structure too, "
            "which is not published",
        )
    page.data("stiffness", shaft.found.stiffness)
    page.data("band", shaft.found.band)


def twisted(run: Run, given: Mapping[str, float]) -> MainShaft:
    """The main shaft of a turbine by finite elements."""
    outer, G = given["outer"], 1e9 * given["G"]
    inner = outer - 2 * given["wall"] if "wall" in given else 0.0
    length = given["length"] if "length" in given else given["to_bearing"] + given["between"]
    found = run.timed("mesh and solve", twisted_tube, outer, inner, length, G, run.quick)
    return MainShaft(outer, inner, length, G, G * polar_moment(outer, inner) / length, found)


def check_torsion(page: Page, name: str, found: TwistedTube, reference: float, source: str) -> None:
    """The stiffness by finite elements against a closed form or a published figure."""
    page.equals(
        name,
        found.stiffness,
        reference,
        within=found.tolerance,
        why=found.reason,
        source=source,
        unit="N m/rad",
        measure="stiffness",
        band=found.band,
    )


def check_digits(
    page: Page,
    name: str,
    computed: float,
    published: float,
    half: float,
    source: str,
    unit: str = "N m/rad",
    shown: str = "",
) -> None:
    """A closed form against a published stiffness, to half of its last digit."""
    page.equals(
        name,
        computed,
        published,
        within=half / published,
        why=f"{DIGITS}{shown}",
        source=source,
        unit=unit,
        measure="stiffness",
    )


def check_free_free(page: Page, by_eigenvalues: float, closed: float) -> None:
    """The free-free frequency of rotor and generator, by eigenvalues and in closed form."""
    page.vanishes(
        "free-free frequency by eigenvalues against the closed form",
        by_eigenvalues / closed - 1,
        within=1e-9,
        why="round-off of the eigenvalues of two masses: both are the same formula",
        source="sqrt(k (1 / J_rotor + 1 / n^2 J_generator)) / 2 pi",
        basis="self-consistency",
    )


def dtu_10mw(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """Two masses in closed form, by eigenvalues, and with the shaft's own inertia."""
    stiffness, rotor, polar = given["stiffness"], given["rotor"], given["polar"]
    generator = given["generator"] * given["ratio"] ** 2
    free, fixed = two_mass_frequencies(stiffness, rotor, generator)
    by_eigenvalues = float(chain_frequencies([rotor, generator], [stiffness])[1])
    held = float(chain_frequencies([rotor], [], stiffness)[0])
    own = STEEL_DENSITY * polar * shaft.length
    with_shaft = rod_frequency(stiffness, own, rotor, generator)
    for name, computed in (("free-free", free), ("free-fixed", fixed)):
        page.equals(
            f"{name} frequency, two masses",
            computed,
            given[name.replace("-", "_")],
            within=0.0005,
            relative=False,
            why=DIGITS,
            source=sources["stiffness"],
            unit="Hz",
            measure="frequency",
        )
    check_free_free(page, by_eigenvalues, free)
    page.vanishes(
        "free-fixed frequency by eigenvalues against the closed form",
        held / fixed - 1,
        within=1e-9,
        why="round-off of one eigenvalue: both are the same formula",
        source="sqrt(k / J_rotor) / 2 pi",
        basis="self-consistency",
    )
    check_digits(
        page,
        "stiffness from K G / L of the turbine's HAWC2 shaft",
        polar * shaft.G / shaft.length,
        stiffness,
        0.5,
        sources["stiffness"],
        shown=" (1 N m/rad)",
    )
    check_digits(
        page,
        f"polar moment of a solid shaft of {shaft.outer:g} m",
        polar_moment(shaft.outer),
        polar,
        0.5e-4,
        sources["polar"],
        unit="m^4",
    )
    page.equals(
        f"finite elements, solid shaft of {shaft.outer:g} m",
        shaft.found.stiffness,
        stiffness,
        within=shaft.found.tolerance + 0.5e-4 / polar,
        why=f"{shaft.found.per_turn} parabolic arcs round a turn, and {DIGITS} of K",
        source=sources["stiffness"],
        unit="N m/rad",
        measure="stiffness",
        band=shaft.found.band,
    )
    page.answer(
        f"Two masses give {free:.4f} Hz free-free and {fixed:.4f} Hz free-fixed, as published. "
        f"The stiffness is K G / L of a solid shaft of {shaft.outer:g} m over {shaft.length:g} m "
        "to its last digit; that shaft's own inertia would lower the first frequency by "
        f"{100 * (1 - with_shaft / free):.3f} %."
    )
    sweep = np.logspace(8.5, 11, 60)
    lines = np.array([two_mass_frequencies(k, rotor, generator) for k in sweep])
    published = [given["free_free"], given["free_fixed"]]
    page.chart(
        "Frequencies of the two masses by the stiffness between them",
        [
            trace("free-free", sweep, lines[:, 0]),
            trace("free-fixed", sweep, lines[:, 1]),
            trace("published", [stiffness] * 2, published, True, marker={"size": 10}),
        ],
        STIFFNESS,
        "frequency [Hz]",
        "xy",
    )
    page.table(
        "Frequencies [Hz]",
        [
            ["free-free", free, by_eigenvalues, published[0]],
            ["free-fixed (generator held)", fixed, held, published[1]],
            ["free-free with the shaft's inertia", with_shaft, None, None],
        ],
        ["case", "closed form", "eigenvalues", "published"],
    )
    page.text(
        "The IEA 10 MW turbine's OpenFAST model holds the same stiffness, rounded: see that case."
    )
    page.assume("density of the shaft", STEEL_DENSITY, "kg/m^3", "steel")
    page.data("free_free", free)
    page.data("free_fixed", fixed)


def iea_10(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The tube, and what other descriptions of it would give."""
    found, placeholder = shaft.found, given["placeholder"]
    G, length = 1e9 * given["dtu_G"], given["dtu_length"]
    x, polar = np.array(given["hawc2_x"]), np.array(given["hawc2_polar"])
    # 1 / K is integrated exactly where K is linear
    steps, slope = np.diff(x), np.diff(polar) / np.diff(x)
    level = np.abs(slope) < 1e-12
    flexibility = np.where(
        level,
        steps / polar[:-1],
        np.log(polar[1:] / polar[:-1]) / np.where(level, 1.0, slope),
    )
    low, high = shaft.closed * USUAL_G / shaft.G
    check_torsion(page, "finite elements, tube over 3.0 m", found, shaft.closed, CLOSED_FORM)
    check_digits(
        page,
        "what the placeholder is: K G / L of the DTU 10 MW turbine's shaft",
        G * given["dtu_polar"] / length,
        placeholder,
        500.0,
        sources["placeholder"],
        shown=" (1000 N m/rad)",
    )
    page.answer(
        f"DTTorSpr for the main shaft alone: {found.stiffness:.4g} N m/rad (numerical band "
        f"± {found.band:.1g}; {low:.4g} to {high:.4g} for any usual G). The published "
        f"{placeholder:.4g} is the DTU 10 MW turbine's, carried over, and "
        f"{found.stiffness / placeholder:.1f} times softer."
    )
    descriptions = {
        "finite elements, 3.0 m, wall 0.1 m, over 3.0 m": found.stiffness,
        "closed form of it": shaft.closed,
        "closed form, G = 79.3 GPa": low,
        "closed form, G = 80.8 GPa": high,
        "WISDEM's later shaft, 2.5 m, wall 0.1 m, over 1.0 + 1.2 m": (
            shaft.G * polar_moment(2.5, 2.3) / 2.2
        ),
        "the turbine's HAWC2 shaft, by its sections over 5.4 m": G / flexibility.sum(),
        "placeholder in the OpenFAST model": placeholder,
    }
    page.table(
        "Torsional stiffness by description of the shaft",
        [
            {"shaft": name, STIFFNESS: k, "over the placeholder": k / placeholder}
            for name, k in descriptions.items()
        ],
    )
    fine = np.linspace(0.0, x[-1], 400)
    along = np.interp(fine, x, polar)
    twist = np.cumsum(np.diff(fine) / (G * 0.5 * (along[1:] + along[:-1])))
    load = 1e3 * 1e7  # 10 MN m, in mrad
    page.chart(
        "Twist along the shaft under 10 MN m, from the gearbox-less generator's end: the tube, "
        "and the sections of the turbine's HAWC2 model",
        [
            trace("HAWC2 sections", fine, load * np.concatenate([[0.0], twist])),
            trace("tube", [0.0, shaft.length], [0.0, load / shaft.closed]),
            trace("placeholder", [0.0, length], [0.0, load / placeholder]),
        ],
        "x [m]",
        "twist [mrad]",
    )
    page.text(
        "The descriptions differ by far more than any numerical band: what counts as the shaft, "
        "from where to where, decides. The HAWC2 sections include the thin tube between bearing "
        "and generator, and hold most twist there."
    )


def iea_15(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """Closed form, finite elements, and the arithmetic behind the HAWC2 shaft."""
    found, published, earlier = shaft.found, given["published"], given["earlier"]
    polar, G = given["polar"], 1e9 * given["hawc2_G"]
    section, body = given["section_length"], given["body_length"]
    J = polar_moment(shaft.outer, shaft.inner)
    as_filed, as_run = G * polar / section, G * polar / body
    ratio = as_filed / published
    check_digits(
        page,
        "G J / L of the tube",
        shaft.closed,
        published,
        50.0,
        sources["published"],
        shown=" (100 N m/rad)",
    )
    check_torsion(page, "finite elements", found, published, sources["published"])
    check_digits(
        page,
        "the same tube over 3.0 m",
        shaft.G * J / 3.0,
        earlier,
        5.0,
        f"DTTorSpr of an earlier release: {sources['earlier']}",
        shown=" (10 N m/rad)",
    )
    check_digits(
        page,
        "I_p of the HAWC2 shaft from DTTorSpr times length over G",
        earlier * body / G,
        polar,
        0.5e-4,
        f"{sources['polar']}: 'I_p = DTTorSpr*ShftLen/G'; length of the body in "
        f"{sources['body_length']}",
        unit="m^4",
    )
    page.equals(
        "I_p that the OpenFAST figure needs over the section file's length",
        published * section / G,
        4.5008,
        within=0.5e-4 / 4.5008,
        why=DIGITS,
        source="a list of reference values (second-hand: its own source was not read)",
        unit="m^4",
        measure="stiffness",
        basis="second-hand",
    )
    page.equals(
        "HAWC2 shaft as filed over the OpenFAST figure",
        ratio,
        (shaft.length / 3.0) * (body / section),
        within=0.5e-4 / polar + 1e-8,
        why=f"{DIGITS} of I_p",
        source="2.2 m over 3.0 m, times 6.130 m over 5.118 m",
        unit="-",
        measure="stiffness",
    )
    page.answer(
        f"The published {published:,.0f} N m/rad is G J / L of a tube of 3.0 m, wall 0.1 m, "
        f"over 2.2 m; finite elements give {found.stiffness:,.0f} (± {found.band:.1g}).",
        f"The HAWC2 shaft is {100 * (1 - ratio):.1f} % softer for two reasons of length: its "
        "I_p was made from an earlier OpenFAST figure, of the same tube over 3.0 m (factor "
        f"{shaft.length / 3:.4f}), for a body of 6.130 m, and is filed with a section of 5.118 m "
        f"(factor {body / section:.4f}). Over the length of its body, it is "
        f"{100 * (1 - as_run / published):.1f} % softer.",
    )
    page.table(
        "Torsional stiffness of the main shaft",
        [
            {"model": name, STIFFNESS: k, "over OpenFAST today": k / published, "what": what}
            for name, k, what in (
                ("OpenFAST, today", published, "G J over 1.0 + 1.2 m"),
                ("OpenFAST, earlier", earlier, "G J over 3.0 m"),
                ("HAWC2, length of the body file", as_run, "the earlier figure again"),
                ("HAWC2, length of the section file", as_filed, "the same I_p over 5.118 m"),
                ("finite elements, 2.2 m", found.stiffness, "three meshes"),
            )
        ],
    )
    page.chart(
        "Finite elements against G J / L by elements round a turn",
        [
            trace(
                "three meshes",
                [1 / s for s in found.series.sizes],
                [abs(v / shaft.closed - 1) for v in found.series.values],
                marker={"size": 9},
            )
        ],
        "elements round a turn",
        "relative error",
        "xy",
    )
    page.text(
        f"I_p of the tube itself is {J:.4f} m^4; the HAWC2 figure is an equivalent that carries a "
        "stiffness, not a section. It serves one length and one G only. A further version of the "
        "model (commit d77070a) has a body of 5.168 m."
    )


def iea_22(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The thin tube by finite elements and by its closed forms."""
    found, wall, G, length = shaft.found, given["wall"], shaft.G, shaft.length
    placeholder, earlier = given["placeholder"], given["earlier"]
    radius = (shaft.outer - wall) / 2
    thin = float(G * 2 * np.pi * radius**3 * wall / length)
    tube = solid_shafts.straight((0.0, length), shaft.outer, shaft.inner)
    by_meridian = float(end_stiffness(tube, material_of(G))[9, 9])
    low, high = shaft.closed * USUAL_G / G
    page.equals(
        "G J / L of the tube",
        shaft.closed,
        earlier,
        within=1e-9,
        why="the same formula with the same inputs, all digits given: round-off",
        source=sources["earlier"],
        unit="N m/rad",
        measure="stiffness",
    )
    check_torsion(page, "finite elements", found, earlier, sources["earlier"])
    page.equals(
        "Fourier harmonics in the meridian",
        by_meridian,
        shaft.closed,
        within=1e-8,
        why="the angle of twist is linear, which the elements hold exactly: round-off",
        source=CLOSED_FORM,
        unit="N m/rad",
        measure="stiffness",
    )
    page.equals(
        "thin-walled formula 2 pi G r^3 t / L",
        thin,
        shaft.closed,
        within=(wall / radius) ** 2,
        why="it leaves out terms of the square of wall over radius",
        source=CLOSED_FORM,
        unit="N m/rad",
        measure="stiffness",
    )
    page.answer(
        f"DTTorSpr for the main shaft alone: {found.stiffness:.5g} N m/rad (numerical band "
        f"± {found.band:.1g}; {low:.4g} to {high:.4g} for any usual G). The released model holds "
        f"{placeholder:.0e} with the degree of freedom off, {placeholder / found.stiffness:.0f} "
        f"times as much; one before it held {earlier:,.0f}, which is G J / L to round-off."
    )
    page.table(
        "Torsional stiffness",
        [
            {"by": name, STIFFNESS: k, "over G J / L": k / shaft.closed}
            for name, k in (
                ("finite elements", found.stiffness),
                ("meridian", by_meridian),
                ("G J / L", shaft.closed),
                ("thin-walled formula", thin),
                ("earlier release", earlier),
                ("placeholder", placeholder),
            )
        ],
    )
    walls = np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.3])
    by_wall = [G * polar_moment(shaft.outer, shaft.outer - 2 * w) / length for w in walls]
    page.chart(
        "G J / L of the shaft by its wall, and what other walls would give",
        [
            trace("G J / L", walls, by_wall),
            trace("finite elements", [wall], [found.stiffness], True, marker={"size": 10}),
            trace("placeholder", walls[[0, -1]], [placeholder] * 2),
        ],
        "wall [m]",
        STIFFNESS,
        "xy",
    )
    page.text(
        "A wall of 20 mm on 3.1 m is thin enough to buckle or ovalise before it yields; torsion "
        "between rigid ends knows nothing of that."
    )


def nrel_5mw(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The shaft beside the published stiffness of the whole drivetrain."""
    found, G, length = shaft.found, shaft.G, shaft.length
    stiffness, rotor = given["stiffness"], given["rotor"]
    high = G * polar_moment(given["high"]) / given["high_length"] * given["wisdem_ratio"] ** 2
    series = 1 / (1 / shaft.closed + 1 / high)
    generator = given["generator"] * given["ratio"] ** 2
    both = rotor * generator / (rotor + generator)
    free, fixed = two_mass_frequencies(stiffness, rotor, generator)
    soft, _ = two_mass_frequencies(series, rotor, generator)
    length_needed = G * polar_moment(shaft.outer) / stiffness
    diameter_needed = solid_diameter(stiffness * length / G)
    page.equals(
        "damping ratio of the free-free mode",
        float(given["damping"] / (2 * np.sqrt(stiffness * both))),
        0.05,
        within=0.0005,
        relative=False,
        why="the published 5 % to two figures",
        source="Jonkman et al. 2009, NREL/TP-500-38060, section 5: stiffness and damping for 5 % "
        "(second-hand: the section itself was not read)",
        unit="-",
        measure="frequency",
        basis="second-hand",
    )
    check_free_free(page, float(chain_frequencies([rotor, generator], [stiffness])[1]), free)
    check_torsion(page, "finite elements, low-speed shaft alone", found, shaft.closed, CLOSED_FORM)
    page.answer(
        f"The main shaft in WISDEM's model, {shaft.outer:g} m over {length:.2f} m, has "
        f"{found.stiffness:.4g} N m/rad alone (± {found.band:.1g}): "
        f"{stiffness / shaft.closed:.2f} times softer than the {stiffness:,.0f} that the "
        "aeroelastic model has for the whole drivetrain. So the two do not belong to one machine: "
        f"the published figure would need that shaft to be {length_needed:.2f} m long, or "
        f"{diameter_needed:.2f} m thick, with all else rigid."
    )
    page.table(
        "Stiffness, on the rotor's side",
        [
            {"part": name, STIFFNESS: k, "over the published": k / stiffness}
            for name, k in (
                ("published, whole drivetrain", stiffness),
                ("low-speed shaft, G J / L", shaft.closed),
                ("low-speed shaft, finite elements", found.stiffness),
                ("high-speed shaft, G J n^2 / L", high),
                ("both in series, as WISDEM does", series),
            )
        ],
    )
    page.table(
        "Free-free frequency of rotor and generator",
        [
            {"stiffness": name, "frequency [Hz]": frequency}
            for name, frequency in (
                ("published", free),
                ("WISDEM's shafts in series", soft),
                ("published, generator held", fixed),
            )
        ],
    )
    diameters = np.linspace(0.4, 1.2, 60)
    page.chart(
        "Stiffness of a solid main shaft by its diameter, for several lengths, beside the "
        "published figure of the drivetrain",
        [
            *(
                trace(f"{L:g} m", diameters, [G * polar_moment(d) / L for d in diameters])
                for L in (1.0, 2.28, 4.0)
            ),
            trace("published", diameters[[0, -1]], [stiffness] * 2),
            trace("finite elements", [shaft.outer], [found.stiffness], True, marker={"size": 10}),
        ],
        "diameter [m]",
        STIFFNESS,
        "y",
    )
    page.text(
        "A shaft can only be softer than all of itself: compliances add. With the published "
        "figure and a shaft that takes half of the compliance, it would be "
        f"{solid_diameter(2 * stiffness * length / G):.2f} m thick over {length:.2f} m. Gearbox "
        "and generator have the other half then; no published split is known."
    )
    page.assume(
        "bore of the low-speed shaft",
        "none",
        "",
        "a wall of 0.288 m leaves 1 mm of 0.577 m: 1e-11 of J",
    )


TURBINES: dict[str, Callable[[Page, Mapping[str, Any], Record, MainShaft], None]] = {
    "dtu_10mw": dtu_10mw,
    "iea_10": iea_10,
    "iea_15": iea_15,
    "iea_22": iea_22,
    "nrel_5mw": nrel_5mw,
}
