"""Main shaft of the IEA 10 MW turbine: a stiffness for the field that holds a placeholder."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, WALL, LENGTHS, SHEAR_MODULUS = 3.0, 0.1, (1.5, 1.5), 80e9
#: DTTorSpr of the OpenFAST model [N m/rad].
PLACEHOLDER = 2_317_025_000.0
#: The shaft that it belongs to: polar moment [m^4], G [Pa], length [m].
DTU_SHAFT = 0.2036, 8.08e10, 7.1
#: x [m] and polar moment [m^4] of the shaft in the turbine's own HAWC2 model, linear between.
HAWC2_X = (0.0, 0.4, 0.41, 1.9, 3.7, 3.71, 4.25, 4.26, 5.0, 5.25, 5.4)
HAWC2_K = (1.891, 1.891, 0.494, 0.494, 1.071, 5.712, 5.712, 1.074, 1.419, 10.091, 10.091)


def run(run: Run) -> Any:
    """The tube by finite elements, and what other descriptions of it would give."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        published_shafts,
        shaft_inputs,
    )
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation.shaft_theory import (
        polar_moment,
    )

    length = sum(LENGTHS)
    inner = OUTER - 2 * WALL
    closed = SHEAR_MODULUS * polar_moment(OUTER, inner) / length
    found = published_shafts.torsion(run, OUTER, inner, length, SHEAR_MODULUS)
    K, G, L = DTU_SHAFT
    carried_over = G * K / L
    # 1 / K is integrated exactly where K is linear
    slope = np.diff(HAWC2_K) / np.diff(HAWC2_X)
    steps = np.diff(HAWC2_X)
    flexibility = np.where(
        np.abs(slope) < 1e-12,
        steps / np.array(HAWC2_K[:-1]),
        np.log(np.array(HAWC2_K[1:]) / np.array(HAWC2_K[:-1]))
        / np.where(np.abs(slope) < 1e-12, 1.0, slope),
    )
    turned = G / flexibility.sum()
    other = SHEAR_MODULUS * polar_moment(2.5, 2.3) / 2.2
    moduli = np.array([79.3e9, 80.8e9])
    low, high = closed * moduli / SHEAR_MODULUS
    verdicts = [
        published_shafts.judge_torsion(
            "finite elements, tube over 3.0 m",
            found,
            closed,
            "closed form G J / L",
        ),
        judge(
            "what the placeholder is: K G / L of the DTU 10 MW turbine's shaft",
            carried_over,
            PLACEHOLDER,
            tolerance=500.0 / PLACEHOLDER,
            unit="N m/rad",
            source="IEA-10.0-198-RWT_ElastoDyn.dat, commit 059caf9, DTTorSpr",
            reason="half of the last published digit (1000 N m/rad)",
            measure="stiffness",
        ),
    ]
    rows: list[Any] = [
        ["finite elements, 3.0 m, wall 0.1 m, over 3.0 m", found.series.finest],
        ["closed form of it", closed],
        ["closed form, G = 79.3 GPa", float(low)],
        ["closed form, G = 80.8 GPa", float(high)],
        ["WISDEM's later shaft, 2.5 m, wall 0.1 m, over 1.0 + 1.2 m", other],
        ["the turbine's HAWC2 shaft, by its sections over 5.4 m", float(turned)],
        ["placeholder in the OpenFAST model", PLACEHOLDER],
    ]
    x = np.linspace(0.0, HAWC2_X[-1], 400)
    polar = np.interp(x, HAWC2_X, HAWC2_K)
    angle = np.concatenate([[0.0], np.cumsum(np.diff(x) / (G * 0.5 * (polar[1:] + polar[:-1])))])
    return CASE.results(
        run,
        summary=[
            f"DTTorSpr for the main shaft alone: {found.series.finest:.4g} N m/rad (numerical band "
            f"± {found.series.uncertainty:.1g}; {low:.4g} to {high:.4g} for any usual G). The "
            f"published {PLACEHOLDER:.4g} is the DTU 10 MW turbine's, carried over, and "
            f"{found.series.finest / PLACEHOLDER:.1f} times softer.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="A figure for the field",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "IEA-10.0-198-RWT"),
                        ("wall", WALL, "m", "IEA-10.0-198-RWT"),
                        ("lengths", "1.5 + 1.5", "m", "hub to bearing, bearing to bearing"),
                        ("G", SHEAR_MODULUS / 1e9, "GPa", "as of the IEA 15 MW shaft"),
                        (
                            "DTU shaft: K, G, L",
                            "0.2036, 80.8, 7.1",
                            "m^4, GPa, m",
                            "first set of iea10mw_rc1_hawc2_shaft_st.dat, commit b00b748",
                        ),
                        ("HAWC2 shaft", "11 stations", "", "fourth set of the same file"),
                    ),
                    Table(
                        caption="Torsional stiffness by description of the shaft",
                        columns=["shaft", "stiffness [N m/rad]", "over the placeholder"],
                        rows=[[name, k, k / PLACEHOLDER] for name, k in rows],
                    ),
                    chart(
                        "Twist along the shaft under 10 MN m, from the gearbox-less generator's "
                        "end: the tube, and the sections of the turbine's HAWC2 model",
                        [
                            trace("HAWC2 sections", x, 1e3 * 1e7 * angle),
                            trace("tube", [0.0, length], [0.0, 1e3 * 1e7 / closed]),
                            trace("placeholder", [0.0, 7.1], [0.0, 1e3 * 1e7 / PLACEHOLDER]),
                        ],
                        "x [m]",
                        "twist [mrad]",
                    ),
                    Text(
                        text="The descriptions differ by far more than any numerical band: what "
                        "counts as the shaft, from where to where, decides. The HAWC2 sections "
                        "include the thin tube between bearing and generator, and hold most twist "
                        "there."
                    ),
                ],
            )
        ],
        assumptions=[published_shafts.RIGID_ENDS],
        figures={"stiffness": found.series.finest, "band": found.series.uncertainty},
    )


CASE = Case(
    name="verification/published_iea_10",
    title="Main shaft of the IEA 10 MW turbine: a figure for a placeholder",
    source="IEA-10.0-198-RWT (Bortolotti et al. 2019, NREL/TP-5000-73492) and its repository",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
