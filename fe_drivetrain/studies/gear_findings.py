"""What a rating of gears says: answer, figures, tables, cautions, assumptions, limits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.dynamics.bodies.condensed_rungs import SOFT_SEATS, STIFF_SEATS
from fe_drivetrain.procedure.failure_modes import GEAR_RATING
from fe_drivetrain.report.charts import bars, chart, error_bars
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.gear_answer import state_answer
from fe_drivetrain.studies.gear_answers import GearAnswer, LevelAnswer, MeshAnswer, Safety, safeties
from fe_drivetrain.studies.gear_machine import GearTrain
from fe_drivetrain.studies.gear_options import HOURS
from fe_drivetrain.studies.gear_stresses import SHARING
from fe_drivetrain.studies.machine_description import assume_housings, housings_in_words

UNREAD = (
    "ISO 6336, ISO 1328 and IEC 61400-4 were not read: equations agree with printed KISSsoft "
    "ratings of the NREL 5 MW gears, the table of K_gamma and the least safety factors are "
    "second-hand."
)
BY_QUALITY = (
    "Limits of steels by quality (ML, MQ, ME) are from memory of ISO 6336-5 and not verified: give "
    "contact_limit and root_limit in their place."
)
TORQUE_ALONE = (
    "Files have the torque without all other loads of the hub: only the rotor's weight acts beside "
    "it, in all of them."
)
_ROUND_OFF = 1e-6
_QUICK = 1.5  # K_v beyond which the load of the teeth is no longer that of the torque


def gear_chart(
    gears: Mapping[str, GearAnswer], meshes: Mapping[str, MeshAnswer], varies: bool
) -> Chart:
    """Safety factors of all gears over those required; stresses, or loads, without what they need.

    Parameters
    ----------
    gears : mapping of str to GearAnswer
        All flanks.
    meshes : mapping of str to MeshAnswer
        All meshes.
    varies : bool
        Whether safety is over a spectrum.
    """
    if not gears:
        loads = {name: float(one.along.max()) for name, one in meshes.items()}
        return bars("Largest local load of each mesh", {"load": loads}, "load over the mean [-]")
    rated = {name: safeties(one, varies) for name, one in gears.items() if one.required}
    if not rated:
        stress = {name: one.contact_stress / 1e6 for name, one in gears.items()}
        return bars("Contact stress of all gears", {"sigma_H": stress}, "sigma_H [MPa]")
    traces = [_dots(label, k, rated) for k, label in enumerate(("flanks, S_H", "roots, S_F"))]
    over = "over the spectrum" if varies else "at the reference torque"
    found = chart(
        f"Safety factors {over}, relative to those required",
        [one for one in traces if one["x"]],
        "safety factor over that required [-]",
        "",
        events={"just enough": 1.0},
    )
    found.figure["layout"] |= {
        "height": 170 + 22 * max(len(rated), 5),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
    }
    found.figure["layout"]["xaxis"]["rangemode"] = "tozero"
    return found


def _dots(label: str, number: int, rated: Mapping[str, tuple[Safety | None, ...]]) -> Any:
    """Reserves of flanks (0) or roots (1), with their bands; the factors are told on pointing."""
    shown = {name: both[number] for name, both in rated.items()}
    known = {name: one for name, one in shown.items() if one is not None}
    reserve = np.array([one.value / one.required for one in known.values()])
    band = np.array([one.band / one.required for one in known.values()])
    return {
        "type": "scatter",
        "mode": "markers",
        "name": label,
        "x": rounded(reserve),
        "y": list(known),
        "customdata": rounded([one.value for one in known.values()]),
        "hovertemplate": "%{y}: S %{customdata:.3g}, %{x:.3g} of the least<extra></extra>",
        "marker": {"size": 11, "symbol": ("circle", "diamond")[number]},
        **error_bars("x", reserve - band, reserve, reserve + band),
    }


def state_findings(
    found: Findings, train: GearTrain, left_out: Mapping[str, str], result: Mapping[str, Any]
) -> None:
    """State all that a rating of gears has found.

    Parameters
    ----------
    found : Findings
        Takes it.
    train : GearTrain
        The machine, and what the file states.
    left_out : mapping of str to str
        Why a mesh is not rated, by its name.
    result : mapping of str to object
        Fields of the result.
    """
    gears, meshes = result["gears"], result["meshes"]
    for one in gears.values():
        _gear_figures(found, one, result["varies"])
    for mesh in meshes.values():
        if len(mesh.spread.share[0]) > 1:
            found.found(f"K_gamma of {mesh.name}", mesh.spread.sharing, mesh.sharing_band)
        found.found(f"K_Hbeta of {mesh.name}", mesh.spread.face_load, mesh.face_band)
    found.data("gears", [gear_row(one, result["varies"]) for one in gears.values()])
    found.data("meshes", [mesh_row(one) for one in meshes.values()])
    found.data("levels", [level_row(one) for one in result["levels"]])
    found.data("sharing", list(_sharing_rows(meshes)))
    found.data("face", list(_face_rows(meshes)))
    found.data("ring", list(_ring_rows(gears, meshes)))
    if result["spectrum"] is not None:
        found.data("spectrum", list(_spectrum_rows(result["spectrum"])))
    _bounds(found, train, result)
    _checks(found, train, meshes)
    _cautions(found, train, left_out, result)
    _assumptions(found, train, result)
    state_answer(found, result)


def _gear_figures(found: Findings, gear: GearAnswer, varies: bool) -> None:
    S_H, S_F = safeties(gear, varies)
    rating = (GEAR_RATING,)
    if S_H is not None:
        found.found(f"S_H of {gear.name}", S_H.value, S_H.band, rating)
    if S_F is not None:
        found.found(f"S_F of {gear.name}", S_F.value, S_F.band, rating)
    if gear.life is not None and gear.bands is not None:
        band = gear.bands.damage  # none of an infinite damage, beyond the static strength
        known = band if np.isfinite(band) else None
        found.found(f"damage of {gear.name}", gear.life.damage.largest, known, rating)
    found.found(f"sigma_H of {gear.name} [MPa]", gear.contact_stress / 1e6, loads=rating)
    if gear.root_stress is not None:
        found.found(f"sigma_F of {gear.name} [MPa]", gear.root_stress / 1e6, loads=rating)


def gear_row(gear: GearAnswer, varies: bool) -> Record:
    """The record of a flank.

    Parameters
    ----------
    gear : GearAnswer
        The flank.
    varies : bool
        Whether the spectrum has several torques.
    """
    life = gear.life
    row: Record = {
        "gear": gear.name,
        "mesh": gear.mesh,
        "sigma_H [MPa]": gear.contact_stress / 1e6,
        "sigma_F [MPa]": None if gear.root_stress is None else gear.root_stress / 1e6,
        "S_H": gear.contact_safety,
        "S_F": gear.root_safety,
        "least S_H": None if gear.required is None else gear.required[0],
        "least S_F": None if gear.required is None else gear.required[1],
    }
    if varies:
        row["S_H over the spectrum"] = None if life is None else life.contact_safety
        row["S_F over the spectrum"] = None if life is None else life.root_safety
    return row | {
        "damage of the flank": None if life is None else life.damage.flank,
        "damage of the other flank": None if life is None else life.damage.back,
        "damage of the root": None
        if life is None
        else max(life.damage.root, life.damage.root_back),
        "life [h]": None if np.isnan(gear.life_hours) else gear.life_hours,
        "missing": ", ".join(gear.missing),
    }


def mesh_row(mesh: MeshAnswer) -> Record:
    """The record of a mesh.

    Parameters
    ----------
    mesh : MeshAnswer
        The mesh.
    """
    pair, K = mesh.pair, mesh.factors
    return {
        "mesh": mesh.name,
        "transverse contact ratio": None if pair is None else pair.transverse_ratio,
        "overlap ratio": None if pair is None else pair.overlap_ratio,
        "working angle [deg]": None if pair is None else float(np.degrees(pair.working_angle)),
        "torque on the first gear [kN m]": None if pair is None else mesh.torque / 1e3,
        "F_t [kN]": None if pair is None else mesh.force / 1e3,
        "K_A": K.K_A,
        "K_gamma": K.K_gamma,
        "K_v": K.K_v,
        "K_Hbeta": K.K_Hbeta,
        "K_Fbeta": K.K_Fbeta,
        "K_Halpha": K.K_Halpha,
    }


def level_row(level: LevelAnswer) -> Record:
    """The record of a level.

    Parameters
    ----------
    level : LevelAnswer
        The level.
    """
    row: Record = {
        "level": level.name,
        "time [s]": level.seconds,
        "largest difference of a contact stress from the finest [%]": 100.0 * level.difference,
    }
    for name, (sharing, face) in level.factors.items():
        row[f"K_gamma, {name}"], row[f"K_Hbeta, {name}"] = sharing, face
    return row


def _sharing_rows(meshes: Mapping[str, MeshAnswer]) -> Iterator[Record]:
    for mesh in meshes.values():
        for azimuth, shares in zip(mesh.spread.azimuths, mesh.spread.share, strict=True):
            if len(shares) > 1:
                for planet, share in enumerate(shares.tolist(), start=1):
                    yield {
                        "mesh": mesh.name,
                        "azimuth [deg]": float(np.degrees(azimuth)),
                        "planet": planet,
                        "load over the mean": share,
                    }


def _face_rows(meshes: Mapping[str, MeshAnswer]) -> Iterator[Record]:
    for mesh in meshes.values():
        along = mesh.along
        for place, load in zip(mesh.places.tolist(), along.tolist(), strict=True):
            yield {"mesh": mesh.name, "place on the face": place, "load over the mean": load}


def _ring_rows(
    gears: Mapping[str, GearAnswer], meshes: Mapping[str, MeshAnswer]
) -> Iterator[Record]:
    for gear in gears.values():
        if gear.life is not None and len(gear.life.of_teeth):
            places = np.degrees(meshes[gear.mesh].spread.azimuths).tolist()
            for place, damage in zip(places, gear.life.of_teeth.tolist(), strict=True):
                yield {"gear": gear.name, "place [deg]": place, "damage": damage}


def _spectrum_rows(spectrum: Any) -> Iterator[Record]:
    for torque, seconds, turns in zip(
        spectrum.torques.tolist(), spectrum.seconds.tolist(), spectrum.turns.tolist(), strict=True
    ):
        yield {"torque [kN m]": torque / 1e3, "time [h]": seconds / 3600.0, "turns": turns}


def _bounds(found: Findings, train: GearTrain, result: Mapping[str, Any]) -> None:
    """State what both bounds of the main bearings' housings do to the factors of all meshes."""
    levels = {one.name: one.factors for one in result["levels"]}
    if SOFT_SEATS in levels:
        soft, stiff = levels[SOFT_SEATS], levels[STIFF_SEATS]
        rows: list[Record] = [
            {
                "mesh": name,
                "K_gamma, seats averaged": soft[name][0],
                "K_gamma, seats rigid": stiff[name][0],
                "K_Hbeta, seats averaged": soft[name][1],
                "K_Hbeta, seats rigid": stiff[name][1],
            }
            for name in soft
        ]
        found.data("bounds", rows)
        most = max(soft, key=lambda name: abs(soft[name][1] - stiff[name][1]))
        found.say(
            f"Between both bounds of the main bearings' housings K_Hbeta of {most} is "
            f"{soft[most][1]:.4g} with averaged seats and {stiff[most][1]:.4g} with rigid ones; no "
            "other mesh differs by more."
        )
    if train.left_out:
        rows = [{"level or part": name, "because": why} for name, why in train.left_out.items()]
        found.data("levels left out", rows)


