"""Stiffness of spur teeth over the phase: formulas, potential energy, plane finite elements."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import degrees

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_meshes import given_meshes
from fe_drivetrain.cases.gear.plane_teeth import (
    DEPTH,
    MeshedPair,
    compliances,
    mesh_teeth,
    meshed_pair,
    pressed_surface,
)
from fe_drivetrain.cases.references.plane_rings import Plane, plane_strain
from fe_drivetrain.cases.references.published_gears import nrel_5mw
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.gear import (
    Gear,
    IsoStiffness,
    Pair,
    Steel,
    cai_law,
    constant_law,
    contact_depths,
    contact_half_width,
    energy_law,
    iso_gear_stiffness,
    kuang_yang_law,
    meshing_without_backlash,
    parabolic_law,
)
from fe_drivetrain.report import gear_pair, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

STEEL = Steel()
STRAIN = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
STRESS = Plane(STEEL.youngs_modulus, STEEL.poisson_ratio)
LOAD = 5e5  # N/m of face
STIFFNESS_RATIO = 0.8
COARSE, FINE, QUICK_FINE = 0.2, 0.08, 0.15  # modules
DEPTHS = (DEPTH, 2.0 * DEPTH, 1.0)

#: Hubs over root circles, and loads [N/m], between which gears are: softest and stiffest.
SOFTEST, STIFFEST = (0.35, 1e5), (0.7, 1e6)

HUB = 0.5
"""Radius over the root radius at which gears of a user are held."""

#: Pairs, and the radii where the gears are held [m].
PAIRS: dict[str, tuple[Callable[[], Pair], tuple[float, float]]] = {
    "20 and 40 teeth": (
        lambda: meshing_without_backlash(Gear(20, 1e-2, 0.1), Gear(40, 1e-2, 0.1)),
        (0.04, 0.09),
    ),
    "sun and planet of stage 2, NREL 5 MW": (lambda: nrel_5mw()["sun 2"], (0.08, 0.2)),
}
COUPLED, PLANE_STRESS = "elements, coupled", "elements, plane stress"
ELEMENTS = "plane finite elements of the true tooth shape"


@case(
    "Stiffness of spur teeth over the phase, by formulas, energy and finite elements",
    source="ISO 6336-1:2006; Sainsot, Velex, Duverger 2004; Weber, Banaschek 1953; Cai 1995 and "
    "Kuang, Yang 1992 from memory",
    alone="full",
    settings={"drivetrain": "FILE, or a name of the library (otherwise two pairs of spur gears)"},
)
def run(run: Run, page: Page) -> None:
    """Compute each method's stiffness over a period, its error against elements, and its time."""
    steps = 8 if run.quick else 24
    if SETTING in run.settings:
        own(run, page, steps)
        return
    found = [
        one_pair(run, page, name, make(), hubs, steps)
        for name, (make, hubs) in list(PAIRS.items())[: 1 if run.quick else None]
    ]
    explain(page)
    answer(page, dict(zip(PAIRS, found, strict=False)))
    page.image("The first of the pairs", run.sketch(*gear_pair(next(iter(PAIRS.values()))[0]())))


def explain(page: Page) -> None:
    """Say what the elements are, and which formulas are from memory."""
    page.text(
        "Finite elements are quadratic triangles in plane strain, of a whole gear held at its hub "
        "with four teeth, two of which are loaded. A concentrated load has no finite displacement "
        "below it: elements give the motion of a point on the line of action at a depth, and half "
        "planes under Hertz's pressure what is between it and the surface. Elements small against "
        "the contact, with the pressure on them, check that: the error goes with the depth. Weber "
        "and Banaschek take the tooth's centre line; here it is three tenths of the way. Two "
        "pairs in contact press on the same gear bodies, so that each is softer than alone: the "
        "sum of single pairs, which all formulas take, is too stiff."
    )
    page.text(
        "Formulas of Cai and of Kuang and Yang stand as remembered: their papers were not at hand. "
        "Cai's is meant for helical gears, that of Kuang and Yang has no contact in it. The "
        "parabola has 14 N/(mm µm), as Al-Hamadani 2018 has it, and a stiffness ratio of 0.8, "
        "which that thesis does not state. ISO 6336-1 takes solid discs here (C_R = 1)."
    )


