"""The parts and the assembly: what may be built, what is refused, and the exact shapes."""

import math

import gmsh
import numpy as np
import pytest
from pydantic import ValidationError

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.geometry import (
    Bearing,
    Flange,
    Housing,
    MeshSizes,
    Section,
    Shaft,
    build,
    check_parts,
    element_counts,
    element_sizes,
    gmsh_session,
)
from fe_drivetrain.geometry.element_sizes import _elements_beside, _size_limit


def plain_shaft(length=1.0, outer=0.4, inner=0.0):
    section = Section(length=length, outer_diameter=outer, inner_diameter=inner)
    return Shaft(front=-length / 2, sections=(section,))


def cad(shaft, bearings=(), housings=None):
    """Volumes of the parts, and areas of the named faces, of the CAD model itself."""
    with gmsh_session():
        build(shaft, bearings, housings or {}, MeshSizes())
        amounts = {}
        for dim, group in gmsh.model.getPhysicalGroups():
            tags = gmsh.model.getEntitiesForPhysicalGroup(dim, group)
            if dim:
                name = gmsh.model.getPhysicalName(dim, group)
                amounts[name] = math.fsum(gmsh.model.occ.getMass(dim, tag) for tag in tags)
        return amounts


def turned_volume(*pieces):
    """Volume of a stack of (length, outer radius, outer radius at the end, bore radius)."""
    return math.fsum(
        math.pi * length * ((a * a + a * b + b * b) / 3 - bore * bore)
        for length, a, b, bore in pieces
    )


def fillet_volume(radius, at):
    """Pappus: the spandrel between a square's corner and the quarter circle inscribed in it."""
    area = radius**2 * (1 - math.pi / 4)
    centroid = radius * (10 - 3 * math.pi) / (12 - 3 * math.pi)
    return 2 * math.pi * (at + centroid) * area


def zone_volume(sphere_diameter, width):
    return math.pi * (sphere_diameter**2 / 4 * width - width**3 / 12)


# what the parts measure


def test_length_and_rear_follow_from_flange_and_sections():
    shaft = Shaft(
        front=-2.0,
        flange=Flange(outer_diameter=1.0, thickness=0.1),
        sections=(Section(length=1.5, outer_diameter=0.5), Section(length=2, outer_diameter=0.4)),
    )
    assert shaft.length == pytest.approx(3.6, abs=1e-15)
    assert shaft.rear == pytest.approx(1.6, abs=1e-15)


def test_a_part_survives_a_round_trip_through_plain_data():
    shaft = Shaft(
        front=-1.0,
        flange=Flange(outer_diameter=1.0, thickness=0.1),
        sections=(Section(length=1, outer_diameter=0.5, outer_diameter_end=0.4),),
    )
    housing = Housing(base="bolted", material="cast_steel")
    for part in (shaft, Bearing(kind="ring", x=0.3), housing, MeshSizes(shaft=0.2)):
        assert type(part).model_validate(part.model_dump(mode="json")) == part


def test_parts_are_frozen():
    with pytest.raises(ValidationError, match="frozen"):
        Bearing().width = 0.3


@pytest.mark.parametrize("part", [Housing(), Bearing()])
def test_assumptions_cover_every_dimension_with_unit_and_source(part):
    rows = {row.name: row for row in part.assumptions()}
    # the position of a bearing belongs to the scene, not to the bearing
    dimensions = {n for n, v in part if n not in ("name", "kind", "base", "material", "x")}
    assert set(rows) == dimensions
    for row in rows.values():
        assert row.unit == "m"
        assert row.source.startswith("assumed: ")


def test_a_changed_dimension_no_longer_claims_the_default_s_source():
    rows = {row.name: row for row in Housing(wall=0.15).assumptions()}
    assert rows["wall"].value == 0.15
    assert rows["wall"].source == "given by the scene"
    assert rows["width"].source != "given by the scene"


# the solids, against closed forms (the CAD model is exact but for the integration of its kernel)


