"""Quantities of a design as an OpenMDAO component, for searches over more than a drivetrain.

OpenMDAO (Gray et al. 2019, Struct. Multidisc. Optim. 59, 1075) is an extra, ``pip install
"fe-drivetrain[openmdao]"``, and is imported when a component is first asked for.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.constrained_minimum import STEP
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.units import unit_of_key
from fe_drivetrain.studies.design_quantities import DesignQuantities
from fe_drivetrain.studies.design_request import DesignRequest
from fe_drivetrain.studies.design_trials import DesignTrials

_UNITS = {"m": "m", "kg": "kg", "N/m": "N/m", "Pa": "Pa", "rad": "rad", "h": "h", "N": "N"}
_UNITS |= {"N m": "N*m", "N m/rad": "N*m/rad", "Hz": "Hz", "kg m^2": "kg*m**2"}


def design_component(drivetrain: Drivetrain, request: DesignRequest, model: str = "cheap") -> Any:
    """Quantities of a design as an ``openmdao.api.ExplicitComponent``.

    Inputs are the keys that have a range, with dots replaced by colons, as in
    ``shaft:sections:0:inner_diameter``; outputs are what the request shall minimise and limits,
    each with one value for every bearing or section. Partial derivatives are central differences
    inside of the ranges.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain that designs differ from.
    request : DesignRequest
        Ranges, and quantities; lists of values are for `fe_drivetrain.studies.search`.
    model : {"cheap", "better", "bound"}
        Level of the model, see `fe_drivetrain.studies.design_quantities.MODELS`.

    Returns
    -------
    openmdao.api.ExplicitComponent
        Not yet part of a problem.

    Raises
    ------
    InputError
        OpenMDAO is not installed, a key has a list of values, or a name is unknown.
    """
    try:
        import openmdao.api as om
    except ModuleNotFoundError as error:
        raise InputError(
            'a component needs OpenMDAO: pip install "fe-drivetrain[openmdao]"'
        ) from error
    if request.lists:
        raise InputError(
            f"{', '.join(sorted(request.lists))} has a list of values, and a component has ranges "
            "alone: give two ends, or use `search`"
        )
    asked = DesignQuantities(drivetrain, request)
    now = asked.values(drivetrain, model)
    trials = DesignTrials(asked, {name: len(values) for name, values in now.items()}, {}, model)
    ranges = request.ranges
    names = {key: key.replace(".", ":") for key in ranges}
    outputs = {name: name.replace(".", ":") for name in now}

    class DesignComponent(om.ExplicitComponent):  # type: ignore[misc]
        """Quantities of a design."""

        def setup(self) -> None:
            """Inputs, outputs and derivatives."""
            place = request.start(drivetrain)
            for (key, (low, high)), at in zip(ranges.items(), place, strict=True):
                unit = _UNITS.get(unit_of_key(drivetrain, key))
                self.add_input(names[key], low + at * (high - low), units=unit)
            for name, values in now.items():
                self.add_output(outputs[name], values, units=_UNITS.get(asked.units[name]))
            self.declare_partials("*", "*")

        def _at(self, inputs: Any) -> Any:
            found = [
                (float(inputs[names[key]][0]) - low) / (high - low)
                for key, (low, high) in ranges.items()
            ]
            return np.array(found)

        def _found(self, at: Any) -> dict[str, Any]:
            found = trials.quantities(at)
            if found is None:
                raise om.AnalysisError(str(trials.fault))
            return found

        def compute(self, inputs: Any, outputs_: Any) -> None:
            """Quantities of the design."""
            for name, values in self._found(self._at(inputs)).items():
                outputs_[outputs[name]] = values

        def compute_partials(self, inputs: Any, partials: Any) -> None:
            """Derivatives of all quantities by all values."""
            at = self._at(inputs)
            for k, (key, (low, high)) in enumerate(ranges.items()):
                ends = np.clip([at[k] - STEP, at[k] + STEP], 0.0, 1.0)
                places = [np.where(np.arange(len(at)) == k, end, at) for end in ends]
                before, after = map(self._found, places)
                width = (ends[1] - ends[0]) * (high - low)
                for name in now:
                    slope = (after[name] - before[name]) / width
                    partials[outputs[name], names[key]] = slope[:, None]

    return DesignComponent()
