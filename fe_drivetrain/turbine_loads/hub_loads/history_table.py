"""Tables of histories: titles with units, and those columns that are wanted, of any kind of file.

A kind of file gives its cells as text (`CellTable`), or its columns as numbers (`ArrayTable`).
Units may stand in the titles, as "Fx [kN]", "Fx in kN" or "Fx / kN", or in a row below.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from array import array
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.csv_cells import cell_as_given
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.turbine_loads.hub_loads.channels import is_unit, without_unit
from fe_drivetrain.turbine_loads.hub_loads.number_forms import AmbiguousError, NumberForm
from fe_drivetrain.turbine_loads.hub_loads.stamps import EXAMPLE, TimeColumn, is_stamp, unclear_date

_EXAMPLE = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"
_LOGGER = "TOA5"  # the line of a logger of Campbell Scientific before its titles
_UNIT_BEHIND = re.compile(r"(.+?)\s+(?:in|/)\s+(\S+(?: m)?)")


class Columns(NamedTuple):
    """Columns of a table.

    Attributes
    ----------
    values : mapping of int to ndarray, (n,)
        By place.
    rows : sequence of int, (n,), or None
        Line of each sample in a file of text, or row in a sheet.
    words : str
        How times were read, where they are date-times: in seconds then; else empty.
    """

    values: Mapping[int, Floats]
    rows: Sequence[int] | None
    words: str


class HistoryTable(ABC):
    """A file with named columns.

    Attributes
    ----------
    file : Path
        The file.
    kind : str
        What it is, for messages.
    titles : list of str
        Titles of all columns, with units as far as the file has them, as in "Fx [kN]".
    facts : dict
        What the file states of itself.
    advice : str
        What to do where a file of this kind lacks a column, as the end of a sentence.
    frame_known : bool
        Whether columns called Fx to Mz are hub loads in the shaft's frame; those of programs whose
        axes depend on the model are so where a mapping says it.
    """

    advice = ""
    frame_known = True

    def __init__(self, file: Path, kind: str) -> None:
        self.file, self.kind = file, kind
        self.titles: list[str] = []
        self.facts: dict[str, str] = {}

    @abstractmethod
    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Columns that are wanted.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Places of those that may be date-times.

        Raises
        ------
        InputError
            A cell is no number.
        """

    def cannot(self, why: str) -> InputError:
        """The sentence about a fault of the file.

        Parameters
        ----------
        why : str
            The fault, and what to do.
        """
        return InputError(f"{self.kind} '{self.file}': {why}")


