"""A scene's solids on rollers: balance, the springs that they were solved with, the joint."""

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import double_row_tapered
from fe_drivetrain.bearing.contact import linear
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing_life.rings import assembly as assembly_module
from fe_drivetrain.bearing_life.rings import housing as housing_module
from fe_drivetrain.bearing_life.rings.assembly import (
    RollerAssembly,
    assembly_equilibrium,
    roller_assembly,
)
from fe_drivetrain.bearing_life.rings.housing import housing_races
from fe_drivetrain.common.cache import CACHE_VARIABLE
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces.joints import roller_loads
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

NAME, COUNT, ANGLE = "main_bearing", 8, 20.0
SPRING = 2e9
LOADS = np.zeros((3, 10))
LOADS[0, 2], LOADS[0, 9] = -2e5, 1e5
LOADS[1, [0, 4]] = 2e5, 3e5
LOADS[2, :6] = 1e5, 5e4, -2e5, 1e5, 2e5, -1e5


def bearing(**changes: float) -> Bearing:
    """Two rows that fill the raceway of 600 mm, half a bearing's width each."""
    made = double_row_tapered(NAME, COUNT, 0.05, 0.0939, 0.55, ANGLE, 0.1 + 0.0182, "O", laminae=0)
    return made.with_rows(phase=np.pi, **changes)


@pytest.fixture(scope="module")
def scene() -> Scene:
    """On a mesh as coarse as can be."""
    scene = library_scene("main_bearing_bonded")
    return scene.model_copy(update={"mesh": scene.mesh.scaled(3.0, 8)})


@pytest.fixture(scope="module")
def assembly(scene: Scene) -> RollerAssembly:
    """The scene at its rollers."""
    return roller_assembly(scene, {NAME: bearing()})


def test_rollers_and_gearbox_balance_the_hub(assembly: RollerAssembly, scene: Scene) -> None:
    found = assembly_equilibrium(assembly, LOADS, shapes=200, tolerance=1e-11)
    assert found.converged.all()
    gearbox = found.motions("gearbox")[:, :3] * np.array(scene.gearbox.stiffness[:3])
    left = LOADS[:, :3] - LOADS[:, 9:] * [0, 0, 1] - gearbox - found.bearing_loads(NAME)[:, :3]
    assert np.abs(left).max() < 1e-6 * np.abs(LOADS).max()
    # moments about the bearing's centre
    hub, rear = scene.shaft.front, scene.shaft.rear
    down = gearbox[:, 2] + LOADS[:, 9]
    about_y = LOADS[:, 4] - hub * LOADS[:, 2] + rear * down - found.bearing_loads(NAME)[:, 3]
    assert np.abs(about_y).max() < 1e-6 * np.abs(LOADS).max()


def test_weak_springs_leave_no_trace(
    assembly: RollerAssembly, scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assembly_module, "WEAK", 0.5)
    other = roller_assembly(scene, {NAME: bearing()})
    assert other.springs.max() > 5.0 * assembly.springs.max()
    one, two = (assembly_equilibrium(a, LOADS, tolerance=1e-11) for a in (assembly, other))
    assert np.abs(one.rollers - two.rollers).max() < 1e-6 * one.rollers.max()
    moved = [e.motions("hub") for e in (one, two)]
    assert np.abs(moved[0] - moved[1]).max() < 1e-6 * np.abs(moved[0]).max()


def test_preloaded_springs_are_the_joint_rollers_of_the_scene(
    assembly: RollerAssembly, scene: Scene
) -> None:
    unit = f"bearing_units.{NAME}"
    rows = [{"x": x, "contact_angle": -np.sign(x) * ANGLE} for x in (-0.05, 0.05)]
    joined = change_scene(
        scene,
        {
            f"{unit}.interface": "rollers",
            f"{unit}.rollers": {"count": COUNT, "stiffness": SPRING, "rows": rows},
        },
    )
    response = unit_load_response(build_model(joined, mesh_scene(joined)))
    reference = roller_loads(joined.bearing_units[0], response.motions)
    springs = bearing(law=linear(SPRING), clearance=-4e-4, laminae=1)
    preloaded = RollerAssembly(
        {NAME: springs}, assembly.stiffness, assembly.loads, assembly.points, assembly.springs
    )
    factors = np.vstack([np.zeros(10), 1e3 * np.eye(10)])
    found = assembly_equilibrium(preloaded, factors, shapes=200, tolerance=1e-12)
    change = (found.of(NAME)[1:] - found.of(NAME)[0]) / 1e3
    # the scene counts from the left and upwards, the bearing with this phase downwards
    mirrored = change.reshape(10, 2, COUNT)[:, :, -np.arange(COUNT) % COUNT]
    for load in (0, 1, 2, 4, 5, 9):
        other = reference[:, :, load]
        assert np.abs(mirrored[load] - other).max() < 1e-3 * np.abs(other).max()


def test_few_shapes_are_enough(assembly: RollerAssembly) -> None:
    whole, few = (
        assembly_equilibrium(assembly, LOADS, shapes=n).rollers.max(axis=1) for n in (200, None)
    )
    assert few == pytest.approx(whole, rel=1e-2)


def test_what_is_missing_is_named(assembly: RollerAssembly, scene: Scene) -> None:
    with pytest.raises(InputError, match="the scene has main_bearing"):
        roller_assembly(scene, {})
    with pytest.raises(InputError, match="name one of main_bearing"):
        assembly_equilibrium(assembly, LOADS).of("rear")
    with pytest.raises(InputError, match="finite numbers"):
        assembly_equilibrium(assembly, np.zeros((1, 5)))


def test_what_the_solids_do_at_the_rollers_is_kept(
    assembly: RollerAssembly, scene: Scene, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The same to the last bit, and for another bearing or another scene not the same."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    made = roller_assembly(scene, {NAME: bearing()})
    with monkeypatch.context() as patch:
        patch.setattr(assembly_module, "_solved", None)
        kept = roller_assembly(scene, {NAME: bearing()})
        turned = bearing().with_rows(phase=0.1)
        softer = change_scene(scene, {"gearbox.stiffness.0": 1e6})
        for other in ((scene, turned), (softer, bearing())):
            with pytest.raises(TypeError):  # solved again, by nothing
                roller_assembly(other[0], {NAME: other[1]})
    assert list(kept.points) == list(made.points)
    for one, two in (
        (made.stiffness, kept.stiffness),
        (made.loads, kept.loads),
        (made.springs, kept.springs),
        *(
            (a, b)
            for name in made.points
            for a, b in zip(made.points[name], kept.points[name], strict=True)
        ),
    ):
        assert np.array_equal(one, two)
        assert one.strides == two.strides


def test_the_compliance_of_a_housing_is_kept(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    made = housing_races(scene, NAME, bearing())
    monkeypatch.setattr(housing_module, "_compliance", None)
    assert np.array_equal(made.compliance, housing_races(scene, NAME, bearing()).compliance)
    on_bedplate = change_scene(scene, {f"bearing_units.{NAME}.bedplate": [1e9] * 6})
    with pytest.raises(TypeError):  # solved again, by nothing
        housing_races(on_bedplate, NAME, bearing())
