"""Shafts of a drivetrain as rotors: each with its bodies, its bearings and its gear meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.drivetrain_file.turning_parts import BearingData
from fe_drivetrain.drivetrain_file.whirl_data import WhirlData
from fe_drivetrain.dynamics import Body, Level, Machine, System
from fe_drivetrain.dynamics.whirl.modes import synchronous
from fe_drivetrain.dynamics.whirl.rotor import (
    Bearing,
    Disc,
    Element,
    Joint,
    Rotor,
    Theory,
    bearing_of,
    refined,
    rotor_of,
)
from fe_drivetrain.dynamics.whirl.unbalance import Unbalance, balance_moment
from fe_drivetrain.export.turning_lines import Beam, Coupling, Line, Link, turning_lines
from fe_drivetrain.shafts.beam.frame import round_section
from fe_drivetrain.studies.whirl_record import EXCITED
from fe_drivetrain.studies.whirl_rollers import RollerTables

SLICES = 4
"""Uniform elements of a tapered piece."""
MESH = "meshes of {}"
"""Name of what the gears of a stage hold a shaft with."""
MOST = 0.5
"""Least share of a shaft's bodies in the kinetic energy of a critical that is its own."""
_PLANE = (1, 5, 7, 11)  # w and dw/dx of both ends of a link, in the first plane


@dataclass(frozen=True)
class ShaftRotor:
    """A shaft of a drivetrain, ready to be made a rotor.

    Attributes
    ----------
    name : str
        Name of the shaft.
    ratio : float
        Speed over the rotor's, above 0.
    pieces : tuple of Element or Joint
        From front to rear.
    discs : tuple of Disc
        Its bodies.
    bodies : tuple of str
        Names of the bodies at its nodes.
    bearings : tuple of Bearing
        Bearings, and gear meshes against bodies that stand still.
    whirl : WhirlData
        Damping and unbalance.
    mirrored : bool
        Whether it turns from z to y.
    """

    name: str
    ratio: float
    pieces: tuple[Element | Joint, ...]
    discs: tuple[Disc, ...]
    bodies: tuple[str, ...]
    bearings: tuple[Bearing, ...]
    whirl: WhirlData
    mirrored: bool = False

    __repr__ = short_repr

    def rotor(
        self, parts: int = 1, theory: Theory = "timoshenko", without: frozenset[str] = frozenset()
    ) -> Rotor:
        """The rotor of so many parts for each element, without some of the bearings.

        Parameters
        ----------
        parts : int
            Parts of each element.
        theory : str
            "euler", "rayleigh" or "timoshenko".
        without : frozenset of str
            Names of bearings that are left out.
        """
        fine, nodes = refined(self.pieces, parts)
        return rotor_of(
            self.name,
            fine,
            [Disc(nodes[d.node], d.mass, d.polar, d.transverse) for d in self.discs],
            [
                Bearing(b.name, nodes[b.node], b.speeds, b.stiffness, b.damping)
                for b in self.bearings
                if b.name not in without
            ],
            theory=theory,
            viscous=self.whirl.viscous,
            loss_factor=self.whirl.loss_factor,
        )

    @property
    def meshes(self) -> frozenset[str]:
        """Names of the gear meshes among its bearings."""
        return frozenset(b.name for b in self.bearings if b.name.startswith(MESH.format("")))

    @property
    def mass(self) -> float:
        """Mass of the shaft and of its bodies [kg]."""
        own = [
            one.length * one.section.area * one.material.density
            for one in self.pieces
            if isinstance(one, Element)
        ]
        return sum(own) + sum(disc.mass for disc in self.discs)

    def unbalances(self, highest: float, parts: int) -> list[Unbalance]:
        """Unbalances as stated; by the balance grade at the heaviest body otherwise.

        Parameters
        ----------
        highest : float
            Highest speed of the shaft in operation [rad/s].
        parts : int
            Parts of each element of the rotor.
        """
        fine, nodes = refined(self.pieces, parts)
        at = np.concatenate([[0.0], np.cumsum([one.length for one in fine])])
        rows = [row for row in self.whirl.unbalance if row.shaft == self.name]
        if rows:
            return [
                Unbalance(int(np.abs(at - r.at).argmin()), r.moment, float(np.radians(r.angle)))
                for r in rows
            ]
        heaviest = max(self.discs, key=lambda disc: disc.mass, default=None)
        node = len(at) // 2 if heaviest is None else nodes[heaviest.node]
        grade = self.whirl.balance_grade / 1e3
        return [Unbalance(node, balance_moment(grade, self.mass, highest))]