class ArrayTable(HistoryTable):
    """A file whose columns are numbers, of one length.

    Parameters
    ----------
    file : Path
        The file.
    kind : str
        What it is, for messages.
    columns : mapping
        Numbers, or date-times of numpy, (n,) by title.
    facts : mapping, optional
        What the file states of itself.
    """

    def __init__(
        self,
        file: Path,
        kind: str,
        columns: Mapping[str, NDArray[np.generic]],
        facts: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(file, kind)
        self.titles = [bracketed(title) for title in columns]
        self._columns = list(columns.values())
        self.facts = dict(facts or {})

    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Columns that are wanted.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Places of those that may be date-times.

        Raises
        ------
        InputError
            A column has no numbers.
        """
        values: dict[int, Floats] = {}
        words = ""
        for place in wanted:
            column = self._columns[place]
            if column.dtype.kind == "M" and place in times and column.size:
                ticks = column.astype("datetime64[ns]")
                values[place] = (ticks - ticks[0]) / np.timedelta64(1, "s")
                words = f"time from date-times, 0 s at {ticks[0]}"
                continue
            if column.dtype.kind not in "buif":
                raise self.cannot(
                    f"column {shown(without_unit(self.titles[place]))} has no numbers: write "
                    "numbers, or leave it out"
                )
            values[place] = np.asarray(column, dtype=float)
        return Columns(values, None, words)


class CellTable(HistoryTable):
    """A file of rows of cells as text, the first of which has the titles.

    Attributes
    ----------
    row : str
        What a row is called, for messages.
    """

    row = "line"

    def __init__(self, file: Path, kind: str) -> None:
        super().__init__(file, kind)
        first = list(islice(self.cells(), 4))
        if len(first) > 1 and first[0][1][0] == _LOGGER:
            del first[0]
        if not first:
            raise self.cannot(f"empty; begin with the header '{_EXAMPLE}'")
        self.header, titles = first[0][0], [cell_as_given(title) for title in first[0][1]]
        if len(first) > 1 and _are_units(titles, first[1][1]):
            self.header, units = first[1][0], first[1][1]
            pairs = zip(titles, [*units, *[""] * len(titles)], strict=False)
            titles = [_titled(title, unit.strip(" []()")) for title, unit in pairs]
            if len(first) > 2 and not any(_is_value(cell.strip()) for cell in first[2][1]):
                self.header = first[2][0]  # how samples were made, as in Avg
        self.titles = [bracketed(title) for title in titles]

    @abstractmethod
    def cells(self) -> Iterator[tuple[int, list[str]]]:
        """Number of each row and its cells; those that are empty or comments are left out."""

    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Columns that are wanted, of cells of whatever form.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Places of those that may be date-times.

        Raises
        ------
        InputError
            A cell is no number.
        """
        form = NumberForm()
        for _, cells in self._samples():
            for place in wanted:
                if place < len(cells):
                    form.learn("" if place in times and is_stamp(cells[place]) else cells[place])
        if form.open:  # one column alone, each with three decimals: its neighbours may know
            for _, cells in self._samples():
                for cell in cells:
                    if not is_stamp(cell):
                        form.learn_of_other(cell)
                if not form.open:
                    break
        columns = {place: array("d") for place in wanted}
        read = {place: TimeColumn(form) if place in times else form for place in wanted}
        rows = array("q")
        for number, cells in self._samples():
            self._require_places(number, cells)
            rows.append(number)
            for place, values in columns.items():
                text = cells[place].strip() if place < len(cells) else ""
                try:
                    values.append(read[place](text))
                except ValueError as error:
                    raise self._bad_cell(number, place, text, error, form, times) from error
        words = "; ".join(
            filter(None, (one.words for one in read.values() if isinstance(one, TimeColumn)))
        )
        return Columns({k: np.array(one) for k, one in columns.items()}, rows, words)

    def _samples(self) -> Iterator[tuple[int, list[str]]]:
        return ((number, cells) for number, cells in self.cells() if number > self.header)

    def _require_places(self, number: int, cells: Sequence[str]) -> None:
        """Refuse a row that is longer than the header, whose numbers may stand in other columns."""
        count = len(self.titles)
        if len(cells) > count and any(cell.strip() for cell in cells[count:]):
            raise self.cannot(
                f"{self.row} {number} has {len(cells)} values for {count} columns, as decimal "
                "commas make: write decimals with a point, or columns with semicolons or tabs "
                "between, and one value for each column"
            )

    def _bad_cell(
        self,
        number: int,
        place: int,
        text: str,
        error: ValueError,
        form: NumberForm,
        times: Collection[int],
    ) -> InputError:
        """The sentence about a cell that is not what its column holds."""
        name = without_unit(self.titles[place])
        where = f"{self.row} {number}, column {name}: {shown(text)}"
        if not text:
            return self.cannot(f"{where} is not a number: fill the cell, or remove the {self.row}")
        if isinstance(error, AmbiguousError):
            point = text.replace(",", ".")
            whole = re.sub("[.,]", "", text)
            return self.cannot(
                f"{where} may be {point} or {whole}: write decimals with a point, and nothing "
                "between thousands"
            )
        if re.fullmatch(r"[-+]?[\d.]*,\d*(e[-+]?\d+)?", text, re.IGNORECASE):
            return self.cannot(
                f"{where} has a decimal comma, where others have a point: write all decimals with "
                "a point"
            )
        if re.fullmatch(r"[-+]?\d*\.\d*(e[-+]?\d+)?", text, re.IGNORECASE) and form.decimal == ",":
            return self.cannot(
                f"{where} has a decimal point, where others have a comma: write all decimals with "
                "a point"
            )
        if place in times:
            unclear = unclear_date(text)
            return self.cannot(
                f"{where} {unclear or 'is neither a number nor a date-time'}, like {EXAMPLE}, or "
                "not in the form of the first one: write all times in one form"
            )
        return self.cannot(f"{where} is not a number: correct it, or remove the {self.row}")


def bracketed(title: str) -> str:
    """A title with its unit in brackets, where it has one behind the name.

    Parameters
    ----------
    title : str
        As the file has it: "Fx [kN]", "Fx in kN", "Fx / kN", or without a unit.
    """
    match = _UNIT_BEHIND.fullmatch(title.strip()) if "[" not in title and "(" not in title else None
    if match is not None and is_unit(match[2]):
        return f"{match[1]} [{match[2]}]"
    return title


def _titled(title: str, unit: str) -> str:
    return f"{title} [{unit}]" if unit else title


def _are_units(titles: Sequence[str], cells: Sequence[str]) -> bool:
    """Whether a row below titles has their units: titles have none, and no cell is a number."""
    there = [cell.strip() for cell in cells if cell.strip()]
    has_none = not any(re.search(r"[\[(].*[\])]\s*$", bracketed(title)) for title in titles)
    return has_none and bool(there) and not any(_is_value(cell) for cell in there)


def _is_value(cell: str) -> bool:
    return bool(re.match(r"[-+.,]?\d", cell)) or cell.lower() in ("nan", "inf", "-inf", "-nan")
