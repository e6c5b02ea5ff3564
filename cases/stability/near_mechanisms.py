"""Near-mechanisms: what soft springs hardly hold is named, with the digits that it costs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Of the gearbox's axial spring, which hardly matters [N/m].
AXIAL = 1e8

JOINTS = ("sliding", "averaged", "rigid")


def run(run: Run) -> Any:
    """Soften the springs that hold a shaft on a spherical bearing against turning."""
    import numpy as np

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
    from fe_drivetrain.interfaces import WEAK
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.response import mesh_scene

    epsilon = float(np.finfo(float).eps)
    ratios = {
        joint: decades(-17, -5, 0.5 if run.quick else 1.25)
        for joint in (JOINTS[:1] if run.quick else JOINTS)
    }
    tolerance = 0.4 if run.quick else 0.2
    verdicts, limits, sections, rows = [], [], [], []
    figures: dict[str, Any] = {}
    lowest: list[float] = []
    mesh = None
    for joint, targets in ratios.items():
        with run.step(f"{joint} joint"):
            scene = soft_springs.scene_of("spherical", joint, rigid=())
            mesh = mesh_scene(scene) if mesh is None else mesh
            loose = soft_springs.sprung(scene, mesh)
            held = soft_springs.sprung(
                soft_springs.scene_of("spherical", joint, rigid=(1, 2, 3)), mesh
            )
            loads = ["hub.Mx", "hub.My"]
            rigid = held.solve([AXIAL, 0, 0, 0, 0, 0], loads, "superlu")
            # the remedy: held rigidly, by the other solver, and the springs' own give added
            mended = held.solve([AXIAL, 0, 0, 0, 0, 0], loads, "multigrid")
            assert rigid is not None
            assert mended is not None
            # both motions at one ratio: it is proportional to the spring
            unit = {
                motion.description.split(" through")[0].rsplit(" ", 1)[-1]: motion.ratio
                for motion in loose.weakest([AXIAL, 1.0, 1.0, 1.0, 0, 0])
            }
            _, at_zero = loose.said([AXIAL, 0, 0, 0, 0, 0])
            arm = scene.shaft.rear
            found: dict[str, list[float]] = {"spin about x": [], "tilt about y": []}
            remedy: list[float] = []
            warned: list[tuple[str, ...]] = []
            refused: list[str] = []
            for ratio in targets:
                spin, radial = ratio / unit["x"], ratio / unit["y"]
                springs = [AXIAL, radial, radial, spin, 0, 0]
                warnings, refusal = loose.said(springs)
                answer = None if refusal else loose.solve(springs, loads, "superlu")
                warned.append(warnings)
                refused.append(refusal or ("" if answer else "singular"))
                exact = (
                    rigid.hub[3, 0] + 1.0 / spin,
                    rigid.hub[4, 1] + 1.0 / (radial * arm**2),
                )
                remedy.append(
                    max(
                        abs((mended.hub[3, 0] + 1.0 / spin) / exact[0] - 1.0),
                        abs((mended.hub[4, 1] + 1.0 / (radial * arm**2)) / exact[1] - 1.0),
                    )
                )
                for name, row, column in (("spin about x", 3, 0), ("tilt about y", 4, 1)):
                    value = np.nan if answer is None else answer.hub[row, column]
                    found[name].append(abs(value / exact[column] - 1.0))
        predicted = epsilon / targets
        has_warning = np.array([bool(w) for w in warned])
        errors = {name: np.array(values) for name, values in found.items()}
        worst = np.fmax(*errors.values())
        answered = np.isfinite(worst)
        for name, error in errors.items():
            usable = answered & (error > 0.0) & (error < 0.1) & (targets < 1e-5)
            factor = np.log10(error[usable] / predicted[usable])
            verdicts += [
                judge(
                    f"{joint} joint, {name}: error against the restraint, exponent",
                    slope(targets[usable], error[usable]),
                    -1.0,
                    tolerance=tolerance,
                    source="round-off of the bodies' stiffness acts as springs to ground",
                    reason="round-off scatters by about a decade over the decades of the fit",
                    measure="order",
                    band=tolerance / 2,
                ),
                judge(
                    f"{joint} joint, {name}: digits lost, less those that the program names, mean",
                    float(factor.mean()),
                    0.0,
                    tolerance=2.0,
                    relative=False,
                    unit="digits",
                    source="2e-16 over the ratio that the warning gives",
                    reason="an estimate of round-off without constants: the two digits that the "
                    "threshold of the warning has to spare",
                    measure="identity",
                    band=float(factor.std() / np.sqrt(len(factor))),
                ),
            ]
        verdicts.append(
            judge(
                f"{joint} joint: held rigidly, and moment over stiffness added: worst error at any "
                "spring",
                max(remedy),
                0.0,
                tolerance=1e-8,
                relative=False,
                source="statics, and the held shaft by a direct solver",
                reason="the iteration stops at 1e-9 in the energy norm",
                measure="identity",
            )
        )
        silent = answered & ~has_warning & ~(worst < FOUR_DIGITS)
        at = int(np.argmin(np.abs(np.log10(targets) + 12.0)))
        named = [
            any(f"nearly turn about {axis}" in w for w in warned[at]) for axis in ("x", "y", "z")
        ]
        verdicts += [
            judge(
                quantity,
                float(value),
                1.0,
                tolerance=0.0,
                source=source,
                reason="yes or no",
                measure="identity",
            )
            for quantity, value, source in (
                (
                    f"{joint} joint: springs of 1e-12 of the shaft: warned of by name, about each "
                    "of three axes",
                    all(named),
                    "a shaft on a sphere turns about three axes",
                ),
                (
                    f"{joint} joint: no springs: refused, and the free motions named",
                    all(f"turn freely about {axis}" in at_zero for axis in "xyz"),
                    "a shaft on a sphere turns about three axes",
                ),
                (
                    f"{joint} joint: every answer without four digits was warned of or refused",
                    not silent.any(),
                    "statics: moment over stiffness is added to the motion when held",
                ),
                (
                    f"{joint} joint: restraints of ten times the threshold and more: silent",
                    not has_warning[targets > 10.0 * WEAK].any(),
                    "a warning that always comes is none",
                ),
            )
        ]
        low, _ = safe_range(targets, worst, FOUR_DIGITS)
        assert low is not None
        lowest.append(low)
        limits.append(
            Limit(
                method=f"soft springs as the only restraint, {joint} joint",
                parameter="work of the springs over E times length of what moves",
                low=low,
                criterion="error of the motion below 1e-4",
                beyond="the error of the motion grows tenfold a decade: about 2e-16 over the ratio",
                program=f"warns below {WEAK:.0e} with the name of the motion and the digits lost; "
                f"refuses below {targets[answered].min():.0e}, by name",
                remedy="the direction held rigidly, and moment over stiffness added: right to "
                f"{max(remedy):.0e}",
            )
        )
        rows += [
            [
                joint,
                float(t),
                *(float(e[k]) if np.isfinite(e[k]) else None for e in errors.values()),
                float(predicted[k]),
                len(warned[k]),
                refused[k][:120],
            ]
            for k, t in enumerate(targets)
        ]
        figures[joint] = {
            "ratio": targets.tolist(),
            **{n: [float(v) if np.isfinite(v) else None for v in e] for n, e in errors.items()},
        }
        text = warned[at][0] if warned[at] else ""
        sections.append(
            Section(
                title=f"{joint.capitalize()} joint",
                items=[
                    chart(
                        "Error of the rotation at the hub under a moment there, against the "
                        "rotation when held plus moment over stiffness. Shaded: four digits. "
                        "Crosses: refused",
                        [
                            *(
                                trace(
                                    name,
                                    targets[answered],
                                    np.maximum(error[answered], 1e-16),
                                    mode="lines+markers",
                                )
                                for name, error in errors.items()
                            ),
                            trace(
                                "what the warning says",
                                targets[has_warning],
                                np.minimum(predicted[has_warning], 1.0),
                                line={"dash": "dash"},
                            ),
                            trace(
                                "held, moment over stiffness added",
                                targets,
                                np.maximum(remedy, 1e-16),
                                line={"dash": "dot"},
                            ),
                            crosses("refused", targets[~answered]),
                        ],
                        "work of the springs over E times length of what moves",
                        "relative error",
                        ("x", "y"),
                        (low, None),
                    ),
                    Text(text=f"At {targets[at]:.0e} the program says: {text}"),
                ],
            )
        )
    return CASE.results(
        run,
        summary=[
            "A spring that is the only restraint of a motion leaves four digits of it down to "
            f"{shown(max(lowest))} of the stiffness of what it holds (Young's modulus times "
            f"length). The program warns from {WEAK:.0e} down, names the motion and the digits "
            "that it costs, and refuses where none is left.",
            "The error is 2e-16 over that ratio, within two digits, for each form of the joint.",
        ],
        verdicts=verdicts,
        sections=[
            *sections,
            Section(
                title="All points",
                items=[
                    Table(
                        caption="Errors of two motions, both restrained alike",
                        columns=[
                            "joint",
                            "ratio",
                            "error of the spin",
                            "error of the tilt",
                            "2e-16 over the ratio",
                            "warnings",
                            "refused",
                        ],
                        rows=rows,
                    )
                ],
            ),
        ],
        limits=limits,
        figures=figures,
    )


CASE = Case(
    name="stability/near_mechanisms",
    title="Near-mechanisms: named, with the digits that they cost",
    source="statics of a shaft on a sphere; Higham 2002, Accuracy and stability of numerical "
    "algorithms, ch. 7",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
