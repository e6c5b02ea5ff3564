"""Six steps, loops back, and no end before each was taken."""

from itertools import permutations

import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.steps import Evidence, Procedure, Visit, require_complete


def taken(*steps: int) -> Procedure:
    found = Procedure("drivetrain")
    for step in steps:
        found = found.after(Visit(step, f"done {step}"))
    return found


@pytest.mark.parametrize("missing", range(1, 7))
def test_it_cannot_end_with_a_step_that_was_not_taken(missing: int) -> None:
    found = taken(*(step for step in (1, 2, 3, 4, 2, 3, 4, 5, 6, 5, 6) if step != missing))
    assert found.missing == (missing,)
    with pytest.raises(InputError, match=rf"steps {missing} \("):
        require_complete(found)


def test_any_order_is_complete_that_has_each_step() -> None:
    for order in permutations(range(1, 7)):
        found = taken(*order)
        assert not found.missing
        require_complete(found)


def test_loops_are_logged_with_their_reason() -> None:
    found = taken(1, 2, 3, 4).after(Visit(2, "stiffness of the mounts cannot be identified"))
    assert found.loops == ((4, 2, "stiffness of the mounts cannot be identified"),)
    assert taken(1, 2, 3, 4, 5, 6).loops == ()


def test_evidence_that_fails_keeps_it_open_until_the_step_is_taken_again() -> None:
    bad = Evidence("procedure/identification", "damping", passed=False)
    found = taken(1, 2, 3, 4, 5).after(Visit(6, "compared", (bad,)))
    with pytest.raises(InputError, match="did not pass"):
        require_complete(found)
    good = Evidence("procedure/identification", "damping", passed=True, band=0.2)
    require_complete(found.after(Visit(6, "after a new campaign", (good,))))


def test_a_visit_needs_a_step_and_a_decision() -> None:
    with pytest.raises(InputError, match="1 to 6"):
        Visit(7, "more")
    with pytest.raises(InputError, match="no decision"):
        Visit(1, " ")
