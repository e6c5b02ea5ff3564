"""Work of cases that fail, and of one that does not, as other processes import it."""

import os
import signal

from tiny_case import check_one

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

NEW = "new"


def fill(run: Run, page: Page, mark: str = NEW) -> None:
    """Write the mark to the page and two files."""
    (run.folder / "one.txt").write_text(mark)
    (run.folder / "two").mkdir()
    (run.folder / "two" / "three.txt").write_text(mark * 1000)
    page.say(mark)
    check_one(page)


def mesh_a_scene(run: Run, page: Page) -> None:
    from coarse_scenes import coarse_scene

    from fe_drivetrain.shafts.response.model import mesh_scene

    assert len(mesh_scene(coarse_scene("bonded")).cells) > 100
    fill(run, page)


def gmsh_fails(run: Run, page: Page) -> None:
    import gmsh
    from coarse_scenes import coarse_scene

    from fe_drivetrain.shafts.response.model import mesh_scene

    generate, gmsh.model.mesh.generate = gmsh.model.mesh.generate, _no_mesh
    try:
        mesh_scene(coarse_scene("bonded", **{"mesh.shaft": 0.28}))
    finally:
        gmsh.model.mesh.generate = generate
    page.say(NEW)


def _no_mesh(dimension: int) -> None:
    raise Exception("PLC Error: A segment and a facet intersect at point")  # as gmsh raises it


def crash(run: Run, page: Page) -> None:
    (run.folder / "half.txt").write_text("half")
    os.kill(os.getpid(), signal.SIGSEGV)
