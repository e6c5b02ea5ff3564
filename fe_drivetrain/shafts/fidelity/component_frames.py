"""Components as frames: arms, rings, webs and pins as beams, all else rigid."""

from __future__ import annotations

import math

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.component import CarrierComponent, HousingComponent, material_of
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.beam.frame import (
    Follower,
    Member,
    SpatialFrame,
    annular_sector,
    on_node,
    rectangle,
    round_section,
    sector_centroid,
)

#: Beams along an arm or a pin, an even number, and round half the ring: what is lumped, or straight
#: where it should be curved, is then right to a thousandth.
PIECES, HALF_RING = 8, 48

X = np.array([1.0, 0.0, 0.0])


class _Builder:
    """Collects the nodes and members of a frame."""

    def __init__(self) -> None:
        self.positions: list[Floats] = []
        self.members: list[Member] = []
        self.inertias: dict[int, Floats] = {}

    def node(self, *position: float) -> int:
        self.positions.append(np.array(position))
        return len(self.positions) - 1

    def body(self, node: int, mass: float) -> None:
        """Add to the mass of a node [kg]."""
        own = np.diag([mass, mass, mass, 0.0, 0.0, 0.0])
        self.inertias[node] = self.inertias.get(node, np.zeros((6, 6))) + own

    def frame(self, component: HousingComponent | CarrierComponent) -> SpatialFrame:
        return SpatialFrame(
            np.array(self.positions), self.members, material_of(component), self.inertias
        )


def housing_frame(component: HousingComponent, ring_gives: bool) -> Condensed:
    """A gearbox housing with its arms as beams, from the ring's outside to the eyes' axes.

    Parameters
    ----------
    component : HousingComponent
        The component.
    ring_gives : bool
        Whether the ring is a ring of beams, too, rigid only where the arms meet it; else it is
        rigid altogether.
    """
    housing, density = component.gearbox_housing, material_of(component).density
    nu = material_of(component).poisson_ratio
    inner, outer = housing.inner_diameter / 2, housing.outer_diameter / 2
    builder = _Builder()
    x, y, z = housing.eye
    arm = rectangle(housing.arm_width, housing.arm_height, nu)
    if ring_gives:
        roots, ring = _ring_of_beams(component, builder)
    else:
        rigid = builder.node(0.0, 0.0, 0.0)
        builder.body(rigid, density * math.pi * (outer**2 - inner**2) * housing.length)
        roots, ring = (rigid, rigid), on_node("ring", rigid, np.zeros(3))
    points = [ring]
    for name, side, root in zip(("left", "right"), (1.0, -1.0), roots, strict=True):
        stations = np.linspace(housing.arm_root, y, PIECES + 1)
        nodes = [root, *(builder.node(x, side * at, z) for at in stations[1:])]
        for k in range(PIECES):
            ends = tuple(np.array([x, side * at, z]) for at in stations[k : k + 2])
            builder.members.append(Member((nodes[k], nodes[k + 1]), (ends[0], ends[1]), arm, X))
        builder.body(nodes[-1], density * housing.arm_width * housing.eye_beyond_arm)
        points.append(on_node(name, nodes[-1], np.array([x, side * y, z])))
    return builder.frame(component).condensed(points)


