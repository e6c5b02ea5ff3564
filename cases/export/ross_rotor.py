"""ROSS on a rotor built from scenes: deflections, reactions, natural frequencies."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements along the shaft, and natural frequencies that are compared.
PARTS, COUNT = 32, 6

#: Natural frequencies of the free shaft.
FREE = 4

#: Of a rigid support: how many times the spring in its place is stiffer than the shaft there.
STIFFER = 1e6


def run(run: Run) -> Any:
    """Build rotors, let ROSS solve them, compare."""
    from dataclasses import replace
    from itertools import pairwise

    import numpy as np

    from fe_drivetrain.beam import Support, beam_of_scene, shaft_stiffness, unit_load_response
    from fe_drivetrain.cases.export import (
        rotor_scenes,
    )
    from fe_drivetrain.export import craig_bampton_shaft, free_frequencies, natural_frequencies
    from fe_drivetrain.export.programs import ross_rotor
    from fe_drivetrain.fidelity import scene_supports
    from fe_drivetrain.report import Section, Table, Text, judge
    from fe_drivetrain.scene import library_scene

    with run.step("ROSS starts"):
        version = ross_rotor.ross_version()
    source = f"ROSS {version}"
    verdicts: list[Any] = []
    rows: list[list[Any]] = []
    figures: dict[str, Any] = {}
    worst = {"deflections": 0.0, "reactions": 0.0}
    for name in rotor_scenes.QUICK_SCENES if run.quick else rotor_scenes.SCENES:
        with run.step(f"bearing units of {name}"):
            scene, units = rotor_scenes.scene_and_units(name)
        with run.step(f"ROSS on {name}"):
            rotor = ross_rotor.rotor_of_scene(
                scene, units, longest=scene.shaft.length / PARTS, stiffer=STIFFER
            )
            K, M = rotor.matrix("K"), rotor.matrix("M")
            found = rotor.frequencies(COUNT)
        with run.step(f"level 1 of {name}"):
            beam = ross_rotor.ringed_beam(scene, units)
            own = np.zeros_like(K)
            for k, (low, high) in enumerate(pairwise(rotor.stations.tolist())):
                at = np.arange(6 * k, 6 * k + 12)
                own[np.ix_(at, at)] += shaft_stiffness(beam, low, high)
            for node, spring in rotor.supports.values():
                own[6 * node : 6 * node + 6, 6 * node : 6 * node + 6] += spring
            ends = beam.ends[[0, -1]]
            exact = unit_load_response(beam, ends, rotor.stations)
        size = np.sqrt(np.outer(own.diagonal(), own.diagonal()))
        verdicts.append(
            judge(
                f"{name}: stiffness as ROSS assembles it, largest difference from this project's "
                "elements and supports, with a unit diagonal",
                float(np.abs((K - own) / size).max()),
                0.0,
                tolerance=1e-10,
                relative=False,
                source=source,
                reason="the same theory with the same shear coefficient: exact but for rounding",
                measure="identity",
            )
        )
        moved, reacted = _apart(rotor, exact)
        worst["deflections"] = max(worst["deflections"], moved)
        worst["reactions"] = max(worst["reactions"], reacted)
        for what, value in (("deflections of all nodes", moved), ("reactions", reacted)):
            verdicts.append(
                judge(
                    f"{name}: {what} under 12 unit loads and gravity along 3 axes, largest "
                    "difference from level 1 over the largest of its kind",
                    value,
                    0.0,
                    tolerance=10.0 / STIFFER,
                    relative=False,
                    source="level 1 of this project, in which rigid is rigid",
                    reason=f"what the gearbox holds rigidly is a spring {STIFFER:.0e} times as "
                    "stiff as an element of the shaft",
                    measure="reaction" if what == "reactions" else "deflection",
                )
            )
        verdicts.append(
            judge(
                f"{name}: lowest {COUNT} natural frequencies, largest relative difference from "
                "this project's stiffness with the mass of ROSS",
                float(np.abs(found / natural_frequencies([], own, M)[:COUNT] - 1).max()),
                0.0,
                tolerance=1e-6,
                relative=False,
                source=source,
                reason="an eigenvalue of ROSS's unsymmetric state matrix keeps 1e-16 of its "
                "largest, which the stiff spring lifts to some 1e10 times the least",
                measure="identity",
            )
        )
        # ROSS's own statics, of rigid bearings: no coupling of moments, or it goes missing
        plain = [
            replace(s, stiffness=np.diag(np.diag(np.asarray(s.stiffness)))) for s in beam.supports
        ]
        static = ross_rotor.ross_rotor(replace(beam, supports=plain), stiffer=STIFFER)
        held = []
        for support in plain:
            stiff = np.diag(np.asarray(support.stiffness)).copy()
            stiff[1:3] = np.inf
            held.append(Support(support.name, support.x, stiff))
        weight = static.rotor.m * ross_rotor.STATIC_GRAVITY
        expected_weight = unit_load_response(replace(beam, supports=held), beam.start)
        upward = static.static_reactions()
        for number, support in enumerate(held):
            verdicts.append(
                judge(
                    f"{name}: upward force at {support.name} by run_static, share of the weight",
                    upward[support.name] / weight,
                    float(
                        expected_weight.gravity_reaction[number, 2, 2]
                        * ross_rotor.STATIC_GRAVITY
                        / weight
                    ),
                    tolerance=1e-6,
                    relative=False,
                    source="level 1 on bearings rigid across the shaft, as ROSS takes them",
                    reason="its 1e20 N/m among 1e10 leave six digits",
                    measure="reaction",
                )
            )
        with run.step(f"level 2 of {name}"):
            modal = craig_bampton_shaft(scene, 12, order=rotor_scenes.ORDER)
            second = natural_frequencies(
                modal.points, modal.stiffness, modal.mass, scene_supports(scene, units)
            )[:COUNT]
        for number, (ours, theirs) in enumerate(zip(second, found, strict=True), start=1):
            rows.append([name, number, float(theirs), float(ours), 100 * float(theirs / ours - 1)])
        figures[name] = {"ross": found.tolist(), "level 2": second.tolist()}

    # without supports and rings: the uncondensed meridian is the reference
    with run.step("free shaft"):
        scene = library_scene("main_bearing_bonded")
        none = {unit.bearing.name: np.zeros(6) for unit in scene.bearing_units}
        free = replace(beam_of_scene(scene, none), supports=())
        rotor = ross_rotor.ross_rotor(free, longest=free.length / PARTS)
        theirs = natural_frequencies([], rotor.matrix("K"), rotor.matrix("M"))[6 : 6 + FREE]
        solid = free_frequencies(scene, FREE, order=rotor_scenes.ORDER, rings=False)[:FREE]
    for number, (a, b) in enumerate(zip(theirs, solid, strict=True), start=1):
        verdicts.append(
            judge(
                f"free shaft of main_bearing_bonded, natural frequency {number}",
                float(a),
                float(b),
                tolerance=0.01,
                unit="Hz",
                source="its meridian at level 2, not condensed",
                reason="Cowper's shear coefficient is 5 % below the one of vibrations (Hutchinson "
                "2001), shear's share of these frequencies under 20 %; torsion of "
                f"{PARTS} elements is high by 0.2 % at most",
                measure="frequency",
            )
        )
    return CASE.results(
        run,
        summary=[
            f"ROSS {version} gives the deflections of level 1 to {worst['deflections']:.1e} and "
            f"its reactions to {worst['reactions']:.1e}, with the full 6x6 stiffness of every "
            "bearing unit.",
            f"On those supports its lowest {COUNT} natural frequencies are "
            f"{min(row[-1] for row in rows):+.1f} to {max(row[-1] for row in rows):+.1f} % from "
            "those of the shaft as a solid of revolution with twelve modes of Craig and Bampton.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Natural frequencies on the scene's supports",
                items=[
                    Table(
                        caption="ROSS's beam against level 2 (meridian, Craig-Bampton); both on "
                        "the same bearing units and gearbox",
                        columns=["scene", "mode", "ROSS [Hz]", "level 2 [Hz]", "difference [%]"],
                        rows=rows,
                    ),
                    Text(
                        text="The two differ by what level 1 neglects: a seat as wide as a bearing "
                        "turns less than the point in its middle, and rings stiffen a beam more "
                        "than a solid. Level 2 with its modes is a little high, too, as every "
                        "reduction is."
                    ),
                ],
            ),
            Section(
                title="What ROSS takes",
                items=[
                    Text(
                        text="A BearingElement of ROSS has stiffness along its three axes and "
                        "between the two across the shaft. Tilt stiffness and all other coupling "
                        "goes into an element of its own, derived from ROSS's disk without mass. "
                        "A rigid support is a spring that is "
                        f"{STIFFER:.0e} times as stiff as an element of the shaft. Its run_static "
                        "knows bearings that are rigid across the shaft only: compared apart, "
                        "with the stiffness that couples directions left out."
                    )
                ],
            ),
        ],
        figures=figures,
    )


def _apart(rotor: Any, exact: Any) -> tuple[float, float]:
    """Largest differences of deflections and of reactions under unit loads, over their kind:

    translations, rotations, forces and moments each for themselves, and so under forces, under
    moments and under gravity.
    """
    import numpy as np

    moved, reacted = [], []
    for case in range(15):
        loads, gravity = np.zeros((2, 6)), np.zeros(3)
        if case < 12:
            loads[case // 6, case % 6] = 1.0
        else:
            gravity[case - 12] = 1.0
        at = exact.load_stations.tolist()
        u = rotor.deflections(dict(zip(at, loads, strict=True)), tuple(gravity))
        expected = exact.solution(loads, gravity)
        moved.append((u, expected.displacements))
        carried = rotor.reactions(u)
        both = [(carried[name], expected.reaction(name)) for name in carried]
        reacted.append((np.array([a for a, _ in both]), np.array([b for _, b in both])))
    forces = [case for case in range(12) if case % 6 < 3]
    moments = [case for case in range(12) if case % 6 >= 3]
    found = []
    for pairs in (moved, reacted):
        theirs, ours = np.array(pairs).swapaxes(0, 1)
        found.append(
            max(
                float(np.abs((theirs - ours)[block]).max() / np.abs(ours[block]).max())
                for cases in (forces, moments, [12, 13, 14])
                for block in (np.s_[cases, :, :3], np.s_[cases, :, 3:])
            )
        )
    return found[0], found[1]


CASE = Case(
    name="export/ross_rotor",
    title="ROSS: rotors from scenes",
    source="ROSS (Timbo et al. 2020, J. Open Source Software 5(48), 2120), run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
