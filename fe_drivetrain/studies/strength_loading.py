"""What loads a shaft whose strength is asked for, as it is asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, LARGEST_LOAD
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.strength_options import StrengthOptions
from fe_drivetrain.turbine_loads.histories.sites import Site


@dataclass(frozen=True)
class StrengthLoading:
    """Loads of a shaft as they are asked for; see `strength`.

    Attributes
    ----------
    files : sequence of Path
        Hub loads.
    site : Site or None
        Whose winds weight the files.
    hub : mapping of str to float, or None
        Constant loads of the hub by component, about the front face [N, N m].
    spectrum : sequence, or None
        Torque [N m], hours and speed [rad/s] of classes beside the constant loads.
    resume : bool
        Take what an earlier run kept of files.
    """

    files: Sequence[Path] = ()
    site: Site | None = None
    hub: Mapping[str, float] | None = None
    spectrum: Sequence[Sequence[float]] | None = None
    resume: bool = False

    def check(self, options: StrengthOptions) -> None:
        """Refuse loads that contradict each other, or are none.

        Parameters
        ----------
        options : StrengthOptions
            Choices beside them.

        Raises
        ------
        InputError
            See above.
        """
        files, hub = argument("loads"), argument("hub")
        if not self.files and self.hub is None and self.spectrum is None:
            raise InputError(
                f"strength: nothing loads the shaft: give files with {files}, or loads of the hub "
                f"with {hub}"
            )
        if self.files and (self.hub is not None or self.spectrum is not None):
            raise InputError(
                f"strength: {files} hold the loads of the hub: leave {hub} and "
                f"{argument('spectrum')} out"
            )
        if self.spectrum is not None and (self.hub or {}).get("Mx"):
            raise InputError(
                f"strength: {argument('spectrum')} has the torque of each class, and {hub} another "
                "torque Mx: leave one out"
            )
        if self.site is not None and not self.files:
            raise InputError(
                f"strength: {argument('site')} weights files of hub loads: give {files}, too"
            )
        if self.site is not None and options.hours is not None:
            raise InputError(
                f"strength: {argument('StrengthOptions.hours', options.hours)} h beside "
                f"{argument('site')}, whose years are the life asked for: leave one out"
            )

    def wrench(self) -> Floats:
        """(6,) constant loads of the hub [N, N m].

        Raises
        ------
        InputError
            A component is unknown, or no number of a load.
        """
        found = np.zeros(6)
        for name, value in (self.hub or {}).items():
            if name not in FORCES:
                raise InputError(
                    f"strength: {name!r} is no load of the hub: use {', '.join(FORCES)}"
                )
            if not abs(float(value)) < LARGEST_LOAD:
                raise InputError(
                    f"strength: {name} of the hub is {value:g} N or N m but must be below "
                    f"{LARGEST_LOAD:g}: correct it"
                )
            found[FORCES.index(name)] = float(value)
        return found
