"""For how long load steps are beyond the limits of rating lives, and their extremes."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True, eq=False)
class Limits:
    """Seconds that the methods' limits were passed, and the extremes.

    Attributes
    ----------
    standing, thin, thick, heavy, weak, lost : float
        Time [s]: below the speed of standing; with kappa below 0.1, and above 4; with P above C/2;
        with P_0 above C_0; without equilibrium.
    reversals : float
        How often the direction of rotation changed, within each chunk of steps.
    largest_load, largest_static, largest_roller : float
        Of P, P_0 and one rolling element [N].
    """

    standing: float = 0.0
    thin: float = 0.0
    thick: float = 0.0
    heavy: float = 0.0
    weak: float = 0.0
    lost: float = 0.0
    reversals: float = 0.0
    largest_load: float = 0.0
    largest_static: float = 0.0
    largest_roller: float = 0.0

    def __add__(self, other: Limits) -> Limits:
        """Times add up, extremes stay."""
        values = {}
        for field in fields(self):
            mine, its = getattr(self, field.name), getattr(other, field.name)
            values[field.name] = max(mine, its) if field.name.startswith("largest") else mine + its
        return Limits(**values)
