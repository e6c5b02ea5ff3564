"""Commands that are killed among files of others, and sent into folders of others; a program.

It is a process of its own, so that it may fork: the commands run in its children.
"""

import contextlib
import gc
import hashlib
import importlib
import json
import os
import shutil
import signal
import stat
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from fe_drivetrain.command_line import main as command
from fe_drivetrain.common import CACHE_VARIABLE, FORCES, MANIFEST, read_manifest
from fe_drivetrain.report import read_results

Entries = dict[str, tuple[int, str]]
Words = Callable[[Path], list[str]]

FAILED = 99
SCENE, LOADS, PROJECT = "my.yaml", "loads.csv", "project.yaml"
PAGES = ("advise", "uncertainty", "validate", "loads")
CASES = ("drivetrain/two_masses", "drivetrain/five_masses")

#: Words of each kind of command that writes, in a folder that has a scene, loads and a project; all
#: that it writes stands in the folder "out" or is named out.
QUICK: dict[str, Words] = {
    "run": lambda out: ["run", CASES[0], "--quick", "--out", str(out)],
    "new": lambda out: ["new", str(out.with_name("out.yaml")), "--overwrite"],
    "export": lambda out: [
        *("export", "two_bearings", "--format", "json", "--level", "1", "--overwrite"),
        *("--out", str(out.with_name("out.json"))),
    ],
}
OTHERS: dict[str, Words] = {
    "run of several": lambda out: [
        *("run", *CASES, "--quick", "--out", str(out)),
        *("--junit", str(out.with_name("out.xml"))),
    ],
    "advise": lambda out: [
        *("advise", "main_bearing_spherical", "--quantity", "main_bearing.Fz", "--out", str(out))
    ],
    "validate": lambda out: ["validate", str(out.with_name(PROJECT)), "--out", str(out)],
    "check": lambda out: ["check", str(out.with_name(SCENE)), "--out", str(out)],
    "compare": lambda out: [
        *("compare", "main_bearing_spherical", "main_bearing_bonded", "--out", str(out)),
        *("--quantity", "main_bearing.Fz"),
    ],
    "study": lambda out: ["study", str(out.with_name(SCENE)), "--quick", "--out", str(out)],
    "loads": lambda out: ["loads", str(out.with_name(LOADS)), "--out", str(out)],
    "life": lambda out: [
        *("life", str(out.with_name(SCENE)), "--loads", str(out.with_name(LOADS))),
        *("--out", str(out)),
    ],
    "uncertainty": lambda out: [
        *("uncertainty", "main_bearing_bonded_uncertain", "--level", "1", "--samples", "40"),
        *("--out", str(out)),
    ],
}
INTO_FILES = ("new", "export")


@dataclass(frozen=True)
class Found:
    """What kills and folders of others did to one kind of command.

    Attributes
    ----------
    command : str
        Its kind.
    seconds : float
        Duration of a run that nothing ends [s].
    kills, ended : int
        How many runs were to be killed, and how many of them the kill ended.
    lost : int
        After how many of them a file of others was not there, or was not what it was.
    broken : int
        After how many of them results were neither the old nor the new ones, whole.
    left : int
        Hidden files and folders after one more run.
    refused : bool
        Whether a folder of others was refused, or had nothing but the new file added to it.
    untouched : bool
        Whether all in that folder was as before.
    seen : bool
        Whether a file of others that this program takes away itself is found to be lost.
    """

    command: str
    seconds: float
    kills: int
    ended: int
    lost: int
    broken: int
    left: int
    refused: bool
    untouched: bool
    seen: bool


def add_others(folder: Path) -> Entries:
    """Files of somebody else in a folder: text, links, folders, a pipe, and their modes."""
    before = set(entries(folder))
    below = folder / "data" / "deep"
    below.mkdir(parents=True)
    (below / "empty").mkdir()
    for name, text in (("thesis.txt", "years of work"), ("data/deep/a.csv", "1,2\n")):
        (folder / name).write_text(text)
        (folder / name).chmod(0o640)
    below.chmod(0o750)
    (folder / "link").symlink_to("thesis.txt")
    (below / "up").symlink_to("../..", target_is_directory=True)
    os.mkfifo(folder / "pipe")
    return {name: entry for name, entry in entries(folder).items() if name not in before}


def entries(folder: Path) -> Entries:
    """Mode of each entry below a folder, and its content or where it leads."""
    return dict(_entries(folder))


def _entries(folder: Path) -> Iterator[tuple[str, tuple[int, str]]]:
    for path in folder.rglob("*"):
        with contextlib.suppress(FileNotFoundError):
            mode = path.lstat().st_mode
            content = os.readlink(path) if path.is_symlink() else ""
            if stat.S_ISREG(mode):
                content = hashlib.sha256(path.read_bytes()).hexdigest()
            yield str(path.relative_to(folder)), (mode, content)


def is_lost(folder: Path, others: Entries) -> bool:
    """Whether anything of others is not there, or is not what it was."""
    there = entries(folder)
    return any(there.get(name) != entry for name, entry in others.items())


