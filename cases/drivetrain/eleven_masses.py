"""Every gear a mass, meshes as springs: the NREL 750 kW drivetrain with eleven masses."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Modes of Table 6.1 that do not follow from the inputs of Table 4.2; shown, and restored below.
ASTRAY = frozenset({3, 4, 5, 6, 8})
#: Factors on all mesh stiffnesses, as in the thesis's Fig 6.9.
FACTORS, QUICK_FACTORS = 41, 11


def run(run: Run) -> Any:
    """Frequencies against Table 6.1, the axes that meshes are about, and what restores the rest."""
    from functools import partial

    import numpy as np
    from scipy.optimize import brentq, fsolve

    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.torsion import (
        GENERATOR,
        ROTOR,
        Drivetrain,
        changed,
        gear_masses,
        gear_speeds,
        natural_modes,
        stage_masses,
        static_stiffness,
    )
    from fe_drivetrain.validation import (
        independent_torsion,
    )

    name = "nrel_750kw"
    table = published.table(name)
    planetary, first, second = published.nrel_stages(table)
    verdicts: list[Any] = []
    rows: list[list[Any]] = []
    systems = {state: gear_masses(table, state) for state in published.STATES}
    found = {state: natural_modes(system) for state, system in systems.items()}
    shown = {state: published.observable(modes) for state, modes in found.items()}
    with run.step("frequencies of Table 4.2"):
        for state, system in systems.items():
            seen = shown[state]
            f = found[state].frequencies
            band = published.rounding_band(name, partial(gear_masses, generator=state))
            verdicts += published.judge_printed(
                f"11 masses, generator {state}",
                f[seen],
                published.ELEVEN[state],
                band[seen],
                published.TABLE_6_1,
                leave_out=ASTRAY,
            )
            verdicts.append(
                published.judge_count(
                    f"11 masses, generator {state}", independent_torsion.certified(system, f)
                )
            )
            printed = dict(zip(seen.tolist(), published.ELEVEN[state], strict=True))
            rows += [
                [
                    state,
                    m + 1,
                    float(f[m]),
                    float(band[m]),
                    printed.get(m, "planets against each other"),
                ]
                for m in range(len(f))
            ]
        pair = float(
            np.sqrt((planetary.ring_planet + planetary.sun_planet) / planetary.planet) / (2 * np.pi)
        )
        hidden = np.setdiff1d(np.arange(11), shown["fixed"])
        for m in hidden:
            verdicts.append(
                judge(
                    f"11 masses: planets against each other, the rest still, mode {m + 1}",
                    float(found["fixed"].frequencies[m]),
                    pair,
                    tolerance=1e-9,
                    unit="Hz",
                    source="sqrt((K_RP + K_SP) / J_P) / 2 pi",
                    reason="exact but for rounding",
                    measure="frequency",
                )
            )
        speeds = gear_speeds(table)
        turning = np.array([speeds[part] for part in systems["free"].names])
        largest = float(np.abs(systems["free"].B @ turning).max())
        verdicts.append(
            judge(
                "11 masses: largest winding of a spring while all turn at their ratios",
                largest,
                0.0,
                tolerance=1e-12,
                relative=False,
                source="a gearbox without load turns freely",
                reason="exact but for rounding, of ratios up to 81",
                measure="identity",
            )
        )
        n1, n2, n3 = (stage.speed_ratio for stage in table.stages)
        p, count = planetary.planet_over_sun, planetary.planets
        per_planet = (
            p / n1
        ) ** 2 / count  # (torque about a planet / rotor's torque)^2, all planets
        series = 1 / (
            1 / table.shafts[0].stiffness
            + per_planet * (1 / planetary.ring_planet + 1 / planetary.sun_planet)
            + (1 / table.shafts[1].stiffness + 1 / first.mesh) / n1**2
            + (1 / table.shafts[2].stiffness + 1 / second.mesh) / (n1 * n2) ** 2
            + 1 / table.shafts[3].stiffness / (n1 * n2 * n3) ** 2
        )
        stiffness = static_stiffness(systems["free"], ROTOR, GENERATOR)
        verdicts.append(
            judge(
                "11 masses: torque on the rotor over its angle, generator held",
                stiffness,
                float(series),
                tolerance=1e-10,
                unit="N m/rad",
                source="flow of torque through shafts and meshes, in series",
                reason="exact but for rounding",
                measure="stiffness",
            )
        )
        meshes = [e.name for e in systems["fixed"].elements if "stage" in e.name]

        def with_meshes(factor: float, state: Any = "fixed") -> Any:
            system = systems[state]
            values = {e.name: e.stiffness * factor for e in system.elements if e.name in meshes}
            return natural_modes(changed(system, values)).frequencies

        # the five-mass model, and the inertia that Eq 4.9 leaves out
        spinning = planetary.planets * planetary.planet * planetary.planet_speed**2
        rigid = stage_masses(table)
        rigid = changed(rigid, {"stage 1": float(rigid.J[1] + spinning)})
        limit = natural_modes(rigid).frequencies
        stiff = with_meshes(1e7)[:5]
        verdicts.append(
            judge(
                "11 masses, meshes 1e7 times as stiff: largest relative distance of the first five "
                "frequencies from five masses whose planets turn",
                float(np.abs(stiff / limit - 1).max()),
                0.0,
                tolerance=1e-4,
                relative=False,
                source="rigid meshes",
                reason="a mesh's share in a mode falls as its stiffness rises: at 1e7, shafts and "
                "meshes of like stiffness leave some 1e-7, and the stiffest shafts 1e-5",
                measure="identity",
            )
        )

    with run.step("axes that the meshes are about"):
        axes = _readings(table, np)
    with run.step("inputs that restore the table"):
        targets = np.array([float(v) for v in published.ELEVEN["fixed"]])
        chosen = [4, 5]  # 353 and 748 Hz: of three digits, and the most moved by each of the two

        def with_parts(carrier: float, planet: float) -> Drivetrain:
            return published.changed(
                table, {"stages.0.carrier": carrier, "stages.0.planet": planet}
            )

        def misses(x: Any) -> Any:
            modes = natural_modes(
                gear_masses(with_parts(x[0] * planetary.carrier, x[1] * planetary.planet))
            )
            return modes.frequencies[published.observable(modes)][chosen] / targets[chosen] - 1

        solved, _, converged, message = fsolve(misses, [1.6, 1.0], xtol=1e-12, full_output=True)
        if converged != 1:
            raise ArithmeticError(message)
        carrier, planet = float(solved[0] * planetary.carrier), float(solved[1] * planetary.planet)
        restored = with_parts(carrier, planet)
        modes = natural_modes(gear_masses(restored))
        seen = published.observable(modes)
        restored_f = modes.frequencies[seen]
        band = published.rounding_band(
            name,
            gear_masses,
            restored,
            without=frozenset({"stages.0.carrier", "stages.0.planet"}),
        )
        verdicts += published.judge_printed(
            f"11 masses, generator fixed, carrier of {carrier:.1f} and planets of {planet:.2f} "
            "kg m^2",
            restored_f,
            published.ELEVEN["fixed"],
            band[seen],
            published.TABLE_6_1,
            leave_out=frozenset(m + 1 for m in chosen),
        )
        # what planets on their pins add: m r_c^2, with J_p = m r_p^2 / 2 (solid) to m r_p^2 (hoop)
        reach = (1 + p) / p
        added = carrier - planetary.carrier
        hoop = planetary.planets * planetary.planet * reach**2
        disc = 2 * hoop
        share = (added - hoop) / (disc - hoop)
        verdicts.append(
            judge(
                "what the carrier lacks, between planets as hoops (0) and as solid discs (1) that "
                "go round with it",
                float(share),
                0.5,
                tolerance=0.5,
                relative=False,
                source="parallel axes: m r_c^2 of each planet, of J_P in Table 4.2",
                reason="a planet is something between the two",
                measure="mass",
            )
        )
        five = stage_masses(table)
        fitted = brentq(
            lambda J: float(
                natural_modes(changed(five, {"stage 1": J})).frequencies[3]
                - float(published.FIVE["fixed"][3])
            ),
            float(five.J[1]),
            4 * float(five.J[1]),
        )
        stage = carrier + planetary.planets * planet + n1**2 * planetary.sun
        pair_band = _band_of_fit(misses, solved, targets[chosen], published, chosen, np)
        spread = float(pair_band[0] * planetary.carrier + 3 * pair_band[1] * planetary.planet)
        half = published.digit(published.FIVE["fixed"][3]) / 2
        slope = (
            natural_modes(changed(five, {"stage 1": fitted * 1.01})).frequencies[3]
            - float(published.FIVE["fixed"][3])
        ) / (0.01 * fitted)
        verdicts.append(
            judge(
                "J_2 that five masses need for 402 Hz, from the eleven masses: carrier, three "
                "planets and N_1^2 times the sun",
                float(stage),
                float(fitted),
                tolerance=spread + abs(half / float(slope)),
                relative=False,
                unit="kg m^2",
                source="Table 6.1, five masses, mode 4",
                reason="half of the last digit of the three frequencies that either follows from",
                measure="mass",
            )
        )
    with run.step("mesh stiffness"):
        factors = np.geomspace(0.01, 1e4, QUICK_FACTORS if run.quick else FACTORS)
        swept = np.array([with_meshes(float(x)) for x in factors])
    f = found["fixed"].frequencies
    rise = float((swept[-1, :2] / f[:2]).max() - 1)
    by_meshes = float(1 - stiffness * sum(1 / k for k in _shafts_on_rotor(table)))
    relative = float(np.abs(restored_f / targets - 1).max())
    return CASE.results(
        run,
        summary=[
            f"From Table 4.2, eleven masses give {f[0]:.3f} and {f[1]:.3f} Hz with the generator "
            f"fixed, {found['free'].frequencies[1]:.3f} Hz free (Table 6.1: 0.841, 5.859, 2.44), "
            f"and {f[8]:.0f} and {f[10]:.0f} Hz (1020, 4398). Two more, both at "
            f"{pair:.1f} Hz, are planets against each other: the table's nine are all that the "
            "shafts feel.",
            "Numbers 3 to 6 and 8 of the table do not follow from its inputs; a carrier of "
            f"{carrier:.0f} kg m^2 instead of {planetary.carrier:g} and planets of {planet:.2f} "
            f"instead of {planetary.planet:g} give all nine within {100 * relative:.2f} %. The "
            f"same carrier, with its planets and the sun, makes {stage:.1f} kg m^2: the "
            f"{fitted:.1f} that Table 6.1's five masses need.",
            f"Gear meshes make {100 * by_meshes:.1f} % of the drivetrain's torsional compliance.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Frequencies",
                items=[
                    Table(
                        caption="Eleven masses of Eq 4.36-4.37 with the inputs of Table 4.2; 154, "
                        "307, 353, 748 and 1530 Hz of Table 6.1 lie outside of what rounding "
                        "explains",
                        columns=[
                            "generator",
                            "mode",
                            "frequency [Hz]",
                            "half width by rounding of the inputs [Hz]",
                            "Table 6.1 [Hz]",
                        ],
                        rows=rows,
                    ),
                    published.shapes_chart(
                        "Mode shapes, generator fixed, seen from the rotor's shaft: the first five",
                        found["fixed"],
                        speeds,
                        shown["fixed"][:5],
                    ),
                    published.shapes_chart(
                        "Mode shapes, generator fixed, seen from the rotor's shaft: the others",
                        found["fixed"],
                        speeds,
                        shown["fixed"][5:],
                    ),
                    published.shapes_chart(
                        "Mode shapes, generator free, seen from the rotor's shaft: the first five",
                        found["free"],
                        speeds,
                        shown["free"][:5],
                    ),
                ],
            ),
            Section(
                title="The axes that mesh stiffnesses are about",
                items=[
                    Table(
                        caption="Table 4.2 gives mesh stiffnesses in N m/rad and does not say "
                        "about which axis: the five frequencies that no carrier moves, for the "
                        "readings closest to Table 6.1 of all "
                        f"{len(axes)}",
                        columns=[
                            "ring-planet about",
                            "sun-planet about",
                            "parallel 1 about",
                            "parallel 2 about",
                            "mode 1 [Hz]",
                            "mode 2 [Hz]",
                            "mode 2, free [Hz]",
                            "number 7 of the table [Hz]",
                            "number 9 [Hz]",
                            "largest difference [%]",
                        ],
                        rows=axes[:6],
                    ),
                    Text(
                        text="About the planet and about the gear, the driving wheel as in Eq 4.6, "
                        "all five agree. That reading is chosen by them, so that they prove it no "
                        "more than five numbers can one choice in "
                        f"{len(axes)}; drivetrains A, B and C, read alike, are the test "
                        "(drivetrain/drivetrains_a_b_c)."
                    ),
                ],
            ),
            Section(
                title="What restores the table",
                items=[
                    Table(
                        caption="Table 6.1, generator fixed [Hz]; numbers 5 and 6 are "
                        "what carrier and planet are solved for",
                        columns=[
                            "number in the table",
                            "as printed",
                            "by Table 4.2",
                            f"carrier {carrier:.1f}, planets {planet:.2f} kg m^2",
                        ],
                        rows=[
                            [i + 1, v, float(f[shown["fixed"][i]]), float(restored_f[i])]
                            for i, v in enumerate(published.ELEVEN["fixed"])
                        ],
                    ),
                    Text(
                        text=f"The carrier lacks {added:.1f} kg m^2. Three planets that go round "
                        f"on it at r_c = {reach:.3f} r_p bring {hoop:.1f} as hoops and {disc:.1f} "
                        "as solid discs of the J_P of Table 4.2: bored planets bring what "
                        "is missing. "
                        "Table 4.2's carrier is the bare part; the model behind Table 6.1 has its "
                        "planets on it. A carrier given for `fe_drivetrain.torsion` must count "
                        "them as points."
                    ),
                ],
            ),
            Section(
                title="Mesh stiffness",
                items=[
                    chart(
                        "Frequencies over a common factor on all mesh stiffnesses (Fig 6.9 of the "
                        "thesis, which sees no impact on the lowest): above 1 the lowest two rise "
                        f"by {100 * rise:.1f} % at most, those of the gearbox until the meshes are "
                        "rigid",
                        [
                            trace(f"mode {m + 1}", factors, swept[:, m])
                            for m in (0, 1, 2, 3, 4, 5, 8, 9)
                        ],
                        "factor on the mesh stiffnesses",
                        "frequency [Hz]",
                        logarithmic=("x", "y"),
                    ),
                ],
            ),
        ],
        assumptions=[
            AssumptionRow(
                name="axis of planetary mesh stiffnesses",
                value="the planet's",
                unit="",
                source="not given; of all readings the one that gives Table 6.1",
            ),
            AssumptionRow(
                name="axis of parallel mesh stiffnesses",
                value="the gear's",
                unit="",
                source="Eq 4.6 has the driving gear's radius; gives Table 6.1",
            ),
        ],
        figures={
            "fixed": [float(v) for v in f],
            "free": [float(v) for v in found["free"].frequencies],
            "restored": [float(v) for v in restored_f],
            "restored_carrier": carrier,
            "restored_planet": planet,
            "static_stiffness": stiffness,
        },
    )


def _readings(table: Any, np: Any) -> list[list[Any]]:
    """Every axis that a mesh stiffness can be about, and what follows; the closest first.

    A stiffness about another wheel of the mesh is, about the planet or gear, (r / r_other)^2 times
    as large.
    """
    import itertools

    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.torsion import gear_masses, natural_modes

    stage = table.stages[0]
    p = stage.planet_over_sun
    ring = {"planet": 1.0, "ring": p / (1 + 2 * p), "carrier": p / (1 + p)}
    sun = {"planet": 1.0, "sun": p, "carrier": p / (1 + p)}
    parallel = [{"gear": 1.0, "pinion": s.speed_ratio} for s in table.stages[1:]]
    values = [float(published.ELEVEN["fixed"][i]) for i in (0, 1, 6, 8)]
    values.insert(2, float(published.ELEVEN["free"][1]))
    rows = []
    for a, b, c, d in itertools.product(ring, sun, *parallel):
        other = published.changed(
            table,
            {
                "stages.0.ring_planet": stage.ring_planet * ring[a] ** 2,
                "stages.0.sun_planet": stage.sun_planet * sun[b] ** 2,
                "stages.1.mesh": table.stages[1].mesh * parallel[0][c] ** 2,
                "stages.2.mesh": table.stages[2].mesh * parallel[1][d] ** 2,
            },
        )
        fixed = natural_modes(gear_masses(other))
        f = fixed.frequencies[published.observable(fixed)]
        free = natural_modes(gear_masses(other, "free")).frequencies[1]
        five = [f[0], f[1], free, f[6], f[8]]
        worst = max(abs(x / v - 1) for x, v in zip(five, values, strict=True))
        rows.append([a, b, c, d, *(float(x) for x in five), float(100 * worst)])
    return sorted(rows, key=lambda row: row[-1])


def _band_of_fit(
    misses: Any, solved: Any, targets: Any, published: Any, chosen: Any, np: Any
) -> Any:
    """Half widths of the factors that two frequencies are solved for, by their last digits."""
    step = 1e-5
    jacobian = np.column_stack(
        [
            (misses(solved + step * unit) - misses(solved - step * unit)) / (2 * step)
            for unit in np.eye(2)
        ]
    )
    half = np.array([published.digit(published.ELEVEN["fixed"][m]) / 2 for m in chosen]) / targets
    return np.abs(np.linalg.inv(jacobian)) @ half


def _shafts_on_rotor(table: Any) -> list[float]:
    return [s**2 * shaft.stiffness for shaft, s in zip(table.shafts, table.speeds, strict=True)]


CASE = Case(
    name="drivetrain/eleven_masses",
    title="NREL 750 kW drivetrain as eleven masses, generator fixed and free",
    source="Al-Hamadani 2018, Eq 4.36-4.38, Tables 4.2, 6.1 and 6.3",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
