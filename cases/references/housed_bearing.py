"""Bearing S in the library's pillow block, enlarged to its size, for cases of flexible rings."""

from __future__ import annotations

from functools import lru_cache

from fe_drivetrain.bearing import Bearing, Races, catalogue_bearing
from fe_drivetrain.bearing_life.rings import housing_races
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene

NAME = "main_bearing"

#: Outside diameter of bearing S over that of the bearing which the block is for [mm].
ENLARGED = 939.8 / 650.0

#: Raceway where the contact lines of the rollers' middles end, width, and shaft [m].
RACEWAY, WIDTH, SHAFT = 0.848, 0.3048, 0.635

#: Where these numbers are from, as `Page.assume` takes it.
ASSUMED_HOUSING = (
    (
        "housing",
        f"library's pillow block, {ENLARGED:.3f} times",
        "-",
        "in proportion to the outside diameter, 939.8 mm (Stirling 2023, Table 4.1) over 650 mm",
    ),
    ("diameter of the raceway", RACEWAY, "m", "pitch diameter + D cos(20 deg), rounded"),
)

_SIZES = (
    "centre_height",
    "width",
    "wall",
    "foot_length",
    "foot_width",
    "foot_thickness",
    "pedestal_width",
    "bolt_diameter",
    "bolt_spacing_y",
    "bolt_spacing_x",
    "washer_diameter",
)

#: Coarsening of the mesh, and elements a turn.
Size = tuple[float, int | None]


def bearing_s(arrangement: str = "o") -> Bearing:
    """Bearing S with the contact angle of its load ratings, straight rollers in closed form."""
    return catalogue_bearing(f"bearing_s_{arrangement}20", laminae=0)


def housed_scene(size: Size = (1.0, None)) -> Scene:
    """The library's main bearing with tapered rollers, of the size of bearing S."""
    scene = library_scene("main_bearing_bonded")
    block = scene.bearing_unit(NAME).block
    unit = f"bearing_units.{NAME}"
    enlarged = {f"{unit}.housing.{key}": round(ENLARGED * getattr(block, key), 4) for key in _SIZES}
    changed = change_scene(
        scene,
        {
            **enlarged,
            f"{unit}.bearing.raceway_diameter": RACEWAY,
            f"{unit}.bearing.width": WIDTH,
            "shaft.sections.0.outer_diameter": SHAFT,
        },
    )
    return changed.model_copy(update={"mesh": changed.mesh.scaled(*size)})


@lru_cache(maxsize=8)
def housed_races(size: Size = (1.0, None), arrangement: str = "o") -> Races:
    """Its housing under the rollers of bearing S."""
    return housing_races(housed_scene(size), NAME, bearing_s(arrangement))
