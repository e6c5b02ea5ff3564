"""Wind of TurbSim and HAWC2: round trips, known points, and loads of known winds."""

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition, hub_loads
from fe_drivetrain.turbine_loads.hub_loads.wind import at_azimuth, power_law
from fe_drivetrain.turbine_loads.hub_loads.wind_boxes import (
    WindBox,
    box_hub_loads,
    read_bts,
    read_hawc2,
    write_bts,
    write_hawc2,
)

HUB = 80.0


def box_of(speed: Floats, reach: float = 45.0, step: float = 0.2) -> WindBox:
    _, ny, nz = speed.shape
    y, z = np.linspace(-reach, reach, ny), np.linspace(HUB - reach, HUB + reach, nz)
    return WindBox("made", step, y, z, speed.astype(np.float32))


def uniform(n: int, value: float, points: int = 13) -> Floats:
    return np.full((n, points, points), value)


def test_a_field_comes_back_from_turbsim_within_its_sixteen_bits(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    box = box_of(10.0 + rng.standard_normal((20, 5, 7)))
    write_bts(box, tmp_path / "a.bts", HUB)
    found = read_bts(tmp_path / "a.bts")
    bit = float(np.ptp(box.speed)) / 65535.0
    np.testing.assert_allclose(found.speed, box.speed, atol=0.51 * bit + 1e-6)
    np.testing.assert_allclose(found.y, box.y, atol=1e-4)
    np.testing.assert_allclose(found.z, box.z, atol=1e-4)
    assert found.step == pytest.approx(0.2)
    content = (tmp_path / "a.bts").read_bytes()
    (tmp_path / "cut.bts").write_bytes(content[:-10])
    with pytest.raises(InputError, match="its header states"):
        read_bts(tmp_path / "cut.bts")
    (tmp_path / "other.bts").write_bytes(b"\1\0" + content[2:])
    with pytest.raises(InputError, match="identifier 1 is not one"):
        read_bts(tmp_path / "other.bts")


def test_a_field_comes_back_from_hawc2(tmp_path: Path, rng: np.random.Generator) -> None:
    box = box_of(10.0 + rng.standard_normal((20, 5, 7)))
    write_hawc2(box, tmp_path / "u.bin", 10.0, HUB, 0.2)
    spacing = 2.0, 22.5, 15.0
    found = read_hawc2(tmp_path / "u.bin", (20, 5, 7), spacing, 10.0, HUB, 0.2)
    np.testing.assert_allclose(found.speed, box.speed, atol=2e-6)
    np.testing.assert_allclose(found.y, box.y)
    np.testing.assert_allclose(found.z, box.z)
    assert found.step == pytest.approx(0.2)
    with pytest.raises(InputError, match="are not 20 x 7 x 7 numbers"):
        read_hawc2(tmp_path / "u.bin", (20, 7, 7), spacing, 10.0, HUB)


def test_indices_of_both_formats_are_where_their_programs_put_them(tmp_path: Path) -> None:
    """One gust high up on the left, looking downwind, in the second plane of three."""
    speed = uniform(3, 10.0, 4)
    speed[1, -1, -1] = 14.0
    box = box_of(speed)
    assert box.at([0.2], [45.0], [HUB + 45.0]) == pytest.approx(14.0)
    write_bts(box, tmp_path / "a.bts", HUB)
    raw = np.frombuffer((tmp_path / "a.bts").read_bytes()[-2 * 3 * 48 :], "<i2")
    # time, then z, then y, then component
    assert np.argmax(raw.reshape(3, 4, 4, 3)[..., 0]) == np.ravel_multi_index((1, 3, 3), (3, 4, 4))
    write_hawc2(box, tmp_path / "u.bin", 10.0, HUB, 0.0)
    raw = np.fromfile(tmp_path / "u.bin", "<f4")
    # plane, then y from the left, then z
    assert np.argmax(raw) == np.ravel_multi_index((1, 0, 3), (3, 4, 4))


def test_even_and_sheared_wind_load_the_rotor_as_the_surrogate_without_turbulence() -> None:
    rotor = Rotor()
    for shear in (0.0, 0.2):
        z = np.linspace(HUB - 45.0, HUB + 45.0, 61)
        profile = power_law(12.0, z, HUB, shear)
        box = box_of(np.broadcast_to(profile, (121, 61, 61)), step=0.1)
        made = hub_loads(Condition(12.0, "none", shear, 1), 12.0, 10.0, rotor)
        azimuth = float(Condition(12.0, "none", shear, 1).generator().uniform(0.0, 2.0 * np.pi))
        found = box_hub_loads(box, rotor, azimuth)
        size = np.abs(made.loads).max(axis=0)
        np.testing.assert_allclose(
            found.loads[:120] / size, made.loads / size, atol=1e-5 + 2e-4 * (shear > 0.0)
        )


def test_a_wind_that_is_stronger_on_the_left_yaws_the_rotor() -> None:
    """Thrust on the left, along +y, makes a moment about -z."""
    y = np.linspace(-45.0, 45.0, 13)
    speed = uniform(60, 10.0) + 0.02 * y[None, :, None]
    found = box_hub_loads(box_of(speed)).loads
    even = box_hub_loads(box_of(uniform(60, 10.0))).loads
    change = (found - even).mean(axis=0)
    assert change[5] < -50e3
    assert abs(change[4]) < 0.1 * abs(change[5])


def test_harmonics_of_a_ring_have_the_wind_of_its_nodes(rng: np.random.Generator) -> None:
    rotor, box = Rotor(), box_of(10.0 + rng.standard_normal((30, 13, 13)))
    time = box.time[:-1] + 0.05
    harmonics = box.ring_harmonics(rotor, time, 4)
    for node in range(9):
        azimuth = np.full(len(time), 2.0 * np.pi * node / 9)
        found = at_azimuth(harmonics, azimuth)
        np.testing.assert_allclose(found, box.on_blades(rotor, time, azimuth)[0], atol=1e-4)


def test_a_rotor_that_reaches_out_of_the_field_is_refused() -> None:
    with pytest.raises(InputError, match=r"reaches from y = -20 to 20 m .* larger field"):
        box_hub_loads(box_of(uniform(10, 10.0), reach=20.0))
    with pytest.raises(InputError, match="evenly spaced"):
        WindBox("odd", 0.1, np.array([0.0, 1.0, 3.0]), np.arange(2.0), uniform(3, 1.0)[:, :3, :2])


def test_samples_may_be_denser_than_planes(rng: np.random.Generator) -> None:
    box = box_of(10.0 + rng.standard_normal((30, 13, 13)))
    coarse, fine = box_hub_loads(box), box_hub_loads(box, rate=20.0)
    assert fine.step == pytest.approx(0.05)
    np.testing.assert_allclose(fine.loads[::4], coarse.loads, rtol=1e-9)
