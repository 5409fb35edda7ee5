"""From bodies, motion and load to the equilibrium of every frame."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.analyses.knee.settle.read import SettleInputs
from geocontact.analyses.knee.settle.result import SettleResult
from geocontact.analyses.knee.settle.settled import Settled
from geocontact.analyses.run_record import Record
from geocontact.analyses.sides import medial_side
from geocontact.data.errors import InputError
from geocontact.loads.settling.along import Frame, settle_along
from geocontact.loads.settling.coordinates import coordinates_of
from geocontact.loads.settling.energy_balance import EnergyBalance, energy_balance
from geocontact.loads.settling.indeterminate import not_held

BALANCED = 0.01  # of the work; a larger difference is a reservation
STRAINED = 0.2  # largest strain that the linear law is trusted to
NAMED = 8  # frames that a warning names


def run(i: SettleInputs, o: SettleOptions, record: Record) -> SettleResult:
    """Every frame after the other, then the balance of energy in that with the largest load."""
    wanted = coordinates_of(i.motion.poses, i.bed.point)
    with record.listener.progress("equilibrium", len(wanted)) as step:

        def each(frame: Frame) -> None:
            _refuse_indeterminate(i, frame)
            step()

        frames = settle_along(i.bed, i.fixed, wanted, i.load, i.springs, i.free, each)
    settled = Settled(i, tuple(frames), o.side)
    _refuse_nowhere(i, settled)
    _warn_of_lost(i, settled, record)
    heaviest = settled.heaviest
    rest = frames[heaviest].rest
    balance = None if rest is None else energy_balance(i.bed, frames[heaviest].pull, rest, i.free)
    _summarise(i, settled, balance, record)
    record.say(f"medial is {medial_side(o.split, o.side, None).words} of {i.fixed.name}")
    return SettleResult(record=record, options=o, settled=settled, balance=balance)


def _refuse_indeterminate(i: SettleInputs, frame: Frame) -> None:
    """InputError where contact and springs leave a free coordinate anywhere."""
    if frame.rest is None:
        return
    loose = not_held(frame.rest.total.stiffness, i.free, frame.pull.load)
    if loose and (frame.rest.converged or not i.springs.any()):
        what = f"nothing holds {' and '.join(loose)}: the contact has no stiffness along it"
        raise InputError("", "`free`", what, f"leave out one of them, or give `springs` {loose[0]}=…")


def _refuse_nowhere(i: SettleInputs, s: Settled) -> None:
    """InputError where no frame has an equilibrium."""
    if s.converged.any():
        return
    if all(frame.rest is None for frame in s.frames):
        what = f"{i.bed.moving.name} misses the layer of {i.fixed.name} along -y in every frame: no contact found"
        raise InputError("", "", what, "check motion, unit, `moving_body` and `region`")
    residual = min(frame.rest.residual for frame in s.frames if frame.rest is not None)
    what = f"no frame came to rest; at best {residual:.3g} N were left over"
    raise InputError("", "`free`", what, "let fewer coordinates settle, or give `springs`")


def _warn_of_lost(i: SettleInputs, s: Settled, record: Record) -> None:
    missed = [k for k, frame in enumerate(s.frames) if frame.rest is None]
    stuck = [k for k, frame in enumerate(s.frames) if frame.rest is not None and not frame.converged]
    for frames, what in ((missed, "no contact found"), (stuck, "did not come to rest")):
        if frames:
            times = ", ".join(f"{i.motion.time[k]:g}" for k in frames[:NAMED])
            more = ", …" if len(frames) > NAMED else ""
            record.warn(f"{len(frames)} of {len(s.frames)} frames: {what} (at {times}{more} s); their rows are empty")


def _between(values: Float[np.ndarray, " t"], form: str) -> str:
    """Smallest and largest in words, once where they are written alike."""
    low, high = format(np.nanmin(values), form), format(np.nanmax(values), form)
    return low if low == high else f"{low} … {high}"


def _summarise(i: SettleInputs, s: Settled, balance: EnergyBalance | None, record: Record) -> None:
    peak, area = s.peaks * 1e-6, s.areas * 1e6
    shares = s.forces("medial") / s.forces("total")
    record.say(
        f"{int(s.converged.sum())} of {len(s.frames)} frames at rest under {_between(i.load, '.0f')} N: "
        f"contact area {_between(area, '.1f')} mm^2, pressure up to {np.nanmax(peak):.2f} MPa, "
        f"{_between(100.0 * shares, '.0f')} % of the force medial"
    )
    strain = s.largest_strain
    if i.bed.layer.law == "linear" and strain > STRAINED:
        record.warn(f"the layer is strained by up to {strain:.0%}: `foundation` logarithmic is for that")
    found: dict[str, object] = {
        "frames": len(s.frames),
        "frames_at_rest": int(s.converged.sum()),
        "pieces": len(i.bed.layer.pieces.area),
        "layer_modulus_Pa": i.bed.layer.modulus,
        "largest_pressure_Pa": float(np.nanmax(s.peaks)),
        "largest_strain": round(strain, 6),
        "largest_residual_N": float(np.nanmax(s.residuals)),
        "newton_steps_per_frame": round(float(np.mean([f.rest.steps for f in s.frames if f.rest is not None])), 2),
    }
    if balance is None:
        record.warn("the balance of energy was not checked: no equilibrium under smaller loads, not on the axial way")
    else:
        found |= {"work_of_load_J": balance.work, "stored_energy_J": balance.stored, "axial_way_alone": balance.alone}
        way = (
            " on the axial way alone, as smaller loads have no equilibrium with all that is free"
            if balance.alone
            else ""
        )
        record.say(
            f"work of the load {balance.work * 1e3:.4g} mJ, energy stored {balance.stored * 1e3:.4g} mJ: "
            f"{balance.difference:.1e} apart{way}"
        )
        if balance.difference > BALANCED:
            record.warn(f"work and stored energy differ by {balance.difference:.1%}; give a smaller `piece`")
    record.results["equilibrium"] = found
