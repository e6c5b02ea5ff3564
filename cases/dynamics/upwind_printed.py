"""Figures 7.1 to 7.10 of Al-Hamadani 2018 beside ours, statement by statement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from scipy.optimize import brentq

from fe_drivetrain.cases.dynamics.upwind_causes import Effect
from fe_drivetrain.cases.dynamics.upwind_figures import RUN_OUT, Figures, moment_for_peak
from fe_drivetrain.cases.dynamics.upwind_guess import Guess, Turned
from fe_drivetrain.cases.dynamics.upwind_model import FirstStage
from fe_drivetrain.report.suite import Page, Record

PEAKS = (90.0, 210.0, 330.0)
NEAR = 20.0
"""Difference of angles that counts as agreement [deg]."""
STRAIGHT = 0.9
"""Correlation from which two quantities count as going with each other."""
BEST = "best guess"
"""Name of its turn."""
MEASURED = (1.41, 1.47)
"""Upwind over downwind at rated torque, of the thesis."""
OPERATING = 1.6
"""Upwind over downwind in normal operation."""
LEAST = 0.3
"""Torque over the rated one from which normal operation is looked for."""
SHARED = 1.16
"""Sharing with moments of the hub, of other publications on the gearbox."""
Row = tuple[str, str, str, str, str]
"""Figure, statement, what is printed, ours, verdict."""
COLUMNS = ("figure", "statement", "printed", "ours", "verdict")


@dataclass(frozen=True)
class Known:
    """What the rows need beside the figures.

    Attributes
    ----------
    turns : dict of str to Turned
        Turns of the best guess, with moments of the hub, and with clearances on rollers.
    uneven : float
        Difference of the pins' tilts that makes planets differ as printed [rad].
    peak_moment : float or None
        Pitch moment at which upwind bearings peak where they are printed to [N m].
    torque_share : float or None
        Torque over the rated one, at which pins out of line that give the ratio at rated torque
        give that of normal operation.
    """

    turns: dict[str, Turned]
    uneven: float
    peak_moment: float | None
    torque_share: float | None


def printed_beside(found: Figures, fitted: Figures, known: Known) -> list[Record]:
    """Each printed figure beside ours, of the best guess and of the model fitted to the ratio.

    Parameters
    ----------
    found, fitted : Figures
        Figures of the best guess, and of the fitted model.
    known : Known
        Results of other models.
    """
    both = (found, fitted)
    rows = [
        above_row(both),
        *peak_rows(both, known),
        face_row(both),
        tilt_row(both),
        *sharing_rows(both, known),
        *ratio_rows(both, known),
        below_row(both),
        spectral_row(both),
    ]
    return [dict(zip(COLUMNS, row, strict=True)) for row in rows]


def beside(words: Sequence[str]) -> str:
    """What the best guess has, and the fitted model."""
    return f"{words[0]}; fitted {words[1]}"


def above_row(both: Sequence[Figures]) -> Row:
    """Figures 7.1 and 7.2."""
    least = [float((f.rated.loads[..., 0] / f.rated.loads[..., 1]).min()) for f in both]
    return (
        "7.1, 7.2",
        "upwind loads above downwind ones through the turn, rated torque",
        "curves, without numbers",
        beside([f"least ratio {one:.2f}" for one in least]),
        verdict_of(least[1] > 1.0, least[0] > 1.0),
    )


def peak_rows(both: Sequence[Figures], known: Known) -> list[Row]:
    """Figure 7.3."""
    peaks = [f.peaks for f in both]
    off = [max(abs(turn_between(p, w)) for p, w in zip(one, PEAKS, strict=True)) for one in peaks]
    lows = [f.low for f in both]
    away = [abs(turn_between(one, PEAKS[0])) for one in lows]
    return [
        (
            "7.3",
            "upwind bearings of A, B, C peak level with the sun, to its right, after",
            "90, 210, 330 deg",
            beside([", ".join(f"{p:.0f}" for p in one) for one in peaks]) + " deg",
            verdict_of(off[1] <= NEAR, off[0] <= NEAR) + needed_moment(known.peak_moment),
        ),
        (
            "7.3",
            "the downwind bearing of A carries least there",
            "90 deg",
            beside([f"{one:.0f}" for one in lows]) + " deg",
            verdict_of(away[1] <= NEAR, away[0] <= NEAR),
        ),
    ]


def needed_moment(moment: float | None) -> str:
    """What a pitch moment would have to be, in words after a verdict."""
    if moment is None:
        return "; no pitch moment moves the peak there"
    return f"; {moment / 1e3:+.0f} kN m of pitch would move the peak there"


def face_row(both: Sequence[Figures]) -> Row:
    """Figure 7.4."""
    uneven = [float(f.rated.ring.mean(axis=(0, 1)).max()) for f in both]
    mean = [float(f.rated.ring.mean()) for f in both]
    factors = [one / of for one, of in zip(uneven, mean, strict=True)]
    ends = ["upwind" if f.rated.ring.mean(axis=(0, 1)).argmax() == 0 else "inside" for f in both]
    return (
        "7.4",
        "pressure of ring and planet over the face, 35 slices",
        "a picture, without numbers",
        beside([f"most at {e}, load {k:.2f} of mean" for e, k in zip(ends, factors, strict=True)]),
        "not comparable: neither scale nor lead modifications are given",
    )


def tilt_row(both: Sequence[Figures]) -> Row:
    """Figure 7.5."""
    found = [f.rated.with_tilt() for f in both]
    return (
        "7.5",
        "tilt of a planet moves its upwind and downwind loads in opposite senses",
        "upwind most where tilt is least, downwind least",
        beside([f"correlations {up:+.2f}, {down:+.2f}" for up, down, _ in found]),
        verdict_of(opposite(found[1]), opposite(found[0])),
    )


def sharing_rows(both: Sequence[Figures], known: Known) -> list[Row]:
    """Figures 7.6 and 7.7."""
    calm = [float(f.rated.sharing.max()) for f in both]
    most = max(known.turns, key=lambda name: float(known.turns[name].sharing.max()))
    worst = float(known.turns[most].sharing.max())
    share = [f.rated.with_tilt()[2] for f in both]
    best = max(known.turns, key=lambda name: known.turns[name].with_tilt()[2])
    straightest = known.turns[best].with_tilt()[2]
    straight = [abs(one) >= STRAIGHT for one in share]
    other = f"; agrees {best}" if straightest >= STRAIGHT and not all(straight) else ""
    return [
        (
            "7.6",
            "planets share the load unequally",
            "curves; published of this gearbox: 1.08 in torque alone, 1.16 with moments",
            beside([f"{one:.3f}" for one in calm]) + f"; {worst:.3f} {most}",
            "agrees in kind: less than measured" if worst < SHARED else "agrees",
        ),
        (
            "7.7",
            "a planet's share goes with its tilt",
            "curves, without numbers",
            beside([f"correlation {one:+.2f}" for one in share]) + f"; {straightest:+.2f} {best}",
            verdict_of(straight[1], straight[0]) + other,
        ),
    ]


def ratio_rows(both: Sequence[Figures], known: Known) -> list[Row]:
    """Figure 7.8."""
    shares = [", ".join(f"{r:.2f}" for r in f.rated.ratios) for f in both]
    running = [f.operation.ratio for f in both]
    reason = "neither varying torque nor moments move the ratio of means"
    if known.torque_share is not None:
        reason += (
            f"; were pins out of line the cause, {100 * known.torque_share:.0f} % of rated torque "
            "would give 1.6"
        )
    return [
        (
            "7.8",
            "mean upwind over downwind load of A, B, C, rated torque",
            "1.42, 1.47, 1.41",
            beside(shares),
            f"fitted by one unknown; pins {1e3 * known.uneven:.2f} mrad out of line with each "
            "other would make planets differ so",
        ),
        (
            "7.8",
            "the same in normal operation",
            "1.60",
            beside([f"{r:.2f}" for r in running]),
            "agrees" if abs(running[1] - OPERATING) < 0.05 else f"differs: {reason}",
        ),
    ]


def below_row(both: Sequence[Figures]) -> Row:
    """Figure 7.9."""
    below = [f.operation.share_below for f in both]
    return (
        "7.9",
        "in operation upwind loads fall below downwind ones, at rated torque never",
        "for a very short time",
        beside([f"{100 * one:.0f} % of the time" for one in below]),
        verdict_of(0.0 < below[1] < 0.05, 0.0 < below[0] < 0.05),
    )


def spectral_row(both: Sequence[Figures]) -> Row:
    """Figure 7.10."""
    lines = [
        [*(float(f.operation.at_order(order)[0]) for order in (1, 2)), f.run_out] for f in both
    ]
    ordered = [one[0] > one[1] > one[2] for one in lines]
    words = beside([", ".join(f"{a / 1e3:.2g}" for a in one) for one in lines])
    below = min(one[1] / one[2] for one in lines) * RUN_OUT
    true = "" if all(ordered) else f"; 1P is most, and 2P next below {1e6 * below:.0f} um"
    return (
        "7.10",
        f"1P most, then 2P, then the sun's speed ({both[0].sun:.2f}P at the carrier)",
        "curves, without numbers",
        f"{words} kN, the sun out of round by {1e6 * RUN_OUT:g} um",
        verdict_of(ordered[1], ordered[0]) + true,
    )


def opposite(with_tilt: tuple[float, float, float]) -> bool:
    """Whether tilt goes with one bearing's load, and against the other's."""
    up, down, _ = with_tilt
    return up * down < 0.0 and min(abs(up), abs(down)) >= STRAIGHT


def verdict_of(fitted: bool, best: bool) -> str:
    """Verdict where the fitted model and the best guess may differ."""
    if fitted and best:
        return "agrees"
    if fitted:
        return "agrees once fitted, not with the best guess"
    return "differs" if not best else "agrees with the best guess, not once fitted"


def turn_between(one: float, other: float) -> float:
    """Difference of two angles, within half a turn [deg]."""
    return (one - other + 180.0) % 360.0 - 180.0


def compare(
    page: Page,
    stage: FirstStage,
    found: tuple[Figures, Figures],
    turns: dict[str, Turned],
    models: tuple[Guess, tuple[Guess, str], Sequence[Effect]],
    moment: float,
) -> None:
    """Set each printed figure beside ours."""
    best, (fitted, words), effects = models
    pitched = next(turned for name, turned in turns.items() if name.startswith("with pitch"))
    needed = moment_for_peak(turns[BEST], pitched, moment, PEAKS[0])
    tilt = next(e.needed_beside for e in effects if e.cause.field == "pin_tilt")
    share = None if tilt is None else torque_share(stage, best.but("pin_tilt", tilt))
    known = Known(turns, uneven_tilt(stage, fitted), needed, share)
    rows = printed_beside(*found, known)
    page.table(f"Printed, ours, verdict; fitted: {words}", rows)
    page.data("figures", rows)
    if fitted.overhung:
        page.say(
            "The thesis puts the pins of a flexible carrier on bushings and prints neither their "
            f"stiffness nor their place: at the upwind cheek, {1e-6 / fitted.overhung:.0f} "
            "MN m/rad against tilt give the ratio that is asked for."
        )
    if share is not None:
        page.text(
            "What bends under the load keeps its ratio at any torque; gaps, such as pins out of "
            "line or unequal clearances, count for more the smaller the torque is. The thesis's "
            f"{OPERATING:g} of normal operation after {MEASURED[0]:g} at rated torque speaks for "
            f"gaps if its mean torque was {100 * share:.0f} % of rated, which it does not state: "
            "the ratio against the torque would tell."
        )


def torque_share(stage: FirstStage, guess: Guess) -> float | None:
    """Torque over the rated one at which a guess gives the ratio of normal operation, if any."""

    def off(share: float) -> float:
        return replace(stage, torque=share * stage.torque).ratio(guess) - OPERATING

    if off(LEAST) * off(1.0) > 0.0:
        return None
    return float(brentq(off, LEAST, 1.0, xtol=1e-3))


def uneven_tilt(stage: FirstStage, guess: Guess) -> float:
    """Difference of pins' tilts that moves the ratio by as much as planets are printed to [rad]."""
    step = 1e-5
    per = (stage.ratio(guess.but("pin_tilt", guess.pin_tilt + step)) - stage.ratio(guess)) / step
    return (MEASURED[1] - MEASURED[0]) / per
