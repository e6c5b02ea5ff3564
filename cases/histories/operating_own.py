"""The answer on a user's main bearing over the operating range."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases.histories.operating_loads import BASE, MOMENT, RADIAL
from fe_drivetrain.cases.histories.operating_rollers import Rollers
from fe_drivetrain.cases.histories.operating_words import FLAT, STEEP, BySet
from fe_drivetrain.cases.references.main_bearings import OwnBearing
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.studies.rolling_bearings import row_names
from fe_drivetrain.studies.shown_units import bearing_in_words


def own_answer(page: Page, own: OwnBearing, means: Sequence[Record], rollers: Rollers) -> None:
    """State the largest load of a roller and where it stands, and what wind and shear do.

    Parameters
    ----------
    page : Page
        Takes the answer.
    own : OwnBearing
        The bearing.
    means : sequence of dict
        Loads of the bearing by wind and set.
    rollers : Rollers
        Loads of its rollers.
    """
    sets = {str(row["set"]): [r for r in means if r["set"] == row["set"]] for row in means}
    one = BySet(sets)
    largest = np.stack([rollers.largest[name] for name in sets])  # sets, winds, rows, places
    s, w, r, j = np.unravel_index(int(np.argmax(largest)), largest.shape)
    peak, row = float(largest.max()), row_names(largest.shape[2])[r]
    place = f"{np.degrees(rollers.psi[j]) % 360.0:.0f}\u00a0deg"
    aligning = one.of(f"mean {MOMENT}").max() < 1e-6 * one.of(f"mean {RADIAL}").max()
    load = RADIAL if aligning else MOMENT
    name, _, unit = load.rstrip("]").partition(" [")
    ends = [float(one.of(f"mean {load}")[k]) for k in (0, -1)]
    shear = rollers.peak(STEEP, "largest").max(axis=1) / rollers.peak(FLAT, "largest").max(axis=1)
    who = bearing_in_words(own.one.name)
    page.answer(
        f"What do the rollers of {who} carry from cut-in to cut-out?",
        f"At most {value_text(peak, 'kN')}, in the {row} at {place} at {rollers.winds[w]:g}\u00a0"
        f"m/s; its mean {name} goes from {value_text(ends[0], unit)} to "
        f"{value_text(ends[1], unit)}.",
        [
            page.value("largest load of a roller [kN]", peak),
            page.value(f"mean {name} at cut-in [{unit}]", ends[0]),
            page.value(f"mean {name} at cut-out [{unit}]", ends[1]),
            page.value("largest load of a roller at cut-out, shear 0.4 over 0.1", float(shear[-1])),
            page.value(
                "most loaded roller at cut-out, mean load [kN]",
                float(rollers.peak(BASE)[-1].max()),
            ),
        ],
        hero=f"Mean {load}, mean of seeds",
        cautions=[
            "Hub loads are those of a surrogate, brought to the rated power and speed of the "
            "drivetrain: give your own files to `fe-drivetrain life`.",
            "Housings are rigid: a housing that gives way spares the bearing moments.",
        ],
    )
    page.say(f"The largest load comes with the set '{list(sets)[s]}'.")
