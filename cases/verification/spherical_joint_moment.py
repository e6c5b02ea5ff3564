"""What a spherical joint of a main bearing carries: forces through its centre, and nothing else."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

FORMS = ("sliding", "averaged", "rigid")

#: Coarsening of the library's mesh: forces are exact on any mesh.
FACTOR, QUICK_FACTOR = 3.0, 4.0

BENDING = ("hub.Fy", "hub.Fz", "hub.My", "hub.Mz")


def run(run: Run) -> Any:
    """Solve the three forms, and a bonded bearing beside them."""
    import numpy as np

    from fe_drivetrain.beam import main_bearing_beam, pinned_model
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace
    from fe_drivetrain.response import LOADS, build_model, mesh_scene, unit_load_response
    from fe_drivetrain.scene import change_scene, library_scene

    factor = QUICK_FACTOR if run.quick else FACTOR
    scenes, meshes, responses, models = {}, {}, {}, {}
    for form in (*FORMS, "bonded"):
        kind = "bonded" if form == "bonded" else "spherical"
        scene = library_scene(f"main_bearing_{kind}")
        sizes = scene.mesh.scaled(factor).model_copy(update={"elements_per_turn": 8})
        scene = scene.model_copy(update={"mesh": sizes})
        if kind not in meshes:
            with run.step(f"mesh ({kind})"):
                meshes[kind] = mesh_scene(scene)
        if kind == "spherical":
            scene = change_scene(scene, {"bearing_units.0.interface": form})
        with run.step(f"ten unit loads ({form})"):
            scenes[form] = scene
            models[form] = build_model(scene, meshes[kind])
            # a direct solver: nothing but round-off is to be seen
            responses[form] = unit_load_response(models[form], "superlu")

    unit = scenes["sliding"].bearing_units[0]
    name = unit.bearing.name
    radius = 0.5 * unit.bearing.raceway_diameter
    exact = _statics(models["sliding"], main_bearing_beam(scenes["sliding"]), pinned_model)
    hub = [LOADS.index(load) for load in LOADS if load.startswith("hub")]
    verdicts = []
    rows: list[list[Any]] = []
    moments: dict[str, Any] = {}
    for form, response in responses.items():
        joint = response.reactions[f"{name}.outer"]
        moments[form] = np.linalg.norm(joint[3:], axis=0)
        if form == "bonded":
            continue
        size = np.linalg.norm(joint[:3], axis=0)
        radial = [LOADS.index(load) for load in BENDING]
        worst = float(moments[form][hub].max())
        loaded = size > 1e-6
        offset = float((moments[form][loaded] / size[loaded]).max())
        verdicts += [
            judge(
                f"{form}: moment about the joint's centre, largest of six unit hub loads",
                worst,
                0.0,
                tolerance=1e-9,
                relative=False,
                unit="N m",
                source="a sphere without friction carries no moment",
                reason="each form passes its forces on through the centre exactly: round-off of a "
                "direct solver, of nodal forces of some 1 N",
                measure="identity",
                band=0.0,
            ),
            judge(
                f"{form}: distance of the line of the force from the joint's centre, over the "
                "joint's radius",
                offset / radius,
                0.0,
                tolerance=1e-9,
                relative=False,
                source="a force that carries no moment about a point passes through it",
                reason="as for the moment",
                measure="identity",
                band=0.0,
            ),
            judge(
                f"{form}: radial reactions of unit hub loads, self-weight and gearbox weight "
                "against statics",
                float(_difference(response.reactions[name], exact)),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="Stirling 2023, Eq 3.1, for hub loads and gearbox weight; moment balance "
                "about the gearbox for self-weight",
                reason="the shaft is determinate: round-off of a direct solver, relative to the "
                "largest reaction to each load",
                measure="identity",
                band=0.0,
            ),
            judge(
                f"{form}: joint and base of the housing carry the same force and moment, hub loads",
                float(
                    np.abs((response.reactions[name] - joint)[:, hub]).max()
                    / np.abs(joint[:, hub]).max()
                ),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="equilibrium of the housing, on which no load acts in between",
                reason="round-off of a direct solver",
                measure="identity",
                band=0.0,
            ),
        ]
        rows.append(
            [
                form,
                *(float(joint[c, k]) for c, k in ((1, radial[0]), (2, radial[1]), (2, radial[2]))),
                worst,
                offset,
            ]
        )
    held = float(np.abs(responses["bonded"].reactions[f"{name}.outer"][4, LOADS.index("hub.My")]))
    colours = {"sliding": "#0072b2", "averaged": "#009e73", "rigid": "#d55e00", "bonded": "#1f2933"}
    figure = Chart(
        caption="Moment that the interface carries about the joint's centre",
        figure={
            "data": [
                trace(form, [], [], points=True, marker={"color": colour, "size": 9})
                | {"x": list(LOADS), "y": [float(f"{max(m, 1e-18):.3g}") for m in moments[form]]}
                for form, colour in colours.items()
            ],
            "layout": {
                "xaxis": {"title": {"text": "unit load"}},
                "yaxis": {
                    "title": {"text": "moment [N m]"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )
    mesh = meshes["spherical"]
    return CASE.results(
        run,
        summary=[
            "All three forms of the spherical joint carry forces through the centre and nothing "
            f"else: at most {max(row[-2] for row in rows):.1e} N m over the unit hub loads, where "
            f"a bonded bearing takes {held:.2f} N m of 1 N m at the hub.",
            "Reactions are those of statics (Eq 3.1) to round-off, and say nothing about the mesh.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="What the joint carries",
                items=[
                    figure,
                    Table(
                        caption="Force through the joint for unit hub loads, its moment, and the "
                        "distance of its line from the centre",
                        columns=[
                            "form",
                            "Fy per Fy [N/N]",
                            "Fz per Fz [N/N]",
                            "Fz per My [N/N m]",
                            "largest moment [N m]",
                            "largest distance [m]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Sliding: each pair of nodes passes a force along its normal, and all "
                        "normals meet in the centre. Averaged: one force, spread over each face "
                        "with weights whose centroid is the centre. Rigid: two rigid spheres that "
                        "share their centre's displacement. The chart shows no point below "
                        "1e-18 N m."
                    ),
                    Text(
                        text=f"Mesh: {len(mesh.cells):,} curved ten-node tetrahedra, "
                        f"{len(mesh.points):,} nodes. Bonded, for comparison, on a mesh of its own."
                    ),
                ],
            )
        ],
        figures={form: {"moments": m.tolist()} for form, m in moments.items()},
    )


def _statics(model: Any, beam: Any, pinned_model: Any) -> Any:
    """(2, 10): Fy and Fz at the bearing by statics; gravity along x is left out.

    Self-weight by the moments of shaft and bearing about the gearbox, and the housing's own weight.
    """
    import numpy as np

    from fe_drivetrain.response import LOADS

    exact = np.zeros((6, len(LOADS)))
    exact[:, :6] = pinned_model(np.eye(6), beam).T
    points = model.mesh.points
    gearbox, bearing = (
        model.points[key].position[0]
        for key in ("gearbox", f"{model.scene.bearing_units[0].bearing.name}.seat")
    )
    name = model.scene.bearing_units[0].bearing.name
    turning = model.part_mass["shaft"] + model.part_mass[name]
    lever = float(turning @ (gearbox - points[:, 0])) / (gearbox - bearing)
    for axis in (1, 2):
        exact[axis, 6 + axis] = lever + model.part_mass[f"{name}.housing"].sum()
    # the gearbox's weight stands on its own springs
    return exact[1:3]


def _difference(reaction: Any, exact: Any) -> float:
    """Largest difference of Fy and Fz, relative to the largest of a load, or to 1 N."""
    import numpy as np

    from fe_drivetrain.response import LOADS

    # gravity along x is no load of a drivetrain, and its lever arm is the mesh's asymmetry
    loads = [k for k, load in enumerate(LOADS) if load != "gravity.x"]
    difference = np.abs(reaction[1:3] - exact)[:, loads].max(axis=0)
    return float((difference / np.maximum(1.0, np.abs(exact)[:, loads].max(axis=0))).max())


CASE = Case(
    name="verification/spherical_joint_moment",
    title="Spherical joint of a main bearing: no moment about its centre, reactions by statics",
    source="Stirling 2023, PhD thesis, section 3.1 (Eq 3.1) and section 3.2 (DSRB: three forces, "
    "rotation free)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
