"""Thick curved bar, as of a hook, in bending and under an end force, against exact solutions."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

INNER, OUTER = 0.1, 0.3  # m
MOMENT = 1e5  # N, per width
FORCE = 1e6  # N/m, per width
E, NU = 200e9, 0.3

#: Elements through the height.
DIVISIONS = (4, 8, 16)
QUICK_DIVISIONS = (3, 6, 12)


def run(run: Run) -> Any:
    """Solve a quarter circle of the bar under the exact tractions on its ends."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.interfaces import held_freedoms
    from fe_drivetrain.operator import nodal_stresses, traction_loads
    from fe_drivetrain.report import Measure, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.plane_rings import (
        CurvedBar,
        plane_strain,
    )
    from fe_drivetrain.validation.ring_solids import (
        node_at,
        on_plane,
        plane_strain_hold,
        polar_stresses,
        polar_traction,
        ring_sector,
    )

    bar = CurvedBar(INNER, OUTER)
    plane = plane_strain(E, NU)
    lame = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame
    quarter = 0.5 * np.pi

    def bending(r: Any, t: Any) -> Any:
        return (*bar.bending(r, MOMENT), np.zeros_like(r))

    def end_force(r: Any, t: Any) -> Any:
        return bar.end_force(r, t, FORCE)

    def solve(n: int) -> tuple[dict[str, float], Any]:
        width = (OUTER - INNER) / n
        block = ring_sector(INNER, OUTER, width, quarter, (n, 2 * n, 1))
        points, size = block.points, block.points.size
        here, there = (
            [node_at(points, [0.0, r * np.cos(t), r * np.sin(t)]) for r in (INNER, OUTER)]
            for t in (0.0, quarter)
        )
        middle = node_at(points, [0.0, *(0.5 * (INNER + OUTER) * np.array([np.cos(quarter), 1.0]))])
        flat = plane_strain_hold(block)

        def answer(loaded: tuple[str, ...], stresses: Any, held: list[Any]) -> Any:
            traction = polar_traction(stresses)
            F = np.zeros(size)
            for face in loaded:
                F += traction_loads(points, block.faces[face], traction)
            static = solve_solid(points, block.cells, lame, [flat, *held], F)
            s = nodal_stresses(points, block.cells, static.u[:, 0], lame)
            return static, polar_stresses(s, points)

        # In bending, sections stay plane: that at t = 0 is held on its plane.
        symmetric = on_plane("symmetry", block.face_nodes("y0"), [0.0, 0.0, 1.0], size)
        still = held_freedoms("translation", np.array([3 * here[0] + 1]), size)
        moment, bent = answer(("y1",), bending, [symmetric, still])
        u = moment.u[:, 0].reshape(-1, 3)
        # Under the force they warp: both ends carry the exact tractions, and three freedoms at
        # t = 90 degrees hold the bar without force.
        three = np.array([3 * middle + 1, 3 * middle + 2, 3 * there[1] + 1])
        support = held_freedoms("support", three, size)
        force, pulled = answer(("y0", "y1"), end_force, [support])
        end = np.flatnonzero(
            (np.abs(points[:, 0]) < 1e-12) & (np.abs(points[:, 1]) < 1e-9) & (points[:, 2] > 0.0)
        )
        end = end[np.argsort(points[end, 2])]
        return {
            "bending: rotation of the ends [mrad]": 1e3
            * float(abs(u[there[1], 1] - u[there[0], 1]) / (OUTER - INNER)),
            "bending: strain energy per width [J/m]": float(moment.energy[0]) / width,
            "bending: hoop stress inside [MPa]": float(bent.hoop[there[0]]) / 1e6,
            "bending: hoop stress outside [MPa]": float(bent.hoop[there[1]]) / 1e6,
            "force: strain energy per width [J/m]": float(force.energy[0]) / width,
            "force: hoop stress inside, t = 90 deg [MPa]": float(pulled.hoop[there[0]]) / 1e6,
        }, (points[end, 2], bent.hoop[end], bent.radial[end])

    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    found: list[dict[str, float]] = []
    profile: Any = None
    for n in divisions:
        with run.step(f"{n} elements through the height"):
            values, profile = solve(n)
            found.append(values)

    rotation = bar.bending_rotation(MOMENT, plane) * quarter
    hoop = bar.bending(np.array([INNER, OUTER]), MOMENT)[1]
    pulled = bar.end_force(np.array(INNER), np.array(quarter), FORCE)[1]
    exact = {
        "bending: rotation of the ends [mrad]": 1e3 * abs(rotation),
        "bending: strain energy per width [J/m]": 0.5 * MOMENT * abs(rotation),
        "bending: hoop stress inside [MPa]": hoop[0] / 1e6,
        "bending: hoop stress outside [MPa]": hoop[1] / 1e6,
        "force: strain energy per width [J/m]": bar.end_force_energy(FORCE, quarter, plane),
        "force: hoop stress inside, t = 90 deg [MPa]": float(pulled) / 1e6,
    }
    h = (OUTER - INNER) / divisions[-1]

    def missed(field: Any, r: float) -> float:
        """What a linear field through the Gauss points misses at the surface, s'' h^2 / 12."""
        step = 1e-3 * INNER
        around = field(np.array([r - step, r, r + step]))
        return float(abs(around[0] - 2.0 * around[1] + around[2]) / step**2 * h**2 / 12.0)

    bent_hoop = lambda r: bar.bending(r, MOMENT)[1] / 1e6  # noqa: E731
    pulled_hoop = lambda r: bar.end_force(r, np.array(quarter), FORCE)[1] / 1e6  # noqa: E731
    misses = {
        "bending: hoop stress inside [MPa]": missed(bent_hoop, INNER),
        "bending: hoop stress outside [MPa]": missed(bent_hoop, OUTER),
        "force: hoop stress inside, t = 90 deg [MPa]": missed(pulled_hoop, INNER),
    }
    sizes = 1.0 / np.array(divisions)
    measures: dict[str, Measure] = {"mrad": "rotation", "J/m": "energy", "MPa": "stress"}
    verdicts = []
    for key, reference in exact.items():
        name, unit = key.rstrip("]").split(" [")
        series = [f[key] for f in found]
        is_stress = key in misses
        verdicts.append(
            judge(
                name,
                series[-1],
                reference,
                tolerance=4.0 * misses[key] if is_stress else 1e-3 if run.quick else 1e-4,
                relative=not is_stress,
                unit=unit,
                source="Golovin 1881; Timoshenko and Goodier 1970, art "
                + ("29 and 31" if name.startswith("bending") else "33"),
                reason=f"four times s'' h^2 / 12 = {misses[key]:.2g} MPa, what a linear stress "
                "through the Gauss points misses at a surface; the element's own error is of "
                "that size"
                if is_stress
                else "(h/r)^4 at the inside of the finest mesh is "
                f"{(h / INNER) ** 4:.0e}, and weighs only there",
                measure=measures[unit],
                band=band_of(sizes, series),
            )
        )

    r = np.linspace(INNER, OUTER, 80)
    radial, hoop_r = bar.bending(r, MOMENT)
    height = OUTER - INNER
    straight = -12.0 * MOMENT * (r - 0.5 * (INNER + OUTER)) / height**3
    last = found[-1]
    inside = "bending: hoop stress inside [MPa]"
    winkler = float(bar.winkler(np.array(INNER), MOMENT)) / 1e6
    plain = straight[0] / 1e6
    return CASE.results(
        run,
        summary=[
            f"A bar with b/a = {OUTER / INNER:g} carries {last[inside]:.3f} MPa inside (exact "
            f"{exact[inside]:.3f}); Winkler's hook is {100 * (winkler / exact[inside] - 1):+.1f} % "
            f"off, a straight beam {100 * (plain / exact[inside] - 1):+.0f} %.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stress across the height, in bending",
                items=[
                    chart(
                        "Hoop and radial stress under end moments",
                        [
                            trace("hoop, exact", r, hoop_r / 1e6),
                            trace("hoop, Winkler", r, bar.winkler(r, MOMENT) / 1e6),
                            trace("hoop, straight beam", r, straight / 1e6),
                            trace("radial, exact", r, radial / 1e6),
                            trace("hoop, nodes", profile[0], profile[1] / 1e6, points=True),
                            trace("radial, nodes", profile[0], profile[2] / 1e6, points=True),
                        ],
                        "radius [m]",
                        "stress [MPa]",
                    ),
                    Table(
                        caption="By mesh: elements through the height",
                        columns=["quantity", *(str(n) for n in divisions), "exact"],
                        rows=[[key, *(f[key] for f in found), exact[key]] for key in exact],
                    ),
                    Text(
                        text="Plane strain, hexahedra of 27 nodes, a quarter circle. The ends "
                        "carry the exact tractions, so no clamp disturbs the stress."
                    ),
                ],
            )
        ],
        figures={"divisions": divisions, "values": found, "exact": exact},
    )


CASE = Case(
    name="verification/curved_beam",
    title="Thick curved bar in bending and under an end force",
    source="Golovin 1881; Timoshenko and Goodier 1970, Theory of Elasticity, art 29 and 33",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
