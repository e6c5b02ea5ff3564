"""A model is set up once, for as long as it is in use."""

import gc
from dataclasses import replace

import numpy as np

from fe_drivetrain.shafts.response import prepared as module
from fe_drivetrain.shafts.response.prepared import prepared


def test_a_model_in_use_is_set_up_once_and_forgotten_with_it(bonded_model):
    model = replace(bonded_model)
    first = prepared(model, "superlu", 1)
    assert prepared(model, "superlu", 6) is first
    assert prepared(model, "multigrid", 6) is not first
    before = len(module._PREPARED)
    del model
    gc.collect()
    assert len(module._PREPARED) == before - 1


def test_solutions_balance_their_loads(bonded_model, rng):
    ready = prepared(bonded_model, "superlu", 1)
    T = ready.elimination.T
    loads = rng.standard_normal((bonded_model.n_dofs, 2))
    u, _ = ready.solve(loads)
    left = T.T @ (ready.stiffness @ u - loads)
    assert np.abs(left).max() < 1e-9 * np.abs(T.T @ loads).max()
