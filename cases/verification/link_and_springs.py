"""A shaft as two rigid links and a spherical joint with springs, against beam and solid."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Bending and torsion [N m/rad] of the three shafts of Park et al. 2021, Table 2.
TABLE = {
    "low-speed": (1.34e8, 7.19e7),
    "intermediate": (2.48e7, 1.40e7),
    "high-speed": (2.83e6, 0.15e7),
}
SPLIT = 0.5


def run(run: Run) -> Any:
    """The solid's compliance, and what one joint makes of each load, over the split d."""
    import numpy as np

    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
        evenly_loaded_shear,
        parabola_shortfall,
    )

    steel = MATERIALS["steel"]
    nu, G = steel.poisson_ratio, steel.shear_modulus

    def implied(bending: float, torsion: float) -> tuple[float, float]:
        """Diameter and length [m] of the solid steel shaft that has both, split in the middle.

        With A_s the whole section, as the paper writes.
        """
        square = 0.5 * 3 * (1 + nu) * torsion / bending - 1
        slenderness = np.sqrt(6 * (1 + nu) / 16 / square)
        diameter = (32 * slenderness * torsion / (np.pi * G)) ** (1 / 3)
        return float(diameter), float(slenderness * diameter)

    shafts = {name: implied(*k) for name, k in TABLE.items()}
    diameter, length = shafts["low-speed"]
    tube = Tube(diameter, 0.0, length, steel)
    # its end is loaded, and its root held, evenly
    EI, kGA, L = tube.EI, evenly_loaded_shear(tube), length
    q = 1.0  # N/m

    def park(d: Any, shear: float = kGA) -> Any:
        """Eq 15 of the paper, with a shear rigidity G A_s [N]."""
        return ((1 - d) ** 2 + d**2) / (L / (3 * EI) + 1 / (shear * L))

    # deflection and rotation (downward as positive slope) of a cantilever's tip
    beam = {
        "end force": (L**3 / (3 * EI) + L / kGA, L**2 / (2 * EI)),
        "end moment": (L**2 / (2 * EI), L / EI),
        "distributed weight": (
            q * (L**4 / (8 * EI) + L**2 / (2 * kGA)),
            q * L**3 / (6 * EI),
        ),
    }

    def link(load: str, d: Any, k: Any) -> tuple[Any, Any]:
        """The same of two rigid links, the joint at d L from the clamp."""
        arm = (1 - d) * L
        bent = {"end force": arm, "end moment": 1.0 + 0 * arm, "distributed weight": arm**2 / 2}
        angle = bent[load] / k
        return angle * arm, angle

    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshed: dict[str, list[tuple[float, float]]] = {name: [] for name in beam}
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(solid_shafts.straight((0.0, length), diameter), refinement)
            C = solid_shafts.sectional_compliance(mesh, steel, (0.0, length))
        tip = C.matrix[1, :, 1, :]
        per_length = steel.density * tube.area
        meshed["end force"].append((float(tip[0, 0]), -float(tip[1, 0])))
        meshed["end moment"].append((-float(tip[0, 1]), float(tip[1, 1])))
        meshed["distributed weight"].append(
            (float(C.weight[1, 0]) / per_length, -float(C.weight[1, 1]) / per_length)
        )
    turn = mesh.per_turn
    section = 2 * 4 * parabola_shortfall(turn)
    local = solid_shafts.local_compliance(tube)
    slack = {
        "end force": 2 * local / beam["end force"][0],
        "end moment": 0.0,
        "distributed weight": L * local / beam["distributed weight"][0],
    }
    slender = {"end force": 1 / 3, "end moment": 1 / 2, "distributed weight": 1 / 4}
    verdicts = []
    rows: list[Any] = []
    for load, (w, phi) in beam.items():
        needed = 1 - w / (phi * L)
        by_mesh = [1 - a / (b * L) for a, b in meshed[load]]
        band = solid_shafts.mesh_band(refinements, by_mesh)
        best = link(load, needed, 1.0)[1] / phi
        rows.append([load, slender[load], needed, by_mesh[-1], band, best * L / EI])
        verdicts.append(
            judge(
                f"{load}: split that meets both deflection and rotation of the tip, solid",
                by_mesh[-1],
                needed,
                tolerance=(section + slack[load]) * (1 - needed),
                relative=False,
                unit="-",
                source="1 - w / (phi L) of Timoshenko's cantilever, evenly held (Hutchinson 2001)",
                reason=f"{turn} parabolic arcs round a turn; loads that enter evenly over a "
                f"section, {solid_shafts.LOCAL:.0%} of what one diameter shears",
                measure="deflection",
                band=band,
            )
        )
    solid = {load: values[-1] for load, values in meshed.items()}
    at_clamp = link("end force", 0.0, park(0.0))[0] / beam["end force"][0]
    halved = link("end force", SPLIT, park(SPLIT))[0] / solid["end force"][0]
    force_band = solid_shafts.mesh_band(
        refinements, [link("end force", SPLIT, park(SPLIT))[0] / v[0] for v in meshed["end force"]]
    )
    verdicts += [
        judge(
            "Eq 15 at d = 0: deflection under an end force, over the beam's",
            float(at_clamp),
            1.0,
            tolerance=1e-12,
            source="Timoshenko's cantilever",
            reason="the equation is an equality of energies, and with one link fixed there is one "
            "rotation only: round-off",
            measure="identity",
        ),
        judge(
            "Eq 15 at d = 1/2: deflection under an end force, over the solid's",
            float(halved),
            0.5,
            tolerance=section + slack["end force"],
            source="(1 - d)^2 / ((1 - d)^2 + d^2)",
            reason="as for the split",
            measure="deflection",
            band=force_band,
        ),
        judge(
            "torsion of the low-speed shaft implied by the table",
            G * tube.polar / L,
            TABLE["low-speed"][1],
            tolerance=1e-12,
            unit="N m/rad",
            source="Park et al. 2021, Table 2",
            reason="diameter and length are solved for it: round-off",
            measure="stiffness",
        ),
        judge(
            "bending of the low-speed shaft implied by the table, Eq 15 at d = 1/2",
            float(park(SPLIT, G * tube.area)),
            TABLE["low-speed"][0],
            tolerance=1e-12,
            unit="N m/rad",
            source="Park et al. 2021, Table 2",
            reason="diameter and length are solved for it: round-off",
            measure="stiffness",
        ),
    ]
    d = np.linspace(0.0, 0.9, 91)

    def error_lines(k: Any) -> list[Any]:
        lines = []
        for load in beam:
            for i, what in enumerate(("deflection", "rotation")):
                value = np.asarray(link(load, d, k)[i]) * np.ones_like(d)
                lines.append(
                    trace(
                        f"{load}: {what}",
                        d,
                        100 * (value / solid[load][i] - 1),
                        line={"dash": "dot" if i else "solid"},
                    )
                )
        return lines

    one_split = []
    for label, k, at in (
        ("Eq 15, d = 1/2", park(0.5), 0.5),
        ("Eq 15, d = 0", park(0.0), 0.0),
        ("EI / L, d = 1/2", EI / L, 0.5),
        ("4 EI / 3 L, d = 1/3", 4 * EI / (3 * L), 1 / 3),
        ("27 EI / 16 L, d = 1/4", 27 * EI / (16 * L), 1 / 4),
    ):
        row: list[Any] = [label]
        for load in beam:
            row += [
                100 * (float(value) / reference - 1)
                for value, reference in zip(link(load, at, k), solid[load], strict=True)
            ]
        one_split.append(row)
    return CASE.results(
        run,
        summary=[
            "One joint meets deflection and rotation of a cantilever's tip at d = 1/2 for an end "
            f"moment, {rows[0][3]:.3f} for an end force and {rows[2][3]:.3f} for the weight "
            "(slender: 1/3 and 1/4): no split serves all.",
            "Eq 15 at d = 1/2, which the paper's table implies, gives "
            f"{100 * halved:.0f} % of the deflection under an end force: it counts the spring's "
            "energy once for each link, where one spring has one rotation.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Where the split must sit",
                items=[
                    shaft_inputs.inputs(
                        ("low-speed shaft: diameter", diameter, "m", "implied, see below"),
                        ("low-speed shaft: length", length, "m", "implied, see below"),
                        ("bending, torsion", "1.34e8, 7.19e7", "N m/rad", "Table 2"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "What two links with the spring of Eq 15 make of each load, against the "
                        "solid, by the split d from the clamp",
                        error_lines(park(d)),
                        "d",
                        "error [%]",
                    ),
                    chart(
                        "The same with a spring of EI / L at every split",
                        error_lines(EI / L),
                        "d",
                        "error [%]",
                    ),
                    Table(
                        caption="Split that meets both deflection and rotation of the tip, and the "
                        "spring that goes with it",
                        columns=[
                            "load",
                            "slender beam",
                            "beam with shear",
                            "solid",
                            "band of the solid",
                            "spring over EI / L",
                        ],
                        rows=rows,
                    ),
                    Table(
                        caption="Error of one split for each load, against the solid [%]",
                        columns=[
                            "spring and split",
                            *(f"{load}: {what}" for load in beam for what in ("w", "phi")),
                        ],
                        rows=one_split,
                    ),
                    Text(
                        text="Eq 13 and 14 set equal the strain energy of a cantilever under an "
                        "end force and that of the springs, the latter with a rotation "
                        "(1 - d) F L / k and another d F L / k. Two links on one joint have a "
                        "single relative rotation, (1 - d) F L / k with the joint at d L from the "
                        "clamp; without the second term Eq 15 meets the deflection at any d. "
                        "An end moment needs k = EI / L whatever the split."
                    ),
                ],
            ),
            Section(
                title="What the table implies",
                items=[
                    Table(
                        caption="Solid steel shafts that have the bending (Eq 15, d = 1/2) and the "
                        "torsion (G J / L) of Table 2. With d = 0 or 1 no shaft longer than wide "
                        "has both",
                        columns=[
                            "shaft",
                            "bending [N m/rad]",
                            "torsion [N m/rad]",
                            "diameter [m]",
                            "length [m]",
                            "length over diameter",
                        ],
                        rows=[
                            [name, *TABLE[name], D, length_of, length_of / D]
                            for name, (D, length_of) in shafts.items()
                        ],
                    ),
                ],
            ),
        ],
        figures={"split": {r[0]: r[3] for r in rows}},
    )


CASE = Case(
    name="verification/link_and_springs",
    title="A shaft as two rigid links and a spherical joint: where the split must sit",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Eq 13-16 and Table 2",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
