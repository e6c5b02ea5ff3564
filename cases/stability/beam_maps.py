"""Shafts by beam theory and by Fourier harmonics in the meridian, and maps of their difference.

Every shaft here is held at its front end; a flexibility is the motion of the rear end for a force
or moment there, so that entry 0 is along x, 2 along z, 3 about x and 4 about y.
"""

from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from fe_drivetrain.beam import BeamSection, element_integrals, transport
from fe_drivetrain.common import Floats
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import rounded, trace
from fe_drivetrain.revolution import end_stiffness
from fe_drivetrain.scene import MATERIALS

STEEL = MATERIALS["steel"]

LEVELS = (1.0, 5.0, 10.0)
"""Errors [%] that maps show."""

_LINES = {1.0: "solid", 5.0: "dash", 10.0: "dot"}

AXIAL, DEFLECTION, TORSION, ROTATION = 0, 2, 3, 4


def uniform(length: float, bore: float = 0.0, outer: float = 1.0) -> Shaft:
    """A cylinder from x = 0; lengths [m]."""
    return Shaft(
        front=0.0,
        sections=(Section(length=length, outer_diameter=outer, inner_diameter=bore),),
    )


def stepped(
    lengths: tuple[float, float], outers: tuple[float, float], fillet: float = 0.0
) -> Shaft:
    """Two solid cylinders from x = 0; lengths [m]."""
    return Shaft(
        front=0.0,
        sections=tuple(
            Section(length=length, outer_diameter=outer, fillet=radius)
            for length, outer, radius in zip(lengths, outers, (fillet, 0.0), strict=True)
        ),
    )


def by_elements(shaft: Shaft, size: float, order: int | None = None, layers: int = 3) -> Floats:
    """Flexibility (6, 6) between rigid end faces from the meridian; size of elements [m]."""
    K = end_stiffness(shaft, STEEL, size, order=order, layers=layers)
    return np.asarray(np.linalg.inv(K[6:, 6:]))


def by_beam(shaft: Shaft, shear: bool = True) -> Floats:
    """The same of Timoshenko's beam with Cowper's coefficient, or of Euler and Bernoulli's."""
    total = np.zeros((6, 6))
    for piece, end in zip(shaft.pieces, shaft.stations[1:], strict=True):
        section = BeamSection(piece.length, piece.outer_diameter, piece.inner_diameter)
        own = element_integrals(section, STEEL, shear, 0.0, piece.length).flexibility
        carried = transport(np.array(shaft.rear - end))
        total += carried.T @ own @ carried
    return total


def least_safe(x: Floats, error: Floats, level: float) -> float | None:
    """Least x from which on an error is below a level, to the end of the sweep.

    Parameters
    ----------
    x : (n,) array
        Ascending.
    error : (n,) array
        With its sign, which does not count.
    level : float
        In the unit of the error.

    Returns
    -------
    least : float or None
        Between points by straight lines in logarithms; the first x where the error is below the
        level everywhere, None where it is not even at the last.
    """
    size = np.abs(error)
    above = np.flatnonzero(size >= level)
    if not len(above):
        return float(x[0])
    k = int(above[-1])
    if k == len(x) - 1:
        return None
    share = np.log(size[k] / level) / np.log(size[k] / size[k + 1])
    return float(np.exp(np.log(x[k]) + share * np.log(x[k + 1] / x[k])))


def curve(
    name: str,
    x: Floats,
    percent: Floats,
    dash: str = "solid",
    width: float = 2.0,
    signed: bool = False,
) -> Any:
    """Black curve of an error [%], without its sign unless that is asked for."""
    line = {"color": "black", "dash": dash, "width": width}
    shown = percent if signed else np.abs(percent)
    return trace(name, x, shown, mode="lines+markers", line=line)


def map_traces(x: Floats, y: Floats, percent: Floats, falls_as: float = 1.0) -> list[Any]:
    """Lines of equal error over x (logarithmic) and y, and dots where it was computed.

    Parameters
    ----------
    x, y : (n,) and (m,) array
        Ascending.
    percent : (m, n) array
        Error [%], with its sign.
    falls_as : float
        The power of x with which it falls: times x to this power it is interpolated by splines.

    Returns
    -------
    traces : list
        For a chart.
    """
    fine_x, fine_y = np.geomspace(x[0], x[-1], 41), np.linspace(y[0], y[-1], 31)
    spline = RectBivariateSpline(
        y, np.log(x), percent * x**falls_as, kx=min(3, len(y) - 1), ky=min(3, len(x) - 1)
    )
    fine = np.abs(spline(fine_y, np.log(fine_x)) / fine_x**falls_as)
    lines = [
        {
            "type": "contour",
            "name": f"{level:g} %",
            "x": rounded(fine_x, 5),
            "y": rounded(fine_y, 5),
            "z": [rounded(row, 4) for row in fine],
            "autocontour": False,
            "contours": {
                "start": level,
                "end": level,
                "size": level,
                "coloring": "none",
                "showlabels": True,
                "labelfont": {"size": 15, "color": "black"},
                "labelformat": ".0f",
            },
            "line": {"color": "black", "width": 2, "dash": _LINES[level]},
            "showscale": False,
            "showlegend": True,
            "hovertemplate": "%{x:.3g}, %{y:.3g}: %{z:.3g} %<extra></extra>",
        }
        for level in LEVELS
    ]
    X, Y = np.meshgrid(x, y)
    dots = trace("computed", X.ravel(), Y.ravel(), True, marker={"size": 3, "color": "#777777"})
    return [*lines, dots]
