"""A nose: a standing hollow beam inside the shaft's bore, with bearings between the two."""

from __future__ import annotations

from itertools import combinations

from pydantic import Field, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import Keys, Springs
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft


class NoseBearing(Keys):
    """A bearing with its inner ring on the nose and its outer ring in the shaft's bore.

    It is a spring between the mean motions of these two faces, over its width; its rings stiffen
    neither.
    """

    name: str = Field(
        pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", description="name: letters, digits, '_' and '-'"
    )
    x: float = Field(ge=-1e3, le=1e3, description="x of the centre [m]")
    width: float = Field(gt=0, le=1e3, description="width along x [m]")
    stiffness: Springs = Field(description="of the bearing, along and about x, y, z")

    @property
    def span(self) -> tuple[float, float]:
        """x of both ends of its width [m]."""
        return self.x - self.width / 2, self.x + self.width / 2


class Nose(Keys):
    """A body of revolution like the shaft, whose rear face is held, and its bearings."""

    body: Shaft
    bearings: tuple[NoseBearing, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _carries(self) -> Nose:
        for one, two in combinations(self.bearings, 2):
            gap = max(one.span[0], two.span[0]) - min(one.span[1], two.span[1])
            if gap <= LENGTH_TOLERANCE:
                raise ValueError(
                    f"bearings {one.name!r} and {two.name!r} on the nose overlap or touch: move "
                    "them apart"
                )
        return self

    def check_fits(self, shaft: Shaft) -> None:
        """Refuse a nose that does not go into the shaft's bore, or has a bearing outside of it.

        Parameters
        ----------
        shaft : Shaft
            The shaft.

        Raises
        ------
        InputError
        """
        for bearing in self.bearings:
            self.body.seat_diameter(bearing.x, bearing.width, bearing.name)
            shaft.bore_diameter(bearing.x, bearing.width, bearing.name)
        low, high = max(self.body.front, shaft.front), min(self.body.rear, shaft.rear)
        places = [x for x in (*self.body.stations, *shaft.stations) if low <= x <= high]
        for x in sorted(places):
            nose, bore = self.body.outer_radius(x), shaft.inner_radius(x)
            if nose >= bore - LENGTH_TOLERANCE:
                raise InputError(
                    f"the nose has a diameter of {2 * nose:g} m at x = {x:g} m but must be thinner "
                    f"than the shaft's bore there, {2 * bore:g} m: make it thinner or the bore "
                    "wider"
                )
