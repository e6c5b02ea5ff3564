"""ROSS: all that turns of a drivetrain as a script that builds a rotor of ROSS's own elements.

A rotor for each shaft, of ShaftElement, DiskElement, GearElement and BearingElement, and a
MultiRotor for each stage. ROSS has its shaft along z, y up: its x, y, z are this project's y, z, x,
and its degrees of freedom of a node are x, y, z and rotations about these. A class of the script
adds full matrices where ROSS's elements have fewer terms. ROSS's own coupling of two gears takes
sin(pressure angle) sin(helix) for the axial part of the force of helical teeth, whose cosine is
cos(pressure angle) sin(helix); so a stage's coupling is a matrix of the script.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import Level
from fe_drivetrain.export.formats.statement import comment_lines
from fe_drivetrain.export.programs.ross_rotor import FROM_PROJECT
from fe_drivetrain.export.turning import Turning
from fe_drivetrain.export.turning_files import TURNING_FORMATS
from fe_drivetrain.export.turning_lines import Beam, Coupling, Line, Support, turning_lines

_HEAD = '''\
import numpy as np
import ross
from scipy.linalg import eigh


class Matrices(ross.DiskElement):
    """Full stiffness (6, 6) of a node to ground, which a bearing of ROSS does not have."""

    def __init__(self, n, stiffness, tag):
        super().__init__(n=n, m=0.0, Id=0.0, Ip=0.0, tag=tag)
        self.stiffness = np.array(stiffness)

    def __eq__(self, other):
        return self is other

    def __hash__(self):
        return id(self)

    def K(self):
        return self.stiffness

    def _patch(self, position, fig):
        return fig


class Link(ross.CouplingElement):
    """Full stiffness (12, 12) between two nodes, without mass."""

    def __init__(self, L, stiffness, tag=None, **more):
        super().__init__(m_l=0.0, m_r=0.0, Ip_l=0.0, Ip_r=0.0, L=L, tag=tag, **more)
        self.stiffness = np.array(stiffness)
        # a rotor of ROSS asks for an inner diameter of all elements
        self.i_d = self.idl = self.idr = 0.0

    def __eq__(self, other):
        return self is other

    def __hash__(self):
        return id(self)

    def K(self):
        return self.stiffness


class Planet(ross.DiskElement):
    """A planet or ring, that spins at spin times the speed of the shaft behind it."""

    def __init__(self, spin, **more):
        super().__init__(**more)
        self.spin = spin

    def __eq__(self, other):
        return self is other

    def __hash__(self):
        return id(self)

    def G(self):
        return self.spin * super().G()

    def _patch(self, position, fig):
        return fig


class Stage(ross.MultiRotor):
    """A gear stage from the last node of a rotor to the next one, whose first nodes are planets.

    Its stiffness is stiffness * shape, of six motions each of the driving node, of planets, and of
    the driven node; mass is what these carry beside their own.
    """

    def __init__(self, driving, driven, ratio, planets, stiffness, shape, mass=None):
        self.planets, self.shape = planets, np.array(shape)
        self.carried = None if mass is None else np.array(mass)
        ends = (max(driving.nodes), min(driven.nodes) + planets)
        super().__init__(driving, driven, coupled_nodes=ends, gear_mesh_stiffness=stiffness)
        # ROSS turns the driven rotor by minus this
        self.mesh.gear_ratio = -ratio

    def coupling_matrix(self):
        # of two gears alone, in place of which is the shape
        return np.zeros((12, 12))

    def _add(self, matrix, more):
        first, last = (6 * gear.n for gear in (self.mesh.driving_gear, self.mesh.driven_gear))
        rows = [*range(first, first + 6), *range(last - 6 * self.planets, last + 6)]
        matrix[np.ix_(rows, rows)] += more
        return matrix

    def K(self, frequency):
        return self._add(super().K(frequency), self.mesh.stiffness * self.shape)

    def M(self, frequency=None, synchronous=False):
        found = super().M(frequency, synchronous)
        return found if self.carried is None else self._add(found, self.carried)


def frequencies(rotor):
    """Natural frequencies at standstill, undamped [Hz]; rotor.run_modal(speed) has the others."""
    squares = eigh(rotor.K(0.0), rotor.M(0.0), eigvals_only=True)
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
'''

_MAIN = """\


