"""K_R as a secant over load cases: one number, or scatter where a spring is the wrong form."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import bearing_scenes, secants, shown
from fe_drivetrain.cases.main_bearing.secants import FULL, LEAN, OF_FORM, QUANTITIES, SINGLE
from fe_drivetrain.common import (
    FORCES,
    Floats,
)
from fe_drivetrain.comparison import round_off
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import (
    secant_stiffness,
)

#: Factors on the mesh sizes, coarse first: of the library's housing, and of the tall one.
FACTORS = {"library": (1.35, 1.0), "tall": (1.8, 1.35)}
QUICK_FACTORS = {"library": (4.0, 3.0), "tall": (4.0, 3.0)}
#: Centre of the tall housing over its base [m]; the library's is at 0.42 m.
HERO = "K_R of each load case against the thrust over the rotation: axis and elastic centre"
TALL = 0.9
TITLES = {"library": "the scene's housing", "tall": f"a pedestal of {TALL:g} m"}
#: Every so many samples of a history at 20 Hz.
EVERY = 40
#: Couplings of each moment that the page shows.
TERMS = 3

Reacted = secants.Reacted


#: Component and name of both moments.
PLANES = {4: "vertical plane", 5: "horizontal plane"}


@dataclass(frozen=True, eq=False)
class Worked:
    """Bearings over load cases, and what comes of them.

    Attributes
    ----------
    cases : secants.Cases
        The load cases.
    units : dict[str, list[Reacted]]
        The bonded bearing by housing and mesh, the finest last.
    scenes : dict[str, Scene]
        Its scene by housing.
    free_loads : Floats
        (m, 6) loads on the spherical bearing.
    made : dict[str, tuple[Floats, Floats]]
        Loads and motions of beams on springs of a known form.
    """

    cases: secants.Cases
    units: dict[str, list[Reacted]]
    scenes: dict[str, Scene]
    free_loads: Floats
    made: dict[str, tuple[Floats, Floats]]

    @property
    def hub(self) -> Floats:
        """(m, 6) loads at the hub."""
        return self.cases.hub.values

    @property
    def finest(self) -> dict[str, Reacted]:
        """The bonded bearing on the finest mesh, by housing."""
        return {key: meshes[-1] for key, meshes in self.units.items()}

    @property
    def both(self) -> list[tuple[str, int]]:
        """Housing and component of each moment."""
        return [(key, a) for key in self.units for a in PLANES]

    @cached_property
    def found(self) -> dict[tuple[str, int], secant_stiffness.Secant]:
        """Secant of each moment, by housing and component."""
        return {(key, a): self.finest[key].secant(a) for key, a in self.both}

    @cached_property
    def parts(self) -> dict[tuple[str, int], secant_stiffness.Parts]:
        """What each moment follows, by housing and component."""
        return {
            (key, a): secant_stiffness.parts_of(unit.loads, unit.motions, unit.fit.matrix, a)
            for key, unit in self.finest.items()
            for a in PLANES
        }

    @cached_property
    def statements(self) -> dict[tuple[str, int], str]:
        """Whether one torsional spring is the right form, in words."""
        return {at: secant_stiffness.statement(self.found[at], self.parts[at]) for at in self.both}

    @cached_property
    def improvement(self) -> dict[str, dict[str, Mapping[str, float]]]:
        """Errors of beams by housing and form of their spring."""
        return {key: secants.beam_errors(unit, self.hub) for key, unit in self.finest.items()}

    @property
    def moment(self) -> float:
        """Largest moment on the spherical bearing [N m]."""
        return float(np.abs(self.free_loads[:, 3:]).max())


def band_of(meshes: list[Reacted], figure: Callable[[Reacted], float]) -> float | None:
    """Three times the distance of two meshes (the factor for two, Roache 1994)."""
    if len(meshes) < 2:
        return None
    coarse, fine = (figure(unit) for unit in meshes)
    return 3.0 * abs(float(fine) - float(coarse))


def couplings(key: str, a: int, found: Any, parts: Any) -> list[Record]:
    """What scatters most of a moment beside its own rotation."""
    return [
        {
            "housing": TITLES[key],
            "moment": FORCES[a],
            "secant [MN m/rad]": found.stiffness / 1e6,
            "scatter [%]": 100.0 * found.scatter,
            "also follows": FORCES[j] if j < 6 else "nothing on the bearing",
            "arm [m; of a moment -]": float(parts.arms[j]) if j < 6 else None,
            "size [%]": 100.0 * float(parts.sizes[j]),
            "share of the scatter [%]": 100.0 * float(parts.shares[j]),
        }
        for j in np.argsort(-np.abs(parts.shares))[:TERMS]
    ]


def check_scatter(page: Page, key: str, meshes: list[Reacted], shares: Floats) -> None:
    """Scatter about y at the axis and at the elastic centre, and what it is shared among."""
    unit = meshes[-1]
    page.equals(
        f"{TITLES[key]}: scatter of K_R about y over the load cases, against the lean "
        "K_51 / K_11 times the thrust [%]",
        100.0 * secants.vertical_scatter(unit),
        100.0 * secants.predicted_scatter(unit),
        within=0.1,
        why="seat average and condensed stiffness agree to a tenth",
        source="condensed 6x6 stiffness from unit loads without a gearbox: "
        "My = theta / C_55 + (K_51 / K_11) Fx",
        measure="stiffness",
        band=band_of(meshes, lambda u: 100.0 * secants.vertical_scatter(u)),
    )
    page.at_most(
        f"{TITLES[key]}: scatter of K_R about y at the elastic centre [%]",
        100.0 * secants.scatter_at_centre(unit),
        100.0 * secant_stiffness.SCATTERS,
        why="from there on a single spring is called the wrong form",
        source="at the elastic centre thrust does not tilt: nothing is left to scatter",
        measure="stiffness",
        band=band_of(meshes, lambda u: 100.0 * secants.scatter_at_centre(u)),
    )
    page.equals(
        f"{TITLES[key]}: shares of the scatter about y, their sum",
        float(shares.sum()),
        1.0,
        **round_off(1e5, "terms of either sign, whose sum is a hundredth of them, squared"),
        source="the terms and the rest are all of the moment",
        measure="identity",
        basis="self-consistency",
    )


def check_springs(page: Page, made: dict[str, tuple[Floats, Floats]], coupled: Floats) -> None:
    """What is found of beams on springs of a known form."""
    page.vanishes(
        "beam on a diagonal spring: scatter of K_R over the load cases, worst of three axes",
        max(secant_stiffness.secant(*made["diagonal"], a).scatter for a in (3, 4, 5)),
        within=1e-8,
        why="round-off, of a saddle of some twenty equations with entries from 1e-9 to 1e3",
        source="a linear spring has one stiffness whatever the load",
    )
    fit = secant_stiffness.fitted_spring(*made["coupled"])
    size = np.sqrt(np.outer(coupled.diagonal(), coupled.diagonal()))
    page.vanishes(
        "beam on a coupled spring: matrix fitted to the load cases, worst term over the root of "
        "its diagonals",
        float(np.abs((fit.matrix - coupled) / size).max()),
        within=1e-6,
        why="round-off times the condition of the motions, about 1e4",
        source="the spring that was put in",
        basis="self-consistency",
    )


def secant_traces(key: str, unit: Reacted) -> list[Any]:
    """K_R of each load case at the axis and at the elastic centre."""
    at_axis = unit.secant(4).secants
    at_centre = secant_stiffness.secant(*secants.at_centre(unit), 4).secants
    slope = unit.loads[:, 0] / unit.motions[:, 4] / 1e6
    # seen: each case, at most as many as a page shows without weight
    chosen = np.linspace(0, len(slope) - 1, min(len(slope), 600)).astype(int)
    traces = []
    for where, found in (("axis", at_axis), ("elastic centre", at_centre)):
        kept = chosen[np.isfinite(found[chosen])]
        marker = {"size": 4, "opacity": 0.6}
        name = f"{TITLES[key]}, at the {where}"
        traces.append(trace(name, slope[kept], found[kept] / 1e6, True, marker=marker))
    return traces


def solved(run: Run, page: Page) -> Worked:
    """Three bearings and beams on made-up springs over the load cases."""
    spherical = bearing_scenes.scene_of(run, page, "spherical", coarsen=False)
    bonded = bearing_scenes.scene_of(run, page, "bonded", coarsen=False)
    scenes = {"library": bonded, "tall": secants.tall(bonded, TALL), "spherical": spherical}
    cases = secants.hub_loads(run, EVERY, bonded)
    factors = QUICK_FACTORS if run.quick else FACTORS
    units = {key: secants.series(run, scenes[key], factors[key], cases) for key in factors}
    with run.step("spherical"):
        free_loads, _, _ = secants.reacted(run, spherical, factors["tall"][-1], cases.hub)
    coupled = units["library"][-1].stiffness
    springs = {"diagonal": np.diag(np.diag(coupled)), "coupled": coupled}
    with run.step("springs of a known form"):
        made = {
            form: secants.on_beam(bonded, stiffness, cases.hub.values)
            for form, stiffness in springs.items()
        }
    return Worked(cases, units, scenes, free_loads, made)


def check(page: Page, work: Worked) -> None:
    """Springs of a known form, scatter of both housings, the remedy, and the spherical bearing."""
    with page.of(None):
        check_springs(page, work.made, work.finest["library"].stiffness)
    for key, meshes in work.units.items():
        with page.of(work.scenes[key]):
            check_scatter(page, key, meshes, work.parts[key, 4].shares)
    check_remedy(page, work)
    with page.of(work.scenes["spherical"]):
        page.vanishes(
            "spherical bearing: largest moment over the largest at the hub",
            float(work.moment / np.abs(work.hub[:, 3:]).max()),
            within=1e-6,
            why="accuracy of the solution; the nodal normals of the raceway meet at its centre to "
            "the curved mesh's order",
            source="a sphere that slides carries no moment: K_R is zero in all load cases",
        )


def check_remedy(page: Page, work: Worked) -> None:
    """The coupling that is named takes most of the error of the beam's moment away."""
    tall = work.improvement["tall"]
    # with loads of little thrust the beam's own error would be all that there is to see
    if tall[SINGLE][OF_FORM] <= 2.0 * tall[FULL]["My"]:
        return

    def remaining(unit: Reacted) -> float:
        errors = secants.beam_errors(unit, work.hub)
        return errors[LEAN]["My"] / errors[SINGLE]["My"]

    with page.of(work.scenes["tall"]):
        page.at_most(
            f"{TITLES['tall']}: error of the beam's My with the coupling over that with a "
            "single spring",
            tall[LEAN]["My"] / tall[SINGLE]["My"],
            0.5,
            why="more than half of the error is due to the spring's form, or naming it was idle",
            source="what the secant's scatter is due to is put back",
            measure="reaction",
            band=band_of(work.units["tall"], remaining),
        )


