"""Numbers of an uncertainty study: for its page, and for other programs."""

from typing import Any

import numpy as np

from fe_drivetrain.drivetrain_file.scene import Spread
from fe_drivetrain.shafts.fidelity.quantity import Reported
from fe_drivetrain.shafts.uncertainty.input_study import Study
from fe_drivetrain.shafts.uncertainty.sampling import Samples, distribution, spreads_of


def half_band(samples: Samples) -> float:
    """Half the width of the band, relative to the nominal value."""
    band = samples.band()
    return (band.high - band.low) / 2 / abs(samples.nominal)


def first_order(found: Study, number: Reported) -> float:
    """Relative standard deviation predicted by the sensitivities, for independent inputs."""
    return float(np.linalg.norm(list(changes_by_spread(found, number).values())))


def changes_by_spread(found: Study, number: Reported) -> dict[str, float]:
    """Relative change of a quantity for one standard deviation of each uncertain value."""
    return {
        key: found.slopes[number.name][key] * relative_spread(spread)
        for key, spread in spreads_of(found.scene).items()
    }


def relative_spread(spread: Spread) -> float:
    """Standard deviation of a value, relative to its nominal value."""
    return float(distribution(spread, 1.0).std())


def figures(found: Study) -> dict[str, Any]:
    """All numbers for other programs, as JSON: digests of the samples, no samples."""
    quantities = {}
    for number in found.numbers:
        samples, error = found.samples[number.name], found.errors[number.name]
        band = samples.band()
        entry: dict[str, Any] = {
            "unit": number.unit,
            "nominal": samples.nominal,
            "band": [band.low, band.high],
            "band_standard_errors": [band.low_error, band.high_error],
            "half_band": half_band(samples),
            "model_error": error.share,
            "model_error_source": error.source,
            "sensitivities": dict(found.slopes[number.name]),
            "standard_deviation": samples.deviation,
        }
        if number.name in found.soft_samples:
            entry["face_on_average"] = {
                "nominal": found.soft_samples[number.name].nominal,
                "half_band": half_band(found.soft_samples[number.name]),
                "sensitivities": dict(found.soft_slopes[number.name]),
            }
        if number.name in found.shares:
            shares = found.shares[number.name]
            entry["sobol"] = {
                key: {
                    "first": [float(shares.first[k]), float(shares.first_error[k])],
                    "total": [float(shares.total[k]), float(shares.total_error[k])],
                }
                for k, key in enumerate(shares.keys)
            }
        quantities[number.name] = entry
    return {
        "level": found.level,
        "samples": len(next(iter(found.samples.values())).values),
        "quantities": quantities,
    }