if __name__ == "__main__":
    print("natural frequencies, undamped [Hz]")
    for frequency in frequencies(build())[:40]:
        print(frequency)
"""


def write(path: Path, turning: Turning) -> None:
    """Write the script; numbers keep every digit.

    Raises
    ------
    InputError
        The level is that of rigid bodies: ROSS's shafts bend.
    """
    level = Level[turning.options["level"].upper()]
    if level is Level.RIGID:
        raise InputError(
            f"{argument('level')} is 'rigid' but the shafts of ROSS bend: take 'flexible', or "
            "'torsional'"
        )
    lines, couplings = turning_lines(turning.machine, level, turning.options["generator"] == "held")
    left_out = TURNING_FORMATS["ross"].left_out
    entries = {**turning.source(), "degrees of freedom": _AXES, "left out": left_out}
    if level is Level.TORSIONAL:
        entries["held"] = "all motions of a node but its turn, since bodies only turn at this level"
    head = "\n".join(comment_lines(entries, "#"))
    parts = [head, "\n\n", _HEAD, _materials(lines)]
    parts += [_line(turning, number, line) for number, line in enumerate(lines)]
    parts += [_build(turning, couplings), _MAIN]
    path.write_text("".join(parts), encoding="utf-8")


_AXES = (
    "x, y, z of ROSS are y, z, x of fe-drivetrain: the shaft along z, y up; then rotations about "
    "these"
)


def _materials(lines: list[Line]) -> str:
    """Materials of the beams of each shaft; one without mass is of density 0."""
    rows = {}
    for line in lines:
        for piece in line.pieces:
            if isinstance(piece, Beam):
                of, name = piece.shaft.material, _material(line)
                rho = of.density if piece.shaft.has_mass else 0.0
                stiffness = {"E": of.youngs_modulus, "G_s": of.shear_modulus}
                rows[name] = _call("ross.Material", name=name, rho=rho, **stiffness)
    if not rows:
        return ""
    text = "".join(f"    {name!r}: {row},\n" for name, row in rows.items())
    return f"\n\nMATERIALS = {{\n{text}}}\n"


def _material(line: Line) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in f"of_{line.name}")


def _call(function: str, /, **values: object) -> str:
    return f"{function}({', '.join(f'{key}={value!r}' for key, value in values.items())})"


def _line(turning: Turning, number: int, line: Line) -> str:
    """A function of the script that builds the rotor of a line."""
    text = [
        "\n\n",
        f"def line_{number + 1}():\n",
        f"    # {line.name}, at {line.speed:.6g} times the speed of the rotor\n",
        "    return ross.Rotor(\n        [\n",
        *(f"            {one},\n" for one in _pieces(line)),
        "        ],\n        [\n",
        *(f"            {one},\n" for one in _discs(turning, number, line)),
        "        ],\n        [\n",
        *(f"            {one},\n" for one in _bearings(line)),
        "        ],\n    )\n",
    ]
    return "".join(text)


def _pieces(line: Line) -> Iterator[str]:
    for number, piece in enumerate(line.pieces, start=1):
        tag = f"{line.name} {number}"
        if isinstance(piece, Beam):
            text = _call(
                "ross.ShaftElement",
                L=piece.length,
                idl=piece.inner,
                odl=piece.outer[0],
                idr=piece.inner,
                odr=piece.outer[1],
                shear_method_calc="cowper",
                tag=tag,
            )
            yield f"{text[:-1]}, material=MATERIALS[{_material(line)!r}])"
        else:
            text = _call("Link", L=piece.length, tag=tag)
            yield f"{text[:-1]}, stiffness={_matrix(_in_ross(piece.stiffness))})"


def _discs(turning: Turning, number: int, line: Line) -> Iterator[str]:
    """Discs, gears and what bearings have beside forces across and along the shaft."""
    last = len(line.bodies) - 1
    for node, body in enumerate(line.bodies):
        found = line.disc(node)
        if found is None:
            continue
        mass, across, polar = found
        values = {"n": node, "m": mass, "Id": across, "Ip": polar, "tag": body.name}
        if node < line.planets:
            yield _call("Planet", spin=body.speed / line.speed, **values)
            continue
        gear = None
        if node == line.planets and number > 0:
            gear = _gear(turning, number, driven=True)
        elif node == last and number < len(turning.machine.stages):
            gear = _gear(turning, number + 1, driven=False)
        element = "ross.DiskElement" if gear is None else "ross.GearElement"
        yield _call(element, **values, **(gear or {}))
    for support in line.supports:
        rest = _in_ross(support.stiffness)
        rest[:3, :3] -= _bearing(rest)
        if rest.any():
            tag = f"{support.name}, moments and coupling"
            yield _call("Matrices", n=support.node, tag=tag)[:-1] + f", stiffness={_rows(rest)})"


def _gear(turning: Turning, number: int, driven: bool) -> dict[str, float]:
    """Teeth and pitch circle of the end of a stage, which ROSS draws, and needs for a MultiRotor.

    A carrier stands as a gear with the teeth of ring and sun, as its ratio to the sun has it.
    """
    stage = turning.machine.stages[number - 1]
    torsional = turning.options["level"] == "torsional"
    ratio, count = stage.speed_ratio, None
    if isinstance(stage, PlanetaryData):
        radius = 1.0 if torsional else stage.sun_radius
        if stage.teeth is not None:
            count = stage.teeth.sun if driven else stage.teeth.ring + stage.teeth.sun
    else:
        radius = 1.0 if torsional else stage.centre_distance - stage.gear_radius
        if stage.teeth is not None:
            count = stage.teeth.pinion if driven else stage.teeth.gear
    radius *= 1.0 if driven else ratio
    return {
        "n_teeth": count or round(1000.0 * radius),
        "pitch_diameter": 2.0 * radius,
        "pr_angle": radians(stage.pressure_angle),
        "helix_angle": radians(stage.helix),
    }


def _bearings(line: Line) -> Iterator[str]:
    """Bearings; one without stiffness where a line has none, since ROSS asks for one."""
    for support in line.supports or (Support(f"{line.name}, no bearing", 0, np.zeros((6, 6))),):
        k = _bearing(_in_ross(support.stiffness))
        values = {"kxx": k[0, 0], "kxy": k[0, 1], "kyx": k[1, 0], "kyy": k[1, 1], "kzz": k[2, 2]}
        own = {key: float(value) for key, value in values.items()}
        yield _call("ross.BearingElement", n=support.node, **own, cxx=0.0, tag=support.name)


def _bearing(k: Floats) -> Floats:
    """(3, 3) what a bearing of ROSS has of a stiffness in ROSS's order."""
    found = np.zeros((3, 3))
    found[:2, :2], found[2, 2] = k[:2, :2], k[2, 2]
    return found


