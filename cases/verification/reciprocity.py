"""Maxwell-Betti: a unit load does the same work on another's displacements as that on its own."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Work of each of ten unit loads on the displacements under each other one, both scenes."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        scenes,
    )
    from fe_drivetrain.report import Chart, Section, Table, Text, judge
    from fe_drivetrain.response import LOADS

    verdicts, charts = [], []
    rows: list[list[Any]] = []
    worst = {}
    for kind in scenes.KINDS:
        model, response = scenes.solved(run, kind)
        work = scenes.work(model, response)
        own = np.sqrt(work.diagonal())
        asymmetry = np.abs(work - work.T) / np.outer(own, own)
        hub = response.motions["hub"][:, :6]
        hub_own = np.sqrt(hub.diagonal())
        at_hub = np.abs(hub - hub.T) / np.outer(hub_own, hub_own)
        # The smallest eigenvalue with loads scaled to the same work of their own.
        least = float(np.linalg.eigvalsh(0.5 * (work + work.T) / np.outer(own, own))[0])
        worst[kind] = float(asymmetry.max())
        for what, value in (
            ("work of unit loads on each other's displacements", worst[kind]),
            ("compliance of the hub, six by six", float(at_hub.max())),
        ):
            verdicts.append(
                judge(
                    f"{kind}: {what}, largest asymmetry",
                    value,
                    0.0,
                    tolerance=1e-9,
                    relative=False,
                    source="Maxwell 1864, Betti 1872: W_ij = W_ji",
                    reason="the energy error at which the solver stops",
                    measure="identity",
                    band=response.energy_error,
                )
            )
        verdicts.append(
            judge(
                f"{kind}: negative part of the least eigenvalue of the work matrix, scaled to a "
                "diagonal of one",
                min(least, 0.0),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="strain energy is never negative",
                reason="the energy error at which the solver stops",
                measure="identity",
                band=response.energy_error,
            )
        )
        rows.append(
            [kind, response.n_unknowns, response.method, response.energy_error,
             worst[kind], float(at_hub.max()), least]
        )  # fmt: skip
        shown = np.log10(np.maximum(asymmetry, 1e-18))
        charts.append(
            Chart(
                caption=f"{kind}: |W_ij - W_ji| / sqrt(W_ii W_jj), power of ten",
                figure={
                    "data": [
                        {
                            "type": "heatmap",
                            "x": list(LOADS),
                            "y": list(LOADS),
                            "z": [[round(float(v), 2) for v in row] for row in shown],
                            "zmin": -18,
                            "zmax": -8,
                            "colorbar": {"title": {"text": "power of ten"}},
                        }
                    ],
                    "layout": {
                        "xaxis": {"title": {"text": "displacements under"}},
                        "yaxis": {"title": {"text": "work of"}, "autorange": "reversed"},
                    },
                },
            )
        )
    return CASE.results(
        run,
        summary=[
            "The matrix of the works of ten unit loads on each other's displacements is symmetric "
            f"to {worst['spherical']:.0e} in the spherical and {worst['bonded']:.0e} in the bonded "
            "scene.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Reciprocity",
                items=[
                    Text(
                        text="Loads: six at the hub, uniform accelerations along three axes, and "
                        "the gearbox's weight. The work is that of the nodal loads on the nodal "
                        "displacements, so that the symmetry of the stiffness matrix does not "
                        "enter by itself: joint, springs, averaged couplings and solver all have "
                        "to be self-adjoint. Each pair is relative to the geometric mean of the "
                        "works that the two loads do on their own displacements."
                    ),
                    *charts,
                    Table(
                        caption="Both scenes",
                        columns=[
                            "scene",
                            "unknowns",
                            "solver",
                            "energy error of the solver [-]",
                            "largest asymmetry [-]",
                            "of the hub's compliance [-]",
                            "least eigenvalue [-]",
                        ],
                        rows=rows,
                    ),
                ],
            )
        ],
    )


CASE = Case(
    name="verification/reciprocity",
    title="Maxwell-Betti reciprocity of the main bearing's unit loads",
    source="exact: Maxwell 1864, Betti 1872",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
