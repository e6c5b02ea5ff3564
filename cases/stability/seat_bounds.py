"""Tilt stiffness of a seat by rigid, averaged and sliding coupling: what bounds what, and where."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Widths of the loaded band [m]; the ring is as long as the last.
WIDTHS = (0.015, 0.03, 0.06, 0.09, 0.12, 0.18, 0.24, 0.3)
QUICK_WIDTHS = (0.015, 0.06, 0.18, 0.3)
#: Largest edges of the elements [m], of the sixth order and of the second.
SIZES = (0.06, 0.03, 0.015)
QUICK_SIZES = (0.12, 0.06, 0.03)
ROUGH_SIZES = (0.15, 0.075, 0.0375, 0.02, 0.01, 0.006)
QUICK_ROUGH_SIZES = (0.15, 0.075, 0.0375, 0.02)
#: Lengths of rings whose whole bore is loaded, over the bore's diameter.
LONG = (0.5, 0.6, 0.7, 0.8, 1.0, 2.0, 4.0)
QUICK_LONG = (0.5, 0.8, 2.0)
STRIP = 0.03  # m, of the band that is compared with a narrow strip
PLAIN_WIDTH = 0.06  # m, of the sweep over meshes
TURN, QUICK_TURN = 12, 8  # hexahedra round the axis

GAP = 0.10  # what two couplings may differ by and still stand for one stiffness
MESH_ERROR = 0.01


def run(run: Run) -> Any:
    """Sweep the width of the band, then the mesh."""
    import numpy as np

    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        seat_couplings as seat,
    )

    widths = QUICK_WIDTHS if run.quick else WIDTHS
    rough = QUICK_ROUGH_SIZES if run.quick else ROUGH_SIZES
    sizes = QUICK_SIZES if run.quick else SIZES
    turn = QUICK_TURN if run.quick else TURN
    thickness = seat.OUTSIDE - seat.BORE

    with run.step("widths"):
        swept = [seat.tilted(width, sizes[1]) for width in widths]
        coarser = [seat.tilted(width, sizes[0]) for width in widths]
    with run.step("meshes"):
        fine = [seat.tilted(PLAIN_WIDTH, size) for size in sizes]
        strip = [seat.tilted(STRIP, size)["sliding"].stiffness for size in sizes]
        plain = [seat.tilted(PLAIN_WIDTH, size, 2) for size in rough]
    long = QUICK_LONG if run.quick else LONG
    with run.step("lengths"):
        lengths = [2.0 * seat.BORE * ratio for ratio in long]
        whole = [seat.tilted(length, 0.1, length=length) for length in lengths]
    with run.step("couplings of the library"):
        solid = seat.tilted_solid(PLAIN_WIDTH, 0.06, turn)
        harmonic = seat.tilted(PLAIN_WIDTH, 0.06, 2)

    K = {c: np.array([found[c].stiffness for found in swept]) for c in seat.COUPLINGS}
    # Stress is singular at the edges of a rigid band: errors fall with the size at worst by h.
    # Where the order is one, as much is left as two meshes differ by; it is doubled for safety.
    band = {
        c: 2.0 * np.abs(K[c] - [found[c].stiffness for found in coarser]) for c in seat.COUPLINGS
    }
    of_mean = {
        c: np.array([found[c].moment / found[c].mean for found in swept]) for c in seat.COUPLINGS
    }
    ratio = {c: K[c] / K["rigid"] for c in ("averaged", "sliding")}

    limit = {
        c: grid_convergence(
            sizes, [found[c].stiffness for found in fine], expected_order=1.0, least_order=0.5
        )
        for c in seat.COUPLINGS
    }
    errors = {
        c: np.array([abs(f[c].stiffness / limit[c].extrapolated - 1.0) for f in plain])
        for c in seat.COUPLINGS
    }

    def widest_within(values: Any) -> float | None:
        """The last width up to which two couplings are within the gap."""
        within = 1.0 - values <= GAP
        return float(widths[int(np.argmin(within)) - 1]) if within[0] else None

    narrow = widest_within(ratio["averaged"])
    coarsest = {
        c: max((s for s, e in zip(rough, errors[c], strict=True) if e <= MESH_ERROR), default=None)
        for c in seat.COUPLINGS
    }

    verdicts = [
        judge(
            "averaged coupling over rigid one, largest of all widths and meshes",
            max(
                found["averaged"].stiffness / found["rigid"].stiffness
                for found in (*swept, *coarser, *fine, *plain)
            ),
            0.5,
            tolerance=0.5,
            relative=False,
            source="fields that fulfil the rigid coupling fulfil the averaged one: least energy of "
            "fewer fields is more",
            reason="between 0 and 1 on every mesh, since it holds of the discrete fields alike",
            measure="stiffness",
            band=float((band["averaged"] / K["rigid"]).max()),
        ),
        judge(
            "sliding coupling over rigid one, largest of all widths and meshes",
            max(
                found["sliding"].stiffness / found["rigid"].stiffness
                for found in (*swept, *coarser, *fine, *plain)
            ),
            0.5,
            tolerance=0.5,
            relative=False,
            source="the same: a sliding band is held in fewer ways than a rigid one",
            reason="between 0 and 1 on every mesh",
            measure="stiffness",
            band=float((band["sliding"] / K["rigid"]).max()),
        ),
        judge(
            "energy of the sliding field over that of the averaged one of equal mean rotation: "
            "least of all widths is 1 or more",
            float(
                min(f["sliding"].of_mean / f["averaged"].stiffness for f in (*swept, *fine)) >= 1.0
            ),
            1.0,
            tolerance=0.0,
            source="of all fields of one mean rotation the averaged coupling has the least energy",
            reason="an inequality that each mesh fulfils",
            measure="identity",
        ),
    ]
    narrowest = grid_convergence(sizes, strip, expected_order=1.0, least_order=0.5)
    verdicts.append(
        judge(
            f"failure: sliding band {1e3 * STRIP:g} mm wide, tilt stiffness, extrapolated",
            narrowest.extrapolated / 1e6,
            seat.smooth_strip(STRIP) / 1e6,
            tolerance=STRIP / thickness,
            unit="MN m/rad",
            source="smooth rigid strip on a half plane, pi E w^2 / (16 (1 - nu^2)) a length; "
            "round the bore its cosine gives pi a times that",
            reason="the ring is no half plane: of the order of the band's width over the wall's, "
            f"{STRIP / thickness:.2g}",
            measure="stiffness",
            band=narrowest.extrapolated_uncertainty / 1e6,
        )
    )
    for c in seat.COUPLINGS:
        verdicts.append(
            judge(
                f"couplings of the library, {c}: tilt stiffness in hexahedra, {turn} round",
                solid[c].stiffness / 1e6,
                harmonic[c].stiffness / 1e6,
                tolerance=(np.pi / turn) ** 4,
                unit="MN m/rad",
                source="the first harmonic on the same mesh of the meridian",
                reason="quadratic elements round the turn: the fourth power of half their angle, "
                f"{(np.pi / turn) ** 4:.1e}",
                measure="stiffness",
                band=harmonic[c].stiffness / 1e6 * (np.pi / turn) ** 4,
            )
        )
    for c in ("rigid", "averaged"):
        verdicts.append(
            judge(
                f"remedy: {c} coupling, elements of sixth order, {1e3 * sizes[-1]:g} mm",
                fine[-1][c].stiffness / 1e6,
                limit[c].extrapolated / 1e6,
                tolerance=MESH_ERROR * (2.0 if run.quick else 1.0),
                unit="MN m/rad",
                source=limit[c].sentence("N m/rad"),
                reason="the criterion of the sweep over meshes"
                + ("; twice that on elements twice as large" if run.quick else ""),
                measure="stiffness",
                band=limit[c].uncertainty / 1e6,
            )
        )
    over_rigid = [
        size
        for size, found in zip(rough, plain, strict=True)
        if found["averaged"].stiffness > limit["rigid"].extrapolated
    ]
    wrong_sign = [w for w, k in zip(widths, of_mean["sliding"], strict=True) if k < 0]
    by_mean = [f["sliding"].moment / f["sliding"].mean / f["rigid"].stiffness for f in whole]
    right = [ratio for ratio, k in zip(long, by_mean, strict=True) if k > 0]
    of_library, of_harmonic = (
        found["sliding"].moment / found["sliding"].mean / 1e6 for found in (solid, harmonic)
    )
    verdicts.append(
        judge(
            f"failure: sliding band {1e3 * PLAIN_WIDTH:g} mm wide by its mean rotation, which "
            f"points against the moment, averaged point in hexahedra, {turn} round",
            of_library,
            of_harmonic,
            tolerance=(np.pi / turn) ** 4,
            unit="MN m/rad",
            source="the first harmonic on the same mesh of the meridian, its mean an integral",
            reason="quadratic elements round the turn; weights of nodes integrate a cubic exactly",
            measure="stiffness",
            band=abs(of_harmonic) * (np.pi / turn) ** 4,
        )
    )
    relative = {c: np.abs(ratio[c]) for c in ratio}
    share = [100.0 * w / seat.LENGTH for w in widths]
    rows = [
        [
            1e3 * w,
            *(K[c][k] / 1e6 for c in seat.COUPLINGS),
            100.0 * (1.0 / ratio["averaged"][k] - 1.0),
            of_mean["sliding"][k] / 1e6,
        ]
        for k, w in enumerate(widths)
    ]
    gap = 1.0 - ratio["averaged"]
    bounding = _least_bounding(widths, ratio)
    nowhere = "at every width of the sweep: " if bounding is None else ""
    sliding = f"{100 * ratio['sliding'][0]:.2g} to {100 * ratio['sliding'][-1]:.2g} %"
    return CASE.results(
        run,
        summary=[
            f"Rigid and averaged coupling bracket the tilt stiffness of a bonded seat: they are "
            f"{100 * gap[0]:.2g} % apart on a band of {1e3 * widths[0]:g} mm and "
            f"{100 * gap[-1]:.2g} % where the whole bore is loaded"
            + (
                f"; within {100 * GAP:g} % up to {1e3 * narrow:g} mm."
                if narrow is not None
                else f"; never within {100 * GAP:g} %."
            ),
            f"The averaged one is no lower bound for a seat without friction: that has {sliding} "
            f"of the rigid stiffness, and at {len(wrong_sign)} of {len(widths)} widths its mean "
            "rotation points against the moment.",
            *(
                [
                    f"On elements of second order of {over_rigid[-1]:g} m and more even the "
                    "averaged coupling is stiffer than the rigid one really is: a bracket holds "
                    "only on a mesh that has converged."
                ]
                if over_rigid
                else []
            ),
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Width of the band",
                items=[
                    chart(
                        "Tilt stiffness of the band over that of the rigid coupling: averaged "
                        "falls as the band grows, sliding as it shrinks; shaded where rigid and "
                        f"averaged are within {100 * GAP:g} %",
                        [
                            trace(c, share, relative[c], mode="lines+markers")
                            for c in ("averaged", "sliding")
                        ]
                        + [
                            trace(
                                "smooth strip (theory)",
                                share,
                                [seat.smooth_strip(w) for w in widths] / K["rigid"],
                                line={"dash": "dot"},
                            )
                        ],
                        "width of the loaded band, of the ring's length [%]",
                        "over rigid",
                        logarithmic="xy",
                        safe=None if narrow is None else (None, 100.0 * narrow / seat.LENGTH),
                    ),
                    Table(
                        caption="Tilt stiffness [MN m/rad]; the last column by the mean rotation",
                        columns=[
                            "width [mm]",
                            *seat.COUPLINGS,
                            "rigid over averaged, less one [%]",
                            "sliding, by its mean rotation",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Stiffness is M^2 / 2U, the moment over the rotation that it does "
                        "work on. Any traction of that moment stores at least as much energy as "
                        "the rigid coupling's, so this stiffness never exceeds the rigid one. The "
                        "averaged coupling bounds 2U / theta^2 with the mean rotation theta from "
                        "below, and not M^2 / 2U: a load that the mean hardly sees, such as "
                        "normal pressure on a narrow band, can be far softer."
                    ),
                ],
            ),
            Section(
                title="Length of a seat without friction",
                items=[
                    chart(
                        "Whole bore loaded, over the rigid coupling's tilt stiffness: by its mean "
                        "rotation a short sliding seat is stiffer than a rigid one, and where it "
                        "is shorter still the mean points against the moment. Shaded where it "
                        "points with it",
                        [
                            trace(
                                "averaged",
                                long,
                                [f["averaged"].stiffness / f["rigid"].stiffness for f in whole],
                                mode="lines+markers",
                            ),
                            trace(
                                "sliding, by energy (remedy)",
                                long,
                                [f["sliding"].stiffness / f["rigid"].stiffness for f in whole],
                                mode="lines+markers",
                            ),
                            trace(
                                "sliding, by its mean rotation",
                                long,
                                by_mean,
                                mode="lines+markers",
                            ),
                        ],
                        "length of the ring over the diameter of its bore",
                        "over rigid",
                        logarithmic="x",
                        safe=(min(right), None) if right else None,
                    )
                ],
            ),
            Section(
                title="Mesh",
                items=[
                    chart(
                        f"Error of the tilt stiffness, band of {1e3 * PLAIN_WIDTH:g} mm, elements "
                        "of second order: all are too stiff; shaded where the averaged coupling "
                        f"is within {100 * MESH_ERROR:g} %",
                        [
                            *(
                                trace(c, rough, errors[c], mode="lines+markers")
                                for c in seat.COUPLINGS
                            ),
                            *(
                                trace(
                                    f"{c}, sixth order (remedy)",
                                    sizes,
                                    [
                                        abs(f[c].stiffness / limit[c].extrapolated - 1.0)
                                        for f in fine
                                    ],
                                    mode="lines+markers",
                                    line={"dash": "dash"},
                                )
                                for c in ("rigid", "averaged")
                            ),
                        ],
                        "largest edge of an element [m]",
                        "relative error",
                        logarithmic="xy",
                        safe=(None, coarsest["averaged"]) if coarsest["averaged"] else None,
                    )
                ],
            ),
        ],
        limits=[
            Limit(
                method="rigid and averaged coupling of a seat as one stiffness",
                parameter="width of the loaded band [m], ring 0.3 m long, 0.6 m bore",
                high=narrow,
                criterion=f"rigid and averaged tilt stiffness within {100 * GAP:g} %",
                beyond=f"apart by up to {100 * gap.max():.2g} % of the rigid one: the stiffness is "
                "a property of the coupling",
                program="couples hub and gearbox as the scene says, and takes K_R of the bonded "
                "bearing from the whole assembly",
                remedy="both, as a bracket; or the neighbouring part modelled and bonded",
            ),
            Limit(
                method="averaged coupling as a lower bound of a frictionless seat",
                parameter="width of the loaded band [m]",
                low=bounding,
                criterion="sliding coupling no softer than the averaged one",
                beyond=f"{nowhere}the sliding seat has {sliding} of the rigid stiffness, and its "
                "mean rotation points against the moment",
                program="gives no K_R of a seat that slides: its spherical joint carries no moment",
                remedy="M^2 / 2U of the sliding coupling",
            ),
            Limit(
                method="mean rotation of a seat that slides, as its tilt",
                parameter="length of the loaded bore over its diameter",
                low=min(right, default=None),
                criterion="the mean rotation points with the moment",
                beyond="it points against the moment: its axial displacement counts for more than "
                "its tilt; even then too stiff, by " + _factors(whole) + " times at the longest",
                program="takes K_R only of bonded seats",
                remedy="M^2 / 2U",
            ),
            *(
                Limit(
                    method=f"{c} coupling of a band, elements of second order",
                    parameter=f"edge of the elements [m], band of {PLAIN_WIDTH:g} m",
                    high=coarsest[c],
                    criterion=f"error of the stiffness below {100 * MESH_ERROR:g} %",
                    beyond=f"too stiff by up to {100 * errors[c].max():.2g} %"
                    + (
                        f"; still {100 * errors[c].min():.2g} % at {rough[-1]:g} m"
                        if coarsest[c] is None
                        else ""
                    ),
                    program="nothing: one mesh does not show it; the cases of the main bearing "
                    "state bands from three",
                    remedy="elements of sixth order on the meridian, or extrapolation of meshes",
                )
                for c in ("rigid", "averaged")
            ),
        ],
        figures={
            "widths": list(widths),
            "stiffness": {c: K[c].tolist() for c in K},
            "sizes": list(rough),
            "errors": {c: errors[c].tolist() for c in errors},
        },
    )


def _factors(whole: Any) -> str:
    longest = whole[-1]["sliding"]
    return f"{longest.moment / longest.mean / longest.stiffness:.2g}"


def _least_bounding(widths: Any, ratio: Any) -> float | None:
    """Least width from which on the sliding coupling is no softer than the averaged one."""
    bounds = [
        w
        for w, sliding, mean in zip(widths, ratio["sliding"], ratio["averaged"], strict=True)
        if sliding >= mean
    ]
    return min(bounds, default=None)


CASE = Case(
    name="stability/seat_bounds",
    title="Rigid, averaged and sliding coupling of a seat: bounds of its tilt stiffness",
    source="least energy under ever fewer constraints; the smooth rigid strip on a half plane "
    "(Johnson 1985, Contact Mechanics, section 2.8)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
