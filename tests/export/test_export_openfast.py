"""OpenFAST inputs from the export, read by openfast_io."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from scipy.linalg import eigh

from fe_drivetrain import export
from fe_drivetrain.cases.export.sample_elastodyn import TEXT
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.export.formats import extptfm, subdyn
from fe_drivetrain.export.formats.elastodyn import (
    Torsion,
    read_elastodyn,
    read_torsion,
    write_torsion,
)
from fe_drivetrain.export.formats.statement import commented
from fe_drivetrain.export.formats.torsion import (
    torsional_damping,
    torsional_stiffness,
)
from fe_drivetrain.export.from_scene import shaft_superelement, unit_superelement
from fe_drivetrain.export.superelement import Origin, Superelement

NEW = Torsion(87876717.58333518, 123456.78901234567)
BANDS = StiffnessBands(0.02, 0.001, 0.03)


@pytest.fixture
def elastodyn(tmp_path: Path) -> Path:
    path = tmp_path / "elastodyn.dat"
    path.write_bytes(TEXT.encode())
    return path


def twisted_shaft(stiffness: float) -> Superelement:
    """Two points 2 m apart on x, which resist a relative twist and little else."""
    K = np.zeros((12, 12))
    K[np.ix_([3, 9], [3, 9])] = [[stiffness, -stiffness], [-stiffness, stiffness]]
    return Superelement("shaft", ("a", "b"), np.array([[0.0, 0, 0], [2, 0, 0]]), K)


def test_torsion_of_the_free_shaft_is_the_same_with_points_between() -> None:
    scene = coarse_scene("bonded")
    section, material = scene.shaft.sections[0], scene.material_of("shaft")
    inner = section.inner_diameter
    polar = np.pi / 32 * (section.outer_diameter**4 - inner**4)
    exact = material.shear_modulus * polar / section.length
    for at in (None, ["hub", "gearbox"], ["gearbox", "hub"]):
        element = shaft_superelement(scene, 2, at)
        # exact on quadrilaterals; the condensation rounds
        assert torsional_stiffness(element, "hub", "gearbox") == pytest.approx(exact, rel=1e-9)
        assert torsional_stiffness(element, "gearbox", "hub") == pytest.approx(exact, rel=1e-9)


def test_torsion_needs_a_free_shaft_and_two_points_of_it() -> None:
    unit = unit_superelement(coarse_scene("bonded"), "main_bearing")
    with pytest.raises(InputError, match="supports in it"):
        torsional_stiffness(unit, "main_bearing", "main_bearing")
    with pytest.raises(InputError, match="'c' is not in superelement"):
        torsional_stiffness(twisted_shaft(1.0), "a", "c")
    with pytest.raises(InputError, match="cannot twist relative to itself"):
        torsional_stiffness(twisted_shaft(1.0), "a", "a")
    with pytest.raises(InputError, match="does not resist a twist"):
        torsional_stiffness(twisted_shaft(0.0), "a", "b")


def test_damping_of_the_published_5_mw_turbine() -> None:
    """NREL/TP-500-38060: 5 % of critical of the free-free mode is 6.215e6 N m s/rad.

    Of the rotor's 38 759 228 kg m^2 only the blades' mass is known to a percent or so, of which
    the generator's side leaves a sixteenth in the result; the damper is printed to 4 digits.
    """
    found = torsional_damping(0.05, 867_637_000, 38_759_228, 534.116, 97)
    assert found == pytest.approx(6.215e6, rel=1e-3)


def test_damping_ratio_is_that_of_the_free_free_mode() -> None:
    """Eigenvalues of rotor, spring, damper and generator."""
    k, rotor, generator, ratio = 5e8, 2e7, 200.0, 80.0
    c = torsional_damping(0.03, k, rotor, generator, ratio)
    M = np.diag([rotor, generator * ratio**2])
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    A = np.block(
        [
            [np.zeros((2, 2)), np.eye(2)],
            [-np.linalg.solve(M, k * pair), -np.linalg.solve(M, c * pair)],
        ]
    )
    swing = np.linalg.eigvals(A)
    swing = swing[np.abs(swing.imag) > 1][0]
    assert -swing.real / abs(swing) == pytest.approx(0.03, rel=1e-9)


def test_damping_to_a_held_generator_is_that_of_the_rotor_alone() -> None:
    held = torsional_damping(0.05, 4e8, 1e7, np.inf)
    assert held == pytest.approx(2 * 0.05 * np.sqrt(4e8 * 1e7), rel=1e-15)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((5.0, 1.0, 1.0, 1.0), "give no percent"),
        ((0.1, -1.0, 1.0, 1.0), "stiffness -1 must"),
        ((0.1, 1.0, np.inf, 1.0), "rotor inertia inf must"),
        ((0.1, 1.0, 1.0, 0.0), "generator inertia 0 must"),
        ((0.1, 1.0, 1.0, 1.0, 0.0), "gear ratio 0 must"),
    ],
)
def test_damping_out_of_range(arguments: tuple[float, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        torsional_damping(*arguments)


def differing(before: dict[str, Any], after: dict[str, Any]) -> set[str]:
    assert before.keys() == after.keys()
    return {key for key in before if before[key] != after[key]}


def test_openfast_io_reads_the_two_new_values_and_all_others_as_before(elastodyn: Path) -> None:
    before = read_elastodyn(elastodyn)
    assert before["GBRatio"] == 80
    assert before["outlist"]["GenSpeed"] is True
    target = elastodyn.with_name("new.dat")
    assert write_torsion(elastodyn, target, NEW) == Torsion(5.5e8, 2.5e6)
    after = read_elastodyn(target)
    assert differing(before, after) == {"DTTorSpr", "DTTorDmp"}
    assert (after["DTTorSpr"], after["DTTorDmp"]) == NEW  # every digit
    assert read_torsion(target) == NEW


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n"])
def test_no_other_byte_changes(tmp_path: Path, ending: str, last: str) -> None:
    content = TEXT.rstrip().replace("made-up", "m\xe4de-up").replace("\n", ending) + last
    source, target = tmp_path / "a.dat", tmp_path / "b.dat"
    source.write_bytes(content.encode("latin-1"))
    write_torsion(source, target, NEW)
    pairs = list(
        zip(
            source.read_bytes().splitlines(keepends=True),
            target.read_bytes().splitlines(keepends=True),
            strict=True,
        )
    )
    changed = [(a, b) for a, b in pairs if a != b]
    assert [a.split()[1] for a, _ in changed] == [b"DTTorSpr", b"DTTorDmp"]
    for a, b in changed:
        assert a.split(maxsplit=1)[1] == b.split(maxsplit=1)[1]
    write_torsion(target, target, Torsion(5.5e8, 2.5e6), overwrite=True)
    assert read_torsion(target) == read_torsion(source)


def test_exponents_of_fortran(elastodyn: Path) -> None:
    elastodyn.write_text(TEXT.replace("5.5E+08", "5.5D+08"))
    assert read_torsion(elastodyn) == Torsion(5.5e8, 2.5e6)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("DTTorSpr", "DTTorSpring", "has 0 lines of DTTorSpr"),
        ("DTTorDmp", "DTTorSpr", "has 2 lines of DTTorSpr"),
        ("5.5E+08", "stiff", "DTTorSpr is 'stiff', which is no number"),
        (TEXT, "", "has 0 lines of DTTorSpr"),
    ],
)
def test_what_is_no_elastodyn_file(elastodyn: Path, old: str, new: str, message: str) -> None:
    elastodyn.write_text(TEXT.replace(old, new))
    target = elastodyn.with_name("new.dat")
    with pytest.raises(InputError, match=message) as caught:
        write_torsion(elastodyn, target, NEW)
    assert str(elastodyn) in str(caught.value)
    assert not target.exists()


def test_elastodyn_of_another_version_is_refused_by_openfast_io_alone(elastodyn: Path) -> None:
    elastodyn.write_text("\n".join(x for x in TEXT.split("\n") if "PitchDOF" not in x))
    with pytest.raises(InputError, match="openfast_io cannot read"):
        read_elastodyn(elastodyn)
    write_torsion(elastodyn, elastodyn, NEW, overwrite=True)
    assert read_torsion(elastodyn) == NEW


def test_elastodyn_is_not_overwritten_unless_told(elastodyn: Path) -> None:
    with pytest.raises(InputError, match="exists"):
        write_torsion(elastodyn, elastodyn, NEW)
    with pytest.raises(InputError, match="there is no such file"):
        write_torsion(elastodyn.with_name("none.dat"), elastodyn, NEW, overwrite=True)
    assert elastodyn.read_text() == TEXT


@pytest.mark.parametrize("torsion", [Torsion(0, 1), Torsion(1, -1), Torsion(np.inf, 1)])
def test_torsion_out_of_range(elastodyn: Path, torsion: Torsion) -> None:
    with pytest.raises(InputError, match="must be positive"):
        write_torsion(elastodyn, elastodyn.with_name("new.dat"), torsion)


def cantilever() -> Superelement:
    """The published spring: 3947.8 N/m along z with 100 kg, 1e10 along and about all else."""
    K = np.diag([1e10, 1e10, 3947.8, 1e10, 1e10, 1e10])
    M = np.diag([100.0, 100, 100, 1000, 1000, 1000])
    return Superelement("cantilever", ("tip",), np.zeros((1, 3)), K, M, supported=True)


def sprung(seed: int = 0) -> Superelement:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((6, 6)) * 10.0 ** rng.uniform(3, 5, 6)[:, None]
    return Superelement(
        "seat", ("seat",), rng.uniform(-3, 3, (1, 3)), root @ root.T, supported=True
    )


def tilted(degrees: float) -> np.ndarray:
    """Axes of a shaft whose upwind end is up: about y."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])