def answer(page: Page, work: Worked, centre: Mapping[str, float]) -> None:
    """Whether one spring is the right form, where it is, and what that does to a beam."""
    library, tall = work.improvement["library"], work.improvement["tall"]
    lean = "scatter of K_R about y over the load cases, against the lean K_51 / K_11 times the "
    lean += "thrust"
    at_centre = "scatter of K_R about y at the elastic centre"
    scatter = page.judged(f"{TITLES['library']}: {lean}")
    remaining = page.judged(f"{TITLES['library']}: {at_centre}")
    wrong = scatter.value > 100.0 * secant_stiffness.SCATTERS
    page.answer(
        "Is one torsional stiffness K_R enough to describe a main bearing in its housing?",
        f"One K_R at the shaft's axis is {'not enough' if wrong else 'enough'}: it varies by "
        f"{certain_value(scatter)} between load cases; taken about a point "
        f"{-centre['library']:.2f}\u00a0m below, by {certain_value(remaining)}.",
        [
            page.judged(f"{TITLES['library']}: {lean}", "scatter of K_R at the axis", "predicted"),
            page.judged(
                f"{TITLES['library']}: {at_centre}", "scatter of K_R at the elastic centre"
            ),
            page.judged(
                f"{TITLES['tall']}: {lean}",
                "scatter of K_R at the axis, tall pedestal",
                "predicted",
            ),
            page.judged(
                f"{TITLES['tall']}: {at_centre}",
                "scatter of K_R at the elastic centre, tall pedestal",
            ),
            page.value("error of My by a single spring, tall pedestal [%]", tall[SINGLE]["My"]),
            page.value("error of My with the coupling, tall pedestal [%]", tall[LEAN]["My"]),
        ],
        hero=HERO,
        cautions=[
            "The elastic centre is the point below the axis where thrust does not tilt the "
            f"housing; tall means {TITLES['tall']}.",
        ],
        claim="does not hold" if wrong else "holds",
    )
    page.say(
        f"{TITLES['library'].capitalize()}: {work.statements['library', 4]}.",
        f"{TITLES['tall'].capitalize()}: {work.statements['tall', 4]}.",
        f"In the beam model the named coupling takes the error of My from {tall[SINGLE]['My']:.2g} "
        f"to {tall[LEAN]['My']:.2g} % for the tall pedestal, and the full 6x6 to "
        f"{tall[FULL]['My']:.2g} %; for the scene's housing from {library[SINGLE]['My']:.2g} to "
        f"{library[LEAN]['My']:.2g} %: there the form of the spring does "
        f"{library[SINGLE][OF_FORM]:.2g} %, and what is left is the beam's.",
    )


