"""ROSS on a rotor built from scenes: deflections, reactions, natural frequencies."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.rotor_scenes import ORDER, QUICK_SCENES, SCENES, scene_and_units
from fe_drivetrain.cases.export.samples import show
from fe_drivetrain.common import Floats, max_difference
from fe_drivetrain.drivetrain_file import library_scene
from fe_drivetrain.export import craig_bampton_shaft, free_frequencies, natural_frequencies
from fe_drivetrain.export.programs import ross_rotor
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted, percent_text
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped
from fe_drivetrain.shafts.beam import (
    Beam,
    Support,
    UnitLoadResponse,
    beam_of_scene,
    shaft_stiffness,
    unit_load_response,
)
from fe_drivetrain.shafts.fidelity import scene_supports

#: Elements along the shaft, and natural frequencies that are compared.
PARTS, COUNT = 32, 6

#: Natural frequencies of the free shaft.
FREE = 4

#: How many times the spring in place of a rigid support is stiffer than the shaft there.
STIFFER = 1e6

#: Allowed difference of deflections and reactions: what such a spring leaves.
WITHIN = 10.0 / STIFFER

DIFFERENCE = "difference [%]"
FREQUENCIES = "Natural frequencies of ROSS's beam less those of the solid of revolution"


def answer(page: Page, version: str, errors: Floats, difference: float) -> None:
    """State how far ROSS is from this project's beam and from the solid of revolution.

    Parameters
    ----------
    page : Page
        With the checks of all scenes.
    version : str
        That of ROSS.
    errors : ndarray
        (2,) largest differences of deflections and of reactions from the beam, over their kind.
    difference : float
        Largest difference of natural frequencies from the solid of revolution [%].
    """
    moved, reacted = errors.tolist()
    page.answer(
        "Does ROSS find the deflections, reactions and frequencies of a rotor from a scene?",
        f"ROSS {version} differs from this project's beam by {formatted(moved, 2, '')} in "
        f"deflections and {formatted(reacted, 2, '')} in reactions; its frequencies are up to "
        f"{percent_text(difference / 100)} from a solid's.",
        [
            page.value("largest difference of deflections", moved, at_most=WITHIN, by="beam"),
            page.value("largest difference of reactions", reacted, at_most=WITHIN, by="beam"),
            page.value("largest difference of frequencies from the solid [%]", difference),
            page.judged(
                "free shaft of main_bearing_bonded, natural frequency 1",
                "first natural frequency of a free shaft",
                "solid",
            ),
        ],
        hero=FREQUENCIES,
    )


@case(
    "ROSS: rotors from scenes",
    source="ROSS (Timbo et al. 2020, J. Open Source Software 5(48), 2120), run here",
)
def run(run: Run, page: Page) -> None:
    """Build rotors, let ROSS solve them, compare."""
    version = run.timed("ROSS starts", ross_rotor.ross_version)
    page.section("Natural frequencies on the scene's supports")
    errors: list[Floats] = []
    rows: list[Record] = []
    scenes = QUICK_SCENES if run.quick else SCENES
    for name in scenes:
        check_scene(run, page, name, f"ROSS {version}", errors, rows)
    free_shaft(run, page)
    answer(page, version, np.max(errors, axis=0), max(map(abs, column(rows, DIFFERENCE))))
    page.say(
        "ROSS is given the full 6x6 stiffness of every bearing unit. Its lowest "
        f"{COUNT} natural frequencies on those supports are compared with those of the shaft as a "
        "solid of revolution with twelve modes of Craig and Bampton."
    )
    curves = [
        trace(name, column(of, "mode"), column(of, DIFFERENCE), mode="lines+markers")
        for name, of in grouped(rows, "scene")
    ]
    page.chart(FREQUENCIES, curves, "mode", DIFFERENCE)
    show(run, page, library_scene(scenes[-1]))
    page.table(
        "ROSS's beam against level 2 (meridian, Craig-Bampton); both on the same bearing units and "
        "gearbox",
        rows,
    )
    page.text(
        "The two differ by what level 1 neglects: a seat as wide as a bearing turns less than the "
        "point in its middle, and rings stiffen a beam more than a solid. Level 2 with its modes "
        "is a little high, too, as every reduction is."
    )
    page.section("What ROSS takes")
    page.text(
        "A BearingElement of ROSS has stiffness along its three axes and between the two across "
        "the shaft. Tilt stiffness and all other coupling goes into an element of its own, derived "
        f"from ROSS's disk without mass. A rigid support is a spring that is {STIFFER:.0e} times "
        "as stiff as an element of the shaft. Its run_static knows bearings that are rigid across "
        "the shaft only: compared apart, with the stiffness that couples directions left out."
    )


def check_scene(
    run: Run, page: Page, name: str, source: str, errors: list[Floats], rows: list[Record]
) -> None:
    """One scene's rotor against levels 1 and 2; adds to the errors and to the table's rows."""
    with run.step(f"bearing units of {name}"):
        scene, units = scene_and_units(name)
    with run.step(f"ROSS on {name}"):
        rotor = ross_rotor.rotor_of_scene(
            scene, units, longest=scene.shaft.length / PARTS, stiffer=STIFFER
        )
        K, M = rotor.matrix("K"), rotor.matrix("M")
        found = rotor.frequencies(COUNT)
    with run.step(f"level 1 of {name}"):
        beam = ross_rotor.ringed_beam(scene, units)
        own = assembled(beam, rotor)
        exact = unit_load_response(beam, beam.ends[[0, -1]], rotor.stations)
    page.vanishes(
        f"{name}: stiffness as ROSS assembles it, largest difference from this project's elements "
        "and supports, with a unit diagonal",
        max_difference(K, own),
        within=1e-10,
        why="the same theory with the same shear coefficient: exact but for rounding",
        source=source,
    )
    errors.append(error := max_errors(rotor, exact))
    check_answers(page, name, error)
    page.vanishes(
        f"{name}: lowest {COUNT} natural frequencies, largest relative difference from this "
        "project's stiffness with the mass of ROSS",
        np.abs(found / natural_frequencies([], own, M)[:COUNT] - 1).max(),
        within=1e-6,
        why="an eigenvalue of ROSS's unsymmetric state matrix keeps 1e-16 of its largest, which "
        "the stiff spring lifts to some 1e10 times the least",
        source=source,
    )
    static_analysis(page, name, beam)
    with run.step(f"level 2 of {name}"):
        modal = craig_bampton_shaft(scene, 12, order=ORDER)
        second = natural_frequencies(
            modal.points, modal.stiffness, modal.mass, scene_supports(scene, units)
        )[:COUNT]
    page.data(name, {"ross": found, "level 2": second})
    rows += [
        {
            "scene": name,
            "mode": mode,
            "ROSS [Hz]": theirs,
            "level 2 [Hz]": ours,
            DIFFERENCE: 100 * (theirs / ours - 1),
        }
        for mode, (theirs, ours) in enumerate(zip(found, second, strict=True), start=1)
    ]


def check_answers(page: Page, name: str, error: Floats) -> None:
    """Deflections and reactions of level 1."""
    for what, value in zip(("deflections of all nodes", "reactions"), error, strict=True):
        page.at_most(
            f"{name}: {what} under 12 unit loads and gravity along 3 axes, largest difference "
            "from level 1 over the largest of its kind",
            value,
            WITHIN,
            why=f"what the gearbox holds rigidly is a spring {STIFFER:.0e} times as stiff as an "
            "element of the shaft",
            source="level 1 of this project, in which rigid is rigid",
            measure="reaction" if what == "reactions" else "deflection",
        )


def assembled(beam: Beam, rotor: ross_rotor.Rotor) -> Floats:
    """This project's stiffness of the rotor's elements, with the supports as the rotor has them."""
    size = 6 * len(rotor.stations)
    K = np.zeros((size, size))
    for k, (low, high) in enumerate(pairwise(rotor.stations.tolist())):
        at = slice(6 * k, 6 * k + 12)
        K[at, at] += shaft_stiffness(beam, low, high)
    for node, spring in rotor.supports.values():
        at = slice(6 * node, 6 * node + 6)
        K[at, at] += spring
    return K


def static_analysis(page: Page, name: str, beam: Beam) -> None:
    """ROSS's own statics, of rigid bearings: without coupling, whose share would be missing."""
    diagonals = [np.diag(np.asarray(support.stiffness)) for support in beam.supports]
    plain = [
        replace(support, stiffness=np.diag(stiffness))
        for support, stiffness in zip(beam.supports, diagonals, strict=True)
    ]
    static = ross_rotor.ross_rotor(replace(beam, supports=plain), stiffer=STIFFER)
    upward = static.static_reactions()
    held = [
        Support(support.name, support.x, [stiffness[0], np.inf, np.inf, *stiffness[3:]])
        for support, stiffness in zip(beam.supports, diagonals, strict=True)
    ]
    weight = static.rotor.m * ross_rotor.STATIC_GRAVITY
    expected = unit_load_response(replace(beam, supports=held), beam.start)
    for number, support in enumerate(held):
        page.equals(
            f"{name}: upward force at {support.name} by run_static, share of the weight",
            upward[support.name] / weight,
            expected.gravity_reaction[number, 2, 2] * ross_rotor.STATIC_GRAVITY / weight,
            within=1e-6,
            relative=False,
            why="its 1e20 N/m among 1e10 leave six digits",
            source="level 1 on bearings rigid across the shaft, as ROSS takes them",
            measure="reaction",
        )


