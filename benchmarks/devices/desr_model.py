"""The prosthetic ankle of the DESR data as an own model: `system = "benchmarks.devices.desr_model:ANKLE"`.

The base is an elastic joint along the mean of its two designed cam profiles. What that leaves out by intention is an
effect of its own, `cam_switch`: the foot runs along one cam while it dorsiflexes and along the other on the way back,
and changes between them near the ends of its range, where both have the same profile.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.links import Channels, Modifier, Values
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.systems import elastic_joint
from geocontact.systems.base import Base

RANK = 5.0
SWITCHED = (-0.15, 0.17)
"""Angles [rad] beyond which the foot has changed cams; both profiles are the same there."""


def on_dorsal_cam(angle: np.ndarray, low: float, high: float) -> np.ndarray:
    """1 from the first sample below `low` to the next above `high`, else -1: a relay, off at the start."""
    state = np.where(angle < low, 1.0, np.where(angle > high, -1.0, np.nan))
    state[0] = -1.0 if np.isnan(state[0]) else state[0]
    last = np.maximum.accumulate(np.where(np.isnan(state), 0, np.arange(state.size)))
    return state[last]


def cam_switch(cams: pd.DataFrame) -> Effect:
    """Half the difference of the two cams, to the side that the foot runs along.

    The amplitude is its share, 1 as designed and 0 for the mean of both; the shape stretches it along the angle.
    """
    angle = cams["angle [rad]"].to_numpy(float)
    mean, apart = (0.5 * (cams["dorsal [N m]"] + sign * cams["plantar [N m]"]).to_numpy(float) for sign in (1.0, -1.0))
    half = apart / (np.ptp(mean[[0, -1]]) / np.ptp(angle))

    def offer(system: System) -> tuple[Candidate, ...]:
        share = Parameter("cam_switch.share", "-", 0.5, 0.0, 2.0)
        stretch = Parameter("cam_switch.stretch", "-", 1.0, 0.7, 1.6)

        def change(outputs: Channels, movement: DifferentiatedInputs, values: Values) -> Channels:
            at = movement.position[0] - values.get("angle0", 0.0)
            aside = np.interp(at / values[stretch.name], angle, half) * on_dorsal_cam(at, *SWITCHED)
            stiffness = elastic_joint.stiffness_at_setting(values)
            return np.asarray(outputs + (values[share.name] * stiffness * aside)[:, None])

        modifier = Modifier("cam_switch", RANK, change)
        return (
            Candidate(
                "cam_switch",
                "",
                "constitutive",
                (share, stretch),
                lambda one: replace(one, balance=one.balance.having(modifier)),
                {share.name: 0.0},
                ({stretch.name: 1.3},),
            ),
        )

    return Effect("cam_switch", "constitutive", offer, "two cam profiles of the DESR foot")


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The elastic joint with its table `curve`, which has the columns dorsal and plantar besides."""
    joint = elastic_joint.build(parameters, constants, tables)
    return replace(joint, name=ANKLE.name, own=(cam_switch(tables["curve"]),))


ANKLE = Base("desr_ankle", elastic_joint.INPUTS, elastic_joint.OUTPUTS, build)
