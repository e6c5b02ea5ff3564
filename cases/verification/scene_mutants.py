"""Scenes that are wrong at random: refused in one sentence, or answered as physics has it.

Every mutant is a scene of the library, or a component, with one value or two changed by a seed:
scaled by up to a million, turned in sign, of another type, missing, misspelt, or exchanged with
another. What is taken is held against facts that no code of the program decides: equilibrium,
reciprocity, Hooke's law (all that is elastic twice as stiff moves half as far), statics, and masses
of plain solids.
"""

from __future__ import annotations

import copy
import json
import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fe_drivetrain.bearing_life.coupled import scene_body
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.component import Component
from fe_drivetrain.drivetrain_file.reading import (
    change_scene,
    library_text,
    parse_component,
    parse_scene,
    scene_text,
)
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.geometry import Bearing, CondensedHousing, Housing, Shaft, build, gmsh_session
from fe_drivetrain.shafts.fidelity import LevelModel, frame_level, shaft_level, statics_level

SCENES = (
    "housing_on_bedplate",
    "iea_15mw_main_shaft",
    "iea_15mw_shaft_on_nose",
    "main_bearing_bonded",
    "main_bearing_bonded_uncertain",
    "main_bearing_spherical",
    "nrel_5mw_main_shaft",
    "nrel_750kw_high_speed_shaft",
    "nrel_750kw_low_speed_shaft",
    "short_thick_shaft",
    "stepped_shaft",
    "three_point_suspension",
    "two_bearings",
)
COMPONENTS = ("gearbox_housing", "planet_carrier")

#: Half of the mutants are scaled by these, most of which give another sound scene.
SMALL = (0.5, 0.9, 0.99, 1.01, 1.1, 2.0)
LARGE = (1e-6, 1e-3, 1e-1, 1e1, 1e3, 1e6)
#: What stands in place of a value.
JUNK: tuple[Any, ...] = (
    *(True, False, None, "", "wide", "1e400", ".nan", "inf", [], {}, [1.0], [True], {"a": 1}),
    *(10**400, -0.0, 1e-300, 1e300, [[1.0]], "5 mm"),
)
#: What no refusal may say: words of Python, not of the program.
FOREIGN_WORDS = (
    *("Traceback", "math domain", "division by zero", "NoneType", "object", "float()", "nan"),
    *("SVD", "broadcast", "singular matrix", "invalid value", "list index", "argument"),
)
#: What round-off may change, relative to the largest of its kind: so many roundings times the
#: condition number of the motions, between these bounds.
ROUNDINGS, MAXIMUM = 20, 1e-6
#: The least of it by level: level 2 solves some 10,000 unknowns, whose condition is about 1e7.
MINIMUM = {1: 1e-12, 2: 1e7 * float(np.finfo(np.float64).eps)}


@dataclass(frozen=True)
class Mutant:
    """A scene's data after a change, what was changed, and the kinds of change, in words."""

    library: str
    change: str
    kind: str
    data: dict[str, Any]


@dataclass
class Outcome:
    """What became of a mutant.

    Attributes
    ----------
    mutant : Mutant
        The mutant.
    sentence : str
        Of the refusal; empty where it is taken.
    errors : dict[str, float]
        Error over what is allowed by fact, as in "level 1: equilibrium"; of what is taken.
    faults : list[str]
        What may not be: an exception, a refusal in foreign words, a later refusal.
    """

    mutant: Mutant
    sentence: str = ""
    errors: dict[str, float] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)


def mutants(count: int, seed: int) -> Iterator[Mutant]:
    """Mutants of all scenes and components of the library in turn.

    Parameters
    ----------
    count, seed : int
        Number of them, and of the random numbers.
    """
    rng = np.random.default_rng(seed)
    names = (*SCENES, *COMPONENTS)
    for number in range(count):
        library = names[number % len(names)]
        data = parse_mapping(library_text(library), library)
        changes = [_mutate(data, rng) for _ in range(1 + (rng.random() < 0.2))]
        kind = changes[0][0] if len(changes) == 1 else "two changes"
        yield Mutant(library, "; ".join(words for _, words in changes), kind, data)


def _paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if path:
        yield path
    items: Any = node.items() if isinstance(node, dict) else ()
    for key, value in enumerate(node) if isinstance(node, list) else items:
        yield from _paths(value, (*path, key))


