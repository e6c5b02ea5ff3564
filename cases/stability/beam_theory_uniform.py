"""Beam theory on a uniform shaft: how short it may be, for each bore."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Bore over outer diameter.
BORES = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9)
QUICK_BORES = (0.0, 0.5)

#: Where the ends' corrections are measured: lengths over diameter.
MEASURED = (3.0, 6.0)

#: Shortest shaft, over its diameter, that the corrected beam is meant for.
SHORTEST = 1.0

OF = {"deflection by a force": 2, "rotation by a moment": 4, "tension": 0}


def run(run: Run) -> Any:
    """Map the errors, correct the beam by its ends, and check against solids."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
    )

    lengths = np.append(np.geomspace(0.5, 30.0, 5 if run.quick else 8), SHORTEST)
    lengths.sort()
    bores = np.array(QUICK_BORES if run.quick else BORES)
    shear_share = np.empty((len(bores), len(lengths)))
    error = {name: np.empty_like(shear_share) for name in OF}
    corrected = {name: np.empty_like(shear_share) for name in OF}
    ends = []
    for i, bore in enumerate(bores):
        run.report(f"bore {bore:g} D")
        with run.step("meridians"):
            near = [_flexibility(length, bore) for length in MEASURED]
            far = [_flexibility(length, bore) for length in lengths]
        end = _ends(near, bore)
        ends.append(end)
        for j, length in enumerate(lengths):
            exact, beam = far[j], maps.by_beam(maps.uniform(length, bore))
            thin = maps.by_beam(maps.uniform(length, bore), shear=False)
            better = beam + _end_flexibility(end, length)
            # against Saint-Venant's own solution, which Timoshenko's beam with Cowper's k is
            shear_share[i, j] = 100 * (thin[2, 2] / beam[2, 2] - 1)
            for name, k in OF.items():
                error[name][i, j] = 100 * (beam[k, k] / exact[k, k] - 1)
                corrected[name][i, j] = 100 * (better[k, k] / exact[k, k] - 1)

    with run.step("meridians, finer"):
        short, long = lengths[0], lengths[-2]
        bands = [
            float(
                np.abs(
                    _flexibility(length, bore).diagonal()
                    / _flexibility(length, bore, finer=True).diagonal()
                    - 1
                ).max()
            )
            for length, bore in ((short, bores[0]), (short, bores[-1]), (long, bores[-1]))
        ]
    band = max(bands)

    verdicts = []
    for bore in (0.0, 0.5):
        with run.step("Saint-Venant's flexure"):
            tube = Tube(1.0, bore, 1.0, maps.STEEL)
            tip = _flexure_tip(tube, 6)
            rough = _flexure_tip(tube, 4)
        verdicts.append(
            judge(
                f"bore {bore:g} D, L = D, loads as Saint-Venant has them: mean deflection of the "
                "tip from the mean slope at the root",
                tip,
                tube.length**3 / (3 * tube.EI) + tube.length / tube.kGA,
                tolerance=1e-6,
                unit="m/N",
                source="L^3 / 3EI + L / kGA, k of Cowper 1966, J. Appl. Mech. 33, 335-340",
                reason="the field is a cubic, or with a bore smooth enough that sixth order has it "
                "to rounding",
                measure="deflection",
                band=abs(tip - rough),
            )
        )
    # longer than 3 D the two ends know nothing of each other
    apart = lengths >= 3.0
    for i, bore in enumerate(bores):
        excess = 1 / (1 + error["rotation by a moment"][i, apart] / 100) - 1
        power = np.log(excess[-1] / excess[0]) / np.log(lengths[apart][-1] / lengths[apart][0])
        verdicts.append(
            judge(
                f"bore {bore:g} D: power of L with which the shortfall of the rotation goes",
                float(power),
                -1.0,
                tolerance=0.01,
                relative=False,
                source="Saint-Venant's principle: an end keeps a fixed length from bending",
                reason="what two ends at 3 D feel of each other is e^-8; elements leave "
                f"{band:.1g} of the rotation, a hundredth of an end's share and less",
                measure="order",
                band=float(2 * band / np.abs(excess[-1]) / np.log(10.0)),
            )
        )
    usable = lengths >= SHORTEST
    for name in OF:
        worst = float(np.abs(corrected[name][:, usable]).max())
        verdicts.append(
            judge(
                f"{name}: beam corrected by its ends, worst error from L = {SHORTEST:g} D on",
                worst,
                0.0,
                tolerance=1.0,
                relative=False,
                unit="%",
                source="Fourier harmonics in the meridian",
                reason="1 % is what a map's first line promises; the ends' fields overlap by "
                "e^-2.6 or so at L = D, of an end's share of ten percent",
                measure="rotation" if name.startswith("rot") else "deflection",
                band=100 * band,
            )
        )
    verdicts += _solid_verdicts(run)

    def limit(values: Any, level: float) -> list[float | None]:
        return [maps.least_safe(lengths, row, level) for row in values]

    rows = []
    for i, bore in enumerate(bores):
        row: list[Any] = [float(bore)]
        for values in (shear_share, *error.values()):
            row += [maps.least_safe(lengths, values[i], level) for level in (1.0, 5.0)]
        rows.append(row)
    columns = ["bore over D"]
    for name in (
        "Euler-Bernoulli, deflection",
        *(f"Timoshenko, {name}" for name in OF),
    ):
        columns += [f"{name}: 1 %", f"{name}: 5 %"]

    solid = 0
    bent = "deflection by a force"
    limits = [
        Limit(
            method="Euler and Bernoulli's beam, cantilever",
            parameter="length over diameter, solid shaft",
            low=maps.least_safe(lengths, shear_share[solid], level),
            high=None,
            criterion=f"deflection by a force within {level:g} %",
            beyond=f"too stiff, by {-shear_share[solid, 0]:.0f} % of the deflection at "
            f"L = {lengths[0]:g} D: it has no shear",
            program="beams in scenes are Timoshenko's",
            remedy="Timoshenko's beam with Cowper's coefficient: exact for loads as Saint-Venant "
            "has them",
        )
        for level in (1.0, 5.0)
    ] + [
        Limit(
            method="Timoshenko's beam between rigid ends",
            parameter=f"length over diameter, bore {bores[i]:g} D",
            low=maps.least_safe(lengths, error[bent][i], 1.0),
            high=None,
            criterion="deflection by a force within 1 %",
            beyond=f"too soft, by up to {error[bent][i].max():.1f} %: "
            "rigid ends keep sections flat and round",
            program="none; the harmonics of a whole shaft take some 20 ms (axisymmetric)",
            remedy="ends' flexibility from the table added to the beam: within 1 % from "
            f"L = {maps.least_safe(lengths, corrected[bent][i], 1.0) or float('nan'):.2g} D",
        )
        for i in (0, list(bores).index(0.5))
    ]
    first = limit(error[bent], 1.0)[0]
    styles = ({"dash": "solid"}, {"dash": "dash"}, {"dash": "dot"}, {"dash": "dashdot"})
    curves = [
        trace(name, lengths, np.abs(values), mode="lines+markers", line={"color": "black", **style})
        for (name, values), style in zip(
            {
                "Euler-Bernoulli, loads as Saint-Venant has them": shear_share[solid],
                "Timoshenko, rigid ends: deflection": error[bent][solid],
                "Timoshenko, rigid ends: tension": error["tension"][solid],
                "Timoshenko with the ends' flexibility: deflection": corrected[bent][solid],
            }.items(),
            styles,
            strict=True,
        )
    ]
    axes = ("length over outer diameter", "bore over outer diameter")
    return CASE.results(
        run,
        summary=[
            "A solid cantilever is within 1 % of elasticity by Euler and Bernoulli from "
            f"L = {limit(shear_share, 1.0)[0]:.2g} D and within 5 % from "
            f"{limit(shear_share, 5.0)[0]:.2g} D; Timoshenko's beam is exact there. Between rigid "
            f"ends Timoshenko's deflection is within 1 % from {first or float('nan'):.2g} D and "
            f"within 5 % from {limit(error[bent], 5.0)[0] or float('nan'):.2g} D.",
            "A rigid end takes away a fixed length: of a solid shaft "
            f"{ends[0].moment:.3f} D of each end in bending and {ends[0].tension:.3f} D in "
            "tension. With that the beam is within 1 % for all bores from "
            f"L = {max(limit(corrected[bent], 1.0), key=lambda v: v or np.inf):.2g} D.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="How ends are held",
                items=[
                    Text(
                        text="Two questions are kept apart. What a beam lacks by itself shows "
                        "under loads that are spread over both end sections as Saint-Venant's "
                        "solution has them: then Timoshenko's beam with Cowper's coefficient "
                        "is exact for every length, and Euler and Bernoulli's lacks shear. What an "
                        "end costs shows with rigid end faces, as of a shaft between stiff "
                        "flanges: these keep sections flat and round, which no beam knows, so that "
                        "the shaft is stiffer than its beam however long; only the share falls, as "
                        "D / L. "
                        "In torsion rigid ends disturb nothing: G J / L is exact at any length."
                    ),
                ],
            ),
            Section(
                title="Solid shaft",
                items=[
                    chart(
                        "Error of the beam against its length; shaded is where Timoshenko's "
                        "deflection is within 1 % between rigid ends. Torsion has no error",
                        curves,
                        "length over diameter",
                        "error without its sign [%]",
                        ("x", "y"),
                        safe=(first, None),
                    ),
                ],
            ),
            Section(
                title="Maps",
                items=[
                    chart(
                        "Timoshenko's beam between rigid ends, deflection by a force at the tip: "
                        "lines of 1, 5 and 10 % error (too soft)",
                        maps.map_traces(lengths, bores, error[bent]),
                        *axes,
                        ("x",),
                    ),
                    chart(
                        "Timoshenko's beam between rigid ends, tension: lines of 1, 5 and 10 % "
                        "error (too soft)",
                        maps.map_traces(lengths, bores, error["tension"]),
                        *axes,
                        ("x",),
                    ),
                    chart(
                        "Euler and Bernoulli's cantilever, deflection by a force at the tip, loads "
                        "as Saint-Venant has them: lines of 1, 5 and 10 % error (too stiff)",
                        maps.map_traces(lengths, bores, shear_share, 2.0),
                        *axes,
                        ("x",),
                    ),
                    Table(
                        caption="Least length over diameter for errors within 1 % and 5 %; at "
                        f"{lengths[0]:g} the sweep begins, and an empty cell is beyond "
                        f"{lengths[-1]:g}",
                        columns=columns,
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="The remedy: what a rigid end takes away",
                items=[
                    Table(
                        caption="Each rigid end adds to the beam's flexibility, at its own face: "
                        "rotation by a moment -a D / EI, motion by a force c D^3 / EI, motion by a "
                        "moment (and rotation by a force) b D^2 / EI, motion by tension -e D / EA. "
                        f"Measured at L = {MEASURED[0]:g} D and {MEASURED[1]:g} D",
                        columns=[
                            "bore over D",
                            "a",
                            "b",
                            "c",
                            "e",
                            f"worst error with them from L = {SHORTEST:g} D on [%]",
                        ],
                        rows=[
                            [
                                float(bore),
                                *(e.moment, e.mixed, e.force, e.tension),
                                max(float(np.abs(v[i, usable]).max()) for v in corrected.values()),
                            ]
                            for i, (bore, e) in enumerate(zip(bores, ends, strict=True))
                        ],
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={
            "length_over_diameter": lengths.tolist(),
            "bore_over_diameter": bores.tolist(),
            "timoshenko_deflection_percent": error[bent].tolist(),
            "band": band,
        },
    )


def _flexibility(length: float, bore: float, finer: bool = False) -> Any:
    """Of a shaft of 1 m diameter between rigid ends."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    shaft = maps.uniform(length, bore)
    size = 0.34 if length < 5 else 0.5
    return maps.by_elements(shaft, size * 0.7, 8, 5) if finer else maps.by_elements(shaft, size)


def _ends(measured: Any, bore: float) -> Any:
    """What a rigid end takes away, of a shaft of 1 m diameter, from two lengths."""
    from types import SimpleNamespace

    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
    )

    tube = Tube(1.0, bore, 1.0, maps.STEEL)
    left = [
        found - maps.by_beam(maps.uniform(length, bore))
        for length, found in zip(MEASURED, measured, strict=True)
    ]
    a = -left[0][4, 4] / 2 * tube.EI
    # deflection by a force: -a L^2 + 2 b L + 2 c
    rows = np.array([[2 * length, 2.0] for length in MEASURED])
    rest = [e[2, 2] * tube.EI + a * L**2 for e, L in zip(left, MEASURED, strict=True)]
    b, c = np.linalg.solve(rows, rest)
    return SimpleNamespace(
        moment=float(a),
        mixed=float(b),
        force=float(c),
        tension=float(-left[0][0, 0] / 2 * tube.EA),
        tube=tube,
    )


def _end_flexibility(end: Any, length: float) -> Any:
    """Of both ends, for a force or a moment at the rear."""
    import numpy as np

    found = np.zeros((6, 6))
    found[4, 4] = -2 * end.moment / end.tube.EI
    bent = -end.moment * length**2 + 2 * end.mixed * length + 2 * end.force
    found[2, 2] = bent / end.tube.EI
    found[0, 0] = -2 * end.tension / end.tube.EA
    return found


def _flexure_tip(tube: Any, order: int) -> float:
    """Mean deflection of the tip by 1 N, loads on both ends as Saint-Venant has them."""
    from functools import partial

    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.geometry import LENGTH_TOLERANCE
    from fe_drivetrain.revolution import (
        along_sides,
        freedoms,
        harmonic_response,
        meridian,
        surface_loads,
    )
    from fe_drivetrain.validation.shaft_theory import (
        flexure_stress,
    )

    mesh = meridian(maps.uniform(tube.length, tube.inner, tube.outer), order=order, layers=0)

    def traction(at: Any, normal: Any) -> Any:
        x, r = at.T
        up = flexure_stress(np.column_stack([x, 0 * r, r]), 1.0, tube)
        aside = flexure_stress(np.column_stack([x, r, 0 * r]), 1.0, tube)
        # round the circumference is along -z a quarter turn on
        return normal[:, :1] * np.column_stack([up[:, 0], up[:, 5], -aside[:, 5]])

    ends = [mesh.sides(partial(_at, end)) for end in (0.0, tube.length)]
    loads = surface_loads(mesh, 1, np.vstack(ends), traction)
    rim = mesh.where(lambda x, r: (x < LENGTH_TOLERANCE) & (r > tube.outer / 2 - LENGTH_TOLERANCE))
    held = (np.concatenate([freedoms(rim, 0), freedoms(rim, 1)]), np.zeros(2))
    u = harmonic_response(mesh, maps.STEEL, 1, loads, held).u[..., 0]
    means, slopes = [], []
    s, w = np.polynomial.legendre.leggauss(10)
    for end in ends:
        motion = slope = 0.0
        for cell, side in end:
            values, at, tangent = along_sides(mesh, side, np.array([cell]), (s + 1) / 2)
            ux, ur, ut = (values @ u[mesh.cells[cell]]).T
            r = at[0, :, 1]
            weight = w / 2 * np.hypot(*tangent[0].T) * np.pi * r
            motion += float(weight @ (ur - ut)) / tube.area
            slope -= float(weight @ (r * ux)) / tube.inertia
        means.append(motion)
        slopes.append(slope)
    return float(means[1] - means[0] - slopes[0] * tube.length)


def _at(end: float, x: Any, r: Any) -> Any:
    """Whether places are at an end."""
    return abs(x - end) < 1e-9


def _solid_verdicts(run: Run) -> list[Any]:
    """Points of the map against curved tetrahedra."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.report import judge
    from fe_drivetrain.validation import (
        rigid_ended_shafts,
    )

    verdicts = []
    for length, bore in () if run.quick else ((1.0, 0.0), (2.0, 0.5)):
        shaft = maps.uniform(length, bore)
        with run.step("solids"):
            mesh = rigid_ended_shafts.meshed(shaft, 0.24, 12)
            solid = rigid_ended_shafts.solved(mesh, shaft, ("bending", "tension"))
        exact = _flexibility(length, bore)
        for load, k in (("bending", 4), ("tension", 0)):
            estimate = solid.estimate[load].relative
            verdicts.append(
                judge(
                    f"L = {length:g} D, bore {bore:g} D: stiffness in {load}, {solid.unknowns:,} "
                    "unknowns",
                    solid.stiffness[load],
                    float(1 / exact[k, k]),
                    tolerance=3 * estimate,
                    unit="N/m" if k == 0 else "N m/rad",
                    source="Fourier harmonics in the meridian",
                    reason=f"three times the estimated error of the solid, {estimate:.1g}",
                    measure="stiffness",
                    band=3 * estimate * solid.stiffness[load],
                )
            )
    return verdicts


CASE = Case(
    name="stability/beam_theory_uniform",
    title="Beam theory against elasticity: uniform shafts, by length and bore",
    source="Cowper 1966, J. Appl. Mech. 33, 335-340; Love 1927, A Treatise on the Mathematical "
    "Theory of Elasticity, articles 229-231",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