@pytest.mark.parametrize(
    ("shaft", "volume"),
    [
        (plain_shaft(), turned_volume((1.0, 0.2, 0.2, 0))),
        (plain_shaft(inner=0.3), turned_volume((1.0, 0.2, 0.2, 0.15))),
        (
            Shaft(
                front=0,
                sections=(
                    Section(length=0.5, outer_diameter=0.4, inner_diameter=0.1),
                    Section(length=0.3, outer_diameter=0.6),
                    Section(length=0.2, outer_diameter=0.5, inner_diameter=0.2),
                ),
            ),
            turned_volume((0.5, 0.2, 0.2, 0.05), (0.3, 0.3, 0.3, 0), (0.2, 0.25, 0.25, 0.1)),
        ),
        (
            Shaft(
                front=0,
                sections=(Section(length=0.7, outer_diameter=0.6, outer_diameter_end=0.3),),
            ),
            turned_volume((0.7, 0.3, 0.15, 0)),
        ),
        (
            Shaft(
                front=0,
                flange=Flange(outer_diameter=0.9, thickness=0.1, fillet=0.05),
                sections=(
                    Section(length=0.5, outer_diameter=0.4, inner_diameter=0.1, fillet=0.03),
                    Section(length=0.3, outer_diameter=0.5, inner_diameter=0.1),
                ),
            ),
            turned_volume((0.1, 0.45, 0.45, 0.05), (0.5, 0.2, 0.2, 0.05), (0.3, 0.25, 0.25, 0.05))
            + fillet_volume(0.05, 0.2)
            + fillet_volume(0.03, 0.2),
        ),
        # a fillet as large as its step: the shoulder is all arc
        (
            Shaft(
                front=0,
                sections=(
                    Section(length=0.5, outer_diameter=0.4, fillet=0.05),
                    Section(length=0.3, outer_diameter=0.5),
                ),
            ),
            turned_volume((0.5, 0.2, 0.2, 0), (0.3, 0.25, 0.25, 0)) + fillet_volume(0.05, 0.2),
        ),
    ],
    ids=["solid", "bored", "stepped", "tapered", "filleted", "full fillet"],
)
def test_volume_of_a_shaft_is_the_closed_form(shaft, volume):
    assert cad(shaft)["shaft"] == pytest.approx(volume, rel=1e-6)


def test_a_fillet_beside_a_taper_is_tangent_to_both_its_neighbours():
    shaft = Shaft(
        front=0,
        sections=(
            Section(length=0.5, outer_diameter=0.3, outer_diameter_end=0.4, fillet=0.04),
            Section(length=0.3, outer_diameter=0.6),
        ),
    )
    taper, arc, shoulder, _ = shaft.outer_profile()
    assert arc.centre is not None
    for point, line in ((arc.start, taper), (arc.end, shoulder)):
        radius = np.subtract(point, arc.centre)
        assert np.hypot(*radius) == pytest.approx(0.04, rel=1e-12)
        assert radius @ np.subtract(line.end, line.start) == pytest.approx(0, abs=1e-15)
    # on the taper, not beyond it
    assert arc.start[1] == pytest.approx(0.15 + 0.05 * arc.start[0] / 0.5, rel=1e-12)


def test_bearing_and_housing_are_the_closed_forms():
    bearing, housing = Bearing(bore_diameter=0.4), Housing()
    amounts = cad(None, [bearing], {bearing.name: housing})
    outer = bearing.raceway_diameter / 2 + housing.wall
    foot = housing.foot_length * housing.foot_width * housing.foot_thickness
    flank = housing.centre_height - housing.foot_thickness
    block = housing.width * (math.pi * outer**2 / 2 + 2 * outer * flank) + foot
    zone = math.pi * bearing.raceway_diameter * bearing.width
    assert amounts["main_bearing"] == pytest.approx(
        zone_volume(0.6, bearing.width) - math.pi * 0.2**2 * bearing.width, rel=1e-6
    )
    assert amounts["main_bearing.housing"] == pytest.approx(
        block - zone_volume(0.6, housing.width), rel=1e-6
    )
    assert amounts["main_bearing.housing.base"] == pytest.approx(
        housing.foot_length * housing.foot_width, rel=1e-9
    )
    # the bore is wider than the bearing: only the zone under the bearing is the joint
    assert amounts["main_bearing.outer"] == pytest.approx(zone, rel=1e-6)
    assert amounts["main_bearing.housing.bore"] == pytest.approx(zone, rel=1e-6)


