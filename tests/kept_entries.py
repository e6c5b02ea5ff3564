"""What is in kept files, whatever their key, and other things written under the same key."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from fe_drivetrain.common.kept_files import read_kept, write_kept


def kind_and_key(file: Path) -> tuple[str, str]:
    _, _, layout, key, _ = file.read_bytes().split(b"\n", 4)
    return json.loads(layout)["kind"], key.decode()


def entry(file: Path) -> dict[str, NDArray[Any]]:
    return read_kept(file, *kind_and_key(file))


def rewrite(file: Path, arrays: Mapping[str, NDArray[Any]]) -> None:
    kind, key = kind_and_key(file)
    with file.open("wb") as stream:
        write_kept(stream, kind, key, arrays)
