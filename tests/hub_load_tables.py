"""A small history as many programs write it: what readers of files are tried on."""

from pathlib import Path

import numpy as np

TIME = 0.5 * np.arange(24)
"""(n,) [s]."""

_PHASE = 0.6 * np.arange(24)

COLUMNS = {
    "RotSpeed": ("rpm", 12.0 + np.zeros(24)),
    "Wind1VelX": ("m/s", 9.0 + np.sin(_PHASE)),
    "RotThrust": ("kN", 200.0 + 20.0 * np.sin(0.5 * _PHASE)),
    "RotTorq": ("kN-m", 1000.0 + 50.0 * np.sin(0.25 * _PHASE)),
    "LSShftFys": ("kN", 5.0 + 2.0 * np.sin(0.7 * _PHASE)),
    "LSShftFzs": ("kN", -300.0 + 10.0 * np.cos(_PHASE)),
    "LSSTipMys": ("kN-m", 300.0 * np.sin(_PHASE)),
    "LSSTipMzs": ("kN-m", 200.0 * np.cos(_PHASE)),
}
"""Unit and values (n,) by channel of OpenFAST."""

OF_LOADS = ("RotThrust", "LSShftFys", "LSShftFzs", "RotTorq", "LSSTipMys", "LSSTipMzs")
"""Channels of Fx, Fy, Fz, Mx, My, Mz."""

LOADS = np.column_stack([1e3 * COLUMNS[name][1] for name in OF_LOADS])
"""(n, 6) [N, N m]."""

NAMES = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")


def openfast_text(
    path: Path,
    units: dict[str, str] | None = None,
    cells: dict[tuple[int, str], str] | None = None,
    columns: dict[str, tuple[str, np.ndarray]] | None = None,
    before: int = 6,
) -> Path:
    """A .out, with other units, and with other cells by sample and channel."""
    shown = COLUMNS if columns is None else columns
    names = ["Time", *shown]
    heads = ["s", *(unit for unit, _ in shown.values())]
    own = {} if units is None else units
    lines = [*[""] * before, "\t".join(names)]
    lines.append("\t".join(f"({own.get(n, u)})" for n, u in zip(names, heads, strict=True)))
    for k, time in enumerate(TIME):
        row = {"Time": time, **{name: values[k] for name, (_, values) in shown.items()}}
        written = {name: f"{value:.9E}" for name, value in row.items()}
        written |= {name: text for (sample, name), text in (cells or {}).items() if sample == k}
        lines.append("\t".join(written[name] for name in names))
    path.write_text("\n".join(lines) + "\n")
    return path


def table_cells(form: str = "{:.9g}") -> list[list[str]]:
    """Rows of time [s], forces [kN] and moments [kN m] as text."""
    return [
        [f"{t:g}", *(form.format(v) for v in row)]
        for t, row in zip(TIME, 1e-3 * LOADS, strict=True)
    ]


def swinging_loads(path: Path, seconds: float) -> Path:
    """A .csv of loads that swing once in ten seconds, and the rotor's speed."""
    time = np.arange(0.0, seconds, 0.5)
    swing = np.sin(2 * np.pi * time / 10.0)
    mean = np.array([2e5, 0.0, -3e5, 9e5, 0.0, 0.0])
    each = mean + np.outer(swing, [5e4, 1e3, 1e4, 0.0, 6e5, 1e5])
    names = [f"{name} [{'N' if k < 3 else 'N m'}]" for k, name in enumerate(NAMES)]
    header = ",".join(["time [s]", *names, "RotSpeed [rpm]"])
    table = np.column_stack([time, each, np.full(len(time), 15.0)])
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")
    return path
