"""The band of every FE value: the same scene on two coarser meshes, and what the series shows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.main_bearing import bearing_scenes
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import GridConvergence, grid_convergence
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.mesh import mean_size
from fe_drivetrain.elasticity.solve import SAFETY, recovery_estimate
from fe_drivetrain.report.suite import Jobs, Run, RunJob
from fe_drivetrain.shafts.response import PLANES, Response, bearing_unit_stiffness
from fe_drivetrain.studies.seat_stiffness import SeatStiffness
from fe_drivetrain.studies.solved_assembly import Assembly, timed_mesh

#: Factors on the sizes of a case's own mesh, coarse first; a third apart, as Celik et al. ask.
FACTORS = (1.8, 1.35)

#: Stress is singular where ring, shaft and housing meet, and meshes are not nested: three of them
#: cannot show an order that is to be relied upon. Energy converges with about the element's size,
#: the mean rotation of the seat with less (order 0.75 over finer meshes than here).
MIN_ORDER = 0.5

#: Meshes whose mean sizes are nearer than this say nothing of each other.
_APART = 1.05

NOTE = (
    f"Bands (±): from this mesh and two coarser ones, sizes times {FACTORS[1]:g} and "
    f"{FACTORS[0]:g}, over the mean sizes that their elements really have. The band reaches from "
    "the value to its limit at the order observed and, since meshes are not nested and stress is "
    f"singular, to that of order {MIN_ORDER:g}, whichever is farther, and farther still where "
    "the three show no order."
)

_RECOVERED = "recovered "  # before the name of the figures that the errors are of

Figures = Mapping[str, Floats]
"""Arrays of figures by name: "reaction NAME" (6, 10), "motion POINT" (6, 10), "energy PART"
(10, 10), "checks" (errors of equilibrium and of superposition), "size" (mean size of the elements
[m]), "recovered reaction NAME" (6, 10, their errors by recovered stresses, of a case's own mesh);
and of a tilt solution "K_R" (planes, estimators), "recovered" (planes, band of K_R by
recovered stresses, relative), "stiffness" (6, 6), and the former of the solution without
gearbox, their names beginning with "free "."""

Figure = Callable[..., float]
"""Of `Figures`; other arguments have defaults."""


def of_response(response: Response, prefix: str = "") -> dict[str, Floats]:
    """Figures of one solution."""
    checks = np.array([response.equilibrium_error, response.superposition_error])
    return {f"{prefix}checks": checks} | {
        f"{prefix}{kind} {name}": np.asarray(values)
        for kind, named in (
            ("reaction", response.reactions),
            ("motion", response.motions),
            ("energy", response.strain_energy),
        )
        for name, values in named.items()
    }


def of_solved(solved: Assembly) -> dict[str, Floats]:
    """Figures of a scene with its gearbox, and "stiffness" (6, 6) of a spherical bearing's unit."""
    found = of_response(solved.response)
    found["size"] = np.array(mean_size(solved.model.mesh))
    found |= {f"{_RECOVERED}reaction {name}": error for name, error in solved.errors.items()}
    if solved.scene.bearing_units[0].interface != "bonded":
        found["stiffness"] = bearing_unit_stiffness(solved.response, solved.bearing)
    return found


def of_tilt(tilt: SeatStiffness) -> dict[str, Floats]:
    """Figures of a solution without gearbox springs."""
    k = np.array([list(values.values()) for values in tilt.by_plane.values()])
    return {
        "K_R": k,
        "recovered": recovered_of_tilt(tilt),
        "stiffness": tilt.matrix,
        "size": np.array(mean_size(tilt.free.model.mesh)),
        **of_response(tilt.free.response, "free "),
    }


def recovered_of_tilt(tilt: SeatStiffness) -> Floats:
    """Band of K_R in each plane, relative, from stresses recovered in bearing and housing.

    Under a given moment the tilt is too small by the share that the energy is.
    """
    solved = tilt.free
    mesh, name = solved.model.mesh, solved.bearing
    parts = [
        (mesh.cells[mesh.part_cells(part)], solved.scene.material_of(part).lame)
        for part in (name, f"{name}.housing")
    ]
    return np.array(
        [
            recovery_estimate(
                mesh.points, parts, solved.response.displacements[:, :, plane.moment].ravel()
            ).band(1.0)
            for plane in PLANES
        ]
    )


def coarser(scene: Scene, factor: float) -> Scene:
    """The scene with its mesh sizes times a factor."""
    return scene.model_copy(update={"mesh": scene.mesh.scaled(factor)})


def solve_coarser(
    run: Run, scene: Scene, label: str, solved: bool, tilted: bool
) -> dict[str, Floats] | None:
    """Figures of a coarser mesh; None where it is too coarse for the walls of the parts."""
    try:
        mesh = timed_mesh(run, scene, label)
    except InputError:
        return None
    found: dict[str, Floats] = {}
    if solved:
        found |= of_solved(bearing_scenes.solve(run, scene, label, mesh))
    if tilted:
        found |= of_tilt(bearing_scenes.solve_seat(run, scene, f"{label}, no gearbox", mesh))
    return found


@dataclass(frozen=True)
class Coarser:
    """Coarser solutions of one scene, on their way."""

    jobs: Sequence[RunJob[dict[str, Floats] | None]]

    def below(self, own: Figures) -> Series:
        """The series that ends with the figures of the case's own mesh."""
        found = [job.result() for job in self.jobs]
        levels = [figures for figures in (*found, own) if figures is not None]
        sizes = np.array([figures["size"] for figures in levels])
        apart = bool((sizes[:-1] > _APART * sizes[1:]).all())
        return Series(tuple(levels) if len(levels) > len(found) and apart else (own,))


def start(
    jobs: Jobs, scene: Scene, label: str, *, solved: bool = True, tilted: bool = False
) -> Coarser:
    """Solve a scene on coarser meshes, beside everything else.

    Parameters
    ----------
    label : str
        Of the case's own solution.
    solved, tilted : bool
        Whether with gearbox springs, and whether without.
    """
    return Coarser(
        [
            jobs.start(
                solve_coarser,
                coarser(scene, factor),
                f"{label}, sizes x {factor:g}",
                solved,
                tilted,
            )
            for factor in FACTORS
        ]
    )


@dataclass(frozen=True)
class Series:
    """Figures of one scene on meshes of descending size; of one mesh where there is no other."""

    levels: tuple[Figures, ...]

    @property
    def complete(self) -> bool:
        """Whether there are bands."""
        return len(self.levels) > len(FACTORS)

    def convergence(self, figure: Figure) -> GridConvergence:
        """What the series shows of a figure, which may be made of several."""
        values = [figure(level) for level in self.levels]
        sizes = [level["size"] for level in self.levels]
        return grid_convergence(sizes, values, min_order=MIN_ORDER)

    def band(self, figure: Figure) -> float | None:
        """Half width of a figure's band, in its unit; None where nothing says how wide it is.

        Of figures that K_R or reactions are in, the larger of what the series and recovered
        stresses say.
        """
        by_stress = self._recovered(figure)
        if self.complete:
            return max(self.convergence(figure).uncertainty, by_stress)
        return by_stress or None

    def _recovered(self, figure: Figure) -> float:
        """What a figure becomes where K_R and reactions are at the ends of their bands.

        These come from recovered stresses. Signs of errors are not relied upon: the figure is taken
        with all of them larger, and with all smaller.
        """
        own = self.levels[-1]
        errors = {
            name.removeprefix(_RECOVERED): SAFETY * error
            for name, error in own.items()
            if name.startswith(_RECOVERED)
        }
        found = 0.0
        for sense in (1.0, -1.0):
            moved = {n: own[n] + sense * np.copysign(e, own[n]) for n, e in errors.items()}
            if "recovered" in own:
                moved["K_R"] = own["K_R"] / (1.0 + own["recovered"][:, None])
            found = max(found, abs(figure(own) - figure({**own, **moved})))
        return found

    def percent(self, figure: Figure) -> float | None:
        """The same, relative to the figure [%]."""
        band = self.band(figure)
        if band is None:
            return None
        size = abs(figure(self.levels[-1]))
        return 100.0 * (band / size if size else float("inf") if band else 0.0)

    def beside(self, other: Series, prefix: str) -> Series:
        """With the figures of another series level by level, their names after a prefix."""
        return Series(
            tuple(
                {**own, **{f"{prefix}{name}": values for name, values in beside.items()}}
                for own, beside in zip(self.levels, other.levels, strict=False)
            )
        )

    def worst_error(self) -> float:
        """Largest error of equilibrium and of superposition of the coarser solutions."""
        return float(
            np.max([f[name] for f in self.levels[:-1] for name in f if name.endswith("checks")])
        )

    def note(self) -> str:
        """How bands come about, for the page."""
        own = self.levels[-1]
        estimated = ["K_R"] if "recovered" in own else []
        if any(name.startswith(_RECOVERED) for name in own):
            estimated.append("reactions")
        words = " and of ".join(estimated)
        if self.complete:
            more = f" Those of {words} are at least what recovered stresses of this mesh alone say."
            return NOTE + (more if words else "")
        but = f" but of {words}" if words else ""
        return (
            f"No bands{but}: elements larger than this mesh's would "
            "not fill the walls of the parts, or fold over, so there is no series of meshes."
        )

    def largest(self, name: str) -> str:
        """In words, the largest band of an array of figures, relative to its column's largest."""
        if not self.complete:
            return "no bands"
        own = self.levels[-1][name]
        size = np.abs(own).max(axis=0)
        shares = []
        for i, j in np.ndindex(own.shape):
            if np.abs(own[i, j]) > 1e-4 * size[j]:  # the rest is nothing but the mesh's asymmetry
                band = self.band(lambda f, i=i, j=j: float(f[name][i, j]))
                shares.append((band or 0.0) / size[j])
        return f"bands are at most {100.0 * max(shares):.2g} % of their column's largest"
