"""Kept files of each kind, each bit of which may turn: what is read is what was written, or made
again.
"""

import logging
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import astuple, replace
from functools import partial
from pathlib import Path
from typing import Any, get_args

import numpy as np

from fe_drivetrain.bearing_life.life import LifeRules
from fe_drivetrain.cases import case
from fe_drivetrain.common import CACHE_VARIABLE, Floats, silent
from fe_drivetrain.common.array_records import as_arrays
from fe_drivetrain.common.cache import Kind
from fe_drivetrain.common.kept_files import UnfitError, read_kept
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.mesh import cached_mesh
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.uncertainty.kept_rows import evaluated_rows
from fe_drivetrain.studies import GearOptions, StrengthOptions
from fe_drivetrain.studies.gear_spectra import Reading as GearReading
from fe_drivetrain.studies.gear_spectra import file_spectrum
from fe_drivetrain.studies.life_digest import Reading
from fe_drivetrain.studies.life_digest import kept_digest as life_digest
from fe_drivetrain.studies.load_digest import LoadOptions
from fe_drivetrain.studies.load_reactions import kept_digest as loads_digest
from fe_drivetrain.studies.rolling_bearings import Choices, bearings_of
from fe_drivetrain.studies.strength_sections import strength_shaft
from fe_drivetrain.studies.strength_sums import file_sums
from fe_drivetrain.turbine_loads.hub_loads import Condition, hub_load_set, write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES

#: Bits turned in the file of each kind.
FLIPS, QUICK_FLIPS = 2048, 64

SHAFT = Shaft(front=0.0, sections=(Section(length=0.6, outer_diameter=0.3, inner_diameter=0.1),))
WIND = Condition(12.0, "low", 0.2, 1)
DURATION, RATE = 20.0, 10.0  # s, Hz
SCENE, ENTRY = "main_bearing_bonded", "bearing_s_o20"
STEEL = {"steel": "quenched and tempered", "tensile_strength": 7.5e8, "yield_strength": 5.5e8}

FATES = "What became of bits turned in kept files: noticed, or read with another value"
COUNTED = "counted: a damage is noticed, or what is read is compared with what was written, bit by "
COUNTED += "bit"


class Maker:
    """Results of each kind, as a user's commands make them or take them from the cache.

    Parameters
    ----------
    run : Run
        Keeps figures.
    folder : Path
        Where files of loads are put.
    other : bool
        Whether results are those of another input.
    """

    def __init__(self, run: Run, folder: Path, other: bool = False) -> None:
        self.run = run
        self.wind = replace(WIND, seed=2) if other else WIND
        self.shaft = SHAFT.model_copy(update={"front": 0.1}) if other else SHAFT
        self.loads = folder / f"loads_{int(other)}.csv"
        write_hub_loads(hub_load_set([self.wind], DURATION, RATE, cache=False)[0], self.loads)

    def mesh(self) -> Any:
        """Points and cells of a small shaft."""
        sizes = MeshSizes(shaft=0.15, elements_per_turn=8)
        mesh = cached_mesh(self.shaft, [], {}, sizes, frozenset())
        return mesh.points.tobytes(), mesh.cells.tobytes()

    def hub_loads(self) -> Any:
        """A short history."""
        return hub_load_set([self.wind], DURATION, RATE).loads.tobytes()

    def samples(self) -> Any:
        """Results of an uncertain value."""
        rows = np.linspace(1.0, 2.0, 50)[:, None] * self.wind.seed
        found = evaluated_rows(rows, _squared, {"of": "a case"})
        return {name: values.tobytes() for name, values in found.items()}

    def figures(self) -> Any:
        """Plain data of a case."""
        return self.run.kept({"of": self.wind.seed}, partial(_figures, self.wind.seed))

    def counted_loads(self) -> Any:
        """The digest of a file by `loads`."""
        options = LoadOptions(slopes=(3.0, 10.0), rotor_speed_rpm=15.0)
        found = loads_digest(silent, self.loads, options, resume=True)
        return {name: array.tobytes() for name, array in as_arrays(found).items()}

    def damage(self) -> Any:
        """The digest of a file by `life`."""
        scene = library_scene(SCENE)
        choices = Choices({"main_bearing": ENTRY}, (), True, "rollers", "rigid", True)
        (one,) = bearings_of(scene, choices)
        reading = Reading(OWN_NAMES, 0.0, 20, 12.0)
        found = life_digest(
            silent, self.loads, one, LifeRules(), reading, scene, choices, resume=True
        )
        return [np.asarray(value).tobytes() for value in astuple(found)[1:]]

    def torque_spectrum(self) -> Any:
        """The spectrum of a file by `gears`."""
        reading = GearReading(GearOptions(rotor_speed_rpm=12.0), 1e5, None)
        found = file_spectrum(silent, self.loads, reading, resume=True)
        return {name: array.tobytes() for name, array in as_arrays(found).items()}

    def stress_cycles(self) -> Any:
        """What `strength` sums up of a file."""
        options = StrengthOptions(
            rotor_speed_rpm=12.0, housings=False, elastic=False, weight=False, points=4
        )
        scene = change_scene(library_scene(SCENE), {"strength": STEEL})
        assert isinstance(scene, Scene)
        shaft = strength_shaft(scene, options, Steps(silent))
        found = file_sums(silent, self.loads, shaft.model, options, shaft.content, resume=True)
        return {name: array.tobytes() for name, array in as_arrays(found).items()}

    def by_kind(self) -> dict[Kind, Callable[[], Any]]:
        """What makes each kind of kept file."""
        return {
            "figures": self.figures,
            "gear-spectra": self.torque_spectrum,
            "hub-loads": self.hub_loads,
            "life-digests": self.damage,
            "load-digests": self.counted_loads,
            "meshes": self.mesh,
            "shaft-strength": self.stress_cycles,
            "solutions": self.samples,
        }


