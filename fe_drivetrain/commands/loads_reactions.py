"""Bearing reactions of a scene in the page of ``loads``: how they are made, and their section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fe_drivetrain.commands.loads_counts import equivalent
from fe_drivetrain.commands.loads_digest import (
    CHANNELS,
    LOADS,
    UNITS,
    Digest,
    Options,
    digest,
)
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.fidelity.ladder import LevelModel, assembly_level, shaft_level
from fe_drivetrain.fidelity.over_loads import ROUND_OFF, reaction_history
from fe_drivetrain.histories.spectra import MULTIPLES, SEGMENT
from fe_drivetrain.histories.windows import COLUMNS
from fe_drivetrain.hub_loads.histories import LoadHistory
from fe_drivetrain.hub_loads.recorded import Recorded
from fe_drivetrain.report.charts import trace
from fe_drivetrain.response.cached import whole_content
from fe_drivetrain.response.entering import entering
from fe_drivetrain.response.stated import Stated, stated_reactions
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

OF_REACTIONS = ("reactions", "reaction_loops")
"""Names of the tables of a scene's reactions."""

OTHER = "channel "
"""Before the name of a part that is another channel of the files."""

ALONE = "Fx"
"""Under which its digest has that channel, which is no vector; all else is zero."""

_BETWEEN = " / "  # name of a part, and of what a digest has of it


@dataclass(frozen=True, eq=False)
class SceneReactions:
    """Reactions of a scene to hub loads, all weights included.

    Attributes
    ----------
    scene : Scene
        The scene.
    model : LevelModel
        What solved it for unit loads.
    """

    scene: Scene
    model: LevelModel

    @property
    def names(self) -> list[str]:
        """Names of bearings, and "gearbox"; without those that hold nothing."""
        return [name for name, R in self.model.reaction_matrices.items() if np.nan_to_num(R).any()]

    @property
    def stated(self) -> Stated:
        """What the reactions are."""
        mass = sum(float(R[2, 8]) for R in self.model.reaction_matrices.values())
        return stated_reactions(self.scene, {"shaft, rings and housings": mass})

    def content(self) -> dict[str, Any]:
        """All that reactions depend on."""
        return {"scene": whole_content(self.scene), "level": self.model.level}

    def of(self, history: LoadHistory) -> dict[str, Floats]:
        """Each reaction to a history, (n, 6) [N, N m], moments about the bearing's centre.

        Parameters
        ----------
        history : LoadHistory
            Its moments are about the point that the scene states.

        Raises
        ------
        InputError
            It has loads at a point that the scene does not have.
        """
        driving, weight = entering(self.scene, history), self.scene.gearbox.weight
        found = {n: reaction_history(self.model, n, driving, weight, GRAVITY) for n in self.names}
        size = max(float(np.abs(values).max()) for values in found.values())
        # what a support does not hold is round-off, and no load
        return {n: np.where(np.abs(v).max(0) > ROUND_OFF * size, v, 0.0) for n, v in found.items()}


def scene_reactions(scene: Scene, level: int) -> SceneReactions:
    """Solve a scene for unit loads.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        1, a beam on rigid housings; 4, the assembly of solids.
    """
    return SceneReactions(scene, shaft_level(scene, 1) if level == 1 else assembly_level(scene))


def digest_with_reactions(
    found: Recorded, options: Options, reactions: SceneReactions | None
) -> Digest:
    """The digest of a file, those of each reaction to it, and of other channels, by name.

    Parameters
    ----------
    found : Recorded
        The history.
    options : Options
        How it is counted.
    reactions : SceneReactions, optional
        Of a scene.
    """
    result = digest(found, options)
    for name, loads in {} if reactions is None else reactions.of(found.history).items():
        history = LoadHistory(found.history.name, found.history.time, loads)
        one = digest(Recorded(history, found.rotor_speed, found.wind_speed), options)
        result |= {f"{name}{_BETWEEN}{key}": values for key, values in one.items()}
    for name, values in found.others.items():
        alone = np.zeros_like(found.history.loads)
        alone[:, LOADS.index(ALONE)] = values
        history = LoadHistory(found.history.name, found.history.time, alone)
        plain = replace(options, ultimate={})
        one = digest(Recorded(history, found.rotor_speed, found.wind_speed), plain)
        result |= {f"{OTHER}{name}{_BETWEEN}{key}": values for key, values in one.items()}
    return result


def parts(found: Digest) -> dict[str, Digest]:
    """Digests of the hub loads, under "", of each reaction, and of other channels.

    Parameters
    ----------
    found : Digest
        Of `digest_with_reactions`.
    """
    result: dict[str, Digest] = {}
    for key, values in found.items():
        name, between, own = key.rpartition(_BETWEEN)
        result.setdefault(name if between else "", {})[own] = values
    return result


