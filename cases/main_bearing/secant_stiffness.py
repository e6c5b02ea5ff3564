"""K_R as a secant over load cases: one number, or scatter where a spring is the wrong form."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Factors on the mesh sizes, coarse first: of the library's housing, and of the tall one.
FACTORS, TALL_FACTORS = (1.35, 1.0), (1.8, 1.35)
QUICK_FACTORS, QUICK_TALL_FACTORS = (2.8, 2.1), (2.8, 2.1)
#: Centre of the tall housing over its base [m]; the library's is at 0.42 m.
TALL = 0.9
#: Every so many samples of a history at 20 Hz.
EVERY = 40
#: Couplings of each moment that the page shows.
TERMS = 3
OWN_KEYS = ("scene", "solver", "loads")


def run(run: Run) -> Any:
    """Secants of three bearings and of made-up springs, and the beams that follow from them."""
    import numpy as np

    from fe_drivetrain.cases.main_bearing import (
        secants,
        study,
    )
    from fe_drivetrain.common import FORCES
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.response import secant_stiffness

    bonded = study.scene_of(run, "bonded", OWN_KEYS, coarsen=False)
    spherical = study.scene_of(run, "spherical", OWN_KEYS, coarsen=False)
    hub, what = secants.hub_loads(run, EVERY)
    factors = QUICK_FACTORS if run.quick else FACTORS
    tall_factors = QUICK_TALL_FACTORS if run.quick else TALL_FACTORS

    units = {
        "library": secants.series(run, bonded, factors, hub),
        "tall": secants.series(run, secants.tall(bonded, TALL), tall_factors, hub),
    }
    titles = {"library": "the scene's housing", "tall": f"a pedestal of {TALL:g} m"}
    with run.step("spherical"):
        free = secants.reacted(run, spherical, tall_factors[-1], hub)

    verdicts = []
    rows: list[list[Any]] = []
    statements: dict[tuple[str, int], str] = {}
    found: dict[tuple[str, int], Any] = {}
    parts: dict[tuple[str, int], Any] = {}
    for key, meshes in units.items():
        unit = meshes[-1]
        for a in (4, 5):
            found[key, a] = secant_stiffness.secant(unit.loads, unit.motions, a)
            parts[key, a] = secant_stiffness.parts_of(unit.loads, unit.motions, unit.fit.matrix, a)
            statements[key, a] = secant_stiffness.statement(found[key, a], parts[key, a])
            for j in np.argsort(-np.abs(parts[key, a].shares))[:TERMS]:
                rows.append(
                    [
                        titles[key],
                        FORCES[a],
                        found[key, a].stiffness / 1e6,
                        100.0 * found[key, a].scatter,
                        FORCES[j] if j < 6 else "nothing on the bearing",
                        float(parts[key, a].arms[j]) if j < 6 else None,
                        100.0 * float(parts[key, a].sizes[j]),
                        100.0 * float(parts[key, a].shares[j]),
                    ]
                )

    def band(key: str, figure: Any) -> float | None:
        """Three times the distance of two meshes (the factor for two, Roache 1994)."""
        if len(units[key]) < 2:
            return None
        coarse, fine = (figure(unit) for unit in units[key])
        return 3.0 * abs(float(fine) - float(coarse))

    # Made-up springs on the same shaft and under the same loads.
    with run.step("springs of a known form"):
        diagonal = np.diag(np.diag(units["library"][-1].stiffness))
        coupled = units["library"][-1].stiffness
        made = {
            "diagonal": secants.on_beam(bonded, diagonal, hub),
            "coupled": secants.on_beam(bonded, coupled, hub),
        }
        made_secants = {
            form: [secant_stiffness.secant(loads, motions, a) for a in (3, 4, 5)]
            for form, (loads, motions) in made.items()
        }
        fit = secant_stiffness.fitted_spring(*made["coupled"])
    size = np.sqrt(np.outer(coupled.diagonal(), coupled.diagonal()))
    verdicts += [
        judge(
            "beam on a diagonal spring: scatter of K_R over the load cases, worst of three axes",
            max(s.scatter for s in made_secants["diagonal"]),
            0.0,
            tolerance=1e-8,
            relative=False,
            source="a linear spring has one stiffness whatever the load",
            reason="round-off, of a saddle of some twenty equations with entries from 1e-9 to 1e3",
            measure="identity",
        ),
        judge(
            "beam on a coupled spring: matrix fitted to the load cases, worst term over the root "
            "of its diagonals",
            float(np.abs((fit.matrix - coupled) / size).max()),
            0.0,
            tolerance=1e-6,
            relative=False,
            source="the spring that was put in",
            reason="round-off times the condition of the motions, about 1e4",
            measure="identity",
        ),
    ]

    improvement = {}
    for key, meshes in units.items():
        unit = meshes[-1]
        at_axis = secants.vertical_scatter(unit)
        predicted = secants.predicted_scatter(unit)
        at_centre = secants.scatter_at_centre(unit)
        verdicts += [
            judge(
                f"{titles[key]}: scatter of K_R about y over the load cases, against the lean "
                "K_51 / K_11 times the thrust",
                100.0 * at_axis,
                100.0 * predicted,
                tolerance=0.1,
                unit="%",
                source="condensed 6x6 stiffness from unit loads without a gearbox: "
                "My = theta / C_55 + (K_51 / K_11) Fx",
                reason="seat average and condensed stiffness agree to a tenth",
                measure="stiffness",
                band=band(key, lambda u: 100.0 * secants.vertical_scatter(u)),
            ),
            judge(
                f"{titles[key]}: scatter of K_R about y at the elastic centre",
                100.0 * at_centre,
                0.0,
                tolerance=100.0 * secant_stiffness.SCATTERS,
                relative=False,
                unit="%",
                source="at the elastic centre thrust does not tilt: nothing is left to scatter",
                reason="from there on a single spring is called the wrong form",
                measure="stiffness",
                band=band(key, lambda u: 100.0 * secants.scatter_at_centre(u)),
            ),
            judge(
                f"{titles[key]}: shares of the scatter about y, their sum",
                float(parts[key, 4].shares.sum()),
                1.0,
                tolerance=1e-9,
                source="the terms and the rest are all of the moment",
                reason="round-off",
                measure="identity",
            ),
        ]
        improvement[key] = secants.beam_errors(unit, hub)
    errors = improvement["tall"]
    single, with_lean = (errors[form]["My"] for form in (secants.SINGLE, secants.LEAN))
    # with loads of little thrust the beam's own error would be all that there is to see
    if errors[secants.SINGLE][secants.OF_FORM] > 2.0 * errors[secants.FULL]["My"]:
        verdicts.append(
            judge(
                f"{titles['tall']}: error of the beam's My with the coupling over that with a "
                "single spring",
                with_lean / single,
                0.0,
                tolerance=0.5,
                relative=False,
                source="what the secant's scatter is due to is put back",
                reason="more than half of the error is due to the spring's form, or naming it was "
                "idle",
                measure="reaction",
                band=band(
                    "tall",
                    lambda u: (
                        secants.beam_errors(u, hub)[secants.LEAN]["My"]
                        / secants.beam_errors(u, hub)[secants.SINGLE]["My"]
                    ),
                ),
            )
        )
    moments = np.abs(free[0][:, 3:]).max()
    verdicts.append(
        judge(
            "spherical bearing: largest moment over the largest at the hub",
            float(moments / np.abs(hub[:, 3:]).max()),
            0.0,
            tolerance=1e-6,
            relative=False,
            source="a sphere that slides carries no moment: K_R is zero in all load cases",
            reason="accuracy of the solution; the nodal normals of the raceway meet at its centre "
            "to the curved mesh's order",
            measure="identity",
        )
    )

    def secant_traces(key: str) -> list[Any]:
        unit = units[key][-1]
        there = secants.at_centre(unit)
        at_axis = found[key, 4].secants
        at_there = secant_stiffness.secant(*there, 4).secants
        slope = unit.loads[:, 0] / unit.motions[:, 4] / 1e6
        # seen: each case, at most as many as a page shows without weight
        chosen = np.linspace(0, len(slope) - 1, min(len(slope), 600)).astype(int)
        kept = chosen[np.isfinite(at_axis[chosen])]
        kept_there = chosen[np.isfinite(at_there[chosen])]
        small = {"marker": {"size": 4, "opacity": 0.6}}
        return [
            trace(f"{titles[key]}, at the axis", slope[kept], at_axis[kept] / 1e6, True, **small),
            trace(
                f"{titles[key]}, at the elastic centre",
                slope[kept_there],
                at_there[kept_there] / 1e6,
                True,
                **small,
            ),
        ]

    left_out = float(np.isnan(found["library", 4].secants).mean())
    error_rows: list[list[Any]] = [
        [titles[key], form, *(by[c] for c in (*secants.QUANTITIES, secants.OF_FORM))]
        for key, forms in improvement.items()
        for form, by in forms.items()
    ]
    centre = {
        key: secant_stiffness.elastic_centre(meshes[-1].stiffness) for key, meshes in units.items()
    }
    library = improvement["library"]
    fit_rows: list[list[Any]] = [
        [
            titles[key],
            meshes[-1].fit.motions,
            100.0 * meshes[-1].fit.asymmetry,
            *(100.0 * float(v) for v in meshes[-1].fit.unexplained),
        ]
        for key, meshes in units.items()
    ]
    return CASE.results(
        run,
        summary=[
            f"{titles['library'].capitalize()}: {statements['library', 4]}.",
            f"{titles['tall'].capitalize()}: {statements['tall', 4]}.",
            f"Taken at the elastic centre, {-centre['library']:.3f} and {-centre['tall']:.3f} m "
            "below the shaft's axis, the scatter falls to "
            f"{100 * secants.scatter_at_centre(units['library'][-1]):.2g} and "
            f"{100 * secants.scatter_at_centre(units['tall'][-1]):.2g} %: a torsional spring that "
            "stands there is the right form.",
            f"In the beam model the named coupling takes the error of My from {single:.2g} to "
            f"{with_lean:.2g} % for the tall pedestal, and the full 6x6 to "
            f"{errors[secants.FULL]['My']:.2g} %; for the scene's housing from "
            f"{library[secants.SINGLE]['My']:.2g} to {library[secants.LEAN]['My']:.2g} %: there "
            f"the form of the spring does {library[secants.SINGLE][secants.OF_FORM]:.2g} %, and "
            "what is left is the beam's.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="The secant over load cases",
                items=[
                    Text(text=what),
                    chart(
                        "K_R about y of each load case against the thrust on the bearing over its "
                        "rotation: level at the elastic centre; at the axis a line whose slope is "
                        "the arm of the thrust. Cases that "
                        f"turn the bearing by less than {secant_stiffness.LEAST_ROTATION:g} of the "
                        f"root mean square ({100 * left_out:.0f} %) have no secant and are not "
                        "shown; in scatter and stiffness they count",
                        [*secant_traces("library"), *secant_traces("tall")],
                        "Fx over rotation about y [MN/rad]",
                        "My / rotation [MN m/rad]",
                    ),
                    *(
                        Text(text=f"{titles[key].capitalize()}, {plane}: {statements[key, a]}.")
                        for key in units
                        for a, plane in ((4, "vertical plane"), (5, "horizontal plane"))
                    ),
                ],
            ),
            Section(
                title="Which coupling breaks it",
                items=[
                    Table(
                        caption="What a moment follows beside its own rotation, by the 6x6 spring "
                        "fitted to the load cases, M_a = theta_a / C_aa - sum C_aj R_j / C_aa: "
                        "each term less its part in proportion to the rotation, which scatters "
                        f"nothing; the {TERMS} that scatter most. Size: root mean square over that "
                        "of the moment. Share: of the scatter",
                        columns=[
                            "housing",
                            "moment",
                            "secant [MN m/rad]",
                            "scatter [%]",
                            "also follows",
                            "arm [m; of a moment -]",
                            "size [%]",
                            "share of the scatter [%]",
                        ],
                        rows=rows,
                    ),
                    Table(
                        caption="How far one spring at one point holds: what the fitted 6x6 leaves "
                        "unexplained of each load [%]. It need not be symmetric, since loads from "
                        "the hub and from the gearbox press on the seat in different places",
                        columns=[
                            "housing",
                            "independent motions",
                            "asymmetry [%]",
                            *(f"{c} [%]" for c in FORCES),
                        ],
                        rows=fit_rows,
                    ),
                ],
            ),
            Section(
                title="The remedy in a beam model",
                items=[
                    Table(
                        caption="Root mean square error of a Timoshenko beam against the assembly "
                        "of solids over the load cases, over the root mean square of each reaction "
                        "of the main bearing [%]. Stiffnesses from unit loads without a gearbox, "
                        "not fitted to the load cases, but for the secant",
                        columns=[
                            "housing",
                            "spring",
                            *(f"{q} [%]" for q in secants.QUANTITIES),
                            "My, against the beam on the full 6x6 [%]",
                        ],
                        rows=error_rows,
                    ),
                    Text(
                        text="A program that takes no 6x6 matrix gets the same from a diagonal "
                        "spring at the elastic centre, tied to the shaft by a rigid arm. What the "
                        "full matrix leaves is the beam's own: plane sections, and no ring on the "
                        "shaft. Where that is as large as what the form of the spring does (last "
                        "column), the two may cancel, and a better spring gives no better moment."
                    ),
                ],
            ),
            Section(
                title="Where K_R must not scatter",
                items=[
                    Table(
                        caption="Springs of a known form on the same shaft under the same loads: "
                        "scatter of the secant [%]",
                        columns=["spring", "about x", "about y", "about z"],
                        rows=[
                            [form, *(100.0 * s.scatter for s in by)]
                            for form, by in made_secants.items()
                        ],
                    ),
                    Text(
                        text="The spherical bearing carries no moment in any load case (largest "
                        f"{moments:.2g} N m): its K_R is zero but for round-off."
                    ),
                ],
            ),
        ],
        assumptions=study.assumptions(bonded),
        figures={
            "secant": {
                f"{key} {FORCES[a]}": {"K_R": f.stiffness, "scatter": f.scatter}
                for (key, a), f in found.items()
            },
            "statements": {f"{key} {FORCES[a]}": s for (key, a), s in statements.items()},
            "beam errors": improvement,
            "elastic centre": centre,
        },
    )


CASE = Case(
    name="main_bearing/secant_stiffness",
    title="K_R as a secant over load cases, and the coupling that makes it scatter",
    source="Stirling 2023, PhD thesis, section 3.3.1, Eq 3.20",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
