"""Responses to unit loads: solved once, then any load history is one matrix product."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.spatial import resultant, wrench_transport
from fe_drivetrain.drivetrain_file.entrance import AT_HUB, Entrance
from fe_drivetrain.elasticity.interfaces.constraints import dofs
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.solve.solvers import Diagnostics
from fe_drivetrain.plots.figures import load_bars
from fe_drivetrain.shafts.response.conditions import stood_on
from fe_drivetrain.shafts.response.entering import Loads, entering
from fe_drivetrain.shafts.response.model import LOADS, Model
from fe_drivetrain.shafts.response.part_forces import part_forces
from fe_drivetrain.shafts.response.prepared import Prepared, prepared


@dataclass(frozen=True)
class Response:
    """What the n unit loads of a scene do (`model.scene_loads`), one load a column.

    Six components are Fx, Fy, Fz [N], Mx, My, Mz [N m], or displacements [m] and rotations [rad].

    Attributes
    ----------
    reactions : Mapping[str, Floats]
        (6, n) by name: what the drivetrain puts on its surroundings or on the next part.
        "NAME" (housing base, or nose, moments about the bearing's centre) for each bearing,
        "gearbox" (springs and torque reaction), and, of bearing units, the interfaces "NAME.seat"
        (shaft on bearing) and "NAME.outer" (bearing on housing).
    positions : Mapping[str, Floats]
        (3,) by the same names: the point that the moments are about [m]; and "hub" and the load
        points.
    motions : Mapping[str, Floats]
        (6, n) by reference point: "hub", "gearbox", "NAME.seat", and the load points.
    strain_energy : Mapping[str, Floats]
        (n, n) by part: U = w^T E w / 2 for the load factors w [J].
    displacements : Floats
        (n_nodes, 3, n) [m].
    equilibrium_error : float
        Largest imbalance of loads and reactions over all unit loads, relative to the load.
    superposition_error : float
        Difference between the reactions to a random load, solved directly, and the superposed
        ones, relative to the largest reaction.
    diagnostics : Diagnostics
        Diagnostics of the solve.
    kept : bool
        Whether it was taken from the cache instead of solved.
    entrance : Entrance
        Where loads enter the scene.
    """

    reactions: Mapping[str, Floats]
    positions: Mapping[str, Floats]
    motions: Mapping[str, Floats]
    strain_energy: Mapping[str, Floats]
    displacements: Floats
    equilibrium_error: float
    superposition_error: float
    diagnostics: Diagnostics
    kept: bool = False
    entrance: Entrance = AT_HUB

    def __repr__(self) -> str:
        """One line: the loads, the reactions on the surroundings, and the errors."""
        names = ", ".join(name for name in self.reactions if "." not in name)
        return (
            f"<Response to {self.displacements.shape[-1]} unit loads: reactions of {names}; errors "
            f"of equilibrium {self.equilibrium_error:.1g}, of superposition "
            f"{self.superposition_error:.1g}>"
        )

    def reaction_matrix(self) -> tuple[list[str], Floats]:
        """All reactions as one matrix.

        Returns
        -------
        labels, matrix
            "NAME Fx" to "NAME Mz" for each reaction, and (n_labels, n).
        """
        labels = [f"{name} {c}" for name in self.reactions for c in FORCES]
        return labels, np.vstack(list(self.reactions.values()))

    def history(
        self,
        name: str,
        hub_loads: Loads,
        gearbox_weight: float = 0.0,
        gravity: float = 0.0,
    ) -> Floats:
        """One reaction over any number of load steps.

        Parameters
        ----------
        name : str
            A key of ``reactions``.
        hub_loads : LoadHistory, PointLoads or array_like
            As `entering` takes them; an array is (..., 6) hub forces [N] and moments [N m] about
            the front face, or (..., 6 + 6 m) with those at each of m load points of the scene.
        gearbox_weight : float
            [N], along -z.
        gravity : float
            Acceleration along -z that gives all parts their self-weight [m/s^2].

        Returns
        -------
        reaction
            (..., 6) [N, N m].

        Raises
        ------
        InputError
            There is no reaction of that name, or `entering` refuses the loads.
        """
        if name not in self.reactions:
            raise InputError(f"no reaction {name!r}: use one of {', '.join(self.reactions)}")
        R = self.reactions[name]
        constant = gearbox_weight * R[:, 9] - gravity * R[:, 8]
        driven = entering(self, hub_loads).values
        result = driven @ driving(R, driven.shape[-1]).T
        result += constant
        return np.asarray(result)

    def plot(self, hub_loads: Loads, gearbox_weight: float = 0.0, gravity: float = 0.0) -> Any:
        """What the drivetrain puts on its supports under one load, as a Plotly figure.

        Parameters
        ----------
        hub_loads : PointLoads or array_like
            (6,) and more, as of `history`.
        gearbox_weight, gravity : float
            The same as for `history`.

        Returns
        -------
        plotly.graph_objects.Figure
            See `fe_drivetrain.plots.load_bars`.
        """
        loads = entering(self, hub_loads)
        supports = [name for name in self.reactions if "." not in name]
        found = {name: self.history(name, loads, gearbox_weight, gravity) for name in supports}
        return load_bars(found, "On the supports")


def driving(matrix: Floats, n: int) -> Floats:
    """The first n columns (..., n) of a response that loads at hub and load points belong to."""
    if n == 6:
        return matrix[..., :6]
    return np.concatenate([matrix[..., :6], matrix[..., len(LOADS) : len(LOADS) + n - 6]], axis=-1)


def unit_load_response(model: Model, method: str = "auto", seed: int = 0) -> Response:
    """Solve a model for all unit loads, and check the result twice.

    Parameters
    ----------
    model : Model
        The model.
    method : str
        Solver, see `solvers.solve`.
    seed : int
        Seed of the random load vector of the superposition check.

    Raises
    ------
    InputError
        The system is singular, see `solvers.factorise`; with what the model warned of.
    """
    loads = model.unit_loads()
    n_loads = len(model.loads)
    # Loads of very different size (1 N, 1 N m, a tonne under 1 m/s^2) count equally in the check.
    factors = np.random.default_rng(seed).uniform(-1.0, 1.0, n_loads)
    factors /= np.linalg.norm(loads, axis=0)
    cases = np.column_stack([np.eye(n_loads), factors])
    F = loads @ cases

    U, diagnostics, forces, reactions = _solved(model, method, F, cases)
    direct = np.concatenate([r[:, -1] for r in reactions.values()])
    superposed = np.concatenate([r[:, :-1] @ factors for r in reactions.values()])
    reactions = {name: r[:, :-1] for name, r in reactions.items()}
    positions = {
        name: model.points[
            "gearbox" if name == "gearbox" else f"{name.split('.')[0]}.seat"
        ].position
        for name in reactions
    }
    for name in ("hub", *model.scene.bands):
        positions[name] = model.points[name].position
    U = U[:, :-1]
    n = len(model.mesh.points)
    return Response(
        reactions=reactions,
        positions=positions,
        motions={name: point.motion @ U for name, point in model.points.items()},
        strain_energy={part: U.T @ inner[:, :-1] for part, inner in forces.items()},
        displacements=U[: 3 * n].reshape(n, 3, n_loads),
        equilibrium_error=_equilibrium_error(model, reactions, positions),
        superposition_error=float(np.abs(direct - superposed).max() / np.abs(direct).max()),
        diagnostics=diagnostics,
        entrance=model.scene.entrance,
    )


def some_responses(
    model: Model, columns: Sequence[int], method: str = "auto", forces: bool = True
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Reactions and motions under some of the unit loads of a model: fewer take less time.

    Parameters
    ----------
    model : Model
        The model.
    columns : Sequence[int]
        Which of its n unit loads.
    method : str
        Solver, see `solvers.solve`.
    forces : bool
        Whether reactions are asked for; else there are none.

    Returns
    -------
    reactions, motions
        (6, n) by name, as those of a `Response`; NaN for the other loads.

    Raises
    ------
    InputError
        As `unit_load_response`.
    """
    n = len(model.loads)
    cases = np.eye(n)[:, columns]
    F = model.unit_loads() @ cases
    found: dict[str, Floats] = {}
    if forces:
        U, _, _, found = _solved(model, method, F, cases)
    else:
        U = _displaced(model, method, F)[1]
    moved = {name: point.motion @ U for name, point in model.points.items()}
    whole = []
    for some in (found, moved):
        rows = {name: np.full((6, n), np.nan) for name in some}
        for name, values in some.items():
            rows[name][:, columns] = values
        whole.append(rows)
    return whole[0], whole[1]


def _solved(
    model: Model, method: str, F: Floats, cases: Floats
) -> tuple[Floats, Diagnostics, dict[str, Floats], dict[str, Floats]]:
    """Displacements under loads, how they were found, forces in each part, and reactions."""
    ready, U, diagnostics = _displaced(model, method, F)
    internal = kernels.product(ready.stiffness, U)
    multipliers = ready.elimination.multipliers(internal - F)
    forces = part_forces(model, U, internal)
    return U, diagnostics, forces, reactions_by_part(model, multipliers, forces, U, cases)


def _displaced(model: Model, method: str, F: Floats) -> tuple[Prepared, Floats, Diagnostics]:
    """The model with its solver, displacements under loads, and how they were found."""
    try:
        ready = prepared(model, method, F.shape[1])
        return ready, *ready.solve(F)
    except InputError as error:
        if str(error) == SINGULAR and model.warnings:
            raise InputError(f"{SINGULAR}: {'; '.join(model.warnings)}") from error
        raise


def reactions_by_part(
    model: Model,
    multipliers: Mapping[str, Floats],
    internal: Mapping[str, Floats],
    U: Floats,
    cases: Floats,
) -> dict[str, Floats]:
    """Reactions from the residual on constrained degrees of freedom; never from stresses.

    Parameters
    ----------
    model : Model
        The model.
    multipliers : Mapping[str, Floats]
        Forces of its constraints.
    internal : Mapping[str, Floats]
        Internal forces (n_dofs, m) of each part [N].
    U : Floats
        Displacements (n_dofs, m) [m].
    cases : Floats
        (n_loads, m) unit loads that act inside the parts.
    """
    mesh = model.mesh
    reactions: dict[str, Floats] = {}
    for unit in model.scene.bearing_units:
        name = unit.bearing.name
        centre = model.points[f"{name}.seat"].position
        standing = model.standing(name)
        if name in model.scene.guests:  # less than its parts' own, which carries it
            part, faces = f"{name}.housing", stood_on(model.scene, name)
            forces = internal[part] - model.part_loads(part) @ cases
            nodes = np.unique(np.concatenate([mesh.face_nodes(face) for face in faces]))
            reactions[name] = -resultant(mesh.points[nodes], forces[dofs(nodes)], centre)
        elif not standing:
            base = mesh.face_nodes(f"{name}.housing.base")
            forces = multipliers[f"{name}.housing.base"].reshape(len(base), 3, -1)
            reactions[name] = -resultant(mesh.points[base], forces, centre)
        else:
            reactions[name] = np.zeros((6, U.shape[1]))
            for key in standing:
                carried = _carried_at(model, key, multipliers, U)
                arm = model.points[key].position - centre
                reactions[name] += wrench_transport(arm) @ carried
        parts = [(f"{name}.seat", name, f"shaft.seat.{name}")]
        if unit.condensed is None:
            parts.append((f"{name}.outer", f"{name}.housing", f"{name}.housing.bore"))
        else:
            reactions[f"{name}.outer"] = reactions[name]
        for key, part, face in parts:
            # What a part's neighbour puts on it: its internal forces less the loads inside it.
            forces = internal[part] - model.part_loads(part) @ cases
            nodes = mesh.face_nodes(face)
            reactions[key] = resultant(mesh.points[nodes], forces[dofs(nodes)], centre)
    for owner, *others in model.scene.coupled_units:
        for name in others:
            arm = model.points[f"{name}.seat"].position - model.points[f"{owner}.seat"].position
            reactions[owner] = reactions[owner] - wrench_transport(arm) @ reactions[name]
    for bearing in model.scene.nose_bearings:
        reactions[bearing.name] = _carried_at(model, f"{bearing.name}.joint", multipliers, U)
    reactions["gearbox"] = _carried_at(model, "gearbox", multipliers, U)
    return reactions


def _carried_at(model: Model, point: str, multipliers: Mapping[str, Floats], U: Floats) -> Floats:
    """(6, n_loads) what springs and rigid holds carry at a reference point."""
    total = np.zeros((6, U.shape[1]))
    for at, k in model.springs:
        if at.name == point:
            total += k @ (at.motion @ U)
    if point in model.held:
        total[list(model.held[point])] -= multipliers[f"{point} reaction"]
    return total


def _equilibrium_error(
    model: Model, reactions: Mapping[str, Floats], positions: Mapping[str, Floats]
) -> float:
    """Largest component of (applied - reacted) about the origin, relative to each load's size.

    A nose is no part of the body that is in balance: it is one of its supports.
    """
    mesh = model.mesh
    applied = np.zeros((6, len(model.loads)))
    applied[:, :6] = wrench_transport(model.points["hub"].position)
    for k, name in enumerate(model.scene.bands):
        first = len(LOADS) + 6 * k
        applied[:, first : first + 6] = wrench_transport(model.points[name].position)
    mass = model.mass - model.part_mass.get("nose", 0.0)
    first_moment = mass @ mesh.points
    for axis in range(3):
        e = np.eye(3)[axis]
        applied[:3, 6 + axis] = mass.sum() * e
        applied[3:, 6 + axis] = np.cross(first_moment, e)
    weight = np.zeros((6, 1))
    weight[2] = -1.0
    applied[:, [9]] = wrench_transport(model.points["gearbox"].position) @ weight
    reacted = np.zeros_like(applied)
    for name in (*model.scene.bearing_names, "gearbox"):
        reacted += wrench_transport(positions[name]) @ reactions[name]
    return float((np.abs(applied - reacted).max(axis=0) / np.abs(applied).max(axis=0)).max())
