"""Two drivetrains of 3 MW and one of 2 MW with every gear a mass, against their table."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: What each table of inputs needs in place of one entry, and the number in Table 6.4 (from 1) that
#: it is solved for.
RESTORED = {
    "B": ("stages.1.carrier", "carrier of stage 2 [kg m^2]", 3),
    "C": ("stages.1.pinion", "pinion of the first parallel stage [kg m^2]", 9),
}
#: Numbers of Table 6.4 that neither the inputs nor those explain; shown.
ASTRAY = {"A": frozenset[int](), "B": frozenset({2}), "C": frozenset({2})}
#: Parts that the first frequency above zero rests on, either of which could restore it.
BEHIND_IT = {"B": ("HSS", "generator"), "C": ("LSS", "generator")}


def run(run: Run) -> Any:
    """Frequencies against Table 6.4, and what restores it where it is not of its inputs."""
    import numpy as np
    from scipy.optimize import brentq

    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, trace
    from fe_drivetrain.torsion import (
        Drivetrain,
        Torsional,
        changed,
        gear_masses,
        gear_speeds,
        natural_modes,
        stage_masses,
    )
    from fe_drivetrain.validation import (
        independent_torsion,
    )

    def free(table: Drivetrain) -> Torsional:
        return gear_masses(table, "free")

    def seen_of(table: Drivetrain) -> Any:
        modes = natural_modes(free(table))
        return modes.frequencies[published.observable(modes)]

    verdicts: list[Any] = []
    sections, summary = [], []
    figures: dict[str, Any] = {}
    traces = []
    for letter, printed in published.OTHERS.items():
        name = f"drivetrain_{letter.lower()}"
        table = published.table(name)
        with run.step(f"drivetrain {letter}"):
            system = free(table)
            modes = natural_modes(system)
            seen = published.observable(modes)
            f = modes.frequencies[seen]
            band = published.rounding_band(name, free)[seen]
            verdicts.append(
                published.judge_count(
                    f"drivetrain {letter}, {len(system.inertias)} masses",
                    independent_torsion.certified(system, modes.frequencies),
                )
            )
            targets = np.array([float(v) for v in printed])
            items: list[Any] = []
            columns = [
                "number",
                "Table 6.4 [Hz]",
                "by Tables 4.3 and 4.7 [Hz]",
                "half width by rounding of the inputs [Hz]",
                "difference [%]",
            ]
            rows = [
                [i + 1, printed[i], float(f[i]), float(band[i]), _percent(f[i], targets[i])]
                for i in range(len(printed))
            ]
            if letter not in RESTORED:
                verdicts += published.judge_printed(
                    f"drivetrain {letter}", f, printed, band, published.TABLE_6_4
                )
                worst = float(np.abs(f[1:] / targets[1:] - 1).max())
                summary.append(
                    f"Drivetrain {letter}: all {len(printed) - 1} frequencies above zero of Table "
                    f"6.4 follow from Tables 4.3 and 4.7 within {100 * worst:.2g} %."
                )
            else:
                key, what, number = RESTORED[letter]
                tabled = dict(published.printed_inputs(name))[key]
                value = float(
                    brentq(
                        lambda x, k=key, t=table, n=number, g=targets: float(
                            seen_of(published.changed(t, {k: x}))[n - 1] - g[n - 1]
                        ),
                        0.5 * float(tabled),
                        5 * float(tabled),
                    )
                )
                restored = published.changed(table, {key: value})
                again = natural_modes(free(restored))
                chosen = published.observable(again)
                g = again.frequencies[chosen]
                width = published.rounding_band(name, free, restored, frozenset({key}))[chosen]
                verdicts += published.judge_printed(
                    f"drivetrain {letter}, {what.partition(' [')[0]} {value:.4g} kg m^2",
                    g,
                    printed,
                    width,
                    published.TABLE_6_4,
                    leave_out=ASTRAY[letter] | {number},
                )
                columns.append(f"{what.partition(' [')[0]} {value:.4g} kg m^2 [Hz]")
                columns.append("difference [%]")
                for i, row in enumerate(rows):
                    row += [float(g[i]), _percent(g[i], targets[i])]
                off = [i for i in range(1, len(f)) if abs(f[i] / targets[i] - 1) > 0.1]
                summary.append(
                    f"Drivetrain {letter}: {_hertz(targets[off])} of Table 6.4 "
                    f"{'is' if len(off) == 1 else 'are'} not of Table 4.3, which gives "
                    f"{_hertz(f[off])}; with a {what.partition(' [')[0]} of {value:.4g} "
                    f"kg m^2 instead of {tabled} "
                    + _what_is_left(g, targets, number, ASTRAY[letter])
                )
                figures[f"{letter}_restored"] = [float(v) for v in g]
                figures[f"{letter}_restored_value"] = value
            items.append(
                Table(
                    caption=f"Drivetrain {letter}: {table.title.partition(', ')[2]}; "
                    "generator free",
                    columns=columns,
                    rows=rows,
                )
            )
            if letter == "B":
                first = float(dict(published.printed_inputs(name))["stages.0.carrier"])
                items.append(
                    Text(
                        text=f"The carrier of the first stage has {first:g} kg m^2: it seems to "
                        "have stood for the second one, too. The last two numbers swing the sun of "
                        "stage 2 and the pinion, which are given as 0.4 and 0.3 kg m^2: one digit "
                        f"leaves {100 * band[-2] / f[-2]:.0f} and {100 * band[-1] / f[-1]:.0f} %."
                    )
                )
            if letter in RESTORED:
                values = {p.name: p.inertia for p in system.inertias}
                values |= {e.name: e.stiffness for e in system.elements}
                whole = free(restored)
                needs = {
                    part: float(
                        brentq(
                            lambda x, p=part, s=whole, t=targets: float(
                                natural_modes(changed(s, {p: x})).frequencies[1] - t[1]
                            ),
                            0.5 * values[part],
                            2 * values[part],
                        )
                    )
                    for part in BEHIND_IT[letter]
                }
                shaft, generator = BEHIND_IT[letter]
                items.append(
                    Text(
                        text=f"The print's {printed[1]} Hz stays apart: it would need {shaft} of "
                        f"{needs[shaft]:.3g} N m/rad instead of {values[shaft]:.3g}, or a "
                        f"generator of {needs[generator]:.3g} kg m^2 instead of "
                        f"{values[generator]:g}. In the thesis's own simulated shutdown the torque "
                        f"swings at {published.SHUTDOWN[letter]:g} Hz (section 6.2.3); by Table "
                        f"4.3 the drivetrain does at {f[1]:.3f}."
                    )
                )
            items.append(
                published.shapes_chart(
                    f"Mode shapes of drivetrain {letter}, seen from the rotor's shaft",
                    modes,
                    gear_speeds(table),
                    seen[1:7],
                )
            )
            sections.append(Section(title=f"Drivetrain {letter}", items=items))
            figures[letter] = [float(v) for v in f]
            figures[f"{letter}_stage_masses"] = [
                float(v) for v in natural_modes(stage_masses(table, "free")).frequencies
            ]
            numbers = np.arange(2, len(f) + 1)
            traces += [
                trace(f"{letter}, computed", numbers, f[1:]),
                trace(f"{letter}, Table 6.4", numbers, targets[1:], points=True),
            ]
    peaks: list[list[Any]] = [
        [
            letter,
            float(published.OTHERS[letter][1]),
            figures[letter][1],
            figures[f"{letter}_stage_masses"][1],
            published.SHUTDOWN[letter],
        ]
        for letter in published.OTHERS
    ]
    sections.insert(
        0,
        Section(
            title="All three",
            items=[
                chart(
                    "Frequencies of drivetrains A, B and C by the inputs as printed, and those of "
                    "Table 6.4",
                    traces,
                    "number in Table 6.4",
                    "frequency [Hz]",
                    logarithmic=("y",),
                ),
                Table(
                    caption="The first frequency above zero [Hz]",
                    columns=[
                        "drivetrain",
                        "Table 6.4",
                        "every gear a mass",
                        "a mass for each stage, meshes rigid",
                        "peak in the thesis's simulated shutdown (section 6.2.3)",
                    ],
                    rows=peaks,
                ),
            ],
        ),
    )
    return CASE.results(
        run,
        summary=summary,
        verdicts=verdicts,
        sections=sections,
        assumptions=[
            AssumptionRow(
                name="axes of mesh stiffnesses",
                value="the planet's and the gear's",
                unit="",
                source="not given; found with the eleven masses of drivetrain D, kept here",
            ),
            AssumptionRow(
                name="ring gears",
                value="held",
                unit="",
                source="Table 4.3 gives them inertias; Table 6.4 has no modes of theirs",
            ),
        ],
        figures=figures,
    )


def _percent(value: float, reference: float) -> float | None:
    return float(100 * (value / reference - 1)) if reference else None


def _hertz(values: Any) -> str:
    return " and ".join(f"{v:.5g}" for v in values) + " Hz"


def _what_is_left(found: Any, targets: Any, solved: int, astray: frozenset[int]) -> str:
    """How close a restored drivetrain is, in words."""
    others = [i for i in range(1, len(targets)) if i + 1 != solved and i + 1 not in astray]
    worst = max(abs(float(found[i] / targets[i] - 1)) for i in others)
    left = "".join(
        f", but for {targets[i - 1]:g} Hz, where these give {found[i - 1]:.4g}"
        for i in sorted(astray)
    )
    return (
        f"all others follow within {100 * worst:.1f} %, which is the rounding of the inputs{left}."
    )


CASE = Case(
    name="drivetrain/drivetrains_a_b_c",
    title="Drivetrains A and B of 3 MW and C of 2 MW: natural frequencies",
    source="Al-Hamadani 2018, Tables 4.3, 4.7 and 6.4",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
