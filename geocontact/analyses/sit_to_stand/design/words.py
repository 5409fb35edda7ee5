"""What is said and warned of a choice."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.page_words import counted
from geocontact.analyses.sit_to_stand.certificate_words import not_certified
from geocontact.analyses.sit_to_stand.design.chosen import gain_interval
from geocontact.analyses.sit_to_stand.design.result import StandingDesignResult
from geocontact.analyses.sit_to_stand.design.tables import in_units
from geocontact.standing_up.assistance.peaks import MEASURES, UNITS

PARTS = {"share": "of the person's knee torque", "timing": "of the movement"}
"""What numbers without a unit are parts of."""
AIMS = {"strap": ("peak force of the strap", "smooth", "true"), "energy": ("energy of the strap", "mean", "largest")}
"""What is least, how it is measured, and what is said beside it."""


def doubt(r: StandingDesignResult, *, stopped: bool) -> None:
    """Searches without an answer, movements without a certificate, numbers at the end of what can be built.

    `stopped` by Ctrl-C: what was not begun is missing.
    """
    record = r.record
    if stopped:
        record.warn(f"interrupted after {r.best.name}: the last iterate is kept, and what would come next is missing")
    for one in (*r.designs, *r.front):
        if one.design is not None and not one.design.met and not one.design.stopped:
            record.warn(f"{one.name}: {one.design.ending}; the knee's limit may be out of reach of what varies")
        for trial in one.trials:
            seen = trial.judged.certificate
            if seen is not None and not seen.converged:
                record.warn(not_certified(f"{trial.recorded.name} {one.name}", seen))
    best = r.best.design
    if best is not None and best.on_end.any():
        names = ", ".join(name for name, end in zip(best.task.vary, best.on_end, strict=True) if end)
        record.warn(f"at the end of what can be built, so that the value says where that is: {names}")
    if len(r.draws) < r.options.draws and not stopped:
        record.warn(f"{r.options.draws - len(r.draws)} of {r.options.draws} draws have no movement and are left out")


def say(r: StandingDesignResult, solved: int, seconds: float) -> None:
    """The aim and the knee by each design, what was chosen, the gain, and what it cost to find."""
    record, aim, unit = r.record, MEASURES.index(r.options.aim), UNITS[r.options.aim]
    what, sought, beside = AIMS[r.options.aim]
    asked = {one.name: one.movement.asked for one in r.designs}
    for how, sizes in ((sought, "sizes"), (beside, "largest")):
        each = ", ".join(f"{name} {getattr(of, sizes)[aim]:.3g} {unit}" for name, of in asked.items())
        record.say(f"{what}, {how}: {each}")
    record.say(_of_knee(r))
    numbers = ", ".join(f"{name} {value:.3g} {PARTS.get(name, of)}" for name, value, of in in_units(r.best))
    record.say(f"{r.best.name}: {numbers}")
    gain, (low, high) = r.gain, gain_interval(r.draws)
    also = f", {low:.0%} to {high:.0%} over {counted(len(r.draws), 'draw')}" if np.isfinite(low) else ""
    both = f"{gain:.0%} ({sought}{also}), {r.true_gain:.0%} ({beside})"
    record.say(f"gain over {r.reference.name}: {both}; shear of the strap is predicted, no mat sees it")
    seen = [trial for one in (*r.designs, *r.front) for trial in one.trials]
    passed = sum(t.judged.certificate is not None and t.judged.certificate.converged for t in seen)
    record.say(
        f"{passed} of {counted(len(seen), 'motion')} certified; {counted(solved, 'movement')} in {seconds:.0f} s"
    )
    record.results["design"] = {
        "aim": r.options.aim,
        "values": {one.name: dict(zip(MEASURES, one.movement.asked.sizes.tolist(), strict=True)) for one in r.designs},
        "largest": {name: dict(zip(MEASURES, of.largest.tolist(), strict=True)) for name, of in asked.items()},
        "chosen": {name: value for name, value, _ in in_units(r.best)},
        "price": None if r.best.design is None else r.best.design.price,
        "gain": gain,
        "gain_interval": None if not np.isfinite(low) else [low, high],
        "movements": solved,
        "cpu_seconds": round(seconds, 3),
    }


def _of_knee(r: StandingDesignResult) -> str:
    """How far the knee's true peak and its smooth one are below those without help."""
    without, *others = r.designs
    knee = MEASURES.index("knee")
    parts = []
    for one in others:
        true, smooth = (
            getattr(one.movement.asked, of)[knee] / getattr(without.movement.asked, of)[knee]
            for of in ("largest", "sizes")
        )
        parts.append(f"{one.name} {true:.1%} (smooth {smooth:.1%})")
    peak = without.movement.asked.largest[knee]
    return f"knee at most {r.options.knee:.0%} of its true peak of {peak:.1f} N m without help: {', '.join(parts)}"
