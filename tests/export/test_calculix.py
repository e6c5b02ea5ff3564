"""Decks for CalculiX: what stands in them is the model, and ccx, where it is, agrees."""

import re
from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import FINER, coarse_scene
from scipy import sparse
from scipy.sparse.linalg import spsolve

from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.operator.element_loops import is_straight
from fe_drivetrain.export.calculix_deck import write_inp
from fe_drivetrain.export.calculix_integration import four_point_model
from fe_drivetrain.export.calculix_results import ROUNDING, read_dat, read_response
from fe_drivetrain.export.programs.ccx import find_calculix, run_calculix
from fe_drivetrain.shafts.response.model import LOADS, Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

FORMS = ["bonded", "sliding", "averaged", "rigid", "spring", "rollers"]


def blocks(text: str) -> list[tuple[str, list[str]]]:
    """Keyword lines with their data lines, comments left out."""
    found: list[tuple[str, list[str]]] = []
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            found.append((line, []))
        else:
            found[-1][1].append(line)
    return found


class Deck:
    """A reader of its own: what a finite-element program makes of the text."""

    def __init__(self, path: Path) -> None:
        cards = blocks(path.read_text("ascii"))
        first = next(k for k, (card, _) in enumerate(cards) if card == "*STEP")
        head, steps = cards[:first], cards[first:]
        self.positions = np.array(
            [
                [float(x) for x in line.split(",")[1:]]
                for card, lines in head
                if card.startswith("*NODE")
                for line in lines
            ]
        )
        self.sets = {
            card.split("NSET=")[1]: [int(n) for line in lines for n in line.split(",")]
            for card, lines in head
            if card.startswith("*NSET")
        }
        self.cells = {
            card.split("ELSET=")[1]: np.array([line.split(",") for line in lines], dtype=int)
            for card, lines in head
            if card.startswith("*ELEMENT, TYPE=C3D10")
        }
        self.equations = []
        for card, lines in head:
            if card == "*EQUATION":
                rest = list(lines)
                while rest:
                    terms, values = int(rest.pop(0)), []
                    while len(values) < 3 * terms:
                        values += rest.pop(0).split(",")
                    self.equations.append(
                        [
                            (3 * (int(node) - 1) + int(dof) - 1, float(value))
                            for node, dof, value in zip(*[iter(values)] * 3, strict=True)
                        ]
                    )
        self.held = []
        for card, lines in head:
            if card == "*BOUNDARY":
                for line in lines:
                    name, low, *high = line.split(",")
                    for node in self.sets.get(name) or [int(name)]:
                        for k in range(int(low), int(high[0] if high else low) + 1):
                            self.held.append(3 * (node - 1) + k - 1)
        elements = {}
        self.springs = []
        for card, lines in head:
            if card.startswith("*ELEMENT, TYPE=SPRING1"):
                elements[card.split("ELSET=")[1]] = int(lines[0].split(",")[1])
            if card.startswith("*SPRING"):
                node = elements[card.split("ELSET=")[1]]
                self.springs.append((3 * (node - 1) + int(lines[0]) - 1, float(lines[1])))
        self.materials = {
            card.split("NAME=")[1]: [float(x) for x in head[k + 1][1][0].split(",")]
            for k, (card, _) in enumerate(head)
            if card.startswith("*MATERIAL")
        }
        self.loads = np.zeros((self.positions.size, len(LOADS)))
        column = -1
        for card, lines in steps:
            column += card == "*STEP"
            if card.startswith("*CLOAD"):
                for line in lines:
                    node, dof, value = line.split(",")
                    self.loads[3 * (int(node) - 1) + int(dof) - 1, column] = float(value)

    def solution(self) -> np.ndarray:
        """All displacements, by Lagrange multipliers: no elimination of the project's."""
        n = self.positions.size
        K = sparse.csr_array((n, n))
        for part, rows in self.cells.items():
            E, nu = self.materials[part]
            lame = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
            K = K + assemble(self.positions, rows[:, 1:] - 1, lame, n).tocsr()
        for dof, stiffness in self.springs:
            K = K + sparse.csr_array(([stiffness], ([dof], [dof])), shape=(n, n))
        rows = [*self.equations, *([(dof, 1.0)] for dof in self.held)]
        C = sparse.csr_array(
            (
                [value for row in rows for _, value in row],
                (
                    [k for k, row in enumerate(rows) for _ in row],
                    [dof for row in rows for dof, _ in row],
                ),
            ),
            shape=(len(rows), n),
        )
        scale = float(K.diagonal().max())
        system = sparse.block_array([[K / scale, C.T], [C, None]], format="csc")
        right = np.vstack([self.loads / scale, np.zeros((len(rows), len(LOADS)))])
        return spsolve(system, right)[:n]


