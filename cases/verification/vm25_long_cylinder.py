"""Long cylinder under pressure and in rotation: verification problem VM25 of Ansys."""

from typing import Any

from fe_drivetrain.cases.verification.units import (
    INCH,
    PSI,
)
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

INNER, INSIDE, OUTER = 4.0 * INCH, 5.43 * INCH, 8.0 * INCH
E, NU = 30e6 * PSI, 0.3
PRESSURE = 30e3 * PSI
#: rho omega^2 of 0.00073 lb s^2/in^4 at 1000 rad/s.
ROTATION = 0.00073e6 * PSI / INCH**2

#: What the manual prints as its targets, in psi and inch.
TARGETS = {
    "pressure: radial displacement, bore": (0.0078666, INCH),
    "pressure: radial stress, bore": (-30000.0, PSI),
    "pressure: radial stress, mid-wall": (-7778.0, PSI),
    "pressure: hoop stress, bore": (50000.0, PSI),
    "pressure: hoop stress, mid-wall": (27778.0, PSI),
    "pressure: hoop stress, outside": (20000.0, PSI),
    "rotation: hoop stress, bore": (40588.0, PSI),
    "rotation: radial stress, r = 5.43 in": (4753.0, PSI),
    "rotation: hoop stress, r = 5.43 in": (29436.0, PSI),
}

SECTOR = 0.2617993877991494  # rad: 15 degrees, between planes of symmetry

#: Elements from the bore to r = 5.43 in, to mid-wall, to the outside.
LEVELS = ((4, 1, 3), (8, 2, 6), (16, 4, 12))


