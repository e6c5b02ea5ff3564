"""What a run depended on, so that it can be repeated."""

import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from fe_drivetrain.common.provenance import program_commit, program_hash
from fe_drivetrain.report.results import Environment

_PACKAGES = (
    "fe-drivetrain",
    "scikit-fem",
    "gmsh",
    "meshio",
    "numpy",
    "scipy",
    "pypardiso",
    "pyvista",
    "plotly",
    "openfast-io",
)


def environment(
    settings: Mapping[str, Any], seed: int | None = None, quick: bool = False, command: str = ""
) -> Environment:
    """Date, platform, versions, the user's settings, and what to type."""
    return Environment(
        date=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        python=platform.python_version(),
        platform=f"{platform.system()} {platform.machine()}",
        versions=dict(_versions()),
        settings=dict(settings),
        seed=seed,
        quick=quick,
        code=program_hash(),
        commit=program_commit(),
        command=command,
    )


@lru_cache(maxsize=1)
def _versions() -> dict[str, str]:
    """Versions of the installed packages, read once: their files do not change meanwhile."""
    found = {}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
