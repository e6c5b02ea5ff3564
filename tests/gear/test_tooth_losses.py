"""Losses of teeth: the loss factor as an integral, printed numbers of a public program, limits."""

from math import cos, pi, radians

import numpy as np
import pytest

from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.gear import Gear, Pair
from fe_drivetrain.gear.losses import (
    BOUNDARY,
    film_friction,
    mean_friction,
    shaft_seal_moment,
    tooth_loss_factor,
)
from fe_drivetrain.studies.gear_meshes import gear_meshes


def fzg(
    teeth: tuple[int, int], module: float, helix: float, shifts: tuple[float, float], **of: object
) -> Pair:
    """A pair of the FZG test rig, centre distance 91.5 mm, with its printed tip diameters."""
    tips, width = of["tips"], of["width"]
    made = [
        Gear(z, module, float(width), sign * radians(helix), x, tip_diameter=2.0 * tip)  # type: ignore[arg-type]
        for z, x, tip, sign in zip(teeth, shifts, tips, (1.0, -1.0), strict=True)  # type: ignore[call-overload]
    ]
    return Pair(made[0], made[1], 0.0915)


C14 = fzg((16, 24), 4.5e-3, 0.0, (0.1817, 0.1715), tips=(41.228e-3, 59.182e-3), width=14e-3)
H501 = fzg((20, 30), 3.5e-3, 15.0, (0.1809, 0.0891), tips=(40.336e-3, 58.132e-3), width=23e-3)
SPEED = 1500.0 * pi / 30.0


def test_numbers_that_gearpie_prints_of_fzg_gears() -> None:
    """Its reports C14 and H501: H_V of Ohlendorf, mu of Schlenk and of Fernandes, M320, 75 degC."""
    assert tooth_loss_factor(C14) == pytest.approx(0.1950, abs=5e-5)
    assert tooth_loss_factor(H501) == pytest.approx(0.1639, abs=5e-5)
    oil = (46.23e-3, 0.6e-6)
    assert float(mean_friction(C14, 200.0, SPEED, *oil, 0.85)) == pytest.approx(0.0483, abs=5e-5)
    by_film = film_friction(C14, 200.0, SPEED, *oil, 71.05e-9, 0.85)
    assert float(by_film) == pytest.approx(0.0354, abs=5e-5)


def all_pairs() -> list[Pair]:
    """Spur and helical, external and internal pairs."""
    found = [C14, H501]
    for name in ("grc_750kw", "nrel_5mw"):
        found += [mesh.pair for mesh in gear_meshes(library_machine(name), {})[0].values()]
    return found


@pytest.mark.parametrize("pair", all_pairs())
@pytest.mark.parametrize("even", [False, True])
def test_the_loss_factor_is_the_sliding_under_its_share_of_the_load(pair: Pair, even: bool) -> None:
    path, pitch = pair.path, pair.first.base_pitch
    places = np.linspace(path.start, path.end, 400_001)
    alone = (places >= path.single_start) & (places <= path.single_end)
    share = np.full_like(places, 1.0 / pair.transverse_ratio) if even else np.where(alone, 1.0, 0.5)
    sliding = np.abs(places - path.pitch) * abs(1.0 + pair.first.teeth / pair.second.teeth)
    lost = np.trapezoid(share * sliding, places)
    whole = lost / (pitch * pair.first.base_radius * cos(pair.first.base_helix))
    assert tooth_loss_factor(pair, even) == pytest.approx(whole, rel=1e-5)


def test_spur_teeth_have_ohlendorfs_closed_form() -> None:
    pitch = C14.first.base_pitch
    first = (C14.path.end - C14.path.pitch) / pitch
    second = (C14.path.pitch - C14.path.start) / pitch
    closed = 1.0 - first - second + first**2 + second**2
    assert tooth_loss_factor(C14) == pytest.approx(pi * (1 / 16 + 1 / 24) * closed, rel=1e-12)


@pytest.mark.parametrize("law", [mean_friction, film_friction])
def test_friction_falls_with_speed_and_ends_at_boundary_lubrication(law: object) -> None:
    more = (1.8e-8,) if law is film_friction else ()
    speeds = np.array([0.0, 1e-12, 1e-6, 0.1, 1.0, 10.0, 100.0, 1e6])
    found = law(C14, 200.0, speeds, 0.05, 0.8e-6, *more)  # type: ignore[operator]
    assert found[0] == BOUNDARY
    assert (np.diff(found) <= 0.0).all()
    assert found[-1] > 0.0
    assert law(C14, 0.0, speeds, 0.05, 0.8e-6, *more)[-2] > 0.0  # type: ignore[operator]


def test_a_seal_takes_the_same_moment_at_any_speed() -> None:
    # 7.69e-6 d^2 n of a shaft of 100 mm at 1000/min
    assert shaft_seal_moment(0.1) * 1000.0 * pi / 30.0 == pytest.approx(76.9)