def test_ring_and_seat_are_cylinders():
    bearing = Bearing(kind="ring", raceway_diameter=0.56, width=0.16, x=0.1)
    amounts = cad(plain_shaft(), [bearing], {bearing.name: Housing()})
    assert amounts["main_bearing"] == pytest.approx(
        turned_volume((0.16, 0.28, 0.28, 0.2)), rel=1e-9
    )
    assert amounts["main_bearing.outer"] == pytest.approx(math.pi * 0.56 * 0.16, rel=1e-9)
    assert amounts["shaft.seat.main_bearing"] == pytest.approx(math.pi * 0.4 * 0.16, rel=1e-9)


def test_bolted_base_is_the_four_washer_footprints():
    bearing = Bearing(bore_diameter=0.4)
    fixed = cad(None, [bearing], {bearing.name: Housing()})
    bolted = cad(None, [bearing], {bearing.name: Housing(base="bolted")})
    housing = Housing()
    washer, hole = housing.washer_diameter, housing.bolt_diameter
    assert bolted["main_bearing.housing.base"] == pytest.approx(
        math.pi * (washer**2 - hole**2), rel=1e-9
    )
    assert fixed["main_bearing.housing"] - bolted["main_bearing.housing"] == pytest.approx(
        math.pi * hole**2 * housing.foot_thickness, rel=1e-5
    )


def test_bore_of_the_shaft_is_its_cylindrical_walls_only():
    shaft = Shaft(
        front=0,
        sections=(
            Section(length=0.5, outer_diameter=0.6, inner_diameter=0.25),
            Section(length=0.3, outer_diameter=0.3, inner_diameter=0.1),
        ),
    )
    amounts = cad(shaft)
    assert amounts["shaft.bore"] == pytest.approx(math.pi * (0.25 * 0.5 + 0.1 * 0.3), rel=1e-9)
    assert amounts["shaft.front"] == pytest.approx(math.pi * (0.3**2 - 0.125**2), rel=1e-9)
    assert amounts["shaft.rear"] == pytest.approx(math.pi * (0.15**2 - 0.05**2), rel=1e-9)


def test_two_bearings_with_two_housings_on_a_stepped_shaft():
    shaft = Shaft(
        front=-1.0,
        flange=Flange(outer_diameter=0.9, thickness=0.1),
        sections=(
            Section(length=1.3, outer_diameter=0.4, inner_diameter=0.1, fillet=0.02),
            Section(length=0.1, outer_diameter=0.46, inner_diameter=0.1),
            Section(length=0.8, outer_diameter=0.42, outer_diameter_end=0.3, inner_diameter=0.1),
            Section(length=0.6, outer_diameter=0.3, inner_diameter=0.1),
        ),
    )
    front = Bearing(name="front")
    rear = Bearing(name="rear", x=1.5, kind="ring", raceway_diameter=0.5, width=0.16)
    amounts = cad(shaft, [front, rear], {"front": Housing(), "rear": Housing()})
    names = {"shaft", "shaft.front", "shaft.rear", "shaft.bore"}
    for bearing in ("front", "rear"):
        names |= {bearing, f"shaft.seat.{bearing}", f"{bearing}.bore", f"{bearing}.outer"}
        names |= {f"{bearing}.housing{end}" for end in ("", ".bore", ".base")}
    assert set(amounts) == names
    assert amounts["rear"] == pytest.approx(turned_volume((0.16, 0.25, 0.25, 0.15)), rel=1e-9)
    assert amounts["shaft.seat.front"] == pytest.approx(math.pi * 0.4 * 0.2, rel=1e-9)


