"""What holds for any shaft, support and load: balance, reciprocity, monotony and scaling.

Random shafts of cheap models: beams, meridians, and blocks of solid elements.
"""

from dataclasses import replace

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.interfaces.constraints import fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator.loads import traction_loads
from fe_drivetrain.elasticity.revolution.rigid_seats import end_stiffness
from fe_drivetrain.elasticity.solve.solid import Static, solve_solid
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.beam.shaft import shaft_stiffness, unit_load_response

#: The few thousand roundings of a small dense system, amplified by its conditioning: springs from
#: 1e5 N/m to rigid on shafts of 1e6 to 1e11 N/m.
ROUNDING = 1e-7


def log(low: float, high: float) -> st.SearchStrategy[float]:
    """Between two powers of ten, each decade equally."""
    return st.floats(low, high).map(lambda x: 10.0**x)


materials = st.builds(
    Material,
    youngs_modulus=log(9.0, 12.0),
    poisson_ratio=st.floats(-0.3, 0.49),
    density=st.floats(1e3, 1e4),
)


@st.composite
def beams(draw: st.DrawFn) -> Beam:
    """Up to four sections, one of them perhaps a cone, on up to three supports."""
    bore = draw(st.one_of(st.just(0.0), st.floats(0.01, 0.15)))
    diameters = st.floats(0.2, 1.0)
    sections = draw(
        st.lists(
            st.builds(
                BeamSection,
                st.floats(0.1, 2.0),
                diameters,
                st.just(bore),
                outer_diameter_end=st.one_of(st.none(), diameters),
            ),
            min_size=1,
            max_size=4,
        )
    )
    length = sum(s.length for s in sections)
    spring = log(5.0, 11.0)
    any_spring = st.one_of(st.just(0.0), spring)
    places = draw(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=3))
    stiffness = [draw(st.lists(spring, min_size=6, max_size=6))]
    stiffness += [draw(st.lists(any_spring, min_size=6, max_size=6)) for _ in places[1:]]
    supports = [
        Support(f"s{k}", share * length, k_s)
        for k, (share, k_s) in enumerate(zip(places, stiffness, strict=True))
    ]
    return Beam(sections, supports, material=draw(materials), shear=draw(st.booleans()))


def compliance(beam: Beam) -> tuple[Floats, Floats]:
    """Stations, and motions there for unit loads there."""
    stations = np.linspace(0.0, beam.length, 4)
    found = unit_load_response(beam, stations, stations).displacement
    return stations, found.reshape(24, 24)


def scaled(C: Floats, size: Floats | None = None) -> Floats:
    """With a diagonal of one (or of another's): metres and radians in the same way."""
    root = np.sqrt(np.diag(C) if size is None else size)
    return np.asarray(C / np.outer(root, root))


def never_softer(before: Floats, after: Floats, tolerance: float) -> None:
    """No load does more work after than before: the difference has no negative eigenvalue."""
    size = np.diag(before)
    change = scaled(before, size) - scaled(after, size)
    assert np.linalg.eigvalsh((change + change.T) / 2.0).min() >= -tolerance


# --- beams ---------------------------------------------------------------------------------------


