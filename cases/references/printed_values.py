"""How a printed number stands beside ours, where inputs count that its source does not print."""

from typing import Literal

Stands = Literal["holds", "does not hold", "not testable"]

NEAR = 0.05
"""A printed ratio holds where ours is within so much of it."""


def holds(ok: bool) -> Stands:
    """Verdict of a statement that can be tested.

    Parameters
    ----------
    ok : bool
        Whether it holds.
    """
    return "holds" if ok else "does not hold"


def against(ours: float, printed: float, span: tuple[float, float], near: float = NEAR) -> Stands:
    """Verdict of a printed number.

    Parameters
    ----------
    ours, printed : float
        Both numbers.
    span : tuple of float
        Least and largest number of ours by changed guesses: one within it cannot be tested.
    near : float
        It holds where ours is within so much of it, relative.
    """
    if abs(ours / printed - 1.0) <= near:
        return "holds"
    return "not testable" if span[0] <= printed <= span[1] else "does not hold"
