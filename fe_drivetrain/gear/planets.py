"""Phases of a planetary stage's meshes, and positions where planets fit, as its teeth fix them.

Phases are delays in periods of the mesh, between 0 and 1, against the first planet: the stiffness
of planet n's mesh at the time t is that of the first planet's at t - phase (Parker and Lin 2004).
Seen from the carrier the sun turns positively and the ring negatively, as where the ring is held;
angles of planets are counted in that sense.
"""

from __future__ import annotations

from math import pi, sin, tan

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.functions import involute_of
from fe_drivetrain.gear.involute import Pair


def equally_spaced(sun: int, ring: int, planets: int) -> bool:
    """Whether equally spaced planets can be assembled.

    Parameters
    ----------
    sun : int
        Teeth of the sun.
    ring : int
        Teeth of the ring, counted positive.
    planets : int
        Number of planets.

    Returns
    -------
    bool
        (sun + ring) / planets is whole.
    """
    _check_teeth(sun, ring, planets)
    return (sun + ring) % planets == 0


def check_assembly(name: str, sun_teeth: int, ring_teeth: int, planets: int) -> None:
    """Refuse a stage whose planets cannot be put in at equal angles.

    Raises
    ------
    InputError
        (z_s + z_r) / N is no integer.
    """
    if not equally_spaced(sun_teeth, ring_teeth, planets):
        total = sun_teeth + ring_teeth
        raise InputError(
            f"{name}: {planets} planets cannot be put in at equal angles, since the teeth of sun "
            f"and ring, {sun_teeth} + {ring_teeth} = {total}, must be a multiple of {planets} "
            f"(remainder {total % planets}): change the teeth"
        )


def assembly_positions(sun: int, ring: int, planets: int) -> Floats:
    """Angles nearest to equal spacing at which planets can be assembled.

    Parameters
    ----------
    sun : int
        Teeth of the sun.
    ring : int
        Teeth of the ring, counted positive.
    planets : int
        Number of planets.

    Returns
    -------
    (planets,) array
        Angles [rad], whole multiples of 2 pi / (sun + ring) from the first, at 0.
    """
    _check_teeth(sun, ring, planets)
    least = 2.0 * pi / (sun + ring)
    equal = 2.0 * pi * np.arange(planets) / planets
    return np.asarray(np.round(equal / least) * least, dtype=np.float64)


def sun_phases(sun: int, ring: int, places: Floats) -> Floats:
    """Phases of the sun's meshes: how far planet n's is behind the first one's.

    Parameters
    ----------
    sun : int
        Teeth of the sun.
    ring : int
        Teeth of the ring, counted positive.
    places : (n,) array
        Angles of the planets [rad].

    Returns
    -------
    (n,) array
        z_s psi / 2 pi, in periods: a tooth of the sun reaches a planet further on later.
    """
    _check_places(sun, ring, places)
    return _whole_apart(sun * np.asarray(places, dtype=np.float64) / (2.0 * pi))


def ring_phases(sun: int, ring: int, places: Floats) -> Floats:
    """Phases of the ring's meshes, as `sun_phases`; the ring turns the other way.

    Parameters
    ----------
    sun : int
        Teeth of the sun.
    ring : int
        Teeth of the ring, counted positive.
    places : (n,) array
        Angles of the planets [rad].

    Returns
    -------
    (n,) array
        -z_r psi / 2 pi, in periods: equal to those of the sun, since the sum of teeth times the
        angle is whole where planets fit.
    """
    _check_places(sun, ring, places)
    return _whole_apart(-ring * np.asarray(places, dtype=np.float64) / (2.0 * pi))


def ring_after_sun(sun: Pair, ring: Pair) -> float:
    """Phase of a planet's mesh with the ring against its mesh with the sun.

    Both flanks of the planet's teeth are loaded, one by the sun, the other by the ring, so that it
    follows from the thickness of its teeth. Each mesh has phase 0 where a pair comes into contact
    at the start of the path of contact that `Pair.path` has.

    Parameters
    ----------
    sun : Pair
        Sun and planet.
    ring : Pair
        The planet and the ring.

    Returns
    -------
    float
        Delay of the ring's mesh, in periods, between 0 and 1 (gamma_rs of Parker and Lin 2004,
        there as a lead).

    Raises
    ------
    InputError
        If the planet of one is not the planet of the other.
    """
    planet = ring.first
    if sun.second != planet:
        raise InputError(
            f"the sun meshes with a planet of {sun.second.teeth} teeth, the ring with one of "
            f"{planet.teeth}: they must be one gear"
        )
    pitch, turn = planet.base_pitch, planet.teeth / (2.0 * pi)
    shifts = 2.0 * planet.shift * tan(planet.pressure_angle)
    half = (0.5 * pi + shifts) / planet.teeth + float(involute_of(planet.transverse_angle))
    # places of contact on the planet, from T on its base circle, of a tooth whose middle has turned
    # to the angle 0 against the line of centres, sun below and ring above
    at_sun = turn * (sun.working_angle + half - 0.5 * pi) * pitch
    at_ring = turn * (ring.working_angle + half - 0.5 * pi) * pitch
    from_sun = sun.centre_distance * sin(sun.working_angle) - at_sun
    difference = (from_sun - sun.path.start) - (at_ring - ring.path.start)
    return float(difference / pitch % 1.0)


def sequence(sun: int, ring: int, planets: int) -> str:
    """Kind of phasing of equally spaced planets.

    Parameters
    ----------
    sun : int
        Teeth of the sun.
    ring : int
        Teeth of the ring, counted positive.
    planets : int
        Number of planets.

    Returns
    -------
    str
        "in phase", "sequential" (phases 1/planets apart), "counter-phased" (opposite pairs), or
        "mixed".

    Raises
    ------
    InputError
        If equally spaced planets cannot be assembled.
    """
    if not equally_spaced(sun, ring, planets):
        raise InputError(
            f"{planets} equally spaced planets cannot be assembled between a sun of {sun} and a "
            f"ring of {ring} teeth: their sum, {sun + ring}, must be a multiple of {planets}"
        )
    step = sun % planets
    if step == 0:
        return "in phase"
    if 2 * step == planets:
        return "counter-phased"
    return "sequential" if np.gcd(step, planets) == 1 else "mixed"


def _whole_apart(phases: Floats) -> Floats:
    """Between 0 and 1; what is 1 to round-off is 0."""
    rest = phases - phases[0]
    rest = rest - np.floor(rest + 1e-9)
    return np.asarray(np.maximum(rest, 0.0), dtype=np.float64)


def _check_places(sun: int, ring: int, places: Floats) -> None:
    _check_teeth(sun, ring, len(places))
    turns = (np.asarray(places) - places[0]) * (sun + ring) / (2.0 * pi)
    wrong = np.abs(turns - np.round(turns)) > 1e-6
    if wrong.any():
        n = int(np.argmax(wrong))
        raise InputError(
            f"planet {n + 1} at {np.degrees(places[n]):.6g} degrees cannot be assembled between a "
            f"sun of {sun} and a ring of {ring} teeth: planets stand at multiples of "
            f"{360.0 / (sun + ring):.6g} degrees from the first"
        )


def _check_teeth(sun: int, ring: int, planets: int) -> None:
    if not 0 < sun < ring:
        raise InputError(
            f"a sun of {sun} teeth in a ring of {ring}: give both positive, more for the ring"
        )
    if planets < 1:
        raise InputError(f"{planets} planets: give at least one")
