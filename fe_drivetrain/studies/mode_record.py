"""What is known of the modes of a drivetrain, as findings, charts and page read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics import Answer, Level
from fe_drivetrain.procedure import BearingDefects, Excitation, Meeting
from fe_drivetrain.studies.mode_speeds import Campbell

TORSIONAL = "torsional"


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Modes:
    """Natural modes of a drivetrain at one level, and how they stand to its excitations.

    Attributes
    ----------
    level : Level
        Level of the model.
    frequencies : Floats
        Frequencies (n,) at rest, ascending, free motions left out [Hz].
    bands : Floats
        Half widths (n,) of their numerical uncertainty [Hz]; NaN where it is not known.
    kinds : tuple[str, ...]
        Direction (n,) of most of the kinetic energy: "torsional", "axial", "lateral", "mixed".
    words : tuple[str, ...]
        What each mode (n,) is.
    kinetic, strain : Mapping[str, Floats]
        Share (n,) of each part in the kinetic and in the strain energy; each 1 in sum.
    shapes : Mapping[str, Floats]
        Motions (6, k) of each body in the first k modes, of unit modal mass [m, rad].
    speeds : tuple[float, float] or None
        Least and largest speed of the rotor in operation [rad/s]; None where none is known.
    speed : float or None
        Speed of the rotor of `running` [rad/s]; None where none is known.
    running : Floats
        Frequencies (n,) at that speed [Hz], NaN of a mode that does not oscillate; those at rest
        where there is no speed.
    damping : Floats
        Damping ratios (n,) there; 0 where no damping is given.
    campbell : Campbell or None
        Frequencies over the speed; None without one.
    excitations : tuple[Excitation, ...]
        All that may excite in operation.
    meetings : tuple[Meeting, ...]
        Every excitation against every mode; empty where no speeds are known.
    bearing_defects : tuple[BearingDefects, ...]
        Defect frequencies of bearings with a catalogue entry.
    defects : tuple[Excitation, ...]
        What defects of these bearings would excite.
    defect_meetings : tuple[Meeting, ...]
        Each of them against every mode; empty where no speeds are known.
    ladder : tuple[Answer, ...]
        Frequencies of modes of the finest level at each level, from the simplest.
    enough : Mapping[str, str]
        Simplest level that is within the tolerance, for each of these modes.
    tolerance : float
        Relative error that a simpler level may have.
    """

    level: Level
    frequencies: Floats = field(repr=False)
    bands: Floats = field(repr=False)
    kinds: tuple[str, ...]
    words: tuple[str, ...]
    kinetic: Mapping[str, Floats] = field(repr=False)
    strain: Mapping[str, Floats] = field(repr=False)
    shapes: Mapping[str, Floats] = field(repr=False)
    speeds: tuple[float, float] | None
    speed: float | None
    running: Floats = field(repr=False)
    damping: Floats = field(repr=False)
    campbell: Campbell | None = field(repr=False)
    excitations: tuple[Excitation, ...] = field(repr=False)
    meetings: tuple[Meeting, ...] = field(repr=False)
    bearing_defects: tuple[BearingDefects, ...] = field(repr=False)
    defects: tuple[Excitation, ...] = field(repr=False)
    defect_meetings: tuple[Meeting, ...] = field(repr=False)
    ladder: tuple[Answer, ...] = field(repr=False)
    enough: Mapping[str, str]
    tolerance: float

    @property
    def torsional(self) -> int | None:
        """Place of the first torsional mode among the frequencies; None where there is none."""
        return self.kinds.index(TORSIONAL) if TORSIONAL in self.kinds else None

    @property
    def resonances(self) -> list[Meeting]:
        """Crossings in operation whose excitation acts where the mode moves, strongest first."""
        met = [one for one in self.meetings if one.verdict == "resonance"]
        return sorted(met, key=lambda one: -one.share)
