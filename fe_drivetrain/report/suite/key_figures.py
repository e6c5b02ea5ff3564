"""Key figures of an answer, made of checks and values of a case, or of limits that are given."""

from __future__ import annotations

from typing import TypedDict, Unpack

from fe_drivetrain.report.answer import Bound, KeyFigure, status_of
from fe_drivetrain.report.results import Figure, Verdict

_PREFIXES = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "m": 1e-3, "µ": 1e-6}


class KeyLimit(TypedDict, total=False):
    """What is asked of a key figure.

    Attributes
    ----------
    at_most, at_least : float
        A bound, in the unit of the value.
    between : tuple of float
        Both ends of a range.
    beside : float
        Another's value, to compare with.
    by : str
        Whose limit it is.
    printed : str
        The limit as its source prints it.
    """

    at_most: float
    at_least: float
    between: tuple[float, float]
    beside: float
    by: str
    printed: str


def key_figure(
    found: Figure | Verdict, name: str = "", by: str = "", printed: str = ""
) -> KeyFigure:
    """The key figure that a check or a value is.

    Parameters
    ----------
    found : Figure or Verdict
        The value.
    name : str
        In the words of the reader; its quantity where left out.
    by, printed : str
        See `KeyFigure`.

    Returns
    -------
    KeyFigure
        Good or bad as the check is; "watch" where a bound lies within its band.
    """
    plain = KeyFigure(
        name=name or found.quantity,
        value=found.computed,
        unit=found.unit,
        band=found.band,
        status="none",
        quantity=found.quantity,
    )
    if isinstance(found, Figure):
        return plain
    bound: Bound = "equals" if found.check == "vanishes" else found.check
    allowed = found.tolerance * (abs(found.reference) if found.relative else 1.0)
    return plain.model_copy(
        update={
            "bound": bound,
            "limit": found.reference,
            "upper": found.upper,
            "allowed": allowed,
            "printed": printed,
            "by": by,
            "status": status_of(
                found.computed, bound, found.reference, found.upper, found.band, allowed
            ),
        }
    )


def in_unit(figure: KeyFigure, unit: str) -> KeyFigure:
    """A key figure in a unit that people use: GN/m in place of N/m, % in place of a share.

    Parameters
    ----------
    figure : KeyFigure
        In any unit.
    unit : str
        That of the figure with another prefix, or "%" of a pure number.

    Returns
    -------
    KeyFigure
        With value, band and limits converted.

    Raises
    ------
    ValueError
        The units differ by more than a prefix.
    """
    shares = {"": 1.0, "-": 1.0, "%": 0.01}
    if figure.unit in shares and unit in shares:
        factor = shares[figure.unit] / shares[unit]
    else:
        old, new = _sizes(figure.unit), _sizes(unit)
        if not old.keys() & new.keys():
            raise ValueError(f"{figure.name}: {figure.unit!r} cannot be shown in {unit!r}")
        base = min(old.keys() & new.keys())
        factor = old[base] / new[base]

    def of(value: float | None) -> float | None:
        return None if value is None else value * factor

    return figure.model_copy(
        update={
            "value": figure.value * factor,
            "unit": unit,
            "band": of(figure.band),
            "limit": of(figure.limit),
            "upper": of(figure.upper),
            "allowed": figure.allowed * factor,
        }
    )


def _sizes(unit: str) -> dict[str, float]:
    """What a unit is without a prefix, and the size of that prefix: N of kN is 1000, kN of kN 1."""
    return {
        unit.removeprefix(prefix): size
        for prefix, size in _PREFIXES.items()
        if unit.startswith(prefix) and unit != prefix
    }


def limited(
    name: str, unit: str, value: float, band: float | None = None, **limit: Unpack[KeyLimit]
) -> KeyFigure:
    """A key figure with the limit that is given.

    Parameters
    ----------
    name, unit : str
        What it is.
    value, band : float
        In that unit.
    **limit : object
        See `KeyLimit`.

    Returns
    -------
    KeyFigure

    Raises
    ------
    ValueError
        Two limits are given.
    """
    bounds: dict[str, Bound] = {
        "at_most": "at most",
        "at_least": "at least",
        "between": "between",
        "beside": "beside",
    }
    given = [key for key in bounds if key in limit]
    if len(given) > 1:
        raise ValueError(f"{name}: give one of {', '.join(given)}")
    bound: Bound = bounds[given[0]] if given else ""
    ends: float | tuple[float, float] | None = limit.get(given[0]) if given else None  # type: ignore[assignment]
    low, high = ends if isinstance(ends, tuple) else (ends, None)
    return KeyFigure(
        name=name,
        value=float(value),
        unit=unit,
        band=None if band is None else float(band),
        bound=bound,
        limit=None if low is None else float(low),
        upper=None if high is None else float(high),
        by=limit.get("by", ""),
        printed=limit.get("printed", ""),
        status=status_of(float(value), bound, low, high, band),
    )