def own(run: Run, page: Page, steps: int) -> None:
    """Stiffness of the external spur meshes of a user's drivetrain.

    Raises
    ------
    InputError
        The drivetrain has no such mesh.
    """
    chosen = run.drivetrain("", gears=True)
    chosen.state(page)
    meshes = given_meshes(chosen, machine_of(chosen.drivetrain), {}, page)
    pairs = {name: mesh.pair for name, mesh in meshes.items() if is_plane(mesh.pair)}
    if not pairs:
        helices = ", ".join(
            f"{name} {abs(degrees(mesh.pair.first.helix)):.3g}°" for name, mesh in meshes.items()
        )
        raise InputError(
            f"drivetrain {chosen.name!r} has no mesh that this case can take: plane elements need "
            "two external gears without a helix whose contact ratio is below 2; its meshes have a "
            f"helix of {helices}"
        )
    left = [name for name in meshes if name not in pairs]
    if left:
        page.note(
            "Left out, since plane elements need external spur gears of a contact ratio below 2: "
            f"{', '.join(left)}."
        )
    found = {
        name: one_pair(run, page, name, pair, hubs_of(pair), steps)
        for name, pair in list(pairs.items())[: 1 if run.quick else None]
    }
    explain(page)
    page.assume("hubs that hold the gears", HUB, "of the root radius", "of the case")
    page.assume("load", LOAD / 1e3, "N/mm of face", "of the case")
    answer(page, found)


def is_plane(pair: Pair) -> bool:
    """Whether plane elements with at most two pairs in contact can stand for a pair."""
    spur = not pair.first.helix and not pair.internal
    return spur and 1.0 < pair.transverse_ratio < 2.0


def is_kuang_yang(pair: Pair) -> bool:
    """Whether both gears have the numbers of teeth to which their formula was fitted."""
    return all(12.0 <= gear.virtual_teeth <= 100.0 for gear in (pair.first, pair.second))


def hubs_of(pair: Pair) -> tuple[float, float]:
    """Radii where the gears are held, in the middle of those between which gears are [m]."""
    return HUB * pair.first.root_radius, HUB * pair.second.root_radius


def hero(name: str) -> str:
    """Caption of the chart of errors against time of a pair."""
    return f"{name}: error against fine coupled elements, and time"


def answer(page: Page, found: dict[str, list[Record]]) -> None:
    """State how far the standard's and other formulas are from finite elements."""
    errors = {
        name: {str(row["method"]): float(row["error of the mean [%]"]) for row in rows}
        for name, rows in found.items()
    }
    name = next(iter(found))
    of = errors[name]
    fine = next(row for row in found[name] if row["method"] == COUPLED)
    mean = float(fine["mean [N/(mm µm)]"]) / (1.0 + of[COUPLED] / 100.0)
    iso, energy, apart = "ISO 6336-1, mean c_gamma", "energy, line contact", "elements, pairs apart"
    words = {
        key: f"{abs(of[key]):.2g}\u00a0% {'more' if of[key] > 0.0 else 'less'}"
        for key in (iso, energy)
    }
    page.answer(
        "How far are formulas of mesh stiffness from finite elements of the teeth?",
        f"With {name}, ISO 6336-1 gives {words[iso]} mesh stiffness than finite elements; the "
        f"energy method with line contact gives {words[energy]}.",
        [
            page.value(f"mean stiffness by elements, {name} [N/(mm µm)]", mean),
            *(
                page.value(f"{method}: difference of the mean, {pair} [%]", values[key])
                for pair, values in list(errors.items())[:2]
                for method, key in (("ISO 6336-1", iso), ("energy method", energy))
            ),
            page.value(f"uncoupled pairs of teeth: difference of the mean, {name} [%]", of[apart]),
        ],
        hero=hero(name),
        cautions=[
            "The standard does not account for hub or load: finite elements with other hubs and "
            "loads lie on both sides of it.",
            "The formulas of Cai and of Kuang and Yang are from memory: their papers were not "
            "available.",
        ],
    )


def summed(stiffness: Floats, steps: int) -> Floats:
    """Stiffness of single pairs at all places, added up over the phases of a period."""
    total = stiffness[:steps].copy()
    total[: len(stiffness) - steps] += stiffness[steps:]
    return total


def methods_of(
    pair: Pair, hubs: tuple[float, float], places: Floats, steps: int
) -> dict[str, Callable[[], Floats]]:
    """Mesh stiffness over the phases by each method, cheap to expensive."""
    iso = iso_gear_stiffness(pair)

    def elements(plane: Plane, coupled: bool) -> Floats:
        return meshed_pair(pair, hubs, plane, STEEL, steps, COARSE).mesh(LOAD, coupled)

    return {
        "ISO 6336-1, mean c_gamma": lambda: np.full(steps, iso.mesh),
        "ISO 6336-1, c' of each pair": lambda: summed(constant_law(iso.single)(places), steps),
        "parabola, 14 N/(mm µm)": lambda: summed(
            parabolic_law(pair, STIFFNESS_RATIO)(places), steps
        ),
        "Cai, c' of ISO": lambda: summed(cai_law(pair, iso.single)(places), steps),
        **(
            {"Kuang and Yang": lambda: summed(kuang_yang_law(pair)(places), steps)}
            if is_kuang_yang(pair)
            else {}
        ),
        "energy, contact of Yang and Sun": lambda: summed(energy_law(pair, hubs)(places), steps),
        "energy, line contact": lambda: summed(energy_law(pair, hubs, LOAD)(places), steps),
        "elements, pairs apart": lambda: elements(STRAIN, False),
        PLANE_STRESS: lambda: elements(STRESS, True),
        COUPLED: lambda: elements(STRAIN, True),
    }