@given(beams(), st.lists(st.floats(-1.0, 1.0), min_size=24, max_size=24))
def test_reactions_of_a_beam_balance_loads_and_weight(beam: Beam, factors: list[float]) -> None:
    stations = np.linspace(0.0, beam.length, 4)
    loads = np.reshape(factors, (4, 6)) * 1e6
    gravity = np.array([0.3, -2.0, -9.81])
    found = unit_load_response(beam, stations).solution(loads, gravity)
    supports = np.array([s.x for s in beam.supports])
    force = found.reactions[:, :3].sum(axis=0)
    moment = found.reactions[:, 3:].sum(axis=0) + _moments(supports, found.reactions[:, :3])
    ends, (abscissa, weight) = beam.ends, np.polynomial.legendre.leggauss(3)
    mass, first_moment = 0.0, 0.0
    for section, x0 in zip(beam.sections, ends[:-1], strict=True):
        assert isinstance(section, BeamSection)
        share = (abscissa + 1.0) / 2.0
        (d0, d1), (b0, b1) = section.end_diameters
        outer, inner = d0 + (d1 - d0) * share, b0 + (b1 - b0) * share
        line = beam.material.density * np.pi / 4.0 * (outer**2 - inner**2)
        line = line * weight * section.length / 2.0
        mass += line.sum()
        first_moment += (line * (x0 + share * section.length)).sum()
    size = np.abs(loads).sum() + mass * 10.0
    applied = loads[:, :3].sum(axis=0) + mass * gravity
    np.testing.assert_allclose(force, applied, rtol=0, atol=ROUNDING * size)
    turning = loads[:, 3:].sum(axis=0) + _moments(stations, loads[:, :3])
    turning = turning + np.array([0.0, -gravity[2], gravity[1]]) * first_moment
    arm = max(1.0, beam.length)
    np.testing.assert_allclose(moment, turning, rtol=0, atol=ROUNDING * size * arm)


def _moments(x: Floats, forces: Floats) -> Floats:
    """About the origin, of forces at stations on the x axis."""
    arms = np.column_stack([x, 0.0 * x, 0.0 * x])
    return np.asarray(np.cross(arms, forces).sum(axis=0))


@given(beams())
def test_a_beam_is_reciprocal_and_costs_energy(beam: Beam) -> None:
    """Maxwell and Betti: what load a does at b, load b does at a."""
    _, C = compliance(beam)
    unit = scaled(C)
    np.testing.assert_allclose(unit, unit.T, rtol=0, atol=ROUNDING)
    assert np.linalg.eigvalsh((unit + unit.T) / 2.0).min() >= -ROUNDING


@given(beams(), st.integers(0, 5), log(-1.0, 6.0), st.booleans())
def test_a_stiffer_spring_never_softens_a_beam(
    beam: Beam, direction: int, factor: float, rigid: bool
) -> None:
    first, *others = beam.supports
    stiffness = np.diag(np.asarray(first.stiffness)).copy()
    stiffness[direction] = np.inf if rigid else stiffness[direction] * (1.0 + factor)
    stiffer = replace(beam, supports=[Support("s0", first.x, stiffness), *others])
    never_softer(compliance(beam)[1], compliance(stiffer)[1], ROUNDING)


@given(beams(), st.data())
def test_more_material_never_softens_a_beam(beam: Beam, data: st.DataObject) -> None:
    which = data.draw(st.integers(0, len(beam.sections) - 1))
    section = beam.sections[which]
    assert isinstance(section, BeamSection)
    by = data.draw(st.floats(1e-6, 1.0))
    thicker = replace(
        section,
        outer_diameter=section.outer_diameter + by,
        outer_diameter_end=section.end_diameters[0][1] + by,
        inner_diameter=section.inner_diameter * data.draw(st.floats(0.0, 1.0)),
        inner_diameter_end=None,
    )
    sections = [thicker if k == which else s for k, s in enumerate(beam.sections)]
    never_softer(compliance(beam)[1], compliance(replace(beam, sections=sections))[1], ROUNDING)


@given(beams(), log(-2.0, 2.0), log(-1.0, 1.0))
def test_a_beam_scales_with_its_modulus_and_its_size(
    beam: Beam, modulus: float, size: float
) -> None:
    """Forces over lengths scale with E s, moments over angles with E s^3."""
    assume(1e6 <= beam.material.youngs_modulus * modulus <= 1e13)
    material = beam.material.model_copy(
        update={"youngs_modulus": beam.material.youngs_modulus * modulus}
    )
    by = modulus * np.array([size] * 3 + [size**3] * 3)
    supports = [
        Support(s.name, s.x * size, np.diag(np.asarray(s.stiffness)) * by) for s in beam.supports
    ]
    sections = []
    for s in beam.sections:
        assert isinstance(s, BeamSection)
        end = s.outer_diameter_end
        sections.append(
            BeamSection(
                s.length * size,
                s.outer_diameter * size,
                s.inner_diameter * size,
                outer_diameter_end=None if end is None else end * size,
            )
        )
    other = Beam(sections, supports, material=material, shear=beam.shear)
    units = np.tile([1.0] * 3 + [size] * 3, 4)
    found = compliance(other)[1] * np.outer(units, units) * modulus * size
    expected = compliance(beam)[1]
    np.testing.assert_allclose(
        scaled(found, np.diag(expected)), scaled(expected), rtol=0, atol=ROUNDING
    )