@pytest.fixture(scope="module")
def models(bonded_model: Model, spherical_responses: dict[str, tuple[Model, Response]]):
    found = {"bonded": bonded_model, **{k: model for k, (model, _) in spherical_responses.items()}}
    spring = {"interface": "spring", "stiffness": ["rigid", "rigid", "rigid", 0, 1e8, 2e8]}
    rollers = {
        "interface": "rollers",
        "rollers": {"count": 10, "stiffness": 1e9, "rows": [{"x": -0.05}, {"x": 0.05}]},
        "bedplate": [2e9, 3e9, 4e9, 5e8, 6e8, "rigid"],
    }
    for form, kind, unit in (("spring", "spherical", spring), ("rollers", "bonded", rollers)):
        scene = coarse_scene(kind, **{f"bearing_units.0.{key}": v for key, v in unit.items()})
        found[form] = build_model(scene, mesh_scene(scene))
    return found


@pytest.fixture(scope="module")
def responses(models):
    # direct: motions that all but vanish are compared, too
    return {form: unit_load_response(model, "superlu") for form, model in models.items()}


@pytest.mark.parametrize("form", FORMS)
def test_a_deck_is_the_whole_model(models, responses, form, tmp_path):
    """Read by another reader and solved with multipliers, it gives the project's answer."""
    path = tmp_path / "deck.inp"
    write_inp(models[form], path)
    deck = Deck(path)
    n = len(models[form].mesh.points)
    u = deck.solution()
    expected = responses[form].displacements
    # fourteen digits in the deck
    size = np.abs(expected).max(axis=(0, 1))
    assert (np.abs(u[: 3 * n].reshape(n, 3, -1) - expected).max(axis=(0, 1)) < 1e-7 * size).all()
    # of what moves most: torque all but leaves a held gearbox where it is
    most = np.max([np.abs(m).max(axis=0) for m in responses[form].motions.values()], axis=0)
    for name, motion in responses[form].motions.items():
        label = re.sub("[^A-Z0-9_]", "_", name.upper())
        move, turn = deck.sets[label][0] - 1, deck.sets[f"{label}_ROTATION"][0] - 1
        found = np.vstack([u[3 * move : 3 * move + 3], u[3 * turn : 3 * turn + 3]])
        assert (np.abs(found - motion).max(axis=0) < 1e-7 * most).all(), name


@pytest.mark.parametrize("form", FORMS)
def test_equations_are_not_chained(models, form, tmp_path):
    """What an equation gives, or a support holds, stands in no other equation's first place."""
    write_inp(models[form], tmp_path / "deck.inp")
    deck = Deck(tmp_path / "deck.inp")
    given = [row[0][0] for row in deck.equations]
    assert len(set(given)) == len(given)
    assert not set(given) & set(deck.held)
    assert not set(given) & {dof for row in deck.equations for dof, _ in row[1:]}
    assert all(row[0][1] == 1.0 for row in deck.equations)


def test_the_same_model_gives_the_same_bytes(bonded_model, tmp_path):
    for name in ("a.inp", "b.inp"):
        write_inp(bonded_model, tmp_path / name)
    text = (tmp_path / "a.inp").read_bytes()
    assert text == (tmp_path / "b.inp").read_bytes()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.inp", "b.inp"]
    for line in text.decode("ascii").splitlines():
        # CalculiX reads 132 characters a field, 20 of a number, 16 fields a line
        fields = [] if line.startswith("*") else line.split(",")
        assert len(fields) <= 16
        assert all(len(field) <= 20 for field in fields if not field[0].isalpha())


