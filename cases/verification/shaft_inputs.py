"""Tables of inputs, shared by the cases of shafts."""

from fe_drivetrain.scene import Material
from fe_drivetrain.suite import Page


def show_inputs(page: Page, *rows: tuple[str, float | str, str, str]) -> None:
    """Add the table of a case's inputs: name, value, unit, source."""
    page.table("Inputs", rows, ["input", "value", "unit", "source"])


def steel_rows(material: Material) -> list[tuple[str, float | str, str, str]]:
    """E, nu and what follows, for `show_inputs`."""
    return [
        ("E", material.youngs_modulus / 1e9, "GPa", "steel, assumed"),
        ("nu", material.poisson_ratio, "-", "steel, assumed"),
        ("G = E / (2 (1 + nu))", material.shear_modulus / 1e9, "GPa", "of these"),
    ]