def _at(node: Any, path: Sequence[Any]) -> Any:
    for key in path:
        node = node[key]
    return node


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _mutate(data: dict[str, Any], rng: np.random.Generator) -> tuple[str, str]:
    """Change one place of the data; returns the kind of change, and what was done."""
    everywhere = [p for p in _paths(data) if p[0] != "title"]
    numbers = [p for p in everywhere if _number(_at(data, p))]
    way = rng.random()
    path = _picked(numbers if way < 0.65 else everywhere, rng)
    key, parent, last = _key(path), _at(data, path[:-1]), path[-1]
    if way < 0.6:
        factor = float(rng.choice(SMALL if way < 0.35 else LARGE))
        parent[last] = parent[last] * factor
        return "half to twice" if way < 0.35 else "1e-6 to 1e6 times", f"{key} times {factor:g}"
    if way < 0.65:
        parent[last] = -parent[last]
        return "other sign", f"-{key}"
    if way < 0.75:
        parent[last] = copy.deepcopy(JUNK[int(rng.integers(len(JUNK)))])
        return "another type", f"{key} is {shown(parent[last])}"
    if way < 0.83:
        del parent[last]
        return "missing", f"without {key}"
    if way < 0.88 and isinstance(parent, dict):
        parent[f"{last}_"] = parent[last]
        return "unknown key", f"{key}_ beside {key}"
    return _exchange(data, rng, numbers)


def _exchange(
    data: dict[str, Any], rng: np.random.Generator, numbers: list[tuple[Any, ...]]
) -> tuple[str, str]:
    """Exchange two numbers, or turn a list round."""
    lists = [p for p in _paths(data) if isinstance(_at(data, p), list) and len(_at(data, p)) > 1]
    if lists and rng.random() < 0.5:
        path = _picked(lists, rng)
        _at(data, path).reverse()
        return "order", f"{_key(path)} backwards"
    one = _picked(numbers, rng)
    two = _picked([path for path in numbers if path != one], rng)
    a, b = _at(data, one), _at(data, two)
    _at(data, one[:-1])[one[-1]], _at(data, two[:-1])[two[-1]] = b, a
    return "exchanged", f"{_key(one)} and {_key(two)} exchanged"


def _key(path: Sequence[Any]) -> str:
    return ".".join(map(str, path))


def _picked(paths: list[tuple[Any, ...]], rng: np.random.Generator) -> tuple[Any, ...]:
    return paths[int(rng.integers(len(paths)))]


def judged(mutant: Mutant, *, meridian: bool, cad: bool) -> Outcome:
    """Read a mutant, and hold what is taken against facts.

    Parameters
    ----------
    mutant : Mutant
        The mutant.
    meridian : bool
        Whether level 2 answers, too.
    cad : bool
        Whether the CAD model is built, as for a mesh.
    """
    outcome = Outcome(mutant)
    text = json.dumps(mutant.data)
    component = mutant.library in COMPONENTS
    try:
        found = parse_component(text) if component else parse_scene(text)
    except InputError as error:
        outcome.sentence = str(error)
        if not _one_sentence(outcome.sentence):
            outcome.faults.append(f"refused in words that are not the program's: {error}")
        return outcome
    except Exception as error:  # whatever it is, it is a fault
        outcome.faults.append(f"read with {type(error).__name__}: {error}")
        return outcome
    steps: list[Callable[[], Any]]
    if isinstance(found, Scene):
        scene = found
        steps = [
            lambda: _round_trip(scene),
            # rolling bearings, of which a scene on a nose has none, hold no torque
            lambda: scene.nose is None and scene.gearbox.stiffness[3] and scene_body(scene, 1),
            lambda: coarser_scene(scene, 2.0, 8),
            lambda: _facts(scene, 1, outcome),
        ]
        steps += [lambda: _facts(scene, 2, outcome)] if meridian else []
        steps += [lambda: _cad(scene)] if cad else []
    else:
        body = found
        steps = [lambda: _component_facts(body, outcome)]
    for step in steps:
        try:
            step()
        except Exception as error:
            outcome.faults.append(f"later {type(error).__name__}: {error}")
    return outcome


def _one_sentence(text: str) -> bool:
    own = re.sub("'[^']*'", "", text)  # without what it quotes
    foreign = any(re.search(rf"\b{re.escape(word)}", own) for word in FOREIGN_WORDS)
    return text.isprintable() and 10 < len(text) < 1500 and not foreign


def _round_trip(scene: Scene) -> None:
    """A scene that is taken is taken again, changed by nothing or written as a file."""
    if change_scene(scene, {}) != scene or parse_scene(scene_text(scene)) != scene:
        raise AssertionError("read again, it is another scene")


def _cad(scene: Scene) -> None:
    """What the gate takes, CAD and the foreseen number of elements take."""
    bearings = [unit.bearing for unit in scene.bearing_units]
    with gmsh_session("mutant"):
        build(scene.shaft, bearings, scene.blocks, scene.mesh, bands=scene.seats)


# --- facts ---------------------------------------------------------------------------------------


