"""Stances of a study together: by setting of the foot, beside predictors without a model, mean and spread."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.evaluation import (
    ANOTHER,
    MEAN,
    QUANTITIES,
    JudgedStance,
    MeasuredCurve,
    trivial_curves,
)
from geocontact.below_knee_prosthesis.outliers import Oddness, oddness
from geocontact.identify.signals.agreement import Agreement, agreement

PLAIN = (MEAN, ANOTHER)
"""Predictors without a model."""
PlainCurves = Mapping[str, Mapping[str, Float[np.ndarray, " s"]]]
"""By stance and predictor, over the stance on the plate."""


def plain_curves(stances: Sequence[JudgedStance], name: str) -> dict[str, dict[str, Float[np.ndarray, " s"]]]:
    """Curves of a quantity by both predictors without a model, by stance, each at that stance's own shares."""
    found = {}
    for one in stances:
        plates = {
            each.name: MeasuredCurve(each.name, each.person, each.setting, at_shares_of(one, each.measured(name), each))
            for each in stances
        }
        found[one.name] = trivial_curves(list(plates.values()), plates[one.name])
    return found


def at_shares_of(axis: JudgedStance, values: Float[np.ndarray, " s"], of: JudgedStance) -> Float[np.ndarray, " s"]:
    """A curve `of` one stance at the shares of another: share by share within the stance, second by second around it.

    Swing is as long in seconds for all, so that the same place in the curves of two stances is not the same share.
    """
    share, longer = axis.errors.share, axis.errors.stance[1] / of.errors.stance[1]
    inside = np.clip(share, 0.0, 1.0)
    return np.asarray(np.interp(inside + longer * (share - inside), of.errors.share, values))


def curves_of(
    plain: PlainCurves, own: Sequence[JudgedStance], label: str, axis: JudgedStance
) -> list[Float[np.ndarray, " s"]]:
    """Curves of one predictor for some stances, at the shares of one; nothing where it has none of one of them."""
    found = [(one, plain[one.name].get(label)) for one in own]
    if any(each is None for _, each in found):
        return []
    return [at_shares_of(axis, each, one) for one, each in found if each is not None]


def by_setting(stances: Sequence[JudgedStance]) -> dict[str, list[JudgedStance]]:
    """Stances that nothing was fitted to, by setting; all of them where there are none such."""
    kept = [one for one in stances if not one.calibrated] or list(stances)
    found: dict[str, list[JudgedStance]] = {}
    for one in kept:
        found.setdefault(one.setting, []).append(one)
    return found


CALIBRATED = "calibrated"


def by_setting_and_calibrated(stances: Sequence[JudgedStance]) -> dict[str, list[JudgedStance]]:
    """The same with those that a sole was fitted to as a group of their own, last, as the study's figure 3 has them."""
    fitted = [one for one in stances if one.calibrated]
    return by_setting(stances) | ({CALIBRATED: fitted} if 0 < len(fitted) < len(stances) else {})


@dataclass(frozen=True, eq=False)
class QuantityErrors:
    """One quantity of one stance: errors of the model and of the predictors without one.

    Parameters
    ----------
    r2, rmse
        Of the model, over what was simulated; the error in the quantity's unit.
    plain
        By predictor, over the same samples; one that there is nothing for is missing.
    """

    stance: JudgedStance
    quantity: str
    r2: float
    rmse: float
    plain: Mapping[str, Agreement]

    @property
    def better(self) -> bool | None:
        """Whether the model is nearer than every predictor; None where there is none."""
        return all(self.rmse < each.rmsd for each in self.plain.values()) if self.plain else None


def against_predictors(stances: Sequence[JudgedStance]) -> Iterator[QuantityErrors]:
    """Every quantity of every stance, stance by stance."""
    plain = {name: plain_curves(stances, name) for name in QUANTITIES}
    for one in stances:
        for name in QUANTITIES:
            r2, off = one.errors.table[name]
            seen = np.where(np.isfinite(one.simulated(name)), one.measured(name), np.nan)  # the same samples for all
            curves = plain[name][one.name]
            yield QuantityErrors(one, name, r2, off, {k: agreement(v, seen, 1.0, 0.0) for k, v in curves.items()})


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Mean and standard deviation of a quantity over some stances, at the shares of the first of them.

    `label` is the quantity, the quantity and "measured", or the quantity and a predictor.
    """

    quantity: str
    label: str
    mean: Float[np.ndarray, " s"]
    sd: Float[np.ndarray, " s"]


def ensembles(stances: Sequence[JudgedStance]) -> dict[str, list[Ensemble]]:
    """By setting: simulated, measured, and by the predictors without a model, each over the same stances.

    Stances that a sole was fitted to are a group of their own.
    """
    plain = {name: plain_curves(stances, name) for name in QUANTITIES}
    return {
        setting: [one for name in QUANTITIES for one in _ensembles(own, name, plain[name])]
        for setting, own in by_setting_and_calibrated(stances).items()
    }


def _ensembles(own: Sequence[JudgedStance], name: str, plain: PlainCurves) -> Iterator[Ensemble]:
    for label, curves in (
        (name, [at_shares_of(own[0], one.simulated(name), one) for one in own]),
        (f"{name} measured", [at_shares_of(own[0], one.measured(name), one) for one in own]),
        *((f"{name} {label}", curves_of(plain, own, label, own[0])) for label in PLAIN),
    ):
        if curves:
            yield Ensemble(name, label, np.mean(curves, axis=0), np.std(curves, axis=0))


def odd_stances(stances: Sequence[JudgedStance]) -> dict[str, Oddness]:
    """How far the force of each stance that nothing was fitted to stands out, by name."""
    return oddness({one.name: one.errors.table["resultant"][1] for one in stances if not one.calibrated})
