"""Checks against the printed frequencies, and charts of mode shapes."""

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.comparison import digit
from fe_drivetrain.dynamics.torsion import Modes
from fe_drivetrain.report import shape_chart
from fe_drivetrain.report.suite import Page, Record, Target

ROUNDING = (
    "every input at its worst within half of its last printed digit, summed, and one unit of the "
    "reference's last digit, which the thesis cuts off in places (5.1951 rad/s stands as 0.826 Hz)"
)


def check_printed(
    page: Page,
    label: str,
    found: Floats,
    printed: Sequence[str],
    bands: Floats,
    source: str,
    leave_out: Collection[int] = (),
) -> None:
    """Frequencies against printed ones [Hz], but for free turning and what is left out (from 1).

    `bands` are the half widths that rounding of the inputs leaves.
    """
    for mode, (f, value, band) in enumerate(zip(found, printed, bands, strict=True), start=1):
        if float(value) != 0.0 and mode not in leave_out:
            within = float(band) + digit(value), ROUNDING, source
            title = f"{label}: frequency {mode} [Hz]"
            page.meets(float(f), Target(title, float(value), *within, relative=False))


def check_count(page: Page, label: str, wrong: int) -> None:
    """Whether `independent_torsion.certified` found every frequency in its place."""
    title = "frequencies that are not where exact counting puts them, of 1e-9"
    why = "a single frequency elsewhere fails; 1e-9 is far above what rounding leaves of singular "
    sylvester = "Sylvester's law of inertia, in rational arithmetic"
    page.meets(float(wrong), Target(title, 0.0, 0.5, f"{why}values", sylvester), of=label)


def frequency_rows(
    state: str, found: Floats, bands: Floats, printed: Sequence[str]
) -> list[Record]:
    """Frequencies beside those of Table 6.1."""
    return [
        {
            "generator": state,
            "mode": mode,
            "frequency [Hz]": float(f),
            "half width by rounding of the inputs [Hz]": float(band),
            "Table 6.1 [Hz]": value,
        }
        for mode, (f, band, value) in enumerate(zip(found, bands, printed, strict=True), start=1)
    ]


def show_shapes(
    page: Page, caption: str, modes: Modes, speeds: Mapping[str, float], chosen: Ints
) -> None:
    """Mode shapes seen from the rotor's shaft (angles over the speed ratio), largest 1."""
    seen = modes.shapes / np.array([[speeds[name]] for name in modes.names])
    seen = seen / np.abs(seen).max(axis=0)
    words = [f"{modes.frequencies[m]:.4g} Hz" for m in chosen]
    # the first that is no free turning is what an engineer asks for
    first = int(np.argmax(modes.frequencies[chosen] > 0.0))
    axis = "angle over speed ratio, largest 1"
    page.add(shape_chart(caption, modes.names, seen[:, chosen], words, axis, first))


def show_energy(page: Page, caption: str, springs: Sequence[str], modes: Modes, at: Ints) -> None:
    """Share of each spring in the strain energy of modes [%]."""
    shares = zip(springs, modes.stiffness_shares, strict=True)
    rows = [[spring, *(100 * share[at]).tolist()] for spring, share in shares]
    page.table(caption, rows, ["spring", *(f"{modes.frequencies[m]:.5g} Hz" for m in at)])
