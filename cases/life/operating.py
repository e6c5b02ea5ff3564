"""What the studies of a main bearing's life state on their pages."""

from fe_drivetrain.report.suite import Page


def state_assumptions(page: Page, moving: bool = False) -> None:
    """What neither the thesis nor the catalogue gives, of a turbine that moves, or pitch held."""
    page.assume(
        "bearing S", "D 65, L 95, D_pw 787.4 mm, 2 x 36 rollers", "", "bearing/ratings: fits C, C0"
    )
    if moving:
        page.assume(
            "hub loads",
            "of a turbine that moves",
            "",
            "generic 2 MW rotor with a controller of ours, in place of the thesis's 1.5 MW turbine",
        )
        page.assume("rotor speed", "of each step", "", "the turbine's")
        return
    page.assume(
        "hub loads",
        "surrogate",
        "",
        "generic 2 MW rotor, pitch held within a history, in place of the thesis's 1.5 MW turbine",
    )
    page.assume("rotor speed", "of the mean wind", "", "the surrogate's, constant in a history")


def state_meaning(page: Page) -> None:
    """What the years are, at the end of a page."""
    page.section("What these lives are")
    page.text(
        "Constants of ISO 281 and ISO/TS 16281 are as public code and Stirling 2023 print them; "
        "none was read in the standards. Years are for ranking: bearing, turbine and its "
        "controller are stand-ins for private ones. Life holds no wear, no micropitting and no "
        "sliding, and time outside 3 to 25 m/s does no damage."
    )
