"""Beam theory on a shaft that is held by the rim of its flange: how thick a flange it needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Flange over shaft diameter.
RATIOS = (1.4, 1.7, 2.0, 2.5, 3.0)
QUICK_RATIOS = (1.4, 2.0, 3.0)

#: Length of the shaft over its diameter.
LENGTH = 3.0

#: Ratio that the curves, limits and solids are of.
SHOWN = 2.0

#: Thickness over shaft diameter where the root's yield is measured, on the ratio shown.
MEASURED = 0.1

#: Thickest flange, over the shaft's diameter, that a plate stands for.
PLATE = 0.4


def run(run: Run) -> Any:
    """Map the error over thickness and diameter; add the flange as a plate; check both."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace

    thick = np.geomspace(0.02, 1.0, 4 if run.quick else 9)
    ratios = np.array(QUICK_RATIOS if run.quick else RATIOS)
    exact, beam, plate = np.empty((3, len(ratios), len(thick)))
    with run.step("meridians"):
        inset = _inset(MEASURED, SHOWN, _by_elements(MEASURED, SHOWN))
    thin = thick <= PLATE
    for i, ratio in enumerate(ratios):
        with run.step("meridians"):
            for j, t in enumerate(thick):
                exact[i, j] = _by_elements(t, ratio)
        beam[i] = [_by_beam(t, ratio) for t in thick]
        plate[i] = [_plate(t, ratio, inset if t <= PLATE else 0.0) for t in thick]
    error = 100 * (beam / exact - 1)
    with_plate = 100 * ((beam + plate) / exact - 1)
    shown = int(np.argmin(np.abs(ratios - SHOWN)))
    with run.step("meridians, finer"):
        places = ((shown, 0), (shown, len(thick) - 1), (-1, len(thick) // 2))
        worst = max(
            abs(exact[i, j] / _by_elements(thick[j], ratios[i], finer=True) - 1)
            for i, j in places[: 1 if run.quick else 3]
        )

    verdicts = []
    for i, ratio in enumerate(ratios):
        # what the flange adds, over the thinnest two
        more = exact[i, :2] - beam[i, :2]
        step = np.log(thick[1] / thick[0])
        yielding = [_plate(t, ratio, 1.0) / _plate(t, ratio, 0.0) for t in thick[:2]]
        verdicts.append(
            judge(
                f"flange {ratio:g} d: power of the thickness with which its flexibility goes",
                float(np.log(more[1] / more[0]) / step),
                -3.0,
                tolerance=float(np.log(yielding[1] / yielding[0]) / step),
                relative=False,
                source="Kirchhoff's plate: bending rigidity goes as the cube of the thickness",
                reason="the shaft's skin yields to the plate as if that reached on into the shaft, "
                "by a part of its thickness and at most by all: the share of that grows with the "
                "thickness by this power",
                measure="order",
                band=float(2 * worst * exact[i, 0] / more[1] / step),
            )
        )
    insets = [_inset(thick[0], ratios[i], exact[i, 0]) for i in (0, -1)]
    width = (ratios[0] - 1) / 2
    slope = (
        exact[0, 0] * worst / (_plate(thick[0], ratios[0], 1.0) - _plate(thick[0], ratios[0], 0.0))
    )
    verdicts += [
        judge(
            f"how far the plate reaches into the shaft, over its thickness of {thick[0]:g} d: "
            f"flange of {ratios[0]:g} d over one of {ratios[-1]:g} d",
            insets[0] / insets[1],
            1.0,
            tolerance=float(2 * thick[0] / width),
            relative=False,
            source="what the root of a thin plate yields hangs on the plate's own thickness alone",
            reason="the thickness is no longer small beside the width of the narrower flange: "
            "twice their ratio",
            measure="identity",
            band=float(slope / insets[1]),
        ),
        judge(
            "rotation by a moment, beam and yielding plate in series: worst error of all "
            f"flanges up to {PLATE:g} d thick",
            float(np.abs(with_plate[:, thin]).max()),
            0.0,
            tolerance=5.0,
            relative=False,
            unit="%",
            source="Fourier harmonics in the meridian",
            reason="5 % is the second line of a map; one constant, from one flange, stands for all",
            measure="rotation",
            band=100 * worst,
        ),
    ]
    if not run.quick:
        verdicts.append(_solid_verdict(run))

    low = maps.least_safe(thick, error[shown], 10.0)
    rows: list[Any] = [
        [
            float(ratio),
            *(maps.least_safe(thick, error[i], level) for level in (5.0, 10.0)),
            float(np.abs(with_plate[i, thin]).max()),
        ]
        for i, ratio in enumerate(ratios)
    ]
    line = {"color": "black"}
    return CASE.results(
        run,
        summary=[
            f"A shaft of L = {LENGTH:g} d held by the rim of a flange of {SHOWN:g} d: the beam, "
            "for which a flange is a short thick shaft, has the rotation by a moment within 10 % "
            f"only from a flange {low or float('nan'):.2g} d thick; of one {thick[0]:g} d thick it "
            f"has {100 + error[shown, 0]:.2g} % of it.",
            f"With the flange as a plate in series that reaches {inset:.2f} of its thickness into "
            f"the shaft it is within {np.abs(with_plate[:, thin]).max():.2g} % for all flanges up "
            f"to {PLATE:g} d thick.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="How ends are held",
                items=[
                    Text(
                        text="The flange's rim does not move, as with bolts close to it; its faces "
                        "are free. The shaft's other end is rigid, whose share is below 1 %. The "
                        "beam is clamped at the flange's middle. The remedy adds the rotation of "
                        "a thin plate, clamped at the rim and to a rigid boss: the harmonic "
                        "solution f = c1 r + c2 r^3 + c3 / r + M r ln r / (4 pi D) of Kirchhoff's "
                        "plate. The boss is smaller than the shaft, whose skin yields: by "
                        f"{inset:.3f} of the flange's thickness at each side, measured on a flange "
                        f"of {SHOWN:g} d, {MEASURED:g} d thick."
                    ),
                ],
            ),
            Section(
                title="Results",
                items=[
                    chart(
                        f"Error of the rotation by a moment, flange of {SHOWN:g} d, L = "
                        f"{LENGTH:g} d, against the flange's thickness; shaded is where the beam "
                        "alone is within 10 %",
                        [
                            trace(
                                "beam",
                                thick,
                                np.abs(error[shown]),
                                mode="lines+markers",
                                line=line,
                            ),
                            trace(
                                "beam and yielding plate",
                                thick[thin],
                                np.abs(with_plate[shown, thin]),
                                mode="lines+markers",
                                line={**line, "dash": "dash"},
                            ),
                        ],
                        "flange thickness over shaft diameter",
                        "error without its sign [%]",
                        ("x", "y"),
                        safe=(low, None),
                    ),
                    chart(
                        "Beam alone: lines of 1, 5 and 10 % error (too stiff)",
                        maps.map_traces(thick, ratios, error, 0.0),
                        "flange thickness over shaft diameter",
                        "flange over shaft diameter",
                        ("x",),
                    ),
                    Table(
                        caption="Least thickness over shaft diameter for errors of the beam within "
                        f"5 % and 10 %, where an empty cell is beyond {thick[-1]:g}; and the worst "
                        f"error with the plate, up to a thickness of {PLATE:g} d",
                        columns=[
                            "flange over d",
                            "beam: 5 %",
                            "beam: 10 %",
                            "beam and yielding plate [%]",
                        ],
                        rows=rows,
                    ),
                ],
            ),
        ],
        limits=[
            Limit(
                method="beam of sections, flange held by its rim",
                parameter=f"flange thickness over shaft diameter, flange {SHOWN:g} d, shaft "
                f"{LENGTH:g} d long",
                low=low,
                high=None,
                criterion="rotation by a moment within 10 %",
                beyond=f"too stiff, by {-error[shown, 0]:.0f} % of the rotation at {thick[0]:g} d: "
                "a beam's section stays flat, a plate bends",
                program="none; axisymmetric.seat_stiffness has it in tens of milliseconds",
                remedy=f"a plate in series, reaching {inset:.2f} of its thickness into the shaft: "
                f"within {np.abs(with_plate[:, thin]).max():.2g} % up to {PLATE:g} d",
            )
        ],
        figures={
            "thickness_over_diameter": thick.tolist(),
            "flange_over_diameter": ratios.tolist(),
            "percent": error.tolist(),
            "with_plate_percent": with_plate.tolist(),
        },
    )


def plate_rotation(outer: float, inner: float, thickness: float, material: Any) -> float:
    """Rotation [rad/(N m)] of a rigid boss in a plate that is clamped outside, by a moment.

    w = f(r) cos t with f = c1 r + c2 r^3 + c3 / r + M r ln r / (4 pi D), the last of which carries
    the moment (Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells, article 63);
    f = f' = 0 at the outer radius and f = r f' at the inner.
    """
    import numpy as np

    E, nu = material.youngs_modulus, material.poisson_ratio
    # in units of the outer radius, times 4 pi D / M
    b = inner / outer
    rows = np.array([[1.0, 1.0, 1.0], [1.0, 3.0, -1.0], [0.0, 2 * b**2, -2 / b**2]])
    # f / r alike and f' of r ln r: at 1, and what they differ by at b
    c = np.linalg.solve(rows, [0.0, -1.0, -1.0])
    rotation = c @ [1.0, b**2, b**-2] + np.log(b)
    rigidity = E * thickness**3 / (12 * (1 - nu**2))
    return float(abs(rotation) / (4 * np.pi * rigidity))


def _plate(thickness: float, ratio: float, inset: float) -> float:
    """Rotation of the plate that reaches some of its thickness into a shaft of 1 m diameter."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    return plate_rotation(ratio / 2, 0.5 - inset * thickness, thickness, maps.STEEL)


def _inset(thickness: float, ratio: float, exact: float) -> float:
    """How far the plate reaches into the shaft, over its thickness, for the exact rotation."""
    from scipy.optimize import brentq

    more = exact - _by_beam(thickness, ratio)
    return float(brentq(lambda k: _plate(thickness, ratio, k) - more, 0.0, 2.0))


def _shaft(thickness: float, ratio: float) -> Any:
    from fe_drivetrain.geometry import Flange, Section, Shaft

    return Shaft(
        front=0.0,
        flange=Flange(outer_diameter=ratio, thickness=thickness),
        sections=(Section(length=LENGTH, outer_diameter=1.0),),
    )


def _by_elements(thickness: float, ratio: float, finer: bool = False) -> float:
    """Rotation of the rear by a moment, the rim held."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.revolution import seat_stiffness

    shaft = _shaft(thickness, ratio)
    # what is bent at the root is as small as the flange is thick
    size = 0.12 if thickness < 0.05 else 0.25
    settings: Any = (
        {"size": 0.7 * size, "order": 7, "layers": 4} if finer else {"size": size, "layers": 3}
    )
    K = seat_stiffness(shaft, maps.STEEL, [(0.0, thickness), (shaft.rear, shaft.rear)], **settings)
    return float(np.linalg.inv(K[6:, 6:])[4, 4])


def _by_beam(thickness: float, ratio: float) -> float:
    """The same of a beam that is clamped at the middle of the flange."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    half = maps.stepped((thickness / 2, LENGTH), (ratio, 1.0))
    return float(maps.by_beam(half)[4, 4])


def _solid_verdict(run: Run) -> Any:
    """One point against curved tetrahedra."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.geometry import MeshSizes
    from fe_drivetrain.interfaces import fixed, rigid_face, rigid_point
    from fe_drivetrain.mesh import generate
    from fe_drivetrain.report import judge
    from fe_drivetrain.solve import recovery_estimate, solve_solid

    t = 0.25
    shaft = _shaft(t, SHOWN)
    with run.step("solid"):
        mesh = generate(shaft, sizes=MeshSizes(shaft=0.24, elements_per_turn=16))
        n = len(mesh.points)
        x = mesh.points[:, 0]
        radius = np.hypot(mesh.points[:, 1], mesh.points[:, 2])
        rim = np.flatnonzero((radius > SHOWN / 2 * (1 - 1e-3)) & (x < t + 1e-9))
        point = rigid_point("rear", np.array([shaft.rear, 0.0, 0.0]), 3 * n, 3 * n + 6)
        constraints = [
            fixed("rim", rim, 3 * n + 6),
            rigid_face("rear", mesh.face_nodes("shaft.rear"), mesh.points, point),
        ]
        F = np.zeros((3 * n + 6, 1))
        F[3 * n + 4] = 1.0
        found = solve_solid(mesh.points, mesh.cells, maps.STEEL.lame, constraints, F)
        estimate = recovery_estimate(
            mesh.points, [(mesh.cells, maps.STEEL.lame)], found.u[:, 0]
        ).relative
    exact = _by_elements(t, SHOWN)
    return judge(
        f"flange {SHOWN:g} d, t = {t:g} d: rotation by a moment, {3 * n:,} unknowns",
        float(found.u[3 * n + 4, 0]),
        exact,
        tolerance=3 * estimate,
        unit="rad/(N m)",
        source="Fourier harmonics in the meridian",
        reason=f"three times the estimated error of the solid, {estimate:.1g}",
        measure="rotation",
        band=3 * estimate * exact,
    )


CASE = Case(
    name="stability/beam_theory_flange",
    title="Beam theory against elasticity: a shaft held by the rim of its flange",
    source="Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells, article 63",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
