"""Superelements: what they check, and every format's round trip."""

from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain import export
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import max_difference
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.reading import (
    change_scene,
    library_component,
    library_scene,
)
from fe_drivetrain.elasticity.solve.condensation import keep_points
from fe_drivetrain.export.from_component import component_superelement
from fe_drivetrain.export.from_scene import (
    shaft_superelement,
    supported_superelement,
    unit_superelement,
)
from fe_drivetrain.export.scene_export import superelement_of
from fe_drivetrain.export.superelement import Origin, Superelement
from fe_drivetrain.export.unit_statement import stated_bound, stated_rollers
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds
from fe_drivetrain.shafts.fidelity.ladder import shaft_level
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft, meridian_shaft
from fe_drivetrain.shafts.fidelity.unit_faces import face_of

pytestmark = pytest.mark.usefixtures("kept_between_runs")

#: What the extra of a format installs.
IMPORTS = {"hdf5": "h5py"}

RIGID_SPRING = {"interface": "spring", "stiffness": ["rigid"] * 6}
GIVEN = {
    "housing": {"stiffness": np.diag([1e9, 1e9, 1e9, 1e8, 1e8, 1e8]).tolist(), "source": "given"}
}
TWO_ROWS = [{"x": -0.05, "contact_angle": 30.0}, {"x": 0.05, "contact_angle": -30.0}]
ROLLERS = {
    "interface": "rollers",
    "rollers": {"count": 40, "stiffness": 4e8, "rows": TWO_ROWS},
}

READABLE = [
    pytest.param(name, marks=[pytest.mark.needs(IMPORTS[f.extra])] if f.extra else [])
    for name, f in export.FORMATS.items()
    if hasattr(export.format_module(name), "read")
]


