"""Gearbox springs from none to rigid: from a mechanism to a held shaft, and to what is no digit."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Of the other gearbox springs [N/m].
OTHER = 1e8


def run(run: Run) -> Any:
    """Sweep the radial gearbox stiffness of a spherical and of a bonded main bearing."""
    from dataclasses import replace

    import numpy as np

    from fe_drivetrain.beam import Support, beam_of_scene, unit_load_response
    from fe_drivetrain.cases.stability import (
        soft_springs,
    )
    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        crosses,
        decades,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.common import InputError
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.response import mesh_scene

    step = 2.0 if run.quick else 1.0
    tolerance = 0.4 if run.quick else 0.2
    reason = "round-off scatters by about a decade over the decades of the fit"

    with run.step("spherical: mesh and assembly"):
        scene = soft_springs.scene_of("spherical")
        mesh = mesh_scene(scene)
        spherical = soft_springs.sprung(scene, mesh)
        held_scene = soft_springs.scene_of("spherical", rigid=(2, 3))
        held = soft_springs.sprung(held_scene, mesh)
    lever = -scene.shaft.front / scene.shaft.rear  # hub to bearing over bearing to gearbox
    with run.step("spherical: springs"):
        stiffness = np.concatenate(
            [decades(-6, 4, 1 / step), decades(8, 28, 0.1 if run.quick else 0.25)]
        )
        rigid = held.solve([OTHER, OTHER, 0, 0, 0, 0], ["hub.Fz"], "superlu")
        assert rigid is not None
        exact = rigid.hub[2, 0] + lever**2 / stiffness
        computed, carried, warned, refusals = [], [], [], []
        for k in stiffness:
            run.report(f"spherical: gearbox {k:.0e} N/m")
            springs = [OTHER, OTHER, float(k), 0, 0, 0]
            warnings, refusal = spherical.said(springs)
            found = None if refusal else spherical.solve(springs, ["hub.Fz"], "superlu")
            warned.append(bool(warnings))
            refusals.append(refusal or ("" if found else "singular"))
            computed.append(np.nan if found is None else found.hub[2, 0])
            carried.append(np.nan if found is None else k * found.gearbox[2, 0])
        _, at_zero = spherical.said([OTHER, OTHER, 0.0, 0, 0, 0])
    error = np.abs(np.array(computed) / exact - 1.0)
    # statics: the gearbox carries the load times the lever, whatever its spring
    reaction_error = np.abs(np.array(carried) / -lever - 1.0)
    answered = np.isfinite(error)
    low, high = safe_range(stiffness, np.fmax(error, reaction_error), FOUR_DIGITS)
    soft = slope(stiffness[stiffness < 1e5], error[stiffness < 1e5], (1e-12, 0.1))
    # from the softest scene to the stiffest, everything wrong was warned of or refused
    worst = np.fmax(error, reaction_error)
    silent = answered & ~np.array(warned) & ~(worst < FOUR_DIGITS)
    allowed = stiffness <= 1e16

    with run.step("beam"):
        beam = beam_of_scene(held_scene, {"main_bearing": [np.inf] * 3 + [0.0] * 3})
        compliance = []
        for k in [*stiffness, np.inf]:
            support = Support("gearbox", scene.shaft.rear, [OTHER, OTHER, k, np.inf, 0.0, 0.0])
            others = [s for s in beam.supports if s.name != "gearbox"]
            sprung = replace(beam, supports=[*others, support])
            front = scene.shaft.front
            try:
                compliance.append(unit_load_response(sprung, front, front).displacement[2, 2])
            except InputError:
                compliance.append(np.nan)
        beam_error = np.abs(
            np.array(compliance[:-1]) / (compliance[-1] + lever**2 / stiffness) - 1.0
        )

    with run.step("bonded: springs"):
        bonded_scene = soft_springs.scene_of("bonded")
        bonded_mesh = mesh_scene(bonded_scene)
        bonded = soft_springs.sprung(bonded_scene, bonded_mesh)
        bonded_held = soft_springs.sprung(
            soft_springs.scene_of("bonded", rigid=(2, 3)), bonded_mesh
        )
        loads = ["hub.Fz", "gearbox.weight"]
        free = bonded.solve([0, 0, 0, 0, 0, 0], loads, "superlu")
        fast = bonded_held.solve([0, 0, 0, 0, 0, 0], loads, "superlu")
        assert free is not None
        assert fast is not None
        # one spring on a solved body: its force, and what that moves
        motion, own, across = free.gearbox[2, 0], -free.gearbox[2, 1], -free.hub[2, 1]
        bonded_k = decades(0, 32, 0.25 if run.quick else 0.5)
        bonded_exact = free.hub[2, 0] - across * motion * bonded_k / (1.0 + bonded_k * own)
        bonded_found, bonded_carried = [], []
        for k in bonded_k:
            run.report(f"bonded: gearbox {k:.0e} N/m")
            answer = bonded.solve([0, 0, float(k), 0, 0, 0], ["hub.Fz"], "superlu")
            bonded_found.append(np.nan if answer is None else answer.hub[2, 0])
            bonded_carried.append(np.nan if answer is None else k * answer.gearbox[2, 0])
    hub = np.array(bonded_found)
    bonded_error = np.abs(hub / bonded_exact - 1.0)
    force = motion * bonded_k / (1.0 + bonded_k * own)
    bonded_reaction_error = np.abs(np.array(bonded_carried) / force - 1.0)
    bonded_answered = np.isfinite(bonded_error)
    _, bonded_high = safe_range(bonded_k, np.fmax(bonded_error, bonded_reaction_error), FOUR_DIGITS)
    from_free = np.abs(hub / free.hub[2, 0] - 1.0)
    from_held = np.abs(hub / fast.hub[2, 0] - 1.0)
    above = bonded_k > 1e16
    stiff = slope(bonded_k[above], bonded_reaction_error[above], (1e-11, 0.1))
    to_free = slope(bonded_k, from_free, (1e-9, 1e-2))
    beyond_own = (bonded_k > 1.0 / own) & ~above
    to_held = slope(bonded_k[beyond_own], from_held[beyond_own], (1e-9, 1e-2))

    def order(quantity: str, value: float, reference: float, source: str, within: float) -> Any:
        return judge(
            quantity,
            value,
            reference,
            tolerance=within,
            source=source,
            reason=reason if within > 0.1 else "first order in the spring or its compliance",
            measure="order",
            band=within / 2,
        )

    def yes(quantity: str, value: bool, source: str) -> Any:
        return judge(
            quantity,
            float(value),
            1.0,
            tolerance=0.0,
            source=source,
            reason="yes or no",
            measure="identity",
        )

    verdicts = [
        yes(
            "spherical, no gearbox spring: refused, and the motion named",
            "turn freely about y" in at_zero,
            "a shaft on a sphere",
        ),
        order(
            "spherical, soft spring: error of the hub's motion, exponent",
            soft,
            -1.0,
            "round-off of the shaft's stiffness acts as springs to ground",
            tolerance,
        ),
        order(
            "bonded, stiff spring: error of the gearbox's reaction, exponent",
            stiff,
            1.0,
            "the spring times a motion that round-off does not let vanish",
            tolerance,
        ),
        yes(
            "spherical: every answer without four digits was warned of or refused, from a spring "
            "of nothing to the stiffest that a scene may have",
            not silent[allowed].any(),
            "statics: the reaction of the gearbox is the lever times the load",
        ),
        yes(
            "spherical: springs above those that leave four digits are all solved",
            bool(answered[allowed & (stiffness >= low)].all()),
            "statics",
        ),
        judge(
            "beam by the force method: worst error wherever the solid answers",
            float(beam_error[answered].max()),
            0.0,
            tolerance=1e-10,
            relative=False,
            source="statics: the lever squared over the spring is added",
            reason="round-off",
            measure="identity",
        ),
        order(
            "bonded, soft spring: departure from the free shaft, exponent",
            to_free,
            1.0,
            "one spring on a body: k u / (1 + k c)",
            0.05,
        ),
        order(
            "bonded, stiff spring: departure from the held shaft, exponent",
            to_held,
            -1.0,
            "one spring on a body: k u / (1 + k c)",
            0.05,
        ),
        judge(
            "bonded: hub motion at the softest spring, over that of the free shaft",
            float(hub[0] / free.hub[2, 0]),
            1.0,
            tolerance=1e-7,
            source="the same scene without a spring",
            reason="the spring of 1 N/m is 1e-8 of the shaft's own stiffness",
            measure="deflection",
            band=1e-9,
        ),
        judge(
            "bonded: hub motion at the stiffest spring that a scene may have, over that of the "
            "held shaft",
            float(hub[bonded_k <= 1.01e16][-1] / fast.hub[2, 0]),
            1.0,
            tolerance=1e-6,
            source="the same scene, held rigidly",
            reason="1e16 N/m is 1e8 times the shaft's own stiffness; its round-off is as much",
            measure="deflection",
            band=1e-7,
        ),
    ]
    beyond = (
        "the error of the motion grows tenfold a decade; then the solver finds the matrix singular"
    )
    first_warned = stiffness[np.array(warned)]
    limits = [
        Limit(
            method="soft gearbox springs on a spherical bearing",
            parameter="radial stiffness [N/m]",
            low=low,
            criterion="error of the hub's motion below 1e-4",
            beyond=beyond,
            program="names the motion and the digits lost up to "
            f"{shown(first_warned.max() if len(first_warned) else None)} N/m, refuses below "
            f"{stiffness[answered].min():.1g} N/m; none at all is a mechanism by geometry",
            remedy=f"force method (beam): right to {np.nanmax(beam_error):.0e} from "
            f"{stiffness[np.isfinite(beam_error)].min():.1g} N/m on",
        ),
        Limit(
            method="stiff gearbox springs on a bonded bearing",
            parameter="radial stiffness [N/m]",
            high=bonded_high,
            criterion="error of the gearbox's reaction below 1e-4",
            beyond="the motion of the spring is round-off, and the spring multiplies it: the "
            "reaction's error grows tenfold a decade",
            program="refuses springs above 1e16 N/m in a scene",
            remedy="stiffness 'rigid': eliminated",
        ),
        Limit(
            method="stiff gearbox springs on a spherical bearing",
            parameter="radial stiffness [N/m]",
            high=high,
            criterion="error of the gearbox's reaction below 1e-4",
            beyond="the motion of the spring is round-off, and the spring multiplies it: the "
            "reaction's error grows tenfold a decade",
            program="refuses springs above 1e16 N/m in a scene",
            remedy="stiffness 'rigid': eliminated",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            "On a spherical bearing the hub's motion and the gearbox's reaction keep four digits "
            f"from {shown(low)} to {shown(high)} N/m of radial gearbox stiffness. No spring at "
            "all is refused as a mechanism; up to "
            f"{shown(first_warned.max() if len(first_warned) else None)} N/m the program names the "
            f"motion that is hardly held, and below {stiffness[answered].min():.1g} N/m it refuses "
            "to answer.",
            "On a bonded bearing the free and the held shaft are recovered, first order in the "
            "spring and in its compliance; the reaction of the spring keeps four digits up to "
            f"{shown(bonded_high)} N/m, and a scene may have 1e16.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Spherical bearing: from a mechanism to a held shaft",
                items=[
                    chart(
                        "Error of the hub's motion under a force there, against the motion held "
                        "plus lever squared over stiffness. Shaded: four digits",
                        [
                            trace(
                                "solid, silent",
                                stiffness[answered & ~np.array(warned)],
                                np.maximum(error[answered & ~np.array(warned)], 1e-16),
                                mode="lines+markers",
                            ),
                            trace(
                                "solid, warned of",
                                stiffness[answered & np.array(warned)],
                                error[answered & np.array(warned)],
                                mode="lines+markers",
                            ),
                            trace(
                                "reaction of the gearbox",
                                stiffness[answered],
                                np.maximum(reaction_error[answered], 1e-16),
                                line={"dash": "dot"},
                            ),
                            crosses("refused", stiffness[~answered]),
                            trace(
                                "beam by the force method",
                                stiffness[np.isfinite(beam_error)],
                                np.maximum(beam_error[np.isfinite(beam_error)], 1e-16),
                                line={"dash": "dash"},
                            ),
                        ],
                        "radial gearbox stiffness [N/m]",
                        "relative error",
                        ("x", "y"),
                        (low, high),
                    ),
                    Table(
                        caption="What the program says",
                        columns=["stiffness [N/m]", "error", "warned", "refused"],
                        rows=[[0.0, None, False, at_zero]]
                        + [
                            [float(k), float(e) if np.isfinite(e) else None, w, r]
                            for k, e, w, r in zip(stiffness, error, warned, refusals, strict=True)
                        ],
                    ),
                ],
            ),
            Section(
                title="Bonded bearing: from a free end to a held one",
                items=[
                    Text(
                        text="The bonded bearing holds the shaft by itself. One spring more moves "
                        "the hub by what its force moves: from two unit loads on the free shaft "
                        "its motion with any spring follows, and is what the solution with that "
                        "spring is held against."
                    ),
                    chart(
                        "Hub motion under a force there: error, and departure from the two limits. "
                        "Shaded: four digits",
                        [
                            trace(
                                "error",
                                bonded_k[bonded_answered],
                                np.maximum(bonded_error[bonded_answered], 1e-16),
                                mode="lines+markers",
                            ),
                            trace(
                                "departure from the free shaft",
                                bonded_k[bonded_answered],
                                np.maximum(from_free[bonded_answered], 1e-16),
                            ),
                            trace(
                                "departure from the held shaft",
                                bonded_k[bonded_answered],
                                np.maximum(from_held[bonded_answered], 1e-16),
                            ),
                            trace(
                                "error of the gearbox's reaction",
                                bonded_k[bonded_answered],
                                np.maximum(bonded_reaction_error[bonded_answered], 1e-16),
                            ),
                            crosses("refused", bonded_k[~bonded_answered]),
                        ],
                        "radial gearbox stiffness [N/m]",
                        "relative",
                        ("x", "y"),
                        (None, bonded_high),
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={"stiffness": stiffness.tolist(), "error": [float(e) for e in error if e == e]},
    )


CASE = Case(
    name="stability/springs",
    title="Springs from nothing to rigid: where a shaft is held, and how many digits are left",
    source="statics of a lever; the formula of Sherman and Morrison 1950, Ann. Math. Stat. 21, 124",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
