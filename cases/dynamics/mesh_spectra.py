"""Spectra of mesh forces: lines, and sidebands beside them."""

from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page

PADDED = 16
"""Length of the spectrum over that of the signal."""


class Spectrum(NamedTuple):
    """Frequencies [Hz], sizes, and what the time resolves [Hz]."""

    frequencies: Floats
    size: Floats
    resolution: float

    def peak(self, begin: float, end: float) -> float:
        """Frequency of the largest size between two [Hz]."""
        near = (self.frequencies > begin) & (self.frequencies < end)
        return float(self.frequencies[near][self.size[near].argmax()])

    def sidebands(self, line: float, begin: float, end: float) -> tuple[float, float]:
        """Largest peaks below and above a line, between two distances from it [Hz]."""
        return self.peak(line - end, line - begin), self.peak(line + begin, line + end)

    def beside(self, line: float, width: float, name: str) -> Any:
        """Curve of the sizes beside a line, over that of the line; line and width in Hz."""
        near = np.abs(self.frequencies - line) < width
        size = self.size / self.size[near].max()
        return trace(name, self.frequencies[near], np.maximum(size[near], 1e-5))


def spectrum_of(values: Floats, dt: float) -> Spectrum:
    """With Hann's window."""
    swing = (values - values.mean()) * np.hanning(len(values))
    length = PADDED * len(values)
    size = np.abs(np.fft.rfft(swing, length))
    frequency = np.asarray(np.fft.rfftfreq(length, dt), dtype=np.float64)
    return Spectrum(frequency, size, 1.0 / (dt * len(values)))


def check_distances(
    page: Page,
    run: str,
    line: float,
    peaks: tuple[float, float],
    expected: float,
    resolution: float,
    source: str,
) -> None:
    """Check how far the sidebands below and above are from a mesh line [Hz]."""
    for side, at in zip(("below", "above"), peaks, strict=True):
        page.equals(
            f"{run}: sideband {side} the mesh line, distance from it [Hz]",
            abs(at - line),
            expected,
            within=resolution,
            relative=False,
            why="one over the time of the signal",
            source=source,
            measure="frequency",
            basis="self-consistency",
        )
