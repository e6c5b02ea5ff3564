"""Histories of other programs, changed at random: read, or one sentence."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hub_load_tables import openfast_text
from test_results_of_programs import RUNS
from test_tables_of_others import FORMS, vectors

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded

TIMES = 12
SIGNS = b'0123456789.,;\t\n\r"#-+eE*[]()= \0\xff/:'


def matlab(folder: Path) -> Path:
    from scipy.io import savemat

    savemat(folder / "a.mat", vectors())
    return folder / "a.mat"


KINDS: dict[str, tuple[Callable[[Path], Path], ChannelMap]] = {
    "OpenFAST": (lambda folder: openfast_text(folder / "a.out"), ChannelMap()),
    "MATLAB": (matlab, ChannelMap()),
    **{kind: (write, mapping) for kind, (write, mapping, _) in RUNS.items()},
    **{form: (write, ChannelMap()) for form, write in FORMS.items()},
}


def changed(chance: random.Random, content: bytes) -> bytes:
    """The bytes of a file with some of them changed, left out, put in or repeated."""
    data = bytearray(content)
    for _ in range(chance.choice([1, 1, 2, 5])):
        place = chance.randrange(len(data)) if data else 0
        length = chance.choice([1, 2, 10, 200])
        data[place : place + chance.choice([0, length])] = chance.choice(
            [
                b"",
                bytes(chance.choices(SIGNS, k=min(length, 10))),
                bytes(data[place : place + length]) * 2,
                b"\xff\xff\xff\x7f",
                b"9" * length,
            ]
        )
        if not chance.randrange(8):
            del data[place:]
    return bytes(data)


@pytest.mark.parametrize("kind", KINDS)
def test_a_changed_history_is_read_or_one_sentence(tmp_path: Path, kind: str) -> None:
    chance, (write, mapping) = random.Random(kind), KINDS[kind]
    (tmp_path / "whole").mkdir()
    name = write(tmp_path / "whole").name
    for _ in range(TIMES):
        shutil.copytree(tmp_path / "whole", tmp_path / "changed", dirs_exist_ok=True)
        victim = chance.choice(sorted((tmp_path / "changed").iterdir()))
        victim.write_bytes(changed(chance, victim.read_bytes()))
        loads, sentence = read(tmp_path / "changed" / name, mapping)
        if loads is None:
            assert sentence.isprintable()
            assert 20 < len(sentence) < 1500
        else:
            assert np.isfinite(loads).all()
            assert loads.shape[1] == 6


def read(file: Path, mapping: ChannelMap) -> tuple[np.ndarray | None, str]:
    """The loads, or the sentence in their place."""
    try:
        with np.errstate(all="ignore"):
            return read_recorded(file, mapping).history.loads, ""
    except InputError as error:
        return None, str(error)
