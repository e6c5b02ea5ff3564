"""WISDEM's drivetrain with spring and damper of a finite-element shaft, from its turbine file."""

import warnings
from collections.abc import Callable
from copy import deepcopy
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.samples import show
from fe_drivetrain.common import MissingToolError, scratch_folder
from fe_drivetrain.drivetrain_file import Material, Scene, change_scene, library_scene
from fe_drivetrain.export import Torsion, shaft_superelement, torsional_damping, torsional_stiffness
from fe_drivetrain.export.formats import windio
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Run

RATIO = 0.05
#: Main shaft: outer and inner diameter [m].
OUTER, INNER = 3.0, 2.4
DENSITY = 7850.0

SPRINGS = "Torsional spring of WISDEM's drivetrain: its own, and from the turbine file"

#: Its bearings fit a shaft of 3 m.
MAIN_SHAFT = "iea_15mw_main_shaft"

#: Options of WISDEM: a direct drive of one material.
OPTIONS = {
    "WISDEM": {
        "n_dlc": 1,
        "DriveSE": {
            "direct": True,
            "gearbox_torque_density": 0.0,
            "hub": {"hub_gamma": 2.0, "spinner_gamma": 1.5},
            "gamma_f": 1.35,
            "gamma_m": 1.3,
            "gamma_n": 1.0,
        },
        "RotorSE": {"n_pc": 20},
    },
    "materials": {"n_mat": 1},
    "flags": {"generator": False},
}

#: Inputs of WISDEM: a made-up turbine.
VALUES: dict[str, Any] = {
    "n_blades": 3,
    "rotor_diameter": 120.0,
    "machine_rating": 5e3,
    "D_top": 6.5,
    "rated_torque": 4e6,
    "damping_ratio": RATIO,
    "F_aero_hub": np.array([[1e6], [0.0], [0.0]]),
    "M_aero_hub": np.array([[0.0], [2e6], [2e6]]),
    "blade_mass": 1.7e4,
    "blades_mass": 5.1e4,
    "blades_cm": 2.0,
    "pitch_system.BRFM": 1e6,
    "pitch_system_scaling_factor": 0.54,
    "blade_root_diameter": 3.0,
    "flange_t2shell_t": 4.0,
    "flange_OD2hub_D": 0.5,
    "flange_ID2flange_OD": 0.8,
    "hub_rho": 7200.0,
    "hub_Xy": 2e8,
    "hub_stress_concentration": 2.5,
    "n_front_brackets": 3,
    "n_rear_brackets": 3,
    "clearance_hub_spinner": 0.5,
    "spin_hole_incr": 1.2,
    "spinner_gust_ws": 70.0,
    "hub_diameter": 5.0,
    "minimum_rpm": 4.0,
    "rated_rpm": 12.0,
    "blades_I": np.array([3.5e7, 1.8e7, 1.8e7, 0.0, 0.0, 0.0]),
    "bear1.bearing_type": "CARB",
    "bear2.bearing_type": "SRB",
    "bear1.D_shaft": 2.2,
    "bear2.D_shaft": 2.2,
    "upwind": True,
    "L_12": 2.0,
    "L_h1": 1.0,
    "L_generator": 3.25,
    "overhang": 6.25,
    "drive_height": 4.875,
    "tilt": 4.0,
    "access_diameter": 0.9,
    "lss_diameter": OUTER * np.ones(2),
    "lss_wall_thickness": 0.5 * (OUTER - INNER) * np.ones(2),
    "nose_diameter": 2.2 * np.ones(2),
    "nose_wall_thickness": 0.1 * np.ones(2),
    "bedplate_wall_thickness": 0.06 * np.ones(4),
    "generator_efficiency_user": np.zeros((20, 2)),
}

TURBINE = """\
components:
    drivetrain:
        outer_shape:
            gear_ratio: 1.0 # direct drive
        elastic_properties:
            mass: 6.4e+5
            inertia: [9.5e+6, 1.06e+7, 1.05e+7, 0.0, 0.0, 0.0]
            location: [-5.1, 0.0, 4.3]
"""