def one_pair(
    run: Run, page: Page, name: str, pair: Pair, hubs: tuple[float, float], steps: int
) -> list[Record]:
    """All methods on one pair: checks, charts, and error and time of each."""
    with run.step(f"{name}: fine elements"):
        fine = meshed_pair(pair, hubs, STRAIN, STEEL, steps, QUICK_FINE if run.quick else FINE)
    exact = fine.mesh(LOAD)
    weights = shares_of_time(pair, len(fine.places), steps)
    mean = float(weights @ exact)
    methods = methods_of(pair, hubs, fine.places, steps)
    if run.quick:
        methods.pop(PLANE_STRESS)
    rows: list[Record] = []
    waves = {}
    for method, work in methods.items():
        with run.step(f"{name}: {method}"):
            begin = time.perf_counter()
            waves[method] = work()
            seconds = time.perf_counter() - begin
        error = np.sqrt(weights @ (waves[method] / exact - 1.0) ** 2)
        rows.append(
            {
                "method": method,
                "time [ms]": 1e3 * seconds,
                "mean [N/(mm µm)]": weights @ waves[method] / 1e9,
                "error of the mean [%]": 100.0 * (weights @ waves[method] / mean - 1.0),
                "rms error over the phase [%]": 100.0 * error,
            }
        )
    split = checks(run, page, name, fine, hubs, waves)
    page.section(name[0].upper() + name[1:])
    show_phase(page, name, exact, waves)
    show_path(page, name, fine, hubs)
    page.sweep(
        hero(name),
        rows,
        "time [ms]",
        "rms error over the phase [%]",
        by="method",
        log="xy",
        points=True,
    )
    page.table(f"{name}: where elements and contact meet, at the pitch point", split)
    return rows


def show_phase(page: Page, name: str, exact: Floats, waves: dict[str, Floats]) -> None:
    """Mesh stiffness over the phase, by all methods."""
    at = np.append(np.arange(len(exact)) / len(exact), 1.0)
    page.chart(
        f"{name}: mesh stiffness over the phase, {LOAD / 1e3:g} N/mm",
        [
            trace("elements, fine, coupled", at, np.append(exact, exact[0]) / 1e9),
            *(
                trace(m, at, np.append(w, w[0]) / 1e9, line={"dash": "dot"})
                for m, w in waves.items()
                if m not in (COUPLED, PLANE_STRESS)
            ),
        ],
        "phase [periods]",
        "stiffness [N/(mm µm)]",
    )


def show_path(page: Page, name: str, fine: MeshedPair, hubs: tuple[float, float]) -> None:
    """Stiffness of one pair along the path of contact."""
    pair, places = fine.pair, fine.places
    iso = iso_gear_stiffness(pair)
    along = (places - pair.path.pitch) / pair.first.base_pitch
    page.chart(
        f"{name}: stiffness of one pair along the path of contact",
        [
            trace("elements, fine", along, fine.single(LOAD) / 1e9),
            trace("ISO 6336-1, c'", along[[0, -1]], np.full(2, iso.single) / 1e9),
            trace("parabola", along, parabolic_law(pair, STIFFNESS_RATIO)(places) / 1e9),
            trace("Cai", along, cai_law(pair, iso.single)(places) / 1e9),
            *(
                [trace("Kuang and Yang", along, kuang_yang_law(pair)(places) / 1e9)]
                if is_kuang_yang(pair)
                else []
            ),
            trace("energy, line contact", along, energy_law(pair, hubs, LOAD)(places) / 1e9),
        ],
        "place from the pitch point [base pitches]",
        "stiffness [N/(mm µm)]",
    )


def shares_of_time(pair: Pair, places: int, steps: int) -> Floats:
    """Weights of the phases in means: two pairs are in contact for epsilon - 1 of a period."""
    two = np.arange(steps) + steps < places
    ratio = pair.transverse_ratio
    return np.asarray(np.where(two, (ratio - 1.0) / two.sum(), (2.0 - ratio) / (~two).sum()))