def free_shaft(run: Run, page: Page) -> None:
    """A shaft without supports and rings: the meridian that is not condensed is the reference."""
    with run.step("free shaft"):
        scene = library_scene("main_bearing_bonded")
        none = {unit.bearing.name: np.zeros(6) for unit in scene.bearing_units}
        free = replace(beam_of_scene(scene, none), supports=())
        rotor = ross_rotor.ross_rotor(free, longest=free.length / PARTS)
        theirs = natural_frequencies([], rotor.matrix("K"), rotor.matrix("M"))[6 : 6 + FREE]
        solid = free_frequencies(scene, FREE, order=ORDER, rings=False)[:FREE]
    for number, (computed, exact) in enumerate(zip(theirs, solid, strict=True), start=1):
        page.equals(
            f"free shaft of main_bearing_bonded, natural frequency {number} [Hz]",
            computed,
            exact,
            within=0.01,
            why="Cowper's shear coefficient is 5 % below the one of vibrations (Hutchinson 2001), "
            "shear's share of these frequencies under 20 %; torsion of "
            f"{PARTS} elements is high by 0.2 % at most",
            source="its meridian at level 2, not condensed",
        )


def max_errors(rotor: ross_rotor.Rotor, exact: UnitLoadResponse) -> Floats:
    """Largest errors (2,) of deflections and of reactions under unit loads, over their kind.

    Translations, rotations, forces and moments are taken each for themselves, and so under forces,
    under moments and under gravity.
    """
    at = exact.load_stations.tolist()
    pairs = []
    for unit in np.eye(15):
        loads, gravity = unit[:12].reshape(2, 6), unit[12:]
        u = rotor.deflections(dict(zip(at, loads, strict=True)), gravity.tolist())
        expected = exact.solution(loads, gravity)
        carried = rotor.reactions(u)
        pairs.append(
            (
                np.array([u, expected.displacements]),
                np.array([[f, expected.reaction(name)] for name, f in carried.items()]),
            )
        )
    moved = np.array([pair[0] for pair in pairs])
    reacted = np.array([pair[1].swapaxes(0, 1) for pair in pairs])
    kinds = ([0, 1, 2, 6, 7, 8], [3, 4, 5, 9, 10, 11], [12, 13, 14])
    found = []
    for theirs, ours in (moved.swapaxes(0, 1), reacted.swapaxes(0, 1)):
        blocks = [np.s_[kind, :, part] for kind in kinds for part in (slice(3), slice(3, 6))]
        found.append(max(np.abs((theirs - ours)[b]).max() / np.abs(ours[b]).max() for b in blocks))
    return np.array(found)