def test_subdyn_spring_has_the_published_frequency_and_sag(tmp_path: Path) -> None:
    """OpenFAST r-test SD_Spring_Case1: 1 Hz, and -0.2485 m, both as printed there."""
    path = tmp_path / "subdyn.dat"
    subdyn.write(path, cantilever())
    spring = subdyn.read_spring(path)
    M = np.zeros((6, 6))
    M[:3, :3], M[3:, 3:] = spring.mass * np.eye(3), spring.inertia
    K = spring.global_stiffness
    lowest = np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)).real.min()) / (2 * np.pi)
    # 3947.8 is 4 pi^2 100 rounded to a tenth: f is off by half of that
    assert lowest == pytest.approx(1.0, rel=0.5 * 0.05 / 3947.8)
    weight = np.array([0, 0, -9.81 * spring.mass, 0, 0, 0])
    assert np.linalg.solve(K, weight)[2] == pytest.approx(-0.2485, abs=5e-5)


@pytest.mark.parametrize("tilt", [0.0, 5.0])
def test_subdyn_spring_keeps_every_digit_of_21_terms_and_cosines(
    tmp_path: Path, tilt: float
) -> None:
    element, axes, path = sprung(), tilted(tilt), tmp_path / "subdyn.dat"
    subdyn.write(path, element, axes)
    spring = subdyn.read_spring(path)
    np.testing.assert_array_equal(np.triu(spring.stiffness), np.triu(element.stiffness))
    np.testing.assert_array_equal(spring.axes, axes)
    np.testing.assert_array_equal(spring.joints[0], spring.joints[1])
    np.testing.assert_allclose(spring.joints[1], axes.T @ element.positions[0], rtol=1e-15)
    assert spring.mass == 0.0