def _ring_of_beams(
    component: HousingComponent, builder: _Builder
) -> tuple[tuple[int, int], Follower]:
    """The ring's nodes and beams; the nodes that the arms stand on, and the bore's mean motion."""
    housing = component.gearbox_housing
    inner, outer = housing.inner_diameter / 2, housing.outer_diameter / 2
    mean = (inner + outer) / 2
    section = rectangle(housing.length, outer - inner, material_of(component).poisson_ratio)
    up = math.asin(housing.arm_z / outer)  # from y towards z
    half = math.asin(housing.arm_height / 2 / outer)

    def at(angle: float, radius: float) -> Floats:
        return np.array([0.0, radius * math.cos(angle), radius * math.sin(angle)])

    left, right = (builder.node(*at(angle, mean)) for angle in (up, math.pi - up))
    places: list[Floats] = []
    owners: list[int] = []
    weights: list[float] = []

    def bore(angle: float, node: int, arc: float) -> None:
        # two places along x have the second moment of the whole length
        for side in (-1.0, 1.0):
            places.append(at(angle, inner) + side * housing.length / math.sqrt(12.0) * X)
            owners.append(node)
            weights.append(arc)

    for start, end, first, last in (
        (up + half, math.pi - up - half, left, right),
        (math.pi - up + half, 2 * math.pi + up - half, right, left),
    ):
        angles = np.linspace(start, end, HALF_RING + 1)
        nodes = [first, *(builder.node(*at(a, mean)) for a in angles[1:-1]), last]
        step = float(angles[1] - angles[0])
        for k in range(HALF_RING):
            ends = at(angles[k], mean), at(angles[k + 1], mean)
            builder.members.append(Member((nodes[k], nodes[k + 1]), ends, section, X))
        for angle, node, share in zip(
            angles, nodes, [0.5, *[1.0] * (HALF_RING - 1), 0.5], strict=True
        ):
            bore(float(angle), node, share * step)
    arc = 2 * half / PIECES
    density = material_of(component).density
    for node, middle in ((left, up), (right, math.pi - up)):
        builder.body(node, density * section.area * mean * 2 * half)
        for k in range(PIECES):
            bore(middle - half + (k + 0.5) * arc, node, arc)
    ring = Follower("ring", np.zeros(3), owners, np.array(places), np.array(weights))
    return (left, right), ring


def carrier_frame(component: CarrierComponent) -> Condensed:
    """A planet carrier with hub, webs and pins as beams between rigid cheeks."""
    carrier, material = component.planet_carrier, material_of(component)
    nu, density = material.poisson_ratio, material.density
    builder = _Builder()
    front = carrier.hub_length
    near = front + carrier.cheek_thickness
    far = near + carrier.gap

    def cheek(middle: float, bore: float) -> int:
        node = builder.node(middle, 0.0, 0.0)
        area = math.pi / 4 * (carrier.cheek_diameter**2 - bore**2)
        builder.body(node, density * area * carrier.cheek_thickness)
        return node

    hub = builder.node(0.0, 0.0, 0.0)
    first = cheek(front + carrier.cheek_thickness / 2, carrier.hub_bore_diameter)
    tube = round_section(carrier.hub_diameter, nu, carrier.hub_bore_diameter)
    builder.members.append(Member((hub, first), (0.0 * X, front * X), tube, np.eye(3)[2]))
    last = None
    if carrier.walls == 2:
        last = cheek(far + carrier.cheek_thickness / 2, carrier.sun_bore_diameter)
        inner, outer = carrier.web_inner_diameter / 2, carrier.web_outer_diameter / 2
        angle = math.radians(carrier.web_angle)
        web = annular_sector(inner, outer, angle, nu)
        radius = sector_centroid(inner, outer, angle)
        for k in range(carrier.planets):
            turn = 2 * math.pi * (k + 0.5) / carrier.planets
            radial = np.array([0.0, -math.sin(turn), math.cos(turn)])
            ends = near * X + radius * radial, far * X + radius * radial
            builder.members.append(Member((first, last), ends, web, radial))
    points = [on_node("hub", hub, np.zeros(3))]
    pin = round_section(carrier.pin_diameter, nu)
    stations = np.linspace(near, far, PIECES + 1)
    simpson = np.array([1.0, *[4.0, 2.0] * (PIECES // 2 - 1), 4.0, 1.0])
    for name, centre in zip(component.loaded, carrier.pin_centres(), strict=True):
        axis = np.array([0.0, *centre[1:]])
        places = [at * X + axis for at in stations]
        between = [builder.node(*place) for place in places[1:-1]]
        end = builder.node(*places[-1]) if last is None else last
        nodes = [first, *between, end]
        for k in range(PIECES):
            ends = places[k], places[k + 1]
            builder.members.append(Member((nodes[k], nodes[k + 1]), ends, pin, axis))
        round_it = carrier.pin_diameter / 2 * np.vstack([np.eye(3)[1:], -np.eye(3)[1:]])
        points.append(
            Follower(
                name,
                np.array(centre),
                np.repeat(nodes, 4).tolist(),
                np.vstack([place + round_it for place in places]),
                np.repeat(simpson, 4),
            )
        )
    return builder.frame(component).condensed(points)