def test_gravity_and_weights_balance(bonded_model, tmp_path):
    write_inp(bonded_model, tmp_path / "deck.inp")
    deck = Deck(tmp_path / "deck.inp")
    mass = bonded_model.mass.sum()
    total = deck.loads.reshape(-1, 3, len(LOADS)).sum(axis=0)
    np.testing.assert_allclose(total[:, 6:9], mass * np.eye(3), atol=1e-9 * mass)


def test_a_missing_folder_is_told(bonded_model, tmp_path):
    with pytest.raises(InputError, match="there is no folder"):
        write_inp(bonded_model, tmp_path / "nowhere" / "deck.inp")


def test_names_that_are_the_same_in_capitals_are_refused(tmp_path):
    scene = coarse_scene("bonded", **{"bearing_units.0.bearing.name": "nall"})
    model = build_model(scene, mesh_scene(scene))
    with pytest.raises(InputError, match="capitals"):
        write_inp(model, tmp_path / "deck.inp")
    assert not list(tmp_path.iterdir())


def test_four_points_change_curved_elements_only():
    """Degree 2 is exact where edges are straight; in all, the stiffness of a rigid motion is 0."""
    # of so many elements that some nodes are of straight ones alone
    scene = coarse_scene("bonded", **FINER)
    model = build_model(scene, mesh_scene(scene))
    four = four_point_model(model)
    mesh = model.mesh
    n = len(mesh.points)
    motions = np.zeros((model.n_dofs, 6))
    motions[: 3 * n] = rigid_motions(mesh.points)
    for part, K in four.part_stiffness.items():
        size = np.abs(K.data).max()
        assert np.abs(K @ motions).max() < 1e-9 * size
        cells = mesh.cells[mesh.part_cells(part)]
        straight = is_straight(mesh.points, cells)
        assert not straight.all()
        inside = np.setdiff1d(cells[straight], cells[~straight])
        rows = (3 * inside[:, None] + np.arange(3)).ravel()
        change = (K - model.part_stiffness[part]).tocsr()
        assert abs(change[rows]).max() < 1e-12 * size if len(rows) else part != "shaft"
        assert abs(change).max() > 1e-9 * size


def test_a_dat_file_is_read_with_all_that_fortran_writes(tmp_path):
    path = tmp_path / "job.dat"
    path.write_text(
        "\n                        S T E P       1\n\n\n"
        " displacements (vx,vy,vz) for set NALL and time  0.1000000E+01\n\n"
        "         1  1.000000E+00 -2.500000E-09  0.000000E+00\n"
        "         7  1.234567-123 -1.234567-101  9.999999E-99\n\n"
        " forces (fx,fy,fz) for set SUPPORTS and time  0.1000000E+01\n\n"
        "         7  1.000000E+02  2.000000E+00  3.000000E+00\n\n"
        " total internal energy for set SHAFT and time  0.2000000E+01\n\n"
        "        4.250000E-03\n\n"
        " something else (abc) for set SHAFT and time  0.2000000E+01\n\n"
        "        1.000000E+00\n",
        "ascii",
    )
    moved, forces, energy = read_dat(path)
    assert (moved.quantity, moved.set_name, moved.time) == ("displacements", "NALL", 1.0)
    assert moved.nodes.tolist() == [1, 7]
    np.testing.assert_array_equal(
        moved.values, [[1.0, -2.5e-9, 0.0], [1.234567e-123, -1.234567e-101, 9.999999e-99]]
    )
    assert (forces.quantity, forces.nodes.tolist()) == ("forces", [7])
    assert (energy.time, energy.values.tolist()) == (2.0, [[4.25e-3]])


def test_an_answer_that_is_not_whole_is_refused(bonded_model, tmp_path):
    path = tmp_path / "job.dat"
    path.write_text("", "ascii")
    with pytest.raises(InputError, match="not complete"):
        read_response(bonded_model, path)


