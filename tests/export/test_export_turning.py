"""All that turns of a drivetrain for other programs: matrices, and its torsion as one spring."""

import json
import math
from collections import Counter
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import jsonschema
import numpy as np
import pytest
import yaml
from scipy.io import mmread
from scipy.linalg import eigh
from small_drivetrain import GENERATOR, ROTOR, STIFFNESS, two_mass_file, two_masses

from fe_drivetrain.cases.export.sample_elastodyn import TEXT
from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import Drivetrain, parse_drivetrain, read_drivetrain
from fe_drivetrain.dynamics import Level, machine_of
from fe_drivetrain.dynamics.bodies.levels import torsional
from fe_drivetrain.dynamics.torsion import static_stiffness
from fe_drivetrain.export.formats.elastodyn import Torsion, read_torsion
from fe_drivetrain.export.formats.turning_json import TurningFile
from fe_drivetrain.export.turning import OneSpring, Turning, turning_of
from fe_drivetrain.export.turning_files import TURNING_FORMATS, write_turning, write_turning_files
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.studies import modes, prepare_export

GEARED = "nrel_750kw"
DAMPER = 3e5
DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def geared() -> Drivetrain:
    return read_drivetrain(GEARED, {"damping": {"shafts": 0.006, "meshes": 0.1}})


@pytest.fixture(scope="module")
def rigid(geared: Drivetrain) -> Turning:
    return turning_of(geared, Level.RIGID)


