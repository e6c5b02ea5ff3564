"""What every page of the main-bearing cases shows: checks, meshes, pictures, matrices, sources."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from fe_drivetrain.cases.main_bearing.bands import Series
from fe_drivetrain.common import (
    FORCES,
    Floats,
)
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.mesh import quality
from fe_drivetrain.report import (
    Image,
    NoPictureError,
    Solid,
    Text,
    begin_pictures,
    deformed_view,
    model_pictures,
    no_picture,
)
from fe_drivetrain.report.suite import Jobs, Page, Run
from fe_drivetrain.shafts.response import (
    ESTIMATORS,
    LOADS,
)
from fe_drivetrain.studies import model_checks
from fe_drivetrain.studies.seat_stiffness import SeatStiffness
from fe_drivetrain.studies.solved_assembly import Assembly

#: K_R by plane (Stirling 2023, section 3.3.1) [MN m/rad].
PUBLISHED = {"vertical": 145.0, "horizontal": 392.0}

_AS = ", as in the thesis"
_OTHER_HOUSING = "The thesis's values belong to its own housing, whose dimensions it does not give"


def deformed(pictures: Sequence[Image | Solid | Text]) -> str:
    """Caption of the last picture of `pictures_of`, the deformed shape; empty without any."""
    return next((one.caption for one in reversed(pictures) if not isinstance(one, Text)), "")


def check_solution(page: Page, solved: Assembly, label: str) -> None:
    """The two independent checks that every solution carries."""
    with page.of(solved.scene):
        model_checks.check_solution(page, solved.response, label)


def check_series(page: Page, series: Series, label: str) -> None:
    """Whether the coarser solutions of a series are in balance; nothing where there are none."""
    if series.complete:
        page.vanishes(
            f"{label}, coarser meshes of its bands: equilibrium and linearity, the worst",
            series.worst_error(),
            within=1e-8,
            why="the residual at which the solver of the linear scene stops",
            source="exact",
        )


def tilt_table(page: Page, tilt: SeatStiffness, series: Series) -> None:
    """K_R by plane and estimator, each with its band; of the thesis's scene beside its own."""
    rows = []
    for p, (plane, values) in enumerate(tilt.by_plane.items()):
        row: dict[str, object] = {"plane": plane}
        for k, (estimator, value) in enumerate(zip(ESTIMATORS, values.values(), strict=True)):
            band = series.band(lambda f, p=p, k=k: float(f["K_R"][p, k]) / 1e6)
            row |= {estimator: value / 1e6, f"± {estimator}": band}
        row["spread [%]"] = tilt.spread(plane)
        rows.append(row | {"Stirling 2023": PUBLISHED[plane]})
    page.table(
        f"K_R = M / theta of bearing and housing [MN m/rad], gearbox springs removed. "
        f"{_OTHER_HOUSING}",
        rows,
    )


def matrix_table(page: Page, caption: str, matrix: Floats) -> None:
    """A 6x6 stiffness."""
    names = ("ux", "uy", "uz", "rx", "ry", "rz")
    size = np.sqrt(np.outer(matrix.diagonal(), matrix.diagonal()))
    shown = np.where(np.abs(matrix) < 1e-3 * size, 0.0, matrix)
    page.table(
        caption + " [N/m, N, N m/rad]; terms below 0.1 % of their diagonals shown as 0",
        [[name, *row] for name, row in zip(names, shown.tolist(), strict=True)],
        ["", *names],
    )


def reaction_table(
    page: Page, caption: str, reaction: Floats, loads: Sequence[str] = LOADS
) -> None:
    """A (6, n) reaction matrix; what is nothing but the mesh's asymmetry is shown as zero."""
    size = np.abs(reaction).max(axis=0)
    # A column may hold nothing but round-off: the bearing feels no torque, no gearbox weight.
    shown = np.where(np.abs(reaction) < np.maximum(1e-4 * size, 1e-6), 0.0, reaction)
    page.table(
        f"{caption}. Below 0.01 % of their column's largest, or 1e-6, entries show as 0",
        [
            [f"{c} [{'N' if c[0] == 'F' else 'N m'}]", *row]
            for c, row in zip(FORCES, shown.tolist(), strict=True)
        ],
        ["reaction", *(f"{load} [per {_unit(load)}]" for load in loads)],
    )


def _unit(load: str) -> str:
    if load.startswith("gravity"):
        return "m/s²"
    return "N m" if load.rpartition(".")[2].startswith("M") else "N"