def is_whole(home: Path) -> bool:
    """Whether all that the command writes is of one run: what manifests list, and files."""
    try:
        for manifest in (home / "out").glob(f"**/{MANIFEST}"):
            folder = manifest.parent
            if any(part.startswith(".") for part in folder.relative_to(home).parts):
                continue
            own = read_manifest(folder)
            if own is None or not all(own.has(name, folder / name) for name in own.files):
                return False
            if own.kind == "results":
                read_results(folder / "results.json")
        if (home / "out.json").exists():
            json.loads((home / "out.json").read_text("utf-8"))
        if (home / "out.xml").exists():
            ElementTree.parse(home / "out.xml")
        if (home / "out.yaml").exists():
            return (home / "out.yaml").read_text("utf-8").endswith("\n")
    except (OSError, ValueError, ElementTree.ParseError):
        return False
    return True


def child(words: list[str], home: Path) -> int:
    """Start a command in a child process: its number."""
    pid = os.fork()
    if pid == 0:
        status = FAILED
        try:
            os.chdir(home)
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            command(words)
        except SystemExit as end:
            status = int(end.code or 0)
        finally:
            os._exit(status)
    return pid


def ended(pid: int) -> int:
    """Exit status of a child, negative where a signal ended it."""
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def prepared(home: Path) -> None:
    """A folder with a scene, loads and a project of the user's."""
    home.mkdir(parents=True)
    for words in (["new", SCENE], ["validate", PROJECT, "--new"]):
        if ended(child(words, home)) != 0:
            raise RuntimeError(f"{' '.join(words)} failed")
    time_s = np.arange(0.0, 60.0, 0.05)
    columns = [
        size * (1.0 + 0.1 * np.sin(time_s * (k + 1)))
        for k, size in enumerate((200e3, 1e3, -400e3, 500e3, 800e3, 3e5))
    ]
    units = ("N",) * 3 + ("N m",) * 3
    titles = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    np.savetxt(
        home / LOADS,
        np.column_stack([time_s, *columns, np.full(time_s.size, 1.2)]),
        delimiter=",",
        header=",".join(["time [s]", *titles, "rotor speed [rad/s]"]),
        comments="",
    )


def killed(name: str, words: Words, home: Path, kills: int, rng: np.random.Generator) -> Found:
    """Kill a command at random moments among files of others, and send it into their folder."""
    shutil.copytree(home.with_name("prepared"), home)
    out = home / "out"
    status = ended(child(words(out), home))
    if status not in (0, 1):
        raise RuntimeError(f"{name} ended with status {status}")
    start = time.perf_counter()
    ended(child(words(out), home))
    seconds = time.perf_counter() - start
    others = add_others(home)
    if out.is_dir():
        others |= {f"out/{entry}": of for entry, of in add_others(out).items()}
    died = lost = broken = 0
    moments = rng.uniform(0.0, 1.1 * seconds, kills).tolist()
    for moment in moments:
        pid = child(words(out), home)
        time.sleep(moment)
        os.kill(pid, signal.SIGKILL)
        died += ended(pid) == -signal.SIGKILL
        lost += is_lost(home, others)
        broken += not is_whole(home)
        if moment == moments[-1] and not died and moment > 1e-3:
            moments.append(0.5 * moment)  # on a machine that has become quicker
    ended(child(words(out), home))
    lost += is_lost(home, others)
    left = sum(1 for _ in home.glob("**/.*"))
    refused, untouched = into_others(name, words, home.with_name(f"{home.name}-others"))
    (home / "data" / "deep" / "a.csv").write_text("1,3\n")
    seen = is_lost(home, others)
    return Found(name, seconds, len(moments), died, lost, broken, left, refused, untouched, seen)


def into_others(name: str, words: Words, home: Path) -> tuple[bool, bool]:
    """Run into a folder of others: whether that is refused, and whether all stays as it was."""
    shutil.copytree(home.with_name("prepared"), home)
    (home / "out").mkdir()
    add_others(home / "out" if name not in INTO_FILES else home)
    before = entries(home)
    status = ended(child(words(home / "out"), home))
    after = entries(home)
    new = {entry.partition(".")[0] for entry in after.keys() - before.keys()}
    right = new <= {"out", "scene"} if name in INTO_FILES else status == 2
    return right, all(after.get(entry) == of for entry, of in before.items())


def load(modules: Iterator[str]) -> None:
    """Import once, for all children, what commands import: their time is then that of their work.

    Programs with threads or windows of their own are left to the children.
    """
    for module in modules:
        with contextlib.suppress(Exception):
            importlib.import_module(module)


def main() -> None:
    """The experiment, in the folder and with the kills of the command line, as JSON."""
    folder, kills, names = Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]
    os.environ[CACHE_VARIABLE] = str(folder / "cache")
    kinds = {name: words for name, words in (QUICK | OTHERS).items() if name in names}
    load(f"fe_drivetrain.command_line.{name}" for name in ("run", "studies", "export"))
    load(f"fe_drivetrain.pages.{name}" for name in PAGES)
    load(f"fe_drivetrain.cases.{name.replace('/', '.')}" for name in CASES)
    load(iter(("fe_drivetrain.report.page", "fe_drivetrain.report.index", "rich.progress")))
    gc.freeze()
    rng = np.random.default_rng(20)
    prepared(folder / "prepared")
    work = [
        partial(killed, name, words, folder / name.replace(" ", "_"), kills, rng)
        for name, words in kinds.items()
    ]
    found = [asdict(one()) for one in work]
    shutil.rmtree(folder / "cache", ignore_errors=True)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