def test_subdyn_spring_stores_the_same_energy_in_either_frame(tmp_path: Path) -> None:
    element, axes, path = sprung(3), tilted(6.0), tmp_path / "subdyn.dat"
    subdyn.write(path, element, axes)
    motion = np.random.default_rng(1).standard_normal(6)
    # components along the element's axes, from those along SubDyn's
    local = np.concatenate([axes @ motion[:3], axes @ motion[3:]])
    found = motion @ subdyn.read_spring(path).global_stiffness @ motion
    assert found == pytest.approx(local @ element.stiffness @ local, rel=1e-12)


def test_subdyn_mass_has_the_same_kinetic_energy_in_either_frame(tmp_path: Path) -> None:
    root = np.random.default_rng(5).standard_normal((3, 3))
    M = np.zeros((6, 6))
    M[:3, :3], M[3:, 3:] = 250.0 * np.eye(3), root @ root.T + np.eye(3)
    element, path = replace(sprung(3), mass=M), tmp_path / "subdyn.dat"
    axes = tilted(6.0) @ turned_about_x(20.0)
    subdyn.write(path, element, axes)
    spring = subdyn.read_spring(path)
    rates = np.random.default_rng(2).standard_normal(6)
    # components along the element's axes, from those along SubDyn's
    local = np.concatenate([axes @ rates[:3], axes @ rates[3:]])
    found = spring.mass * rates[:3] @ rates[:3] + rates[3:] @ spring.inertia @ rates[3:]
    assert found == pytest.approx(local @ M @ local, rel=1e-12)


