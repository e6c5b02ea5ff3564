"""Convergence over step and harmonics: bands that cover, checks, and answers that stay open."""

from functools import partial

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.in_time import (
    ConvergenceInTime,
    InTime,
    converge_in_time,
    peak_between,
)
from fe_drivetrain.dynamics.bodies.equations import equations_of_motion, spring_laws, steady
from fe_drivetrain.dynamics.bodies.meshing import contact_wave
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.report.suite.in_time import check_in_time
from fe_drivetrain.report.suite.page import Page

END, FORCE = "displacement at the end [m]", "largest force [N]"
MINIMUM = "least force after it [N]"
SECONDS = 3.0


def of_mesh(
    dt: float,
    harmonics: int,
    ratio: float = 1.6,
    frequency: float = 3.0,
    phase: float = 0.0,
    damping: float = 0.2,
) -> InTime:
    """One mass on a mesh that is suddenly loaded; on a plain spring without harmonics."""
    law = (
        spring_laws([[1.0]], 40.0, damping)
        .in_phase(phase=phase, frequency=frequency)
        .with_waves(contact_wave(ratio, harmonics)[None])
        if harmonics
        else spring_laws([[1.0]], 40.0, damping)
    )
    motion = integrate(equations_of_motion([1.0], law), steady([1.0]), SECONDS, dt)
    force = motion.forces[:, 0]
    values = {
        END: float(motion.q[-1, 0]),
        FORCE: peak_between(force),
        MINIMUM: -peak_between(-force[force.argmax() :]),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def test_the_band_of_the_step_covers_an_exact_motion() -> None:
    found = converge_in_time(of_mesh, 1e-2)
    w, d = np.sqrt(40.0 - 0.01), 0.1
    exact = (1 - np.exp(-d * SECONDS) * (np.cos(w * SECONDS) + d / w * np.sin(w * SECONDS))) / 40.0
    missed = abs(found.value(END) - exact)
    assert missed <= found.step_band(END) < 10.0 * missed
    assert found.band(END) == found.step_band(END)
    assert found.energy_error < 1e-12
    assert found.steps == (4e-2, 2e-2, 1e-2)


def test_bands_cover_peaks_of_random_meshes() -> None:
    """Those of step and harmonics together, against an eighth of one and eight times the other."""
    rng = np.random.default_rng(4)
    held = []
    for _ in range(20):
        mesh = partial(
            of_mesh,
            ratio=rng.uniform(1.1, 1.9),
            frequency=10.0 ** rng.uniform(-0.5, 0.5),
            phase=rng.uniform(),
            damping=rng.uniform(0.05, 1.0),
        )
        found, exact = converge_in_time(mesh, 2e-3, 8), mesh(2.5e-4, 64).values
        held += [abs(found.value(key) - exact[key]) <= found.band(key) for key in (FORCE, MINIMUM)]
    assert np.mean(held) >= 0.95


def test_what_does_not_vary_has_no_harmonics() -> None:
    found = converge_in_time(of_mesh, 1e-3, 8)
    assert found.harmonics == (2, 4, 8)
    assert found.by_harmonics[-1] is found.finest
    assert found.band(FORCE) == found.step_band(FORCE) + found.harmonics_band(FORCE)
    assert converge_in_time(of_mesh, 1e-3).harmonics_band(FORCE) == 0.0


def test_a_peak_between_samples() -> None:
    t = np.arange(0.0, 3.0, 0.1)
    assert peak_between(np.sin(t + 0.03)) == pytest.approx(1.0, abs=1e-5)
    assert np.sin(t + 0.03).max() < 1.0 - 1e-4
    # at an end, and on a corner or a plateau, it is the sample
    assert peak_between([1.0, 0.5, 0.25]) == 1.0
    assert peak_between([0.0, 2.0, 2.0, 0.0]) == pytest.approx(2.25)
    assert peak_between([1.0, 1.0, 1.0]) == 1.0


def test_the_energy_of_a_varying_stiffness_closes_with_the_square_of_the_step() -> None:
    found = converge_in_time(of_mesh, 1e-3, 4)
    first, second, third = (one.energy_error for one in found.by_step)
    assert first / second == pytest.approx(4.0, rel=0.1)
    assert second / third == pytest.approx(4.0, rel=0.1)


def test_too_few_harmonics_are_refused() -> None:
    with pytest.raises(InputError, match="2 harmonics have no series"):
        converge_in_time(of_mesh, 1e-2, 2)


def series(*values: float, energy: float = 1e-4, converged: bool = True) -> ConvergenceInTime:
    runs = tuple(InTime({FORCE: value}, energy, converged) for value in values)
    return ConvergenceInTime((4.0, 2.0, 1.0), runs)


def checked(found: ConvergenceInTime, **given: object) -> Page:
    page = Page()
    check_in_time(page, "step", found, {FORCE: 0.05}, energy=1e-2, why="small", **given)  # type: ignore[arg-type]
    return page


def test_what_has_converged_is_checked() -> None:
    page = checked(series(1.16, 1.04, 1.01))
    assert [v.passed for v in page.checks] == [True, True]
    assert page.checks[1].quantity == "step: left uncertain by the step, of largest force, over it"
    assert page.checks[1].computed == pytest.approx(0.03 / 1.01, rel=1e-6)
    assert not page.unsettled


def test_what_has_not_converged_fails_or_is_open_but_never_passes() -> None:
    coarse = series(1.9, 1.5, 1.1)
    assert [v.passed for v in checked(coarse).checks] == [True, False]
    page = checked(coarse, open_for=[FORCE])
    assert [v.passed for v in page.checks] == [True]
    assert page.unsettled == [
        "Not converged: step: largest force, uncertain by ± 1\u00a0N by the step."
    ]
    assert [v.passed for v in checked(series(1.16, 1.04, 1.01, energy=0.02)).checks] == [
        False,
        True,
    ]
    lost = checked(series(1.16, 1.04, 1.01, converged=False))
    assert lost.unsettled == ["Not converged: step, iterations of some steps."]
    # of several the worst is checked, by what each is allowed
    runs = tuple(
        InTime({FORCE: a, END: b}, 0.0) for a, b in ((1.16, 1.0), (1.04, 1.0), (1.01, 1.0))
    )
    two = Page()
    both = ConvergenceInTime((4.0, 2.0, 1.0), runs)
    check_in_time(two, "step", both, {END: 1e-6, FORCE: 0.01}, energy=1.0, why="small")
    assert [v.passed for v in two.checks] == [True, False]
    assert two.checks[1].source.endswith(FORCE)
    # a value of zero has no share: it is measured by a size that is given
    zero = series(0.08, 0.02, 0.0)
    assert [v.passed for v in checked(zero).checks] == [True, False]
    assert [v.passed for v in checked(zero, scale={FORCE: 1.0}).checks] == [True, True]