def test_a_bearing_against_a_shoulder_is_bonded_to_it_too():
    shaft = Shaft(
        front=-0.1,
        sections=(
            Section(length=0.5, outer_diameter=0.4),
            Section(length=0.2, outer_diameter=0.46),
        ),
    )
    amounts = cad(shaft, [Bearing(x=0.3)])
    shoulder = math.pi * (0.23**2 - 0.2**2)
    assert amounts["shaft.seat.main_bearing"] == pytest.approx(
        math.pi * 0.4 * 0.2 + shoulder, rel=1e-9
    )


# what is refused


def section(**changes):
    return Section(**{"length": 1.0, "outer_diameter": 0.4, **changes})


def stepped(fillet, next_length=0.5, last_fillet=0.0):
    return Shaft(
        front=0,
        sections=(
            section(outer_diameter=0.5, fillet=fillet),
            section(length=next_length, outer_diameter=0.4, fillet=last_fillet),
            section(outer_diameter=0.5),
        ),
    )


@pytest.mark.parametrize(
    ("attempt", "words"),
    [
        (lambda: section(length=0), "section: length is 0 but must be at least 1e-06"),
        (lambda: section(length=-1), "length is -1"),
        (lambda: section(length=math.nan), "length is nan"),
        (lambda: section(length="long"), "length is 'long'"),
        (lambda: section(outer_diameter=-0.1), "outer_diameter is -0.1"),
        (lambda: section(inner_diameter=-0.1), "inner_diameter is -0.1 but must be at least 0"),
        (lambda: section(inner_diameter=0.4), "inner_diameter is 0.4 m but must be less than"),
        (
            lambda: section(inner_diameter=0.3, outer_diameter_end=0.2),
            "must be less than the outer diameter, 0.2 m",
        ),
        (lambda: section(fillet=-0.01), "fillet is -0.01"),
        (lambda: section(diameter=1), "unknown key 'diameter'"),
        (
            lambda: Section(length=1),
            "section: outer_diameter (outer diameter at the front, m) is missing",
        ),
        (lambda: Shaft(front=0, sections=()), "sections"),
        (lambda: Shaft(front=math.inf, sections=(section(),)), "front is inf"),
        (
            lambda: Shaft(front=0, sections=[{"length": 1, "outer_diameter": 0.4}, {"length": 1}]),
            "shaft section 2: outer_diameter (outer diameter at the front, m) is missing",
        ),
        (lambda: stepped(0.06), "fillet is 0.06 m but must be at most 0.05 m"),
        (lambda: stepped(0.05, next_length=0.04), "needs 0.05 m of a section 0.04 m long"),
        (lambda: stepped(0.04, next_length=0.07, last_fillet=0.04), "needs 0.08 m"),
        (
            lambda: Shaft(front=0, sections=(section(fillet=0.01), section())),
            "fillet is 0.01 m but must be at most 0 m",
        ),
        (lambda: Shaft(front=0, sections=(section(fillet=0.01),)), "no step behind it"),
        (
            lambda: Shaft(
                front=0,
                sections=(section(inner_diameter=0.3), section(outer_diameter=0.3)),
            ),
            "step at x = 1 m: the bore is 0.3 m but must be less than the outer diameter, 0.3 m",
        ),
        (lambda: Flange(outer_diameter=1, thickness=0), "thickness is 0"),
        (
            lambda: Shaft(
                front=0,
                flange=Flange(outer_diameter=0.2, thickness=0.1),
                sections=(section(inner_diameter=0.3),),
            ),
            "inner_diameter is 0.3 m",
        ),
        (lambda: Bearing(name="a.b"), "name is 'a.b'"),
        (lambda: Bearing(name="shaft"), "name is 'shaft'"),
        (lambda: Bearing(width=0), "width is 0"),
        (lambda: Bearing(width=0.7), "less than the diameter of its sphere, 0.6 m"),
        (lambda: Bearing(kind="ball"), "kind is 'ball'"),
        (lambda: Bearing(bore_diameter=0.58), "its bore is 0.58 m but must be less than 0.565"),
        (lambda: Housing(wall=0), "wall is 0"),
        (lambda: Housing(foot_thickness=0.5), "foot_thickness is 0.5 m but must be less than"),
        (lambda: Housing(pedestal_width=1.5), "pedestal_width is 1.5 m"),
        (lambda: Housing(base="bolted", bolt_diameter=0.1), "bolt_diameter is 0.1 m"),
        (lambda: Housing(base="bolted", bolt_spacing_x=0.05), "washer_diameter is 0.092 m"),
        (lambda: Housing(base="bolted", bolt_spacing_x=0.3), "bolt_spacing_x is 0.3 m"),
        (lambda: Housing(base="bolted", bolt_spacing_y=1.2), "bolt_spacing_y is 1.2 m"),
        (lambda: Housing(base="bolted", bolt_spacing_y=0.9), "pedestal_width is 0.82 m"),
        (lambda: MeshSizes(shaft=0), "shaft is 0"),
        (lambda: MeshSizes(elements_per_turn=3), "elements_per_turn is 3 but must be at least 6"),
    ],
)
def test_a_wrong_part_is_refused_in_one_sentence(attempt, words):
    with pytest.raises(InputError) as caught:
        attempt()
    message = str(caught.value)
    assert words in message
    assert "\n" not in message
    assert ": " in message, "the fix follows a colon"