def _checks(found: Findings, train: GearTrain, meshes: Mapping[str, MeshAnswer]) -> None:
    """Forces of the meshes by statics against those of the torque alone."""
    apart = [abs(mesh.balance - 1.0) for mesh in meshes.values() if not np.isnan(mesh.balance)]
    if apart:
        found.vanishes(
            "forces of all meshes by statics over those of the torque, less 1",
            max(apart),
            within=_ROUND_OFF,
            why="both are of one equilibrium; round-off of springs whose stiffness differs by 1e6",
            source="torque over the base radius",
            basis="self-consistency",
        )


def _cautions(
    found: Findings, train: GearTrain, left_out: Mapping[str, str], result: Mapping[str, Any]
) -> None:
    """State what must be known before the ratings, most severe first."""
    gears, meshes = result["gears"], result["meshes"]
    keys = {key for one in gears.values() for key in one.missing}
    missing = _by_key(key for key in keys if "grade" not in key)
    if missing:
        found.note(f"The file does not state {missing}: what needs it is not rated.", first=True)
    without_grade = _by_key(key for key in keys if "grade" in key)
    if without_grade:
        found.note(f"Without {without_grade} K_v and K_Halpha are taken as 1.")
    lacking = _by_key(left_out.values())
    if lacking:
        found.note(f"The file does not state {lacking}: loads are found there, no stresses.")
    low = [
        mesh
        for mesh in meshes.values()
        if len(mesh.spread.share[0]) > 1
        and mesh.spread.sharing < SHARING.get(len(mesh.spread.share[0]), SHARING[7])
    ]
    if train.machine.not_given:
        found.note(
            f"The file does not state {', '.join(train.machine.not_given)}: load is shared by "
            "formula, not by statics.",
            first=True,
        )
    if low and result["level"] != "torsional":
        table = SHARING.get(len(low[0].spread.share[0]), SHARING[7])
        found.note(
            "Errors of the pins' places are not in the file: K_gamma is that of perfect parts, and "
            f"IEC 61400-4 takes {table:g} unless measured."
        )
    if result["level"] != "torsional":
        found.note("Flanks have no modification along the face: lead corrections are not modelled.")
        quick = {name: one.factors.K_v for name, one in meshes.items() if one.factors.K_v > _QUICK}
        if quick:
            worst = max(quick, key=lambda name: quick[name])
            found.note(
                f"K_v of {worst} is {quick[worst]:.3g}, of so little torque at this speed. Statics "
                "spread the torque without it, so that K_Hbeta of a fixed misalignment, as by the "
                "rotor's weight, is too large then: safety may seem to fall with the torque."
            )
    found.note(housings_in_words(train.rung, train.machine))
    assume_housings(found, train.rung.assumes)
    if result["varies"] and (result["spectrum"].torques < 0.0).any():
        found.note(
            "Negative torques load the other flanks, and are spread over planets and face as those "
            "of the driving sense."
        )
    if any(s.quality for one in train.strengths.values() for s in one.gears.values()):
        found.note(BY_QUALITY)
    found.note(UNREAD)