def shaft_rotors(
    machine: Machine, whirl: WhirlData | None, rollers: RollerTables | None = None
) -> list[ShaftRotor]:
    """The shafts of a machine that bend or tilt, as rotors.

    A shaft has the bodies at its ends, a carrier with the masses of its planets. Bodies of the next
    shafts stand still, planets follow: they hold a shaft by the meshes of its gears.

    Parameters
    ----------
    machine : Machine
        The machine.
    whirl : WhirlData or None
        Damping, unbalance, and bearings over the speed, where the file states them.
    rollers : RollerTables or None
        Stiffness of bearings by their rollers, of those that the file has none over the speed of.
    """
    own = whirl or WhirlData()
    lines, couplings = turning_lines(machine, Level.FLEXIBLE)
    found = []
    for k, line in enumerate(lines):
        before = couplings[k - 1] if k else None
        behind = couplings[k] if k < len(couplings) else None
        planets = _planets(lines, k)
        if machine.shafts[k].kind == "coupling":
            # a coupling carries torque alone: each of its ends whirls by itself
            front, rear = _end(line, line.planets), _end(line, len(line.bodies) - 1)
            pairs = [(front, (before, None), ()), (rear, (None, behind), planets)]
        else:
            pairs = [(line, (before, behind), planets)]
        for part, of, carried in pairs:
            if _turns_on_bearings(part):
                found.append(_shaft(machine, part, of, carried, (own, rollers)))
    return found


def _end(line: Line, node: int) -> Line:
    """A body of a line by itself."""
    body = line.bodies[node]
    supports = tuple(replace(one, node=0) for one in line.supports if one.node == node)
    name = f"{line.name}, {body.name}"
    return Line(name, line.speed, 0, (body,), (), supports)


def _turns_on_bearings(line: Line) -> bool:
    """Whether something of a line has a mass that is not fixed across."""
    return any(body.mass and {"uy", "uz"} <= body.free for body in line.bodies) or any(
        isinstance(piece, Beam) and piece.shaft.has_mass for piece in line.pieces
    )


def critical_in_drivetrain(system: System, shaft: ShaftRotor, limit: float) -> float | None:
    """First critical of a shaft by its unbalance, in the whole drivetrain [rad/s].

    The first one in which the shaft's bodies have half of the kinetic energy or more, as they move
    across, and whirl forward. None where there is none.

    Parameters
    ----------
    system : System
        The whole drivetrain, held, with speeds over the rotor's.
    shaft : ShaftRotor
        The shaft.
    limit : float
        Highest speed of the shaft [rad/s].
    """
    speeds, shapes = synchronous(system.mass, system.gyroscopic, system.K, shaft.ratio)
    below = speeds * shaft.ratio <= limit
    speeds, shapes = speeds[below], shapes[:, below]
    energy = (shapes.conj() * (system.mass @ shapes)).real
    pairs = [(f"{name} uy", f"{name} uz") for name in shaft.bodies]
    kept = [pair for pair in pairs if pair[0] in system.names and pair[1] in system.names]
    own = {f"{name} {m}" for name in shaft.bodies for m in ("uy", "uz", "ry", "rz")}
    mine = np.array([name in own for name in system.names])
    first, second = (np.array([system.names.index(pair[k]) for pair in kept]) for k in (0, 1))
    for k in np.flatnonzero(energy[mine].sum(axis=0) >= MOST * energy.sum(axis=0)):
        mass = np.sqrt(system.mass.diagonal()[first])
        a, b = mass * shapes[first, k], mass * shapes[second, k] * (-1 if shaft.mirrored else 1)
        forward, backward = (float((np.abs(w) ** 2).sum()) for w in (a + 1j * b, a - 1j * b))
        if forward >= EXCITED * (forward + backward):
            return float(speeds[k] * shaft.ratio)
    return None


def _planets(lines: Sequence[Line], k: int) -> Sequence[Body]:
    """Bodies of planets that the rear end of a line carries: they are in front of the next line."""
    if k + 1 >= len(lines):
        return ()
    following = lines[k + 1]
    return [body for body in following.bodies[: following.planets] if " planet " in body.name]


