"""Exudyn: a shaft on its supports as a multibody system, flexible or of rigid bodies and springs.

Three ways in, for a program that solves large motions:

- `flexible_system`: the condensed matrices as they are, an ObjectGenericODE2 on a rigid-body node
  for each point (Tait-Bryan angles, whose small values are rotations about x, y, z) and one generic
  node for the modes of Craig and Bampton, where there are any. Other bodies go to the points'
  markers. The matrices hold for small motions about the place where the shaft stands.
- `floating_system`: an ObjectFFRFreducedOrder with all modes of the condensed matrices; it turns.
- `rigid_bodies_system`: a rigid body for each point, and between neighbours a
  ConnectorRigidBodySpringDamper with the shaft's 6x6 stiffness; that turns, too.

The frame and the units are this project's (SI). Each support is a connector with its 6x6 stiffness
to the ground, what it holds rigidly a JointGeneric (Gerstmayr, Exudyn user documentation, sections
ObjectGenericODE2, ObjectConnectorRigidBodySpringDamper, ObjectJointGeneric).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.scaling import diagonal_roots, max_difference, scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.export.craig_bampton import CraigBampton
from fe_drivetrain.export.lumped_shaft import rigid_mass
from fe_drivetrain.export.modes import with_inertia
from fe_drivetrain.export.superelement import ALLOWED, Superelement

STANDING_STILL = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class System:
    """A multibody system of Exudyn, assembled.

    Attributes
    ----------
    system : Any
        Its MainSystem, ``mbs`` in Exudyn's own documentation: add bodies, sensors, loads.
    container : Any
        Its SystemContainer, which must live as long.
    points : tuple[str, ...]
        Names of the points.
    markers : Mapping[str, int]
        By point: the number of its rigid marker.
    loads : Mapping[str, tuple[Any, Any]]
        By point: the numbers of its force and its torque, zero until they are set.
    supports : Mapping[str, tuple[Any or None, Any or None]]
        By point: numbers of the connector and of the joint to the ground, None where there is none.
    """

    system: Any
    container: Any
    points: tuple[str, ...]
    markers: Mapping[str, int]
    loads: Mapping[str, tuple[Any, Any]]
    supports: Mapping[str, tuple[Any | None, Any | None]]

    def reactions(self, loads: Mapping[str, Floats]) -> dict[str, Floats]:
        """What the shaft puts on its supports (6,) [N, N m] under loads (6,) at points.

        Exudyn's static solver finds the equilibrium with its large rotations; the answer is linear
        only as far as the loads are small.

        Raises
        ------
        InputError
            A load is at no point.
        ArithmeticError
            Exudyn finds no equilibrium.
        """
        exudyn, _ = _exudyn()
        for name in loads:
            if name not in self.points:
                raise InputError(
                    f"load at {name!r} is at none of the points {', '.join(self.points)}"
                )
        for name in self.points:
            both = np.asarray(loads.get(name, np.zeros(6)), dtype=float)
            for number, half in zip(self.loads[name], (both[:3], both[3:]), strict=True):
                self.system.SetLoadParameter(number, "loadVector", half.tolist())
        settings = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.show.statistics = False
        settings.staticSolver.verboseMode = 0
        try:
            self.system.SolveStatic(settings, showCausingItems=False)
        except (ValueError, RuntimeError) as error:
            raise ArithmeticError(f"Exudyn finds no equilibrium: {error}") from error
        output = exudyn.OutputVariableType
        found = {}
        for name, numbers in self.supports.items():
            found[name] = np.zeros(6)
            for number in numbers:
                if number is not None:
                    found[name] += np.concatenate(
                        [
                            self.system.GetObjectOutput(number, output.ForceLocal),
                            self.system.GetObjectOutput(number, output.TorqueLocal),
                        ]
                    )
        return found

    def reaction_matrix(self, point: str, size: float = 1e4) -> dict[str, Floats]:
        """(6, 6) by support: what the shaft puts on it per unit of each load at a point.

        Parameters
        ----------
        point : str
            Where the load is.
        size : float
            Size of the loads that it is measured with, both ways, so that what a load does by
            turning the shaft cancels to its third power [N, N m]. A small one drowns: bodies stand
            at metres, which leaves their springs 1e-16 m.
        """
        matrices = {name: np.zeros((6, 6)) for name in self.supports}
        for component in range(6):
            load = np.zeros(6)
            load[component] = size
            forth, back = self.reactions({point: load}), self.reactions({point: -load})
            for name, matrix in matrices.items():
                matrix[:, component] = (forth[name] - back[name]) / (2.0 * size)
        return matrices

    def place(self, point: str) -> Floats:
        """Position of a point (3,) [m] under the loads of the last `reactions`."""
        exudyn, _ = _exudyn()
        found = self.system.GetMarkerOutput(self.markers[point], exudyn.OutputVariableType.Position)
        return np.asarray(found)

    def frequencies(self) -> Floats:
        """Natural frequencies about the equilibrium position of the shaft, ascending [Hz]."""
        exudyn, _ = _exudyn()
        settings = exudyn.SimulationSettings()
        # What it has no derivative of, it takes by differences: steps of 1e-8 m, ten times its own,
        # leave both what is of second order and the round-off of stiff springs small.
        settings.staticSolver.newton.numericalDifferentiation.relativeEpsilon = 1e-6
        values, _ = self.system.ComputeODE2Eigenvalues(simulationSettings=settings)
        return np.asarray(np.sort(np.sqrt(np.abs(values))) / (2.0 * np.pi))


def flexible_system(
    body: Superelement | CraigBampton,
    supports: Mapping[str, Floats],
    gravity: Sequence[float] = STANDING_STILL,
    inertia: Mapping[str, Floats] | None = None,
) -> System:
    """A condensed shaft as a flexible body on its supports.

    Parameters
    ----------
    body : Superelement or CraigBampton
        Free, with its mass.
    supports : Mapping[str, Floats]
        (6, 6) stiffness to ground by point [N/m, N, N m/rad]; inf on the diagonal holds that motion
        rigidly, and nothing else is in its row.
    gravity : Sequence[float]
        (3,) of the shaft, not of its supports [m/s^2].
    inertia : Mapping[str, Floats] or None
        (6, 6) mass of supports by point [kg, kg m, kg m^2], as
        `fe_drivetrain.shafts.fidelity.unit_matrices` gives it; they have none where it is not
        given.

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    InputError
        The body is supported already or has no mass, or a support or its mass is at no point.
    """
    _, items = _exudyn()
    K, M = _matrices(body)
    system, container = _empty()
    nodes = [
        system.AddNode(items.NodeRigidBodyRxyz(name=name, referenceCoordinates=[*place, 0, 0, 0]))
        for name, place in zip(body.points, np.asarray(body.positions).tolist(), strict=True)
    ]
    numbers = list(nodes)
    modes = len(K) - 6 * len(nodes)
    if modes:
        still = [0.0] * modes
        numbers.append(
            system.AddNode(
                items.NodeGenericODE2(
                    referenceCoordinates=still,
                    initialCoordinates=still,
                    initialCoordinates_t=still,
                    numberOfODE2Coordinates=modes,
                )
            )
        )
    falling = np.zeros(len(K))
    falling[: 6 * len(nodes)] = np.tile([*gravity, 0.0, 0.0, 0.0], len(nodes))
    system.AddObject(
        items.ObjectGenericODE2(
            name=getattr(body, "name", "shaft"),
            nodeNumbers=numbers,
            massMatrix=with_inertia(body.points, M, inertia or {}),
            stiffnessMatrix=K,
            forceVector=M @ falling,
        )
    )
    markers = [system.AddMarker(items.MarkerNodeRigid(nodeNumber=node)) for node in nodes]
    return _assembled(system, container, body.points, body.positions, markers, supports)


def floating_system(
    body: Superelement,
    supports: Mapping[str, Floats],
    gravity: Sequence[float] = STANDING_STILL,
) -> System:
    """A condensed shaft as a flexible body that may turn and travel as far as it likes.

    An ObjectFFRFreducedOrder: a floating frame, and all free modes of the condensed matrices in it.
    Exudyn knows such bodies by nodes that have displacements only; so each point is six of them,
    a little way off along each axis, that move rigidly with it.

    Parameters
    ----------
    body, supports, gravity : Superelement, Mapping[str, Floats], Sequence[float]
        The same as for `flexible_system`; modes of Craig and Bampton have no motion of any point
        that could carry their momentum, and are not taken.

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    InputError
        The body is supported already or has no mass, or a support is at no point.
    """
    exudyn, items = _exudyn()
    fem = import_module("exudyn.FEM")
    K, M = _matrices(body)
    n = len(body.points)
    arm = 0.05 * float(np.ptp(body.positions, axis=0).max())
    offsets = arm * np.vstack([np.eye(3), -np.eye(3)])
    carry = np.vstack([wrench_transport(offset).T[:3] for offset in offsets])
    spread = np.kron(np.eye(n), carry)
    gathered = np.kron(np.eye(n), np.linalg.pinv(carry))
    size = diagonal_roots(M.diagonal())
    _, modes = linalg.eigh(scaled_to_unit_diagonal(K, M.diagonal()), scaled_to_unit_diagonal(M))
    mesh = fem.FEMinterface()
    mesh.nodes = {"Position": (body.positions[:, None] + offsets).reshape(-1, 3)}
    mesh.massMatrix = sparse.csr_matrix(gathered.T @ M @ gathered)
    mesh.stiffnessMatrix = sparse.csr_matrix(gathered.T @ K @ gathered)
    # the six rigid motions are the frame's
    basis = spread @ (modes[:, 6:] / size[:, None])
    mesh.modeBasis = {"matrix": basis, "type": "NormalModes"}
    system, container = _empty()
    reduced = fem.ObjectFFRFreducedOrderInterface(
        mesh, rigidBodyNodeType=exudyn.NodeType.RotationRxyz
    )
    # it takes the centre of mass from a stretch of the mesh, which is right of lumped masses only;
    # a rotation knows better
    whole = spread @ point_motions(body.positions)
    about = whole.T @ mesh.massMatrix @ whole
    reduced.chiU = np.array([about[5, 1], about[3, 2], about[4, 0]]) / about[0, 0]
    number = reduced.AddObjectFFRFreducedOrder(system, gravity=list(gravity), name=body.name)
    markers = [
        system.AddMarker(
            items.MarkerSuperElementRigid(
                bodyNumber=number["oFFRFreducedOrder"],
                meshNodeNumbers=np.arange(6 * k, 6 * k + 6),
                weightingFactors=np.full(6, 1.0 / 6.0),
            )
        )
        for k in range(n)
    ]
    return _assembled(system, container, body.points, body.positions, markers, supports)


def rigid_bodies_system(
    body: Superelement,
    supports: Mapping[str, Floats],
    gravity: Sequence[float] = STANDING_STILL,
) -> System:
    """A shaft as rigid bodies at its points with 6x6 connectors between neighbours.

    Parameters
    ----------
    body : Superelement
        Free, its stiffness a chain along x and its mass of rigid bodies at its points, as
        `fe_drivetrain.export.lumped_shaft.lumped_superelement` gives it.
    supports, gravity : Mapping[str, Floats], Sequence[float]
        The same as for `flexible_system`.

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    InputError
        The body is none of these: `flexible_system` takes it.
    """
    exudyn, items = _exudyn()
    utilities = import_module("exudyn.utilities")
    springs = chain_of(body)
    inertias = bodies_of(body)
    system, container = _empty()
    bodies = [
        system.CreateRigidBody(
            name=name,
            referencePosition=place,
            inertia=utilities.RigidBodyInertia(
                mass=mass, inertiaTensor=inertia, com=centre, inertiaTensorAtCOM=False
            ),
            nodeType=exudyn.NodeType.RotationRxyz,
            gravity=list(gravity),
        )
        for (name, place), (mass, centre, inertia) in zip(
            zip(body.points, body.positions.tolist(), strict=True), inertias, strict=True
        )
    ]
    markers = [system.AddMarker(items.MarkerBodyRigid(bodyNumber=number)) for number in bodies]
    for i, j, k in springs:
        arm = body.positions[j] - body.positions[i]
        carried = system.AddMarker(
            items.MarkerBodyRigid(bodyNumber=bodies[i], localPosition=arm.tolist())
        )
        system.AddObject(
            items.ObjectConnectorRigidBodySpringDamper(
                name=f"{body.points[i]} to {body.points[j]}",
                markerNumbers=[carried, markers[j]],
                stiffness=k,
            )
        )
    return _assembled(system, container, body.points, body.positions, markers, supports)


def exudyn_version() -> str:
    """The version of Exudyn that is installed.

    Raises
    ------
    MissingToolError
        None is.
    """
    return str(_exudyn()[0].__version__)


def chain_of(body: Superelement) -> list[tuple[int, int, Floats]]:
    """Springs between neighbours along x that make a stiffness.

    Returns
    -------
    Of each the numbers i and j of its points, and (6, 6) by the motion of j against what it would
    have if it stood rigidly on i.

    Raises
    ------
    InputError
        The stiffness is no such chain.
    """
    order = np.argsort(body.positions[:, 0])
    rebuilt = np.zeros_like(body.stiffness)
    springs = []
    for i, j in zip(order[:-1].tolist(), order[1:].tolist(), strict=True):
        carry = wrench_transport(body.positions[j] - body.positions[i])
        block = body.stiffness[6 * j : 6 * j + 6, 6 * i : 6 * i + 6]
        # a force at j is balanced at i: K_ji = -k T^T
        k = -np.linalg.solve(carry, block.T).T
        k = 0.5 * (k + k.T)
        relative = np.zeros((6, len(rebuilt)))
        relative[:, 6 * j : 6 * j + 6] = np.eye(6)
        relative[:, 6 * i : 6 * i + 6] = -carry.T
        rebuilt += relative.T @ k @ relative
        springs.append((i, j, k))
    size = np.sqrt(np.outer(body.stiffness.diagonal(), body.stiffness.diagonal()))
    apart = float(np.abs((rebuilt - body.stiffness)[size > 0] / size[size > 0]).max())
    if apart > ALLOWED:
        raise InputError(
            f"superelement {body.name!r} is no chain of springs between neighbouring points, off "
            f"by {apart:.1g} of its diagonal: take the flexible body, or level 1"
        )
    return springs


def bodies_of(body: Superelement) -> list[tuple[float, Floats, Floats]]:
    """Mass [kg], centre (3,) [m] and inertia (3, 3) [kg m^2] about its point, of each point's body.

    Raises
    ------
    InputError
        The mass is missing, or not that of a rigid body at each point.
    """
    if body.mass is None:
        raise InputError(f"superelement {body.name!r} has no mass: take one that has")
    found = []
    rebuilt = np.zeros_like(body.mass)
    for first in range(0, len(body.mass), 6):
        rows = slice(first, first + 6)
        block = body.mass[rows, rows]
        mass = float(np.trace(block[:3, :3]) / 3.0)
        if mass <= 0.0:
            raise InputError(
                f"superelement {body.name!r} has a point without mass: rigid bodies need some"
            )
        centre = np.array([block[5, 1], block[3, 2], block[4, 0]]) / mass
        rebuilt[rows, rows] = rigid_mass(mass, centre, block[3:, 3:])
        found.append((mass, centre, block[3:, 3:]))
    apart = max_difference(rebuilt, body.mass)
    if apart > ALLOWED:
        raise InputError(
            f"superelement {body.name!r} has the mass of an elastic body, not of rigid ones at its "
            f"points, by {apart:.1g} of its diagonal: take the flexible body"
        )
    return found


def _matrices(body: Superelement | CraigBampton) -> tuple[Floats, Floats]:
    if isinstance(body, Superelement):
        if body.supported:
            raise InputError(
                f"superelement {body.name!r} has its supports in it: give the free one, and these"
            )
        if body.mass is None:
            raise InputError(
                f"superelement {body.name!r} has no mass: take level 2 or 3 of the shaft"
            )
        return body.stiffness, body.mass
    return body.stiffness, body.mass


def _assembled(
    system: Any,
    container: Any,
    points: tuple[str, ...],
    positions: Floats,
    markers: Sequence[Any],
    supports: Mapping[str, Floats],
) -> System:
    """Add the supports and a load of each point, and assemble."""
    _, items = _exudyn()
    ground = system.AddObject(items.ObjectGround())
    held: dict[str, tuple[Any | None, Any | None]] = {}
    for name, stiffness in supports.items():
        if name not in points:
            raise InputError(f"support {name!r} is at none of the points {', '.join(points)}")
        k = np.array(stiffness, dtype=float)
        at = points.index(name)
        rigid = np.isinf(k.diagonal())
        base = system.AddMarker(
            items.MarkerBodyRigid(bodyNumber=ground, localPosition=positions[at].tolist())
        )
        both = [base, markers[at]]
        k[np.isinf(k)] = 0.0
        spring = joint = None
        if k.any():
            spring = system.AddObject(
                items.ObjectConnectorRigidBodySpringDamper(
                    name=f"{name} to ground", markerNumbers=both, stiffness=k
                )
            )
        if rigid.any():
            joint = system.AddObject(
                items.ObjectJointGeneric(
                    name=f"{name} held", markerNumbers=both, constrainedAxes=rigid.astype(int)
                )
            )
        held[name] = (spring, joint)
    loads = {
        name: (
            system.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0])),
            system.AddLoad(items.LoadTorqueVector(markerNumber=marker, loadVector=[0, 0, 0])),
        )
        for name, marker in zip(points, markers, strict=True)
    }
    system.Assemble()
    return System(system, container, points, dict(zip(points, markers, strict=True)), loads, held)


def _empty() -> tuple[Any, Any]:
    exudyn, _ = _exudyn()
    container = exudyn.SystemContainer()
    return container.AddSystem(), container


def _exudyn() -> tuple[Any, Any]:
    """Exudyn and its items."""
    try:
        return import_module("exudyn"), import_module("exudyn.itemInterface")
    except ImportError as error:
        raise MissingToolError(
            'Exudyn is not installed: pip install "fe-drivetrain[exudyn]"'
        ) from error
