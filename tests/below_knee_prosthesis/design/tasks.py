"""An invented stance that a foot has to carry."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.design.foot_task import FootTask, SagittalLeg


def a_task(frames: int = 12) -> FootTask:
    """From toes up to heel rise, 760 N in the middle."""
    share = np.linspace(0.0, 1.0, frames)
    return FootTask(
        time=0.6 * share,
        pitch=np.radians(8.0 - 26.0 * share),
        thigh=np.radians(24.0 - 22.0 * share),
        load=150.0 + 610.0 * np.sin(np.pi * share),
        forward=-90.0 * np.sin(2.0 * np.pi * share),
        falling=0.3,
        ankle=np.array([0.065, 0.04, 0.0]),
        bushing=np.array([0.065, 0.38, 0.0]),
        knee=np.array([0.065, 0.48, 0.0]),
        leg=SagittalLeg(
            body=62.0,
            length=0.44,
            thigh=(11.0, 0.18, 0.23),
            knee=np.array([0.065, 0.48]),
            centre=np.array([0.07, 0.28]),
            shank=(4.3, 0.13),
        ),
        leg_length=0.95,
        weight=760.0,
        pelvis=np.radians(-4.0 + 6.0 * share),
        acceleration=np.zeros((frames, 4)),
        needed=np.column_stack([8.0 - 30.0 * share, 5.0 - 12.0 * share]),
    )
