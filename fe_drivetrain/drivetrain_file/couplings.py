"""Spline couplings of a drivetrain's file."""

from math import radians

from pydantic import Field

from fe_drivetrain.gear.slices import SLICES
from fe_drivetrain.gear.splines import Spline
from fe_drivetrain.geometry.part import Part, dimension


class SplineData(Part):
    """A spline between the two parts of a shaft, such as that of a sun and a hollow one."""

    teeth: int = Field(ge=6, le=500, description="number of teeth")
    diameter: float = dimension(of="pitch diameter", gt=0, le=20.0)
    at: float = dimension(
        0.0,
        of="x of the middle of its teeth from where the shaft begins",
        ge=0,
        source="assumed: where the shaft begins",
    )
    length: float = dimension(of="width over which teeth engage", gt=0, le=20.0)
    stiffness: float = dimension(
        1.4e10,
        of="stiffness of a pair of teeth along the normal of its flanks, for each width",
        unit="N/m^2",
        gt=0,
        le=1e14,
        source="assumed: 14 N/(mm um), as a pair of gear teeth, DIN 3990",
    )
    pressure_angle: float = dimension(
        30.0, of="pressure angle", unit="deg", ge=0, le=60, source="assumed: 30 degrees, ISO 4156"
    )
    axial: float | None = dimension(
        None,
        of="stiffness of what holds the shaft along its axis; 0 where it slides",
        unit="N/m",
        ge=0,
        le=1e20,
        source="assumed: a stop, as stiff as the teeth are across the axis",
    )
    slices: int = Field(
        default=SLICES,
        ge=1,
        le=199,
        description="slices over the width of the teeth; 1 leaves the shaft free to tilt",
        json_schema_extra={"unit": "-", "source": "assumed: 35, Al-Hamadani 2018"},
    )

    @property
    def spline(self) -> Spline:
        """The coupling, for the loads of its teeth."""
        return Spline(
            self.teeth,
            self.diameter,
            self.length,
            self.stiffness,
            radians(self.pressure_angle),
            self.slices,
        )

    @property
    def bushing(self) -> tuple[float, float, float, float, float, float]:
        """Its six stiffnesses along and about x, y, z, all flanks in contact [N/m, N m/rad]."""
        across, torsion, tilt = self.spline.springs
        along = across if self.axial is None else self.axial
        return along, across, across, torsion, tilt, tilt