def started(material: Material) -> tuple[Any, Callable[[Path], Any]]:
    """WISDEM's drivetrain, and what reads windIO's files.

    Raises
    ------
    MissingToolError
        WISDEM is not installed.
    """
    try:
        problem = drivetrain(material.youngs_modulus, material.shear_modulus)
        return problem, import_module("windIO").load_yaml
    except ImportError as error:
        raise MissingToolError(
            f"WISDEM cannot be loaded ({error}): install it with pip install "
            '"fe-drivetrain[wisdem]"'
        ) from error


def uniform_shaft(length: float) -> Scene:
    """The library's main shaft as a tube of one length [m]."""
    return change_scene(
        library_scene(MAIN_SHAFT),
        {
            # no ring that stiffens the shaft: WISDEM knows of none
            "bearing_units.1.bearing.kind": "ring",
            "bearing_units.1.interface": "bonded",
            "shaft.sections.0.length": length,
            "shaft.sections.0.outer_diameter": OUTER,
            "shaft.sections.0.inner_diameter": INNER,
        },
    )


def drivetrain_torsion(spring: float, problem: Any) -> Torsion:
    """Spring and damper of a drivetrain whose main shaft has a spring [N m/rad]."""
    rotor = float(problem["blades_I"][0] + problem["hub_system_I"][0])
    generator = float(problem["generator_I"][0])
    # beside the main shaft, a hub as stiff as five of them and a generator rotor as three
    softer = 1.0 / (1.0 / spring + 1.0 / (5 * spring) + 1.0 / (3 * spring))
    return Torsion(softer, torsional_damping(RATIO, softer, rotor, generator))


def run_with(problem: Any, ours: Torsion, load_yaml: Callable[[Path], Any]) -> Any:
    """Let WISDEM take a torsion from its turbine file; what windIO's file states of it."""
    with scratch_folder() as name:
        path = name / "turbine.yaml"
        path.write_text(TURBINE)
        windio.write_torsion(path, path, ours, "wisdem", overwrite=True)
        given = load_yaml(path)["components"]["drivetrain"]
        for key in ("spring_constant_user", "damping_coefficient_user"):
            problem[f"drivetrain_{key}"] = given[key]
        problem.run_model()
        windio.write_torsion(path, path, ours, "windio", overwrite=True)
        return load_yaml(path)["components"]["drivetrain"]["elastic_properties"]


def check_files(page: Page, used: Torsion, stated: Any, ours: Torsion) -> None:
    """What programs read is what was written."""
    for quantity, found, expected, unit in (
        ("spring that WISDEM continues with", used.spring, ours.spring, "N m/rad"),
        ("damper that WISDEM continues with", used.damper, ours.damper, "N m s/rad"),
        ("spring_constant in windIO", stated["spring_constant"], ours.spring, "N m/rad"),
        ("damping_coefficient in windIO", stated["damping_coefficient"], ours.damper, "N m s/rad"),
    ):
        page.equals(
            quantity,
            found,
            expected,
            within=0.0,
            why="the file keeps every digit",
            source="what was written",
            unit=unit,
            measure="identity",
        )


def answer(page: Page, own: Torsion, used: Torsion, ours: Torsion) -> None:
    """State the torsion that WISDEM continues with, beside its own and what was written."""
    spring = page.value(
        "spring that WISDEM continues with [GN m/rad]",
        used.spring / 1e9,
        beside=ours.spring / 1e9,
        by="as written",
    )
    damper = page.value(
        "damper that WISDEM continues with [MN m s/rad]",
        used.damper / 1e6,
        beside=ours.damper / 1e6,
        by="as written",
    )
    how = "as" if (used.spring, used.damper) == (ours.spring, ours.damper) else "not as"
    page.answer(
        "Does WISDEM take the torsion of a finite-element shaft from its turbine file?",
        f"It continues with {certain_value(spring)} and {certain_value(damper)}, {how} written, in "
        f"place of its own {value_text(own.spring / 1e9, 'GN m/rad')}.",
        [
            spring,
            damper,
            page.judged(
                "main shaft: stiffness of the finite-element model",
                "main shaft alone, finite elements",
                "WISDEM",
                unit="GN m/rad",
            ),
            page.value("WISDEM's own damper [MN m s/rad]", own.damper / 1e6),
        ],
        hero=SPRINGS,
        cautions=[
            "WISDEM's own damper is of critical with the generator held, ours with it free.",
            "The turbine is made up, with its hub's and generator rotor's stiffness assumed.",
        ],
    )


