"""Error against cost: exact facts of its tools, its reference, and the case end to end."""

import csv

import numpy as np
import pytest
from conftest import QuickRun
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.cases.performance.studies import (
    beam_stiffness,
    meridian_stiffness,
)
from fe_drivetrain.cases.performance.work_precision import (
    PARTS,
    parts_of,
)
from fe_drivetrain.cases.references.growing_shafts import STEPPED
from fe_drivetrain.cases.references.stiffness_choices import (
    CURVED,
    ELEMENTS,
    HEXAHEDRA,
    P1,
    STRAIGHT,
    Level,
    Solve,
    assemble_shaft,
    mesh_shaft,
    shaft_outcomes,
)
from fe_drivetrain.cases.references.tilt_choices import QUANTITIES, assemble_tilt, in_element
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.pareto import (
    cheapest_within,
    growth_exponent,
    pareto_front,
)
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.shaft_section import Grading
from fe_drivetrain.elasticity.solve import solvers
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.bearing_stiffness import PLANES, tilt_stiffness, without_gearbox
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

STEEL = MATERIALS["steel"]
TUBE = Shaft(front=-2.0, sections=(Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3),))

costs = st.floats(1e-6, 1e3)
points = st.lists(st.tuples(costs, costs), min_size=1, max_size=40)


@given(points)
def test_nothing_beats_the_pareto_front_and_it_beats_all_else(chosen):
    seconds, errors = np.array(chosen).T
    front = pareto_front(seconds, errors)
    on = set(front.tolist())
    for k in range(len(chosen)):
        no_worse = (seconds <= seconds[k]) & (errors <= errors[k])
        better = no_worse & ((seconds < seconds[k]) | (errors < errors[k]))
        if k in on:
            assert not better.any()
        else:
            assert no_worse[front].any()
    assert np.all(np.diff(seconds[front]) > 0)
    assert np.all(np.diff(errors[front]) < 0)


def test_pareto_front_may_ask_for_a_gain():
    seconds, errors = [1.0, 2.0, 3.0, 4.0], [0.1, 0.0999, 0.09, 0.0]
    assert pareto_front(seconds, errors).tolist() == [0, 1, 2, 3]
    assert pareto_front(seconds, errors, gain=0.05).tolist() == [0, 2, 3]


def test_pareto_front_leaves_out_what_has_no_error():
    assert pareto_front([1.0, 2.0, 3.0], [np.nan, 0.2, 0.1]).tolist() == [1, 2]
    assert pareto_front([], []).tolist() == []


@given(points, costs)
def test_cheapest_within_a_bound(chosen, bound):
    seconds, errors = np.array(chosen).T
    best = cheapest_within(seconds, errors, bound)
    if best is None:
        assert errors.min() > bound
    else:
        assert errors[best] <= bound
        assert seconds[best] == seconds[errors <= bound].min()


@pytest.mark.parametrize("exponent", [1.0, 1.15, 4 / 3, 2.0])
def test_growth_exponent_of_a_power_is_its_exponent(exponent):
    n = np.array([1e4, 3e4, 1e5, 1e6])
    assert growth_exponent(n, 3e-6 * n**exponent) == pytest.approx(exponent, rel=1e-12)
    # the unit of the cost does not matter
    assert growth_exponent(n, 7.0 * n**exponent) == pytest.approx(exponent, rel=1e-12)


def test_growth_exponent_of_one_size_is_unknown():
    assert np.isnan(growth_exponent([1e4, 1e4], [1.0, 1.1]))
    assert np.isnan(growth_exponent([1e4, 1e5], [1.0, np.nan]))
    assert np.isnan(growth_exponent([], []))


def test_meridian_reference_equals_beam_theory_where_that_is_exact():
    """Uniform shaft: GJ/L always; without lateral contraction EA/L and EI/L too."""
    area, inertia = np.pi / 4 * (0.7**2 - 0.3**2), np.pi / 64 * (0.7**4 - 0.3**4)
    steel = meridian_stiffness(TUBE, STEEL, order=4, layers=1)
    assert steel[0] == pytest.approx(STEEL.shear_modulus * 2 * inertia / 2.0, rel=1e-10)
    cork = Material(youngs_modulus=1e10, poisson_ratio=0.0, density=1000.0)
    found = meridian_stiffness(TUBE, cork, order=4, layers=1)
    exact = 1e10 * np.array([inertia, inertia, area]) / 2.0
    np.testing.assert_allclose(found, exact, rtol=1e-10)


def test_meridian_reference_is_the_limit_of_solid_elements_from_below():
    """Displacement elements are too stiff; finer ones less so, in the meridian and in space."""
    rough, fine = (meridian_stiffness(STEPPED, STEEL, n, layers=n) for n in (3, 6))
    assert np.all(fine < rough)
    np.testing.assert_allclose(rough, fine, rtol=2e-3)
    # 12 elements a turn leave 2e-4 of the surface, far less than the step's own error here
    level = Level("hex 20", 0.5, 12, Grading(1, 1, 0.2))
    (solid,) = shaft_outcomes(STEPPED, STEEL, level, [Solve("superlu")], repeats=1)
    assert np.all(solid.values > fine)
    np.testing.assert_allclose(solid.values, fine, rtol=1e-2)
    # series of beams: stiffer, since its sections stay plane through the step
    assert np.all(beam_stiffness(1)[0] > fine)


