"""A run of the same drivetrain under other random torques, and what explains its numbers."""

from functools import partial

import numpy as np

from fe_drivetrain.cases.procedure.known_drivetrain import (
    BRAKING,
    BROAD,
    DAMPING,
    DRIVING,
    FRONT,
    OMEGA,
    REAR,
    REDUCED,
    STEP,
    TRUTH,
    simulated,
)
from fe_drivetrain.procedure import least_squares, ratio_by_ranges
from fe_drivetrain.report.suite import Page, Record

OF = ("inertia / truth", "damping / truth", "stiffness / truth")


def elsewhere(page: Page, rows: list[Record]) -> None:
    """A run of the same drivetrain under other random torques, beside this one."""
    ours = partial(spread_of, rows)
    shares = [row["share above zero"] for row in rows if row["method"][0] in "BC"]
    aerodynamic = [ours(key, "l", torque="aerodynamic", run="broadband") for key in OF]
    page.table(
        "Over the truth: an independent run of 570 s with other random torques, and this one",
        [
            ("Eq 4: stiffness", "1.0013, 1.0018", ours(OF[2], "E")),
            (
                f"Eq 5: I / D [s]; 1 / w is {1.0 / OMEGA:.4f}, the truth {REDUCED / DAMPING:.3f}",
                "0.0641, 0.0621",
                ", ".join(
                    row["of these"].split()[-2] for row in rows if row["method"][:4] == "Eq 5"
                ),
            ),
            ("A on the shaft's torque: inertia", "0.03", ours(OF[0], "A", torque="shaft")),
            ("A on the shaft's torque: damping", "0.50", ours(OF[1], "A", torque="shaft")),
            ("A on the reduced torque: inertia", "0.53", ours(OF[0], "A", torque="reduced")),
            ("A on the reduced torque: damping", "8.7 to 8.9", ours(OF[1], "A", torque="reduced")),
            ("B, C: inertia", "-1.1 to 4.4", ours(OF[0], "B", "C")),
            ("B, C: damping", "-54 to 33", ours(OF[1], "B", "C")),
            ("B, C: share above zero", "0 to 0.41", f"{min(shares):.2g} to {max(shares):.2g}"),
            (
                "least squares, aerodynamic torque, broadband: I, D, K",
                "2.2, 5.2, 2.2",
                ", ".join(aerodynamic),
            ),
            (
                "least squares, aerodynamic torque, resonance: I, D, K",
                "7.3 each",
                ours(OF[0], "l", torque="aerodynamic", run="resonance"),
            ),
        ],
        ["quantity", "independent run", "this run"],
    )
    check_aerodynamic(page, float(aerodynamic[0]))
    page.text(
        "Methods A to C are those of Eq 6 to 13, and medians of B and C are medians of noise, so "
        "that two runs agree in their size only."
    )


def spread_of(rows: list[Record], key: str, *method: str, torque: str = "", run: str = "") -> str:
    """One value, or the least and the largest, of methods by their first letter."""
    values = [
        float(row[key])
        for row in rows
        if row["method"][0] in method
        and row[key] is not None
        and torque in ("", row["torque"])
        and run in ("", row["run"])
    ]
    digits = 5 if method == ("E",) else 3
    low, high = (f"{v:.{digits}g}" for v in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def check_aerodynamic(page: Page, inertia: float) -> None:
    """Least squares on a torque that is not the reduced one."""
    ratio = BRAKING * FRONT / (DRIVING * REAR)
    page.equals(
        "broadband, least squares on the aerodynamic torque: inertia over the truth",
        inertia,
        FRONT / REDUCED / (1.0 + ratio**2),
        within=0.1,
        relative=False,
        why="two random torques of 20 Hz have by chance a correlation of 1 / sqrt(7600) in 190 s; "
        f"three times that, times s_g J_r / (s_a J_g) = {ratio:.1f}",
        source="regression on the reduced torque: J_r / J* / (1 + (s_g J_r / (s_a J_g))^2)",
        measure="identity",
    )


def shares_of_braking(page: Page) -> None:
    """Least squares on the aerodynamic torque, by how the generator's torque varies besides."""
    needed = float(np.sqrt(FRONT / REDUCED / 2.2 - 1.0)) * REAR / FRONT
    runs = [(share, 20.0, 20.0) for share in (0.0, 0.1, needed, BRAKING / DRIVING, 1.0)]
    runs += [(needed, rotor, other) for rotor, other in ((3.0, 3.0), (3.0, 20.0), (20.0, 3.0))]
    rows: list[Record] = []
    for share, rotor, other in runs:
        bands = (BROAD[0], rotor), (BROAD[0], other)
        twists = simulated(round(570.0 / STEP), bands[0], share * DRIVING, bands[1])
        found = least_squares(twists["aerodynamic"]).values / TRUTH
        rows.append(
            {
                "s_g / s_a": share,
                "rotor's torque up to [Hz]": rotor,
                "generator's up to [Hz]": other,
                "regression, equal bands": FRONT / REDUCED / (1.0 + (share * FRONT / REAR) ** 2),
                **dict(zip(OF, map(float, found), strict=True)),
                "Eq 5: I / D [s]": float(np.median(ratio_by_ranges(twists["shaft"]))),
            }
        )
    page.table("Least squares on the aerodynamic torque in 570 s, by the generator's torque", rows)
    page.data("braking", rows)
    at = rows[2]
    page.equals(
        "generator's torque that makes inertia 2.2 times the truth: stiffness over the truth",
        float(at[OF[2]]),
        float(at["regression, equal bands"]),
        within=0.1,
        relative=False,
        why="two random torques of 20 Hz have by chance a correlation of 1 / sqrt(22800) in 570 s; "
        f"three times that, times s_g J_r / (s_a J_g) = {needed * FRONT / REAR:.1f} and 2.2, is "
        "0.07",
        source="regression on the reduced torque: J_r / J* / (1 + (s_g J_r / (s_a J_g))^2)",
        measure="identity",
    )
    damping = [float(row[OF[1]]) for row in rows if row["s_g / s_a"] == needed]
    page.text(
        "The independent run has 2.2, 5.2 and 2.2 for inertia, damping and stiffness, and states "
        "neither its generator's torque nor the bands of both. Inertia and stiffness follow from "
        f"s_g / s_a alone: 2.2 of both is {needed:.3f}. Damping follows from the spectra near the "
        f"resonance: {at[OF[1]]:.2f} with equal bands, {min(damping):.2g} to {max(damping):.2g} "
        "with bands of 3 and 20 Hz. 5.2 is within that range, towards a generator's torque of a "
        "wider band than the rotor's; which bands were used is not known, so that it is not "
        "reproduced. The 0.0641 s of its Eq 5 ask for narrow bands, too."
    )
