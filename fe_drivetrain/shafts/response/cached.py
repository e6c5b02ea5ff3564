"""Unit-load responses from the cache: a scene is solved once, new load histories cost a product."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.kept_time import count_kept
from fe_drivetrain.common.provenance import file_digest
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.solve.solvers import Diagnostics
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.solution_keys import mesh_hash, solved_by
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

Arrays = dict[str, NDArray[Any]]


def cached_response(
    model: Model, method: str = "auto", seed: int = 0, cache: Cache | None = None
) -> Response:
    """`unit_load_response` of a model, taken from the cache where it was solved before.

    Parameters
    ----------
    model : Model
        As `build_model` made it of its scene and mesh.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solve`. What "auto" chose when it was solved is
        kept.
    seed : int
        Seed, see `unit_load_response`.
    cache : Cache or None
        The user's if not given.

    Returns
    -------
    Response
        The same to the last bit, with the same layout in memory, whether kept or solved now; its
        ``kept`` says which. Times in its diagnostics are those of when it was solved.

    Raises
    ------
    InputError
        As `unit_load_response`.
    """
    used = user_cache() if cache is None else cache
    content = _content(model.scene, model.mesh, method, seed)
    with used.one_at_a_time("solutions", content):
        arrays = used.load("solutions", content)
        if arrays is not None:
            try:
                kept = _from_arrays(arrays)
                count_kept(kept.diagnostics.setup_seconds + kept.diagnostics.solve_seconds)
                return replace(kept, kept=True, entrance=model.scene.entrance)
            except (KeyError, IndexError, TypeError, ValueError):
                pass  # not as it was written: solved again below
        arrays = _to_arrays(unit_load_response(model, method, seed))
        used.keep("solutions", content, arrays)
    return replace(_from_arrays(arrays), entrance=model.scene.entrance)


def _content(scene: Scene, mesh: Mesh, method: str, seed: int) -> dict[str, Any]:
    return {
        "scene": solved_content(scene),
        "mesh": mesh_hash(mesh),
        "method": method,
        "seed": seed,
        "made by": solved_by(),
    }


def is_kept(scene: Scene, mesh: Mesh) -> bool:
    """Whether the user's cache has what `cached_response` would otherwise solve, or can have none.

    Parameters
    ----------
    scene, mesh : Scene, Mesh
        A scene and its mesh.
    """
    used = user_cache()
    return used.folder is None or used.has("solutions", _content(scene, mesh, "auto", 0))


def solved_content(scene: Scene) -> dict[str, Any]:
    """What of a scene a solution depends on: no title, weights, sizes, spreads, catalogue names.

    Nor the point that hub loads are about: the unit loads of a solution enter at the front face.

    Parameters
    ----------
    scene : Scene
        The scene. Its mesh is hashed by itself.

    Returns
    -------
    dict
        Plain data.
    """
    content = whole_content(scene, {"title", "uncertainty", "mesh"})
    for described in content["bearing_units"]:
        del described["catalogue"]  # which is for lives
    del content["hub"]["loads_at"]
    for loaded in (content["gearbox"], *content["load_points"]):
        del loaded["weight"]
    return content


def whole_content(scene: Scene, without: set[str] | None = None) -> dict[str, Any]:
    """All that is stated of a scene, its files by what is in them and not by where they are.

    Parameters
    ----------
    scene : Scene
        The scene.
    without : set of str or None
        Keys to leave out.

    Returns
    -------
    dict
        Plain data.
    """
    content = scene.model_dump(mode="json", exclude=without)
    for unit, described in zip(scene.bearing_units, content["bearing_units"], strict=True):
        if unit.foreign is not None:
            described["housing"] |= {"step": None, "mesh": file_digest(unit.foreign.file)}
        for part, data in zip(unit.parts, described["parts"], strict=True):
            data |= {"step": None, "mesh": file_digest(part.file)}
    return content


def _to_arrays(response: Response) -> Arrays:
    """A response as plain arrays."""
    arrays: Arrays = {
        "displacements": response.displacements,
        "checks": np.array([response.equilibrium_error, response.superposition_error]),
        "diagnostics": np.array(json.dumps(asdict(response.diagnostics))),
    }
    for what, values in _groups(response).items():
        arrays[f"{what} names"] = np.array(list(values), dtype=np.str_)
        arrays |= {f"{what} {k}": value for k, value in enumerate(values.values())}
    # How arrays lie in memory can decide the last digits of what follows, so as a file keeps them.
    return {name: np.ascontiguousarray(array) for name, array in arrays.items()}


def _groups(response: Response) -> dict[str, Mapping[str, NDArray[Any]]]:
    return {
        "reactions": response.reactions,
        "positions": response.positions,
        "motions": response.motions,
        "strain_energy": response.strain_energy,
    }


def _from_arrays(arrays: Arrays) -> Response:
    def group(what: str) -> dict[str, NDArray[Any]]:
        return {str(n): arrays[f"{what} {k}"] for k, n in enumerate(arrays[f"{what} names"])}

    equilibrium, superposition = arrays["checks"].tolist()
    return Response(
        reactions=group("reactions"),
        positions=group("positions"),
        motions=group("motions"),
        strain_energy=group("strain_energy"),
        displacements=arrays["displacements"],
        equilibrium_error=equilibrium,
        superposition_error=superposition,
        diagnostics=Diagnostics(**json.loads(str(arrays["diagnostics"].ravel()[0]))),
    )
