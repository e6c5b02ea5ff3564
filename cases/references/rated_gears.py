"""Gears that others have rated by ISO 6336, with their inputs and what they print.

The gearbox of the NREL 5 MW reference turbine (Nejad, Guo, Gao and Moan 2016) with KISSsoft 03/2017
(ISO 6336:2006, method B), from reports of 26 February 2020 in the public repository
gfsReboucas/Drivetrain; example 1 of ISO/TR 6336-30, as that repository quotes it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from math import degrees, pi, radians
from typing import Any

import yaml

from fe_drivetrain.comparison.tolerances import digit
from fe_drivetrain.gear.involute import Gear, Pair, Rack
from fe_drivetrain.gear.load_factors import (
    LoadFactors,
    reduced_mass,
    relative_mass,
    resonance_speed,
)
from fe_drivetrain.gear.pair_factors import RunningPair, method_b_factors
from fe_drivetrain.gear.rating import (
    Running,
    contact_stress,
    endured_contact,
    endured_root,
    root_stress,
)
from fe_drivetrain.gear.root_geometry import Cutter
from fe_drivetrain.gear.strength import (
    GearMaterial,
    life_factor,
    lubricant_factor,
    notch_factor,
    roughness_factor,
    size_factor,
    surface_factor,
    velocity_factor,
)

RPM = pi / 30.0
HOURS = 175200.0
HARD = GearMaterial("case-hardened", 1500e6, 430e6)
SOFT = GearMaterial("through-hardened", 700e6, 290e6, 1000e6, 240.0)
MATERIALS = {"case-hardened": HARD, "through-hardened": SOFT}


@dataclass(frozen=True)
class RatedMesh:
    """A mesh with its load, and what is printed of it.

    Attributes
    ----------
    name : str
        Name of the mesh.
    pair : Pair
        Its gears.
    materials : tuple of GearMaterial
        Materials of both.
    running : Running
        Torque, speed, oil, roughness.
    cycles : tuple of float
        Cycles of load on one flank of a tooth of each gear, over the life.
    stiffness : tuple of float
        c' and c_gamma_alpha, as printed [N/m^2].
    factors : LoadFactors
        As given; K_v and K_Halpha are computed where `computed_dynamics` says so.
    mass : float
        Reduced one, per face width [kg/m].
    deviations : tuple of float
        Largest base pitch and profile form deviation, as printed [m].
    computed_dynamics : tuple of bool
        Whether K_v, and whether K_Halpha and K_Falpha, are computed.
    cutter : Cutter or None
        Cutter of an internal gear.
    mean_stress : tuple of float
        Y_M of both gears.
    rims : tuple of float or None
        Thickness of the rims of both gears [m]; thick where none.
    tooth_height : float
        The larger one of both gears as made, of which K_Fbeta follows [m].
    load_rounding : float
        What a K factor printed with few digits leaves of the load, relative.
    input_rounding : float
        What lengths printed with few digits leave of the ratings, relative.
    printed : dict
        Quantity with unit: value as printed, of both gears, or of the mesh.
    unmet : dict
        As `printed`, of what the equations do not give.
    reason : str
        Why they do not.
    """

    name: str
    pair: Pair
    materials: tuple[GearMaterial, GearMaterial]
    running: Running
    cycles: tuple[float, float]
    stiffness: tuple[float, float]
    factors: LoadFactors
    mass: float
    deviations: tuple[float, float]
    tooth_height: float
    load_rounding: float = 0.0
    input_rounding: float = 1e-5
    computed_dynamics: tuple[bool, bool] = (False, False)
    cutter: Cutter | None = None
    mean_stress: tuple[float, float] = (1.0, 1.0)
    rims: tuple[float | None, float | None] = (None, None)
    printed: dict[str, tuple[str, ...]] = field(default_factory=dict)
    unmet: dict[str, tuple[str, ...]] = field(default_factory=dict)
    reason: str = ""


def with_dynamics(mesh: RatedMesh) -> LoadFactors:
    """Load factors of a mesh, with those that are computed.

    Parameters
    ----------
    mesh : RatedMesh
        Its deviations, stiffness, masses and given factors.

    Returns
    -------
    LoadFactors
        K_Fbeta always follows from K_Hbeta.
    """
    running = RunningPair(
        mesh.pair,
        mesh.materials,
        mesh.running,
        mesh.stiffness,
        mesh.mass,
        mesh.deviations,
        mesh.tooth_height,
    )
    return method_b_factors(running, mesh.factors, *mesh.computed_dynamics)


def tolerance(mesh: RatedMesh, quantity: str, printed: str) -> float:
    """How far a rating may be from a print: rounding of the print, and of the load factors.

    Parameters
    ----------
    mesh : RatedMesh
        Whose rating.
    quantity : str
        A key of `printed`.
    printed : str
        The number.

    Returns
    -------
    float
        In the unit of the quantity. Half of the last digit, and what rounded inputs leave: lengths
        `input_rounding`; tooth heights 5e-5 of sigma_F; K factors with few digits
        `load_rounding`, to the half power in contact stress; 2e-5 of stresses that are endured, of
        which the cause was not found. Lives go with the power of the S-N curve.
    """
    value, name = float(printed), quantity.split(" ")[0]
    power = {"sigma_Hw": 0.5, "sigma_H": 0.5, "S_H": 0.5, "sigma_F": 1.0, "S_F": 1.0, "life": 16.5}
    besides = {"sigma_HG": 2e-5, "life": 33.0 * 2e-5, "sigma_F": 5e-5}
    relative = power.get(name, 0.0) * mesh.load_rounding + besides.get(name, mesh.input_rounding)
    return 0.5 * digit(printed) + relative * abs(value)


def rated(mesh: RatedMesh, factors: LoadFactors | None = None) -> dict[str, tuple[float, ...]]:
    """Rate a mesh: every quantity that a report may print.

    Parameters
    ----------
    mesh : RatedMesh
        What is rated.
    factors : LoadFactors, optional
        Its load factors; `with_dynamics` where left out.

    Returns
    -------
    dict
        Under the keys of `printed`: values of both gears, or of the mesh.
    """
    pair, K = mesh.pair, with_dynamics(mesh) if factors is None else factors
    resonance = resonance_speed(mesh.stiffness[1], mesh.mass, pair.first.teeth)
    return {
        "F_t [N]": (pair.tangential_force(mesh.running.torque),),
        "m_red [kg/m]": (mesh.mass,),
        "n_E1 [1/min]": (resonance / RPM,),
        "K_v": (K.K_v,),
        "K_Halpha": (K.K_Halpha,),
        "K_Fbeta": (K.K_Fbeta,),
        **_of_flanks(mesh, K),
        **_of_roots(mesh, K),
    }


def _of_flanks(mesh: RatedMesh, K: LoadFactors) -> dict[str, tuple[float, ...]]:
    """Contact stress, what the flanks endure, and their lives."""
    pair, running, own = mesh.pair, mesh.running, mesh.materials
    contact = contact_stress(pair, running.torque, K, own)
    flanks = endured_contact(pair, running, own)
    weaker = min(m.contact_limit for m in own)
    sigma_HG = [e.curve.at(n) for e, n in zip(flanks, mesh.cycles, strict=True)]
    speed = running.speed * pair.first.reference_radius
    radii = pair.curvatures(pair.path.pitch)
    radius = float(radii[0] * radii[1] / (radii[0] + radii[1]))
    lives = [
        float(e.curve.endured([1.25 * s])[0]) / n * HOURS
        for e, s, n in zip(flanks, contact.stress, mesh.cycles, strict=True)
    ]
    rough = 0.5 * sum(running.flank_roughness)
    return {
        "Z_H": (contact.Z_H,),
        "Z_E [sqrt(MPa)]": (contact.Z_E / 1e3,),
        "Z_epsilon": (contact.Z_epsilon,),
        "Z_beta": (contact.Z_beta,),
        "sigma_H0 [MPa]": (contact.nominal / 1e6,),
        "sigma_Hw [MPa]": (contact.at_pitch_point / 1e6,),
        "Z_B, Z_D": contact.Z_BD,
        "sigma_H [MPa]": tuple(s / 1e6 for s in contact.stress),
        "Z_L": (lubricant_factor(weaker, running.viscosity),),
        "Z_v": (velocity_factor(weaker, speed),),
        "Z_R": (roughness_factor(weaker, rough, radius),),
        "Z_NT": tuple(life_factor(m, n) for m, n in zip(own, mesh.cycles, strict=True)),
        "sigma_HG [MPa]": tuple(s / 1e6 for s in sigma_HG),
        "S_H": tuple(g / s for g, s in zip(sigma_HG, contact.stress, strict=True)),
        "life of the flanks at S_H = 1.25 [h]": tuple(lives),
    }


def _of_roots(mesh: RatedMesh, K: LoadFactors) -> dict[str, tuple[float, ...]]:
    """Tooth form, root stress, and what the roots endure."""
    pair, running, own = mesh.pair, mesh.running, mesh.materials
    roots = root_stress(pair, running.torque, K, mesh.cutter, mesh.rims)
    gears, roughness = (pair.first, pair.second), running.root_roughness
    endured = [
        endured_root(gear, r.root, m, rough, Y_M)
        for gear, r, m, rough, Y_M in zip(
            gears, roots, own, roughness, mesh.mean_stress, strict=True
        )
    ]
    sigma_FG = [e.curve.at(n) for e, n in zip(endured, mesh.cycles, strict=True)]
    return {
        "Y_F": tuple(r.root.Y_F for r in roots),
        "Y_S": tuple(r.root.Y_S for r in roots),
        "s_Fn [modules]": tuple(r.root.chord for r in roots),
        "h_Fe [modules]": tuple(r.root.arm for r in roots),
        "rho_F [modules]": tuple(r.root.fillet for r in roots),
        "alpha_Fen [deg]": tuple(degrees(r.root.load_angle) for r in roots),
        "Y_beta": (roots[0].Y_beta,),
        "sigma_F0 [MPa]": tuple(r.nominal / 1e6 for r in roots),
        "sigma_F [MPa]": tuple(r.stress / 1e6 for r in roots),
        "Y_delta_relT": tuple(
            notch_factor(m, r.root.notch) for m, r in zip(own, roots, strict=True)
        ),
        "Y_R_relT": tuple(
            surface_factor(m, rough) for m, rough in zip(own, roughness, strict=True)
        ),
        "Y_X": tuple(size_factor(m, pair.first.normal_module) for m in own),
        "Y_NT": tuple(life_factor(m, n, root=True) for m, n in zip(own, mesh.cycles, strict=True)),
        "sigma_FG [MPa]": tuple(s / 1e6 for s in sigma_FG),
        "S_F": tuple(g / r.stress for g, r in zip(sigma_FG, roots, strict=True)),
    }


@cache
def rated_meshes() -> dict[str, RatedMesh]:
    """All meshes with printed ratings, by name.

    Returns
    -------
    dict
        Those of the NREL 5 MW gearbox, and example 1 of ISO/TR 6336-30.
    """
    table = yaml.safe_load((files(__package__) / "rated_gears.yaml").read_text(encoding="utf-8"))
    return {name: _mesh(name, data) for name, data in table.items()}


def _mesh(name: str, data: dict[str, Any]) -> RatedMesh:
    mm = 1e-3
    helix = radians(data.get("helix", 0.0))

    def gear(number: int, shift: float) -> Gear:
        teeth, tips = data["teeth"][number], data.get("tips")
        return Gear(
            teeth,
            data["module"] * mm,
            data["width"] * mm,
            -helix if number and teeth > 0 else helix,
            shift,
            rack=Rack(1.0, data["dedendum"], data["fillets"][number]),
            tip_diameter=tips[number] * mm if tips else None,
        )

    # shifts are printed with four digits, and fit the centre distance without backlash
    first = gear(0, data["shifts"][0])
    rough = Pair(first, gear(1, data["shifts"][1]), data["distance"] * mm)
    fitted = rough.shift_sum - first.shift if data.get("fitted", True) else data["shifts"][1]
    pair = Pair(first, gear(1, fitted), data["distance"] * mm)
    own = [MATERIALS[kind] for kind in data["materials"]]
    speed = data["speed"] * RPM
    power = data.get("power_W", 0.0)
    torque = data["torque"] if "torque" in data else power / (data["shaft_speed"] * RPM)
    torque *= data.get("share", 1.0)
    life = data["hours"] * 60.0
    roughness = (data["flank_roughness"][0] * 1e-6, data["flank_roughness"][1] * 1e-6)
    turns, limits = data["turns"], data.get("deviations", (0.0, 0.0))
    return RatedMesh(
        name=name,
        pair=pair,
        materials=(own[0], own[1]),
        running=Running(torque, speed, data["viscosity"] * 1e-6, roughness, (20e-6, 20e-6)),
        cycles=(turns[0] * life, turns[1] * life),
        stiffness=(data["stiffness"][0] * 1e9, data["stiffness"][1] * 1e9),
        factors=LoadFactors(**data["factors"]),
        mass=_mass(pair, data.get("inner"), data.get("mass", "pair")),
        deviations=(limits[0] * 1e-6, limits[1] * 1e-6),
        tooth_height=data["height"] * mm,
        load_rounding=data.get("load_rounding", 0.0),
        input_rounding=data.get("input_rounding", 1e-5),
        computed_dynamics=(bool(data.get("K_v_of")), bool(data.get("K_Halpha_of"))),
        cutter=Cutter(data["cutter"]) if "cutter" in data else None,
        mean_stress=tuple(data.get("mean_stress", (1.0, 1.0))),
        printed={k: tuple(v) for k, v in data["printed"].items()},
        unmet={k: tuple(v) for k, v in data.get("unmet", {}).items()},
        reason=data.get("reason", ""),
    )


def _mass(pair: Pair, inner: list[float] | None, kind: str) -> float:
    """Reduced mass by the kind of mesh: of a pair, a sun and three planets, a planet alone."""
    if inner is None:
        return float("nan")
    one, two = (
        relative_mass(g, d * 1e-3, HARD.density)
        for g, d in zip((pair.first, pair.second), inner, strict=True)
    )
    if kind == "planet":
        return one
    return reduced_mass(one, two, 3 if kind == "sun" else 1)