def _by_key(keys: Iterable[str]) -> str:
    """Keys of the file with the stages that lack them: "strength of stage 1, stage 2"."""
    stages: dict[str, list[str]] = {}
    for key in sorted(set(keys)):
        stage, colon, name = key.partition(": ")
        stages.setdefault(name if colon else stage, []).extend([stage] if colon else [])
    words = (f"{k} of {', '.join(of)}" if of else k for k, of in stages.items())
    return "; ".join(words)


def _assumptions(found: Findings, train: GearTrain, result: Mapping[str, Any]) -> None:
    """State what neither the file nor the user gives."""
    for row in train.machine.assumptions():
        if not row.name.endswith(": slices"):  # those of the options count
            found.assume(*row)
    for number, strength in train.strengths.items():
        for one in strength.assumptions():
            if one.is_assumed:
                found.assume(*one._replace(name=f"stage {number} strength: {one.name}"))
    found.assume("reference torque", train.torque, "N m", train.stated)
    if not result["varies"] and result["asked"].hours is None:
        found.assume("hours of the life asked for", HOURS, "h", "assumed: twenty years")
    if any(one.mesh.split()[2] != "mesh" for one in result["gears"].values()):
        found.assume("Y_M of planets", 0.7, "-", "ISO 6336-3: roots that are bent both ways")
