"""A drivetrain on a base whose acceleration a file has: by hand, by momentum, and what is read."""

from pathlib import Path

import numpy as np
import pytest
from hub_load_tables import TIME, openfast_text
from numpy.testing import assert_allclose
from scipy.integrate import trapezoid
from scipy.interpolate import CubicSpline

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import DampingRatios, read_drivetrain
from fe_drivetrain.dynamics import Level, assembly, integrate, library_machine, on_base, varying
from fe_drivetrain.dynamics.bodies.equations import equations_of_motion, spring_laws
from fe_drivetrain.dynamics.time.base_motion import base_acceleration, base_motion
from fe_drivetrain.dynamics.time.running import Running, running
from fe_drivetrain.procedure.drivetrain_operation import shaken
from fe_drivetrain.procedure.steady_running import steady_run, wound_up
from fe_drivetrain.studies import transient
from fe_drivetrain.turbine_loads.hub_loads.base_history import (
    BaseReading,
    read_base_history,
)
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap

TIMES = np.arange(0.0, 0.4001, 0.01)
SINE = 0.3 * np.sin(2.0 * np.pi * 2.5 * TIMES)
KEPT = BaseReading(keep_mean=True)


@pytest.fixture(scope="module")
def park() -> Running:
    return running(library_machine("park_2021"), Level.RIGID, 15e3, 0.6, DampingRatios())


def table(path: Path, **columns: Floats) -> Path:
    """A table whose titles end with the unit after two underscores, over `TIMES`."""
    titles = [f"{name.split('__')[0]} [{name.split('__')[1]}]" for name in columns]
    rows = np.column_stack([TIMES, *columns.values()]).tolist()
    lines = [",".join(("time [s]", *titles)), *(",".join(map(repr, row)) for row in rows)]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_a_sinusoid_of_a_file_is_that_of_inertia_forces(park: Running, tmp_path: Path) -> None:
    file = table(tmp_path / "base.csv", ay__mg=SINE / 9.80665e-3)
    moving = shaken(park, read_base_history(file, reading=KEPT), 0.01)
    found = next(moving.pieces(1e-3))
    S = on_base(park.system, assembly(park.machine, Level.RIGID).bodies)[:, 1]
    made, acting = steady_run(park, 0.01)
    inertia = varying(-made.mass @ S, TIMES, SINE)
    start = wound_up(made, [*acting, inertia], park.turning.velocity)
    own = integrate(made, [*acting, inertia], 0.4, 1e-3, start=start)
    assert_allclose(found.forces, own.forces, atol=1e-9 * np.abs(own.forces).max())
    still = integrate(made, acting, 0.4, 1e-3, start=start)
    assert np.abs(found.forces - still.forces).max() > 100.0


def test_supports_give_the_momentum_that_the_base_does(park: Running, tmp_path: Path) -> None:
    """Along y: what all bodies gain against space is what springs to the base pulled."""
    file = tmp_path / "base.csv"
    rows = "".join(f"{t!r},{a!r}\n" for t, a in zip(TIMES.tolist(), SINE.tolist(), strict=True))
    file.write_text(f"time [s],ay [m/s2]\n{rows}", encoding="utf-8")
    found = next(shaken(park, read_base_history(file, reading=KEPT), 0.01).pieces(1e-3))
    S = on_base(park.system, assembly(park.machine, Level.RIGID).bodies)[:, 1]
    made, _ = steady_run(park, 0.01)
    pulls = -found.forces @ (made.springs.rows @ S)
    mass = float(S @ made.mass @ S)
    of_base = np.interp(found.times, TIMES, SINE)
    gained = found.velocity @ (made.mass @ S)
    steps = np.diff(found.times)
    base = np.concatenate([[0.0], np.cumsum(steps * 0.5 * (of_base[1:] + of_base[:-1]))])
    pulled = np.concatenate([[0.0], np.cumsum(steps * 0.5 * (pulls[1:] + pulls[:-1]))])
    moved = gained - gained[0] + mass * base
    assert np.abs(moved).max() > 100.0
    assert_allclose(moved, pulled, atol=1e-8 * np.abs(pulls).max())