def turned_about_x(degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def test_subdyn_takes_one_point_on_the_ground_and_a_rigid_body(tmp_path: Path) -> None:
    path = tmp_path / "subdyn.dat"
    with pytest.raises(InputError, match="takes one point"):
        subdyn.write(path, twisted_shaft(1e6))
    with pytest.raises(InputError, match="right-handed orthonormal"):
        subdyn.write(path, sprung(), np.round(tilted(5.0), 4))
    element = cantilever()
    assert element.mass is not None
    uneven = element.mass.copy()
    uneven[0, 0] = 90.0
    with pytest.raises(InputError, match="no rigid body"):
        subdyn.write(path, replace(element, mass=uneven))


def natural_frequencies(K: np.ndarray, M: np.ndarray) -> np.ndarray:
    size = np.sqrt(M.diagonal())
    return np.sqrt(eigh(K / np.outer(size, size), M / np.outer(size, size), eigvals_only=True)[6:])


@pytest.fixture(scope="module")
def shaft() -> Superelement:
    return shaft_superelement(coarse_scene("bonded"), 2, ["main_bearing", "hub", "gearbox"])


def test_extptfm_keeps_frequencies_and_inertia(tmp_path: Path, shaft: Superelement) -> None:
    path = tmp_path / "extptfm.dat"
    export.write_superelement(path, shaft, "extptfm")
    found = extptfm.read_reduced(path)
    assert shaft.mass is not None
    # the condensation's own round-off, over the frequencies' spread of a decade squared
    np.testing.assert_allclose(
        natural_frequencies(found.stiffness, found.mass),
        natural_frequencies(shaft.stiffness, shaft.mass),
        rtol=1e-8,
    )
    assert not found.stiffness[:6].any()  # free: the interface moves it as a rigid body
    assert not found.damping.any()
    inertia = shaft.inertia()
    assert inertia is not None
    np.testing.assert_allclose(found.mass[:6, :6], inertia, atol=1e-12 * inertia.max())
    np.testing.assert_allclose(
        found.weight[:6], -extptfm.GRAVITY * inertia[:, 2], atol=1e-9 * inertia.max()
    )


def test_extptfm_gives_the_static_stiffness_of_the_interface(tmp_path: Path) -> None:
    """On supports the interface's block is what is left with the other points without load."""
    rng = np.random.default_rng(4)
    root, mass = rng.standard_normal((2, 12, 12))
    element = Superelement(
        "held", ("a", "b"), rng.uniform(-1, 1, (2, 3)), root @ root.T, mass @ mass.T, True
    )
    path = tmp_path / "extptfm.dat"
    C = 1e-3 * element.stiffness
    extptfm.write(path, element, C)
    found = extptfm.read_reduced(path)
    exact = np.linalg.inv(np.linalg.inv(element.stiffness)[:6, :6])
    np.testing.assert_allclose(found.stiffness[:6, :6], exact, rtol=1e-9, atol=1e-9)
    assert not found.stiffness[6:, :6].any()
    np.testing.assert_allclose(found.damping, 1e-3 * found.stiffness, atol=1e-12)
    np.testing.assert_allclose(
        eigh(found.stiffness, found.mass, eigvals_only=True),
        eigh(element.stiffness, element.mass, eigvals_only=True),
        rtol=1e-8,
    )


def test_extptfm_needs_a_mass_and_a_damping_of_its_size(
    tmp_path: Path, shaft: Superelement
) -> None:
    with pytest.raises(InputError, match="has no mass"):
        extptfm.write(tmp_path / "a", twisted_shaft(1e6))
    with pytest.raises(InputError, match="damping of shape"):
        extptfm.write(tmp_path / "a", shaft, np.eye(6))


@pytest.mark.parametrize("read", [subdyn.read_spring, extptfm.read_reduced])
@pytest.mark.parametrize("content", [b"", b"not of any format\n", bytes(range(256)), None])
def test_malformed_openfast_files_get_one_sentence(
    tmp_path: Path, read: Callable[[Path], object], content: bytes | None, shaft: Superelement
) -> None:
    path = tmp_path / "file.dat"
    if content is None:
        if read is subdyn.read_spring:
            subdyn.write(path, sprung())
        else:
            extptfm.write(path, shaft)
        content = path.read_bytes()
        content = content[: len(content) // 2]
    path.write_bytes(content)
    with pytest.raises(InputError, match="openfast_io") as caught:
        read(path)
    assert str(path) in str(caught.value)


def test_extptfm_refuses_what_is_not_symmetric(tmp_path: Path, shaft: Superelement) -> None:
    path = tmp_path / "file.dat"
    extptfm.write(path, shaft)
    lines = path.read_text().splitlines()
    row = next(k for k, line in enumerate(lines) if line.startswith("!Mass")) + 1
    values = lines[row].split()
    lines[row] = " ".join([values[0], "1e9", *values[2:]])
    path.write_text("\n".join(lines))
    with pytest.raises(InputError, match="mass matrix is not symmetric"):
        extptfm.read_reduced(path)


@pytest.mark.parametrize("format", ["extptfm", "subdyn"])
def test_openfast_files_state_their_origin(
    tmp_path: Path, format: str, shaft: Superelement
) -> None:
    path = tmp_path / "file.dat"
    element = shaft if format == "extptfm" else cantilever()
    stated = {"bound": "stiff: a face", "rollers": "none"}
    element = replace(element, origin=Origin("my scene", "abc123"), band=BANDS, **stated)
    export.write_superelement(path, element, format)
    said = commented(path.read_text().splitlines(), "!")
    assert stated.items() <= said.items()
    head = "\n".join(path.read_text().splitlines()[:4])
    assert all(f"{key}: {text}" in head for key, text in stated.items())
    assert f"band: axial {'2 %' if format == 'subdyn' else '0.02'}, torsion" in head
    assert said["scene"] == "my scene"
    assert said["scene hash"] == "abc123"
    assert said["band"] == "axial 0.02, torsion 0.001, bending 0.03 of the stiffness"
    assert "x downwind" in said["frame"]
    assert f"point {len(element.points)}" in said


def test_extptfm_of_release_4_has_the_same_matrices(tmp_path: Path, shaft: Superelement) -> None:
    new, old = tmp_path / "5.dat", tmp_path / "4.dat"
    extptfm.write(new, shaft)
    extptfm.write(old, shaft, release=4)
    lines = old.read_text().splitlines()
    assert all(line.startswith("!") for line in lines[:2])
    assert "flex 5 format" in lines[1].lower()  # its manual asks for that in line 2
    assert max(map(len, lines)) < 4096  # what OpenFAST reads of a line
    pairs = zip(extptfm.read_release_4(old), extptfm.read_reduced(new), strict=True)
    for found, expected in pairs:
        np.testing.assert_array_equal(found, expected)
    old.write_text("\n".join(lines[:60]))
    with pytest.raises(InputError, match="no ExtPtfm superelement of OpenFAST 4") as caught:
        extptfm.read_release_4(old)
    assert str(old) in str(caught.value)
    with pytest.raises(InputError, match="no ExtPtfm superelement of OpenFAST 4"):
        extptfm.read_release_4(new)
