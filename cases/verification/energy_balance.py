"""Work of the loads equals the stored energy, by part and by spring, gravity included."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import scenes
from fe_drivetrain.common import GRAVITY, Floats
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run, Target
from fe_drivetrain.shafts.response import LOADS

#: A typical mean load: hub forces [N] and moments [N m] (Fx 200 kN, Fz -370 kN, My 660 kN m), then
#: accelerations, and the weight of the gearbox.
HUB = (200e3, 0.0, -370e3, 0.0, 660e3, 0.0)
STORED = "energy stored under a working load, gravity and gearbox weight"
WHERE = "{}: where the work of each load is stored"
LABELS = [*LOADS, "working load"]
STOPS = "the energy error at which the solver stops"
CLAPEYRON = "Clapeyron: half the work of the loads is stored"


@case("Energy in equals energy stored", source="exact: Clapeyron's theorem")
def run(run: Run, page: Page) -> None:
    """Clapeyron's theorem for ten unit loads and for a working load with gravity, both scenes."""
    page.section("Energy")
    page.text(
        "Work: the nodal loads on the nodal displacements. Stored: strain energy of each part by "
        "its own stiffness, and of the springs at the gearbox by their motion. Joint, couplings "
        f"and supports do no work. The working load is Fx {HUB[0] / 1e3:g} kN, Fz "
        f"{HUB[2] / 1e3:g} kN, My {HUB[4] / 1e3:g} kN m at the hub with self-weight and the "
        "gearbox's weight, applied from the unstressed state."
    )
    rows, worst, of_working = [], {}, {}
    for kind in scenes.KINDS:
        model, response = scenes.solved(run, kind)
        work = scenes.work(model, response)
        stored = dict(response.strain_energy)
        for point, k in model.springs:
            motion = response.motions[point.name]
            stored[f"springs of the {point.name}"] = motion.T @ k @ motion
        total = np.sum(list(stored.values()), axis=0)
        own = work.diagonal()
        imbalance = float((np.abs(total.diagonal() - own) / own).max())
        working = np.array([*HUB, 0.0, 0.0, -GRAVITY, model.scene.gearbox.weight])
        done, kept = (0.5 * working @ energy @ working for energy in (work, total))
        error = response.diagnostics.energy_error
        title = "work less energy stored, largest of ten unit loads, relative"
        page.meets(imbalance, Target(title, 0.0, 1e-9, STOPS, CLAPEYRON), error, kind)
        stores = Target(f"{STORED} [J]", float(done), 1e-9, STOPS, CLAPEYRON, measure="energy")
        page.meets(float(kept), stores, error * float(done), kind)
        worst[kind] = max(imbalance, abs(float(kept / done) - 1.0))

        loads = np.vstack([np.eye(10), working])
        energies = {part: _of_each(loads, e) for part, e in stored.items()}
        works = _of_each(loads, work)
        for j, label in enumerate(LABELS):
            in_all = sum(float(e[j]) for e in energies.values())
            rows.append(
                {
                    "scene": kind,
                    "load": label,
                    "work / 2 [J]": float(works[j]),
                    "stored [J]": in_all,
                    "difference [-]": in_all / float(works[j]) - 1.0,
                }
            )
        shares = {part: 100.0 * e / works for part, e in energies.items()}
        groups = {part: dict(zip(LABELS, share, strict=True)) for part, share in shares.items()}
        of_working[kind] = {part: share[LABELS[-1]] for part, share in groups.items()}
        page.add(bars(WHERE.format(kind), groups, "share of the work [%]", stacked=True))
    page.image(f"The {kind} scene, as meshed here", run.sketch(model.mesh))
    page.table("Work of each load and energy stored", rows)
    answer(page, worst, of_working["spherical"])
    page.data("energies", rows)


def answer(page: Page, worst: dict[str, float], shares: dict[str, float]) -> None:
    """State the energy that is stored, and what is missing; shares [%] of the spherical scene."""
    spherical, bonded = (
        page.judged(f"{kind}: {STORED}", f"stored energy, {kind} bearing", "half the work")
        for kind in ("spherical", "bonded")
    )
    missing = max(worst.values())
    most = sorted(shares, key=lambda part: -shares[part])[:2]
    page.answer(
        "Is all the work of the loads found again as stored energy?",
        f"A working load stores {formatted(spherical.value, 4)}\u00a0J with a spherical bearing "
        f"and {formatted(bonded.value, 4)}\u00a0J with a bonded one; at most "
        f"{formatted(missing, 1, '')} of its work is missing.",
        [
            spherical,
            bonded,
            *(
                page.value(f"stored in {part}, spherical bearing [%]", shares[part])
                for part in most
            ),
            page.value(
                "largest share of the work that is missing", missing, at_most=1e-9, by="solver"
            ),
        ],
        hero=WHERE.format("spherical"),
        cautions=["Joint, couplings and supports do no work, and store none."],
    )


def _of_each(loads: Floats, energy: Floats) -> Floats:
    """(m,) half of the quadratic form of each load."""
    return np.asarray(0.5 * np.einsum("li,ij,lj->l", loads, energy, loads))
