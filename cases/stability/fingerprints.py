"""One process's answers, to the last bit: written to a file, to be compared with another's.

Run as ``python -m fe_drivetrain.cases.stability.fingerprints FILE L/D ...``; the threads are those
that the environment gives.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from fe_drivetrain.cases.references.soft_springs import scene_of
from fe_drivetrain.common import Floats, InputError, run_python, until_stopped
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.mesh import shaft_hexahedra
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import direct_solvers, factorise, reduce
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.shafts.response import build_model, mesh_scene

Arrays = Mapping[str, Floats]

_THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "FE_DRIVETRAIN_CORES",
)

#: Compared as one number each; all else as arrays.
STIFFNESS = "stiffness"


def scene_arrays() -> dict[str, Floats]:
    """ "mesh" and "operator" of a main bearing, made again where the cache is disabled."""
    scene = scene_of("bonded")
    mesh = mesh_scene(scene)
    return {"mesh": mesh.points, "operator": build_model(scene, mesh).stiffness.data}


def tube_answers(slenderness: Iterable[float], backwards: bool = False) -> dict[str, Floats]:
    """Displacements of tubes under a force across their end, and their bending stiffness.

    Parameters
    ----------
    slenderness : iterable of float
        Lengths over the diameter.
    backwards : bool
        Nodes are numbered from the last to the first.

    Returns
    -------
    arrays : dict
        "METHOD at L/D" (n,) in the order of the numbers, and "stiffness, METHOD at L/D" (1,); NaN
        where the method refuses, or hands over to another one.
    """
    lame = MATERIALS["steel"].lame
    found: dict[str, Floats] = {}
    for value in slenderness:
        length = 0.6 * value
        tube = Shaft(
            front=0.0,
            sections=(Section(length=length, outer_diameter=0.6, inner_diameter=0.3),),
        )
        solid = shaft_hexahedra(tube, 1.001 * length / 6, 27, elements_per_turn=6)
        number = np.arange(len(solid.points))[:: -1 if backwards else 1]
        points = np.empty_like(solid.points)
        points[number] = solid.points
        cells = number[solid.cells]
        n = points.size
        elimination = eliminate([fixed("front", number[solid.front], n)], n)
        system = reduce(points, cells, assemble(points, cells, lame, n), elimination)
        F = np.zeros((n, 1))
        F[3 * number[solid.rear] + 2, 0] = 1.0
        for method in methods():
            x = np.full(n, np.nan)
            try:
                answer = factorise(system, method).solve(F)
                if answer.diagnostics.method == method:
                    x = answer.x[:, 0]
            except InputError:
                pass
            found[f"{method} at {value:g}"] = x
            found[f"{STIFFNESS}, {method} at {value:g}"] = np.array([1.0 / (F[:, 0] @ x)])
    return found


def methods() -> list[str]:
    """Solvers that are installed."""
    return [m for m in direct_solvers.PACKAGES if direct_solvers.is_installed(m)] + ["multigrid"]


def elsewhere(file: Path, slenderness: Iterable[float], threads: int) -> dict[str, Floats]:
    """`scene_arrays` and `tube_answers` in a process of its own, with so many threads, no cache."""
    done = run_python(
        *("-m", __spec__.name, str(file), json.dumps(list(slenderness))),
        environment={**dict.fromkeys(_THREADS, str(threads)), "FE_DRIVETRAIN_CACHE": "off"},
    )
    if done.returncode:
        raise RuntimeError(f"a process that should repeat a run failed: {done.stderr[-2000:]}")
    with np.load(file) as archive:
        return {name: archive[name] for name in archive.files}


def different(a: Arrays, b: Arrays) -> list[str]:
    """Names of the arrays that differ in any bit."""
    return [name for name in a if a[name].tobytes() != b[name].tobytes()]


def main() -> None:
    """Compute, and write to the file that is named."""
    file, slenderness = sys.argv[1], json.loads(sys.argv[2])
    with Path(file).open("wb") as stream:
        np.savez(stream, **scene_arrays(), **tube_answers(slenderness))  # type: ignore[arg-type]


if __name__ == "__main__":
    sys.exit(until_stopped(main))
