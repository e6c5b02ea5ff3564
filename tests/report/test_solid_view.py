"""A deformed model for the browser: the same solid as the mesh, within its digits."""

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.mesh import boundary
from fe_drivetrain.elasticity.operator.stress import nodal_stresses, von_mises
from fe_drivetrain.report import solid_view
from fe_drivetrain.report.results import Solid
from fe_drivetrain.report.solid_view import Parts, write_solid_view
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response

STEEL = (115e9, 77e9)
LIMIT = 3_000_000  # bytes


def decoded(view: dict[str, Any], name: str, kind: str) -> Any:
    return np.frombuffer(base64.b64decode(view[name]), dtype=kind)


@pytest.fixture(scope="module")
def u(bonded_response: Response) -> Floats:
    """Under 1 MN down at the hub."""
    return bonded_response.displacements[..., 2] * -1e6


@pytest.fixture(scope="module")
def view(bonded_model: Model, u: Floats, tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("view") / "view.json"
    mesh = bonded_model.mesh
    fields = {"down": u, "down, three times": 3.0 * u}
    assert write_solid_view(mesh, fields, dict.fromkeys(mesh.part_names, STEEL), path)
    assert path.stat().st_size < LIMIT
    return json.loads(path.read_text("utf-8"))


def vertices(view: dict[str, Any]) -> Floats:
    steps = decoded(view, "positions", "<i2").reshape(-1, 3)
    return np.asarray(view["middle"]) + view["reach"] * steps / 32767.0


def test_each_part_is_closed_turned_outward_and_has_its_volume(
    view: dict[str, Any], bonded_model: Model
) -> None:
    points = vertices(view)
    triangles = decoded(view, "triangles", "<u4").reshape(-1, 3)
    mesh = bonded_model.mesh
    assert [part["name"] for part in view["parts"]] == list(mesh.part_names)
    for part in view["parts"]:
        own = triangles[part["first"] : part["first"] + part["count"]]
        edges = np.concatenate([own[:, [0, 1]], own[:, [1, 2]], own[:, [2, 0]]])
        back = {(b, a) for a, b in edges.tolist()}
        assert back == {(a, b) for a, b in edges.tolist()}
        a, b, c = (points[own[:, k]] for k in range(3))
        volume = np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0
        # the exact one by the six-node triangles themselves, each as four flat ones
        six = mesh.points[boundary(mesh, part["name"])]
        flat = np.concatenate([six[:, [0, 3, 5]], six[:, [3, 1, 4]], six[:, [5, 4, 2]], six[:, 3:]])
        exact = np.einsum("ni,ni->", flat[:, 0], np.cross(flat[:, 1], flat[:, 2])) / 6.0
        assert volume > 0.0
        assert_allclose(volume, exact, rtol=1e-3)


def test_values_are_those_of_the_nodes(
    view: dict[str, Any], bonded_model: Model, u: Floats
) -> None:
    mesh = bonded_model.mesh
    points = vertices(view)
    load = view["loads"][0]
    moved = load["largest"] * decoded(load, "displacements", "<i2").reshape(-1, 3) / 32767.0
    stress = load["greatest"] * decoded(load, "stresses", "<i2") / 32767.0
    part = view["parts"][0]
    own = np.unique(decoded(view, "triangles", "<u4")[: 3 * part["count"]])
    s = von_mises(
        nodal_stresses(mesh.points, mesh.cells[mesh.part_cells("shaft")], u.ravel(), STEEL)
    )
    nodes = mesh.part_nodes("shaft")
    for vertex in own[::97]:
        distance = np.linalg.norm(mesh.points[nodes] - points[vertex], axis=1)
        node = nodes[np.argmin(distance)]
        assert distance.min() < 1e-4 * view["reach"]
        assert_allclose(moved[vertex], u[node], atol=1e-4 * load["largest"])
        assert_allclose(stress[vertex], s[node], atol=1e-4 * load["greatest"])
    assert_allclose(load["largest"], np.linalg.norm(u, axis=1).max(), rtol=1e-6)
    assert_allclose(load["factor"] * load["largest"] / (2.0 * view["reach"]), 0.08, rtol=0.2)


def test_each_load_has_its_own_values_and_scale(view: dict[str, Any]) -> None:
    one, three = view["loads"]
    assert [one["name"], three["name"]] == ["down", "down, three times"]
    for whole in ("largest", "greatest"):
        assert_allclose(three[whole], 3.0 * one[whole], rtol=1e-9)
    assert three["displacements"] == one["displacements"]
    assert three["stresses"] == one["stresses"]


def test_loads_that_do_not_fit_are_left_out(
    bonded_model: Model, u: Floats, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh, path = bonded_model.mesh, tmp_path / "view.json"
    fields = {f"load {k}": u for k in range(3)}
    lame = dict.fromkeys(mesh.part_names, STEEL)
    sizes = []
    for count in (1, 2):
        write_solid_view(mesh, dict(list(fields.items())[:count]), lame, path)
        sizes.append(path.stat().st_size)
    monkeypatch.setattr(solid_view, "MAX_BYTES", sizes[1] + (sizes[1] - sizes[0]) // 2)
    write_solid_view(mesh, fields, lame, path)
    assert len(json.loads(path.read_text("utf-8"))["loads"]) == 2
    monkeypatch.setattr(solid_view, "MAX_BYTES", 1)
    write_solid_view(mesh, fields, lame, path)
    assert len(json.loads(path.read_text("utf-8"))["loads"]) == 1


def test_of_a_fine_surface_there_are_corners_alone_and_of_one_too_fine_nothing(
    bonded_model: Model, u: Floats, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mesh = bonded_model.mesh
    facets = sum(len(boundary(mesh, part)) for part in mesh.part_names)
    lame = dict.fromkeys(mesh.part_names, STEEL)
    monkeypatch.setattr(solid_view, "MAX_TRIANGLES", facets)
    assert write_solid_view(mesh, {"down": u}, lame, tmp_path / "coarse.json")
    coarse = json.loads((tmp_path / "coarse.json").read_text("utf-8"))
    assert sum(part["count"] for part in coarse["parts"]) == facets
    monkeypatch.setattr(solid_view, "MAX_TRIANGLES", facets - 1)
    assert not write_solid_view(mesh, {"down": u}, lame, tmp_path / "none.json")
    assert not (tmp_path / "none.json").exists()


def test_a_surface_of_the_largest_size_takes_less_than_3_mb() -> None:
    """Half as many vertices as triangles: 14 and 12 bytes for each, in letters of 6 bits."""
    triangles = solid_view.MAX_TRIANGLES
    vertices = 0.5 * triangles
    assert (14.0 * vertices + 12.0 * triangles) * 8.0 / 6.0 < LIMIT


@pytest.mark.parametrize("nodes", [4, 8, 10, 20, 27])
def test_parts_of_other_elements_are_closed_and_have_their_volume(
    nodes: int, tmp_path: Path
) -> None:
    other = brick((2, 1, 1), nodes)
    shell = brick((1, 2, 2), 27, lambda p: p + np.eye(3)[0])
    points = np.concatenate([other.points, shell.points])
    parts = Parts(points, {"one": other.cells, "two": shell.cells + len(other.points)})
    pulled = 1e-3 * points * [1.0, -0.3, -0.3]
    lame = dict.fromkeys(parts.cells, STEEL)
    path = tmp_path / "mixed.json"
    assert write_solid_view(parts, {"pulled": pulled}, lame, path)
    view = json.loads(path.read_text("utf-8"))
    triangles = decoded(view, "triangles", "<u4").reshape(-1, 3)
    at = vertices(view)
    for part in view["parts"]:
        own = at[triangles[part["first"] : part["first"] + part["count"]]]
        inside = np.einsum("na,na->", own[:, 0], np.cross(own[:, 1], own[:, 2])) / 6.0
        assert_allclose(inside, 1.0, rtol=1e-3)
    # uniaxial: E times the strain
    lam, mu = STEEL
    strain = np.array([1e-3, -0.3e-3, -0.3e-3])
    stress = lam * strain.sum() + 2.0 * mu * strain
    assert_allclose(view["loads"][0]["greatest"], stress[0] - stress[1], rtol=1e-6)


def test_a_run_shows_a_body_bent_beside_the_picture_of_it(tmp_path: Path) -> None:
    block, run = brick((2, 1, 1), 27), Run({}, True, tmp_path)
    stretched = block.points * [1e-3, 0.0, 0.0]
    item = run.view("a bar", ("bar", block, STEEL), {"pulled": stretched}, "model.png")
    assert isinstance(item, Solid)
    assert (item.caption, item.still) == ("a bar", "model.png")
    view = json.loads((tmp_path / item.file).read_text())
    assert [part["name"] for part in view["parts"]] == ["bar"]
    assert [load["name"] for load in view["loads"]] == ["pulled"]