def _facts(scene: Scene, level: int, outcome: Outcome) -> None:
    model, statics = shaft_level(scene, level), statics_level(scene)
    errors = {
        "equilibrium": _unbalanced(scene, model),
        "statics": _from_statics(model, statics),
        **_of_compliance(model.compliance),
    }
    if (mass := weight_over_mass(scene, model)) is not None:
        errors["mass"] = mass
    if (twice := twice_as_stiff(scene)) is not None:
        stiff = shaft_level(twice, level)
        size = np.abs(model.compliance).max(initial=1e-300)
        errors["Hooke"] = float(np.abs(2 * stiff.compliance - model.compliance).max() / size)
        if statics_decides(statics):
            errors["modulus"] = _from_statics(stiff, statics)
    allowed = _round_off(model)
    for name, error in errors.items():
        outcome.errors[f"level {level}: {name}"] = error / allowed


def _unbalanced(scene: Scene, model: LevelModel) -> float:
    """Resultant of all reactions about the hub, less the load; over the size of both."""
    at = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    at |= {bearing.name: bearing.x for bearing in scene.nose_bearings}
    at["gearbox"] = scene.shaft.rear
    worst = 0.0
    total = np.zeros((6, 6))
    size = np.ones((6, 6))
    for name, matrix in model.reaction_matrices.items():
        carried = wrench_transport(np.array([at[name] - scene.shaft.front, 0.0, 0.0]))
        total += carried @ matrix[:, :6]
        size = np.maximum(size, (np.abs(carried) @ np.abs(matrix[:, :6])).max(axis=0))
    worst = float((np.abs(total - np.eye(6)) / size).max())
    return worst


def statics_decides(statics: LevelModel) -> bool:
    """Whether equilibrium alone decides every reaction."""
    return all(np.isfinite(matrix).all() for matrix in statics.reaction_matrices.values())


def _from_statics(model: LevelModel, statics: LevelModel) -> float:
    """Largest difference to what statics decides, over the largest reaction to that load."""
    size = np.max([np.abs(m[:, :6]).max(axis=0) for m in model.reaction_matrices.values()], axis=0)
    worst = 0.0
    for name, matrix in statics.reaction_matrices.items():
        apart = np.abs(model.reaction_matrices[name][:, :6] - matrix[:, :6]) / size
        worst = max(worst, float(np.nan_to_num(apart, nan=0.0).max()))
    return worst


def _of_compliance(compliance: Floats) -> dict[str, float]:
    """How far motions for unit loads are from symmetric, and from positive."""
    scaled = _scaled(compliance)
    least = float(np.linalg.eigvalsh(0.5 * (scaled + scaled.T))[0]) if scaled.size else 0.0
    asymmetry = float(np.abs(scaled - scaled.T).max(initial=0.0))
    finite = 0.0 if np.isfinite(compliance).all() else math.inf
    return {"symmetry": max(asymmetry, finite), "positive": max(-least, 0.0)}


def _scaled(compliance: Floats) -> Floats:
    """Motions with ones on the diagonal, without those that supports hold rigidly."""
    roots = np.sqrt(np.maximum(compliance.diagonal(), 1e-300))
    moves = roots > 1e-12 * roots.max()
    return np.asarray((compliance / np.outer(roots, roots))[np.ix_(moves, moves)])


def _round_off(model: LevelModel) -> float:
    """What round-off may change in answers from the motions of a level, relative."""
    scaled = _scaled(model.compliance)
    condition = float(np.linalg.cond(scaled)) if scaled.size else 1.0
    return min(max(ROUNDINGS * np.finfo(float).eps * condition, MINIMUM[model.level]), MAXIMUM)


def weight_over_mass(scene: Scene, model: LevelModel) -> float | None:
    """Relative difference of what rests on the supports and the masses of plain solids.

    None where a solid is not plain: a bore that reaches the foot, fillets at level 2, files.

    Parameters
    ----------
    scene, model : Scene, LevelModel
        The scene, and the level that answered.
    """
    if scene.nose is not None or (model.level > 1 and any(p.fillet for p in scene.shaft.pieces)):
        return None
    mass = scene.material_of("shaft").density * shaft_volume(scene.shaft)
    for unit in scene.bearing_units:
        found = _unit_mass(scene, unit)
        if found is None:
            return None
        mass += found
    carried = math.fsum(matrix[2, 8] for matrix in model.reaction_matrices.values())
    if mass <= 0:
        return None if carried == 0 else math.inf
    return abs(carried - mass) / mass


def shaft_volume(shaft: Shaft) -> float:
    """Volume of frustums with straight bores [m^3]."""
    volume = 0.0
    for piece in shaft.pieces:
        a, b, bore = piece.outer_diameter / 2, piece.end_diameter / 2, piece.inner_diameter / 2
        volume += math.pi * piece.length * ((a * a + a * b + b * b) / 3 - bore * bore)
    return volume