def _shaft(
    machine: Machine,
    line: Line,
    couplings: tuple[Coupling | None, Coupling | None],
    planets: Sequence[Body],
    stated_of: tuple[WhirlData, RollerTables | None],
) -> ShaftRotor:
    whirl, rollers = stated_of
    first = line.planets
    bodies, pieces = line.bodies[first:], line.pieces[first:]
    parts: list[Element | Joint] = []
    nodes = [0]
    for piece in pieces:
        parts += _elements(piece)
        nodes.append(len(parts))
    discs = [
        Disc(node, body.mass, body.polar, body.transverse)
        for node, body in zip(nodes, bodies, strict=True)
        if body.mass or body.polar or body.transverse
    ]
    rear = bodies[-1]
    for planet in planets:
        arm = float(np.hypot(*np.subtract(planet.position, rear.position)[1:]))
        about = planet.mass * arm**2
        discs.append(Disc(nodes[-1], planet.mass, about, planet.transverse + about / 2))
    mirrored = line.speed < 0
    bearings = []
    named = {one.name: one for one in machine.bearings}
    for support in line.supports:
        at = support.node - first
        if at < 0 or support.name == "grid":
            continue
        stated = named.get(support.name)
        if stated is None:
            bearings.append(bearing_of(support.name, nodes[at], support.stiffness, None, (0.0,)))
            continue
        place = _place(machine, line, stated) - bodies[at].position[0]
        W = wrench_transport(along_x(place))
        speeds, K, C = over_speed(stated.name, whirl, rollers, abs(line.speed))
        own = support.stiffness if K is None else W @ K @ W.T
        bearings.append(bearing_of(stated.name, nodes[at], own, W @ C @ W.T, speeds, mirrored))
    for coupling, node, end in zip(couplings, (nodes[0], nodes[-1]), (-1, 0), strict=True):
        if coupling is not None:
            K = _of_end(coupling, end)
            name = MESH.format(f"stage {coupling.number}")
            bearings.append(bearing_of(name, node, K, mirrored=mirrored))
    return ShaftRotor(
        line.name,
        abs(line.speed),
        tuple(parts),
        tuple(discs),
        tuple(body.name for body in bodies),
        tuple(bearings),
        whirl,
        mirrored,
    )


def _elements(piece: Beam | Link) -> list[Element | Joint]:
    """A piece of a line as elements; a taper in slices of its mean diameter."""
    if isinstance(piece, Link):
        at = np.array(_PLANE)
        return [Joint(piece.length, piece.stiffness[np.ix_(at, at)])]
    material = piece.shaft.material
    if not piece.shaft.has_mass:
        material = material.model_copy(update={"density": 0.0})
    count = 1 if piece.outer[0] == piece.outer[1] else SLICES
    edges = np.linspace(*piece.outer, count + 1).tolist()
    nu = material.poisson_ratio
    return [
        Element(piece.length / count, round_section((one + two) / 2, nu, piece.inner), material)
        for one, two in pairwise(edges)
    ]


def _place(machine: Machine, line: Line, bearing: BearingData) -> float:
    """Middle of a bearing along x [m]."""
    if bearing.holds not in {body.name for body in line.bodies}:
        k = [shaft.name for shaft in machine.shafts].index(bearing.holds)
        return machine.axes[k][0] + bearing.at
    centres: Mapping[str, float] = {body.name: body.position[0] for body in line.bodies}
    return centres[bearing.holds] + bearing.at


def over_speed(
    name: str, whirl: WhirlData, rollers: RollerTables | None, ratio: float
) -> tuple[Sequence[float], Floats | None, Floats]:
    """Stiffness of a bearing over the speed, where it is stated or that of its rollers.

    Parameters
    ----------
    name : str
        Name of the bearing.
    whirl : WhirlData
        What the file states, which comes first.
    rollers : RollerTables or None
        Stiffness of rollers over the rotor's speed.
    ratio : float
        Speed of the bearing's shaft over the rotor's.

    Returns
    -------
    speeds : sequence of float
        Speeds (k,) of the shaft [rad/s].
    stiffness : ndarray (k, 6, 6) or None
        Stiffness there [N/m, N, N m/rad]; None where it is that of its row.
    damping : ndarray, (6, 6)
        Damping [N s/m, N m s/rad].
    """
    stated = whirl.of_bearing(name)
    damping = np.zeros((6, 6)) if stated is None else np.diag(stated.damping)
    if stated is not None and stated.over_speed:
        own = np.array([np.diag(one.stiffness) for one in stated.over_speed])
        return [one.speed for one in stated.over_speed], own, damping
    if rollers is not None and name in rollers.stiffness:
        return (ratio * rollers.speeds).tolist(), rollers.stiffness[name], damping
    return (0.0,), None, damping


def _of_end(coupling: Coupling, end: int) -> Floats:
    """(6, 6) of one end of a stage, the other end and turning held, planets following."""
    K = coupling.stiffness
    own = np.arange(6) + (0 if end == 0 else len(K) - 6)
    between = np.arange(6, len(K) - 6)
    found = K[np.ix_(own, own)]
    if between.size:
        inner = K[np.ix_(between, between)]
        held = np.linalg.lstsq(inner, K[np.ix_(between, own)], rcond=None)[0]
        found = found - K[np.ix_(own, between)] @ held
    return np.asarray((found + found.T) / 2)
