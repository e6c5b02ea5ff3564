"""The interface as a ladder of its own: bonded, 6x6 spring, ring of rollers, spherical joint."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE = "main_bearing_spherical"

#: Coarsening of the mesh, in full and under --quick.
SIZES = (1.6, 2.2)

#: Tilt stiffness of main bearings [N m/rad], and whose.
KNOWN = {
    5.0e6: "toroidal roller bearing INP-A of a 5 MW drivetrain (Nejad et al. 2016)",
    1.272e9: "double-row tapered rollers, fitted to tables (Stirling 2023)",
}

#: The ring of rollers: two rows, radial; all assumed.
COUNT, STIFFNESS, ROWS = 28, 5e8, (-0.05, 0.05)

#: Rollers that ring and housing do not feel [N/m].
SOFT = 5e3

#: What a choice of joint may change.
ENOUGH = 0.05


def run(run: Run) -> Any:
    """Sweep the tilt stiffness of the joint from none to all, and set the other joints beside."""
    import numpy as np

    from fe_drivetrain.cases.fidelity import (
        joint_ladder,
    )
    from fe_drivetrain.cases.fidelity.joint_ladder import (
        BEARING,
        solved,
        tilting,
        with_joint,
    )
    from fe_drivetrain.fidelity import meridian_shaft
    from fe_drivetrain.interfaces import joint_stiffness, roller_lines, roller_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import change_scene, library_scene

    scene = change_scene(library_scene(SCENE), run.settings)
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(SIZES[run.quick])})
    ring = with_joint(scene, **{"bearing.kind": "ring", "interface": "bonded"})

    with run.step("the two limits"):
        spherical = solved(with_joint(scene, interface="averaged"))
        none, all_ = solved(tilting(scene, 0.0)), solved(tilting(scene, "rigid"))
        sliding = solved(scene)
        bonded = solved(with_joint(scene, interface="bonded"))
    decades = np.array([4.0, 6.0, 11.0, 13.0]) if run.quick else np.arange(4.0, 14.0)
    sweep = []
    for power in decades:
        run.report(f"tilt stiffness 1e{power:g} N m/rad")
        with run.step("sweep"):
            sweep.append(solved(tilting(scene, float(10.0**power))))
    to_none = [joint_ladder.difference(s.hub_motions, none.hub_motions) for s in sweep]
    to_all = [joint_ladder.difference(s.hub_motions, all_.hub_motions) for s in sweep]

    with run.step("condensed"):
        housing, shaft = joint_ladder.housing_alone(scene), meridian_shaft(scene)
        fine = 10.0 ** np.linspace(decades[0], decades[-1], 61)
        curve = np.array(
            [joint_ladder.on_springs(tilting(scene, float(k)), housing, shaft)[4, 4] for k in fine]
        )
        at = [joint_ladder.on_springs(tilting(scene, 10.0**p), housing, shaft) for p in decades]
    moments = np.array([s.tilt_moment for s in sweep])
    condensed = np.array([m[4, 4] for m in at])

    with run.step("ring of rollers"):
        rows_at = [{"x": x} for x in ROWS]
        ring_of = {"count": COUNT, "stiffness": STIFFNESS, "rows": rows_at}
        rollers = with_joint(ring, interface="rollers", rollers=ring_of)
        rolling = solved(rollers)
        unit = rollers.bearing_units[0]
        loads = roller_loads(unit, rolling.response.motions)
        lines = roller_lines(unit)
        # between bodies that hardly give to them, rollers are the 6x6 spring that they add up to
        soft = with_joint(rollers, **{"rollers.stiffness": SOFT})
        unit = soft.bearing_units[0]
        matrix = joint_stiffness(unit)
        free = np.abs(matrix).max() * 1e-12
        rows = np.where(np.abs(matrix) < free, 0.0, 0.5 * (matrix + matrix.T)).tolist()
        as_spring = with_joint(soft, interface="spring", rollers=None, stiffness=rows)
        soft_rollers, soft_spring = solved(soft), solved(as_spring)

    low, high = (_reached(fine, curve, share) for share in (ENOUGH, 1.0 - ENOUGH))
    verdicts = [
        judge(
            "hub compliance, spring without tilt stiffness against the averaged spherical joint",
            joint_ladder.difference(none.hub_motions, spherical.hub_motions),
            0.0,
            tolerance=1e-8,
            relative=False,
            source="the same mesh with the joint's own constraint",
            reason="the same equations, eliminated in another way; solvers stop at 1e-9",
            measure="identity",
        ),
        judge(
            "order of the way to the spherical limit",
            _order(decades, to_none, first=True),
            1.0,
            tolerance=0.02,
            relative=False,
            source="a soft spring's effect is in proportion to it",
            reason="the next term is a hundredth at a hundredth of the unit's own stiffness",
            measure="order",
        ),
        judge(
            "order of the way to the rigid limit",
            _order(decades, to_all, first=False),
            -1.0,
            tolerance=0.02,
            relative=False,
            source="a stiff spring's give is in proportion to its inverse",
            reason="the next term is a hundredth a hundred times above the unit's own stiffness",
            measure="order",
        ),
        judge(
            "tilting moment over the sweep, condensed shaft on joint and housing against the "
            "assembly, largest difference",
            float(np.abs(condensed - moments).max()),
            0.0,
            tolerance=0.02,
            relative=False,
            source="level 2, solved apart",
            reason="the joint moves its faces by their means in both; what differs is how ring and "
            "shaft give to each other: a cylinder of the same volume stands for the ring",
            measure="reaction",
        ),
        judge(
            "loads of the rollers along their lines, sum against what the joint carries",
            joint_ladder.roller_totals(rolling.response, lines, loads.reshape(-1, 10)),
            0.0,
            tolerance=1e-7,
            relative=False,
            source="equilibrium",
            reason="solvers stop at 1e-9",
            measure="identity",
        ),
        judge(
            f"hub compliance, rollers of {SOFT:g} N/m against the 6x6 spring that they add up to",
            joint_ladder.difference(soft_rollers.hub_motions, soft_spring.hub_motions),
            0.0,
            tolerance=1e-4,
            relative=False,
            source="K = sum k w w^T over the lines of contact",
            reason="next to such springs the bodies are rigid, to about their ratio of stiffness",
            measure="identity",
        ),
        judge(
            "hub tilt, mean motions tied over bonded: softer",
            float(all_.hub_motions[4, 4] >= bonded.hub_motions[4, 4]),
            1.0,
            tolerance=0.0,
            source="tying means is fewer constraints than tying all points",
            reason="energy principle",
            measure="identity",
        ),
    ]
    rungs = {
        "bonded: one piece": bonded,
        "spring, all six motions rigid: mean motions tied": all_,
        f"rollers: {len(ROWS)} rows of {COUNT}, {STIFFNESS:.1e} N/m each": rolling,
        "spring without tilt stiffness": none,
        "spherical, averaged": spherical,
        "spherical, sliding": sliding,
    }
    table = Table(
        caption="The joints on the same drivetrain",
        columns=[
            "joint",
            "tilting moment at the bearing for 1 N m at the hub [N m]",
            "hub tilt for 1 N m at the hub [rad]",
            "time [s]",
        ],
        rows=[
            [name, s.tilt_moment, float(s.hub_motions[4, 4]), s.seconds]
            for name, s in rungs.items()
        ],
    )
    tilt_chart = chart(
        "Tilting moment that the bearing takes for 1 N m at the hub, from spherical to rigid; the "
        f"shaded range has less than {100 * ENOUGH:g} % of the largest share",
        [
            trace("level 2: shaft, joint and housing as springs", fine, curve),
            trace("assembly of solids", 10.0**decades, moments, points=True),
            trace("bonded", [fine[0], fine[-1]], [bonded.tilt_moment] * 2, line={"dash": "dash"}),
            trace("rigid limit", [fine[0], fine[-1]], [all_.tilt_moment] * 2, line={"dash": "dot"}),
            *(
                trace(whose, [k], [np.interp(k, fine, curve)], points=True, marker={"size": 13})
                for k, whose in KNOWN.items()
            ),
        ],
        x="tilt stiffness of the joint [N m/rad]",
        y="moment [N m]",
        logarithmic=("x",),
        safe=(None, low),
    )
    angles = np.degrees(2 * np.pi * np.arange(COUNT) / COUNT)
    shown = {"1 N down at the hub": -loads[..., 2], "1 N m about y at the hub": loads[..., 4]}
    roller_chart = chart(
        "Loads of the rollers round the ring, from +y towards z; each pushes and pulls",
        [
            trace(f"{what}, row at x = {x:g} m", angles, values[k])
            for what, values in shown.items()
            for k, x in enumerate(ROWS)
        ],
        x="angle [deg]",
        y="load of one roller [N]",
    )
    known = "; ".join(f"{whose}: {_share(k, fine, curve):.0f} %" for k, whose in KNOWN.items())
    summary = [
        f"From no to full tilt stiffness the bearing's share of a hub moment goes from 0 to "
        f"{all_.tilt_moment:.3f}. Below {low:.2g} N m/rad a spherical joint is within "
        f"{100 * ENOUGH:g} % of the largest share, above {high:.2g} N m/rad a rigid tie is; only "
        "between them does the joint's own stiffness have to be known.",
        f"Of the largest share, a bearing as stiff as these takes: {known}.",
        f"Bonding stiffens the hub by another "
        f"{100 * (all_.hub_motions[4, 4] / bonded.hub_motions[4, 4] - 1):.1f} % in tilt, for it "
        "keeps the bore round as well.",
    ]
    return CASE.results(
        run,
        summary=summary,
        verdicts=verdicts,
        sections=[
            Section(title="From spherical to rigid", items=[tilt_chart, table]),
            Section(
                title="A ring of rollers",
                items=[
                    Text(
                        text="Each roller is a spring between the mean motions of both faces over "
                        "its share of them. On bodies that do not give they add up to a 6x6 "
                        "spring; on those that do, ring and housing share the load otherwise. "
                        "Number, stiffness and rows are assumed."
                    ),
                    roller_chart,
                ],
            ),
        ],
        figures={
            "tilt_stiffness": (10.0**decades).tolist(),
            "moment": moments.tolist(),
            "moment_level_2": condensed.tolist(),
            "spherical_below": low,
            "rigid_above": high,
            "bearing": BEARING,
        },
    )


def _order(decades: Any, errors: Any, first: bool) -> float:
    """Slope of the error over the two outermost points of the sweep."""
    import numpy as np

    x, y = (decades[:2], errors[:2]) if first else (decades[-2:], errors[-2:])
    return float(np.diff(np.log10(y))[0] / np.diff(x)[0])


def _reached(stiffness: Any, moments: Any, share: float) -> float:
    """Stiffness at which so much of the largest moment is reached."""
    import numpy as np

    return float(10.0 ** np.interp(share * moments[-1], moments, np.log10(stiffness)))


def _share(stiffness: float, fine: Any, curve: Any) -> float:
    import numpy as np

    return float(100 * np.interp(stiffness, fine, curve) / curve[-1])


CASE = Case(
    name="fidelity/bearing_joints",
    title="The bearing's joint: bonded, 6x6 spring, rollers, spherical",
    source="Stirling 2023 (scene; tilt stiffness); Nejad et al. 2016; rollers assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
