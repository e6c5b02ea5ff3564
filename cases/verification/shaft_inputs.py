"""Tables of inputs, shared by the cases of shafts."""

from fe_drivetrain.scene import Material
from fe_drivetrain.suite import Page

#: Name, value, unit, and where it comes from: "chosen" where it is left out.
Input = tuple[str, float | str, str] | tuple[str, float | str, str, str]


def show_inputs(page: Page, *rows: Input, steel: Material | None = None) -> None:
    """Add the table of a case's inputs; with a steel, its elasticity below them."""
    table = [row if len(row) == 4 else (*row, "chosen") for row in rows]
    if steel is not None:
        table += [
            ("E", steel.youngs_modulus / 1e9, "GPa", "steel, assumed"),
            ("nu", steel.poisson_ratio, "-", "steel, assumed"),
            ("G = E / (2 (1 + nu))", steel.shear_modulus / 1e9, "GPa", "of these"),
        ]
    page.table("Inputs", table, ["input", "value", "unit", "source"])


def show_uniform(
    page: Page, outer: float, bore: float, length: Input, *more: Input, steel: Material
) -> None:
    """The inputs of a uniform shaft, solid and bored; diameters in m."""
    show_inputs(
        page,
        ("outer diameter", outer, "m", "Stirling 2023, Table 3.1, in size"),
        ("bore of the bored shaft", bore, "m"),
        length,
        *more,
        steel=steel,
    )
