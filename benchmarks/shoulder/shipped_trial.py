"""Shoulder exoskeleton along the synthetic trial that is shipped: `python -m benchmarks.shoulder.shipped_trial
[--rounds 5]`.

Error of angles and forces against a tolerance of 1e-10, for both arms and three support levels, and how much faster
than real time at that error, with and without a compiler; CPU seconds of one core, medians. Observed order with even
steps, energy balance with friction, twelve cases of two arms. Everything is synthetic.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
MARKERS = HERE.parent / "meshes" / "overhead_P1T1S100" / "markers.trc"
LEVELS = (0.0, 0.5, 1.0)
USUAL = 5e-7
TOLERANCES = (1e-3, 1e-4, 1e-5, 3e-6, 1e-6, USUAL)
REFERENCE = 1e-10
CUTOFF = 6.0  # Hz
STEPS = (1000, 2000, 4000, 8000)


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.shoulder.shipped_trial", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    arms = both_arms()
    report = {
        "machine": machine(),
        "versions": versions({"casadi", "numpy", "scipy"}),
        "trial_seconds": float(arms[0].time[-1] - arms[0].time[0]),
        "with a compiler": [tolerance(arms, each, options.rounds, machine_code=True) for each in TOLERANCES],
        "without": [tolerance(arms, USUAL, 1, machine_code=False)],
        "order": order(arms[0]),
        "energy": energy(arms[0]),
        "twelve cases of two arms": twelve(arms, options.rounds),
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "shoulder.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    print(json.dumps(report, indent=2))


def both_arms() -> list[Any]:
    """Of the shipped trial, filtered."""
    import numpy as np

    from geocontact.identify.signals.filters import filled_and_smoothed
    from geocontact.io.mocap.markers import read_markers
    from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, arm_motions

    found = []
    for arm in arm_motions(read_markers(MARKERS), MarkerSettings(upright=(0.0, 0.5))).arms:
        columns = np.hstack([arm.interface, arm.shoulder, arm.gravity_at_frames(), arm.elevation[:, None]])
        time, v = filled_and_smoothed(arm.time, columns, cutoff=CUTOFF, longest_gap=0.2)
        parts = {"interface": v[:, :3], "shoulder": v[:, 3:6], "gravity": v[:, 6:9], "elevation": v[:, 9]}
        found.append(replace(arm, time=time, **parts))
    return found


def simulated(arm: Any, level: float, **how: Any) -> Any:
    """One arm with the usual device on the usual person."""
    from geocontact.shoulder_exoskeleton.device import Wearer, lucy
    from geocontact.shoulder_exoskeleton.simulate import simulate_arm

    return simulate_arm(arm, lucy(), Wearer(), level, **how)


def cpu(run: Callable[[], Any], rounds: int) -> float:
    """Median of CPU seconds."""
    import numpy as np

    seconds = []
    for _ in range(rounds):
        start = time.process_time()
        run()
        seconds.append(time.process_time() - start)
    return float(np.median(seconds))


def tolerance(arms: list[Any], allowed: float, rounds: int, *, machine_code: bool) -> dict[str, float]:
    """Largest errors over arms, levels and frames, and the slowest of the arms."""
    import numpy as np

    angle, force, factors, steps = 0.0, 0.0, [], 0
    for arm in arms:
        for level in LEVELS:
            exact = simulated(arm, level, tolerance=REFERENCE)
            one = simulated(arm, level, tolerance=allowed, machine_code=machine_code)
            angle = max(angle, float(np.degrees(np.abs(one.angles - exact.angles)).max()))
            off = np.linalg.norm(one.outputs["force"] - exact.outputs["force"], axis=1)
            force, steps = max(force, float(off.max())), max(steps, one.steps)
            seconds = cpu(
                lambda arm=arm, level=level: simulated(arm, level, tolerance=allowed, machine_code=machine_code), rounds
            )
            factors.append(float(arm.time[-1] - arm.time[0]) / seconds)
    return {
        "tolerance": allowed,
        "largest_angle_error_deg": angle,
        "largest_force_error_N": force,
        "most_steps": steps,
        "times_real_time_median": float(np.median(factors)),
        "times_real_time_least": min(factors),
    }


def order(arm: Any) -> dict[str, list[float]]:
    """Errors of the angles at the end of the lift with even steps, before stick and slip, and the orders between."""
    import numpy as np

    from geocontact.shoulder_exoskeleton.device import Wearer, lucy
    from geocontact.shoulder_exoskeleton.simulate import simulate_arm

    first = arm.time <= arm.time[0] + 1.2
    parts = {name: getattr(arm, name)[first] for name in ("time", "interface", "shoulder", "gravity", "elevation")}
    start, smooth = replace(arm, **parts), lucy().having(v_th=0.2, b=0.0)
    exact = simulate_arm(start, smooth, Wearer(), 0.5, tolerance=1e-12).angles[-1]
    errors = [
        float(np.abs(simulate_arm(start, smooth, Wearer(), 0.5, steps=n).angles[-1] - exact).max()) for n in STEPS
    ]
    return {
        "steps": list(map(float, STEPS)),
        "errors_rad": errors,
        "orders": np.log2(np.divide(errors[:-1], errors[1:])).tolist(),
    }


def energy(arm: Any) -> dict[str, float]:
    """What is missing from the balance, over what friction and damping take [J]; gravity held, every millisecond."""
    import numpy as np
    from scipy.interpolate import make_interp_spline

    fine = np.arange(round((arm.time[-1] - arm.time[0]) / 1e-3) + 1) * 1e-3 + arm.time[0]
    place = make_interp_spline(arm.time, arm.interface, k=5)(fine)
    still = replace(
        arm, time=fine, interface=place, shoulder=place, elevation=np.zeros(len(fine)), gravity=arm.gravity[0]
    )
    told = simulated(still, 1.0, tolerance=1e-8).outputs
    balance = told["power_in"][:, 0] - told["power_lost"][:, 0]
    came = np.concatenate([[0.0], np.cumsum(0.5e-3 * (balance[1:] + balance[:-1]))])
    off = np.abs(told["energy"][:, 0] - told["energy"][0, 0] - came)
    return {"lost_J": float(np.trapezoid(told["power_lost"][:, 0], fine)), "missing_J": float(off.max())}


def twelve(arms: list[Any], rounds: int) -> dict[str, float]:
    """CPU seconds of twelve cases, six at half and six at full support, both arms."""
    cases = [(arm, level) for level in (0.5, 1.0) for _ in range(6) for arm in arms]
    return {"cpu_seconds": cpu(lambda: [simulated(arm, level) for arm, level in cases], rounds)}


if __name__ == "__main__":
    main()
