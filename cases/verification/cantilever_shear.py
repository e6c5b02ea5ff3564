"""A cantilever bent by a force: Saint-Venant's exact flexure, Cowper's shear, and a clamped end."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, LENGTH = 0.4, 0.8
#: Bore over outer diameter.
WALLS = (0.0, 0.5, 0.9)
#: Length over diameter of the clamped shaft.
RATIOS = (1.0, 2.0, 5.0, 10.0, 20.0)
QUICK_RATIOS = (1.0, 5.0, 10.0, 20.0)


def run(run: Run) -> Any:
    """Exact tractions on both ends; then a clamped end and a rigid tip."""
    import numpy as np

    from fe_drivetrain.beam import cowper_shear_coefficient
    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.mesh import Grading, face_weights
    from fe_drivetrain.operator import nodal_stresses, traction_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import end_stiffness
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
        flexure_field,
        flexure_stress,
        parabola_shortfall,
        recovery_error,
    )

    steel = MATERIALS["steel"]
    nu = steel.poisson_ratio
    refinements = (1, 2) if run.quick else (1, 2, 3)
    force = 1e6
    verdicts, traces = [], []
    rows: list[Any] = []
    for wall in WALLS:
        name = f"bore {wall:g} D" if wall else "solid"
        tube = Tube(OUTER, wall * OUTER, LENGTH, steel)

        def traction(positions: Any, normals: Any, tube: Tube = tube) -> Any:
            s = flexure_stress(positions, force, tube)
            return normals[:, :1] * s[:, [0, 3, 5]]

        tips, shears, errors, peaks, unknowns = [], [], [], [], []
        for refinement in refinements:
            with run.step(f"{name}: mesh and solve"):
                shaft = solid_shafts.straight((0.0, LENGTH / 2, LENGTH), OUTER, wall * OUTER)
                mesh = solid_shafts.solid(shaft, refinement)
                exact = flexure_field(mesh.points, force, tube)
                ends = [mesh.section_facets(end) for end in (mesh.front, mesh.rear)]
                F: Any = sum(traction_loads(mesh.points, facets, traction) for facets in ends)
                # the tractions of the exact section on the meshed one: what they lack of balance
                # is as small as the section's error, and would load the three pins
                F = F - _unbalanced(mesh.points, F, ends[0])
                found = solve_solid(
                    mesh.points,
                    mesh.cells,
                    steel.lame,
                    [],
                    F,
                    solid_shafts.pinned_like(mesh, exact),
                )
            u = found.u[:, 0].reshape(-1, 3)
            means = []
            z = mesh.points[:, 2]
            for facets in ends:
                w = face_weights(mesh.points, facets, len(mesh.points))
                slope = -(w @ (z * u[:, 0])) / (w @ z**2)
                means.append((w @ u[:, 2] / w.sum(), slope))
            (w0, slope0), (w1, _) = means
            tip = float(w1 - w0 - slope0 * LENGTH)
            tips.append(tip)
            # what is left beside bending, as Cowper's coefficient
            bend = force * LENGTH**3 / (3 * tube.EI)
            shears.append(float(force * LENGTH / ((tip - bend) * steel.shear_modulus * tube.area)))
            errors.append(float(np.abs(u - exact).max() / np.abs(exact).max()))
            unknowns.append(mesh.n_unknowns)
            s = nodal_stresses(mesh.points, mesh.cells, found.u[:, 0], steel.lame)
            middle = mesh.section_nodes(LENGTH / 2)
            side = middle[mesh.points[middle, 1].argmax()]
            inner = middle[np.hypot(mesh.points[middle, 1], z[middle]).argmin()]
            at = side if wall else inner
            peaks.append(float(s[at, 5]))
            there = flexure_stress(mesh.points[middle], force, tube)
            size = np.abs(there[:, [3, 5]]).max()
            reference = float(flexure_stress(mesh.points[at][None], force, tube)[0, 5])
        turn = mesh.per_turn
        shortfall = 4 * parabola_shortfall(turn)
        band = solid_shafts.mesh_band(refinements, tips)
        by_shear = solid_shafts.mesh_band(refinements, shears)
        closed = force * LENGTH**3 / (3 * tube.EI) + force * LENGTH / tube.kGA
        share = force * LENGTH / tube.kGA / closed
        cowper = float(cowper_shear_coefficient(nu, wall))
        traces.append(trace(name, unknowns, errors, marker={"size": 8}))
        rows.append([name, tips[-1], band, closed, 100 * share, shears[-1], cowper])
        verdicts += [
            judge(
                f"{name}: mean deflection of the tip from the tangent at the root",
                tips[-1],
                closed,
                tolerance=2 * shortfall,
                unit="m",
                source="F L^3 / 3EI + F L / kGA, k of Cowper 1966",
                reason=f"{turn} parabolic arcs round a turn: I is {shortfall:.2g} too low by their "
                "formula; twice that is allowed",
                measure="deflection",
                band=band,
            ),
            judge(
                f"{name}: shear coefficient",
                shears[-1],
                cowper,
                tolerance=2 * shortfall / share,
                source="Cowper 1966, J. Appl. Mech. 33, 335-340",
                reason=f"the tip's tolerance, of which shear is {100 * share:.2g} %",
                measure="stiffness",
                band=by_shear,
            ),
            judge(
                f"{name}: largest difference from the exact displacements, over the largest",
                errors[-1],
                0.0,
                tolerance=2 * shortfall,
                relative=False,
                source="Love 1927, articles 229-231",
                reason="as for the deflection, at the worst node",
                measure="deflection",
                band=abs(errors[-1] - errors[-2]),
            ),
            judge(
                f"{name}: shear stress on the neutral axis, "
                + ("at the skin" if wall else "at the centre"),
                peaks[-1],
                reference,
                tolerance=recovery_error(turn) * float(size / abs(reference)),
                unit="Pa",
                source="Saint-Venant's flexure, Love 1927, articles 230-231",
                reason="stress is recovered linearly in each element: h^2 / 12 for the arc h of an "
                "element, and as much for the radius, of the largest stress of the section",
                measure="stress",
                band=abs(peaks[-1] - peaks[-2]),
            ),
        ]

    ratios = QUICK_RATIOS if run.quick else RATIOS
    stiffer, solids, bands = [], [], []
    for ratio in ratios:
        length = ratio * OUTER
        tube = Tube(OUTER, 0.0, length, steel)
        shaft = solid_shafts.straight((0.0, length), OUTER)
        # a rigid tip that may turn: the beam's compliance is the same
        beam = length**3 / (3 * tube.EI) + length / tube.kGA
        with run.step("clamped: meridian"):
            K = end_stiffness(shaft, steel)[np.ix_([8, 10], [8, 10])]
        stiffer.append(float(1 - np.linalg.inv(K)[0, 0] / beam))
        by_mesh = []
        for refinement in (1, 2):
            # long ones show nothing new, and take time
            if ratio > (1 if run.quick else 5):
                break
            with run.step("clamped: mesh and solve"):
                mesh = solid_shafts.solid(shaft, refinement, Grading(ends=1))
                by_mesh.append(float(np.linalg.inv(_between_rigid_ends(mesh, steel))[0, 0]))
        if by_mesh:
            solids.append(1 - by_mesh[-1] / beam)
            bands.append(solid_shafts.mesh_band((1, 2), by_mesh, 1.4))
            turn = mesh.per_turn
            edge = solid_shafts.SLICE / turn * solid_shafts.BASE_TURN * 0.3
            verdicts.append(
                judge(
                    f"clamped, L = {ratio:g} D: deflection of a rigid tip",
                    by_mesh[-1],
                    float(np.linalg.inv(K)[0, 0]),
                    tolerance=2 * 4 * parabola_shortfall(turn) + 0.2 * edge**1.4 / ratio,
                    unit="m/N",
                    source="Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)",
                    reason=f"{turn} parabolic arcs, as above; and stress is singular along the "
                    "clamped edge, of exponent 0.71: what elements there miss goes as their size "
                    f"of {edge:.2g} radii to the power 1.4, in a part of the shaft as long as it "
                    "is wide",
                    measure="deflection",
                    band=bands[-1],
                )
            )
    last, before = ratios[-1], ratios[-2]
    power = float(np.log(stiffer[-1] / stiffer[-2]) / np.log(last / before))
    verdicts.append(
        judge(
            "clamped: power with which the beam's error falls with length over diameter",
            power,
            -1.0,
            tolerance=0.15,
            relative=False,
            source="a clamp turns less than Saint-Venant's root by a share of M D / EI: the error "
            "is in proportion to D / L",
            reason=f"from L = {before:g} D to {last:g} D; what shear adds is of second order in "
            "D / L, a tenth of the first there",
            measure="order",
        )
    )
    return CASE.results(
        run,
        summary=[
            "Under Saint-Venant's tractions the solid's mean deflection is F L^3 / 3EI + F L / kGA "
            f"with Cowper's k to {max(abs(r[1] / r[3] - 1) for r in rows):.1g}, solid and bored. "
            f"A clamped end and a rigid tip are stiffer than the beam by {100 * stiffer[0]:.1f} % "
            f"at L = {ratios[0]:g} D and {100 * stiffer[-1]:.2f} % at L = {ratios[-1]:g} D.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Saint-Venant's flexure",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
                        ("length", LENGTH, "m", "chosen: short, so that shear counts"),
                        ("force at the tip", force / 1e6, "MN", "chosen"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    Table(
                        caption="Mean deflection of the tip, from the mean tangent at the root",
                        columns=[
                            "shaft",
                            "finite elements [m]",
                            "band [m]",
                            "F L^3 / 3EI + F L / kGA [m]",
                            "shear's share [%]",
                            "shear coefficient, finite elements",
                            "Cowper",
                        ],
                        rows=rows,
                    ),
                    chart(
                        "Largest difference from the exact displacements, over the largest",
                        traces,
                        "unknowns",
                        "relative error",
                        ("x", "y"),
                    ),
                    Text(
                        text="Cowper's coefficient speaks of the mean deflection and of the "
                        "least-squares rotation of a section. An averaged reference point moves by "
                        "these very means, so a beam stands for a solid that is loaded through "
                        "such points."
                    ),
                ],
            ),
            Section(
                title="Clamped end",
                items=[
                    chart(
                        "How much stiffer a clamped shaft with a rigid tip is than Timoshenko's "
                        "beam, against length over diameter",
                        [
                            trace("meridian", ratios, 100 * np.array(stiffer)),
                            trace(
                                "hexahedra",
                                ratios[: len(solids)],
                                100 * np.array(solids),
                                True,
                                marker={"size": 9},
                            ),
                        ],
                        "length over diameter",
                        "stiffer by [%]",
                        ("x", "y"),
                    ),
                    Text(
                        text="A clamp keeps the section flat and round, where Saint-Venant's "
                        "solution warps. It is no error of the beam, but of its boundary condition."
                    ),
                ],
            ),
        ],
        figures={"clamped_stiffer": dict(zip(map(str, ratios), stiffer, strict=True))},
    )


def _unbalanced(points: Any, F: Any, facets: Any) -> Any:
    """Forces on a face, uniform and linear, with the resultant of F."""
    import numpy as np

    from fe_drivetrain.interfaces import averaged_point
    from fe_drivetrain.mesh import face_weights
    from fe_drivetrain.validation import (
        solid_shafts,
    )

    weights = face_weights(points, facets, len(points))
    nodes = np.flatnonzero(weights != 0.0)
    point = averaged_point("root", nodes, weights[nodes], points, np.zeros(3), points.size)
    return point.motion.T @ solid_shafts.resultant(points, F)


def _between_rigid_ends(mesh: Any, material: Any) -> Any:
    """(2, 2) stiffness of the rear face against u_z and rotation about y, the front held."""
    import numpy as np

    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.solve import solve_solid

    rear = mesh.section_nodes(mesh.rear)
    ends = np.concatenate([mesh.section_nodes(mesh.front), rear])
    freedoms = (3 * ends[:, None] + np.arange(3)).ravel()
    motions = np.zeros((freedoms.size, 2))
    here = rigid_motions(mesh.points[rear], np.array([mesh.rear, 0.0, 0.0]))[:, [2, 4]]
    motions[-3 * len(rear) :] = here
    found = solve_solid(
        mesh.points,
        mesh.cells,
        material.lame,
        [],
        np.zeros(mesh.n_unknowns),
        (freedoms, motions),
    )
    reaction = found.reactions["prescribed"][(3 * rear[:, None] + np.arange(3)).ravel()]
    return here.T @ reaction


CASE = Case(
    name="verification/cantilever_shear",
    title="Cantilever with shear: Saint-Venant's flexure, Cowper's coefficient, a clamped end",
    source="Love 1927, A Treatise on the Mathematical Theory of Elasticity, articles 229-231; "
    "Cowper 1966, J. Appl. Mech. 33, 335-340",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