def test_a_mass_on_a_spring_against_its_closed_form() -> None:
    """Relative motion of x'' + w^2 x = -A sin(W t) from rest."""
    w, W, A = 40.0, 12.0, 0.7
    times = np.linspace(0.0, 1.0, 2001)
    equations = equations_of_motion([1.0], spring_laws([[1.0]], w**2))
    base = base_acceleration([[1.0]], times, A * np.sin(W * times))
    found = integrate(equations, [base], 1.0, 5e-4)
    t = found.times
    exact = -A / (w**2 - W**2) * (np.sin(W * t) - W / w * np.sin(w * t))
    longer = 40.0 * (w * 5e-4) ** 2 / 12.0  # how far a longer period lags after 40 rad
    assert_allclose(found.q[:, 0], exact, atol=longer * np.abs(exact).max())


def test_a_spline_and_its_acceleration_are_one_motion() -> None:
    """Loads of inertia and of what spins, from displacements and from their second derivative."""
    made = equations_of_motion(np.eye(2), spring_laws(np.eye(2), 1.0), [[0.0, 3.0], [-3.0, 0.0]])
    by_path = base_motion(np.eye(2), TIMES, np.column_stack([SINE, SINE**2]))
    by_rate = base_acceleration(np.eye(2), TIMES, by_path.accelerations, by_path.velocity)
    path = CubicSpline(TIMES, np.column_stack([SINE, SINE**2]))
    load, at = by_rate.loads_on(made), np.linspace(0.0, 0.4, 333)
    turned = made.damping @ path(at, 1).T
    exact = (-made.mass @ path(at, 2).T - turned).T
    found = np.array([load.at(t) for t in at])
    assert_allclose(found, exact, atol=2e-3 * np.abs(turned).max())


def test_units_signs_tilt_place_and_means(tmp_path: Path) -> None:
    file = tmp_path / "measured.csv"
    rows = [f"{t},{9.80665 + a},{a},{np.degrees(a)}" for t, a in zip(TIMES, SINE, strict=True)]
    file.write_text("\n".join(["time [s],up [m/s^2],fore,pitch [deg/s^2]", *rows]), "utf-8")
    channels = {"ax": "-fore", "az": "up", "ary": "pitch"}
    mapping = ChannelMap(channels=channels, units={"fore": "m/s^2"}, tilt=5.0)
    place = BaseReading((2.0, 0.0, 1.0))
    found = read_base_history(file, mapping, 0.0, place)
    cos, sin = np.cos(np.radians(5.0)), np.sin(np.radians(5.0))
    up, fore = SINE + 9.80665, -SINE
    # of the rotor's centre: less alpha x r = (ary z, 0, -ary x)
    along = cos * fore - sin * up - SINE * 1.0
    across = sin * fore + cos * up + SINE * 2.0
    for k, values in ((0, along), (2, across), (4, SINE)):
        mean = trapezoid(values, TIMES) / TIMES[-1]
        assert_allclose(found.accelerations[:, k], values - mean, atol=1e-9)
        assert_allclose(found.mean[k], mean, atol=1e-9)
    assert not found.accelerations[:, [1, 3, 5]].any()
    assert found.facts.turns
    assert found.read.startswith("-fore [m/s^2], up [m/s^2], pitch [deg/s^2], turned")


