"""Torsional stiffness K_R of the bearing unit in both planes, by three estimators side by side."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Measure K_R, and show how much it depends on the estimator and on the load."""
    import numpy as np

    from fe_drivetrain.cases.main_bearing import (
        bands,
        study,
    )
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, rounded
    from fe_drivetrain.response import PLANES

    scene = study.scene_of(run, "bonded")
    with run.side_by_side(3) as jobs:
        coarser = bands.start(jobs, scene, "bonded", solved=False, tilted=True)
        tilt = study.solve_tilt(run, scene, "without gearbox", study.mesh_of(run, scene, "bonded"))
        series = coarser.below(bands.of_tilt(tilt))
    free = tilt.free
    name = free.bearing
    response = free.response

    verdicts = study.check_verdicts(free, "without gearbox")
    verdicts += series.checked("without gearbox")
    energy_rows: list[list[Any]] = []
    for plane in PLANES:
        load = plane.moment
        work = float(response.motions["hub"][load, load])
        stored = {part: float(e[load, load]) for part, e in response.strain_energy.items()}
        verdicts.append(
            judge(
                f"{plane.name}: work of the hub moment against energy stored",
                sum(stored.values()),
                work,
                tolerance=1e-8,
                source="Clapeyron: U = M theta / 2",
                reason="no spring and no constraint does work: solver accuracy",
                unit="rad/(N m)",
                measure="energy",
                band=series.band(
                    lambda f, k=load: sum(
                        float(e[k, k]) for key, e in f.items() if key.startswith("free energy ")
                    )
                ),
            )
        )
        energy_rows.append([plane.name, *(100.0 * v / work for v in stored.values())])

    # The overhang carries a pure moment, M^2 L / (2 EI), that leaves the shaft under the ring.
    shaft = scene.shaft
    section = shaft.sections[0]
    material = scene.material_of("shaft")
    inertia = np.pi / 64.0 * (section.outer_diameter**4 - section.inner_diameter**4)
    half_ring = scene.bearing_units[0].bearing.width / 2.0
    arms = [scene.bearing_units[0].bearing.x - shaft.front + d for d in (-half_ring, half_ring)]
    bounds = [arm / (material.youngs_modulus * inertia) for arm in arms]
    stored_in_shaft = float(response.strain_energy["shaft"][4, 4])
    uniform = len(shaft.sections) == 1 and shaft.flange is None
    if uniform:
        verdicts.append(
            judge(
                "vertical: energy in the shaft between that of a beam up to the ring's near side "
                "(0) and up to its far side (1)",
                (stored_in_shaft - bounds[0]) / (bounds[1] - bounds[0]),
                0.5,
                tolerance=0.5,
                relative=False,
                source="beam in pure bending, U = M^2 L / (2 EI)",
                reason="under the ring the moment passes from the shaft into the bearing",
                band=series.band(
                    lambda f: float(f["free energy shaft"][4, 4]) / (bounds[1] - bounds[0])
                ),
            )
        )

    # A hub force turns the bearing by the moment that it makes there: the same K_R?
    loads: list[list[Any]] = []
    for plane in PLANES:
        arm = scene.bearing_units[0].bearing.x - shaft.front
        by_moment = response.motions[f"{name}.seat"][plane.moment, plane.moment]
        by_force = response.motions[f"{name}.seat"][plane.moment, plane.force]
        k_force = plane.sign * arm / by_force / 1e6
        loads.append(
            [
                plane.name,
                1e-6 / by_moment,
                k_force,
                100.0 * (k_force * 1e6 * by_moment - 1.0),
                series.band(
                    lambda f, p=plane, a=arm: (
                        100.0
                        * p.sign
                        * a
                        * float(
                            f[f"free motion {name}.seat"][p.moment, p.moment]
                            / f[f"free motion {name}.seat"][p.moment, p.force]
                        )
                    )
                ),
            ]
        )
    load_table = Table(
        caption="K_R [MN m/rad] from the averaged seat under a pure moment and under a hub force "
        "with the same moment at the bearing",
        columns=["plane", "hub moment", "hub force", "difference [%]", "± difference [%]"],
        rows=loads,
    )
    mesh = free.model.mesh
    points: list[list[Any]] = [
        [key, *(float(v) for v in mesh.points[node])]
        for key, node in mesh.named_points.items()
        if key.startswith(f"{name}.housing.")
    ]
    bars = {
        "data": [
            {
                "type": "bar",
                "name": plane,
                "x": list(values),
                "y": rounded([v / 1e6 for v in values.values()]),
            }
            for plane, values in tilt.by_plane.items()
        ],
        "layout": {"yaxis": {"title": {"text": "K_R [MN m/rad]"}}, "barmode": "group"},
    }
    load_factors = np.zeros(10)
    load_factors[4] = 1e6
    spread = {plane: study.spread(k) for plane, k in tilt.by_plane.items()}
    vertical, horizontal = (k / 1e6 for k in tilt.both("averaged seat"))
    uncertain = [series.percent(lambda f, p=p: float(f["K_R"][p, 1])) for p in range(len(PLANES))]
    bands_of_planes = (
        [
            f"Numerical uncertainty from two coarser meshes: {uncertain[0]:.2g} % in the vertical "
            f"and {uncertain[1]:.2g} % in the horizontal plane (averaged seat)."
        ]
        if series.complete
        else []
    )
    return CASE.results(
        run,
        summary=[
            f"K_R of bearing and housing is {vertical:.0f} MN m/rad in the vertical and "
            f"{horizontal:.0f} MN m/rad in the horizontal plane (averaged seat).",
            f"The three estimators spread by {spread['vertical']:.0f} % and "
            f"{spread['horizontal']:.0f} %: K_R is a property of the estimator as much as of the "
            "housing.",
            "The thesis gives 145 and 392 MN m/rad for a housing whose dimensions it does not "
            "state; this housing is another one, and nothing here is fitted to those figures.",
            *bands_of_planes,
        ],
        verdicts=verdicts,
        sections=[
            study.picture_section(run, free, load_factors, "My = 1 MN m at the hub, no gearbox"),
            Section(
                title="K_R by three estimators",
                items=[
                    bands.tilt_table(tilt, series),
                    Chart(caption="K_R by plane and estimator", figure=bars),
                    Text(
                        text="Four nodes: rotation of the line between two housing points, as in "
                        "the thesis; it misses the give of the ring and of the shell between "
                        "shaft and housing, so it is usually the stiffest. Averaged seat: "
                        "least-squares rotation of the face between shaft and bearing. Energy: "
                        "M²/2U with the energy of bearing and housing alone, without the "
                        "shaft's own give under the ring."
                    ),
                    Table(
                        caption="The points that the four-node estimator uses, imprinted in the "
                        "geometry",
                        columns=["point", "x [m]", "y [m]", "z [m]"],
                        rows=points,
                    ),
                ],
            ),
            Section(
                title="Energy and load",
                items=[
                    Table(
                        caption="Where the work of a hub moment goes [%]",
                        columns=["plane", *response.strain_energy],
                        rows=energy_rows,
                    ),
                    load_table,
                ],
            ),
            Section(
                title="Mesh and solution",
                items=[study.mesh_table({"without gearbox": free}), Text(text=series.note())],
            ),
        ],
        assumptions=study.assumptions(scene),
        figures={"tilt_stiffness": tilt.by_plane},
    )


CASE = Case(
    name="main_bearing/torsional_stiffness",
    title="Torsional stiffness K_R of bearing and housing, by three estimators",
    source="Stirling 2023, PhD thesis, section 3.3.1, Eq 3.20, Figures 3.13 and 3.14",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
