"""Intervals of the exoskeleton's dynamic parameters over noises: `python -m benchmarks.standing.device`. Synthetic."""

from __future__ import annotations

import time

import numpy as np

from benchmarks.machine import write_results
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton_torque import DeviceMotion, identified_from
from meshes.standing_unloaded import TURN_NOISE, planted, synthetic_unloaded

SEEDS, CUTOFF, REACH = 30, 6.0, 1.96


def main() -> None:
    """With encoders as shipped and exact ones; writes benchmarks/results/standing_device.json."""
    figures = {
        "encoders as shipped": over_noises(TURN_NOISE),
        "exact encoders": over_noises(0.0),
    }
    print(write_results("standing_device", {"seeds": SEEDS, "cutoff": CUTOFF}, figures).read_text("utf-8"))


def over_noises(turn_noise: float) -> dict[str, object]:
    """How often each interval of 95 % holds what was planted, and by how many deviations the values are off."""
    began, rows = time.process_time(), []
    for seed in range(SEEDS):
        found = once(turn_noise, seed)
        rows.append((found.values - planted(found.subject))[found.alone] / found.deviations[found.alone])
    off = np.array(rows)
    held = (np.abs(off) <= REACH).sum(axis=0)
    names = [name for name, alone in zip(found.names, found.alone, strict=True) if alone]
    return {
        "held": dict(zip(names, held.tolist(), strict=True)),
        "held of all": f"{int(held.sum())} of {off.size}",
        "mean off in standard deviations": dict(zip(names, off.mean(axis=0).round(2).tolist(), strict=True)),
        "left of the torques [N m]": found.residual,
        "cpu seconds": time.process_time() - began,
    }


def once(turn_noise: float, seed: int):  # type: ignore[no-untyped-def]
    """As the command does it."""
    subject = Subject()
    times, q, motors = synthetic_unloaded(subject, seed, turn_noise)
    return identified_from(subject, DeviceMotion.smoothed(times, q, motors, CUTOFF), CUTOFF)


if __name__ == "__main__":
    main()