def secant_section(page: Page, work: Worked) -> None:
    """The secant of each load case."""
    page.section("The secant over load cases")
    page.text(work.cases.statement)
    left_out = float(np.isnan(work.found["library", 4].secants).mean())
    page.text(
        "K_R is level at the elastic centre; at the axis it is a line whose slope is the arm of "
        f"the thrust. Cases that turn the bearing by less than {secant_stiffness.MIN_ROTATION:g} "
        f"of the root mean square ({100 * left_out:.0f} %) have no secant and are not shown; in "
        "scatter and stiffness they count."
    )
    page.chart(
        HERO,
        [line for key, unit in work.finest.items() for line in secant_traces(key, unit)],
        "Fx over rotation about y [MN/rad]",
        "My / rotation [MN m/rad]",
    )
    for key, a in work.both:
        page.text(f"{TITLES[key].capitalize()}, {PLANES[a]}: {work.statements[key, a]}.")


def coupling_section(page: Page, work: Worked) -> None:
    """What a moment follows beside its own rotation, and how far one spring holds."""
    page.section("Which coupling breaks it")
    page.table(
        "What a moment follows beside its own rotation, by the 6x6 spring fitted to the load "
        "cases, M_a = theta_a / C_aa - sum C_aj R_j / C_aa: each term less its part in proportion "
        f"to the rotation, which scatters nothing; the {TERMS} that scatter most. Size: root mean "
        "square over that of the moment. Share: of the scatter",
        [
            row
            for key, a in work.both
            for row in couplings(key, a, work.found[key, a], work.parts[key, a])
        ],
    )
    page.table(
        "How far one spring at one point holds: what the fitted 6x6 leaves unexplained of each "
        "load [%]. It need not be symmetric, since loads from the hub and from the gearbox press "
        "on the seat in different places",
        [
            {
                "housing": TITLES[key],
                "independent motions": unit.fit.motions,
                "asymmetry [%]": 100.0 * unit.fit.asymmetry,
            }
            | {
                f"{c} [%]": 100.0 * float(v)
                for c, v in zip(FORCES, unit.fit.unexplained, strict=True)
            }
            for key, unit in work.finest.items()
        ],
    )


