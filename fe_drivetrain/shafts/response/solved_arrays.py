"""Arrays that were solved of a scene, taken from the cache where they were solved before."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.kept_time import count_kept
from fe_drivetrain.common.provenance import source_hash
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.cached import solved_content
from fe_drivetrain.shafts.response.solution_keys import solved_by

_SECONDS = "seconds that it took"


def kept_arrays(
    scene: Scene,
    content: Mapping[str, Any],
    rooms: Mapping[str, Set[str] | None],
    solve: Callable[[], Mapping[str, NDArray[Any]]],
    cache: Cache | None = None,
) -> dict[str, NDArray[Any]]:
    """What was solved of a scene before, or is now.

    Parameters
    ----------
    scene : Scene
        The scene, with the sizes of its mesh.
    content : Mapping[str, Any]
        What else the arrays depend on, as plain data.
    rooms : Mapping
        Whose sources they depend on beside those of `solved_by`, as of `source_hash`.
    solve : callable
        Makes the arrays, by name.
    cache : Cache or None
        Where they may come from; the user's if not given.

    Returns
    -------
    dict[str, ndarray]
        The same to the last bit, with the same layout in memory, whether kept or solved now.
    """
    (arrays,) = kept_together(scene, [content], rooms, lambda: [solve()], cache)
    return arrays


def kept_together(
    scene: Scene,
    contents: Sequence[Mapping[str, Any]],
    rooms: Mapping[str, Set[str] | None],
    solve: Callable[[], Iterable[Mapping[str, NDArray[Any]]]],
    cache: Cache | None = None,
    depends: Mapping[str, Any] | None = None,
) -> list[dict[str, NDArray[Any]]]:
    """`kept_arrays` of several contents that are solved together, where one of them is missing.

    The wall time of each is kept, too, and counted when it is read (`kept_time.working_time`).

    Parameters
    ----------
    scene : Scene
        Scene, see `kept_arrays`.
    contents : Sequence
        What else each depends on.
    rooms : Mapping
        Rooms, see `kept_arrays`.
    solve : callable
        Makes the arrays of each, by name, one after the other or all at once.
    cache : Cache or None
        Cache, see `kept_arrays`.
    depends : Mapping[str, Any] or None
        What of the scene they depend on; `solved_content` if not given.

    Returns
    -------
    list of dict
        Arrays of each content.
    """
    used = user_cache() if cache is None else cache
    common = {
        "scene": solved_content(scene) if depends is None else depends,
        "sizes": scene.mesh.model_dump(mode="json"),
        "made by": solved_by(),
        "code": source_hash(rooms),
    }
    whole = [{**content, **common} for content in contents]
    with used.one_at_a_time("solutions", whole[0]):
        found = [used.load("solutions", content) for content in whole]
        kept = [arrays for arrays in found if arrays is not None]
        if len(kept) == len(found):
            for arrays in kept:
                count_kept(float(arrays.pop(_SECONDS)))
            return kept
        solved = []
        for content, (arrays, seconds) in zip(whole, _timed(solve), strict=True):
            used.keep("solutions", content, {**arrays, _SECONDS: np.array(seconds)})
            solved.append(arrays)
    return solved


def _timed(
    solve: Callable[[], Iterable[Mapping[str, NDArray[Any]]]],
) -> Iterator[tuple[dict[str, NDArray[Any]], float]]:
    """Arrays of each content, and the wall time from the one before to it [s]."""
    start = time.perf_counter()
    for each in solve():
        arrays = {name: np.array(a, order="C") for name, a in each.items()}
        yield arrays, time.perf_counter() - start
        start = time.perf_counter()
