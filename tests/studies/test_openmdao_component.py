"""A design as an OpenMDAO component: its driver finds what the search finds."""

from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies import design_component, design_request

KEY = "shaft.sections.0.inner_diameter"


def _request(**more: object) -> object:
    return design_request({KEY: (0.05, 0.35), **more}, "mass.shaft", ["shaft.torsional>=1e8"])


@pytest.mark.needs("openmdao")
def test_a_driver_of_openmdao_finds_the_bore_of_the_closed_form(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)  # OpenMDAO writes reports beside
    import openmdao.api as om

    scene = coarse_scene("bonded")
    (section,) = scene.shaft.sections
    modulus = scene.material_of("shaft").youngs_modulus / 2.6
    D, L = section.outer_diameter, section.length
    solid = modulus * np.pi * D**4 / 32.0 / L
    limit = 0.7 * solid
    problem = om.Problem()
    problem.model.add_subsystem("design", design_component(scene, _request()), promotes=["*"])
    problem.driver = om.ScipyOptimizeDriver(optimizer="SLSQP", tol=1e-12, disp=False)
    name = KEY.replace(".", ":")
    problem.model.add_design_var(name, lower=0.05, upper=0.35, ref=0.1)
    problem.model.add_objective("mass:shaft", ref=1e3)
    problem.model.add_constraint("shaft:torsional", lower=limit, ref=solid)
    problem.setup()
    problem.run_driver()
    exact = (0.3 * D**4) ** 0.25
    assert problem.get_val(name)[0] == pytest.approx(exact, rel=1e-5)
    checked = problem.check_partials(out_stream=None, form="central", step=1e-4)
    for one in checked["design"].values():
        assert one["J_fwd"] == pytest.approx(one["J_fd"], rel=1e-4)


def test_a_list_of_values_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("openmdao")
    with pytest.raises(InputError, match="has a list of values"):
        design_component(coarse_scene("bonded"), _request(**{KEY: [0.1, 0.2, 0.3]}))


def test_without_openmdao_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "openmdao.api", None)
    with pytest.raises(InputError, match="pip install"):
        design_component(coarse_scene("bonded"), _request())
