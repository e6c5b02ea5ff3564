"""Random shafts: sound, various, and the same for the same seed."""

from itertools import pairwise

from fe_drivetrain.cases.verification.random_shafts import STEP, random_scene


def test_random_shafts_follow_from_their_seed_and_are_sound() -> None:
    scenes = [random_scene(seed) for seed in range(40)]
    assert scenes == [random_scene(seed) for seed in range(40)]
    for scene in scenes:
        shaft = scene.shaft
        widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
        for one, two in pairwise(shaft.pieces):
            assert abs(one.end_diameter - two.outer_diameter) > 0.5 * STEP * widest
        for unit in scene.bearing_units:
            bearing = unit.bearing
            assert shaft.seat_diameter(bearing.x, bearing.width, bearing.name) > 0
    # all that a shaft may have is among them
    pieces = [piece for scene in scenes for piece in scene.shaft.pieces]
    assert {piece.fillet > 0 for piece in pieces} == {True, False}
    assert {piece.outer_diameter_end is None for piece in pieces} == {True, False}
    assert {piece.inner_diameter > 0 for piece in pieces} == {True, False}
    assert {len(scene.bearing_units) for scene in scenes} == {1, 2}
