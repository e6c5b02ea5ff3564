"""A user's record of a shaft: each method's answer, and the decrement of a stop, in a project."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.channels import ChannelFile, Channels, read_channels, write_channels
from fe_drivetrain.procedure.decay import logarithmic_decrement
from fe_drivetrain.procedure.identified_shaft import identified
from fe_drivetrain.procedure.methods import SPECTRA, damping_of_decay
from fe_drivetrain.procedure.project import Identified

STIFFNESS, DAMPING, INERTIA = 3.69e7, 4.0e5, 1.4e5
STEP, STOP = 0.01, 100.0


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Channels:
    """Broadband twist, then the free decay of an oscillator with the shaft's spring and damper."""
    time = np.arange(0.0, 130.0, STEP)
    natural = np.sqrt(STIFFNESS / INERTIA)
    ratio = DAMPING / (2.0 * np.sqrt(STIFFNESS * INERTIA))
    swing = natural * np.sqrt(1.0 - ratio**2)
    after = time - STOP
    decay = np.exp(-ratio * natural * after.clip(0.0)) * np.cos(swing * after)
    driven = sum(np.sin(2.0 * np.pi * f * time + f) for f in (0.4, 0.9, 1.3, 2.1, 2.6))
    twist = 1e-3 * np.where(after < 0.0, driven, 5.0 * decay)
    torque = STIFFNESS * twist + DAMPING * np.gradient(twist, STEP)
    path = tmp_path_factory.mktemp("record") / "mine.csv"
    columns = {"front [rad]": twist, "rear [rad]": 0.0 * twist, "torque [N m]": torque}
    write_channels(path, STEP, columns)
    return read_channels(
        ChannelFile(file=path.name), path.parent, frozenset({"front", "rear", "torque"})
    )


def asked(**more: float) -> Identified:
    return Identified(
        torque="torque",
        front="front",
        rear="rear",
        band=(0.2, 3.5),
        stiffness=STIFFNESS,
        damping=DAMPING,
        tolerance=0.05,
        **more,
    )


def test_a_stop_gives_the_damper_by_its_decrement_beside_the_spectra(record: Channels) -> None:
    found = identified(asked(stop=STOP), record)
    (decrement,) = (one for one in found.verdicts if "decrement" in one.quantity)
    assert decrement.reference == pytest.approx(DAMPING, rel=0.01)
    assert decrement.passed
    assert identified(asked(), record).methods == {}


def test_each_method_of_the_report_answers_where_a_turn_is_stated(record: Channels) -> None:
    found = identified(asked(turn=4.0), record)
    by = {one.method: one for one in found.methods["torque"]}
    assert list(by)[:5] == [
        "Eq 4, ranges",
        "Eq 5, ranges",
        "A, time",
        "B, differential",
        "C, constant",
    ]
    assert by[SPECTRA].stiffness == pytest.approx(STIFFNESS, rel=0.02)
    # ranges of Eq 4 are sqrt(K^2 + (w D)^2) at one frequency: above K, and not far
    assert STIFFNESS < float(by["Eq 4, ranges"].stiffness or 0.0) < 1.1 * STIFFNESS
    # method A sees the damper as D / (1 - tan w t), or has none: it is not the damper
    assert abs(float(by["A, time"].damping or 0.0) / DAMPING - 1.0) > 0.2


def test_the_damper_of_a_decay_is_exact_of_an_exact_decay() -> None:
    time = np.arange(0.0, 3.0, 1e-3)
    natural, ratio = 12.0, 0.04
    swing = natural * np.sqrt(1.0 - ratio**2)
    signal = np.exp(-ratio * natural * time) * np.cos(swing * time)
    damping, _ = damping_of_decay(logarithmic_decrement(signal, 1e-3), 1e6)
    assert damping == pytest.approx(2.0 * ratio * 1e6 / natural, rel=1e-4)


def test_a_stop_after_the_record_is_refused(record: Channels) -> None:
    with pytest.raises(InputError, match="stop = 500 s is at the end of a record of 130 s, or"):
        identified(asked(stop=500.0), record)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"turn": 1e-6}, "turn is 1e-06 s but must be from"),
        ({"turn": 66.0}, "to 65 s, half of the record"),
        ({"turn": 1e9}, "turn is 1e\\+09 s"),
        ({"ratio": 0.0}, "ratio of identified is 0"),
    ],
)
def test_a_turn_that_the_record_has_not_is_refused(
    record: Channels, more: dict[str, float], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        identified(asked(**more), record)


def test_a_twist_that_grows_has_no_damper() -> None:
    time = np.arange(0.0, 3.0, 1e-3)
    growing = np.exp(0.5 * time) * np.cos(12.0 * time)
    with pytest.raises(InputError, match="does not decay after the stop"):
        damping_of_decay(logarithmic_decrement(growing, 1e-3), 1e6)
