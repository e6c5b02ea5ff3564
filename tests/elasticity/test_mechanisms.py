"""A scene that can move is refused before the solve, and the motion has a name."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.cases.main_bearing import bearing_scenes, shown
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.interfaces.mechanisms import (
    find_mechanisms,
    named_bodies,
    weak_restraints,
)
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.model import build_model
from fe_drivetrain.shafts.response.unit_loads import unit_load_response


def test_bodies_are_parts_that_share_nodes(spherical_mesh, bonded_model):
    assert sorted(named_bodies(spherical_mesh)[1]) == [
        ("main_bearing.housing",),
        ("shaft", "main_bearing"),
    ]
    assert len(named_bodies(bonded_model.mesh)[1]) == 1


def refusal(scene, mesh, springs):
    """The sentence that a scene is refused with, as it is read and as a whole model equally."""
    with pytest.raises(InputError) as read:
        change_scene(scene, {"gearbox.stiffness": springs})
    gearbox = scene.gearbox.model_copy(update={"stiffness": tuple(springs)})
    with pytest.raises(InputError) as modelled:
        build_model(scene.model_copy(update={"gearbox": gearbox}), mesh)
    assert str(read.value) == f"scene: {modelled.value}"
    return str(modelled.value)


@pytest.mark.parametrize("form", ["sliding", "averaged", "rigid"])
def test_spherical_shaft_without_torque_reaction_twists(spherical_mesh, form):
    scene = change_scene(coarse_scene("spherical"), {"bearing_units.0.interface": form})
    message = refusal(scene, spherical_mesh, [4e6, 8e7, 8e7, 0, 0, 0])
    assert "shaft and main_bearing can turn freely about x" in message
    assert message.count("freely") == 1


def test_spherical_shaft_without_gearbox_turns_about_all_axes(spherical_mesh):
    message = refusal(coarse_scene("spherical"), spherical_mesh, [0] * 6)
    for axis in "xyz":
        assert f"turn freely about {axis} through (0, 0, 0) m" in message


def test_one_radial_spring_leaves_one_tilt_free(spherical_mesh):
    """A spring along z at the gearbox stops tilt about y; yaw about z stays free."""
    message = refusal(coarse_scene("spherical"), spherical_mesh, [0, 0, 1.0, "rigid", 0, 0])
    assert "turn freely about z" in message
    assert "about y" not in message


def test_free_body_has_six_motions_with_names(bonded_model):
    found = find_mechanisms(bonded_model.mesh, [], [])
    assert len(found) == 6
    assert sum("turn freely" in text for text in found) == 3
    assert sum("move freely along" in text for text in found) == 3


def test_held_scene_has_none(bonded_model):
    assert find_mechanisms(bonded_model.mesh, bonded_model.constraints, ()) == []


def test_a_spring_of_any_size_holds(spherical_mesh):
    """Whether something is held is a question of geometry, not of stiffness."""
    scene = change_scene(coarse_scene("spherical"), {"gearbox.stiffness": [0, 1, 1, 1, 0, 0]})
    model = build_model(scene, spherical_mesh)
    point, stiffness = model.springs[0]
    for k in (1e-20, 1e15):
        springs = [(point, k * stiffness)]
        assert find_mechanisms(model.mesh, model.constraints, springs) == []


def spherical_with(mesh, *stiffness):
    """The spherical scene with its averaged joint: the motions that it allows are exact."""
    changes = {"gearbox.stiffness": list(stiffness), "bearing_units.0.interface": "averaged"}
    return build_model(change_scene(coarse_scene("spherical"), changes), mesh)


def moduli(model):
    return {part: model.scene.material_of(part).youngs_modulus for part in model.mesh.part_names}


def test_ratio_of_a_weak_spin_by_hand(spherical_mesh):
    """A shaft that turns by 1 rad moves its bearing's rim most, and works on one spring."""
    k = 0.01
    model = spherical_with(spherical_mesh, 4e6, 8e7, 8e7, k, 0, 0)
    (found,) = weak_restraints(model.mesh, model.constraints, model.springs, moduli(model))
    nodes = np.unique(
        np.concatenate(
            [model.mesh.cells[model.mesh.part_cells(p)].ravel() for p in ("shaft", "main_bearing")]
        )
    )
    points = model.mesh.points[nodes]
    rim = np.hypot(points[:, 1], points[:, 2]).max()
    length = np.ptp(points, axis=0).max()
    E = moduli(model)["shaft"]
    assert found.ratio == pytest.approx(k / (E * length * rim**2), rel=1e-9)
    assert "shaft and main_bearing can nearly turn about x through (0, 0, 0) m" in str(found)
    assert found.digits_lost == pytest.approx(-np.log10(found.ratio))