@case(
    "WISDEM's drivetrain with the torsion of a finite-element shaft",
    source="WISDEM and windIO, run here",
)
def run(run: Run, page: Page) -> None:
    """Run WISDEM's drivetrain with its own torsion, then with ours from a turbine file."""
    with run.step("WISDEM with its own torsion"):
        problem, load_yaml = started(library_scene(MAIN_SHAFT).material_of("shaft"))
        problem.run_model()
    own = torsion_of(problem)
    with run.step("finite-element shaft"):
        scene = uniform_shaft(float(problem.get_val("L_lss", units="m")[0]))
        page.about(scene)
        shaft = shaft_superelement(scene, 2, ["hub", "gearbox"])
    spring = torsional_stiffness(shaft, "hub", "gearbox")
    ours = drivetrain_torsion(spring, problem)
    stated = run.timed("WISDEM with ours", run_with, problem, ours, load_yaml)
    used = torsion_of(problem)
    page.equals(
        "main shaft: stiffness of the finite-element model [N m/rad]",
        spring,
        own.spring,
        within=1e-9,
        why="the elements contain the exact solution: round-off of the condensation",
        source="WISDEM's drivetrain, G J / L of its uniform shaft",
    )
    check_files(page, used, stated, ours)
    answer(page, own, used, ours)
    page.say("For a uniform shaft WISDEM's own stiffness is that of the finite-element shaft.")
    by = {
        "WISDEM's own, main shaft": own.spring,
        "finite elements, main shaft": spring,
        "with hub and generator rotor, from the file": used.spring,
    }
    giga = {name: k / 1e9 for name, k in by.items()}
    page.add(bars(SPRINGS, {"spring": giga}, "spring [GN m/rad]"))
    show(run, page, scene)
    page.section("Torsion of the drivetrain")
    page.text(
        "WISDEM's damper is its damping ratio times that of critical with the generator held; ours "
        "is of the mode in which rotor and generator turn against each other, which has less "
        "inertia. WISDEM 4.2 looks for its overrides beside the drivetrain's other values, not in "
        "its elastic properties, where its schema lists them. The turbine is made up."
    )
    page.table(
        "Direct drive, low-speed side",
        [
            {"": name, "spring [N m/rad]": torsion.spring, "damper [N m s/rad]": torsion.damper}
            for name, torsion in (("WISDEM's own", own), ("with ours", used))
        ],
    )
    page.data("own", list(own))
    page.data("used", list(used))


def drivetrain(young: float, shear: float) -> Any:
    """WISDEM's direct drivetrain of a made-up turbine; moduli of its steel [Pa]."""
    with warnings.catch_warnings():
        # openmdao's and WISDEM's own
        warnings.simplefilter("ignore")
        om = import_module("openmdao.api")
        model = import_module("wisdem.drivetrainse.drivetrain").DrivetrainSE
    problem = om.Problem(reports=False)
    problem.model = model(modeling_options=deepcopy(OPTIONS))
    problem.setup()
    for name, value in (VALUES | steel_values(young, shear)).items():
        problem[name] = value
    return problem


def steel_values(young: float, shear: float) -> dict[str, Any]:
    """WISDEM's inputs of a material, by its moduli [Pa]."""
    one, row = np.ones(1), np.ones((1, 3))
    parts = ("lss", "hss", "hub", "spinner", "bedplate")
    return {
        "E_mat": young * row,
        "G_mat": shear * row,
        "Xt_mat": 4.5e8 * row,
        "wohler_exp_mat": 10.0 * one,
        "wohler_A_mat": 10.0 * one,
        "rho_mat": DENSITY * one,
        "Xy_mat": 3.5e8 * one,
        "unit_cost_mat": 3.0 * one,
        "material_names": ["steel"],
        **{f"{part}_material": "steel" for part in parts},
    }


def torsion_of(problem: Any) -> Torsion:
    """Spring and damper that WISDEM continues with."""
    return Torsion(
        float(problem.get_val("drivetrain_spring_constant", units="N*m/rad")[0]),
        float(problem.get_val("drivetrain_damping_coefficient", units="N*m*s/rad")[0]),
    )