def test_an_unknown_load_is_told(bonded_model, tmp_path):
    with pytest.raises(InputError, match=r"'hub.Fw' is unknown"):
        write_inp(bonded_model, tmp_path / "deck.inp", ["hub.Fx", "hub.Fw"])


def test_a_missing_calculix_says_how_to_get_it():
    with pytest.raises(MissingToolError, match="apt-get install calculix-ccx"):
        find_calculix("no-such-program")


@pytest.mark.needs("ccx")
@pytest.mark.parametrize("form", ["sliding", "spring", "rollers"])
def test_ccx_agrees_in_all_its_digits(models, form, tmp_path):
    """Torque, a force and self-weight, through a joint that slides, and through springs."""
    loads = ["hub.Mx", "hub.Fz", "gravity.z"]
    columns = [LOADS.index(load) for load in loads]
    model = four_point_model(models[form])
    expected = unit_load_response(model, "superlu")
    write_inp(model, tmp_path / "job.inp", loads, fields=False)
    found = read_response(model, run_calculix(tmp_path / "job.inp"), loads)
    own = expected.displacements[..., columns]
    size = np.abs(own).max(axis=(0, 1))
    assert (np.abs(found.displacements - own).max(axis=(0, 1)) < 2 * ROUNDING * size).all()
    reactions = np.vstack(list(found.reactions.values()))
    own = np.vstack([expected.reactions[name][:, columns] for name in found.reactions])
    size = np.abs(own).max(axis=0)
    assert (np.abs(reactions - own).max(axis=0) < 2 * ROUNDING * size).all()


@pytest.mark.needs("ccx")
def test_a_deck_that_ccx_refuses_is_an_error(tmp_path):
    (tmp_path / "job.inp").write_text("*NODE\n1,0,0,0\n*STEP\n*STATIC\n*CLOAD\n9,1,1.\n*END STEP\n")
    with pytest.raises(RuntimeError, match="ccx ended"):
        run_calculix(tmp_path / "job.inp")


def test_rigid_couplings_and_supports_are_in_the_deck(spherical_mesh, tmp_path):
    """Hub and gearbox as rigid faces, the gearbox held in three directions."""
    scene = change_scene(
        coarse_scene("spherical"),
        {
            "hub.coupling": "rigid",
            "gearbox.coupling": "rigid",
            "gearbox.stiffness": [4e6, "rigid", "rigid", "rigid", 1e6, 0],
        },
    )
    model = build_model(scene, spherical_mesh)
    response = unit_load_response(model, "superlu")
    write_inp(model, tmp_path / "deck.inp")
    u = Deck(tmp_path / "deck.inp").solution()
    n = len(spherical_mesh.points)
    size = np.abs(response.displacements).max(axis=(0, 1))
    difference = np.abs(u[: 3 * n].reshape(n, 3, -1) - response.displacements).max(axis=(0, 1))
    assert (difference <= 1e-7 * size).all()


def test_export_writes_what_the_ending_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    scene = tmp_path / "mine.yaml"
    import yaml

    scene.write_text(yaml.safe_dump(coarse_scene("bonded").model_dump(mode="json")), "utf-8")

    def run(*arguments: str) -> int:
        monkeypatch.setattr("sys.argv", ["fe-drivetrain", "export", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        return int(end.value.code or 0)

    assert run("mine.yaml", "--out", "mine.inp", "--set", "gearbox.weight=1") == 0
    assert (tmp_path / "mine.inp").read_text("ascii").startswith("** Single main bearing")
    assert run("mine.yaml", "--out", "mine.vtu") == 0
    assert (tmp_path / "mine.vtu").is_file()
    capsys.readouterr()
    for arguments, hint in (
        (("mine.yaml", "--out", "mine.stl"), ".inp"),
        (("mine.yaml", "--out", "nowhere/mine.inp"), "folder"),
        (("none.yaml", "--out", "mine.inp"), "cannot read"),
        (("nothing", "--out", "mine.inp"), "main_bearing_bonded"),
    ):
        assert run(*arguments) == 2
        assert hint in capsys.readouterr().err