def remedy_section(page: Page, work: Worked) -> None:
    """Beams on springs of several forms, and springs that must not scatter."""
    page.section("The remedy in a beam model")
    page.table(
        "Root mean square error of a Timoshenko beam against the assembly of solids over the load "
        "cases, over the root mean square of each reaction of the main bearing [%]. Stiffnesses "
        "from unit loads without a gearbox, not fitted to the load cases, but for the secant",
        [
            {"housing": TITLES[key], "spring": form}
            | {f"{q} [%]": by[q] for q in QUANTITIES}
            | {"My, against the beam on the full 6x6 [%]": by[OF_FORM]}
            for key, forms in work.improvement.items()
            for form, by in forms.items()
        ],
    )
    page.text(
        "A program that takes no 6x6 matrix gets the same from a diagonal spring at the elastic "
        "centre, tied to the shaft by a rigid arm. What the full matrix leaves is the beam's own: "
        "plane sections, and no ring on the shaft. Where that is as large as what the form of the "
        "spring does (last column), the two may cancel, and a better spring gives no better moment."
    )
    page.section("Where K_R must not scatter")
    page.table(
        "Springs of a known form on the same shaft under the same loads: scatter of the secant [%]",
        [
            {"spring": form}
            | {
                f"about {axis}": 100.0 * secant_stiffness.secant(loads, motions, a).scatter
                for a, axis in ((3, "x"), (4, "y"), (5, "z"))
            }
            for form, (loads, motions) in work.made.items()
        ],
    )
    page.text(
        "The spherical bearing carries no moment in any load case (largest "
        f"{work.moment:.2g} N m): its K_R is zero but for round-off."
    )


@case(
    "K_R as a secant over load cases, and the coupling that makes it scatter",
    source="Stirling 2023, PhD thesis, section 3.3.1, Eq 3.20",
    settings={
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Secants of three bearings and of made-up springs, and the beams that follow from them."""
    work = solved(run, page)
    check(page, work)
    centre = {key: secant_stiffness.elastic_centre(u.stiffness) for key, u in work.finest.items()}
    answer(page, work, centre)
    secant_section(page, work)
    coupling_section(page, work)
    remedy_section(page, work)
    shown.assume(page, work.scenes["library"])
    page.data(
        "secant",
        {
            f"{key} {FORCES[a]}": {"K_R": f.stiffness, "scatter": f.scatter}
            for (key, a), f in work.found.items()
        },
    )
    page.data("statements", {f"{key} {FORCES[a]}": s for (key, a), s in work.statements.items()})
    page.data("beam errors", work.improvement)
    page.data("elastic centre", centre)