def random_element(seed: int, mass: bool = True, free: bool = False) -> Superelement:
    """Symmetric matrices of no structure, entries over many orders of magnitude."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 4))
    size = 10.0 ** rng.uniform(-2, 5, 6 * n)
    root, inertia = rng.standard_normal((2, 6 * n, 6 * n))
    K = size[:, None] * (root @ root.T) * size
    K = 0.5 * (K + K.T)
    M = inertia @ inertia.T
    return Superelement(
        f"random_{seed}",
        tuple(f"point_{k}" for k in range(n)),
        rng.uniform(-3, 3, (n, 3)),
        K,
        0.5 * (M + M.T) if mass else None,
        supported=True,
        band=StiffnessBands(0.01, 0.002, 0.03),
        origin=Origin("a scene", "00ff", "2 meridian", "0.1 m", "fe-drivetrain"),
        bound="stiff: a face; of others, the soft one",
        rollers="none (0 of 80)",
    )


@pytest.mark.parametrize("format", READABLE)
@pytest.mark.parametrize(("seed", "mass"), [(0, True), (1, True), (2, False), (3, True)])
def test_round_trip(tmp_path: Path, format: str, seed: int, mass: bool) -> None:
    element = random_element(seed, mass)
    path = tmp_path / f"element{export.FORMATS[format].suffix}"
    export.write_superelement(path, element, format)
    back = export.read_superelement(path, format)
    digits = export.FORMATS[format].digits
    size = np.sqrt(np.outer(element.stiffness.diagonal(), element.stiffness.diagonal()))
    assert np.abs((back.stiffness - element.stiffness) / size).max() <= 10.0**-digits
    if mass and back.mass is not None:
        np.testing.assert_allclose(back.mass, element.mass, rtol=0, atol=30 * 10.0**-digits)
    assert len(back.points) == len(element.points)
    if not export.FORMATS[format].left_out:
        assert back.band == element.band
        assert (back.bound, back.rollers) == (element.bound, element.rollers)


@pytest.mark.parametrize("format", READABLE)
@pytest.mark.parametrize("content", [b"", b"not of any format\n", bytes(range(256)), b"{}"])
def test_a_malformed_file_gets_one_sentence(tmp_path: Path, format: str, content: bytes) -> None:
    path = tmp_path / f"element{export.FORMATS[format].suffix}"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        export.read_superelement(path, format)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("format", READABLE)
def test_a_truncated_file_is_refused(tmp_path: Path, format: str) -> None:
    path = tmp_path / f"element{export.FORMATS[format].suffix}"
    export.write_superelement(path, random_element(5), format)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(InputError):
        export.read_superelement(path, format)


@pytest.mark.parametrize("format", export.FORMATS)
def test_nothing_is_overwritten_unless_told(tmp_path: Path, format: str) -> None:
    path = tmp_path / "there"
    path.write_text("mine")
    with pytest.raises(InputError, match="exists"):
        export.write_superelement(path, random_element(0), format)
    assert path.read_text() == "mine"
    assert [p.name for p in tmp_path.iterdir()] == ["there"]


def test_an_unknown_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="format 'xyz' is unknown: use one of json"):
        export.write_superelement(tmp_path / "a", random_element(0), "xyz")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda K: K + np.triu(np.ones_like(K), 1) * K.max(), "not symmetric"),
        (lambda K: -K, "negative eigenvalue"),
        (lambda K: K[:5, :5], "must be"),
        (lambda K: K * np.nan, "finite"),
    ],
)
def test_what_is_no_stiffness_is_refused(change, message: str) -> None:  # type: ignore[no-untyped-def]
    element = random_element(7)
    with pytest.raises(InputError, match=message):
        Superelement("bad", element.points, element.positions, change(element.stiffness))


@pytest.mark.parametrize("level", [1, 2, 3])
def test_a_free_shaft_has_no_stiffness_at_one_point(level: int) -> None:
    scene = coarse_scene("bonded")
    words = (
        r"a free shaft has no stiffness at one point, hub, .*\(.*gearbox\), .*`what='drivetrain'`"
    )
    with pytest.raises(InputError, match=words):
        superelement_of(scene, "shaft", ["hub"], level)


def test_a_free_component_has_no_stiffness_at_one_point() -> None:
    component = library_component("gearbox_housing")
    name = component.attachments[0].name
    with pytest.raises(InputError, match=rf"free gearbox housing .* {name}, .*`what='supported'`"):
        component_superelement(component, "body", [name], 1)


def test_shaft_of_a_scene_is_free_and_has_its_mass() -> None:
    scene = coarse_scene("bonded")
    element = shaft_superelement(scene, 2, ["hub", "gearbox"])
    assert element.points == ("hub", "gearbox")
    assert element.rigid_error() < 1e-12
    inertia = element.inertia()
    assert inertia is not None
    shaft = scene.shaft
    volume = np.pi / 4 * shaft.sections[0].outer_diameter ** 2 * shaft.length
    assert inertia[0, 0] == pytest.approx(scene.material_of("shaft").density * volume, rel=1e-9)
    assert element.origin.scene_hash == drivetrain_hash(scene)


def test_bands_hold_what_the_next_level_says() -> None:
    """The meridian's band is small; a beam's is what separates it from the meridian."""
    scene = library_scene("stepped_shaft")
    beam, meridian = (shaft_superelement(scene, level, ["hub", "gearbox"]) for level in (1, 2))
    assert beam.band is not None
    assert meridian.band is not None
    for of_meridian, of_beam in zip(meridian.band, beam.band, strict=True):
        assert 0 < of_meridian < 2e-3 < of_beam
    assert beam.band.largest > 0.05
    finer = keep_points(meridian_shaft(scene, 0.25, 5), ["hub", "gearbox"])
    apart = StiffnessBands.of_difference(finer.stiffness, meridian.stiffness)
    for change, half_width in zip(apart, meridian.band, strict=True):
        assert change < half_width
    unit = unit_superelement(coarse_scene("bonded"), "main_bearing")
    assert unit.band is not None
    assert all(0 < half_width < 1 for half_width in unit.band)


def test_a_beam_of_a_thousand_sections_has_no_band_and_says_why() -> None:
    """Cut into short sections of one diameter, it is the same beam."""
    scene = library_scene("stepped_shaft")
    whole = beam_shaft(scene)
    cut = [
        section.model_copy(update={"length": section.length / 500})
        for section in scene.shaft.sections
        for _ in range(500)
    ]
    shaft = scene.shaft.model_copy(update={"sections": tuple(cut)})
    element = shaft_superelement(scene.model_copy(update={"shaft": shaft}), 1)
    assert element.band is None
    assert f"at most 100 sections and there are {len(cut)}" in element.origin.mesh
    assert max_difference(whole.stiffness, element.stiffness) < 1e-8


def test_torsion_of_the_free_shaft_is_g_j_over_l() -> None:
    scene = coarse_scene("bonded")
    element = shaft_superelement(scene, 2, ["hub", "gearbox"])
    section, material = scene.shaft.sections[0], scene.material_of("shaft")
    expected = material.shear_modulus * np.pi / 32 * section.outer_diameter**4 / section.length
    assert element.stiffness[3, 3] == pytest.approx(expected, rel=1e-9)
    assert element.stiffness[3, 9] == pytest.approx(-expected, rel=1e-9)


@pytest.mark.parametrize(
    ("kind", "changes", "bound", "rollers"),
    [
        ("bonded", {}, "stiff: the face to the shaft keeps its shape", "the ring is bonded"),
        ("spherical", {}, "stiff: the face to the shaft keeps its shape", "and no moment"),
        ("spherical", {"interface": "averaged"}, "its face moves on average", "and no moment"),
        ("spherical", {"interface": "rigid"}, "its face keeps its shape", "and no moment"),
        ("bonded", RIGID_SPRING, "its face moves on average", "the joint is rigid"),
        ("bonded", {**RIGID_SPRING, "stiffness": [*["rigid"] * 5, 1e9]}, "on average", "spring of"),
        ("bonded", GIVEN, "taken as it is given", "the ring is bonded"),
        ("bonded", ROLLERS, "stiff: the face", "2 rows of 40, each roller a spring of 4e+08 N/m"),
    ],
)
def test_what_is_stated_of_a_unit_is_that_of_its_joint(
    kind: str, changes: dict[str, object], bound: str, rollers: str
) -> None:
    """A unit has two bounds where another coupling is another solution, and is named so."""
    name = "main_bearing"
    own = {f"bearing_units.{name}.{key}": value for key, value in changes.items()}
    scene = coarse_scene(kind, **own)
    assert bound in stated_bound(scene, [name])
    assert rollers in stated_rollers(scene, [name])
    ways = {face_of(scene, name, True, coupling)[1] for coupling in ("rigid", "averaged")}
    both = len(ways) == 2 and scene.bearing_unit(name).condensed is None
    assert stated_bound(scene, [name]).startswith("stiff:") == both


def test_a_unit_is_written_at_the_bound_that_it_states() -> None:
    scene = coarse_scene("bonded")
    unit, bounds = unit_superelement(scene, "main_bearing"), unit_bounds(scene, "main_bearing")
    assert unit.bound.startswith("stiff:")
    np.testing.assert_array_equal(unit.stiffness, bounds.stiff)
    assert np.linalg.eigvalsh(bounds.stiff - bounds.soft)[0] > 0
    # the band reaches to the soft bound
    assert unit.band is not None
    assert np.all(bounds.stiff - bounds.soft <= unit.band.half_widths(unit.stiffness))


def test_units_that_differ_are_stated_by_name() -> None:
    scene = library_scene("two_bearings")
    first, second = (unit.bearing.name for unit in scene.bearing_units)
    mixed = change_scene(scene, {f"bearing_units.{second}.housing": GIVEN["housing"]})
    said = stated_bound(mixed, [first, second])
    assert said.startswith(f"of {first} ")
    assert f"; of {second} the only one, for the stiffness" in said


def test_supported_drivetrain_and_bearing_unit() -> None:
    scene = coarse_scene("bonded")
    model = shaft_level(scene, 1)
    element = supported_superelement(scene, model, ["hub"], StiffnessBands.uniform(0.01))
    np.testing.assert_allclose(element.stiffness, model.stiffness(["hub"]))
    assert element.supported
    unit = unit_superelement(scene, "main_bearing")
    assert np.linalg.eigvalsh(unit.stiffness)[0] > 0
