"""What is typed of each command, for the end of its help."""

from __future__ import annotations

from collections.abc import Mapping

EXAMPLES: Mapping[str, tuple[str, ...]] = {
    "new": (
        "mine.yaml",
        "mine.yaml --arrangement two-bearings",
        "mine.yaml --from gearbox.rexs",
        "bearings.yaml --bearing",
        "--list",
    ),
    "check": ("two_bearings", "mine.yaml --open"),
    "study": (
        "two_bearings --quick",
        "mine.yaml --loads 'outputs/*.outb' --open",
        "mine.yaml --loads outputs --json > study.json",
    ),
    "advise": (
        "main_bearing_bonded --quantity main_bearing.My --tolerance 2%",
        "mine.yaml --load hub.My=1e6",
        "mine.yaml --quantity modes.torsional.1 --tolerance 5%",
    ),
    "modes": (
        "nrel_5mw --speeds 6.9:12.1 --open",
        "mine.yaml --level torsional --generator held --json",
        "mine.yaml --whirl --open",
    ),
    "loads": (
        "'outputs/*.outb' --site class-II --open",
        "mine.csv --against 'others/*.csv'",
        "torque.csv --channel 'Mx=Main shaft torque' --rotor-speed 12",
    ),
    "life": (
        "two_bearings --loads 'outputs/*.outb' --site class-II",
        "mine.yaml --loads outputs --bearing front=bearing_s",
        "mine.yaml --loads outputs --only front --series roller=21",
        "grc_750kw --loads outputs --gearbox-temperature 65",
    ),
    "gears": (
        "nrel_5mw --open",
        "mine.yaml --torque 4e6 --load hub.My=1e6 --hours 50000",
        "mine.yaml --loads 'outputs/*.outb' --site class-II",
        "grc_750kw --losses",
    ),
    "strength": (
        "mine.yaml --loads 'outputs/*.outb' --site class-II",
        "mine.yaml --load hub.My=1e6 --load hub.Mx=2e6 --rotor-speed 12 --rigid",
        "mine.yaml --loads outputs --set shaft.sections.0.fillet=0.03",
    ),
    "transient": (
        "mine.yaml stop --value braked=2.5 --open",
        "mine.yaml operation --loads 'outputs/*.outb' --level rigid",
        "mine.yaml dip --value depth=0.9 --value length=0.25 --json",
    ),
    "compare": (
        "mine.yaml stiffer.yaml",
        "two_bearings --vary shaft.front=-1.2:-0.8:5",
        "synthetic_2mw --vary generator.inertia=60:120:4 --quantity modes.torsional.1",
        "two_bearings --vary shaft.sections.0.inner_diameter=0.05:0.5 --minimise mass --limit "
        "'tilt<=0.4 mrad' --load hub.Fz=-8e5",
    ),
    "uncertainty": (
        "mine.yaml --quantity main_bearing.My --sobol",
        "mine.yaml --quantity modes.torsional.1",
    ),
    "report": (
        "mine.yaml --loads 'outputs/*.outb' --site class-II --open",
        "mine.yaml --loads outputs --pdf",
    ),
    "run": (
        "verification/nafems_le10 --quick",
        "gear --quick --out results",
        "--all --quick --junit verdicts.xml",
    ),
    "list": ("gear", "spherical roller", "--settings"),
    "validate": (
        "project.yaml --new",
        "project.yaml --new --drivetrain mine.yaml",
        "project.yaml --open",
    ),
    "history": ("nafems_le10", "--out results"),
    "compare-runs": ("before after",),
    "export": (
        "two_bearings --out shaft.json --format json",
        "two_bearings --what front --format dmig --format subdyn --out unit",
        "mine.yaml --out model.inp",
        "nrel_750kw --what turning --level rigid --format json --out system.json",
        "--list",
    ),
    "part": (
        "housing.step --picture faces.png",
        "housing.csv --bore bore",
        "housing.bdf --point bore=101 --units mm",
    ),
}
"""Arguments and options by command."""


def examples_text(command: str) -> str:
    """Examples as the end of a help text.

    Parameters
    ----------
    command : str
        Its name.

    Returns
    -------
    str
        A heading, and a line for each; empty where there are none.
    """
    lines = [f"  fe-drivetrain {command} {words}" for words in EXAMPLES.get(command, ())]
    return "\n".join(["Examples:", *lines]) if lines else ""


def unfolded(description: str) -> str:
    """A description whose paragraphs are one line each, so that a terminal folds them.

    Parameters
    ----------
    description : str
        Docstring of a command.

    Returns
    -------
    str
    """
    from inspect import cleandoc

    return "\n\n".join(
        " ".join(paragraph.split()) for paragraph in cleandoc(description).split("\n\n")
    )
