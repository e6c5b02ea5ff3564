"""The catalogue entries of a scene's bearings, found and held against its shaft: one gate.

``check`` and ``life`` pass it, so that what the one takes the other does not refuse.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.drivetrain_file.scene import Scene

if TYPE_CHECKING:
    from fe_drivetrain.bearing.catalogue import Entry, Named


class NamedBearing(NamedTuple):
    """A bearing's entry of a catalogue.

    Attributes
    ----------
    name : str
        Name of the entry.
    entry : Entry
        What the catalogue says.
    seat : float
        Diameter of the shaft at the seat [m].
    misfit : str or None
        What does not fit, as a sentence; see `fe_drivetrain.bearing.seats.check_seat`.
    named : str or CataloguePage
        What the scene or the user names it by.
    """

    name: str
    entry: Entry
    seat: float
    misfit: str | None
    named: Named


def named_bearings(
    scene: Scene, catalogues: Sequence[Path], chosen: Mapping[str, Named]
) -> dict[str, NamedBearing]:
    """Catalogue entries by bearing, of those bearings that have one.

    Parameters
    ----------
    scene : Scene
        The scene.
    catalogues : Sequence[Path]
        Files of the user, beside the program's own catalogue.
    chosen : Mapping[str, str or CataloguePage]
        Entries by bearing that come before those of the scene.

    Returns
    -------
    dict[str, NamedBearing]
        In the scene's order.

    Raises
    ------
    InputError
        There is no such entry, the shaft does not go into the bearing, or all bearings roll and
        nothing holds the shaft's torque.
    """
    entries: dict[str, Named] = {
        u.bearing.name: u.catalogue for u in scene.bearing_units if u.catalogue
    }
    entries |= chosen
    if not entries and not catalogues:
        return {}
    # late, since it loads the compiled loops of bearings
    from fe_drivetrain.bearing.catalogue import name_of, read_bearing_catalogue
    from fe_drivetrain.bearing.seats import check_seat

    known, found = read_bearing_catalogue(*catalogues), {}
    for name in (unit.bearing.name for unit in scene.bearing_units):
        named = entries.get(name)
        if named is None:
            continue
        entry, seat = entry_of(name, named, known), scene.seat_diameter(name)
        misfit = check_seat(name, name_of(named), entry, seat)
        found[name] = NamedBearing(name_of(named), entry, seat, misfit, named)
    if len(found) == len(scene.bearing_units) and scene.nose is None:
        from fe_drivetrain.bearing_life.coupled.of_scene import scene_body

        scene_body(scene, 1)  # rolling bearings hold no torque, which the scene's joints may
    return found


def entry_of(name: str, named: Named, known: Mapping[str, Entry]) -> Entry:
    """The entry of a bearing by its name, or with the inside that is fitted to its page.

    Parameters
    ----------
    name : str
        Name of the bearing.
    named : str or CataloguePage
        What it is named by.
    known : Mapping[str, Entry]
        Entries of all catalogues.

    Raises
    ------
    InputError
        No catalogue has the entry, or no inside fits the page.
    """
    from fe_drivetrain.bearing.catalogue import fitted_entry

    if not isinstance(named, str):
        return fitted_entry(named)
    if named not in known:
        raise InputError(
            f"catalogue entry {shown(named)} of bearing {name!r} is in no catalogue: give a file "
            f"that has it with {argument('catalogues', ['FILE'])}, what a catalogue's page prints, "
            f"as in {{designation: {named}, C: ..., C0: ...}}, or use one of {', '.join(known)}"
        )
    return known[named]
