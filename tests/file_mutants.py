"""Files changed at random, as slips of the pen, broken transfers and bad programs do."""

import os
import pickle
import resource
import select
import signal
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError

#: How many mutants of each file are tried; 500 by this variable.
COUNT = int(os.environ.get("FE_DRIVETRAIN_MUTANTS", "0"))
NUMBERS = (
    *(b"nan", b"inf", b"-1", b"0", b"1e308", b"-1e308", b"5e-324", b"1e999", b"4294967296"),
    *(b"9" * 40, b"1_0", b"0x10", b"1.5.2", b"--3", b"", b"text", b"\xd9\xa1", b"1,5", b"7 7"),
)
SECONDS, MEMORY = 20, 4_000_000_000


def mutants(content: bytes, count: int, seed: int) -> Iterator[bytes]:
    """So many mutants of a file, each with one to three slips."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        changed = content
        for _ in range(1 + int(random.integers(3))):
            slip = SLIPS[int(random.integers(len(SLIPS)))]
            changed = slip(changed, random) if len(changed) > 1 else content
        yield changed


def _place(content: bytes, random: np.random.Generator) -> int:
    return int(random.integers(len(content)))


def _byte(content: bytes, random: np.random.Generator) -> bytes:
    at = _place(content, random)
    return content[:at] + bytes([int(random.integers(256))]) + content[at + 1 :]


def _cut(content: bytes, random: np.random.Generator) -> bytes:
    return content[: _place(content, random)]


def _span(content: bytes, random: np.random.Generator) -> bytes:
    at, length = _place(content, random), int(random.integers(1, 200))
    return content[:at] + content[at + length :]


def _repeated(content: bytes, random: np.random.Generator) -> bytes:
    at, length = _place(content, random), int(random.integers(1, 400))
    return content[: at + length] + content[at : at + length] + content[at + length :]


def _line(content: bytes, random: np.random.Generator) -> bytes:
    lines = content.split(b"\n")
    at = int(random.integers(len(lines)))
    kind = int(random.integers(3))
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, lines[at])
    else:
        other = int(random.integers(len(lines)))
        lines[at], lines[other] = lines[other], lines[at]
    return b"\n".join(lines)


def _number(content: bytes, random: np.random.Generator) -> bytes:
    """Another number in the place of one."""
    at = _place(content, random)
    digits = b"0123456789.-+eEdD"
    while at < len(content) and content[at] not in b"0123456789":
        at += 1
    end = at
    while end < len(content) and content[end] in digits:
        end += 1
    while at and content[at - 1] in digits:
        at -= 1
    return content[:at] + NUMBERS[int(random.integers(len(NUMBERS)))] + content[end:]


SLIPS = (_byte, _cut, _span, _repeated, _line, _line, _number, _number, _number)


def outcome(work: Callable[[], Any]) -> tuple[str, Any]:
    """What becomes of reading in a process of its own, as files of others are read.

    Returns
    -------
    fate : str
        "read" with what was returned, "refused" with the sentence, "ended" with the signal or
        where memory ran out, or "failed" with what else was raised.
    """
    receive, send = os.pipe()
    if (child := os.fork()) == 0:
        os.close(receive)
        _work_alone(work, send)
    os.close(send)
    said = b""
    while True:  # wall time: processor time is limited by the process itself
        if not select.select([receive], [], [], 15 * SECONDS)[0]:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            os.close(receive)
            return "failed", f"took more than {15 * SECONDS} s"
        if not (part := os.read(receive, 1 << 20)):
            break
        said += part
    os.close(receive)
    status = os.waitpid(child, 0)[1]
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return ("failed" if number == signal.SIGXCPU else "ended"), signal.Signals(number).name
    found: tuple[str, Any] = pickle.loads(said)
    return found


def _work_alone(work: Callable[[], Any], send: int) -> None:
    """Do the work within limits, in the forked process, and end it."""
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nothing, stream)
    for number in (signal.SIGPROF, signal.SIGXCPU, signal.SIGSEGV, signal.SIGABRT):
        signal.signal(number, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    try:
        found = ("read", work())
    except InputError as error:
        found = ("refused", str(error))
    except MemoryError:
        found = ("ended", "memory")
    except BaseException as error:
        found = ("failed", f"{type(error).__name__}: {error}")
    with os.fdopen(send, "wb") as pipe:
        pipe.write(pickle.dumps(found))
    os._exit(0)