def reactions_section(
    page: Page, found: Mapping[str, Together], options: Options, of: SceneReactions, rule: str
) -> dict[str, list[Record]]:
    """Add the section; the table that goes to a file.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    found : mapping
        All files together, by reaction.
    options : Options
        How they were counted.
    of : SceneReactions
        What solved the scene.
    rule : str
        How cycles were counted.
    """
    model = of.model
    page.section("Bearing reactions")
    page.text(
        f"{model.title}"
        + (f"; left out: {'; '.join(model.neglects)}. " if model.neglects else ". ")
        + of.stated.sentences()
    )
    rows: list[Record] = []
    loops: list[Record] = []
    for name, one in found.items():
        rows += _statistics(name, one, options)
        loops += _loops(name, one)
    page.table(
        f"Reactions over all files; DEL: damage-equivalent load at {options.frequency:g} Hz; "
        f"{rule}",
        rows,
    )
    page.table("Load loops of reactions, across the shaft", loops)
    for chosen, unit in ((("Fy", "Fz"), "kN"), (("My", "Mz"), "kN m")):
        traces = _spectra(found, chosen)
        if traces:
            page.chart(
                f"Power spectral density of {' and '.join(chosen)} of each reaction, segments of "
                f"{SEGMENT:g} s",
                traces,
                "frequency [Hz]",
                f"density [({unit})²/Hz]",
                "xy",
            )
    page.data("reactions", rows)
    page.data("reactions_stated", of.stated.facts())
    return dict(zip(OF_REACTIONS, (rows, loops), strict=True))


def others_section(
    page: Page, found: Mapping[str, Together], options: Options, rule: str
) -> dict[str, list[Record]]:
    """Add the section of other channels; the tables that go to files.

    Parameters
    ----------
    page : Page
        Takes the table.
    found : mapping
        All files together, by name of the part.
    options : Options
        How they were counted.
    rule : str
        How cycles were counted.
    """
    if not found:
        return {}
    page.section("Other channels")
    slopes = np.array(options.slopes, dtype=float)
    place = LOADS.index(ALONE)
    rows: list[Record] = []
    windows: list[Record] = []
    for part, one in found.items():
        assert one.damage is not None
        name = part.removeprefix(OTHER)
        loads = equivalent(one.damage, one.seconds, slopes, options.frequency)[place]
        row: Record = {"channel": name}
        row |= dict(zip(COLUMNS, one.overall()[place].tolist(), strict=True))
        row |= {f"DEL, m = {m:g}": v for m, v in zip(options.slopes, loads.tolist(), strict=True)}
        amplitudes = one.median_multiples()
        if amplitudes is not None:
            row |= {
                f"{n}P": None if np.isnan(v) else float(v)
                for n, v in zip(MULTIPLES, amplitudes[place], strict=True)
            }
        rows.append(row)
        for window in one.windows:
            values = np.asarray(window["values"])
            wind = float(values[CHANNELS.index("wind speed"), 1])
            windows.append(
                {
                    "channel": name,
                    "file": window["file"],
                    "start [s]": float(window["start [s]"]),
                    "seconds": float(window["seconds"]),
                    "mean wind speed [m/s]": None if np.isnan(wind) else wind,
                    **dict(zip(COLUMNS, values[place].tolist(), strict=True)),
                }
            )
    page.table(
        f"In the files' units; DEL: damage-equivalent at {options.frequency:g} Hz; {rule}", rows
    )
    page.data("other_channels", rows)
    return {"other_channels": rows, "other_windows": windows}


def _statistics(name: str, found: Together, options: Options) -> list[Record]:
    assert found.damage is not None
    slopes = np.array(options.slopes, dtype=float)
    equivalents = equivalent(found.damage, found.seconds, slopes, options.frequency)
    amplitudes = found.median_multiples()
    rows: list[Record] = []
    for c, (load, unit, values) in enumerate(zip(LOADS, UNITS, found.overall(), strict=False)):
        if not np.abs(values).max() > 0.0:
            continue
        shown = "kN" if unit == "N" else "kN m"
        row: Record = {"reaction": f"{name}, {load} [{shown}]"}
        row |= {column: float(v) / 1e3 for column, v in zip(COLUMNS, values, strict=True)}
        row |= {
            f"DEL, m = {m:g}": float(v) / 1e3
            for m, v in zip(options.slopes, equivalents[c], strict=True)
        }
        if amplitudes is not None:
            row |= {
                f"{n}P": None if np.isnan(v) else float(v) / 1e3
                for n, v in zip(MULTIPLES, amplitudes[c], strict=True)
            }
        rows.append(row)
    return rows


def _loops(name: str, found: Together) -> list[Record]:
    rows: list[Record] = []
    for plane, (number, seconds, whole, over) in found.loops.items():
        if number:
            rows.append(
                {
                    "reaction": f"{name}, {plane}",
                    "loops": int(number),
                    "share of time [%]": 100.0 * float(seconds / whole),
                    "loops over blade passages (3P)": (
                        None if np.isnan(over) else float(over / whole)
                    ),
                }
            )
    return rows


def _spectra(found: Mapping[str, Together], chosen: Sequence[str]) -> list[Any]:
    traces = []
    for name, one in found.items():
        if not one.spectra:
            continue
        lines = min(one.spectra)
        total = np.asarray(sum(s[:, :lines] for s, _ in one.spectra.values()))
        density = total / sum(seconds for _, seconds in one.spectra.values()) / 1e6
        frequency = np.arange(lines) / SEGMENT
        traces += [
            trace(f"{name}, {load}", frequency[1:], density[LOADS.index(load), 1:])
            for load in chosen
            if density[LOADS.index(load), 1:].max() > 0.0
        ]
    return traces
