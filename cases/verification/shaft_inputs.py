"""Tables of inputs, sources and a check, shared by the cases of shafts."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases.references.exact_shafts import ExactShaft
from fe_drivetrain.cases.references.solid_shafts import Supported, mesh_band, straight
from fe_drivetrain.cases.references.supported_shafts import Load, SupportedShaft
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, Target

SIZE = "Stirling 2023, Table 3.1, in size"
HARMONICS = "Fourier harmonics in the meridian (fe_drivetrain.elasticity.revolution.harmonics)"
#: Of a mesh under the loads of an exact field, see `of_mesh`.
SHAFT, REFINEMENT, UNKNOWNS, TURN = "shaft", "refinement", "unknowns", "per turn"
ERROR = "largest difference from the exact displacements, over the largest"

#: Name, value, unit, and where it comes from: "chosen" where it is left out.
Input = tuple[str, float | str, str] | tuple[str, float | str, str, str]


def show_inputs(
    page: Page, *rows: Input, steel: Material | None = None, gravity: float | None = None
) -> None:
    """Add the table of a case's inputs; below them gravity [m/s^2] and elasticity of its steel."""
    table = [row if len(row) == 4 else (*row, "chosen") for row in rows]
    if steel is not None and gravity is not None:
        table.append(("gravity", gravity, "m/s^2", "standard"))
        table.append(("density", steel.density, "kg/m^3", "steel, assumed"))
    if steel is not None:
        table += [
            ("E", steel.youngs_modulus / 1e9, "GPa", "steel, assumed"),
            ("nu", steel.poisson_ratio, "-", "steel, assumed"),
            ("G = E / (2 (1 + nu))", steel.shear_modulus / 1e9, "GPa", "of these"),
        ]
    page.table("Inputs", table, ["input", "value", "unit", "source"])


def begin(run: Run, page: Page, title: str, shaft: Shaft, shown: str = "The shaft") -> None:
    """Begin a section with a picture of its shaft, and what is shown there."""
    page.section(title)
    page.image(shown, run.sketch(shaft))


def begin_uniform(
    run: Run,
    page: Page,
    title: str,
    diameters: tuple[float, float],
    length: tuple[str, float, str] | tuple[str, float, str, str],
    *more: Input,
    steel: Material,
) -> None:
    """Begin the section of a uniform shaft, solid and bored; outer diameter and bore in m."""
    outer, bore = diameters
    begin(run, page, title, straight((0.0, length[1]), outer, bore), "The bored shaft")
    sizes = ("outer diameter", outer, "m", SIZE), ("bore of the bored shaft", bore, "m"), length
    show_inputs(page, *sizes, *more, steel=steel)


def beside_beam(
    name: str,
    shaft: SupportedShaft,
    load: Load,
    at: Floats,
    solid: Supported,
    over_max: bool = False,
) -> list[Any]:
    """Curves of a deflection: the beam with shear at places x [m], the solid at its stations.

    Parameters
    ----------
    name : str
        Of the load.
    shaft : SupportedShaft
        Which is bent.
    load : Load
        What bends it.
    at : ndarray
        (n,) [m].
    solid : Supported
        What the solid does under the load.
    over_max : bool
        Over the largest deflection of the beam; in mm otherwise.
    """
    beam, means = shaft.beam(load, at).motions[:, 0], solid.motions[:, 0]
    largest = np.abs(beam).max()
    curve, points = (of / largest if over_max else 1e3 * of for of in (beam, means))
    solids = trace(f"{name}, solid", shaft.stations, points, True)
    return [trace(f"{name}, beam", at, curve), solids]


def show_errors(
    page: Page, title: str, rows: Sequence[Record], table: Sequence[str] | bool
) -> None:
    """Errors of the displacements of `of_mesh` over the unknowns, a curve for each shaft."""
    axis = "relative error"
    page.sweep(title, rows, UNKNOWNS, ERROR, by=SHAFT, log="xy", axis=axis, table=table)


def of_mesh(name: str, refinement: int, shaft: ExactShaft) -> Record:
    """The size of a mesh under the loads of an exact field, and the error of its displacements."""
    mesh = shaft.mesh
    size = {SHAFT: name, REFINEMENT: refinement, UNKNOWNS: mesh.n_unknowns, TURN: mesh.per_turn}
    return {**size, ERROR: shaft.error}


def check_motion(
    page: Page,
    title: str,
    unit: str,
    closed: tuple[float, str],
    by_frame: float,
    by_mesh: Sequence[float],
    evenly: tuple[float, float, str, str],
) -> Record:
    """The frame against a closed form with shear, ever finer solids against a beam held evenly.

    Parameters
    ----------
    page : Page
        Where it is checked.
    title, unit : str
        What moves.
    closed : tuple of float, str
        The closed form, and where it comes from.
    by_frame : float
        The frame of the library.
    by_mesh : sequence of float
        Of the solids, meshes 1, 2, ... of a family.
    evenly : tuple of float, float, str, str
        Of the solid: the beam, by what share it may differ, why, and where the beam comes from.

    Returns
    -------
    row : dict
        Of a table: closed form, frame, solid, its band.
    """
    exact = "the frame's sections are exact: round-off"
    framed = Target(f"{title}, frame [{unit}]", closed[0], 1e-10, exact, closed[1])
    band = mesh_band(range(1, len(by_mesh) + 1), by_mesh)
    page.meets(by_frame, framed)
    page.meets(by_mesh[-1], Target(f"{title}, solid [{unit}]", *evenly), band)
    return {
        "closed form": closed[0],
        "frame": by_frame,
        "solid": float(by_mesh[-1]),
        "band of the solid": band,
    }
