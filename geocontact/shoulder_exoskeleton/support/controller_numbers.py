"""Numbers of a device's controller: thresholds of its phases, noise and delay of its sensors.

A device states them in its file; what it does not state is a threshold tuned on synthetic trials (`phase_machine`), and
a sensor that is exact and in time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from geocontact.data.parameter import Number
from geocontact.shoulder_exoskeleton.device import DEG, Device, DeviceQuantity
from geocontact.shoulder_exoskeleton.support.phase_machine import Sensing, Thresholds

DEG_PER_S = "deg/s", DEG[1]
LATEST = 2.0
"""s; no controller waits or comes later."""


def _angle(what: str) -> DeviceQuantity:
    return DeviceQuantity("rad", DEG, 0.0, 3.0, what)


def _rate(what: str) -> DeviceQuantity:
    return DeviceQuantity("rad/s", DEG_PER_S, 1e-4, 20.0, what)


def _current(what: str) -> DeviceQuantity:
    return DeviceQuantity("A", ("A", 1.0), 0.0, 100.0, what)


def _time(what: str) -> DeviceQuantity:
    return DeviceQuantity("s", ("s", 1.0), 0.0, LATEST, what)


CONTROLLED: Mapping[str, DeviceQuantity] = {
    "low": _angle("elevation below which a resting arm may be"),
    "high": _angle("elevation above which an arm is raised whatever its rate"),
    "up": _rate("rate at which a lift begins"),
    "down": _rate("rate at which a lowering begins"),
    "still": _rate("rate below which a lowering may have ended"),
    "on": _current("current at which the tool runs"),
    "off": _current("current below which the tool does not run any more"),
    "confirmed": _time("time for which a condition of elevation and rate must hold"),
    "running": _time("time for which a condition of the current must hold"),
    "smoothing": _time("time constant of the low-pass on elevation and rate"),
    "settled": _time("time after the tool stops until a lowering may begin"),
    "turned": _time("time for which an arm that is lowered must rise to be lifted again"),
    "angle_noise": _angle("standard deviation of the sensor of the elevation"),
    "angle_step": _angle("step of the sensor of the elevation"),
    "delay": _time("delay of elevation and current"),
    "current_noise": _current("standard deviation of the sensor of the current"),
}
"""All numbers of a controller."""
SENSORS = {"noise": "angle_noise", "step": "angle_step", "delay": "delay", "current_noise": "current_noise"}
"""Fields of `Sensing` and their names in the file."""


def thresholds_of(device: Device) -> Thresholds:
    """Those of the device; ValueError for thresholds that contradict each other."""
    names = {each.name for each in fields(Thresholds)}
    return Thresholds(**{name: number.value for name, number in device.controller.items() if name in names})


def sensing_of(device: Device) -> Sensing | None:
    """Sensors as far as the device states them, the others exact; None where it states none."""
    stated = {name: device.controller[key].value for name, key in SENSORS.items() if key in device.controller}
    return Sensing(**{**dict.fromkeys(SENSORS, 0.0), **stated}) if stated else None


def controller_numbers(device: Device) -> dict[str, Number]:
    """Every number that runs, stated or by default."""
    used, exact = thresholds_of(device), "exact unless the device states it"
    usual = {each.name: (getattr(used, each.name), "tuned on synthetic trials") for each in fields(Thresholds)}
    usual |= dict.fromkeys(SENSORS.values(), (0.0, exact))
    return {name: device.controller.get(name, Number(value, "invented", note)) for name, (value, note) in usual.items()}
