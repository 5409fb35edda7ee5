"""Scales of a support profile by the weight of each person's arm: the paper's personal setting of the support level."""

from __future__ import annotations

from collections.abc import Collection, Mapping


def scales_of(moments: Mapping[str, float], makers: Collection[str]) -> dict[str, float]:
    """By person what a profile is multiplied by: the moment of the arm's weight over the largest of its makers.

    Whoever has a heavier arm than all of them gets what the heaviest has: no simulation shows how a cuff holds more.

    Parameters
    ----------
    moments
        Of all persons [N m], see `human_arm.arm_weight`.
    makers
        Persons the profile is made with.
    """
    largest = max(moments[each] for each in makers)
    return {person: min(1.0, moment / largest) for person, moment in moments.items()}