def _in_ross(k: Floats) -> Floats:
    """A matrix (6 k, 6 k) of nodes in ROSS's order."""
    order = np.add.outer(6 * np.arange(len(k) // 6), FROM_PROJECT).ravel()
    return np.array(k[np.ix_(order, order)])


def _matrix(matrix: Floats) -> str:
    """A matrix on short lines, or how to make it where it is zero."""
    return _rows(matrix) if matrix.any() else f"np.zeros({matrix.shape!r})"


def _rows(matrix: Floats) -> str:
    """A matrix as rows of a list."""
    rows = (", ".join(repr(float(value) + 0.0) for value in row) for row in matrix)
    return "[\n" + "".join(f"                [{row}],\n" for row in rows) + "            ]"


def _build(turning: Turning, couplings: list[Coupling]) -> str:
    """The function of the script that joins the rotors of all lines."""
    text = [
        "\n\ndef build():\n",
        '    """The whole: a rotor of ROSS, whose speed is that of the turbine\'s rotor."""\n',
        "    whole = line_1()\n",
    ]
    speeds = turning.machine.speeds
    for one in couplings:
        K, M = _in_ross(one.stiffness), _in_ross(one.mass)
        stiffness = float(np.abs(K).max())
        text += [
            f"    # stage {one.number}\n",
            "    whole = Stage(\n        whole,\n",
            f"        line_{one.number + 1}(),\n",
            f"        ratio={speeds[one.number] / speeds[one.number - 1]!r},\n",
            f"        planets={len(K) // 6 - 2},\n",
            f"        stiffness={stiffness!r},\n",
            f"        shape={_rows(K / stiffness)},\n",
            f"        mass={_rows(M)},\n" if M.any() else "",
            "    )\n",
        ]
    return "".join([*text, "    return whole\n"])