def exported(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["fe-drivetrain", "export", *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    return int(end.value.code or 0)


def spring_of(drivetrain: Drivetrain) -> OneSpring:
    return turning_of(drivetrain, Level.TORSIONAL).spring


def frequencies(stiffness: Any, mass: Any) -> Any:
    """By eigenvalues of the two matrices as they are [Hz]."""
    return np.sqrt(np.maximum(eigh(stiffness, mass, eigvals_only=True), 0.0)) / math.tau


def test_two_masses_on_a_shaft_are_the_one_spring_by_hand() -> None:
    shaft = {"name": "shaft", "torsion": STIFFNESS, "damping": DAMPER}
    one = spring_of(two_masses(shaft=shaft))
    assert one.torsion == pytest.approx((STIFFNESS, DAMPER), rel=1e-12)
    both = ROTOR * GENERATOR / (ROTOR + GENERATOR)
    for found in (one.free, one.free_of_two):
        assert found == pytest.approx(math.sqrt(STIFFNESS / both) / math.tau, rel=1e-12)
    assert one.ratio == pytest.approx(DAMPER / (2.0 * math.sqrt(STIFFNESS * both)), rel=1e-12)
    for found in (one.held, one.held_of_two):
        assert found == pytest.approx(math.sqrt(STIFFNESS / ROTOR) / math.tau, rel=1e-12)


def test_the_grid_does_not_hold_what_is_free() -> None:
    """A generator of fixed speed stands on a spring, which free-free leaves out."""
    on_grid = two_masses(generator={"inertia": GENERATOR, "stiffness": 1e7})
    assert spring_of(on_grid).free == pytest.approx(spring_of(two_masses()).free, rel=1e-12)


def test_a_parallel_stage_is_in_series_on_the_side_of_the_rotor() -> None:
    """1/k = 1/k_rotor + 1/(k_mesh r_b^2) + 1/(n^2 k_generator), with dampers by energy."""
    n, front, rear, mesh, c_front, c_rear = 4.0, 3e8, 2e7, 5e9, 2e5, 1e4
    stage = {"kind": "parallel", "stiffness_of": "axis", "stiffness": mesh}
    bodies = {"gear": {"inertia": 100.0}, "pinion": {"inertia": 1.0}}
    sizes = {"centre_distance": 1.0, "face_width": 0.3, "radii": {"gear": 0.8, "pinion": 0.2}}
    found = two_mass_file(
        shaft={"name": "shaft", "torsion": front, "damping": c_front},
        gearbox={
            "stages": [stage | bodies | sizes],
            "shafts": [{"name": "fast", "torsion": rear, "damping": c_rear}],
        },
    )
    one = spring_of(parse_drivetrain(yaml.safe_dump(found)))
    spring = 1.0 / (1.0 / front + 1.0 / mesh + 1.0 / (n**2 * rear))
    assert one.torsion.spring == pytest.approx(spring, rel=1e-12)
    wound = (spring / front, spring / (n * rear))
    damper = c_front * wound[0] ** 2 + c_rear * wound[1] ** 2
    assert one.torsion.damper == pytest.approx(damper, rel=1e-12)
    assert one.gear_ratio == pytest.approx(-n)


def test_planets_wind_up_as_the_torsional_model_does(geared: Drivetrain) -> None:
    one = spring_of(geared)
    model = torsional(machine_of(geared))
    assert one.torsion.spring == pytest.approx(
        static_stiffness(model, "rotor", "generator"), rel=1e-9
    )
    assert one.torsion.damper > 0.0


@pytest.mark.parametrize("level", ["torsional", "rigid"])
def test_scipy_finds_the_frequencies_of_modes_in_matrix_market_files(
    level: str, geared: Drivetrain, tmp_path: Path
) -> None:
    content = prepare_export(geared, "turning", level=level).content
    assert isinstance(content, Turning)
    found = {}
    for name in ("mtx", "mtx-mass", "mtx-damping", "mtx-gyroscopic"):
        path = tmp_path / f"{name}.mtx"
        write_turning(path, content, name)
        found[name] = mmread(path).toarray()
        for fact in (geared.title, drivetrain_hash(geared), f"level: {level}", "fe-drivetrain"):
            assert fact in " ".join(path.read_text().replace("%", " ").split())
    n = len(content.names)
    assert all(matrix.shape == (n, n) for matrix in found.values())
    own = modes(geared, level=level).frequencies
    count = min(20, n)
    by_scipy = frequencies(found["mtx"], found["mtx-mass"])[:count]
    np.testing.assert_allclose(by_scipy, own[:count], rtol=1e-6)
    np.testing.assert_array_equal(found["mtx-gyroscopic"], -found["mtx-gyroscopic"].T)
    np.testing.assert_allclose(found["mtx-damping"], content.damping, rtol=1e-12, atol=1e-9)
    assert (level == "rigid") == found["mtx-gyroscopic"].any()


def test_formats_of_all_that_turns_are_all_written_or_none(rigid: Turning, tmp_path: Path) -> None:
    files = {"csv": tmp_path / "a.csv", "elastodyn": tmp_path / "a.dat"}
    with pytest.raises(InputError, match="give it as template"):
        write_turning_files(files, rigid)
    assert list(tmp_path.iterdir()) == []
    template = tmp_path / "mine.dat"
    template.write_text(TEXT, encoding="utf-8")
    write_turning_files(files, rigid, template=template)
    assert read_torsion(files["elastodyn"]) == rigid.spring.torsion
    assert files["csv"].stat().st_size > 0


def test_json_and_csv_hold_the_same_numbers(rigid: Turning, tmp_path: Path) -> None:
    write_turning(tmp_path / "a.json", rigid, "json")
    content = json.loads((tmp_path / "a.json").read_text())
    schema = json.loads((DOCS / "turning.schema.json").read_text())
    assert schema == TurningFile.model_json_schema(mode="serialization")
    jsonschema.validate(content, schema)
    assert content["drivetrain_hash"] == rigid.hash
    assert content["options"] == {"level": "rigid", "generator": "free"}
    assert content["degrees_of_freedom"] == list(rigid.names)
    write_turning(tmp_path / "a.csv", rigid, "csv")
    rows = [line.split(",") for line in (tmp_path / "a.csv").read_text().splitlines()]
    for kind, matrix in rigid.matrices.items():
        np.testing.assert_array_equal(content[kind], matrix)
        table = [[float(cell) for cell in row[2:]] for row in rows if row[0] == kind]
        np.testing.assert_array_equal(table, matrix)
    assert ["matrix", "freedom", *rigid.names] in rows


def test_simpack_has_a_variable_for_each_entry_that_is_not_zero(
    rigid: Turning, tmp_path: Path
) -> None:
    write_turning(tmp_path / "a.subvar", rigid, "simpack")
    text = (tmp_path / "a.subvar").read_text()
    i, j = 0, int(np.flatnonzero(rigid.stiffness[0])[-1])
    assert f"subvar($_turning_K_{i + 1}_{j + 1}, str= '{float(rigid.stiffness[i, j])!r}')" in text
    assert f"$_turning_DTTorSpr, str= '{rigid.spring.torsion.spring!r}'" in text
    assert f"drivetrain hash: {rigid.hash}" in text


@pytest.mark.needs("h5py")
def test_h5py_reads_the_matrices(rigid: Turning, tmp_path: Path) -> None:
    import h5py

    write_turning(tmp_path / "a.h5", rigid, "hdf5")
    with h5py.File(tmp_path / "a.h5") as file:
        assert file.attrs["drivetrain hash"] == rigid.hash
        for kind, matrix in rigid.matrices.items():
            np.testing.assert_array_equal(file[kind], matrix)


@pytest.mark.needs("exudyn")
def test_exudyn_finds_the_frequencies_by_the_script(geared: Drivetrain, tmp_path: Path) -> None:
    turning = turning_of(geared, Level.TORSIONAL)
    write_turning(tmp_path / "a.py", turning, "exudyn")
    space: dict[str, Any] = {"__name__": "model"}
    exec((tmp_path / "a.py").read_text(), space)
    container, system, markers = space["build"]()
    system.Assemble()
    squares, _ = system.ComputeODE2Eigenvalues()
    found = np.sqrt(np.maximum(np.sort(np.asarray(squares)), 0.0)) / math.tau
    np.testing.assert_allclose(
        found[1:], frequencies(turning.stiffness, turning.mass)[1:], rtol=1e-6
    )
    assert list(markers) == list(turning.names)
    assert container is not None


def test_the_script_for_exudyn_holds_the_matrices(rigid: Turning, tmp_path: Path) -> None:
    write_turning(tmp_path / "a.py", rigid, "exudyn")
    text = (tmp_path / "a.py").read_text()
    names = text.index("NAMES = ")
    space: dict[str, Any] = {"np": np}
    exec(text[names : text.index("def build")], space)
    assert space["NAMES"] == list(rigid.names)
    for kind, matrix in rigid.matrices.items():
        np.testing.assert_array_equal(space["matrix"](kind), matrix)
    assert f"# drivetrain hash: {rigid.hash}" in text


def test_the_gear_unit_in_rexs_has_each_part_once(
    geared: Drivetrain, rigid: Turning, tmp_path: Path
) -> None:
    """Components by kind, their relations, and geometry that is read back from positions."""
    write_turning(tmp_path / "a.rexs", rigid, "rexs")
    text = (tmp_path / "a.rexs").read_text("utf-8-sig")
    assert f"drivetrain hash: {rigid.hash}" in text
    assert "left out: inertias" in text
    model = ElementTree.fromstring(text)
    assert model.get("version") == "1.6"
    found = {one.get("id"): one for one in model.iterfind("components/component")}
    kinds = Counter(one.get("type") for one in found.values())
    planets = 3
    assert kinds["planetary_stage"] == kinds["ring_gear"] == kinds["planet_carrier"] == 1
    assert kinds["cylindrical_stage"] == 2 * planets + 2
    assert kinds["cylindrical_gear"] == 1 + planets + 2 * 2
    machine = rigid.machine
    pins = sum(len(getattr(stage, "pins", ())) for stage in machine.stages)
    assert kinds["concept_bearing"] == len(machine.bearings) + planets * pins
    assert kinds["shaft"] == len(machine.shafts) + 1 + 2 * planets
    whole: dict[str, str] = {}
    for relation in model.iterfind("relations/relation"):
        ends = {ref.get("role", ""): ref for ref in relation.iterfind("ref")}
        for ref in ends.values():
            assert found[ref.get("id")].get("type") == ref.get("hint")
        if relation.get("type") == "assembly" and ends["assembly"].get("hint") == "shaft":
            whole[ends["part"].get("id", "")] = ends["assembly"].get("id", "")
    for relation in model.iterfind("relations/relation[@type='stage']"):
        ids = {ref.get("role", ""): ref.get("id", "") for ref in relation.iterfind("ref")}
        one, two = (found[ids[role]] for role in ("gear_1", "gear_2"))
        assert {ids["gear_1"], ids["gear_2"]} <= whole.keys()
        apart = float(np.linalg.norm((place_of(one) - place_of(two))[1:]))
        assert apart == pytest.approx(value_of(found[ids["stage"]], "center_distance"))
        hands = [value_of(gear, "helix_angle_reference_diameter") for gear in (one, two)]
        assert hands[1] == (hands[0] if two.get("type") == "ring_gear" else -hands[0])
    teeth = {one.get("name"): value_of(one, "number_of_teeth") for one in gears_of(model)}
    stage = geared.gearbox.stages[0]
    assert stage.teeth is not None
    assert [teeth[f"stage 1 {part}"] for part in ("ring", "planet 1", "sun")] == list(stage.teeth)


def gears_of(model: ElementTree.Element) -> list[ElementTree.Element]:
    return [c for c in model.iterfind("components/component") if "_gear" in (c.get("type") or "")]


def value_of(component: ElementTree.Element, name: str) -> float:
    return float(component.findtext(f"attribute[@id='{name}']") or "nan")


def place_of(component: ElementTree.Element) -> Any:
    cells = component.iterfind("attribute[@id='support_vector']/array/c")
    return np.array([float(cell.text or "nan") for cell in cells])


def test_a_copy_of_an_elastodyn_file_has_the_spring_and_says_whose(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    source, target, mine = (tmp_path / name for name in ("ed.dat", "new.dat", "mine.yaml"))
    source.write_text(TEXT)
    shaft = {"name": "shaft", "torsion": STIFFNESS, "damping": DAMPER}
    mine.write_text(yaml.safe_dump(two_mass_file(shaft=shaft)))
    common = (str(mine), "--format", "elastodyn", "--template", str(source))
    assert exported(monkeypatch, *common, "--out", str(target)) == 0
    said = capsys.readouterr().out
    assert "leaves out inertias between rotor and generator" in " ".join(said.split())
    assert "2.516" in said  # Hz, free-free
    assert "1.125" in said  # Hz, generator held
    assert read_torsion(target) == pytest.approx(Torsion(STIFFNESS, DAMPER))
    own = drivetrain_hash(read_drivetrain(mine))
    old, new = TEXT.splitlines(), target.read_text().splitlines()
    changed = [k for k, (one, other) in enumerate(zip(old, new, strict=True)) if one != other]
    assert [old[k].split()[1] for k in changed] == ["DTTorSpr", "DTTorDmp"]
    assert f"drivetrain: Two masses; drivetrain hash: {own}; level: torsional" in new[changed[0]]
    # once more from the copy: what it is of is stated once
    again = (*common[:-1], str(target), "--out", str(target), "--overwrite")
    assert exported(monkeypatch, *again) == 0
    assert target.read_text().splitlines() == new
    for more in (("--level", "rigid"), ("--generator", "held")):
        assert exported(monkeypatch, *common, "--out", str(target), "--overwrite", *more) == 2
        assert "holds neither" in capsys.readouterr().err
    assert exported(monkeypatch, *common[:3], "--out", str(target), "--overwrite") == 2
    assert "add --template FILE" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("--format", "dmig"), "--format dmig cannot hold --what turning: use one of json, csv"),
        (("--format", "json", "--level", "fine"), "no level 'fine'"),
        (("--format", "json", "--at", "hub"), "--at is not used by an export of kind 'turning'"),
        (("--format", "json", "--level", "rigid"), "needs what its file does not state"),
        (("--format", "json", "--generator", "loose"), "generator is 'loose': choose"),
        (("--format", "rexs", "--what", "turning"), "as a gear unit needs what its file does not"),
        (("--format", "json", "--template", "a"), "does not use --template"),
        ((), "ends in ''"),
    ],
)
def test_a_drivetrain_without_sections_is_refused_what_it_has_not(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    arguments: tuple[str, ...],
    hint: str,
) -> None:
    mine = tmp_path / "mine.yaml"
    mine.write_text(yaml.safe_dump(two_mass_file()))
    assert exported(monkeypatch, str(mine), "--out", str(tmp_path / "a"), *arguments) == 2
    assert hint in " ".join(capsys.readouterr().err.split())
    assert [path.name for path in tmp_path.iterdir()] == ["mine.yaml"]


def test_what_has_no_rotor_or_is_a_component_is_refused(tmp_path: Path, rigid: Turning) -> None:
    with pytest.raises(InputError, match="does not state its rotor"):
        prepare_export(read_drivetrain("two_bearings"), "turning")
    with pytest.raises(InputError, match="`generator='held'` is not used by an export of kind"):
        prepare_export(read_drivetrain("two_bearings"), generator="held")
    with pytest.raises(InputError, match="`level='rigid'` must be a number"):
        prepare_export(read_drivetrain("two_bearings"), level="rigid")
    with pytest.raises(InputError, match="the main shaft has no sections"):
        prepare_export(two_masses())
    with pytest.raises(InputError, match="format is 'xyz': choose"):
        write_turning(tmp_path / "a", rigid, "xyz")
    assert list(TURNING_FORMATS) == list(dict.fromkeys(TURNING_FORMATS))