def _unit_mass(scene: Scene, unit: BearingUnit) -> float | None:
    bearing, name = unit.bearing, unit.bearing.name
    ring = scene.material_of(name).density * ring_volume(bearing, scene.seat_diameter(name))
    if isinstance(unit.housing, CondensedHousing):
        return ring
    if not isinstance(unit.housing, Housing) or unit.parts:
        return None
    volume = block_volume(unit.housing, bearing)
    if volume is None:
        return None
    return ring + scene.material_of(f"{name}.housing").density * volume


def ring_volume(bearing: Bearing, bore: float) -> float:
    """Volume of a ring with a cylindrical or a spherical outside [m^3]."""
    radius, width = bearing.raceway_diameter / 2, bearing.width
    volume = math.pi * width * (radius**2 - (bore / 2) ** 2)
    return volume - (math.pi * width**3 / 12 if bearing.kind == "spherical" else 0.0)


def block_volume(housing: Housing, bearing: Bearing) -> float | None:
    """Volume of half a round on a trapezium on a foot, less bore and bolt holes [m^3].

    None where the bore reaches the foot.

    Parameters
    ----------
    housing, bearing : Housing, Bearing
        The block, and the bearing in it.
    """
    radius, width = bearing.raceway_diameter / 2, housing.width
    drop, outer = housing.centre_height - housing.foot_thickness, radius + housing.wall
    if drop < radius:
        return None
    section = math.pi * outer**2 / 2 + (2 * outer + housing.pedestal_width) / 2 * drop
    bore = math.pi * radius**2 * width
    if bearing.kind == "spherical":
        bore -= math.pi * width**3 / 12
    foot = housing.foot_length * housing.foot_width * housing.foot_thickness
    if housing.base == "bolted":
        foot -= math.pi * housing.bolt_diameter**2 * housing.foot_thickness
    return section * width - bore + foot


def twice_as_stiff(scene: Scene) -> Scene | None:
    """The scene with all that gives twice as stiff; None where that is refused."""
    data = json.loads(json.dumps(scene.model_dump(mode="json")))
    own = {name: scene.material_of(name) for name in ("shaft", *_part_names(scene))}
    for part, material in own.items():
        data["materials"][f"twice_{part.replace('.', '_')}"] = material.model_dump() | {
            "youngs_modulus": 2 * material.youngs_modulus
        }
    data["shaft"]["material"] = "twice_shaft"
    data["gearbox"]["stiffness"] = _doubled(data["gearbox"]["stiffness"])
    for unit in data["bearing_units"]:
        name = unit["bearing"]["name"]
        unit["bearing"]["material"] = f"twice_{name}"
        if "material" in unit["housing"]:
            unit["housing"]["material"] = f"twice_{name}_housing"
        for holder in (unit, unit["rollers"] or {}, unit["housing"]):
            for key in {"stiffness", "bedplate"} & holder.keys():
                holder[key] = _doubled(holder[key])
    if data["nose"] is not None:
        data["nose"]["body"]["material"] = "twice_nose"
        for bearing in data["nose"]["bearings"]:
            bearing["stiffness"] = _doubled(bearing["stiffness"])
    data["uncertainty"] = {}
    try:
        return Scene.model_validate(data)
    except (InputError, ValueError):
        return None  # a spring or a modulus that is at its upper limit


def _part_names(scene: Scene) -> list[str]:
    names = [] if scene.nose is None else ["nose"]
    for unit in scene.bearing_units:
        names += [unit.bearing.name, *unit.housing_parts]
    return names


def _doubled(stiffness: Any) -> Any:
    if isinstance(stiffness, list):
        return [_doubled(k) for k in stiffness]
    return 2 * stiffness if _number(stiffness) else stiffness


def _component_facts(component: Component, outcome: Outcome) -> None:
    """Frames of a component: balanced under its loads, symmetric, positive."""
    model = frame_level(component)
    loaded = [a for a in component.attachments if a.name in component.loaded]
    first = component.attachments[0].position
    applied = np.hstack([wrench_transport(a.position - first) for a in loaded])
    at = {a.name: a.position for a in component.attachments}
    total, size = np.zeros((6, applied.shape[1])), np.abs(applied).max(axis=0)
    for name, matrix in model.reaction_matrices.items():
        carried = wrench_transport(at[name] - first) @ matrix[:, : applied.shape[1]]
        total += carried
        size = np.maximum(size, np.abs(carried).max(axis=0))
    errors = {
        "equilibrium": float((np.abs(total - applied) / size).max()),
        **_of_compliance(model.compliance),
    }
    allowed = _round_off(model)
    for name, error in errors.items():
        outcome.errors[f"component: {name}"] = error / allowed
