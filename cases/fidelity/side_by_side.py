"""One scene at levels 1 and 2: what beam theory costs beside what its supports do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.solve import Condensed, keep_points
from fe_drivetrain.report import Chart, bars
from fe_drivetrain.report.suite import Page
from fe_drivetrain.shafts.fidelity import (
    Quantity,
    beam_shaft,
    housing_springs,
    meridian_shaft,
    shaft_level,
    simplified,
)

#: What is compared, in words; FORCE is that of the first bearing.
FORCE = "Fz"
QUANTITIES = {
    "hub.stiffness.uz": "Bending: stiffness of the hub along z",
    "hub.stiffness.rx": "Torsion: stiffness of the hub about x",
    FORCE: "Force: of the first bearing along z, of all hub loads",
}

_MINIMUM = 1e-3  # percent: a place on a logarithmic axis


@dataclass(frozen=True)
class Changes:
    """What one quantity does when a part of its model is replaced, relative.

    Attributes
    ----------
    beam : float
        The meridian by a beam.
    bare : float
        The same, of a shaft without the rings of its bearings.
    housings : float
        Housings as springs by rigid ones.
    faces : float
        Housings whose faces keep in shape by such whose faces move on average.
    """

    beam: float
    bare: float
    housings: float
    faces: float


@dataclass(frozen=True)
class Compared:
    """A scene side by side.

    Attributes
    ----------
    scene : str
        Name.
    slenderness : float
        Length of the shaft over its largest diameter, the flange aside.
    changes : dict of str to Changes
        By key of `QUANTITIES`.
    stiffer_on_softer : float
        Largest share by which a motion of the hub is stiffer where its supports are softer; none
        is above 0 (Rayleigh).
    stiffer_than_beam : float
        Share by which the free shaft's meridian is stiffer in torsion than its beam, fillets left
        out; not above 0, because a beam keeps its sections plane and round.
    """

    scene: str
    slenderness: float
    changes: dict[str, Changes]
    stiffer_on_softer: float
    stiffer_than_beam: float


def compared(name: str, scene: Scene) -> Compared:
    """Solve a scene with beam and meridian, on rigid housings and on two bounds of springs."""
    beam, meridian = beam_shaft(scene), meridian_shaft(scene)
    stiff, soft = (housing_springs(scene, coupling=c)[0] for c in ("rigid", "averaged"))
    models = {
        "beam": shaft_level(scene, 1, stiff, beam),
        "rigid": shaft_level(scene, 2, None, meridian),
        "stiff": shaft_level(scene, 2, stiff, meridian),
        "soft": shaft_level(scene, 2, soft, meridian),
        "bare beam": shaft_level(scene, 1, stiff, beam_shaft(scene, rings=False)),
        "bare meridian": shaft_level(scene, 2, stiff, meridian_shaft(scene, rings=False)),
    }
    changes = {}
    for key in QUANTITIES:
        first = scene.bearing_units[0].bearing.name
        quantity = Quantity(f"{first}.{key}" if key == FORCE else key)
        values = {which: quantity.of(model, scene.shaft.length) for which, model in models.items()}
        changes[key] = Changes(
            *(
                float(np.linalg.norm(values[new] - values[old]) / np.linalg.norm(values[old]))
                for new, old in (
                    ("beam", "stiff"),
                    ("bare beam", "bare meridian"),
                    ("rigid", "stiff"),
                    ("soft", "stiff"),
                )
            )
        )
    hubs = [models[which].compliance[:6, :6].diagonal() for which in ("rigid", "stiff", "soft")]
    softened = [float(np.max((harder - softer) / softer)) for harder, softer in pairwise(hubs)]
    plain = simplified(scene).get("fillets")
    sharp = meridian if plain is None else meridian_shaft(plain)
    return Compared(
        name,
        scene.shaft.length / max(section.outer_diameter for section in scene.shaft.sections),
        changes,
        max(softened),
        _end_torsion(sharp) / _end_torsion(beam) - 1.0,
    )


def _end_torsion(body: Condensed) -> float:
    return float(keep_points(body, ("hub", "gearbox")).stiffness[3, 3])


def show(page: Page, key: str, found: Sequence[Compared]) -> None:
    """A section with one quantity of all scenes, as bars and in numbers.

    Parameters
    ----------
    page : Page
        Takes the section.
    key : str
        Of `QUANTITIES`.
    found : sequence of Compared
        The scenes.
    """
    page.section(QUANTITIES[key].partition(":")[0])
    page.add(_bars(key, found))
    page.table(
        QUANTITIES[key],
        [
            {
                "scene": one.scene,
                "length over diameter": one.slenderness,
                **{
                    f"{title} [%]": round(100 * getattr(one.changes[key], part), 6)
                    for part, title in _TITLES.items()
                },
            }
            for one in found
        ],
    )


_TITLES = {
    "beam": "beam instead of meridian",
    "bare": "the same without rings",
    "housings": "rigid housings",
    "faces": "how the shaft holds their faces",
}


def titled(scene: str) -> str:
    """A scene's name in words: "IEA 15 MW main shaft"."""
    words = scene.replace("_15mw_", " 15 MW ").replace("_5mw_", " 5 MW ")
    words = words.replace("_750kw_", " 750 kW ").replace("_", " ")
    return words.replace("iea", "IEA").replace("nrel", "NREL")


def hero(key: str) -> str:
    """Caption of the bars of one quantity, by key of `QUANTITIES`."""
    return f"{QUANTITIES[key]}; beside each name its length over its largest diameter"


def _bars(key: str, found: Sequence[Compared]) -> Chart:
    """Bars of each scene's changes, the stoutest scene at the top."""
    ordered = sorted(found, key=lambda one: one.slenderness)
    groups = {
        title: {
            f"{titled(one.scene)} ({one.slenderness:.1f})": 100 * getattr(one.changes[key], part)
            for one in ordered
        }
        for part, title in _TITLES.items()
    }
    return bars(hero(key), groups, f"change [%]; {_MINIMUM:g} stands for less", least=_MINIMUM)
