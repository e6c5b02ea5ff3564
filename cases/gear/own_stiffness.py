"""Mesh stiffness of a user's gears by ISO 6336-1 and by a formula, beside that of the file."""

from fe_drivetrain.cases.gear.own_meshes import given_meshes
from fe_drivetrain.cases.gear.rows import mesh_row, stiffness_row
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import Machine, machine_of
from fe_drivetrain.gear import mesh_stiffness, parabolic_law, parabolic_mean
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies.gear_meshes import GearMesh

HERO = "Mesh stiffness along the line of action: of the file, by ISO 6336-1 and by a formula"
OF_FILE, BY_ISO, BY_FORMULA = "of the file [GN/m]", "by ISO 6336-1 [GN/m]", "Eq 5.2 to 5.4 [GN/m]"
STATED = "stated in the file"
RATIO = 0.8
"""Least over largest stiffness of a pair of teeth, which the thesis does not state."""

POINTS = 4000
NEARLY_EQUAL = 0.05
"""How near to the standard's a stiffness counts as the same."""


def own_stiffness(run: Run, page: Page) -> None:
    """Stiffness of all meshes of a user's drivetrain in three ways."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Mesh stiffness of the file, by ISO 6336-1 and by a formula")
    machine = machine_of(chosen.drivetrain)
    meshes = given_meshes(chosen, machine, {}, page)
    rows: list[Record] = []
    for name, mesh in meshes.items():
        with run.step(name):
            check_mesh(page, mesh)
            rows.append(row_of(chosen.drivetrain, machine, mesh))
    page.section("Meshes")
    groups = {
        key.partition(" [")[0]: {str(row["mesh"]): float(row[key]) for row in rows}
        for key in (OF_FILE, BY_ISO, BY_FORMULA)
    }
    page.add(bars(HERO, groups, "mesh stiffness [GN/m]"))
    page.table("Meshes of the file whose gears are given in full", rows)
    page.text(
        "Eq 5.2 to 5.4 of Al-Hamadani 2018 take 14 N/(mm µm) of a pair of teeth at the pitch point "
        f"and, here, {RATIO} of that at the ends of its path. Stiffness about an axis is turned "
        "into that along the line of action by the base radius."
    )
    answer(page, rows)


def row_of(drivetrain: Drivetrain, machine: Machine, mesh: GearMesh) -> Record:
    """Stiffness of one mesh."""
    key = {"mesh": "stiffness"}.get(mesh.key, mesh.key)
    stage, stated = machine.stages[mesh.stage - 1], drivetrain.gearbox.stages[mesh.stage - 1]
    own = stage.along_line(getattr(stage, key))
    iso = mesh.stiffness.mesh * mesh.pair.face_width
    return {
        **mesh_row(mesh.name, mesh.pair),
        **stiffness_row(mesh.stiffness),
        OF_FILE: own / 1e9,
        BY_ISO: iso / 1e9,
        BY_FORMULA: parabolic_mean(mesh.pair, RATIO) * mesh.pair.face_width / 1e9,
        "file over ISO 6336-1": own / iso,
        STATED: "yes" if getattr(stated, key) is not None else "no: by ISO 6336-1",
        "planets": stage.planets if isinstance(stage, PlanetaryData) else None,
    }


def check_mesh(page: Page, mesh: GearMesh) -> None:
    """Check the contact ratio, and the formula's mean against an average over the phases."""
    pair = mesh.pair
    page.at_least(
        f"{mesh.name}: transverse contact ratio",
        pair.transverse_ratio,
        1.0,
        why="below 1 teeth part before the next ones touch",
        source="kinematics",
    )
    page.equals(
        f"{mesh.name}: mean stiffness by Eq 5.2 to 5.4 [GN/m]",
        parabolic_mean(pair, RATIO) * pair.face_width / 1e9,
        mesh_stiffness(pair, parabolic_law(pair, RATIO), points=POINTS).mean / 1e9,
        within=2e-3,
        why="phases do not catch the ends of the path to the point",
        source=f"mean over {POINTS} phases",
    )


def answer(page: Page, rows: list[Record]) -> None:
    """State how the file's stiffness stands to that of the standard."""
    stated = [row for row in rows if row[STATED] == "yes"]
    softest = min(rows, key=lambda row: float(row[BY_ISO]))
    formula = [float(row[BY_FORMULA]) / float(row[BY_ISO]) for row in rows]
    if stated:
        apart = {str(r["mesh"]): float(r["file over ISO 6336-1"]) for r in stated}
        most = max(apart, key=lambda name: abs(apart[name] - 1.0))
        verdict = (
            f"The file's stiffness of {most} is {apart[most]:.2g} times that of ISO 6336-1, the "
            "largest difference of all meshes."
            if abs(apart[most] - 1.0) > NEARLY_EQUAL
            else f"The file's stiffness is that of ISO 6336-1 within {percent_text(NEARLY_EQUAL)}, "
            "of all meshes where it is stated."
        )
    else:
        verdict = (
            f"The file leaves them to ISO 6336-1: {softest['mesh']} is softest, with "
            f"{value_text(float(softest[BY_ISO]), 'GN/m')}; Eq 5.2 to 5.4 give "
            f"{min(formula):.2g} to {max(formula):.2g} times as much."
        )
    page.answer(
        "How stiff are the gear meshes: by the file, and by ISO 6336-1?",
        verdict,
        [
            *(
                page.value(
                    f"mesh stiffness, {row['mesh']} [GN/m]",
                    float(row[OF_FILE]),
                    beside=float(row[BY_ISO]),
                    by="ISO 6336-1",
                )
                for row in rows[:5]
            ),
            page.value("largest of Eq 5.2 to 5.4 over ISO 6336-1", max(formula)),
        ],
        HERO,
        ["Gears are solid discs, or of the file's blank factor; a rim makes meshes softer."],
    )