@pytest.mark.parametrize("element", ELEMENTS)
def test_every_element_has_the_stiffness_of_its_own_material(element):
    """Stiffness is proportional to E, and near GJ/L: some too stiff, straight P2 too soft."""
    mesh = mesh_shaft(TUBE, Level(element, 0.5, 8))
    found = []
    for factor in (1.0, 3.0):
        material = Material(youngs_modulus=factor * 1e11, poisson_ratio=0.3, density=1000.0)
        assembled = assemble_shaft(TUBE, material, mesh)
        solution = solvers.solve(assembled.system, assembled.loads, "superlu")
        found.append(assembled.quantities(solution.x))
    np.testing.assert_allclose(found[1], 3.0 * found[0], rtol=1e-8)
    torsion = 1e11 / 2.6 * np.pi / 32 * (0.7**4 - 0.3**4) / 2.0
    error = found[0][0] / torsion - 1.0
    # of the surface: chords of 8 to 12 a turn leave 5 to 20 % of J, parabolas 1e-3 at the most
    if element in (STRAIGHT, "hex 8"):
        assert -0.25 < error < -0.03
    elif element == P1:
        assert abs(error) < 0.25
    else:
        assert abs(error) < 3e-3


def test_tilt_stiffness_is_that_of_the_model(bonded_model: Model):
    """The sweep's own assembly of the bonded scene against the model, for curved elements."""
    from fe_drivetrain.shafts.response.model import build_model

    scene, mesh = without_gearbox(bonded_model.scene), bonded_model.mesh
    assembled = assemble_tilt(scene, in_element(mesh, "main_bearing", CURVED))
    solution = solvers.solve(assembled.system, assembled.loads, "superlu")
    found = assembled.quantities(solution.x)
    model = build_model(scene, mesh)
    response = unit_load_response(model, "superlu")
    for (name, kind), value in zip(QUANTITIES, found, strict=True):
        plane = next(p for p in PLANES if p.name == name)
        right = tilt_stiffness(model, response, "main_bearing", plane)[kind]
        assert value == pytest.approx(right, rel=1e-6)


def test_linear_tetrahedra_of_the_housing_are_stiffer(bonded_model: Model):
    """P1 displacements are among those of straight P2 on one mesh: they store less energy."""
    scene, mesh = without_gearbox(bonded_model.scene), bonded_model.mesh
    stiffness = {}
    for element in (P1, STRAIGHT):
        made = in_element(mesh, "main_bearing", element)
        assembled = assemble_tilt(scene, made)
        x = solvers.solve(assembled.system, assembled.loads, "superlu").x
        stiffness[element] = np.einsum("nk,nk->k", assembled.loads, x)
    # compliance of each of the six loads
    assert np.all(stiffness[P1] < stiffness[STRAIGHT])


def test_face_weights_of_both_triangles_add_up_to_the_area(bonded_model: Model):
    mesh: Mesh = bonded_model.mesh
    areas = {e: in_element(mesh, "main_bearing", e).seat[1].sum() for e in (P1, STRAIGHT, CURVED)}
    # straight triangles of three and of six nodes are the same ones
    assert areas[P1] == pytest.approx(areas[STRAIGHT], rel=1e-12)
    bearing = bonded_model.scene.bearing_units[0].bearing
    exact = np.pi * 0.4 * bearing.width
    assert areas[P1] < areas[CURVED] < exact * (1 + 1e-12)
    assert areas[CURVED] == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize(
    ("given_settings", "message"),
    [
        ({"parts": "shafts"}, "parts: 'shafts' is unknown"),
        ({"parts": []}, "parts is empty"),
    ],
)
def test_wrong_settings_are_refused(given_settings, message, tmp_path):
    with pytest.raises(InputError, match=message):
        parts_of(Run(given_settings, True, tmp_path))


def test_parts_may_be_one_or_all(tmp_path):
    assert parts_of(Run({}, True, tmp_path)) == list(PARTS)
    assert parts_of(Run({"parts": "growth"}, True, tmp_path)) == ["growth"]


@pytest.mark.quick("performance/work_precision")
def test_quick_run_measures_every_element_and_writes_its_page(quick_run: QuickRun):
    results = quick_run("performance/work_precision")
    folder = quick_run.folder / "performance" / "work_precision"
    with (folder / "shaft_choices.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert {row["element"] for row in rows} == set(ELEMENTS)
    for row in rows:
        assert float(row["credited error of torsional [-]"]) < 1.0
        assert all(float(value) > 0 for key, value in row.items() if key.endswith("[s]"))
        credited = float(row["credited error of bending [-]"])
        assert credited >= abs(float(row["error of bending [-]"]))
        assert credited >= float(row["volume error [-]"])
    # curved quadratic elements beat linear ones on the same mesh
    best = {
        element: min(
            float(r["credited error of torsional [-]"]) for r in rows if r["element"] == element
        )
        for element in ELEMENTS
    }
    assert best[CURVED] < best[STRAIGHT]
    assert best["hex 20"] < best["hex 8"]
    assert set(results.figures) == {"shaft", "housing", "growth", "goals"}
    assert len(results.figures["growth"]) == 2
    assert "Pareto front" in (folder / "report.html").read_text()


def test_hexahedra_are_the_elements_of_so_many_nodes():
    for element, nodes in HEXAHEDRA.items():
        assert mesh_shaft(TUBE, Level(element, 1.0, 8)).cells.shape[1] == nodes
