"""What makes each part of a dossier: studies, shown as by their own commands."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from fe_drivetrain.command_line.showing import Shown

if TYPE_CHECKING:
    from fe_drivetrain.command_line.report_request import ReportRequest
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.scene_study import StudyResult
    from fe_drivetrain.studies.study_loads import StudyLoads

    Work = Callable[[Run, Page], None]

TOLERANCE = 0.05
"""Within which the cheapest model has to have the first bearing's vertical force."""


def main_reaction(scene: Scene) -> str:
    """The quantity that the cheapest model has to have: the first bearing's vertical force.

    Parameters
    ----------
    scene : Scene
        The drivetrain.
    """
    return f"{scene.bearing_names[0]}.Fz"


def dossier_works(
    asked: ReportRequest, scene: Scene, own: StudyLoads | None = None
) -> dict[str, Work]:
    """What makes each part; a part that says nothing of this drivetrain is left out.

    Parameters
    ----------
    asked : ReportRequest
        Names the files of loads.
    scene : Scene
        The drivetrain.
    own : StudyLoads or None
        The loads as read, which the part of reactions needs, and no other.

    Returns
    -------
    dict
        By the name of the part, in the order of the dossier.
    """
    from fe_drivetrain.command_line.export_files import write_shaft
    from fe_drivetrain.command_line.life_files import write_life
    from fe_drivetrain.command_line.loads_files import write_loads
    from fe_drivetrain.command_line.study_files import write_study
    from fe_drivetrain.pages.advise import show_advise
    from fe_drivetrain.pages.check import show_check
    from fe_drivetrain.pages.export import show_export
    from fe_drivetrain.pages.life import show_life
    from fe_drivetrain.pages.loads import show_loads
    from fe_drivetrain.pages.study import show_study
    from fe_drivetrain.studies.bearing_lives import life
    from fe_drivetrain.studies.dossier_overview import extremes_of
    from fe_drivetrain.studies.export_content import prepare_export
    from fe_drivetrain.studies.gearbox_bearings import catalogue_entries
    from fe_drivetrain.studies.level_advice import advise
    from fe_drivetrain.studies.life_options import LifeOptions
    from fe_drivetrain.studies.load_digest import LoadOptions
    from fe_drivetrain.studies.load_histories import loads
    from fe_drivetrain.studies.scene_check import check
    from fe_drivetrain.studies.scene_study import study

    catalogues = tuple(asked.catalogue or ())

    def write_reactions(run: Run, page: Page, result: StudyResult) -> None:
        assert own is not None
        for name, table in extremes_of(result, own.histories).items():
            page.data(name, table)
        write_study(run, page, result, own.histories)

    works: dict[str, Work] = {
        "loads": Shown(
            lambda run: loads(
                asked.loads,
                LoadOptions(**asked.reading),
                resume=True,
                report=run.report,
            ),
            show_loads,
            write_loads,
        ),
        "reactions": Shown(
            lambda run: study(scene, own, quick=run.quick, report=run.report),
            show_study,
            write_reactions,
            draws=True,
        ),
        "life": Shown(
            lambda run: life(
                scene,
                asked.loads,
                asked.place,
                LifeOptions(catalogues=catalogues, **asked.reading),
                resume=True,
                report=run.report,
            ),
            show_life,
            write_life,
        ),
        **strength_works(asked, scene),
        **turning_works(asked, scene),
        "model": Shown(
            lambda run: advise(
                scene, main_reaction(scene), TOLERANCE, kept=True, report=run.report
            ),
            show_advise,
        ),
        "check": Shown(
            lambda run: check(scene, catalogues, report=run.report), show_check, draws=True
        ),
        "export": Shown(
            lambda run: prepare_export(scene, report=run.report), show_export, write_shaft
        ),
    }
    if not catalogue_entries(scene):
        del works["life"]
    return works


def strength_works(asked: ReportRequest, scene: Scene) -> dict[str, Work]:
    """What makes the part of the main shaft's strength; none where the file states none.

    Parameters
    ----------
    asked : ReportRequest
        Names the files of loads.
    scene : Scene
        The drivetrain.
    """
    from fe_drivetrain.command_line.strength_files import write_strength
    from fe_drivetrain.pages.strength import show_strength
    from fe_drivetrain.studies.shaft_strength import strength
    from fe_drivetrain.studies.strength_options import StrengthOptions

    if scene.strength is None:
        return {}
    options = StrengthOptions(**asked.reading)
    return {
        "strength": Shown(
            lambda run: strength(
                scene, asked.loads, asked.place, options, resume=True, report=run.report
            ),
            show_strength,
            write_strength,
        )
    }


def turning_works(asked: ReportRequest, scene: Scene) -> dict[str, Work]:
    """What makes the parts of all that turns; none where the file does not state it.

    Parameters
    ----------
    asked : ReportRequest
        Names the files of loads.
    scene : Scene
        The drivetrain.

    Returns
    -------
    dict
        By name: modes of what has rotor and generator, gears of what has stages, and an emergency
        stop of what has a brake, too.
    """
    from fe_drivetrain.command_line.gears_files import write_gears
    from fe_drivetrain.dynamics import machine_of
    from fe_drivetrain.pages.gears import show_gears
    from fe_drivetrain.pages.modes import show_modes
    from fe_drivetrain.pages.transient import show_transient
    from fe_drivetrain.studies.drivetrain_modes import modes
    from fe_drivetrain.studies.drivetrain_transient import transient
    from fe_drivetrain.studies.gear_options import GearOptions
    from fe_drivetrain.studies.gear_ratings import gears

    if scene.rotor is None or scene.generator is None or machine_of(scene).not_given:
        return {}
    works: dict[str, Work] = {
        "modes": Shown(lambda run: modes(scene, report=run.report), show_modes)
    }
    if not scene.gearbox.stages:
        return works
    options = GearOptions(**asked.reading)
    works["gears"] = Shown(
        lambda run: gears(
            scene,
            loads=asked.loads,
            site=asked.place,
            options=options,
            resume=True,
            report=run.report,
        ),
        show_gears,
        write_gears,
    )
    if scene.brake is not None:
        works["stop"] = Shown(
            lambda run: transient(scene, "stop", report=run.report), show_transient
        )
    return works