def test_unused_bolt_dimensions_do_not_stand_in_the_way():
    assert Housing(base="fixed", bolt_spacing_y=0.5).bolt_spacing_y == 0.5


def assemble(shaft=None, bearings=None, housings=None, sizes=None, bonded=frozenset()):
    bearings = [Bearing()] if bearings is None else bearings
    housings = {"main_bearing": Housing()} if housings is None else housings
    with gmsh_session():
        build(shaft, bearings, housings, sizes or MeshSizes(), bonded)
        return {
            gmsh.model.getPhysicalName(*group): sum(
                gmsh.model.occ.getMass(3, tag)
                for tag in gmsh.model.getEntitiesForPhysicalGroup(*group)
            )
            for group in gmsh.model.getPhysicalGroups(3)
        }


SHAFT = plain_shaft(2.0)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"bearings": [], "housings": {}}, "no shaft and no bearing"),
        ({"shaft": SHAFT, "bearings": [Bearing(), Bearing(x=0.5)]}, "given twice"),
        ({"shaft": SHAFT, "housings": {"other": Housing()}}, "housing 'other' has no bearing"),
        ({"shaft": SHAFT, "bonded": frozenset({"other"})}, "bonded bearing 'other'"),
        ({"shaft": SHAFT, "housings": {}, "bonded": frozenset({"main_bearing"})}, "bonded bearing"),
        ({}, "'main_bearing' has no bore_diameter"),
        ({"shaft": SHAFT, "bearings": [Bearing(x=0.95)]}, "x = 0.85 to 1.05 m but must lie on"),
        ({"shaft": SHAFT, "bearings": [Bearing(x=5)]}, "bearing 'main_bearing': its seat"),
        # wider than its section; over a taper; over a fillet
        (
            {
                "shaft": Shaft(
                    front=-0.05,
                    sections=(section(length=0.1), section(outer_diameter=0.38)),
                )
            },
            "its seat on the shaft is x = -0.1 to 0.1 m",
        ),
        (
            {"shaft": Shaft(front=-0.5, sections=(section(outer_diameter_end=0.3),))},
            "(none m)",
        ),
        (
            {
                "shaft": Shaft(
                    front=-0.88, sections=(section(fillet=0.03), section(outer_diameter=0.5))
                )
            },
            "-0.88 to 0.09",
        ),
        ({"shaft": SHAFT, "bearings": [Bearing(bore_diameter=0.41)]}, "'shaft' and 'main_bearing'"),
        ({"shaft": SHAFT, "bearings": [Bearing(raceway_diameter=0.42)]}, "its bore is 0.4 m"),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(bore_diameter=0.61)}},
            "parts 'main_bearing' and 'main_bearing.housing' do not touch",
        ),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(bore_diameter=0.59)}},
            "parts 'main_bearing' and 'main_bearing.housing' overlap",
        ),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(width=0.45)}},
            "0.396863 m in diameter but must be greater than the shaft, 0.4 m",
        ),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(width=0.65)}},
            "the bore has no opening",
        ),
        # a shoulder inside the housing that the bore does not clear
        (
            {
                "shaft": Shaft(
                    front=-0.12, sections=(section(length=0.24), section(outer_diameter=0.56))
                )
            },
            "opening at x = 0.12 m",
        ),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(centre_height=0.3)}},
            "breaks through the base",
        ),
        (
            {"shaft": SHAFT, "housings": {"main_bearing": Housing(pedestal_width=0.2)}},
            "breaks through its flanks",
        ),
        (
            {"shaft": SHAFT, "sizes": MeshSizes(housing=0.4)},
            "part 'main_bearing.housing': mesh size 'housing' is 0.4 m but must be at most 0.3 m, "
            "3 times its foot of 0.1 m",
        ),
        (
            {"shaft": plain_shaft(2.0, inner=0.39)},
            "part 'shaft': mesh size 'shaft'",
        ),
        ({"shaft": SHAFT, "sizes": MeshSizes(bearing=0.001)}, "which makes about"),
        (
            {
                "shaft": SHAFT,
                "bearings": [Bearing(), Bearing(name="b", x=0.3)],
                "housings": {"main_bearing": Housing(), "b": Housing()},
            },
            "parts 'main_bearing.housing' and 'b.housing' overlap",
        ),
        # foot against foot, and bearing against bearing
        (
            {
                "shaft": SHAFT,
                "bearings": [Bearing(), Bearing(name="b", x=0.36)],
                "housings": {"main_bearing": Housing(), "b": Housing()},
            },
            "parts 'main_bearing.housing' and 'b.housing' touch",
        ),
        (
            {
                "shaft": SHAFT,
                "bearings": [Bearing(), Bearing(name="b", x=0.2)],
                "housings": {},
            },
            "parts 'main_bearing' and 'b' touch",
        ),
    ],
)
def test_an_assembly_that_does_not_fit_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(InputError) as caught:
        assemble(**arguments)
    message = str(caught.value)
    assert words in message
    assert "\n" not in message
    assert not gmsh.isInitialized()


