"""Bearings whose inside is published, each with a catalogue's page of the same designation."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, degrees, pi, radians

from fe_drivetrain.bearing import CataloguePage

SKF = "SKF general catalogue (1,129 pages), as text in a public repository"
PARTS = "parts library bd_warehouse 0.4.0, which has pages of SKF"
MASTA = "MASTA in a public study of a 26 MW drivetrain"


@dataclass(frozen=True)
class Published:
    """A bearing with its page and its inside.

    Attributes
    ----------
    name : str
        Designation.
    page : CataloguePage
        What a catalogue prints.
    elements : int
        Rolling elements of one row.
    diameter, pitch : float
        Diameter of an element, and of the circle of their middles [m].
    length : float
        Effective length of a roller [m]; of C0 (ISO 76) where nobody states it, 0 of balls.
    angle : float
        Contact angle [deg].
    source : str
        Where the inside comes from.
    """

    name: str
    page: CataloguePage
    elements: int
    diameter: float
    pitch: float
    length: float
    angle: float
    source: str

    @property
    def fields(self) -> dict[str, float]:
        """The inside by the names of `FittedRollers`."""
        found = {"elements": float(self.elements), "diameter": self.diameter, "pitch": self.pitch}
        return found | ({"length": self.length} if self.length else {})


def _published(
    name: str,
    ratings: tuple[float, float, float],
    inside: tuple[int, float, float],
    source: str,
    *,
    of: str = SKF,
    angle: float = 0.0,
    length: float | None = None,
    **more: float | str,
) -> Published:
    """Ratings C, C0 and Cu [N]; number, diameter and pitch diameter [mm]."""
    C, C0, Cu = ratings
    page = CataloguePage.read(
        {"designation": name, "C": C, "C0": C0, "Cu": Cu, "source": of, **more}, name
    )
    number, diameter, pitch = inside
    if page.of_kind == "ball":
        length = 0.0
    elif length is None:
        cosine = cos(radians(angle))
        gamma = diameter * cosine / pitch
        length = C0 / (44.0 * (1.0 - gamma) * page.row_count * number * diameter * cosine)
    sizes = 1e-3 * diameter, 1e-3 * pitch, 1e-3 * length
    return Published(name, page, number, *sizes, angle, source)


#: C0 of the tapered bearing is that of ISO 76 by its inside: MASTA's C_u follows from it to 1e-7.
_OF_26_MW = 92228718.0

#: Number, diameter over pitch diameter and angle of FAG 22205-E1 follow from its printed orders of
#: faults: cage 0.4123, outer race 6.1852, rolling element 5.4030 / 2.
_CAGE, _OUTER, _ELEMENT = 0.4123, 6.1852, 0.5 * 5.4030
_ACROSS = 1.0 - 2.0 * _CAGE
_OVER = (1.0 - _ACROSS**2) / (2.0 * _ELEMENT)
_OF_FAULTS = "Schaeffler, orders of faults in Sensors 2020, 20, 3493, Table 1"

PUBLISHED = (
    _published(
        "tapered, 26 MW",
        (22227978.9, _OF_26_MW, 3929016.7),
        (87, 110.51, 3330.9),
        MASTA,
        of=MASTA,
        angle=19.0,
        length=238.048,
        kind="single_row_tapered",
        d=3.055,
        D=3.6,
        T=0.31,
        e=0.5165,
        Y=1.1617,
    ),
    _published(
        "30204 J2",
        (27500.0, 28000.0, 3000.0),
        (15, 6.20, 35.8),
        "data set UOS, Table 2, as bearing-datasets 0.3.0 quotes it",
        of=PARTS,
        angle=12.6,
        e=0.35,
        Y=1.7,
        Y0=0.9,
    ),
    _published(
        "NU 205 ECP",
        (32500.0, 27000.0, 3350.0),
        (13, 7.5, 38.5),
        "Hou et al., Table 5, and raceways of FAG NU 2205-E, as bearing-datasets 0.3.0 quotes them",
        of=PARTS,
    ),
    _published(
        "NJ 204 ECP",
        (28500.0, 22000.0, 2750.0),
        (11, 7.5, 34.0),
        "data set UOS, Table 2, as bearing-datasets 0.3.0 quotes it",
        of=PARTS,
    ),
    _published(
        "22205 E",
        (49000.0, 44000.0, 4750.0),
        (round(_OUTER / _CAGE), _OVER * 38.5, 38.5),
        f"{_OF_FAULTS}; pitch circle in the middle of bore and outside diameter",
        of="SKF, from memory",
        angle=degrees(atan((_OVER**2 - _ACROSS**2) ** 0.5 / _ACROSS)),
        e=0.35,
        Y1=1.9,
        Y2=2.9,
        Y0=1.8,
    ),
    _published(
        "6305",
        (23400.0, 11600.0, 490.0),
        (7, 11.5, 43.5),
        "public implementation of ISO/TS 16281 with MASTA's results",
        f0=12.0,
    ),
    _published(
        "6205",
        (14800.0, 7800.0, 335.0),
        (9, 7.90, 38.5),
        "Jung et al. 2023, Table 1 (NSK 6205), as bearing-datasets 0.3.0 quotes it",
        f0=14.0,
    ),
    _published(
        "6203",
        (9950.0, 4750.0, 200.0),
        (8, 6.75, 28.55),
        "Paderborn's fact sheets of 6203, as bearing-datasets 0.3.0 quotes them",
        f0=13.0,
    ),
    _published(
        "6204",
        (13500.0, 6550.0, 280.0),
        (8, 7.94, 34.57),
        "data set UOS, Table 2, as bearing-datasets 0.3.0 quotes it",
        f0=13.0,
    ),
    _published(
        "6206",
        (20300.0, 11200.0, 480.0),
        (9, 9.525, 46.0),
        "studies of SKF 6206, as bearing-datasets 0.3.0 quotes them",
        f0=14.0,
    ),
    _published(
        "61806",
        (4490.0, 2900.0, 146.0),
        (19, 3.18, 35.5),
        "data set of Paderborn, Table 1 (61806-2RS), as bearing-datasets 0.3.0 quotes it",
        f0=14.0,
    ),
)

#: Cylindrical bearings of which the same catalogue prints both raceways: designation, C, C0 and Cu
#: [kN], raceway of the inner ring of NU and NJ, and of the outer ring of N [mm].
RACEWAYS = (
    ("NU 318 ECP", 365, 360, 43, 113.5, 169.5),
    ("NU 219 ECP", 255, 265, 32.5, 112.5, 154.5),
    ("NU 319 ECP", 390, 390, 46.5, 121.5, 177.5),
    ("NU 220 ECP", 285, 305, 36.5, 119, 163),
    ("NU 2220 ECP", 380, 450, 54, 119, 163),
    ("NU 320 ECP", 450, 440, 51, 127.5, 191.5),
    ("NU 221 ECP", 300, 315, 36.5, 125, 173),
    ("NU 321 ECP", 500, 500, 57, 133, 201),
    ("NU 222 ECP", 335, 365, 42.5, 132.5, 180.5),
    ("NU 322 ECP", 530, 540, 61, 143, 211),
    ("NU 224 ECP", 390, 430, 49, 143.5, 195.5),
    ("NU 324 ECP", 610, 620, 69.5, 154, 230),
)

#: The roller bearing of minzhun/ISO16281's test, named N305 there: six rollers of 9 mm would fill
#: 39 % of the pitch circle, so it is that program's own, and no bearing of a catalogue.
UNUSUAL = {"designation": "N 305", "C": 31500.0, "C0": 25600.0}
UNUSUAL_FILL = 6 * 9.0 / (pi * 43.5)


def raceway_pages() -> list[tuple[CataloguePage, float, float]]:
    """Pages with diameter of the rollers and of their pitch circle by both raceways [m]."""
    found = []
    for name, C, C0, Cu, F, E in RACEWAYS:
        data = {"designation": name, "C": 1e3 * C, "C0": 1e3 * C0, "Cu": 1e3 * Cu, "source": SKF}
        found.append((CataloguePage.read(data, name), 5e-4 * (E - F), 5e-4 * (E + F)))
    return found
