"""Main of the limited process: it reads one file and writes arrays, or one sentence.

Started by `reading.read_in_process` as ``python -m fe_drivetrain.foreign.child REQUEST RESULT``.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np


def main(request_file: str, result_file: str) -> int:
    """Do what is asked for; the exit status is 0, or 3 with a sentence in the result's place."""
    request = json.loads(Path(request_file).read_text())
    _limit(request["limits"])
    from fe_drivetrain.common.errors import InputError
    from fe_drivetrain.foreign.reading import told_file
    from fe_drivetrain.foreign.telling import tell_to

    tell_to(told_file(result_file))
    try:
        arrays = _action(request["action"])(request)
        np.savez(result_file, **arrays)
        return 0
    except InputError as error:
        sentence = str(error)
    except MemoryError:
        sentence = "MEMORY"
    Path(result_file).with_suffix(".txt").write_text(sentence)
    return 3


def _limit(limits: dict[str, int]) -> None:
    try:
        import resource
    except ImportError:  # there are no such limits on Windows
        return
    for kind, value in (
        (resource.RLIMIT_AS, limits["bytes"]),
        (resource.RLIMIT_CPU, limits["seconds"]),
        (resource.RLIMIT_FSIZE, limits["file"]),
        (resource.RLIMIT_CORE, 0),
    ):
        resource.setrlimit(kind, (value, value))


def _text(data: Any) -> np.ndarray[Any, Any]:
    return np.array(json.dumps(data))


def _opened(request: dict[str, Any]) -> dict[str, Any]:
    from fe_drivetrain.foreign import step_solid

    given = (request.get(key) for key in ("part", "healed"))
    return step_solid.opened(request["file"], request["smallest_detail"], *given)


def _look_at_step(request: dict[str, Any]) -> dict[str, Any]:
    """A survey, and a coarse surface for a picture."""
    from fe_drivetrain.foreign import step_heal, step_solid
    from fe_drivetrain.geometry.session import gmsh_session

    with gmsh_session():
        survey = _opened(request)
        survey["seats"] = step_solid.seat_cylinders(survey)
        points, triangles, owner = np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros(0, int)
        curved: dict[str, Any] = {}
        try:
            step_heal.surface_mesh()
            points, triangles, owner = _surface()
            if step_solid.has_splines(survey):
                curved = _curved()
        except Exception as error:
            why = step_heal.reason(error)
            survey["unmeshed"] = f"{why}{step_heal.where(why)}"
    surface = {"points": points, "triangles": triangles, "owner": owner}
    return {"survey": _text(survey)} | surface | curved


def _surface() -> tuple[Any, Any, Any]:
    import gmsh

    from fe_drivetrain.geometry.session import numbered_nodes

    points, number = numbered_nodes()
    blocks, owner = [], []
    for _, face in gmsh.model.getEntities(2):
        nodes = gmsh.model.mesh.getElementsByType(2, face)[1].reshape(-1, 3)
        blocks.append(number[nodes])
        owner.append(np.full(len(nodes), face))
    return points, np.concatenate(blocks), np.concatenate(owner)


def _curved() -> dict[str, Any]:
    """The outside of the surface mesh that is there, of curved triangles turned outward [mm]."""
    import gmsh

    from fe_drivetrain.foreign.step_solids import outside
    from fe_drivetrain.geometry.session import numbered_nodes

    gmsh.model.mesh.setOrder(2)
    points, number = numbered_nodes()
    blocks = [np.zeros((0, 6), int)]
    for face in outside():
        nodes = number[gmsh.model.mesh.getElementsByType(9, face)[1].reshape(-1, 6)]
        if not len(nodes):
            continue
        first, second, third, middle = points[nodes[0, :4]]
        on = gmsh.model.getClosestPoint(2, face, middle.tolist())[1]
        normal = np.array(gmsh.model.getNormal(face, list(on)))
        outward = np.cross(second - first, third - first) @ normal > 0
        blocks.append(nodes if outward else nodes[:, [0, 2, 1, 5, 4, 3]])
    return {"curved_points": points, "curved_triangles": np.concatenate(blocks)}


def _mesh_step(request: dict[str, Any]) -> dict[str, Any]:
    """A mesh of curved tetrahedra in mm, its faces, and the survey."""
    from fe_drivetrain.foreign import step_mesh, step_solid
    from fe_drivetrain.geometry.session import gmsh_session

    with gmsh_session():
        survey = _opened(request)
        seat = step_mesh.seat_of(survey, request)
        seat["holes"] = (
            step_mesh.bolt_holes(survey, request, _held(survey, request))
            if request.get("bolts")
            else []
        )
        step_mesh.cut(survey, request)
        step_mesh.mesh(survey, request["size"], request["per_turn"], request["optimise"])
        arrays = _grouped()
        survey["splines"] = step_solid.has_splines(survey)
        survey.pop("faces")
    arrays["survey"] = _text(survey | {"seat": seat})
    return arrays


def _grouped() -> dict[str, Any]:
    """Nodes, cells and facets of the open mesh by their physical groups."""
    import gmsh

    from fe_drivetrain.geometry.session import numbered_nodes

    points, number = numbered_nodes()
    arrays: dict[str, Any] = {"points": points}
    for dim, group in gmsh.model.getPhysicalGroups():
        kind, width = (9, 6) if dim == 2 else (11, 10)
        nodes = [
            gmsh.model.mesh.getElementsByType(kind, entity)[1].reshape(-1, width)
            for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, group)
        ]
        name = gmsh.model.getPhysicalName(dim, group)
        arrays["cells" if dim == 3 else name] = number[np.concatenate(nodes)]
    return arrays


def _mesh_further_part(request: dict[str, Any]) -> dict[str, Any]:
    """A mesh of curved tetrahedra in mm of a part without a seat, its faces, and the survey."""
    from fe_drivetrain.foreign import step_mesh, step_solid
    from fe_drivetrain.geometry.session import gmsh_session

    with gmsh_session():
        survey = _opened(request)
        step_mesh.name_faces(survey, request)
        step_mesh.mesh(survey, request["size"], request["per_turn"], request["optimise"])
        arrays = _grouped()
        survey["splines"] = step_solid.has_splines(survey)
        survey.pop("faces")
    return arrays | {"survey": _text(survey)}


def _held(survey: dict[str, Any], request: dict[str, Any]) -> list[int]:
    from fe_drivetrain.foreign import step_solid

    return [t for pick in request["held"] for t in step_solid.picked(survey, pick, "held face")]


def _read_mesh(request: dict[str, Any]) -> dict[str, Any]:
    from fe_drivetrain.foreign.mesh_file import read

    return read(request["file"])


def _action(name: str) -> Callable[[dict[str, Any]], dict[str, Any]]:
    if name in _ACTIONS:
        return _ACTIONS[name]
    module, _, function = name.partition(":")
    return getattr(import_module(module), function)  # type: ignore[no-any-return]


_ACTIONS = {
    "look": _look_at_step,
    "mesh step": _mesh_step,
    "mesh further part": _mesh_further_part,
    "read mesh": _read_mesh,
}

if __name__ == "__main__":
    from fe_drivetrain.common.stopped import until_stopped

    sys.exit(until_stopped(lambda: main(*sys.argv[1:])))
