"""Designs that a search has tried: each is computed once, and kept, so that it can be resumed."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.common.reading import changed
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.cached import whole_content
from fe_drivetrain.shafts.response.solution_keys import solved_by
from fe_drivetrain.shafts.uncertainty.kept_rows import EVERY
from fe_drivetrain.shafts.uncertainty.sampling import FINER, with_values
from fe_drivetrain.studies.design_quantities import DesignQuantities
from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest


class DesignTrials:
    """Designs with one combination of values of lists, over the ranges of the others.

    Parameters
    ----------
    asked : DesignQuantities
        What is asked of each.
    counts : mapping of str to int
        Number of values of each quantity.
    choice : mapping of str to object
        Values of keys that are lists.
    model : str
        By which designs are computed, see `fe_drivetrain.studies.design_quantities.MODELS`.

    Attributes
    ----------
    asked, counts, choice, model : DesignQuantities, Mapping, Mapping, str
        As given.
    made, kept : int
        Designs that were computed, and those that an earlier run had kept.
    fault : InputError or None
        Why the last design that cannot be built cannot.
    """

    def __init__(
        self,
        asked: DesignQuantities,
        counts: Mapping[str, int],
        choice: Mapping[str, Any],
        model: str = "cheap",
    ) -> None:
        self.asked, self.choice, self.model = asked, dict(choice), model
        self.counts = dict(counts)
        self.fault: InputError | None = None
        self.made = self.kept = 0
        self._known: dict[bytes, Floats | None] = {}
        self._content = {**_content(asked, self.choice, model), "counts": self.counts}
        self._last = time.monotonic()
        self._load()

    @property
    def rejected(self) -> int:
        """Number of designs that could not be built."""
        return sum(row is None for row in self._known.values())

    def in_words(self, at: Floats) -> str:
        """A design by its values, as in "KEY=0.2, OTHER=rigid".

        Parameters
        ----------
        at : ndarray, (d,)
            See `values_at`.
        """
        return ", ".join(
            f"{key}={value:.6g}" if isinstance(value, float) else f"{key}={value}"
            for key, value in self.values_at(at).items()
        )

    def values_at(self, at: Floats) -> dict[str, Any]:
        """Values of all that varies, by key.

        Parameters
        ----------
        at : ndarray, (d,)
            Place in the ranges, each from 0 to 1.
        """
        ranges = self.asked.request.ranges
        found = {
            key: low + float(t) * (high - low)
            for (key, (low, high)), t in zip(ranges.items(), at, strict=True)
        }
        return {**self.choice, **found}

    def design(self, at: Floats) -> Drivetrain:
        """The design at a place, with the mesh sizes of the drivetrain itself.

        Parameters
        ----------
        at : ndarray, (d,)
            Place in the ranges.

        Raises
        ------
        InputError
            Such a design cannot be built.
        """
        base, values = self.asked.drivetrain, self.values_at(at)
        if isinstance(base, Scene):
            # another mesh of a housing would make a step in what is smooth otherwise: sizes do not
            # count, and the finest are allowed where any are
            built = with_values(base, values, (*reversed(FINER), 1.0))
            return built.model_copy(update={"mesh": base.mesh})
        return changed(base, values, "drivetrain")

    def quantities(self, at: Floats) -> dict[str, Floats] | None:
        """Every quantity of the design at a place; None of one that cannot be built.

        Parameters
        ----------
        at : ndarray, (d,)
            Place in the ranges.
        """
        key = np.round(at, 14).tobytes()
        if key not in self._known:
            self._known[key] = self._computed(at)
            self.made += 1
            if time.monotonic() - self._last > EVERY:
                self.keep()
        row = self._known[key]
        if row is None:
            return None
        ends = np.cumsum(list(self.counts.values()))[:-1]
        return dict(zip(self.counts, np.split(row, ends), strict=True))

    def keep(self) -> None:
        """Keep all that was computed, for a search that is resumed."""
        self._last = time.monotonic()
        if not self._known:
            return
        nothing = np.full(sum(self.counts.values()), np.nan)
        rows = [nothing if row is None else row for row in self._known.values()]
        arrays = {
            "places": np.array([np.frombuffer(key) for key in self._known]),
            "values": np.array(rows),
        }
        user_cache().keep("solutions", self._content, arrays)

    def _computed(self, at: Floats) -> Floats | None:
        try:
            found = self.asked.values(self.design(at), self.model)
        except InputError as error:
            self.fault = error
            return None
        return np.concatenate([found[name] for name in self.counts])

    def _load(self) -> None:
        arrays = user_cache().load("solutions", self._content)
        if arrays is None:
            return
        for place, row in zip(arrays["places"], arrays["values"], strict=True):
            # why a design cannot be built is found again, where that is asked
            if not np.isnan(row).all():
                self._known[np.ascontiguousarray(place).tobytes()] = row
        self.kept = len(self._known)


def _content(asked: DesignQuantities, choice: Mapping[str, Any], model: str) -> dict[str, Any]:
    """All that quantities of a design depend on, as plain data."""
    base, request = asked.drivetrain, asked.request
    files = [] if request.hub_loads is None else recorded_files(request.hub_loads)
    return {
        "designs of": whole_content(base)
        if isinstance(base, Scene)
        else base.model_dump(mode="json"),
        "ranges": {key: list(ends) for key, ends in request.ranges.items()},
        "choice": repr(sorted(choice.items())),
        "quantities": list(asked.names),
        "model": model,
        "load": dict(request.load),
        "files": [history_digest(file) for file in files],
        "prices": dict(request.prices),
        "life": repr(request.life),
        "made by": {"code": program_hash(), **solved_by()},
    }
