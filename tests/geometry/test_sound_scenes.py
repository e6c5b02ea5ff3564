"""A scene that the top level refuses is refused everywhere, with one sentence."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.geometry import (
    Bearing,
    Housing,
    MeshSizes,
    Section,
    Shaft,
    build,
    check_parts,
    gmsh_session,
)
from fe_drivetrain.shafts.fidelity.ladder import shaft_level, statics_level

#: What is wrong, as settings of a scene of the library, and what the sentence must say.
FAULTS = {
    "no gearbox": (["gearbox.stiffness=[0,0,0,0,0,0]"], "turn freely about y through (0, 0, 0) m"),
    "no vertical spring": (["gearbox.stiffness.2=0"], "turn freely about y"),
    "no torque reaction": (["gearbox.stiffness.3=0"], "turn freely about x"),
    "spring of round-off": (["gearbox.stiffness.2=1e-5"], "mechanism within round-off"),
    "spring of nothing": (["gearbox.stiffness.2=1e-300"], "from 1e-06 to 1e+16"),
    "opening": (
        ["shaft.sections.0.outer_diameter=0.55"],
        "its opening at x = -0.15 m is 0.519615 m in diameter but must be greater than the shaft",
    ),
    "bore of bearing": (
        ["bearing_units.0.bearing.bore_diameter=0.5"],
        "bore_diameter is 0.5 m but the shaft is 0.4 m there",
    ),
    "bearing off the shaft": (
        ["bearing_units.0.bearing.x=5"],
        "must lie on one cylindrical length",
    ),
    "millimetres": (["shaft.sections.0.length=4760"], "4.76 and 0.0004 m if these were milli"),
    "tonnes": (
        [
            "materials.steel.youngs_modulus=2e11",
            "materials.steel.poisson_ratio=0.3",
            "materials.steel.density=7.85",
        ],
        "7850 if it is in t/m^3",
    ),
    "weight": (["gearbox.weight=1e308"], "must be at most 1e+09"),
    "a section in millimetres": (
        ["shaft.sections.0.length=700"],
        "shaft is 700 m long and 0.4 m wide, but must be at most 50 m long",
    ),
    "bolts in millimetres that nothing uses": (
        ["bearing_units.0.housing.bolt_spacing_y=1060"],
        "less than foot_length less washer_diameter, 1.158 m (lengths are in metres: 1.06 m if",
    ),
    "foot of a sheet": (
        ["bearing_units.0.housing.foot_thickness=0.00013"],
        "must be at most 0.00039 m, 3 times its foot of 0.00013 m",
    ),
    "foot under a collar": (
        [
            "shaft.flange.outer_diameter=0.8",
            "shaft.flange.thickness=0.1",
            "shaft.front=-0.5",
            "bearing_units.0.housing.foot_width=0.9",
        ],
        "its foot of width 0.9 m has room for a radius of 0.32 m at x = -0.4 m",
    ),
    "mesh for a thick wall": (
        ["shaft.sections.0.inner_diameter=0.39"],
        "mesh size 'shaft' is 0.1",
    ),
    "mesh of dust": (["mesh.shaft=1e-3"], "must make at most 1e+06"),
    "a truth value in a list": (
        ["gearbox.stiffness=[4e6, 8e7, 8e7, true, 0, 0]"],
        "gearbox.stiffness: a truth value has no meaning here",
    ),
}
ADVISE = ["advise", "SCENE", "--quantity", "main_bearing.Fz", "--load", "hub.Fz=-3e5"]
EXPORT = ["export", "SCENE", "--out", "out", "--format", "json"]
ENTRIES = {
    "check": ["check", "SCENE"],
    "study": ["study", "SCENE"],
    "compare": ["compare", "SCENE", "two_bearings"],
    "life": ["life", "SCENE", "--loads", "none.csv"],
    "advise": ADVISE,
    "uncertainty": ["uncertainty", "SCENE", "--level", "1"],
    "shaft": [*EXPORT, "--level", "1"],
    "drivetrain": [*EXPORT, "--what", "drivetrain", "--level", "2"],
    "assembly": [*EXPORT, "--what", "drivetrain", "--level", "4"],
    "bearing": [*EXPORT, "--what", "main_bearing"],
    "summary": [*EXPORT, "--what", "summary"],
    "modes": [*EXPORT, "--modes", "3"],
    "CalculiX": ["export", "SCENE", "--out", "out.inp"],
    "mesh": ["export", "SCENE", "--out", "out.vtu"],
}


@pytest.mark.parametrize("fault", FAULTS)
def test_every_entry_refuses_a_fault_with_the_same_sentence(fault, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    settings, says = FAULTS[fault]
    sentences = set()
    for entry in ENTRIES.values():
        words = ["main_bearing_spherical" if word == "SCENE" else word for word in entry]
        with pytest.raises(SystemExit) as exit_:
            main([*words, *(w for s in settings for w in ("--set", s))])
        assert exit_.value.code == 2
        printed = capsys.readouterr()
        assert printed.out == ""
        sentences.add(printed.err)
    (sentence,) = sentences
    assert says in sentence
    assert len(sentence.strip().splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


def test_the_scenes_that_are_refused_differ_from_sound_ones_by_the_fault_alone():
    scene = library_scene("main_bearing_spherical")
    assert change_scene(scene, {"gearbox.stiffness.2": 1e3}) != scene
    assert change_scene(scene, {"shaft.sections.0.outer_diameter": 0.5}) != scene


def two_units(**second: object) -> dict[str, object]:
    """The unit of the spherical scene, and the same again with other values of its bearing."""
    unit = library_scene("main_bearing_spherical").bearing_units[0].model_dump(mode="json")
    other = {**unit, "bearing": {**unit["bearing"], "name": "b", **second}}
    return {"bearing_units": [unit, other]}


@pytest.mark.parametrize(
    ("x", "says"),
    [
        (0.1, "'main_bearing' and 'b' overlap"),
        (-0.1, "'main_bearing' and 'b' overlap"),
        (0.2, "'main_bearing' and 'b' touch"),
        (0.24, "'main_bearing' and 'b.housing' overlap"),
        (0.3, "'main_bearing.housing' and 'b.housing' overlap"),
        (-0.35, "'main_bearing.housing' and 'b.housing' overlap"),
        (0.36, "'main_bearing.housing' and 'b.housing' touch"),
    ],
)
def test_bearing_units_in_each_other_are_refused_as_they_are_read(x, says):
    scene = library_scene("main_bearing_spherical")
    with pytest.raises(InputError, match=says):
        change_scene(scene, two_units(x=x))


def test_bearing_units_beside_each_other_are_taken():
    scene = change_scene(library_scene("main_bearing_spherical"), two_units(x=0.3601))
    assert [unit.bearing.x for unit in scene.bearing_units] == [0.0, 0.3601]


def fits_in_cad(shaft, bearings, housings) -> bool:
    """Whether the CAD model can be built, without the check of dimensions before it."""
    from fe_drivetrain.geometry import assembly

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            assembly,
            "check_parts",
            lambda shaft, bearings, housings, bonded: {
                b.name: shaft.seat_diameter(b.x, b.width, b.name) for b in bearings
            },
        )
        try:
            with gmsh_session():
                build(shaft, bearings, housings, MeshSizes())
        except InputError:
            return False
        return True


def test_dimensions_decide_as_the_cad_model_does():
    """Random pairs of units: the check without CAD refuses what CAD finds in contact, no more."""
    random = np.random.default_rng(7)
    shaft = Shaft(front=-1.0, sections=[Section(length=3.0, outer_diameter=0.4)])
    decided = []
    for _ in range(24):
        bearings, housings = [], {}
        for name, x in (("a", 0.0), ("b", random.uniform(0.15, 0.5))):
            kind = str(random.choice(["spherical", "ring"]))
            raceway, width = random.uniform(0.55, 0.75), random.uniform(0.1, 0.2)
            bearings.append(
                Bearing(name=name, x=x, kind=kind, width=width, raceway_diameter=raceway)
            )
            housings[name] = Housing(
                centre_height=random.uniform(0.45, 0.7),
                width=random.uniform(0.1, 0.3),
                foot_width=random.uniform(0.1, 0.4),
                pedestal_width=raceway + 0.22,
            )
        try:
            check_parts(shaft, bearings, housings)
            fits = True
        except InputError as error:
            assert "overlap" in str(error) or "touch" in str(error)  # noqa: PT017
            fits = False
        assert fits == fits_in_cad(shaft, bearings, housings)
        decided.append(fits)
    assert 4 < sum(decided) < 20


def test_levels_answer_what_is_sound():
    """The shaft that every level holds: statics and beam agree where statics decides."""
    scene = coarse_scene("spherical")
    statics, beam = statics_level(scene), shaft_level(scene, 1)
    row = statics.reaction_matrices["main_bearing"][2]
    np.testing.assert_allclose(row, beam.reaction_matrices["main_bearing"][2], atol=1e-12)


def test_of_a_thousand_sections_the_ones_beside_the_bearing_are_named():
    sections = [Section(length=0.01, outer_diameter=0.4 + 0.01 * (k % 2)) for k in range(1000)]
    shaft = Shaft(front=-5.0, sections=sections)
    with pytest.raises(InputError, match=r"\(-0\.01 to .* to 0\.02 m\): move") as refused:
        shaft.seat_diameter(0.003, 0.2, "b")
    assert str(refused.value).count(" to ") == 4  # the seat and three sections