def test_a_pedestal_much_wider_than_its_shell_is_built():
    """Its flanks lean away from the bore: the shell's own wall is what is left beside it."""
    housing = Housing(wall=0.03, pedestal_width=1.2)
    housing.check_fits(Bearing(), None)
    with pytest.raises(InputError, match="flanks"):
        Housing(wall=0.03, pedestal_width=0.3).check_fits(Bearing(), None)


def test_a_housing_just_wide_enough_to_clear_the_shaft_is_built():
    # sqrt(0.3^2 - 0.22^2) = 0.20396 > 0.2
    wide = {"main_bearing": Housing(width=0.44, foot_width=0.44)}
    assert assemble(plain_shaft(2.0), housings=wide).keys() == {
        "shaft",
        "main_bearing",
        "main_bearing.housing",
    }


def two_sections(one, two):
    return Shaft(front=0.0, sections=(section(**one), section(**two)))


@pytest.mark.parametrize(
    ("shaft", "words"),
    [
        # a step of two micrometres; a collar as short; a bore as narrow
        (two_sections({}, {"outer_diameter": 0.400004}), "radius 0.2 to 0.200002 m"),
        (two_sections({"length": 2e-6}, {"outer_diameter": 0.5}), "a length of 2e-06 m"),
        (two_sections({}, {"inner_diameter": 4e-6}), "must have at least 1e-05 m, or none"),
        # what a fillet leaves of its step
        (two_sections({"fillet": 0.0499999}, {"outer_diameter": 0.5}), "a length of 1e-07 m"),
        # a bore of a tenth of a millimetre is no detail too fine, but costs too many elements
        (plain_shaft(inner=1e-4), "must make at most 1e+06: leave that detail out"),
        (plain_shaft(2000.0, 700.0), "2 and 0.7 m if these were millimetres"),
    ],
)
def test_details_that_no_mesh_can_follow_are_refused_at_once(shaft, words):
    with pytest.raises(InputError) as caught:
        assemble(shaft, [], {})
    assert words in str(caught.value)
    assert "gmsh" not in str(caught.value)