def test_weak_motions_among_stiff_springs_are_told_apart(spherical_mesh):
    """Twenty-two decades between the springs: neither hides the other."""
    model = spherical_with(spherical_mesh, 0, 1e16, 1e-3, 1e-2, 0, 0)
    first, second = weak_restraints(model.mesh, model.constraints, model.springs, moduli(model))
    assert "nearly turn about y" in str(first)
    assert "nearly turn about x" in str(second)
    assert all("about z" not in warning for warning in model.warnings)
    assert len(model.warnings) == 2


def test_real_springs_and_a_bonded_shaft_without_any_are_not_warned_of(
    spherical_mesh, bonded_model
):
    assert spherical_with(spherical_mesh, 4e6, 8e7, 8e7, "rigid", 0, 0).warnings == ()
    assert bonded_model.warnings == ()


def test_ratio_is_proportional_to_the_spring_and_its_order_is_kept(spherical_mesh):
    def ratios(k):
        model = spherical_with(spherical_mesh, 4e6, 2 * k, k, "rigid", 0, 0)
        found = weak_restraints(
            model.mesh, model.constraints, model.springs, moduli(model), below=np.inf
        )
        return [motion.ratio for motion in found]

    one, ten = ratios(1.0), ratios(10.0)
    assert len(one) == 2  # about y and about z: x is held
    assert one[1] == pytest.approx(2 * one[0], rel=1e-6)
    assert ten == pytest.approx([10 * r for r in one], rel=1e-9)


def test_a_spring_below_round_off_is_refused_by_name(spherical_mesh):
    """The same limit for the scene as it is read, and for the whole model."""
    scene = coarse_scene("spherical")
    gearbox = scene.gearbox.model_copy(update={"stiffness": (4e6, 8e7, 8e7, 1e-6, 0, 0)})
    refused = "mechanism within round-off: shaft and main_bearing can nearly turn about x"
    with pytest.raises(InputError, match=refused):
        build_model(scene.model_copy(update={"gearbox": gearbox}), spherical_mesh)
    with pytest.raises(InputError, match=refused):
        spherical_with(spherical_mesh, 4e6, 8e7, 8e7, 1e-6, 0, 0)


def test_a_failed_solve_says_what_hardly_holds(spherical_mesh):
    model = spherical_with(spherical_mesh, 4e6, 8e7, 8e7, 1e-4, 0, 0)
    with pytest.raises(InputError, match=r"singular.*nearly turn about x"):
        unit_load_response(model)


def test_the_error_of_a_weak_motion_is_what_was_warned_of(spherical_mesh):
    """The shaft spins by the torque over the spring, exactly; round-off takes its digits."""
    k = 1.0
    model = spherical_with(spherical_mesh, 4e6, 8e7, 8e7, k, 0, 0)
    (found,) = weak_restraints(model.mesh, model.constraints, model.springs, moduli(model))
    held = spherical_with(spherical_mesh, 4e6, 8e7, 8e7, "rigid", 0, 0)
    spin = unit_load_response(model).motions["hub"][3, 3]
    exact = unit_load_response(held).motions["hub"][3, 3] + 1.0 / k
    expected = 2.2e-16 / found.ratio
    # an estimate of round-off is right within a decade or two to either side
    assert 1e-2 * expected < abs(spin / exact - 1.0) < 1e2 * expected


def test_a_warning_reaches_the_progress_lines_and_the_page(spherical_mesh, tmp_path):
    changes = {"gearbox.stiffness": [4e6, 8e7, 8e7, 1.0, 0, 0]}
    scene = change_scene(coarse_scene("spherical"), changes)
    lines: list[str] = []
    run = Run({}, True, tmp_path, lambda step, lane=0: lines.append(step))
    solved = bearing_scenes.solve(run, scene, "soft", spherical_mesh)
    sentence = "shaft and main_bearing can nearly turn about x through (0, 0, 0) m"
    assert any(line.startswith(f"warning: soft: {sentence}") for line in lines)
    page = Page()
    shown.mesh_section(page, {"soft": solved})
    assert sentence in page.sections[0].items[0].caption
