"""The beam of Stirling 2023, chapter 4, and hub loads like the four of its wind files."""

from functools import lru_cache

import numpy as np

from fe_drivetrain.bearing import Bearing, catalogue_bearing
from fe_drivetrain.bearing_life.coupled import LinearBody, factors_of, in_housings, linear_body
from fe_drivetrain.common import Floats
from fe_drivetrain.shafts.beam import MainBearingBeam, condensed_beam, main_bearing_frame
from fe_drivetrain.turbine_loads.hub_loads import Condition, hub_load_set

#: Mean wind speeds of the thesis's wind files 1 to 4 [m/s].
WIND_SPEEDS = (12.0, 14.0, 18.0, 24.0)

#: K_R [N m/rad]: of the thesis's housing about y and z, and its best fit of the rollers.
HOUSING_TILT, HOUSING_YAW, BEST_FIT = 145e6, 392e6, 1272e6

#: Stiffness of the housing along the axes [N/m]: the closed forms have none.
HOUSING_RADIAL = 2.5e10

BEAM = MainBearingBeam(shaft_diameter=0.635, tilt_stiffness=145e6, yaw_stiffness=145e6)

BEARINGS = {
    "X, 38 deg": "bearing_s",
    "X, 20 deg": "bearing_s_x20",
    "O, 20 deg": "bearing_s_o20",
}

#: What the thesis does not give, as `Page.assume` takes it.
ASSUMED = (
    ("contact angle", 38.0, "deg", "not printed; fitted to K_R; other pages of it use 20 deg"),
    ("arrangement", "X, face to face", "", "Table 4.1 says 'double inner'; O beside it"),
    ("shaft diameter", 0.635, "m", "changed in chapter 4 without a value; bore of the bearing"),
    (
        "hub loads",
        "surrogate",
        "",
        "generic 2 MW rotor in place of the thesis's 1.5 MW turbine; the same mean wind speeds, "
        "medium turbulence, shear 0.2",
    ),
)


@lru_cache
def beam_body() -> LinearBody:
    """The beam on its gearbox springs, without shear, as the thesis has it."""
    stations = np.array([-BEAM.overhang, 0.0, BEAM.span])
    body = condensed_beam(
        main_bearing_frame(BEAM, shear=False), ["hub", "bearing", "gearbox"], stations
    )
    K1, K2 = BEAM.radial_stiffness, BEAM.axial_stiffness
    return linear_body(body, ["bearing"], {"gearbox": (K2, K1, K1, np.inf, 0.0, 0.0)})


def housed_body(tilt: float = HOUSING_TILT, yaw: float = HOUSING_YAW) -> LinearBody:
    """The same with a housing in series."""
    axes = [HOUSING_RADIAL] * 3
    return in_housings(beam_body(), {"bearing": np.diag([*axes, 1e10, tilt, yaw])})


def bearing_s(name: str = "bearing_s", laminae: int = 0) -> Bearing:
    """Bearing S with straight rollers; 0 laminae is their closed form."""
    return catalogue_bearing(name, laminae=laminae)


def histories(duration: float, rate: float, speeds: tuple[float, ...] = WIND_SPEEDS) -> Floats:
    """Factors (files, steps, 10) of the loads, a wind file for each speed."""
    conditions = [Condition(v, "medium", 0.2, 1) for v in speeds]
    loads = hub_load_set(conditions, duration, rate).loads
    flat = factors_of(loads.reshape(-1, 6), BEAM.gearbox_weight)
    return flat.reshape(len(speeds), -1, flat.shape[1])


def radial(vectors: Floats) -> Floats:
    """Size of the two components across the shaft."""
    return np.hypot(vectors[..., 0], vectors[..., 1])
