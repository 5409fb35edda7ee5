"""What has to be said against an identification."""

from __future__ import annotations

from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.law import LENGTHS

FEW_STRETCHES = 12
OWN = 0.1  # of what c does to the force; less is called hardly separable from the cuff
RARE, MORE = 0.01, 1.5  # p and size from which residuals are more than noise
BETTER = 0.02  # of R² that the mirrored force must gain to be worth a word
APART = 3.0  # times that two stiffnesses may differ before a unit is doubted
SCALE_FREE = (
    f"k and the lengths {', '.join(LENGTHS)} are known up to one factor only: F(k/s, s × lengths) = F for every s; "
    "know l, z or k (`known`), give a prior (`prior`), or record the free joint's displacement (`unlocked`)"
)


def reserve(record: Record, found: Fitted, free: Free | None) -> None:
    """Tell the record what is open, rough or odd."""
    _say_what_is_open(record, found)
    if free is not None:
        _doubt_displacement(record, found, free)
    e, excess = found.estimate, found.residuals.excess
    if found.stretches < FEW_STRETCHES:
        record.warn(f"{found.stretches} stretches of {found.data.stretch:.2g} s are few: intervals are rough")
    if not e.converged:
        record.warn("the search did not end by itself; see `start` and `bounds`")
    if excess.p < RARE and excess.ratio > MORE:
        record.warn(
            f"the fit leaves {excess.ratio:.2g} times what noise within the trials would: offsets that change "
            "from trial to trial, or something the law misses; intervals do not know of it and are too short"
        )
    if found.r2 < 0.0:
        record.warn(f"R² is {found.r2:.2f}: a constant force would do better than the law")
    bad = [f"{each.name} ({each.r2:.2f})" for each in found.held if each.r2 < 0.0]
    if bad:
        record.warn(f"R² of what was not used is below 0, a constant force would do better: {', '.join(bad)}")
    if found.mirrored_r2 > found.r2 + BETTER:
        told = f"the force turned over fits better (R² {found.mirrored_r2:.3f} instead of {found.r2:.3f})"
        record.warn(f"{told}: is its sign turned? see `map` force=-…")


def _doubt_displacement(record: Record, found: Fitted, free: Free) -> None:
    """A stroke that is not that of the fitted geometry, where something else than the displacement sets its scale."""
    problem = found.estimate.problem
    if free.stiffness is None or problem.scale_free or problem.scale is not None or not free.stiffness.value > 0.0:
        return
    times = free.stiffness.value / found.estimate.named["k"]
    if 1.0 / APART < times < APART:
        return
    stroke = f"the free joint slides by {1.0 / times:.3g} times what the fitted lengths ask for"
    record.warn(
        f"{stroke}, so that k by its displacement is {free.stiffness.value:.4g} N/m and not "
        f"{found.estimate.named['k']:.4g}: is the displacement in another unit than its header says?"
    )


def _say_what_is_open(record: Record, found: Fitted) -> None:
    """The scale, ends of intervals, signs."""
    if found.estimate.problem.scale_free:
        record.warn(SCALE_FREE)
    apart, problem = found.separable, found.estimate.problem
    if "c" in problem.names and apart.from_all < OWN and not set(problem.priors) & {"k", "c"}:
        told = f"only {apart.from_all:.2%} of what c does to the force is its own" if apart.told else "not at all"
        record.warn(
            "angle and force hardly tell the compliance c of the upper arm's fixation from that of the cuff, which is "
            f"in series with it ({told}): know k or c (`known`), or give a prior (`prior`)"
        )
    driven = [r.name for r in found.recordings if r.torque is not None and r.torque.any()]
    if driven and found.estimate.named["c"] != 0.0:
        told = f"{', '.join(driven)}: an actuator's torque pushes a fixation that yields"
        record.warn(f"{told}; the fit takes it as 0, as if nobody drove the exoskeleton")
    ends = [each.words for each in found.intervals if each.lower_open or each.upper_open]
    if ends:
        record.warn(f"no limit within the bounds to {', '.join(ends)}, on one side or both")
    signs = [each.words for each in found.intervals if each.key[0] in LENGTHS and each.sign_open]
    if signs:
        record.warn(f"the sign of {', '.join(signs)} is not told: values of both signs fit within the interval")
