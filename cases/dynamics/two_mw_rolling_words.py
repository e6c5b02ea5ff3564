"""What the thesis says of stresses of the 2 MW machine's bearings, and of damage."""

from __future__ import annotations

from collections.abc import Mapping

from fe_drivetrain.cases.dynamics.two_mw_damage import Share
from fe_drivetrain.cases.dynamics.two_mw_guesses import FEWEST, grown, spread
from fe_drivetrain.cases.dynamics.two_mw_loads import Rolling
from fe_drivetrain.cases.dynamics.two_mw_statements import (
    Computed,
    Statement,
    of_guesses,
)
from fe_drivetrain.cases.references.printed_values import against, holds
from fe_drivetrain.report.number_text import percent_text


def of_bearing_stresses(of: Computed) -> list[Statement]:
    """Figures 7.22 to 7.24, 7.27 and 7.28."""
    up, down = of.pins
    peaks = {n: [float(one.pressure.max()) for one in pair] for n, pair in of.rollers.items()}
    shafts = {name: pair for name, pair in peaks.items() if name not in {*up, *down}}
    higher = all(peaks[a][k] > peaks[b][k] for a, b in zip(up, down, strict=True) for k in (0, 1))
    more = peaks["HS-A"][1] / peaks["HS-A"][0]
    loads = spread(of.moved, grown("HS-A"))
    span = (loads[0] ** 0.5, loads[1] ** 0.5)
    deep = [1e3 * one for one in of.bearing_depths]
    sizes = "bearings are those of the 750 kW gearbox, scaled"
    normal = [pair[0] for pair in peaks.values()]
    fast = max(shafts, key=lambda name: shafts[name][1]) if shafts else ""
    return [
        Statement(
            "7.24",
            "pressures of bearings in normal operation",
            "1.51 to 2.05 GPa",
            f"{min(normal) / 1e9:.2f} to {max(normal) / 1e9:.2f} GPa",
            "not testable",
            sizes,
        ),
        Statement(
            "7.24",
            "pressure of HSS-A: shutdown over normal",
            "2.405 over 2.05, 1.17",
            f"{more:.3f}",
            against(more, 2.405 / 2.05, span),
            f"the size of the bearing leaves it; {of_guesses(span)}",
        ),
        Statement(
            "7.24",
            "HSS-A has the highest pressure of the bearings of shafts in the shutdown",
            "2.4 GPa",
            f"{fast}, {shafts[fast][1] / 1e9:.2f} GPa",
            "not testable",
            sizes,
        ),
        Statement(
            "7.23",
            "upwind planet bearings have the higher pressure in both states",
            "all three",
            ", ".join(f"{peaks[a][1] / peaks[b][1]:.3f}" for a, b in zip(up, down, strict=True)),
            holds(higher),
            "as their loads",
        ),
        Statement(
            "7.27",
            "depth of the largest shear below races",
            "0.35 to 0.65 mm",
            f"{deep[0]:.2f} to {deep[1]:.2f} mm",
            "not testable",
            sizes,
        ),
        *of_loaded_rollers(of),
    ]


def of_loaded_rollers(of: Computed) -> list[Statement]:
    """Figure 7.25."""
    first = of.rollers[of.pins[0][0]]
    fewest = [int(str(row[f"{FEWEST}, shutdown"])) for row in of.rolls]
    counts = [(int(one.loaded.min()), int(one.loaded.max())) for one in first]
    return [
        Statement(
            "7.25",
            "rollers of upwind bearing A that carry load in normal operation",
            "6 to 7",
            f"{counts[0][0]} to {counts[0][1]}",
            holds(counts[0][0] in (5, 6, 7) and counts[0][1] in (6, 7, 8)),
            "of 0.1 mm of clearance; one more or less with the place of the rollers",
        ),
        Statement(
            "7.25",
            "at instants of the shutdown one roller alone carries load",
            "1",
            f"{counts[1][0]} at the least load",
            "holds" if counts[1][0] == 1 else "not testable" if 1 in fewest else "does not hold",
            "the load does not go to nothing, for weights are left; by size and clearance "
            f"{min(fewest)} to {max(fewest)}",
        ),
        Statement(
            "7.25",
            "few rollers overload the bearing",
            "stress higher at such instants",
            f"{least_pressure(first[1]) / 1e6:.0f} MPa at the fewest, "
            f"{first[1].pressure.max() / 1e6:.0f} MPa at most",
            holds(least_pressure(first[1]) > 0.9 * first[1].pressure.max()),
            "few rollers carry where there is little to carry",
        ),
    ]


def least_pressure(rolls: Rolling) -> float:
    """Largest pressure at the instants at which fewest rollers carry load [Pa]."""
    return float(rolls.pressure[rolls.loaded == rolls.loaded.min()].max())


def whole_share(parts: Mapping[str, Share]) -> float:
    """Share of shutdowns in the damage of all parts together."""
    return Share(sum(p.normal for p in parts.values()), sum(p.stop for p in parts.values())).share


def of_damage(of: Computed) -> list[Statement]:
    """Figures 7.31 and 7.32; nothing where damage was not counted."""
    if of.shares is None:
        return []
    gears, bearings = of.shares.gears, of.shares.bearings
    worst = max(gears, key=lambda name: gears[name].stop)
    each = [whole_share(kind) for kind in (gears, bearings)]
    his = [one.share for name, one in of.shares.his.items() if name.startswith("stage")]
    ranked = sorted(bearings, key=lambda name: -bearings[name].stop)
    return [
        Statement(
            "7.31, 7.32",
            "shutdowns do most of the damage of gears and bearings",
            "bars",
            f"{percent_text(each[0])} of gears by ISO 6336, {percent_text(each[1])} of bearings "
            f"by ISO 281; as he counts, all but {percent_text(1.0 - min(his))} of both",
            holds(min(each) > 0.5),
            "a count of cycles of the pressure leaves out its mean, which every tooth and roller "
            "feels at each pass",
        ),
        Statement(
            "7.31",
            "gears of the fast stage are damaged most by shutdowns",
            "fast gear and pinion",
            worst,
            holds(worst.startswith("stage 3")),
            "steels and load factors were chosen",
        ),
        Statement(
            "7.32",
            "planet bearings, HSS-A and HSS-C are damaged most by shutdowns",
            "these eight",
            ", ".join(ranked[:3]),
            "not testable",
            "bearings are those of the 750 kW gearbox, scaled",
        ),
    ]
