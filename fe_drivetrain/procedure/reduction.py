"""Which degrees of freedom of a drivetrain matter: springs are locked, and results change or not.

PROTEST 2010, section 4.3, starts from the most advanced model and takes degrees of freedom out
until a result changes, in three ways: by a threshold on the modes (1), by the spectra of signals
(2), one after another (3). Here a spring that does not matter is locked: its elongation is held at
zero, so that its degree of freedom is gone. By Courant's principle each natural frequency rises
with each spring that is locked.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import equations_of_motion, spring_laws, varying
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.superposition import modal_superposition

_KINDS = {"ux": "axial", "uy": "across", "uz": "across", "rx": "torsion"}
_KINDS |= {"ry": "bending", "rz": "bending"}
_DEPENDENT = 1e-10
"""Share of the largest singular value below which a locked elongation follows from the others."""

Signal = Callable[[Floats], Floats]
"""Samples of a signal by the basis of what still moves."""


def spring_groups(system: System) -> dict[str, list[int]]:
    """Springs by part and kind: "LSS torsion", "stage 1 pin across", "stage 2 mesh".

    Slices of a mesh, planets, elements of a shaft and both directions across go together. Springs
    that nothing stretches at this level are left out, and those that cannot change, since a motion
    without mass was eliminated by them.

    Parameters
    ----------
    system : System
        System of a machine.
    """
    found: dict[str, list[int]] = {}
    for number, name in enumerate(system.spring_names):
        if name in system.unchangeable or not system.rows[number].any():
            continue
        part, _, motion = name.rpartition(" ")
        kind = _KINDS.get(motion, "")
        part = part if kind else name
        part = re.sub(r" (slice|element) \d+", "", part)
        part = re.sub(r"(planet|pin) \d+.*", r"\1", part)
        found.setdefault(f"{part} {kind}".strip(), []).append(number)
    return found


def locked_basis(system: System, springs: Sequence[int]) -> Floats:
    """What can move while some springs do not stretch.

    Parameters
    ----------
    system : System
        With a positive mass matrix.
    springs : sequence of int
        Numbers of those that are locked.

    Returns
    -------
    ndarray, (n, r)
        Motions, orthogonal with the mass, which becomes the unit matrix.
    """
    root = np.linalg.cholesky(system.mass)
    if not len(springs):
        return np.asarray(linalg.solve_triangular(root, np.eye(len(root)), lower=True, trans=1))
    held = linalg.solve_triangular(root, system.rows[list(springs)].T, lower=True).T
    held = held / np.linalg.norm(held, axis=1, keepdims=True)
    _, sizes, right = np.linalg.svd(held, full_matrices=True)
    rank = int((sizes > _DEPENDENT * sizes[0]).sum())
    return np.asarray(linalg.solve_triangular(root, right[rank:].T, lower=True, trans=1))


def frequencies_on(system: System, basis: Floats) -> Floats:
    """(r,) natural frequencies, ascending, 0 of free motions, of what can move [Hz].

    Parameters
    ----------
    system : System
        System that the basis belongs to.
    basis : ndarray, (n, r)
        Basis from `locked_basis`.
    """
    size = np.sqrt(system.stiffness)[:, None]
    wound = size * (system.rows @ basis)
    # what rounding leaves of elongations that are locked: of the full model's stiffness
    floor = float(np.finfo(float).eps * np.linalg.norm(size * np.abs(system.rows) @ np.abs(basis)))
    if system.extra.any():
        values = np.linalg.eigvalsh(wound.T @ wound + basis.T @ system.extra @ basis)
        omega = np.sqrt(np.clip(values, 0.0, None))
        floor = max(floor, float(np.sqrt(len(omega) * np.finfo(float).eps) * omega.max()))
    else:
        sizes = np.linalg.svd(wound, compute_uv=False)
        omega = np.zeros(basis.shape[1])
        omega[: len(sizes)] = sizes[: len(omega)]
        omega = np.sort(omega)
    omega[omega <= floor] = 0.0
    return np.asarray(omega / (2.0 * np.pi))


@dataclass(frozen=True)
class Influence:
    """A group of springs, and what it is for the modes up to a frequency.

    Attributes
    ----------
    group : str
        Its name.
    springs : tuple of int
        Numbers of its springs.
    share : float
        Largest share of the strain energy of any of these modes.
    error : float
        Largest relative rise of any of their frequencies while the group alone is locked.
    """

    group: str
    springs: tuple[int, ...]
    share: float
    error: float


def influences(
    system: System, groups: Mapping[str, Sequence[int]], highest: float
) -> list[Influence]:
    """All groups, from the one that matters least when it is locked alone.

    The share of the strain energy tells it of springs in series. One that is soft beside a stiff
    one has no share, whatever it moves: locking it holds what both let move.

    Parameters
    ----------
    system : System
        The full model.
    groups : mapping of str to sequence of int
        Springs by group; see `spring_groups`.
    highest : float
        Frequency up to which modes count [Hz].

    Raises
    ------
    InputError
        No mode is at or below that frequency.
    """
    modes = system_modes(system)
    counted = (modes.frequencies > 0.0) & (modes.frequencies <= highest)
    if not counted.any():
        raise InputError(f"no mode is at or below {highest:g} Hz: give a higher frequency")
    full = modes.frequencies[counted]
    found = []
    for group, springs in groups.items():
        share = float(modes.strain_shares[list(springs)][:, counted].sum(axis=0).max())
        error = _rise(system, springs, full)
        found.append(Influence(group, tuple(springs), share, error))
    return sorted(found, key=lambda one: one.error)


def mode_error(system: System, springs: Sequence[int], highest: float) -> float:
    """Largest relative rise of a natural frequency while springs are locked.

    Parameters
    ----------
    system : System
        The full model.
    springs : sequence of int
        Those that are locked.
    highest : float
        Frequency of the full model up to which modes count [Hz].

    Returns
    -------
    float
        Never negative but for rounding; infinite where a mode has no successor.
    """
    full = frequencies_on(system, locked_basis(system, ()))
    return _rise(system, springs, full[(full > 0.0) & (full <= highest)])


def _rise(system: System, springs: Sequence[int], full: Floats) -> float:
    less = frequencies_on(system, locked_basis(system, springs))
    less = less[less > 0.0][: len(full)]
    return float((less / full - 1.0).max()) if len(less) == len(full) else float("inf")


def threshold_share(tolerance: float) -> float:
    """Share of the strain energy of a mode from which a spring matters, ``1 - 1/(1 + e)^2``.

    Of two springs in series, of which one has the share s, locking that one raises the frequency by
    ``1/sqrt(1 - s) - 1``; for small s this is s / 2.

    Parameters
    ----------
    tolerance : float
        Allowed relative error e of a frequency.
    """
    return 1.0 - (1.0 + tolerance) ** -2


def frequency_that_holds(signal: Floats, step: float, share: float = 0.999) -> float:
    """Frequency below which a share of the power of a signal without its mean is (proposition 2).

    Parameters
    ----------
    signal : ndarray, (n,)
        Signal of the full model.
    step : float
        Between two samples [s].
    share : float
        Share of the power.

    Raises
    ------
    InputError
        The signal does not vary.
    """
    power = np.abs(np.fft.rfft(np.asarray(signal) - np.mean(signal))) ** 2
    if not power.sum() > 0.0:
        raise InputError("a signal that does not vary has no spectrum: load the model")
    held = np.cumsum(power) / power.sum()
    return float(np.fft.rfftfreq(len(signal), step)[int(np.argmax(held >= share))])


def torque_signal(
    system: System, load: Floats, history: Floats, step: float, shaft: str, front: str = ""
) -> Signal:
    """The torque in a shaft under a load that varies, from rest, by what still moves.

    Parameters
    ----------
    system : System
        With dampers in proportion to its stiffness.
    load : ndarray, (n,)
        Pattern of the load [N, N m].
    history : ndarray, (samples,)
        Its size, straight between samples.
    step : float
        Between two samples [s].
    shaft : str
        Name of the shaft, of which the first torsion spring is read; it must not be locked.
    front : str
        Body at the front end of a shaft that is condensed and has no springs: the torque is what
        superelements hold it with. Empty where the shaft has springs.

    Returns
    -------
    callable
        (samples,) torque [N m] for a basis of `locked_basis`.

    Raises
    ------
    InputError
        The shaft has no torsion spring, and no superelement holds its front end.
    """
    names = [f"{shaft} rx", f"{shaft} element 1 rx"]
    watched = next((k for k, n in enumerate(system.spring_names) if n in names), None)
    if watched is not None:
        torque = system.stiffness[watched] * system.rows[watched]
    elif front:
        torque = system.extra[system.place(f"{front} rx")]
    else:
        torque = np.zeros(0)
    if not torque.any():
        raise InputError(
            f"no shaft {shaft!r} with a torsion spring: name a shaft of the machine, or under "
            "front the body that a condensed shaft begins at"
        )
    times = np.arange(len(history)) * step

    def run(basis: Floats) -> Floats:
        rows = system.rows @ basis
        equations = equations_of_motion(
            np.ones(basis.shape[1]),
            spring_laws(rows, system.stiffness, system.damping),
            extra=basis.T @ system.extra @ basis,
        )
        loads = varying(basis.T @ load, times, history)
        found = modal_superposition(equations, loads, float(times[-1]), step)
        return np.asarray(found.q @ (torque @ basis))

    return run


@dataclass(frozen=True)
class Trial:
    """A group that was locked beside all that stay locked.

    Attributes
    ----------
    group : str
        Its name; empty of the full model.
    stays : bool
        Whether it stays locked: the signal changed by no more than the tolerance.
    degrees : int
        Number of degrees of freedom that are left with it.
    signal_error : float
        Root mean square of the signal's difference from the full model's over that of the signal.
    seconds : float
        Taken by the signal.
    """

    group: str
    stays: bool
    degrees: int
    signal_error: float
    seconds: float


def one_after_another(
    system: System, order: Sequence[Influence], signal: Signal, tolerance: float
) -> list[Trial]:
    """Lock groups one after another; one that changes the signal is let go again (proposition 3).

    Parameters
    ----------
    system : System
        The full model.
    order : sequence of Influence
        From the group that matters least.
    signal : callable
        Runs the load case.
    tolerance : float
        Error of the signal up to which a group stays locked.

    Returns
    -------
    list of Trial
        The full model, and each group in its order.

    Raises
    ------
    InputError
        The signal does not vary.
    """
    trials: list[Trial] = []
    kept: list[int] = []
    reference = np.zeros(0)
    for one in (None, *order):
        springs = [] if one is None else list(one.springs)
        start = time.perf_counter()
        basis = locked_basis(system, [*kept, *springs])
        samples = signal(basis)
        seconds = time.perf_counter() - start
        if one is None:
            reference = samples
            size = float(np.linalg.norm(reference - reference.mean()))
            if not size > 0.0:
                raise InputError("the signal of the full model does not vary: load it")
        error = float(np.linalg.norm(samples - reference)) / size
        stays = error <= tolerance
        kept += springs if stays else []
        name = "" if one is None else one.group
        trials.append(Trial(name, stays, basis.shape[1], error, seconds))
    return trials
