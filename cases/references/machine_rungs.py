"""Rungs beyond the shafts of a machine of the library: flexible carrier, solid shaft, housing."""

import numpy as np

from fe_drivetrain.cases.references.machine_shafts import shaft_scene
from fe_drivetrain.drivetrain_file import CarrierComponent, HousingComponent, library_component
from fe_drivetrain.dynamics import Flexible, Housing, Level, Rung, library_machine
from fe_drivetrain.report.suite import Run
from fe_drivetrain.shafts.fidelity import COARSER, coarser, meridian_shaft, solid_component
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame, housing_frame
from fe_drivetrain.shafts.fidelity.component_levels import stiffness_on_supports


def more_rungs(run: Run, name: str) -> list[Rung]:
    """Flexible carrier and a solid shaft of the 5 MW gearbox; housing and carrier of C."""
    found = []
    if name == "nrel_5mw":
        component = library_component("planet_carrier")
        assert isinstance(component, CarrierComponent)
        with run.step("carrier of beams"):
            beams = Flexible({1: carrier_frame(component)})
        found.append(Rung(Level.FLEXIBLE, beams, "flexible shafts, carrier of beams"))
        with run.step("solid low-speed shaft"):
            scene = shaft_scene(library_machine(name), "LSS")
            shaft = meridian_shaft(scene, 1.4, 4, rings=False, layers=1)
        given = Flexible(beams.carriers, shafts={"LSS": shaft})
        found.append(Rung(Level.FLEXIBLE, given, "carrier of beams, solid low-speed shaft"))
        if not run.quick:
            with run.step("carrier of finite elements"):
                solid = solid_component(coarser(component, COARSER[0]))
            elements = Flexible({1: solid.body}, shafts={"LSS": shaft})
            found.append(Rung(Level.FLEXIBLE, elements, "carrier of FE, solid low-speed shaft"))
    if name == "synthetic_2mw":
        housing = library_component("gearbox_housing")
        assert isinstance(housing, HousingComponent)
        body = housing_frame(housing, True)
        spring = stiffness_on_supports(body, housing.supports, ["ring"])
        x = library_machine(name).axes[1][0]
        mass = float(np.abs(body.gravity[::6, 0]).sum())
        own = Housing((x, 0.0, 0.0), spring, mass, mass * 0.86**2, mass * 0.86**2 / 2)
        arms = Flexible(housing=own)
        found.append(Rung(Level.FLEXIBLE, arms, "flexible shafts, housing on torque arms"))
        carrier = carrier_of(library_machine(name).stages[0].centre_distance)
        with run.step("carrier of C"):
            if run.quick:
                of, cast = "beams", carrier_frame(carrier)
            else:
                of, cast = "FE", solid_component(coarser(carrier, COARSER[0])).body
        both = Flexible({1: cast}, housing=own)
        found.append(Rung(Level.FLEXIBLE, both, f"carrier of {of}, housing on torque arms"))
    return found


def carrier_of(centre_distance: float) -> CarrierComponent:
    """The library's carrier with all lengths in proportion to the circle of its pins."""
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    body = component.planet_carrier
    factor = 2.0 * centre_distance / body.pin_circle_diameter
    lengths = {
        name: factor * value
        for name, value in body.model_dump().items()
        if isinstance(value, float) and name != "web_angle"
    }
    mesh = component.mesh
    sizes = mesh.model_copy(update={"size": factor * mesh.size, "edge": factor * mesh.edge})
    smaller = body.model_copy(update=lengths)
    return component.model_copy(update={"planet_carrier": smaller, "mesh": sizes})
