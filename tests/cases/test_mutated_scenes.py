"""Mutants of scenes follow from their seed, and what judges them finds what is wrong."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.cases.verification import scene_mutants
from fe_drivetrain.cases.verification.scene_mutants import Mutant, judged, mutants
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.drivetrain_file.reading import library_text

NAME = "three_point_suspension"


def sound(name: str = NAME) -> Mutant:
    return Mutant(name, "none", "none", parse_mapping(library_text(name), name))


def test_mutants_follow_from_the_seed_and_are_of_every_kind():
    found = list(mutants(300, 5))
    assert [m.change for m in found] == [m.change for m in mutants(300, 5)]
    assert [m.change for m in found] != [m.change for m in mutants(300, 6)]
    kinds = Counter(m.kind for m in found)
    assert len(kinds) == 9
    assert min(kinds.values()) >= 5
    assert {m.library for m in found} == {*scene_mutants.SCENES, *scene_mutants.COMPONENTS}


@pytest.mark.parametrize("name", [NAME, "iea_15mw_shaft_on_nose", "gearbox_housing"])
def test_a_sound_scene_has_no_fault_and_every_fact(name):
    outcome = judged(sound(name), meridian=False, cad=True)
    assert not outcome.sentence
    assert not outcome.faults
    assert len(outcome.errors) >= 3
    assert max(outcome.errors.values()) < 1.0


@pytest.mark.parametrize("name", ["main_bearing", "gearbox"])
def test_a_reaction_that_is_wrong_by_a_millionth_is_found(name, monkeypatch):
    solve = scene_mutants.shaft_level

    def wrong(scene, level):
        model = solve(scene, level)
        matrices = dict(model.reaction_matrices.items())
        matrices[name] = matrices[name] * (1 + 1e-6)
        return replace(model, reaction_matrices=matrices)

    monkeypatch.setattr(scene_mutants, "shaft_level", wrong)
    outcome = judged(sound(), meridian=False, cad=False)
    assert outcome.errors["level 1: equilibrium"] > 1.0
    assert outcome.errors["level 1: statics"] > 1.0


def test_a_compliance_that_does_not_follow_the_modulus_is_found(monkeypatch):
    solve = scene_mutants.shaft_level

    # twice as stiff, the part that is added is not halved: its share of the largest motion
    fixed = solve(scene_mutants.parse_scene(library_text(NAME)), 1).compliance
    added = 1e-5 * np.diag(fixed).max()

    def constant(scene, level):
        model = solve(scene, level)
        return replace(model, compliance=model.compliance + added)

    monkeypatch.setattr(scene_mutants, "shaft_level", constant)
    assert judged(sound(), meridian=False, cad=False).errors["level 1: Hooke"] > 1.0


@pytest.mark.parametrize(
    ("error", "fault"),
    [
        (InputError("scene: math domain error"), "in words that are not the program's"),
        (InputError("no"), "in words that are not the program's"),
        (ZeroDivisionError("division by zero"), "read with ZeroDivisionError"),
    ],
)
def test_a_refusal_in_words_of_python_and_any_other_exception_are_faults(error, fault, monkeypatch):
    def fails(text):
        raise error

    monkeypatch.setattr(scene_mutants, "parse_scene", fails)
    assert fault in judged(sound(), meridian=False, cad=False).faults[0]


def test_a_step_after_the_gate_that_refuses_is_a_fault(monkeypatch):
    def refuses(scene, level):
        raise InputError("the shaft is too long: shorten it")

    monkeypatch.setattr(scene_mutants, "scene_body", refuses)
    assert "too long" in judged(sound(), meridian=False, cad=False).faults[0]
