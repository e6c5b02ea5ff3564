"""Low-speed shaft from finite elements instead of J G / L: what the frequencies make of it."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements round a turn of the meshes.
TURNS, QUICK_TURNS = (8, 11, 14), (8, 9, 10)
#: Fillets of the variants [m], beside a sharp step.
FILLETS, QUICK_FILLETS = (0.01, 0.02), (0.02,)


def run(run: Run) -> Any:
    """Stiffness by sections, meridian and solid, and two, five and eleven masses with each."""
    import numpy as np
    from scipy.optimize import brentq

    from fe_drivetrain.cases.drivetrain import (
        low_speed_shaft as lss,
    )
    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.torsion import (
        frequency_bands,
        gear_masses,
        natural_modes,
        stage_masses,
        two_masses,
    )
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    table = published.table("nrel_750kw")
    row = table.shafts[0]
    tabled = row.stiffness
    half_digit = published.digit("3.69e7") / 2
    found = lss.implied(tabled, row.damping)
    shaft = lss.stepped(found.length, tabled)
    verdicts: list[Any] = []

    with run.step("meridian"):
        straight = lss.meridian_stiffness(lss.uniform(found), found.diameter)
        orders = (2, 3, 4)
        size = 0.3 if run.quick else 0.2
        series = [lss.meridian_stiffness(shaft, size, order) for order in orders]
        meridian = series[-1]
        meridian_band = abs(series[-1] - series[-2])
        sharp = lss.stepped(found.length, tabled, 0.0)
        at_sharp = [
            lss.meridian_stiffness(sharp, 0.3, order) for order in ((3, 4) if run.quick else (5, 6))
        ]
        fillets: list[list[float]] = [
            [0.0, at_sharp[1]],
            *(
                [r, lss.meridian_stiffness(lss.stepped(found.length, tabled, r), 0.3, 3)]
                for r in (QUICK_FILLETS if run.quick else FILLETS)
            ),
            [lss.FILLET, meridian],
        ]
        bounds = torsion_bounds(sharp, lss.SHEAR_MODULUS, 0.1, 2 if run.quick else 5)
    verdicts += [
        judge(
            "uniform shaft, meridian",
            straight,
            tabled,
            tolerance=1e-9,
            unit="N m/rad",
            source="J G / L, Eq 4.4",
            reason="rigid ends do not disturb Saint-Venant's torsion of a circle, and the elements "
            "hold it: rounding",
            measure="stiffness",
            band=1e-9 * tabled,
        ),
        judge(
            "shaft with sharp steps, meridian",
            at_sharp[1],
            bounds.middle,
            tolerance=bounds.half_width / bounds.middle,
            unit="N m/rad",
            source="between two bounds: of displacements, and of the torsion function",
            reason="the exact stiffness lies between the bounds",
            measure="stiffness",
            band=abs(at_sharp[1] - at_sharp[0]),
        ),
    ]
    turns = QUICK_TURNS if run.quick else TURNS
    solids, unknowns = [], []
    for turn in turns:
        with run.step("mesh and solve in three dimensions"):
            mesh = lss.meshed(shaft, turn)
            solids.append(lss.solid_stiffness(mesh))
            unknowns.append(int(mesh.points.size))
        if len(solids) == 1:
            with run.step("front face free to deform"):
                averaged = lss.solid_stiffness(mesh, rigid=False)
    grid = grid_convergence(1 / np.array(turns), solids, least_order=1.0)
    verdicts.append(
        judge(
            f"shaft with fillets in three dimensions, {unknowns[-1]:,} unknowns",
            grid.finest,
            meridian,
            tolerance=(2 if run.quick else 1) * half_digit / tabled,
            unit="N m/rad",
            source=f"meridian, order {orders[-1]}, rigid ends",
            reason="half of the last printed digit of K_LSS (of the coarser meshes of a quick run, "
            "all of it): a better stiffness would not be seen",
            measure="stiffness",
            band=grid.uncertainty,
        )
    )
    # the coupling's part, on one mesh, which is why that series' band counts beside it
    softer = averaged / solids[0]
    low = meridian * min(softer, 1.0) - meridian_band - grid.uncertainty
    high = meridian * max(softer, 1.0) + meridian_band + grid.uncertainty
    middle, half = (low + high) / 2, (high - low) / 2
    change = middle / tabled - 1

    makers = {"2 masses": two_masses, "5 masses": stage_masses, "11 masses": gear_masses}
    models = {
        (name, state, mode): (make, state, mode)
        for name, make in makers.items()
        for state, mode in (("fixed", 0), ("fixed", 1), ("free", 1))
    }

    def frequency(make: Any, state: Any, mode: int, K: float) -> float:
        other = published.changed(table, {"shafts.0.stiffness": K})
        return float(natural_modes(make(other, state)).frequencies[mode])

    def first_order(make: Any, state: Any, mode: int, K: float, width: float) -> float:
        """Half width [Hz] for K with a half width [N m/rad], by the share of energy."""
        system = make(published.changed(table, {"shafts.0.stiffness": K}), state)
        # the one spring of two masses is all shafts in series: K has so much of its compliance
        spring, part = (row.name, 1.0) if make is not two_masses else ("shafts", system.k[0] / K)
        return float(frequency_bands(system, {spring: float(part) * width / K})[mode])

    rows: list[list[Any]] = []
    shares: list[list[Any]] = []
    with run.step("frequencies"):
        for (name, state, mode), what in models.items():
            before = frequency(*what, tabled)
            after = frequency(*what, middle)
            ends = frequency(*what, low), frequency(*what, high)
            exact_band = (ends[1] - ends[0]) / 2
            band = first_order(*what, middle, half)
            step = 1e-6
            slope = (
                frequency(*what, middle * (1 + step)) / frequency(*what, middle * (1 - step)) - 1
            ) / (2 * step)
            rounding = first_order(*what, tabled, half_digit)
            rows.append(
                [
                    name,
                    state,
                    mode + 1,
                    before,
                    rounding,
                    after,
                    exact_band,
                    100 * (after / before - 1),
                ]
            )
            shares.append([name, state, mode + 1, 200 * slope])
            verdicts += [
                judge(
                    f"{name}, generator {state}, mode {mode + 1}: half width of the band, of first "
                    "order",
                    band,
                    exact_band,
                    tolerance=half / middle,
                    unit="Hz",
                    source="solved again at both ends of the stiffness's band",
                    reason="the next term is as small as the band itself, relative",
                    measure="frequency",
                ),
                judge(
                    f"{name}, generator {state}, mode {mode + 1}: frequency with the "
                    "finite-element shaft, of first order",
                    before * (1 + slope * change),
                    after,
                    tolerance=change**2,
                    unit="Hz",
                    source="solved again with the other stiffness",
                    reason="of second order in the change of stiffness",
                    measure="frequency",
                    band=exact_band,
                ),
            ]
    stiffnesses = np.linspace(0.8 * tabled, 1.06 * tabled, 40)
    charts = []
    needed: list[list[Any]] = []
    for state, mode in (("fixed", 0), ("free", 1)):
        measured = published.MEASURED[state]
        traces = [
            trace(name, stiffnesses, [frequency(make, state, mode, k) for k in stiffnesses])
            for name, make in makers.items()
        ]
        printed = [
            values[state][mode] for values in (published.TWO, published.FIVE, published.ELEVEN)
        ]
        traces += [
            trace(
                "Table 6.1 (J G / L)",
                [tabled] * 3,
                [float(v) for v in printed],
                points=True,
                marker={"symbol": "diamond"},
            ),
            trace(
                "finite elements",
                [middle] * 3,
                [frequency(make, state, mode, middle) for make in makers.values()],
                points=True,
            ),
            trace(
                "measured (Table 6.1)",
                stiffnesses[[0, -1]],
                [measured] * 2,
                line={"dash": "dash"},
            ),
        ]
        charts.append(
            chart(
                f"Frequency {mode + 1} with the generator {state} over the low-speed shaft's "
                "stiffness; the band of the finite elements' is shaded",
                traces,
                "stiffness of the low-speed shaft [N m/rad]",
                "frequency [Hz]",
                safe=(low, high),
            )
        )
        needed.append(
            [
                state,
                measured,
                *(
                    float(
                        brentq(
                            lambda k, m=make, s=state, n=mode, t=measured: (
                                frequency(m, s, n, k) - t
                            ),
                            0.3 * tabled,
                            1.5 * tabled,
                        )
                        / tabled
                    )
                    for make in makers.values()
                ),
            ]
        )
    summary_rows = {(r[0], r[1], r[2]): r for r in rows}
    eleven = summary_rows["11 masses", "fixed", 1]
    eleven_free = summary_rows["11 masses", "free", 2]
    return CASE.results(
        run,
        summary=[
            f"A low-speed shaft with flange, step and fillets whose sections add up to Table 4.2's "
            f"{tabled / 1e7:.2f}e7 N m/rad has ({middle / 1e7:.3f} ± {half / 1e7:.3f})e7 by finite "
            f"elements, "
            f"{-100 * change:.2f} % less: sections near a step do not turn as a whole.",
            f"With eleven masses that moves 0.841 Hz (generator fixed) by {eleven[7]:.2f} % to "
            f"{eleven[5]:.4f} ± {eleven[6]:.1g} Hz and 2.44 Hz (free) by {eleven_free[7]:.2f} % to "
            f"{eleven_free[5]:.4f} ± {eleven_free[6]:.1g}; rounding of the printed stiffness alone "
            f"leaves ± {eleven[4]:.1g} and {eleven_free[4]:.1g}.",
            f"It explains little of the distance to the measured 0.806 and 2.32 Hz: eleven masses "
            f"need {needed[0][4]:.2f} and {needed[1][4]:.2f} of the tabled stiffness for those.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stiffness of the shaft",
                items=[
                    Table(
                        caption="Torsional stiffness of the low-speed shaft",
                        columns=["how", "K [N m/rad]", "half width of the band", "over Table 4.2"],
                        rows=[
                            ["Table 4.2; J G / L of a uniform shaft", tabled, half_digit, 1.0],
                            [
                                "sum of L / J G of the sections",
                                lss.in_series(shaft),
                                None,
                                lss.in_series(shaft) / tabled,
                            ],
                            [
                                "meridian, ends rigid",
                                meridian,
                                meridian_band,
                                meridian / tabled,
                            ],
                            *(
                                [
                                    f"three dimensions, {n:,} unknowns, ends rigid",
                                    K,
                                    grid.uncertainty if n == unknowns[-1] else None,
                                    K / tabled,
                                ]
                                for n, K in zip(unknowns, solids, strict=True)
                            ),
                            [
                                f"three dimensions, {unknowns[0]:,} unknowns, front face free to "
                                "deform",
                                averaged,
                                None,
                                averaged / tabled,
                            ],
                            ["taken over: from free to rigid front", middle, half, middle / tabled],
                        ],
                    ),
                    Text(text=f"In three dimensions: {grid.sentence('N m/rad')}."),
                    Table(
                        caption="The same sections with other fillets, meridian, ends rigid",
                        columns=["fillet [m]", "K [N m/rad]", "over Table 4.2"],
                        rows=[[r, K, K / tabled] for r, K in fillets],
                    ),
                ],
            ),
            Section(
                title="Frequencies",
                items=[
                    *charts,
                    Table(
                        caption="Frequencies with K_LSS = J G / L and with the finite elements'; "
                        "bands by rounding of the printed K_LSS, and by mesh and end coupling",
                        columns=[
                            "model",
                            "generator",
                            "mode",
                            "J G / L [Hz]",
                            "half width [Hz]",
                            "finite elements [Hz]",
                            "half width [Hz]",
                            "change [%]",
                        ],
                        rows=rows,
                    ),
                    Table(
                        caption="Share of the low-speed shaft in the strain energy of each mode: "
                        "df / f = share / 2 dK / K",
                        columns=["model", "generator", "mode", "share [%]"],
                        rows=shares,
                    ),
                    Table(
                        caption="K_LSS over Table 4.2's that each model needs for the measured "
                        "frequency, all else as tabled",
                        columns=[
                            "generator",
                            "measured [Hz]",
                            *makers,
                        ],
                        rows=needed,
                    ),
                ],
            ),
        ],
        assumptions=[
            AssumptionRow(
                name="length of the low-speed shaft",
                value=found.length,
                unit="m",
                source="not given; J G / K_LSS with the J that C_LSS = 2.396 N m s/rad implies by "
                "Eq 4.5",
            ),
            AssumptionRow(name="G", value=lss.SHEAR_MODULUS, unit="Pa", source="steel; not given"),
            *(
                AssumptionRow(
                    name=f"{part}: diameter and length",
                    value=f"{piece.outer_diameter:.4f}, {piece.length:.4f}",
                    unit="m",
                    source="proportions chosen, the thesis has no drawing; scaled so that the "
                    "sections add up to K_LSS",
                )
                for part, piece in zip(("flange", "body", "rear"), shaft.pieces, strict=True)
            ),
            AssumptionRow(
                name="fillets", value=lss.FILLET, unit="m", source="chosen: a tenth of the diameter"
            ),
        ],
        figures={
            "stiffness": middle,
            "stiffness_band": half,
            "meridian": meridian,
            "solids": solids,
            "change": change,
        },
    )


CASE = Case(
    name="drivetrain/fe_low_speed_shaft",
    title="NREL 750 kW drivetrain with a low-speed shaft by finite elements",
    source="Al-Hamadani 2018, Eq 4.4, 4.5, Tables 4.2 and 6.1",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
