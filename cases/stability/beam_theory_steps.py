"""Beam theory on a stepped shaft: what the corner of a step costs, sharp and with a fillet."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Large over small diameter.
RATIOS = (1.05, 1.1, 1.2, 1.35, 1.5, 2.0, 2.5, 3.0)
QUICK_RATIOS = (1.1, 1.5, 3.0)

#: Step ratio of the fillets' curves, length over the small diameter, radius over the step's
#: height, and the ratios of their map.
FILLETED, AT = 1.5, 3.0
RADII = (0.1, 0.25, 0.5, 1.0)
FILLET_RATIOS = (1.2, 1.5, 2.0, 2.5)
QUICK_RADII = (1.0,)

#: Length over the small diameter where the step's own flexibility is measured.
MEASURED = 6.0

OF = {"torsion": 3, "bending": 4, "tension": 0}


def run(run: Run) -> Any:
    """Map the errors of sharp steps, then of fillets; correct the beam; check both."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    lengths = np.append(np.geomspace(0.5, 30.0, 4 if run.quick else 7), AT)
    lengths.sort()
    ratios = np.array(QUICK_RATIOS if run.quick else RATIOS)
    ends = _ends()
    error = {name: np.empty((len(ratios), len(lengths))) for name in OF}
    corrected = {name: np.empty((len(ratios), len(lengths))) for name in OF}
    extra = {name: np.empty(len(ratios)) for name in OF}
    for i, ratio in enumerate(ratios):
        run.report(f"step {ratio:g}")
        with run.step("sharp steps"):
            measured = _without_ends(MEASURED, ratio, ends)
            found = [_without_ends(length, ratio, ends) for length in lengths]
        for name, k in OF.items():
            thin = maps.by_beam(maps.uniform(1.0))[k, k]
            extra[name][i] = (measured[k] - _beam(MEASURED, ratio)[k]) / thin
            beam = np.array([_beam(length, ratio)[k] for length in lengths])
            exact = np.array([one[k] for one in found])
            error[name][i] = 100 * (beam / exact - 1)
            corrected[name][i] = 100 * ((beam + extra[name][i] * thin) / exact - 1)

    with run.step("finer, and fillets"):
        rough = _without_ends(AT, FILLETED, ends)
        fine = _without_ends(AT, FILLETED, ends, finer=True)
        band = float(np.abs(rough / fine - 1)[list(OF.values())].max())
        radii = QUICK_RADII if run.quick else RADII
        fillet_ratios = (FILLETED,) if run.quick else FILLET_RATIOS
        rounded = {
            ratio: [_without_ends(AT, ratio, ends, radius * (ratio - 1) / 2) for radius in radii]
            for ratio in fillet_ratios
        }
    beam = _beam(AT, FILLETED)
    with_radius = {
        name: 100 * (beam[k] / np.array([rough[k], *(one[k] for one in rounded[FILLETED])]) - 1)
        for name, k in OF.items()
    }

    bent = np.array(
        [
            [100 * (_beam(AT, ratio)[4] / one[4] - 1) for one in found]
            for ratio, found in rounded.items()
        ]
    )

    verdicts = []
    for ratio in (1.5,) if run.quick else (1.2, 2.0):
        with run.step("bounds in torsion"):
            shaft = _shaft(2.0, ratio)
            bounds = torsion_bounds(shaft, maps.STEEL.shear_modulus, 0.12, 1 if run.quick else 4)
        k = 1 / maps.by_elements(shaft, ratio / 3)[3, 3]
        verdicts.append(
            judge(
                f"sharp step {ratio:g}, L = 2 d: torsional stiffness",
                float(k),
                bounds.middle,
                tolerance=bounds.half_width / bounds.middle + band,
                unit="N m/rad",
                source="middle of two bounds by complementary energies (Michell 1899)",
                reason="the truth lies between the bounds, and elements are too stiff by "
                f"{band:.1g}",
                measure="stiffness",
                band=band * k,
            )
        )
    with run.step("Saint-Venant's ends"):
        direct = _bent_by_tractions(AT, FILLETED)
    verdicts.append(
        judge(
            f"sharp step {FILLETED:g}, L = {AT:g} d: rotation by a moment, ends taken out by "
            "those of uniform shafts",
            float(rough[4]),
            direct,
            tolerance=2e-4,
            unit="rad/(N m)",
            source="the same shaft with linear tractions on both ends, which disturb nothing",
            reason="what an end and the step feel of each other across the shorter half, "
            "1 diameter of it: e^-5 (cylinder's slowest mode of bending) of an end's 1 %",
            measure="rotation",
            band=band * direct,
        )
    )
    usable = lengths >= 2 * ratios[:, None]
    for name in OF:
        verdicts.append(
            judge(
                f"{name}: beam with the step's extra length, worst error of all steps where both "
                "halves are as long as they are wide",
                float(np.abs(corrected[name][usable]).max()),
                0.0,
                tolerance=1.0,
                relative=False,
                unit="%",
                source="Fourier harmonics in the meridian",
                reason="1 % is what a map's first line promises; Saint-Venant's principle keeps "
                "the step's field apart from the ends' a diameter away",
                measure="rotation" if name != "tension" else "deflection",
                band=100 * band,
            )
        )
    # a rigid disc on a half-space is stiffer than a shaft of any softness grown on to it
    disc = 3 * np.pi / 64
    verdicts.append(
        judge(
            "torsion: extra length of the largest step is that of a rigid disc on a half-space "
            "or more",
            float(extra["torsion"][-1] >= disc * (1 - ratios[-1] ** -3)),
            1.0,
            tolerance=0.0,
            relative=False,
            source="Reissner and Sagoci 1944, J. Appl. Phys. 15, 652-654: M = 16/3 G a^3 phi, so "
            "G J / M phi is 3 pi / 64 d; less what the half-space has beyond the larger shaft, "
            "which goes as 1 / r^3",
            reason="yes or no: rigid is stiffer",
            measure="identity",
        )
    )

    shown = int(np.argmin(np.abs(ratios - 1.5)))
    rows = []
    for i, ratio in enumerate(ratios):
        row: list[Any] = [float(ratio)]
        for name in OF:
            row.append(extra[name][i])
            row += [maps.least_safe(lengths, error[name][i], level) for level in (1.0, 5.0)]
        worst = np.max([np.abs(values[i]) for values in corrected.values()], axis=0)
        rows.append([*row, maps.least_safe(lengths, worst, 1.0)])
    columns = ["D over d"]
    for name in OF:
        columns += [f"{name}: extra length over d", f"{name}: 1 %", f"{name}: 5 %"]
    columns.append("all three with their extra lengths: 1 %")
    safe = maps.least_safe(lengths, error["bending"][shown], 5.0)
    kept = maps.least_safe(lengths, corrected["bending"][shown], 5.0)
    curves = []
    for name, style in zip(OF, ("solid", "dash", "dot"), strict=True):
        for values, what, width in (
            (error[name], "", 2.5),
            (corrected[name], " with extra length", 1.0),
        ):
            curves.append(
                trace(
                    name + what,
                    lengths,
                    np.abs(values[shown]),
                    mode="lines+markers",
                    line={"color": "black", "dash": style, "width": width},
                )
            )
    axes = ("length of both halves over small diameter", "large over small diameter")
    softest = {name: float(values.min()) for name, values in error.items()}
    limits = [
        Limit(
            method="beam of sections, sharp step in the middle",
            parameter=f"length over small diameter, step {ratios[shown]:g}, {name}",
            low=maps.least_safe(lengths, error[name][shown], 5.0),
            high=None,
            criterion="flexibility within 5 %",
            beyond=f"too stiff, up to {-softest[name]:.0f} % over all steps: the corner of the "
            "large section carries nothing",
            program="none; the harmonics of a whole shaft take tens of milliseconds (axisymmetric)",
            remedy=f"{extra[name][shown]:.3f} d more of the small section: within 5 % from "
            f"{maps.least_safe(lengths, corrected[name][shown], 5.0) or float('nan'):.2g} d",
        )
        for name in OF
    ]
    return CASE.results(
        run,
        summary=[
            f"A sharp step from {ratios[shown]:g} d to d adds what {extra['torsion'][shown]:.3f} d "
            f"of the small section would in torsion, {extra['bending'][shown]:.3f} d in bending "
            f"and {extra['tension'][shown]:.3f} d in tension. Without it the beam is within 5 % in "
            f"bending from L = {safe or float('nan'):.2g} d, with it from "
            f"{kept or float('nan'):.2g} d.",
            f"A fillet takes much of that away: at L = {AT:g} d the beam without one errs in "
            f"bending by {with_radius['bending'][0]:+.1f} % where the step is sharp and by "
            f"{with_radius['bending'][-1]:+.1f} % where the radius is the step's height.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="How ends are held",
                items=[
                    Text(
                        text="Solid shafts, half of the length before the step and half behind it. "
                        "The ends are rigid in the finite elements, and what they take away (see "
                        "the case of uniform shafts) is taken out again, so that the error is the "
                        "step's alone; in one point that was checked against tractions that need "
                        "no such correction. In torsion rigid ends disturb nothing."
                    ),
                ],
            ),
            Section(
                title="Sharp steps",
                items=[
                    chart(
                        f"Error of the beam's flexibility, step {ratios[shown]:g}; shaded is where "
                        "bending is within 5 %",
                        curves,
                        axes[0],
                        "error without its sign [%]",
                        ("x", "y"),
                        safe=(safe, None),
                    ),
                    *(
                        chart(
                            f"{name.capitalize()} of a shaft with a sharp step: lines of 1, 5 and "
                            "10 % error of the beam (too stiff)",
                            maps.map_traces(lengths, ratios, error[name]),
                            *axes,
                            ("x",),
                        )
                        for name in OF
                    ),
                    Table(
                        caption="Extra length of the small section that stands for the step, and "
                        "least length over small diameter without it for errors within 1 % and "
                        f"5 %; at {lengths[0]:g} the sweep begins, and an empty cell is beyond "
                        f"{lengths[-1]:g}",
                        columns=columns,
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="Fillets",
                items=[
                    chart(
                        f"Error of the beam that knows no fillet, step {FILLETED:g}, "
                        f"L = {AT:g} d, against the fillet's radius: below zero it is too stiff",
                        [
                            trace(
                                name,
                                [0.0, *radii],
                                with_radius[name],
                                mode="lines+markers",
                                line={"color": "black", "dash": style},
                            )
                            for name, style in zip(OF, ("solid", "dash", "dot"), strict=True)
                        ],
                        "fillet radius over height of the step",
                        "error [%]",
                    ),
                    *(
                        []
                        if run.quick
                        else [
                            chart(
                                f"Bending of a shaft of L = {AT:g} d with a fillet that the beam "
                                "does not know: lines of 1, 5 and 10 % error",
                                maps.map_traces(
                                    np.array(radii), np.array(fillet_ratios), bent, 0.0
                                ),
                                "fillet radius over height of the step",
                                axes[1],
                                ("x",),
                            )
                        ]
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={
            "length_over_diameter": lengths.tolist(),
            "step_ratio": ratios.tolist(),
            "extra_length": {name: values.tolist() for name, values in extra.items()},
            "band": band,
        },
    )


def _shaft(length: float, ratio: float, fillet: float = 0.0) -> Any:
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    return maps.stepped((length / 2, length / 2), (ratio, 1.0), fillet)


def _beam(length: float, ratio: float) -> Any:
    """Flexibilities (6,)."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    return maps.by_beam(_shaft(length, ratio)).diagonal()


def _ends() -> Any:
    """What two rigid ends take off the flexibilities (6,) of a solid shaft of 1 m diameter."""
    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    shaft = maps.uniform(3.0)
    return (maps.by_elements(shaft, 0.3) - maps.by_beam(shaft)).diagonal()


def _without_ends(
    length: float, ratio: float, ends: Any, fillet: float = 0.0, finer: bool = False
) -> Any:
    """Flexibilities (6,) of the elements, less the ends'; of rotations and along x alone."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )

    shaft = _shaft(length, ratio, fillet)
    size = ratio / 3
    found = maps.by_elements(shaft, size * 0.7, 8, 5) if finer else maps.by_elements(shaft, size)
    # along x as 1 / D, of rotations as 1 / D^3
    power = np.array([1, 1, 1, 3, 3, 3])
    return found.diagonal() - 0.5 * ends * (1 + ratio ** -power.astype(float))


def _bent_by_tractions(length: float, ratio: float) -> float:
    """Rotation by a moment [rad/(N m)]: twice the energy of unit moments by linear tractions."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        beam_maps as maps,
    )
    from fe_drivetrain.geometry import LENGTH_TOLERANCE
    from fe_drivetrain.revolution import freedoms, harmonic_response, meridian, surface_loads

    mesh = meridian(_shaft(length, ratio), ratio / 3)

    def traction(at: Any, normal: Any) -> Any:
        outer = np.where(at[:, 0] < length / 2, ratio, 1.0)
        return np.column_stack([64 / np.pi / outer**4 * at[:, 1] * normal[:, 0], 0 * at])

    ends = mesh.sides(lambda x, r: (x < LENGTH_TOLERANCE) | (x > length - LENGTH_TOLERANCE))
    loads = surface_loads(mesh, 1, ends, traction)
    rim = mesh.where(lambda x, r: (x < LENGTH_TOLERANCE) & (r > ratio / 2 - LENGTH_TOLERANCE))
    held = (np.concatenate([freedoms(rim, 0), freedoms(rim, 1)]), np.zeros(2))
    return 2 * float(harmonic_response(mesh, maps.STEEL, 1, loads, held).energy[0])


CASE = Case(
    name="stability/beam_theory_steps",
    title="Beam theory against elasticity: stepped shafts, by length, step and fillet",
    source="Michell 1899, Proc. London Math. Soc. 31, 130-146; Reissner and Sagoci 1944, J. Appl. "
    "Phys. 15, 652-654",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
