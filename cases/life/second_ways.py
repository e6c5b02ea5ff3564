"""Lives of each model of a main bearing by other functions, at some load steps."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.bearing import (
    Races,
    equilibrium,
    equilibrium_on_races,
    rigid_races,
    roller_motions,
    three_degrees,
)
from fe_drivetrain.bearing_life.coupled import body_on_races, on_springs
from fe_drivetrain.bearing_life.life import miner_load
from fe_drivetrain.bearing_life.rings import assembly_equilibrium
from fe_drivetrain.cases.life import models
from fe_drivetrain.cases.references.studied_lives import on_rigid_rings
from fe_drivetrain.cases.references.thesis_beam import BEAM, beam_body
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.report.suite import Page
from fe_drivetrain.shafts.beam import pinned_model


def second_ways(page: Page, world: models.World, hub: Floats, ground: str) -> None:
    """Lives of each model by other functions, at some load steps."""
    setup = world.setup
    for model, (one, other, words) in in_two_ways(world, hub).items():
        first, second = (models.lives(setup, len(hub), each) for each in (one, other))
        page.vanishes(
            f"{ground}: {model}, life by a second way, relative difference, the worst step",
            float(np.abs(second / first - 1.0).max()),
            within=1e-4,
            why="residuals of 1e-8 of the load, and 1e-6 of a contact's softness that rigid races "
            "are given; both count fourfold in life",
            source=words,
        )
    P = setup.rated.equivalent_load(pinned_model(hub, BEAM)[:, models.FIVE])
    life = (setup.capacity / miner_load(P, np.ones(len(P)))) ** (10.0 / 3.0)
    mean = 1.0 / np.mean(1.0 / models.catalogue_lives(setup, hub))
    page.vanishes(
        f"{ground}: {models.CATALOGUE}, life by Miner's load, relative difference",
        float(abs(life / mean - 1.0)),
        **round_off(1e3, "sums of powers of 10/3 over all load steps, and their root"),
        source="Miner's rule in loads and in lives",
        basis="self-consistency",
    )


def in_two_ways(
    world: models.World, hub: Floats
) -> dict[str, tuple[models.Laminae, models.Laminae, str]]:
    """Loads on laminae by model: as the model has them, by other functions, and by which."""
    others = by_beams(world, hub) | by_races(world, hub)
    setup, bearing = world.setup, world.setup.bearing
    held = models.fitted(world, hub)
    three = three_degrees(bearing, models.spring_loads(held, hub)[:, models.FIVE])
    again = equilibrium(bearing, three.loads - three.unbalanced)
    every = 2 * sum(bearing.counts)
    whole = assembly_equilibrium(
        body_on_races(world.body(world.ground), world.races), models.factors(hub), shapes=every
    )
    A = np.vstack(roller_motions(bearing))
    flexible = Races(bearing, world.races.compliance + A @ world.ground @ A.T)
    others[models.THREE] = (
        on_rigid_rings(bearing, again.displacements),
        "five degrees under the loads that three of them balance",
    )
    others[models.FLEXIBLE] = (
        of_races(flexible, whole.bearing_loads(setup.body.bearings[0])),
        "races by themselves under the loads that the beam puts on them",
    )
    same = {
        models.SERIES: models.of_loads(bearing, models.spring_loads(held, hub)),
        models.THREE: on_rigid_rings(bearing, three.displacements),
        models.FLEXIBLE: models.of_contacts(bearing, whole.deflections),
    }
    return {
        model: (
            same[model] if model in same else models.MODELS[model](world, hub),
            *others[model],
        )
        for model in models.MODELS
        if model in others
    }


def by_beams(world: models.World, hub: Floats) -> dict[str, tuple[models.Laminae, str]]:
    """Models of springs, by finite-element beams on them."""
    bearing, f = world.setup.bearing, models.factors(hub)
    free = np.array([np.inf, np.inf, np.inf, 0.0, 0.0])
    held = np.array([np.inf, np.inf, np.inf, *models.fitted(world, hub)])
    of_housing = np.array([np.inf, np.inf, np.inf, *(1.0 / np.diag(world.housing)[3:])])
    ways = {
        models.PINNED: (world.setup.body, free, "finite-element beam on a hinge"),
        models.SPRING: (beam_body(), of_housing, "finite-element beam on springs"),
        models.SERIES: (beam_body(), held, "finite-element beam on springs"),
    }
    return {
        model: (models.of_loads(bearing, _six(on_springs(body, f, springs).forces[:, 0])), words)
        for model, (body, springs, words) in ways.items()
    }


def by_races(world: models.World, hub: Floats) -> dict[str, tuple[models.Laminae, str]]:
    """Models of rigid rings, by a beam on races that do not give way or move as one."""
    body, bearing = world.setup.body, world.setup.bearing
    straight = bearing.with_rows(crown=0.0)
    A = np.vstack(roller_motions(bearing))
    held_ring = Races(bearing, A @ world.housing @ A.T)
    as_one = "beam on races that move as a rigid body"
    ways = {
        models.RIGID: (
            bearing,
            rigid_races(bearing),
            "beam on races that do not give way",
        ),
        models.STRAIGHT: (straight, replace(held_ring, bearing=straight), as_one),
        models.FIVE_DEGREES: (bearing, held_ring, as_one),
    }
    return {
        model: (models.on_contacts(own, body_on_races(body, races), hub), words)
        for model, (own, races, words) in ways.items()
    }


def of_races(races: Races, loads: Floats) -> models.Laminae:
    """Rollers on races that give way, under loads (n, 5) on the inner ring."""
    found = equilibrium_on_races(races, loads, shapes=len(races.compliance))
    A = np.vstack(roller_motions(races.bearing))
    return models.of_contacts(races.bearing, found.displacements @ A.T - found.recession)


def _six(forces: Floats) -> Floats:
    """Loads (n, 6) with no torque."""
    return np.insert(forces, 3, 0.0, axis=1)