def mesh_section(page: Page, solutions: Mapping[str, Assembly]) -> None:
    """A section with mesh, solver and diagnostics of each solution."""
    page.section("Mesh and solution")
    page.table(
        f"Meshes of curved ten-node tetrahedra, and what ten unit loads took{_warnings(solutions)}",
        [
            {
                "model": label,
                "elements": len(s.model.mesh.cells),
                "nodes": len(s.model.mesh.points),
                "unknowns": s.response.diagnostics.n_unknowns,
                "minimum scaled Jacobian": quality(s.model.mesh).minimum_scaled_jacobian,
                "solver": s.response.diagnostics.method,
                "iterations": s.response.diagnostics.iterations or None,
                "set-up and solve [s]": s.response.diagnostics.seconds,
            }
            for label, s in solutions.items()
        ],
    )
    page.table(
        "Relative errors of the solutions",
        [
            {
                "model": label,
                "residual [-]": s.response.diagnostics.residual,
                "energy [-]": s.response.diagnostics.energy_error,
                "equilibrium [-]": s.response.equilibrium_error,
                "superposition [-]": s.response.superposition_error,
            }
            for label, s in solutions.items()
        ],
    )
    page.table("Why that solver", _choices(solutions), ["model", "solvers, best first"])


def _choices(solutions: Mapping[str, Assembly]) -> list[tuple[str, str]]:
    """Each model that gives another reason for its solver, and the reason."""
    reasons: dict[str, str] = {}
    for label, s in solutions.items():
        reasons.setdefault(s.response.diagnostics.reason, label)
    return [(label, reason) for reason, label in reasons.items()]


def _warnings(solutions: Mapping[str, Assembly]) -> str:
    """What the models warn of, each once, with the first model that does."""
    found: dict[str, str] = {}
    for label, s in solutions.items():
        for warning in s.model.warnings:
            found.setdefault(warning, label)
    return "".join(f". Warning ({label}): {warning}" for warning, label in found.items())


def pictures_of(
    run: Run, solved: Assembly, loads: Floats, what: str
) -> Sequence[Image | Solid | Text]:
    """Draw the model and its deformed shape.

    Parameters
    ----------
    run : Run
        Its folder takes the pictures.
    solved : Assembly
        The model and its response.
    loads : array
        (10,) load factors of the deformed shape.
    what : str
        The loads in words.

    Returns
    -------
    items : sequence of Image, Solid or Text
        For the page; a sentence that says why where nothing can be drawn.
    """
    with run.step("pictures"):
        return model_pictures(solved.model, solved.response, loads, run.folder, what)


def start_pictures(
    run: Run, jobs: Jobs, solved: Assembly, loads: Floats, what: str
) -> Callable[[], Sequence[Image | Solid | Text]]:
    """Begin `pictures_of` beside other work; what is returned waits for them.

    Parameters
    ----------
    run, jobs : Run, Jobs
        The run, whose folder takes the pictures, and what does its work side by side.
    solved, loads, what : Assembly, Floats, str
        See `pictures_of`.
    """
    try:
        with run.step("pictures"):
            begun = begin_pictures(solved.model, solved.response, loads, run.folder)
    except NoPictureError as reason:
        text = no_picture(reason)
        return lambda: [text]
    view = jobs.start(_view, solved, loads, what, begun.factor)
    return lambda: begun.items(view.result())


def _view(run: Run, solved: Assembly, loads: Floats, what: str, factor: float) -> Solid | Image:
    with run.step("deformed shape for the browser"):
        return deformed_view(solved.model, solved.response, loads, run.folder, what, factor)


def assume(page: Page, scene: Scene) -> None:
    """Everything that the source of the scene does not give."""
    unit = scene.bearing_units[0]
    torque = scene.gearbox.stiffness[3]
    page.assume(
        "gearbox torque reaction",
        torque if torque == "rigid" else float(torque),
        "" if torque == "rigid" else "N m/rad",
        "a spherical joint lets the shaft spin, so the gearbox must react torque; the thesis names "
        "three translational springs only",
    )
    page.assume(
        "coupling of hub and gearbox",
        f"{scene.hub.coupling}, {scene.gearbox.coupling}",
        "",
        "averaged: loads and springs act on the mean motion of the shaft's end face (RBE3)",
    )
    base = {
        "fixed": f"the whole underside of the housing is fixed{_AS}",
        "bolted": "four washer footprints are fixed; in the thesis the whole underside",
    }[unit.block.base]
    page.assume("bedplate", "rigid", "", base)
    page.assume("clearance, friction, damping", "none", "", f"quasi-static, linear{_AS}")
    for unit in scene.bearing_units:
        name = unit.bearing.name
        for owner, part in ((name, unit.bearing), (f"{name}.housing", unit.block)):
            for what, value, unit_of_it, source in part.assumptions():
                if unit.block.base == "bolted" or not what.startswith(("bolt_", "washer_")):
                    page.assume(f"{owner}: {what}", value, unit_of_it, source)
    names = [unit.bearing.name for unit in scene.bearing_units]
    for name in ("shaft", *names, *(f"{name}.housing" for name in names)):
        material = scene.material_of(name)
        given = material in scene.materials.values()
        page.assume(
            f"{name}: E, nu, density",
            f"{material.youngs_modulus / 1e9:g} GPa, {material.poisson_ratio:g}, "
            f"{material.density:g} kg/m³",
            "",
            "given by the scene" if given else "assumed: the thesis names no material",
        )
