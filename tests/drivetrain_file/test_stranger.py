"""A drivetrain that is in no library: what its file says, against a calculation by hand.

Rotor, ratio, speed and generator are those of a public reference turbine, the gearbox is made up.
Nothing here but the reading of the file, the machine and its modes is of the library.
"""

from math import acos, asin, atan, cos, pi, radians, sin, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.linalg import eigh

from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import machine_of, rated_torque, torsional
from fe_drivetrain.dynamics.torsion import natural_modes
from fe_drivetrain.procedure import parse_project, starting_project

FILE = Path(__file__).with_name("iea_3p4mw.yaml")
DENSITY, STEEL, MAIN = 7850.0, 2.06e11 / 2.6, 2.0e11 / 2.6  # kg/m^3; shear moduli [Pa]
RATIO = (1 + 95 / 25) * (1 + 96 / 24) * 97 / 24


@pytest.fixture(scope="module")
def data() -> Any:
    return yaml.safe_load(FILE.read_text("utf-8"))


def of_section(section: dict[str, float]) -> float:
    """Compliance of a cylinder or cone in torsion, G times [1/m^3]."""
    large, length = section["outer_diameter"], section["length"]
    small = section.get("outer_diameter_end", large)
    if small == large:
        return 32.0 * length / (pi * large**4)
    return 32.0 * length / (3.0 * pi * (large - small)) * (1.0 / small**3 - 1.0 / large**3)


def mesh(
    teeth: tuple[int, int], stage: dict[str, Any], internal: bool = False
) -> tuple[float, list[float], list[float]]:
    """Stiffness by ISO 6336-1 method B without shifts [N/m], base and pitch radii [m]."""
    module, helix, normal = stage["module"], radians(stage["helix"]), radians(20.0)
    angle = atan(tan(normal) / cos(helix))
    base_helix = asin(sin(helix) * cos(normal))
    virtual = [z / (cos(base_helix) ** 2 * cos(helix)) for z in teeth]
    flexibility = 0.04723 + 0.15551 / virtual[0] + (0.0 if internal else 0.25791 / virtual[1])
    single = 0.8 * (1.0 + 0.5 * (1.2 - 1.25)) * cos(helix) / flexibility
    pitch = [0.5 * z * module / cos(helix) for z in teeth]
    base = [r * cos(angle) for r in pitch]
    tips = [pitch[0] + module, pitch[1] - module if internal else pitch[1] + module]
    path = [r * sin(acos(b / r)) for r, b in zip(tips, base, strict=True)]
    sign = -1.0 if internal else 1.0
    centre = sign * pitch[0] + pitch[1]
    length = path[0] + sign * (path[1] - centre * sin(angle))
    contact = length / (pi * module / cos(helix) * cos(angle))
    stiffness = single * (0.75 * contact + 0.25) * 1e9 * stage["face_width"]
    return stiffness, base, pitch


def disc(radius: float, width: float) -> float:
    return DENSITY * pi * radius**4 * width / 2.0


def frequency_by_hand(data: Any) -> float:
    """First torsional frequency of bodies that only turn, shafts without mass [Hz]."""
    names = ("rotor", "c1", "p1", "s1", "c2", "p2", "s2", "gear", "pinion", "generator")
    M, K = np.zeros((10, 10)), np.zeros((10, 10))

    def spring(stiffness: float, **arms: float) -> None:
        row = np.array([arms.get(name, 0.0) for name in names])
        K[:] += stiffness * np.outer(row, row)

    stages, shafts = data["gearbox"]["stages"], data["gearbox"]["shafts"]
    inertia = {"rotor": float(data["rotor"]["inertia"]), "generator": data["generator"]["inertia"]}
    for k, stage in enumerate(stages[:2], start=1):
        z, face = stage["teeth"], stage["face_width"]
        sun, (r_sun, r_planet), pitch = mesh((z["sun"], z["planet"]), stage)
        ring, (own, r_ring), _ = mesh((z["planet"], z["ring"]), stage, internal=True)
        mass = DENSITY * pi * pitch[1] ** 2 * face
        inertia[f"c{k}"] = stage["carrier"]["inertia"] + 3 * mass * (pitch[0] + pitch[1]) ** 2
        inertia[f"p{k}"], inertia[f"s{k}"] = 3 * disc(pitch[1], face), disc(pitch[0], face)
        spring(3 * sun, **{f"s{k}": r_sun, f"p{k}": r_planet, f"c{k}": -r_sun - r_planet})
        spring(3 * ring, **{f"p{k}": own, f"c{k}": r_ring - own})
    last, base, pitch = mesh((24, 97), stages[2])
    spring(last, pinion=base[0], gear=base[1])
    inertia["pinion"] = disc(pitch[0], stages[2]["face_width"])
    inertia["gear"] = disc(pitch[1], stages[2]["face_width"])
    flange = data["shaft"]["flange"]
    front = {"outer_diameter": flange["outer_diameter"], "length": flange["thickness"]}
    spring(MAIN / sum(map(of_section, [front, *data["shaft"]["sections"]])), rotor=1, c1=-1)
    for shaft, (one, other) in zip(
        shafts, (("s1", "c2"), ("s2", "gear"), ("pinion", "generator")), strict=True
    ):
        size = {"outer_diameter": shaft["outer"], "length": shaft["length"]}
        spring(STEEL / of_section(size), **{one: 1.0, other: -1.0})
    M[:] = np.diag([inertia[name] for name in names])
    return float(sqrt(eigh(K, M, eigvals_only=True)[1]) / (2.0 * pi))


def test_a_drivetrain_of_no_library_turns_as_by_hand(data: Any) -> None:
    found = read_drivetrain(FILE)
    machine = machine_of(found)
    assert machine.not_given == ()
    assert abs(machine.speeds[-1]) == pytest.approx(RATIO, rel=1e-12) == pytest.approx(97.0)
    rated = rated_torque(found, machine)
    assert rated is not None
    assert rated.torque == pytest.approx(28804.0 * RATIO, rel=1e-12)
    stage = machine.stages[2]
    assert stage.stiffness == pytest.approx(  # type: ignore[union-attr]
        mesh((24, 97), data["gearbox"]["stages"][2])[0], rel=1e-6
    )
    first = natural_modes(torsional(machine)).frequencies[1]
    # shafts have an inertia of their own, which lowers it
    assert 0.997 * frequency_by_hand(data) < first < frequency_by_hand(data)


def test_its_project_begins_with_what_its_file_has(data: Any) -> None:
    project = parse_project(starting_project(read_drivetrain(FILE), "iea_3p4mw.yaml"))
    assert project.inputs is not None
    values = {one.name: one.value for one in project.inputs.values}
    assert values["inertia of drivetrain parts: rotor"] == float(data["rotor"]["inertia"])
    main = [*data["shaft"]["sections"]]
    flange = data["shaft"]["flange"]
    main.append({"outer_diameter": flange["outer_diameter"], "length": flange["thickness"]})
    k = MAIN / sum(map(of_section, main))
    # a cone is cut into eight slices
    assert values["stiffness of shafts: main shaft"] == pytest.approx(k, rel=1e-4)
