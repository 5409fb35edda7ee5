"""Systems on synthetic trials: elbow, foot, shoulder, knee, three straps, and an own model, a joint."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.chain.system import System
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.systems import elastic_joint, sit_to_stand
from geocontact.systems import elbow as elbow_exoskeleton
from geocontact.systems import foot as prosthetic_foot
from geocontact.systems import knee as knee_implant
from geocontact.systems import shoulder as shoulder_exoskeleton

FOOT_CONSTANTS = {"n": 1.2, "delta_full": 0.002, "mu_s": 0.9, "mu_k": 0.7, "v_th": 0.25}
ELBOW_CONSTANTS = {"l": 0.185, "z": 0.09}
ELBOW_VALUES = {"k": 300.0, "x": 0.03, "y": 0.04}
JOINT_CONSTANTS = {"angle0": 0.1, "hardening": 0.6}
KNEE_CONSTANTS = {"R": 0.037}
SITES_CONSTANTS = {"b": 80.0}
STIFFNESS = {"pelvis": 4000.0, "thigh": 7000.0, "shank": 5500.0}
LEVERS = {"pelvis": 0.04, "thigh": -0.03, "shank": 0.05}
NAMES = ("elbow", "foot", "shoulder", "knee", "sit_to_stand", "joint")
SHOULDER_CONSTANTS = {"L_h": 0.25, "o_x": 0.01, "o_y": 0.02, "I": 0.09, "c": 0.2, "l_c": 0.2}


def recording(name: str, time: np.ndarray, columns: dict[str, np.ndarray], **covariates: float) -> Trial:
    values = np.column_stack(list(columns.values()))
    return Trial(name, Signals(time, values, tuple(columns), ("",) * len(columns)), covariates)


def elbow_angle(time: np.ndarray, speed: float) -> np.ndarray:
    """Sweeps of changing stroke, so that no two turns are alike."""
    return 1.1 + 0.55 * np.sin(speed * time) + 0.35 * np.sin(0.37 * speed * time + 1.0)


def elbow_trial(name: str, speed: float, step: float = 0.02, duration: float = 12.0) -> Trial:
    time = np.arange(round(duration / step) + 1) * step
    return recording(name, time, {"beta": elbow_angle(time, speed), "force": np.full(time.size, np.nan)})


def foot_trial(name: str, depth: float, step: float = 0.005, duration: float = 0.8) -> Trial:
    """Heel strike, flat foot, heel rise; the foot glides a little, the way real feet do on a plate."""
    time = np.arange(round(duration / step) + 1) * step
    phase = time / duration
    pitch = 0.25 - 0.7 * phase**2 + 0.06 * np.sin(3.0 * np.pi * phase)
    lowest = np.min([px * np.sin(pitch) + 0.012 * np.cos(pitch) - 0.011 for px in np.linspace(0.0, 0.22, 15)], axis=0)
    y = -lowest - depth * np.sin(np.pi * (0.05 + 0.9 * phase)) * (1.0 + 0.3 * np.cos(4.0 * np.pi * phase))
    x = 0.02 * phase + 0.003 * np.sin(2.0 * np.pi * phase)
    empty = np.full(time.size, np.nan)
    return recording(name, time, {"x": x, "y": y, "pitch": pitch, "force_x": empty, "force_y": empty, "cop_x": empty})


def knee_trial(name: str, speed: float, step: float = 0.01, duration: float = 3.0) -> Trial:
    """Two steps; both sides always carry something, neither all the time the larger part."""
    time = np.arange(round(duration / step) + 1) * step
    phase = 2.0 * np.pi * speed * time / duration
    flexion = 0.5 - 0.4 * np.cos(2.0 * phase) + 0.15 * np.sin(phase)
    medial = 1e-4 * (4.0 + 2.0 * np.sin(phase) + 1.2 * np.sin(3.0 * phase + 0.4))
    lateral = 1e-4 * (3.0 + 1.5 * np.sin(phase + 0.9) + 0.9 * np.cos(2.0 * phase))
    columns = {"flexion": flexion, "adduction": 0.02 * np.sin(phase), "area_medial": medial, "area_lateral": lateral}
    empty = np.full(time.size, np.nan)
    return recording(name, time, {**columns, "force_medial": empty, "force_lateral": empty})


def shoulder_trial(name: str, speed: float, level: float, step: float = 0.01, duration: float = 6.0) -> Trial:
    """An arm that is raised and lowered in strokes that are no two alike, a tool running now and then."""
    time = np.arange(round(duration / step) + 1) * step
    arm = 1.0 - 0.55 * np.cos(speed * time) - 0.2 * np.cos(0.45 * speed * time) + 0.04 * (1.0 - np.cos(8.0 * time))
    event = ((time > 0.4 * duration) & (time < 0.55 * duration)) | (time > 0.8 * duration)
    empty = np.full(time.size, np.nan)
    columns = {"arm": arm, "event": event.astype(float), "exo": empty, "force": empty}
    return recording(name, time, columns, level=level)


def support() -> pd.DataFrame:
    angle = np.linspace(-0.6, 2.8, 18)
    return pd.DataFrame({"angle [rad]": angle, "torque [N m]": 7.5 * np.maximum(np.sin(1.05 * angle + 0.1), 0.0)})


def shoulder() -> System:
    bounds = (("k_t", "N/m", 700.0, 100.0, 5000.0), ("b_t", "N s/m", 20.0, 0.0, 100.0), ("m", "kg", 1.6, 0.3, 5.0))
    parameters = tuple(Parameter(*each) for each in bounds)
    return shoulder_exoskeleton.build(parameters, SHOULDER_CONSTANTS, {"support": support()})


def knee() -> System:
    return knee_implant.build((Parameter("E_star", "Pa", 1.2e7, 2e6, 8e7),), KNEE_CONSTANTS, {})


def sites_trial(name: str, speed: float, step: float = 0.02, duration: float = 6.0) -> Trial:
    """Every site pressed and let go until it pulls, in its own time; rotations do not follow displacements."""
    time = np.arange(round(duration / step) + 1) * step
    columns: dict[str, np.ndarray] = {}
    for i, site in enumerate(sit_to_stand.SITES):
        phase = speed * time + 0.9 * i
        slow = np.sin((0.41 + 0.07 * i) * phase + 2.0 * i)
        columns[f"{site}_normal"] = 0.004 + 0.007 * np.sin(phase) + 0.004 * slow
        columns[f"{site}_tangential"] = 0.003 * np.cos(0.7 * phase)
        columns[f"{site}_rotation"] = 0.05 * np.cos(0.53 * phase + i) + 0.04 * np.sin(1.3 * phase)
    forces = {f"{site}_force": np.full(time.size, np.nan) for site in sit_to_stand.SITES}
    return recording(name, time, columns | forces)


def sites() -> System:
    parameters = [Parameter(f"k_n_{site}", "N/m", k, 1000.0, 25000.0) for site, k in STIFFNESS.items()]
    parameters += [Parameter(f"rho_{site}", "m", rho, -0.15, 0.15) for site, rho in LEVERS.items()]
    return sit_to_stand.build(tuple(parameters), SITES_CONSTANTS, {})


def joint_trial(name: str, speed: float, setting: float, step: float = 0.02, duration: float = 12.0) -> Trial:
    time = np.arange(round(duration / step) + 1) * step
    angle = elbow_angle(time, speed) - 0.9
    return recording(name, time, {"angle": angle, "torque": np.full(time.size, np.nan)}, setting=setting)


def joint() -> System:
    """Stiffness that depends on a setting of the trial."""
    k, growth = Parameter("k", "N m/rad", 40.0, 5.0, 500.0), Parameter("growth", "-", 0.3, -2.0, 2.0)
    return elastic_joint.build((k, growth), JOINT_CONSTANTS, {})


def elbow() -> System:
    known = [Parameter(n, u, ELBOW_VALUES[n], a, b) for n, u, a, b in ELBOW_BOUNDS]
    return elbow_exoskeleton.build(tuple(known), ELBOW_CONSTANTS, {})


ELBOW_BOUNDS = (("k", "N/m", 50.0, 1000.0), ("x", "m", 0.0, 0.1), ("y", "m", 0.0, 0.12))


def spheres() -> pd.DataFrame:
    px = np.linspace(0.0, 0.22, 15)
    zone = [f"z{1 + i // 5}" for i in range(15)]
    return pd.DataFrame({"px [m]": px, "py [m]": 0.012, "radius [m]": 0.011, "zone": zone})


def foot() -> System:
    parameters = [Parameter(f"k_z{i}", "N/m^n", 8e4 * (1.0 + 0.2 * i), 8e3, 1e6) for i in (1, 2, 3)]
    parameters += [Parameter(f"b_z{i}", "N s/m", 100.0 + 40.0 * i, 0.0, 3000.0) for i in (1, 2, 3)]
    return prosthetic_foot.build(tuple(parameters), FOOT_CONSTANTS, {"spheres": spheres()})


def measured(system: System, trial: Trial) -> Trial:
    """The trial with what the base model says as its measurement."""
    outputs = system.simulate(trial, system.start)
    inputs = [trial.column(name) for name in system.inputs]
    columns = dict(zip((*system.inputs, *system.outputs), [*inputs, *outputs.T], strict=True))
    return recording(trial.name, trial.time, columns, **trial.covariates)


def example(name: str, refine: int = 1) -> tuple[System, tuple[Trial, ...]]:
    """A scaled system and its trials, sampled `refine` times as finely."""
    if name == "elbow":
        system = elbow()
        trials = tuple(elbow_trial(f"t{i}", speed, 0.02 / refine) for i, speed in enumerate((1.3, 2.9)))
    elif name == "knee":
        system = knee()
        trials = tuple(knee_trial(f"t{i}", speed, 0.01 / refine) for i, speed in enumerate((1.0, 1.7)))
    elif name == "sit_to_stand":
        system = sites()
        trials = tuple(sites_trial(f"t{i}", speed, 0.02 / refine) for i, speed in enumerate((2.3, 3.7)))
    elif name == "shoulder":
        system = shoulder()
        told = enumerate(((1.3, 0.3), (2.6, 1.0)))
        trials = tuple(shoulder_trial(f"t{i}", speed, level, 0.01 / refine) for i, (speed, level) in told)
    elif name == "joint":
        system = joint()
        told = enumerate(((1.3, -1.0), (2.9, 1.0)))
        trials = tuple(joint_trial(f"t{i}", speed, setting, 0.02 / refine) for i, (speed, setting) in told)
    elif name == "foot":
        system = foot()
        trials = tuple(foot_trial(f"t{i}", depth, 0.005 / refine) for i, depth in enumerate((0.006, 0.009)))
    else:
        raise ValueError(name)
    recorded = tuple(measured(system, trial) for trial in trials)
    return system.scaled(recorded), recorded
