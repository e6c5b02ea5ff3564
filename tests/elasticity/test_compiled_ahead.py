"""What is compiled beside other work is all that real work calls of it, in the same forms."""

import os

import pytest

from fe_drivetrain.common import run_python, threads
from fe_drivetrain.elasticity import compiled_ahead
from fe_drivetrain.elasticity.compiled_ahead import is_compiled

#: Rehearse, do real work, and print the loops of a module that this has compiled or loaded beside.
PROGRAM = """
import sys
from importlib import import_module
from numba.core.dispatcher import Dispatcher
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.elasticity.compiled_ahead import rehearse
from fe_drivetrain.studies.scene_description import quick_scene

def forms(module):
    return {(name, form) for name, loop in vars(module).items() if isinstance(loop, Dispatcher)
            for form in loop.signatures}

def meridian(scene):
    from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft
    meridian_shaft(scene)

def solver(scene):
    from fe_drivetrain.shafts.response.model import build_model, mesh_scene
    from fe_drivetrain.shafts.response.unit_loads import unit_load_response
    unit_load_response(build_model(scene, mesh_scene(scene)), "multigrid")

def bearing(scene):
    from fe_drivetrain.bearing.catalogue import read_bearing_catalogue
    from fe_drivetrain.bearing.rolling import equilibrium
    for kind in ("double_row_tapered", "spherical_roller", "cylindrical"):
        entry = next(one for one in read_bearing_catalogue().values() if one.kind == kind)
        found = equilibrium(entry.bearing("b"), [[0, 2e4, 1e4, 0, 0], [0, 0, 2e4, 0, 0]])
        found.unbalanced, found.rollers

solid = ("operator.kernels", "mesh.bodies", "solve.linear_elements", "solve.aggregates")
work, modules = {
    "meridian": (meridian, ["elasticity.revolution.frontal"]),
    "solver": (solver, [f"elasticity.{name}" for name in solid]),
    "bearing": (bearing, ["bearing.newton"]),
}[sys.argv[1]]
modules = [import_module(f"fe_drivetrain.{module}") for module in modules]
rehearse(sys.argv[1])
before = [forms(module) for module in modules]
assert all(before)
work(quick_scene(library_scene("main_bearing_bonded")))
added = [forms(module) - those for module, those in zip(modules, before, strict=True)]
print(sorted({name for those in added for name, form in those}))
"""


@pytest.mark.parametrize("loops", ["meridian", "solver", "bearing"])
def test_real_work_finds_every_loop_compiled(loops):
    done = run_python("-c", PROGRAM, loops)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("loops", ["meridian", "solver", "bearing"])
def test_whether_loops_are_compiled_is_seen_by_the_last_of_them(loops, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert not is_compiled(loops)
    file, name = compiled_ahead._LAST[loops].split(":")
    module = compiled_ahead.Path(compiled_ahead.__file__).parent / file
    kept = tmp_path / "room_1" / f"{module.stem}.{name}-12.py311.nbi"
    kept.parent.mkdir()
    kept.touch()
    assert is_compiled(loops)
    changed = module.stat().st_mtime - 1.0
    os.utime(kept, (changed, changed))
    assert not is_compiled(loops)


def test_no_process_starts_on_one_core_nor_for_what_is_compiled(tmp_path, monkeypatch):
    def refuse(*_):
        raise AssertionError("a process was started")

    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(compiled_ahead, "Worker", refuse)
    with compiled_ahead.compiled_ahead("solver"):  # tests have one core
        pass
    monkeypatch.setenv(threads.CORES_VARIABLE, "2")
    with pytest.raises(AssertionError), compiled_ahead.compiled_ahead("solver"):
        pass
    monkeypatch.setattr(compiled_ahead, "is_compiled", lambda loops: True)
    with compiled_ahead.compiled_ahead("solver"):
        pass
