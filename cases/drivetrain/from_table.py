"""Any drivetrain from its table: ``--set table=mine.yaml``."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Frequencies, shapes, shares of energy and damping at three levels of detail."""
    import numpy as np

    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.common import InputError
    from fe_drivetrain.report import Section, Table, Text, judge
    from fe_drivetrain.torsion import (
        GENERATOR,
        ROTOR,
        Drivetrain,
        GeneratorRow,
        ParallelStage,
        PlanetaryStage,
        ShaftRow,
        damped_modes,
        gear_masses,
        gear_speeds,
        modal_damping,
        natural_modes,
        read_drivetrain,
        stage_masses,
        static_stiffness,
        two_masses,
    )
    from fe_drivetrain.validation import (
        independent_torsion,
    )

    unknown = sorted(set(run.settings) - {"table"})
    if unknown:
        raise InputError(f"setting {unknown[0]!r} is unknown: use table, a drivetrain's YAML file")
    given = run.settings.get("table")
    table = published.table("nrel_750kw") if given is None else read_drivetrain(str(given))
    states = [s for s in published.STATES if s == "free" or table.generator.stiffness > 0]
    makers = {
        "two masses": two_masses,
        "a mass for each stage": stage_masses,
        "a mass for each gear": gear_masses,
    }
    verdicts: list[Any] = []
    rows: list[list[Any]] = []
    found = {}
    for name, make in makers.items():
        for state in states:
            system = make(table, state)
            modes = natural_modes(system)
            found[name, state] = modes
            verdicts.append(
                published.judge_count(
                    f"{name}, generator {state}",
                    independent_torsion.certified(system, modes.frequencies),
                )
            )
            damping = modal_damping(system)
            rows += [
                [name, state, m + 1, float(f), float(z) if np.isfinite(z) else None]
                for m, (f, z) in enumerate(zip(modes.frequencies, damping, strict=True))
            ]
    speeds = gear_speeds(table)
    gears = gear_masses(table, "free")
    momentum = np.array([speeds[n] for n in gears.names]) * gears.J
    carried = momentum @ natural_modes(gears).shapes
    verdicts.append(
        judge(
            "a mass for each gear, generator free: largest angular momentum of a mode that swings, "
            "over that of free turning",
            float(np.abs(carried[1:] / carried[0]).max()),
            0.0,
            tolerance=1e-8,
            relative=False,
            source="no torque from outside",
            reason="modes are orthogonal to free turning but for rounding",
            measure="identity",
        )
    )
    rigid = static_stiffness(stage_masses(table, "free"), ROTOR, GENERATOR)
    verdicts.append(
        judge(
            "shafts of the stages, generator held: torque on the rotor over its angle",
            rigid,
            float(two_masses(table, "free").k[0]),
            tolerance=1e-10,
            unit="N m/rad",
            source="sum of compliances",
            reason="exact but for rounding",
            measure="stiffness",
        )
    )
    whole = static_stiffness(gears, ROTOR, GENERATOR)
    last = found["a mass for each gear", states[0]]
    shown = published.observable(last)[:6]
    swinging = damped_modes(gear_masses(table, states[0]))
    first = float(found["a mass for each gear", "free"].frequencies[1])
    return CASE.results(
        run,
        summary=[
            f"{table.title}: with the generator free, its first frequency above zero is "
            f"{found['two masses', 'free'].frequencies[1]:.4g} Hz as two masses, "
            f"{found['a mass for each stage', 'free'].frequencies[1]:.4g} with a mass for each "
            f"stage and {first:.4g} with one for each gear.",
            f"Its torsional stiffness on the rotor's side, generator held, is {whole:.4g} N m/rad; "
            f"gear meshes make {100 * (1 - whole / rigid):.1f} % of the compliance.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Modes",
                items=[
                    Table(
                        caption="Undamped natural frequencies, and damping ratios of first order",
                        columns=["model", "generator", "mode", "frequency [Hz]", "damping ratio"],
                        rows=rows,
                    ),
                    published.shapes_chart(
                        f"Mode shapes with a mass for each gear, generator {states[0]}, seen from "
                        "the rotor's shaft",
                        last,
                        speeds,
                        shown,
                    ),
                    Table(
                        caption="Where the strain energy of these modes is [%]",
                        columns=["spring", *(f"{last.frequencies[m]:.5g} Hz" for m in shown)],
                        rows=[
                            [e.name, *(float(100 * x) for x in row[shown])]
                            for e, row in zip(
                                gear_masses(table, states[0]).elements,
                                last.stiffness_shares,
                                strict=True,
                            )
                        ],
                    ),
                ],
            ),
            Section(
                title="The table",
                items=[
                    Text(
                        text="A drivetrain is one YAML file, in SI, each value about the part's "
                        "own axis; `--set table=mine.yaml` reads another one. One shaft more than "
                        "stages; a stage has either its ratio or its teeth."
                    ),
                    Table(
                        caption="Keys of the file",
                        columns=["of", "key", "what", "needed"],
                        rows=[
                            [
                                owner,
                                key,
                                field.description or "",
                                field.is_required() or key == "kind",
                            ]
                            for owner, model in (
                                ("drivetrain", Drivetrain),
                                ("each of shafts", ShaftRow),
                                ("stage of kind planetary", PlanetaryStage),
                                ("stage of kind parallel", ParallelStage),
                                ("generator", GeneratorRow),
                            )
                            for key, field in model.model_fields.items()
                        ],
                    ),
                    Text(text=f"Read here: {table.model_dump_json(exclude_none=True)}"),
                ],
            ),
        ],
        figures={
            "frequencies": {
                f"{name}, {state}": [float(v) for v in modes.frequencies]
                for (name, state), modes in found.items()
            },
            "static_stiffness": whole,
            "damping_ratios": [float(v) for v in swinging.ratios],
        },
    )


CASE = Case(
    name="drivetrain/from_table",
    title="Torsional frequencies of any drivetrain from its table",
    source="Al-Hamadani 2018, Eq 4.8-4.38; the default is drivetrain D of Table 4.2",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