@given(beams())
def test_a_bore_that_closes_is_no_bore(beam: Beam) -> None:
    """The area of a bore of 1e-6 m is 2.5e-11 of that of the thinnest shaft."""

    def bored(diameter: float) -> Floats:
        sections = [replace(s, inner_diameter=diameter) for s in beam.sections]  # type: ignore[type-var]
        return compliance(replace(beam, sections=sections))[1]

    solid = bored(0.0)
    np.testing.assert_allclose(
        scaled(bored(1e-6), np.diag(solid)), scaled(solid), rtol=0, atol=ROUNDING
    )


@given(beams(), st.floats(0.05, 0.95))
def test_where_a_beam_is_cut_changes_nothing(beam: Beam, share: float) -> None:
    first, *others = beam.sections
    assert isinstance(first, BeamSection)
    (d0, d1), _ = first.end_diameters
    middle = d0 + share * (d1 - d0)
    halves = [
        replace(first, length=share * first.length, outer_diameter_end=middle),
        replace(
            first,
            length=(1.0 - share) * first.length,
            outer_diameter=middle,
            outer_diameter_end=d1,
        ),
    ]
    expected = compliance(beam)[1]
    found = compliance(replace(beam, sections=[*halves, *others]))[1]
    np.testing.assert_allclose(
        scaled(found, np.diag(expected)), scaled(expected), rtol=0, atol=ROUNDING
    )


@given(materials, st.floats(0.1, 5.0), st.floats(0.05, 2.0), st.floats(0.0, 0.98))
def test_torsional_stiffness_of_a_beam_is_that_of_saint_venant(
    material: Material, length: float, diameter: float, bore: float
) -> None:
    beam = Beam([BeamSection(length, diameter, bore * diameter)], [], material=material)
    J = np.pi / 32.0 * diameter**4 * (1.0 - bore**4)
    K = shaft_stiffness(beam, 0.0, length)
    np.testing.assert_allclose(K[9, 9], material.shear_modulus * J / length, rtol=1e-11)


# --- the meridian --------------------------------------------------------------------------------


@st.composite
def shafts(draw: st.DrawFn) -> Shaft:
    """Stepped and conical shafts, bored or not."""
    bore = draw(st.sampled_from([0.0, 0.0, 0.05, 0.12]))
    diameters = st.integers(20, 60).map(lambda d: d / 100.0)
    sections = draw(
        st.lists(
            st.builds(
                Section,
                length=st.integers(20, 80).map(lambda x: x / 100.0),
                outer_diameter=diameters,
                inner_diameter=st.just(bore),
                outer_diameter_end=st.one_of(st.none(), diameters),
            ),
            min_size=1,
            max_size=2,
        )
    )
    return Shaft(front=0.0, sections=tuple(sections))


def ends(shaft: Shaft, material: Material) -> Floats:
    return end_stiffness(shaft, material, 0.2, order=4, layers=1, per_fillet=3)