def test_of_openfast_the_sensor_goes_before_the_tower_and_its_displacement(tmp_path: Path) -> None:
    swing = np.sin(5.0 * TIME)
    sensor = {"NcIMUTAxs": ("m/s^2", swing), "NcIMURAys": ("deg/s^2", 2.0 * swing)}
    tower = {"YawBrTAxp": ("m/s^2", 3.0 * swing), "YawBrTDxp": ("m", swing)}
    file = openfast_text(tmp_path / "a.out", columns=tower | sensor)
    found = read_base_history(file, reading=KEPT).accelerations
    assert_allclose(found[:, 0], swing, atol=1e-8)
    assert_allclose(found[:, 4], np.radians(2.0 * swing), atol=1e-8)
    gone = openfast_text(tmp_path / "b.out", {n: "INVALID" for n in sensor}, columns=tower | sensor)
    assert_allclose(read_base_history(gone, reading=KEPT).accelerations[:, 0], 3 * swing, atol=1e-8)
    last = openfast_text(tmp_path / "c.out", columns={"YawBrTDxp": ("m", swing)})
    read = read_base_history(last, reading=KEPT)
    spline = CubicSpline(read.time, swing)(read.time, 2)
    assert_allclose(read.accelerations[:, 0], spline, atol=1e-4 * np.abs(spline).max())
    assert read.read == "YawBrTDxp [m], differentiated twice"


@pytest.mark.parametrize(
    ("header", "mapping", "said"),
    [
        ("time [s],Fx [N]", ChannelMap(), "none of NcIMUTAxs, YawBrTAxp, YawBrTDxp of OpenFAST"),
        ("time [s],ax [m/s]", ChannelMap(), "channel ax has the unit 'm/s', not one of m/s"),
        ("when [s],ax [g]", ChannelMap(), r"it has no column time \[s\]"),
        ("time [s],ax [g]", ChannelMap(channels={"ay": "lateral"}), "no channel 'lateral'"),
        ("time [s],NcIMUTAxs [g]", ChannelMap(tilt=5.0), "along the shaft already"),
        ("time [s],other [g],ax [g]", ChannelMap(), "never changes, so that nothing moves"),
    ],
)
def test_what_cannot_be_read_is_refused(
    tmp_path: Path, header: str, mapping: ChannelMap, said: str
) -> None:
    file = tmp_path / "base.csv"
    rows = [f"{t},{a}" + ",0" * (header.count(",") - 1) for t, a in zip(TIMES, SINE, strict=True)]
    file.write_text("\n".join([header, *rows]), encoding="utf-8")
    with pytest.raises(InputError, match=said):
        read_base_history(file, mapping)


def test_an_acceleration_that_no_nacelle_has_is_refused(tmp_path: Path) -> None:
    """A column in mm/s^2 whose head says g."""
    with pytest.raises(InputError, match=r"is 2941\.\d+ m/s\^2 or rad/s\^2 .* at most 1000"):
        read_base_history(table(tmp_path / "base.csv", ax__g=1e3 * SINE))


def test_the_study_on_a_base_that_moves(tmp_path: Path) -> None:
    """Twice the acceleration changes forces twice as much; values that do not apply are refused."""
    rated = {"operation.rated_power": 1e4, "operation.rotor_speed": [0.3, 0.6]}
    drivetrain, found = read_drivetrain("park_2021", rated), []
    for k in (1, 2):
        table(tmp_path / f"{k}.csv", ay__g=0.1 * k * SINE)
        found.append(
            transient(drivetrain, "base", loads=tmp_path / f"{k}.csv", level="rigid", step=2e-3)
        )
    force = "force of gear 1 bearing"
    one, two = (each.extremes[force] for each in found)
    name = found[0].tables["base_motion"][0]
    assert name["read"] == "ay [g]"
    assert one.most - one.rated > 25.0
    assert_allclose(two.most - two.rated, 2.0 * (one.most - one.rated), rtol=0.02)
    assert found[0].passed
    with pytest.raises(InputError, match="motion of a base needs histories: give `loads`"):
        transient(drivetrain, "base")
    with pytest.raises(InputError, match="both say how the base moves"):
        transient(drivetrain, "base", {"file": "x.csv"}, loads=tmp_path / "1.csv")
    with pytest.raises(InputError, match="planets do not travel under histories"):
        transient(drivetrain, "base", loads=tmp_path / "1.csv", planets="travel")
    with pytest.raises(InputError, match="mean of the event"):
        transient(drivetrain, "base", {"mean": "gone"}, loads=tmp_path / "1.csv")
