"""What holds for any scene: it is balanced, reciprocal and monotone, or it is refused.

Random drivetrains on coarse meshes; few examples, since each is meshed and solved.
"""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import validated
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.measures import inverted_cells, quality, volume
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

few = settings(max_examples=max(2, settings.default.max_examples // 15))  # type: ignore[union-attr]
hundredths = st.integers(20, 40).map(lambda x: x / 100.0)


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    """A shaft on one bearing unit: stepped or not, bored or not, every form of the interface."""
    diameter = draw(st.integers(32, 42)) / 100.0
    bore = draw(st.sampled_from([0.0, 0.1, 0.16]))
    spring = st.floats(5.0, 10.0).map(lambda x: 10.0**x)
    interface = draw(st.sampled_from(["bonded", "sliding", "averaged", "rigid"]))
    sections = [{"length": draw(hundredths) + 0.8, "outer_diameter": diameter}]
    if draw(st.booleans()):
        sections.append({"length": draw(hundredths), "outer_diameter": diameter - 0.06})
    data = {
        "title": "random",
        "shaft": {
            "front": -draw(hundredths) - 0.3,
            "sections": [s | {"inner_diameter": bore} for s in sections],
        },
        "bearing_units": [
            {
                "bearing": {"kind": "ring" if interface == "bonded" else "spherical"},
                "housing": {"wall": draw(st.integers(11, 14)) / 100.0, "pedestal_width": 0.9},
                "interface": interface,
            }
        ],
        "hub": {"coupling": draw(st.sampled_from(["averaged", "rigid"]))},
        "gearbox": {"stiffness": [*(draw(spring) for _ in range(4)), 0, 0], "weight": 1e5},
        "mesh": {k: 0.2 for k in ("shaft", "bearing", "housing", "bearing_edge")}
        | {"elements_per_turn": 6},
    }
    return validated(Scene, data, "random")


def hub_compliance(response: Response) -> np.ndarray:
    return np.asarray(response.motions["hub"][:, :6])


def never_softer(before: np.ndarray, after: np.ndarray) -> None:
    """No hub load does more work after than before, to the accuracy of a direct solution."""
    root = np.sqrt(np.diag(before))
    change = (before - after) / np.outer(root, root)
    assert np.linalg.eigvalsh((change + change.T) / 2.0).min() >= -1e-7


@few
@given(scenes(), st.integers(0, 3), st.floats(0.5, 4.0), st.floats(-1.0, 1.0))
def test_a_scene_is_balanced_reciprocal_and_monotone(
    scene: Scene, direction: int, decades: float, modulus: float
) -> None:
    mesh = mesh_scene(scene)
    model = build_model(scene, mesh)
    response = unit_load_response(model, "superlu")
    assert response.equilibrium_error < 1e-8
    assert response.superposition_error < 1e-8

    C = hub_compliance(response)
    root = np.sqrt(np.diag(C))
    unit = C / np.outer(root, root)
    np.testing.assert_allclose(unit, unit.T, rtol=0, atol=1e-7)

    # what stands on housing and gearbox weighs what the mesh's volume weighs
    weight = GRAVITY * sum(
        scene.material_of(part).density * volume(mesh, part) for part in mesh.part_names
    )
    carried = sum(
        response.history(name, np.zeros(6), gravity=GRAVITY)[2]
        for name in ("main_bearing", "gearbox")
    )
    np.testing.assert_allclose(carried, -weight, rtol=1e-8)

    def changed(changes: dict[str, object]) -> np.ndarray:
        other = change_scene(scene, changes)
        return hub_compliance(unit_load_response(build_model(other, mesh), "superlu"))

    k = scene.gearbox.stiffness[direction]
    assert k != "rigid"
    for stiffer in (min(1e16, k * 10.0**decades), "rigid"):
        never_softer(C, changed({f"gearbox.stiffness.{direction}": stiffer}))
    steel = MATERIALS["steel"]
    stiff_steel = steel.model_dump() | {"youngs_modulus": 1.5 * steel.youngs_modulus}
    never_softer(
        C,
        changed({"materials.stiff": stiff_steel, "bearing_units.0.housing.material": "stiff"}),
    )

    # all stiffness times a factor: all motions over it
    factor = 10.0**modulus
    found = changed(
        {
            f"materials.{name}": MATERIALS[name].model_dump()
            | {"youngs_modulus": factor * MATERIALS[name].youngs_modulus}
            for name in ("steel", "ductile_iron")
        }
        | {
            f"gearbox.stiffness.{i}": float(k) * factor
            for i, k in enumerate(scene.gearbox.stiffness)
        }
    )
    np.testing.assert_allclose(found * factor / np.outer(root, root), unit, rtol=0, atol=1e-7)


@few
@given(
    scenes(),
    st.sampled_from(
        [
            "shaft.sections.0.outer_diameter",
            "shaft.sections.0.inner_diameter",
            "shaft.sections.0.length",
            "shaft.sections.0.outer_diameter_end",
            "shaft.front",
            "bearing_units.0.bearing.width",
            "bearing_units.0.bearing.x",
            "bearing_units.0.bearing.raceway_diameter",
            "bearing_units.0.housing.width",
            "bearing_units.0.housing.wall",
            "bearing_units.0.housing.centre_height",
            "bearing_units.0.housing.foot_thickness",
            "bearing_units.0.housing.foot_width",
            "bearing_units.0.housing.foot_length",
            "bearing_units.0.housing.pedestal_width",
        ]
    ),
    st.one_of(st.floats(0.05, 1.5), st.floats(-4.0, 1.0).map(lambda x: 10.0**x)),
)
def test_a_scene_of_odd_dimensions_is_meshed_soundly_or_refused(
    scene: Scene, key: str, value: float
) -> None:
    try:
        mesh = mesh_scene(change_scene(scene, {key: value}))
    except InputError as error:
        said = str(error)
    else:
        said = _sound(mesh)
    assert said.isprintable()
    assert len(said) < 1000


def _sound(mesh: Mesh) -> str:
    assert not inverted_cells(mesh).size
    assert quality(mesh).minimum_scaled_jacobian > 0.0
    return "sound"