def test_millimetres_are_refused_in_bearings_and_housings_too():
    millimetres = Bearing(width=200.0, raceway_diameter=600.0, bore_diameter=400.0)
    with pytest.raises(InputError, match="bearing 'main_bearing' is 200 m long and 600 m wide"):
        assemble(None, [millimetres], {})
    housing = Housing(foot_length=1250.0)
    with pytest.raises(InputError, match=r"housing of 'main_bearing'.*1\.25 m if these were"):
        assemble(SHAFT, housings={"main_bearing": housing})


def test_lengths_within_the_tolerance_are_one_length_and_no_detail():
    shaft = two_sections({}, {"outer_diameter": 0.4 + 1e-10})
    volume = np.pi / 4 * 0.4**2 * shaft.length
    assert assemble(shaft, [], {}) == {"shaft": pytest.approx(volume, rel=1e-8)}


def test_the_number_of_elements_beside_a_narrow_face_is_foreseen():
    """A step of half a millimetre, within a factor of two of what gmsh makes of it."""
    shaft = two_sections({"length": 0.5}, {"length": 0.5, "outer_diameter": 0.401})
    with gmsh_session():
        build(shaft, [], {}, MeshSizes(shaft=0.3))
        annulus = [
            tag for _, tag in gmsh.model.getEntities(2) if gmsh.model.occ.getMass(2, tag) < 1e-3
        ]
        foreseen = _elements_beside(annulus[0], _size_limit(annulus[0], 12))
        gmsh.model.mesh.generate(3)
        made = len(gmsh.model.mesh.getElementsByType(4)[0])
    assert len(annulus) == 1
    assert made / 2 < foreseen < made * 2


# the session


def test_session_closes_gmsh_and_lets_foreign_errors_through():
    with pytest.raises(KeyError), gmsh_session():
        raise KeyError("mine")
    assert not gmsh.isInitialized()


def test_session_quotes_gmsh_s_own_message():
    with pytest.raises(InputError, match="NoSuchOption"), gmsh_session():
        gmsh.option.setNumber("Mesh.NoSuchOption", 1)
    assert not gmsh.isInitialized()


def test_session_refuses_to_open_twice_and_leaves_the_first_open():
    with gmsh_session():
        with pytest.raises(InputError, match=r"gmsh\.finalize"), gmsh_session():
            pass
        assert gmsh.isInitialized()
    assert not gmsh.isInitialized()


@pytest.mark.parametrize(
    "name",
    ["three_point_suspension", "nrel_750kw_high_speed_shaft", "iea_15mw_main_shaft"],
)
def test_elements_are_foreseen_from_dimensions_as_from_the_cad_model(name, monkeypatch):
    """In closed form as gmsh measures its faces; chords of arcs and spheres' seams within 2 %."""
    scene = change_scene(library_scene(name), {"mesh.elements_per_turn": 24})
    bearings = [unit.bearing for unit in scene.bearing_units]
    bores = check_parts(scene.shaft, bearings, scene.blocks)
    found = {}
    for module in (element_sizes, element_counts):
        store = found.setdefault(module, {})
        within = module.elements_within
        monkeypatch.setattr(
            module,
            "elements_within",
            lambda part, volume, size, store=store, within=within: store.setdefault(
                part, within(part, volume, size)
            ),
        )
        monkeypatch.setattr(
            module,
            "refuse_too_many",
            lambda part, x, y, size, elements, store=store: store.update({part: elements}),
        )
    with gmsh_session():
        build(scene.shaft, bearings, scene.blocks, scene.mesh, bands=scene.seats)
    element_counts.check_counts(scene.shaft, bearings, scene.blocks, bores, scene.mesh, scene.seats)
    in_cad, foreseen = found[element_sizes], found[element_counts]
    assert in_cad.keys() == foreseen.keys()
    assert foreseen == pytest.approx(in_cad, rel=0.02)