def run(run: Run) -> Any:
    """Solve a sector of the cylinder, and of a thin disc."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.interfaces import held_nodes
    from fe_drivetrain.operator import body_loads, nodal_stresses, pressure, traction_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.plane_rings import (
        Lame,
        Plane,
        Rotating,
        plane_strain,
    )
    from fe_drivetrain.validation.ring_solids import (
        moves_as_one,
        node_at,
        polar_stresses,
        ring_sector,
        sector_symmetry,
    )

    lame = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame
    middle = 0.5 * (INNER + OUTER)
    places = {"bore": INNER, "r = 5.43 in": INSIDE, "mid-wall": middle, "outside": OUTER}
    under = Lame(INNER, OUTER, inside=PRESSURE)
    long = Rotating(INNER, OUTER, ROTATION, plane_strain(E, NU))
    disc = Rotating(INNER, OUTER, ROTATION, Plane(E, NU))

    def centrifugal(x: Any) -> Any:
        return ROTATION * x * [0.0, 1.0, 1.0]

    def solve(level: tuple[int, int, int], free: bool) -> tuple[dict[str, float], Any]:
        """With ends that stay plane, as of a long cylinder; or free, of a thin disc."""
        radii = (INNER, INSIDE, middle, OUTER)
        edges = np.concatenate(
            [
                [0.0],
                *(
                    (np.linspace(a, b, n + 1)[1:] - INNER) / (OUTER - INNER)
                    for a, b, n in zip(radii[:-1], radii[1:], level, strict=True)
                ),
            ]
        )
        n = sum(level)
        width = 0.02 * INCH if free else (OUTER - INNER) / n
        divisions = (n, n // 4, 1)
        block = ring_sector(INNER, OUTER, width, SECTOR, divisions, edges=(edges, None, None))
        size = block.points.size
        held = [
            *sector_symmetry(block, SECTOR),
            held_nodes("middle plane", block.face_nodes("z0"), [0], size),
        ]
        if not free:
            held.append(moves_as_one("plane end", block.face_nodes("z1"), 0, size))
        F = np.column_stack(
            [
                traction_loads(block.points, block.faces["x0"], pressure(PRESSURE)),
                body_loads(block.points, block.cells, centrifugal),
            ]
        )
        static = solve_solid(block.points, block.cells, lame, held, F)
        found = {}
        profiles = []
        for case, u in zip(("pressure", "rotation"), static.u.T, strict=True):
            s = nodal_stresses(block.points, block.cells, u, lame)
            polar = polar_stresses(s, block.points)
            t = 0.5 * SECTOR
            for name, r in places.items():
                node = node_at(block.points, [0.0, r * np.cos(t), r * np.sin(t)])
                found[f"{case}: radial stress, {name}"] = float(polar.radial[node])
                found[f"{case}: hoop stress, {name}"] = float(polar.hoop[node])
                found[f"{case}: radial displacement, {name}"] = float(
                    u[3 * node + 1] * np.cos(t) + u[3 * node + 2] * np.sin(t)
                )
            line = block.face_nodes("y0")
            line = line[block.points[line, 0] == 0.0]
            line = line[np.argsort(block.points[line, 1])]
            profiles.append((block.points[line, 1], polar.radial[line], polar.hoop[line]))
        return found, profiles

    series, discs = [], []
    for level in LEVELS:
        with run.step(f"{sum(level)} elements through the wall"):
            series.append(solve(level, free=False))
            discs.append(solve(level, free=True))

    sizes = 1.0 / np.array([sum(level) for level in LEVELS])
    manual = "Ansys Mechanical APDL verification manual, VM25, targets as in PyMAPDL's example"
    stress_reason = (
        "recovered stress at the bore misses s'' h^2 / 12 = 0.03 % with 16 elements from there to "
        "r = 5.43 in; the manual's figures are rounded at the fifth digit"
    )
    verdicts = []

    def add(
        name: str, key: str, values: Any, reference: float, unit: float, source: str, reason: str
    ) -> None:
        found = [v[key] for v, _ in values]
        is_stress = "stress" in key
        shown = 1e-6 if is_stress else 1e6
        verdicts.append(
            judge(
                name,
                shown * found[-1],
                shown * reference * unit,
                tolerance=2e-3 if is_stress else 1e-4,
                unit="MPa" if is_stress else "µm",
                source=source,
                reason=reason,
                measure="stress" if is_stress else "deflection",
                band=shown * band_of(sizes, found),
            )
        )

    for key, (target, unit) in TARGETS.items():
        if key.startswith("pressure"):
            reason = stress_reason if "stress" in key else "rounding of the manual's fifth digit"
            add(key, key, series, target, unit, manual, reason)
    for key, (target, unit) in TARGETS.items():
        if key.startswith("rotation"):
            add(f"thin disc, {key}", key, discs, target, unit, manual, stress_reason)
    exact = "Timoshenko and Goodier 1970, art 32, with the constants of plane strain"
    for key in ("hoop stress, bore", "radial stress, r = 5.43 in", "hoop stress, r = 5.43 in"):
        component, place = key.split(" stress, ")
        reference = float(getattr(long, component)(np.array(places[place])))
        name = f"long cylinder, rotation: {key}"
        add(name, f"rotation: {key}", series, reference, 1.0, exact, stress_reason)

    key = "rotation: hoop stress, bore"
    apart = 100.0 * (series[-1][0][key] / discs[-1][0][key] - 1.0)
    r = np.linspace(INNER, OUTER, 80)
    profiles = series[-1][1]
    thin = discs[-1][1][1]
    return CASE.results(
        run,
        summary=[
            "Under pressure, every target of the manual is met: the bore opens by "
            f"{series[-1][0]['pressure: radial displacement, bore'] / INCH:.7f} in (0.0078666).",
            "In rotation the manual's targets are those of a thin disc, and a disc meets them; a "
            f"long cylinder, which the problem names, has {apart:.1f} % more hoop stress at the "
            "bore, as its own closed form says.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stress along the radius",
                items=[
                    chart(
                        "Under pressure",
                        [
                            trace("hoop, Lame", r, under.hoop(r) / 1e6),
                            trace("radial, Lame", r, under.radial(r) / 1e6),
                            trace("hoop", profiles[0][0], profiles[0][2] / 1e6, points=True),
                            trace("radial", profiles[0][0], profiles[0][1] / 1e6, points=True),
                        ],
                        "radius [m]",
                        "stress [MPa]",
                    ),
                    chart(
                        "Hoop stress in rotation",
                        [
                            trace("long cylinder, exact", r, long.hoop(r) / 1e6),
                            trace("thin disc, exact", r, disc.hoop(r) / 1e6),
                            trace(
                                "long cylinder", profiles[1][0], profiles[1][2] / 1e6, points=True
                            ),
                            trace("thin disc", thin[0], thin[2] / 1e6, points=True),
                        ],
                        "radius [m]",
                        "hoop stress [MPa]",
                    ),
                    Table(
                        caption="The manual's targets, in its units",
                        columns=["quantity", "target", "long cylinder", "thin disc"],
                        rows=[
                            [key, target, series[-1][0][key] / unit, discs[-1][0][key] / unit]
                            for key, (target, unit) in TARGETS.items()
                        ],
                    ),
                    Text(
                        text="The problem asks for a long cylinder. Under pressure, radial and "
                        "hoop stress have a constant sum, so the ends do not matter. In rotation "
                        "they do: the targets follow from the formula of a thin disc (Timoshenko, "
                        "Strength of Materials II, article 42), and a slice a two-hundredth of its "
                        "wall thick, with free faces, gives them. The ends of a long cylinder "
                        "stay plane and carry no net force."
                    ),
                ],
            )
        ],
        figures={
            "targets": {k: t * u for k, (t, u) in TARGETS.items()},
            "long cylinder": [v for v, _ in series],
            "thin disc": [v for v, _ in discs],
        },
    )


CASE = Case(
    name="verification/vm25_long_cylinder",
    title="Long cylinder under pressure and in rotation (VM25)",
    source="Ansys Mechanical APDL verification manual, VM25 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part II, 1956, p 213 and article 42",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
