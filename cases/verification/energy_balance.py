"""Energy in equals energy stored, part by part and spring by spring, gravity included."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: A typical mean load: hub forces [N] and moments [N m] (Fx 200 kN, Fz -370 kN, My 660 kN m), then
#: accelerations, and the weight of the gearbox.
HUB = (200e3, 0.0, -370e3, 0.0, 660e3, 0.0)


def run(run: Run) -> Any:
    """Clapeyron's theorem for ten unit loads and for a working load with gravity, both scenes."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        scenes,
    )
    from fe_drivetrain.common import GRAVITY
    from fe_drivetrain.report import Chart, Section, Table, Text, judge
    from fe_drivetrain.response import LOADS

    verdicts, charts = [], []
    rows: list[list[Any]] = []
    worst = {}
    for kind in scenes.KINDS:
        model, response = scenes.solved(run, kind)
        work = scenes.work(model, response)
        stored = dict(response.strain_energy)
        for point, k in model.springs:
            motion = response.motions[point.name]
            stored[f"springs of the {point.name}"] = motion.T @ k @ motion
        total = np.sum(list(stored.values()), axis=0)
        own = work.diagonal()
        imbalance = np.abs(total.diagonal() - own) / own
        working = np.array([*HUB, 0.0, 0.0, -GRAVITY, model.scene.gearbox.weight])
        put_in, kept = 0.5 * working @ work @ working, 0.5 * working @ total @ working
        worst[kind] = float(max(imbalance.max(), abs(kept / put_in - 1.0)))
        common: dict[str, Any] = {
            "tolerance": 1e-9,
            "source": "Clapeyron: half the work of the loads is stored",
            "reason": "the energy error at which the solver stops",
        }
        verdicts += [
            judge(
                f"{kind}: work less energy stored, largest of ten unit loads, relative",
                float(imbalance.max()),
                0.0,
                relative=False,
                measure="identity",
                band=response.energy_error,
                **common,
            ),
            judge(
                f"{kind}: energy stored under a working load, gravity and gearbox weight",
                float(kept),
                float(put_in),
                unit="J",
                measure="energy",
                band=response.energy_error * float(put_in),
                **common,
            ),
        ]
        loads = np.vstack([np.eye(10), working])
        labels = [*LOADS, "working load"]
        energies = {
            part: 0.5 * np.einsum("li,ij,lj->l", loads, e, loads) for part, e in stored.items()
        }
        done = 0.5 * np.einsum("li,ij,lj->l", loads, work, loads)
        for j, label in enumerate(labels):
            in_all = sum(float(e[j]) for e in energies.values())
            rows.append([kind, label, float(done[j]), in_all, in_all / float(done[j]) - 1.0])
        charts.append(
            Chart(
                caption=f"{kind}: where the work of each load is stored",
                figure={
                    "data": [
                        {
                            "type": "bar",
                            "name": part,
                            "x": labels,
                            "y": [round(100.0 * float(v), 4) for v in e / done],
                        }
                        for part, e in energies.items()
                    ],
                    "layout": {
                        "barmode": "stack",
                        "yaxis": {"title": {"text": "share of the work [%]"}},
                    },
                },
            )
        )
    return CASE.results(
        run,
        summary=[
            "Half the work of the loads is found again in parts and springs to "
            f"{worst['spherical']:.0e} in the spherical and {worst['bonded']:.0e} in the bonded "
            "scene, gravity included.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Energy",
                items=[
                    Text(
                        text="Work: the nodal loads on the nodal displacements. Stored: strain "
                        "energy of each part by its own stiffness, and of the springs at the "
                        "gearbox by their motion. Joint, couplings and supports do no work. The "
                        f"working load is Fx {HUB[0] / 1e3:g} kN, Fz {HUB[2] / 1e3:g} kN, My "
                        f"{HUB[4] / 1e3:g} kN m at the hub with self-weight and the gearbox's "
                        "weight, applied from the unstressed state."
                    ),
                    *charts,
                    Table(
                        caption="Work of each load and energy stored",
                        columns=["scene", "load", "work / 2 [J]", "stored [J]", "difference [-]"],
                        rows=rows,
                    ),
                ],
            )
        ],
    )


CASE = Case(
    name="verification/energy_balance",
    title="Energy in equals energy stored",
    source="exact: Clapeyron's theorem",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