def checks(
    run: Run,
    page: Page,
    name: str,
    fine: MeshedPair,
    hubs: tuple[float, float],
    waves: dict[str, Floats],
) -> list[Record]:
    """Judge elements by themselves, then formulas by elements; the split of contact by depth."""
    page.vanishes(
        f"{name}: coarse elements against fine ones, largest",
        float(np.abs(waves[COUPLED] / fine.mesh(LOAD) - 1.0).max()),
        within=0.01,
        why="quadratic triangles of a fifth of a module",
        source="the finest elements",
    )
    with run.step(f"{name}: pressure on the surface"):
        rows = check_split(page, name, fine.pair, hubs, run.quick)
    with run.step(f"{name}: hubs and loads"):
        ends = stiffness_of_ends(fine.pair)
    check_standard(page, name, iso_gear_stiffness(fine.pair), ends)
    energy = energy_law(fine.pair, hubs, LOAD)(fine.places)
    middle = np.abs(fine.places - fine.places.mean()) < 0.3 * np.ptp(fine.places)
    page.vanishes(
        f"{name}: energy with line contact, one pair, largest error in the middle of the path",
        float(np.abs(energy / fine.single(LOAD) - 1.0)[middle].max()),
        within=0.15,
        why="plane stress instead of plane strain, a tenth, and a short cantilever as a beam",
        source=ELEMENTS,
    )
    return rows


def check_split(
    page: Page, name: str, pair: Pair, hubs: tuple[float, float], quick: bool
) -> list[Record]:
    """Compliance at the pitch point, contact apart at several depths, and under a pressure."""
    curvatures = pair.curvatures(np.array([pair.path.pitch]))
    width = float(contact_half_width(LOAD, curvatures)[0])
    sides = list(zip(("first", "second"), (pair.first, pair.second), hubs, curvatures, strict=True))
    rows = []
    for which, gear, hub, at in sides[: 1 if quick else None]:
        direct = pressed_surface(gear, float(at[0]), hub, width, STRAIN)
        mesh = mesh_teeth(gear, at, hub, QUICK_FINE)
        for share in DEPTHS:
            body = float(compliances(mesh, STRAIN, share)[0, 0, 0, 0])
            depth = share * float(contact_depths(gear, at)[0])
            near = (2.0 * np.log(2.0 * depth / width) - STRAIN.nu) / (np.pi * STRAIN.E)
            rows.append(
                {
                    "tooth": which,
                    "depth over that of the centre line": share,
                    "compliance [m^2/N]": body + near,
                    "error [%]": 100.0 * ((body + near) / direct - 1.0),
                }
            )
            if share == DEPTH:
                page.equals(
                    f"{name}: {which} tooth at the pitch point, contact apart [m^2/N]",
                    body + near,
                    direct,
                    within=0.015,
                    why="a tooth is a half plane near its surface only: the error goes with the "
                    "depth, and is some 3 % from the centre line",
                    source="Hertz's pressure on elements of an eighth of the half width",
                    measure="deflection",
                )
    return rows


def stiffness_of_ends(pair: Pair) -> list[tuple[float, float]]:
    """One pair and mean mesh stiffness [N/(mm µm)] of the softest and the stiffest gears."""
    ends = []
    for share, load in (SOFTEST, STIFFEST):
        held = (share * pair.first.root_radius, share * pair.second.root_radius)
        gears = meshed_pair(pair, held, STRAIN, STEEL, 6, COARSE)
        weights = shares_of_time(pair, len(gears.places), gears.steps)
        mean = float(weights @ gears.mesh(load))
        ends.append((float(gears.single(load).max()) / 1e9, mean / 1e9))
    return ends


def check_standard(
    page: Page, name: str, iso: IsoStiffness, ends: list[tuple[float, float]]
) -> None:
    """The standard's stiffness is between those of the softest and the stiffest gears."""
    for quantity, value, low, high in (
        ("one pair by ISO 6336-1, c'", iso.single, ends[0][0], ends[1][0]),
        ("mean by ISO 6336-1, c_gamma", iso.mesh, ends[0][1], ends[1][1]),
    ):
        page.between(
            f"{name}: {quantity}",
            value / 1e9,
            low,
            high,
            why="the standard knows neither hub nor load: elements with hubs of "
            f"{SOFTEST[0]:g} and {STIFFEST[0]:g} root radii, loads of {SOFTEST[1] / 1e3:g} and "
            f"{STIFFEST[1] / 1e3:g} N/mm",
            source=ELEMENTS,
            unit="N/(mm µm)",
            measure="stiffness",
        )