few = settings(max_examples=max(6, settings.default.max_examples // 5))  # type: ignore[union-attr]


@few
@given(shafts(), materials)
def test_forces_on_the_ends_of_a_shaft_balance_for_any_motion(
    shaft: Shaft, material: Material
) -> None:
    """Symmetric, blind to rigid motions, balanced, and otherwise never negative."""
    K = ends(shaft, material)
    rigid = np.vstack([np.eye(6), np.eye(6)])
    rigid[8, 4], rigid[7, 5] = -shaft.length, shaft.length
    size = np.sqrt(np.diag(K))
    unit = K / np.outer(size, size)
    np.testing.assert_allclose(unit, unit.T, rtol=0, atol=1e-9)
    np.testing.assert_allclose((K @ rigid) / np.outer(size, size[:6]), 0.0, atol=1e-8)
    values = np.linalg.eigvalsh((unit + unit.T) / 2.0)
    assert np.abs(values[:6]).max() < 1e-8
    assert values[6] > 1e-6


@few
@given(shafts(), materials, log(-2.0, 2.0), log(-1.0, 1.0))
def test_a_shaft_scales_with_its_modulus_and_its_size(
    shaft: Shaft, material: Material, modulus: float, size: float
) -> None:
    assume(1e6 <= material.youngs_modulus * modulus <= 1e13)
    larger = Shaft(
        front=0.0,
        sections=tuple(
            Section(
                length=s.length * size,
                outer_diameter=s.outer_diameter * size,
                inner_diameter=s.inner_diameter * size,
                outer_diameter_end=None
                if s.outer_diameter_end is None
                else s.outer_diameter_end * size,
            )
            for s in shaft.sections
        ),
    )
    other = material.model_copy(update={"youngs_modulus": material.youngs_modulus * modulus})
    found = end_stiffness(larger, other, 0.2 * size, order=4, layers=1)
    units = np.tile([1.0] * 3 + [size] * 3, 2)
    expected = end_stiffness(shaft, material, 0.2, order=4, layers=1)
    root = np.sqrt(np.diag(expected))
    # the same mesh but for the mesher's own tolerances
    np.testing.assert_allclose(
        found / np.outer(units, units) / (modulus * size) / np.outer(root, root),
        expected / np.outer(root, root),
        rtol=0,
        atol=1e-3,
    )


@few
@given(shafts(), materials, st.integers(0, 1), st.floats(0.05, 0.5))
def test_more_material_never_softens_a_shaft(
    shaft: Shaft, material: Material, which: int, by: float
) -> None:
    """To the error of so coarse a mesh: 1 %, its elements being of fourth order."""
    sections = list(shaft.sections)
    section = sections[which % len(sections)]
    sections[which % len(sections)] = section.model_copy(
        update={
            "outer_diameter": section.outer_diameter + by,
            "outer_diameter_end": section.end_diameter + by,
        }
    )
    thicker = Shaft(front=0.0, sections=tuple(sections))
    before, after = (np.linalg.inv(ends(s, material)[6:, 6:]) for s in (shaft, thicker))
    never_softer(before, after, 0.01)


@few
@given(materials, st.floats(0.2, 2.0), st.floats(0.1, 1.0), st.sampled_from([0.0, 0.3, 0.7]))
def test_torsional_stiffness_of_a_shaft_is_that_of_saint_venant(
    material: Material, length: float, diameter: float, bore: float
) -> None:
    section = Section(length=length, outer_diameter=diameter, inner_diameter=bore * diameter)
    K = ends(Shaft(front=0.0, sections=(section,)), material)
    J = np.pi / 32.0 * (diameter**4 - section.inner_diameter**4)
    np.testing.assert_allclose(K[9, 9], material.shear_modulus * J / length, rtol=1e-9)


@few
@given(materials, st.floats(0.3, 1.0), st.floats(0.2, 0.6))
def test_a_bore_that_closes_is_no_bore_in_a_shaft(
    material: Material, length: float, diameter: float
) -> None:
    """The stress round a thin bore is large, but in an area of 1e-4 of the section."""
    solid, bored = (
        ends(
            Shaft(
                front=0.0,
                sections=(Section(length=length, outer_diameter=diameter, inner_diameter=bore),),
            ),
            material,
        )
        for bore in (0.0, 0.01 * diameter)
    )
    size = np.sqrt(np.diag(solid))
    difference = (bored - solid) / np.outer(size, size)
    assert np.abs(difference).max() < 2e-3
    never_softer(np.linalg.inv(bored[6:, 6:]), np.linalg.inv(solid[6:, 6:]), 1e-3)


# --- solids --------------------------------------------------------------------------------------


@st.composite
def maps(draw: st.DrawFn) -> Floats:
    """A box of any proportions, sheared: (3, 3)."""
    edges = draw(st.lists(st.floats(0.3, 3.0), min_size=3, max_size=3))
    shear = draw(st.lists(st.floats(-0.4, 0.4), min_size=3, max_size=3))
    A = np.diag(edges)
    A[0, 1], A[0, 2], A[1, 2] = shear
    return A


def loaded(A: Floats, material: Material, nodes: int, divisions: int) -> tuple[Floats, Static]:
    """Forces (n, 6) on a block that is held at one face and loaded at another, and what they do."""
    block = brick((divisions,) * 3, nodes, lambda x: x @ A.T)
    n = 3 * len(block.points)
    columns = []
    for axis in np.eye(3):
        columns.append(traction_loads(block.points, block.faces["x1"], axis))
        columns.append(
            traction_loads(block.points, block.faces["y0"], lambda x, _, a=axis: x[:, :1] * a)
        )
    F = np.column_stack(columns)
    held = fixed("clamp", block.face_nodes("x0"), n)
    return F, solve_solid(block.points, block.cells, material.lame, [held], F, method="superlu")


kinds = st.sampled_from([4, 8, 10, 20, 27])


@few
@given(maps(), materials, kinds)
def test_reactions_of_a_solid_balance_its_loads(A: Floats, material: Material, nodes: int) -> None:
    F, found = loaded(A, material, nodes, 1)
    points = brick((1,) * 3, nodes, lambda x: x @ A.T).points
    forces = (F + found.reactions["clamp"]).reshape(len(points), 3, -1)
    size = np.abs(F).sum()
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-9 * size)
    moments = np.cross(points[:, None], forces.transpose(0, 2, 1)).sum(axis=0)
    np.testing.assert_allclose(moments, 0.0, atol=1e-9 * size * np.abs(points).max())


@few
@given(maps(), materials, kinds, log(-2.0, 2.0))
def test_a_solid_is_reciprocal_and_as_stiff_as_its_modulus(
    A: Floats, material: Material, nodes: int, modulus: float
) -> None:
    F, found = loaded(A, material, nodes, 1)
    work = F.T @ found.u
    unit = scaled(work)
    np.testing.assert_allclose(unit, unit.T, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.energy, np.diag(work) / 2.0, rtol=1e-9)
    assume(1e6 <= material.youngs_modulus * modulus <= 1e13)
    other = material.model_copy(update={"youngs_modulus": material.youngs_modulus * modulus})
    _, stiffer = loaded(A, other, nodes, 1)
    size = np.abs(found.u).max()
    np.testing.assert_allclose(stiffer.u * modulus, found.u, rtol=0, atol=1e-8 * size)


@few
@given(maps(), materials, kinds)
def test_a_finer_mesh_of_a_solid_is_never_stiffer(
    A: Floats, material: Material, nodes: int
) -> None:
    """Ritz: it holds all that the coarse one can do, its elements being cut in eight."""
    (F, coarse), (F_fine, fine) = (loaded(A, material, nodes, k) for k in (1, 2))
    never_softer(F_fine.T @ fine.u, F.T @ coarse.u, 1e-9)


@few
@given(maps(), materials, kinds, st.floats(0.01, 10.0))
def test_a_stiffer_material_never_softens_a_solid(
    A: Floats, material: Material, nodes: int, more: float
) -> None:
    """Of a larger shear modulus at the same bulk modulus, too."""
    lam, mu = material.lame
    bulk = lam + 2.0 / 3.0 * mu
    mu_more = mu * (1.0 + more)
    nu = (3.0 * bulk - 2.0 * mu_more) / (6.0 * bulk + 2.0 * mu_more)
    modulus = 9.0 * bulk * mu_more / (3.0 * bulk + mu_more)
    stiffer = Material(youngs_modulus=modulus, poisson_ratio=nu, density=0.0)
    F, before = loaded(A, material, nodes, 1)
    _, after = loaded(A, stiffer, nodes, 1)
    never_softer(F.T @ before.u, F.T @ after.u, 1e-9)
