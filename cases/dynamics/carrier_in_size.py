"""The library's planet carrier, of a 5 MW gearbox, in the size of another pin circle."""

from fe_drivetrain.drivetrain_file import CarrierComponent, library_component

SCALED = (
    "cheek_thickness",
    "cheek_diameter",
    "sun_bore_diameter",
    "web_inner_diameter",
    "web_outer_diameter",
    "hub_diameter",
    "hub_bore_diameter",
    "hub_length",
    "pin_diameter",
    "gap",
)


def carrier_in_size(radius: float, planets: int = 3, **changes: float) -> CarrierComponent:
    """A carrier with its dimensions in the ratio of pin circles.

    Parameters
    ----------
    radius : float
        Radius of the pins' centres [m].
    planets : int
        Number of pins; webs between more of them are narrower.
    **changes : float
        Dimensions in place of the scaled ones [m, deg].
    """
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    large = component.planet_carrier
    size = 2 * radius / large.pin_circle_diameter
    sizes = {name: size * getattr(large, name) for name in SCALED}
    sizes |= {"pin_circle_diameter": 2 * radius, "web_angle": large.web_angle * 3 / planets}
    own = type(large).model_validate({"planets": planets, **sizes, **changes})
    mesh = component.mesh.scaled(size)
    return component.model_copy(update={"planet_carrier": own, "mesh": mesh})