def _squared(row: Floats) -> dict[str, float]:
    return {"square": float(row[0] ** 2), "root": float(np.sqrt(row[0]))}


def _figures(seed: int) -> list[float]:
    return [seed / (k + 1) for k in range(200)]


class Remarks(logging.Handler):
    """What the cache says."""

    def __init__(self) -> None:
        super().__init__(logging.INFO)
        self.said: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Take a remark."""
        self.said.append(record.getMessage())


@contextmanager
def own_cache(folder: Path) -> Iterator[Remarks]:
    """A cache of its own in here, and what is said of it."""
    before, log, remarks = os.environ.get(CACHE_VARIABLE), _log(), Remarks()
    level = log.level
    os.environ[CACHE_VARIABLE] = str(folder)
    log.addHandler(remarks)
    log.setLevel(logging.INFO)
    try:
        yield remarks
    finally:
        log.removeHandler(remarks)
        log.setLevel(level)
        if before is None:
            del os.environ[CACHE_VARIABLE]
        else:
            os.environ[CACHE_VARIABLE] = before


def _log() -> logging.Logger:
    return logging.getLogger("fe_drivetrain.common.cache")


def flipped(file: Path, count: int, rng: np.random.Generator) -> Record:
    """Turn single bits, half of them in what is before the data."""
    kind, content = file.parent.name, file.read_bytes()
    start, digest, _, key, _ = content.split(b"\n", 4)
    sound = _as_bytes(read_kept(file, kind, key.decode()))
    head = len(start) + 1 + len(digest) + 1 + int(digest.split()[1])
    ends = np.where(np.arange(count) % 2, head, len(content))
    noticed = wrong = 0
    with file.open("r+b") as stream:
        for place in rng.integers(0, 8 * ends).tolist():
            at, turned = place // 8, content[place // 8] ^ 1 << place % 8
            _write(stream, at, turned)
            try:
                wrong += _as_bytes(read_kept(file, kind, key.decode())) != sound
            except UnfitError:
                noticed += 1
            _write(stream, at, content[at])
    return {
        "kind": kind,
        "bytes of the file": len(content),
        "bits turned": count,
        "noticed": noticed,
        "read with another value": wrong,
    }


def _write(stream: Any, at: int, byte: int) -> None:
    stream.seek(at)
    stream.write(bytes([byte]))
    stream.flush()


def _as_bytes(arrays: dict[str, Any]) -> list[tuple[str, bytes]]:
    return [(name, array.tobytes()) for name, array in arrays.items()]


def damages(content: bytes, others: dict[str, bytes]) -> dict[str, bytes]:
    """Files that are put in the place of a sound one, by what happened to it."""
    as_it_was = b"fe-drivetrain kept file 0000" + content[content.index(b"\n") :]
    half = content[: len(content) // 2]
    return {"cut off": half, "empty": b"", "another version": as_it_was, **others}


def made_again(
    make: Callable[[], Any], file: Path, others: dict[str, bytes], said: list[str]
) -> list[Record]:
    """What a user gets who finds a damaged file of one kind, or another one in its place."""
    content, value = file.read_bytes(), make()
    rows = []
    for damage, put in damages(content, others).items():
        file.write_bytes(put)
        said.clear()
        same = make() == value
        rows.append(
            {
                "kind": file.parent.name,
                "in the place of the file": damage,
                "the same value": same,
                "said": len(said) == 1 and file.name in said[0],
                "kept again": file.read_bytes() == content,
            }
        )
    return rows


def experiment(run: Run, folder: Path, flips: int) -> tuple[list[Record], list[Record]]:
    """Rows of turned bits, and of files that were exchanged or damaged."""
    (folder / "others").mkdir()
    kinds = get_args(Kind)
    with own_cache(folder / "others"):
        others = Maker(run, folder, other=True).by_kind()
        for kind in kinds:
            others[kind]()
    foreign = {kind: _only(folder / "others" / kind).read_bytes() for kind in kinds}
    turned, exchanged = [], []
    rng = np.random.default_rng(0)
    with own_cache(folder / "own") as remarks:
        make = Maker(run, folder).by_kind()
        for k, kind in enumerate(kinds):
            make[kind]()
            file = _only(folder / "own" / kind)
            with run.step(f"bits of {kind}"):
                turned.append(flipped(file, flips, rng))
            with run.step(f"damaged {kind}"):
                put = {
                    "one of another input": foreign[kind],
                    "one of another kind": foreign[kinds[k - 1]],
                }
                exchanged += made_again(make[kind], file, put, remarks.said)
    return turned, exchanged


def _only(folder: Path) -> Path:
    (file,) = folder.iterdir()
    return file


def answer(page: Page, turned: list[Record], exchanged: list[Record]) -> None:
    """State how many damages of kept files gave another value."""
    count, noticed = sum(column(turned, "bits turned")), sum(column(turned, "noticed"))
    wrong = sum(column(turned, "read with another value"))
    other = sum(not row["the same value"] for row in exchanged)
    page.answer(
        "Can a damaged cache file give a wrong result?",
        f"{'Yes' if wrong + other else 'No'}: of {formatted(count)} flipped bits and "
        f"{len(exchanged)} truncated or exchanged cache files, {wrong + other} gave another value; "
        "the program makes damaged files again.",
        [
            page.value("flipped bits that gave another value", wrong, at_most=0),
            page.value("damaged files that gave another value", other, at_most=0),
            page.value("flipped bits that were noticed", noticed, at_least=count),
            page.value("kinds of cache files that were damaged", len(turned)),
        ],
        hero=FATES,
        cautions=["Bits are drawn at random, in one file of each kind."],
    )


@case(
    "Kept files with turned bits, cut off, or exchanged: never another value",
    source="NIST FIPS 180-4, Secure Hash Standard (SHA-256)",
)
def run(run: Run, page: Page) -> None:
    """Damage one file of each kind bit by bit and whole, and compare what comes of it."""
    with tempfile.TemporaryDirectory() as name:
        turned, exchanged = experiment(run, Path(name), QUICK_FLIPS if run.quick else FLIPS)
    count = sum(column(turned, "bits turned"))
    page.vanishes(
        f"{count} bits turned in files of {len(turned)} kinds: read with another value",
        sum(column(turned, "read with another value")),
        within=0.0,
        why="one wrong value that is believed is one too many",
        source=COUNTED,
    )
    for what, means in (
        ("the same value", "what is found in the place of a kept file is not believed"),
        ("said", "with -v a user learns why something took longer"),
        ("kept again", "the next run need not make it again"),
    ):
        page.holds(
            f"{len(exchanged)} files cut off, empty, of another version, input or kind: {what}",
            all(column(exchanged, what)),
            why=means,
            source=COUNTED,
        )
    answer(page, turned, exchanged)
    page.section("Turned bits")
    fates = ("noticed", "read with another value")
    by_kind = {fate: {row["kind"]: row[fate] for row in turned} for fate in fates}
    page.add(bars(FATES, by_kind, "bits turned", stacked=True))
    page.table("One file of each kind", turned)
    page.text(
        "Half of the bits are in the lines before the data, which hold the key and the layout. A "
        "file holds its whole key, and SHA-256 of key, layout and data, which are compared when it "
        "is read: also a file that is sound, but of something else, is not taken."
    )
    page.section("Damaged and exchanged files")
    page.table("What comes of each", exchanged)
    page.data("turned", turned)
    page.data("exchanged", exchanged)
