"""ROSS: the beam of a scene as shaft elements, its bearing units and gearbox as bearing elements.

ROSS has the shaft along its z, y up and x = y cross z; degrees of freedom of a node x, y, z, alpha,
beta, theta, the last three rotations about these. So its x, y, z are this project's y, z, x, turned
cyclically and right-handed both. Shear as here: Cowper's coefficient.

A BearingElement has kxx, kxy, kyx, kyy and kzz only. What else a bearing unit or a gearbox has
(stiffness against tilt, and what couples forces along the shaft, across it, and moments) goes into
an element of its own at the same node, and so does the mass of a housing. ROSS cannot hold a motion
rigidly: a rigid support is a spring that many times stiffer than the shaft beside it.

``run_static`` of ROSS puts 1e20 N/m in the place of every bearing's lateral stiffness, whatever it
is, and loads by 9.8065 m/s^2 along -y: it answers for rigid bearings alone. `Rotor.deflections`
uses the stiffness of the rotor as it is.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.beam.beam import Beam
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.fidelity.shafts import ringed_shaft

#: ROSS's x, y, z, alpha, beta, theta among this project's ux, uy, uz, rx, ry, rz.
FROM_PROJECT = (1, 2, 0, 4, 5, 3)
_BACK = tuple(int(i) for i in np.argsort(FROM_PROJECT))

#: Gravity of ROSS's static analysis along -y [m/s^2].
STATIC_GRAVITY = 9.8065


@dataclass(frozen=True)
class Rotor:
    """A rotor of ROSS.

    Attributes
    ----------
    rotor : Any
        The ross.Rotor, for all that ROSS can do with it.
    stations : Floats
        (n,) x of its nodes [m].
    supports : Mapping[str, tuple[int, Floats]]
        Node and stiffness (6, 6) of each support by name [N/m, N, N m/rad] in this
        project's frame and order, as it went in.
    inertia : Mapping[str, Floats]
        Mass (6, 6) of supports that have one [kg, kg m, kg m^2].
    """

    rotor: Any
    stations: Floats
    supports: Mapping[str, tuple[int, Floats]]
    inertia: Mapping[str, Floats] = field(default_factory=dict)

    def node(self, x: float) -> int:
        """The node at a station [m].

        Raises
        ------
        InputError
            There is none.
        """
        at = int(np.argmin(np.abs(self.stations - x)))
        if abs(self.stations[at] - x) > 1e-9 * np.ptp(self.stations):
            raise InputError(
                f"the rotor has no node at x = {x:g} m: give that station when it is built"
            )
        return at

    def matrix(self, kind: str) -> Floats:
        """(6 n, 6 n) stiffness "K" or mass "M" as ROSS assembles it, in this project's order."""
        found = np.asarray(getattr(self.rotor, kind)(0.0))
        rows = _rows(len(self.stations))
        return np.asarray(found[np.ix_(rows, rows)])

    def deflections(
        self, loads: Mapping[float, Floats], gravity: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> Floats:
        """(n, 6) motions of the nodes under loads (6,) at stations and the shaft's own weight.

        The weight of supports is not among the loads.

        Parameters
        ----------
        loads : Mapping[float, Floats]
            By station [m]: forces and moments [N, N m] in this project's order.
        gravity : Sequence[float]
            (3,) along x, y, z [m/s^2].
        """
        n = len(self.stations)
        falling = np.array([*gravity, 0.0, 0.0, 0.0])
        F = self.matrix("M") @ np.tile(falling, n)
        for name, mass in self.inertia.items():
            first = 6 * self.supports[name][0]
            F[first : first + 6] -= mass @ falling
        for x, load in loads.items():
            first = 6 * self.node(x)
            F[first : first + 6] += load
        return scaled_solve(self.matrix("K"), F).reshape(n, 6)

    def reactions(self, deflections: Floats) -> dict[str, Floats]:
        """What the shaft puts on each support (6,) [N, N m], from motions of the nodes (n, 6)."""
        return {name: k @ deflections[node] for name, (node, k) in self.supports.items()}

    def frequencies(self, count: int) -> Floats:
        """The lowest natural frequencies at standstill [Hz], of the rotor's state-space matrix.

        They are those of ``rotor.run_modal(speed=0.0)``, which in every new process spends some ten
        seconds on compiling what draws the modes.
        """
        values = linalg.eigvals(self.rotor.A(0.0))
        return np.sort(values.imag[values.imag > 0.0])[:count] / (2.0 * np.pi)

    def static_reactions(self) -> dict[str, float]:
        """Upward force [N] on the shaft at each support by ROSS's own static analysis.

        It is that of the shaft's weight on bearings rigid along x and y of ROSS, see above. Where a
        support couples forces with moments, what that carries is missing.
        """
        self.rotor.run_static()
        # it makes bearings of its own, without the names
        found = self.rotor.bearing_forces_nodal
        return {name: float(found[f"node_{node}"]) for name, (node, _) in self.supports.items()}


def ross_rotor(
    beam: Beam,
    stations: Sequence[float] = (),
    longest: float | None = None,
    stiffer: float = 1e6,
    inertia: Mapping[str, Floats] | None = None,
) -> Rotor:
    """A rotor of ROSS from a beam and its supports.

    Parameters
    ----------
    beam : Beam
        With its supports; see `fe_drivetrain.shafts.beam.of_scene.beam_of_scene`.
    stations : Sequence[float]
        Where nodes must be [m], besides the ends of sections and the supports.
    longest : float or None
        Maximum length of its elements [m]; a sixteenth of the beam where not given. What is static
        is exact between nodes; frequencies, and cones, want short elements.
    stiffer : float
        How many times a support that is rigid is stiffer than the shaft at its node.
    inertia : Mapping[str, Floats] or None
        (6, 6) mass of supports by name [kg, kg m, kg m^2], in this project's frame: it moves with
        the shaft's node, but does not spin.

    Raises
    ------
    MissingToolError
        ROSS is not installed.
    InputError
        A section is given by rigidities, which ROSS does not take, a length is not positive, or
        there is no support of a mass's name.
    """
    inertia = {} if inertia is None else inertia
    names = [support.name for support in beam.supports]
    for name in inertia:
        if name not in names:
            raise InputError(
                f"mass of {name!r} is at none of the supports {', '.join(names)}: name one of these"
            )
    ross = _ross()
    longest = beam.length / 16.0 if longest is None else longest
    if not longest > 0.0:
        raise InputError(f"longest element is {longest:g} m but must be above 0")
    nodes = _nodes(beam, stations, longest)
    elements = _shaft_elements(ross, beam, nodes)
    own = _free_diagonal(elements)
    extra = _further_matrices(ross)
    bearings, others = [], []
    supports: dict[str, tuple[int, Floats]] = {}
    for support in beam.supports:
        node = int(np.argmin(np.abs(nodes - support.x)))
        k = np.array(support.stiffness, dtype=float)
        rigid = np.flatnonzero(np.isinf(k.diagonal()))
        k[rigid, rigid] = stiffer * own[node][rigid]
        supports[support.name] = (node, k)
        k = k[np.ix_(FROM_PROJECT, FROM_PROJECT)]
        bearing = _bearing_element(ross, node, k, support.name)
        bearings.append(bearing)
        rest = k.copy()
        rest[:3, :3] -= bearing.K(0.0)
        mass = inertia.get(support.name, np.zeros((6, 6)))[np.ix_(FROM_PROJECT, FROM_PROJECT)]
        if rest.any() or mass.any():
            others.append(extra(node, rest, mass, f"{support.name}, moments, coupling, mass"))
    return Rotor(ross.Rotor(elements, others, bearings), nodes, supports, inertia)


def _shaft_elements(ross: Any, beam: Beam, nodes: Floats) -> list[Any]:
    """ROSS's elements of the shaft between nodes."""
    material = ross.Material(
        name="shaft",
        rho=beam.material.density,
        E=beam.material.youngs_modulus,
        G_s=beam.material.shear_modulus,
    )
    ends = beam.ends
    elements = []
    for low, high in itertools.pairwise(nodes.tolist()):
        index = int(np.searchsorted(ends, 0.5 * (low + high))) - 1
        section = beam.sections[index]
        if not isinstance(section, BeamSection):
            raise InputError(
                f"beam section {index + 1} is given by its rigidities, but ROSS takes diameters: "
                "give a BeamSection"
            )
        share = (np.array([low, high]) - ends[index]) / section.length
        outer, inner = (a + (b - a) * share for a, b in section.end_diameters)
        elements.append(
            ross.ShaftElement(
                L=high - low,
                idl=inner[0],
                odl=outer[0],
                idr=inner[1],
                odr=outer[1],
                material=material,
                shear_effects=beam.shear,
                rotary_inertia=True,
                shear_method_calc="cowper",
            )
        )
    return elements


def _bearing_element(ross: Any, node: int, k: Floats, name: str) -> Any:
    """ROSS's bearing with the forces of a stiffness (6, 6) in ROSS's frame."""
    return ross.BearingElement(
        n=node,
        kxx=float(k[0, 0]),
        kxy=float(k[0, 1]),
        kyx=float(k[1, 0]),
        kyy=float(k[1, 1]),
        kzz=float(k[2, 2]),
        cxx=0.0,
        tag=name,
    )


def rotor_of_scene(
    scene: Scene,
    bearing_stiffness: Mapping[str, Floats],
    rings: bool = True,
    longest: float | None = None,
    stiffer: float = 1e6,
    inertia: Mapping[str, Floats] | None = None,
) -> Rotor:
    """The shaft, the bearing units and the gearbox of a scene as a rotor of ROSS.

    Parameters
    ----------
    scene : Scene
        The scene; what its gearbox weighs is a load, see `Rotor.deflections`.
    bearing_stiffness : Mapping[str, Floats]
        (6, 6) by bearing [N/m, N, N m/rad], as `fe_drivetrain.shafts.fidelity.unit_stiffness` or
        the ``stiffness`` of `fe_drivetrain.export.unit_superelement` gives it.
    rings : bool
        Whether the shaft has its rings, see `fe_drivetrain.shafts.fidelity.shafts.ringed_shaft`.
    longest, stiffer : float or None, float
        The same as for `ross_rotor`.
    inertia : Mapping[str, Floats] or None
        (6, 6) by bearing [kg, kg m, kg m^2], as `fe_drivetrain.shafts.fidelity.unit_matrices` gives
        it; supports have no mass where it is not given.
    """
    beam = (ringed_beam if rings else beam_of_scene)(scene, bearing_stiffness)
    return ross_rotor(beam, (), longest, stiffer, inertia)


def ringed_beam(scene: Scene, bearing_stiffness: Mapping[str, Floats]) -> Beam:
    """The beam of a scene, its shaft with its rings."""
    ringed = scene.model_copy(update={"shaft": ringed_shaft(scene)[0]})
    return beam_of_scene(ringed, bearing_stiffness)


def ross_version() -> str:
    """The version of ROSS that is installed.

    Raises
    ------
    MissingToolError
        None is.
    """
    return str(_ross().__version__)


def _nodes(beam: Beam, stations: Sequence[float], longest: float) -> Floats:
    """Stations of all nodes, ascending."""
    wanted = np.sort([*beam.ends, *(support.x for support in beam.supports), *stations])
    slack = 1e-9 * beam.length
    if wanted[0] < beam.ends[0] - slack or wanted[-1] > beam.ends[-1] + slack:
        raise InputError(
            f"stations from x = {wanted[0]:g} m to {wanted[-1]:g} m must be on the beam, from "
            f"{beam.ends[0]:g} to {beam.ends[-1]:g} m"
        )
    wanted = wanted[np.append(True, np.diff(wanted) > slack)]
    parts = [
        np.linspace(low, high, math.ceil((high - low) / longest - 1e-9) + 1)[:-1]
        for low, high in itertools.pairwise(wanted)
    ]
    return np.append(np.concatenate(parts), wanted[-1])


def _free_diagonal(elements: Sequence[Any]) -> Floats:
    """(n, 6) stiffness of the nodes with all others clamped, in this project's order."""
    found = np.zeros((len(elements) + 1, 6))
    for k, element in enumerate(elements):
        found[k : k + 2] += np.diag(element.K()).reshape(2, 6)
    return np.asarray(found[:, _BACK])


def _rows(n: int) -> Floats:
    """Rows of ROSS's matrices in this project's order."""
    return np.add.outer(6 * np.arange(n), _BACK).ravel()


def _further_matrices(ross: Any) -> Any:
    """A class of elements with a full stiffness to ground, and a full mass.

    ROSS adds the stiffness of its disks, which is zero but for this one, to six degrees of freedom
    of a node; a bearing has three. Of a disk without polar inertia nothing spins.
    """

    class FurtherMatrices(ross.DiskElement):  # type: ignore[misc]
        """Stiffness (6, 6) to ground and mass (6, 6), which is none of the rotor's own."""

        def __init__(self, n: int, stiffness: Floats, mass: Floats, tag: str) -> None:
            super().__init__(n=n, m=0.0, Id=0.0, Ip=0.0, tag=tag)
            self.stiffness = stiffness
            self.mass = mass

        def __hash__(self) -> int:
            return hash(self.tag)

        def K(self) -> Floats:
            return self.stiffness

        def M(self) -> Floats:
            return self.mass

    return FurtherMatrices


def _ross() -> Any:
    try:
        return import_module("ross")
    except ImportError as error:
        raise MissingToolError(
            'ROSS is not installed: pip install "fe-drivetrain[ross]"'
        ) from error
    except ValueError as error:  # up to 2.3 it asks plotly 7 for kinds of charts that are no more
        raise MissingToolError(
            'ROSS does not start with the plotly that is installed: pip install "plotly<7"'
        ) from error
