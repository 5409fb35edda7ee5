"""`numbers.csv` is what ran: read back, it alone gives the equations' numbers and inputs, and the same curves."""

from __future__ import annotations

import csv
import warnings
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import bushing_of, read, walk_of
from geocontact.analyses.prosthesis.stance_files import numbers_table
from geocontact.below_knee_prosthesis.foot_numbers import all_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg import Inertial, Leg, Person
from geocontact.below_knee_prosthesis.leg_tree import LegMotion, driving_inputs
from geocontact.below_knee_prosthesis.recorded_walk import Walk
from geocontact.below_knee_prosthesis.simulate import simulate_stance
from geocontact.below_knee_prosthesis.stance_model import stance_numbers
from geocontact.contact.bushing import Bushing
from geocontact.data.body_segments import body_segments
from geocontact.io.text.results import write_table
from geocontact.loads.sphere_set import SoleLaw, SphereSet
from tests.analyses.prosthesis.test_simulate import GIVEN, TRIAL
from tests.recording import opened

LAW = """
n = 1.2
[zone.forefoot]
k = 61e3
b = 410.0
mu_s = 0.66
mu_k = 0.55
[zone.heel_back]
k = 21e3
"""
FOOT = """
[foot]
height = 0.7e-3
pitch = -0.0131
pitch_sd = 0.002
"""
ZONES = ("heel_back", "heel_middle", "heel_front", "midfoot", "forefoot")
SIX = [f"socket_{kind}{axis}" for kind in "rt" for axis in "xyz"]


@dataclass(frozen=True, eq=False)
class TableLeg(Leg):
    """A leg whose masses are those of the table, whatever a table of segments says."""

    told: dict[str, float] = field(default_factory=dict)

    def of(self, name: str) -> float:
        return self.told[f"leg {name}"]

    def thigh_body(self) -> Inertial:
        return self.of("thigh_mass"), np.array([0.0, -self.of("thigh_centre"), 0.0]), np.zeros((3, 3))

    def residual_body(self) -> Inertial:
        return self.of("residual_mass"), np.array([0.0, -self.of("residual_centre"), 0.0]), np.zeros((3, 3))

    def prosthesis_body(self) -> Inertial:
        rows = ("xx", "xy", "xz"), ("xy", "yy", "yz"), ("xz", "yz", "zz")
        inertia = np.array([[self.of(f"prosthesis_I{name}") for name in row] for row in rows])
        return self.of("prosthesis_mass"), three(self.told, "leg prosthesis_centre"), inertia


def three(told: dict[str, float], name: str) -> np.ndarray:
    return np.array([told[f"{name}_{axis}"] for axis in "xyz"])


def leg_of(told: dict[str, float]) -> TableLeg:
    person = Person(told["leg mass"], body_segments("male"), told["leg residual_share"], told["leg prosthesis_mass"])
    places = [three(told, f"leg {name}") for name in ("hip", "ankle", "keel")]
    turn = Rotation.from_rotvec(three(told, "leg turn"))
    sizes = told["leg thigh_length"], places[1], told["leg knee_radius"], places[2], turn
    return TableLeg(person, places[0], *sizes, told=told)


def foot_of(told: dict[str, float]) -> VariableStiffnessFoot:
    of = {name: told[f"keel {name}"] for name in ("length", "posterior", "bending", "retardation", "width")}
    of |= {name: told[f"keel {name}"] for name in ("thickness", "density")}
    keel = Keel(**of, joints=int(told["keel joints"]), torsional=1.0, support="pinned", range=(0.066, 0.151))
    for k, stiffness in enumerate(keel.stiffness(told["fulcrum"]), start=1):
        assert stiffness == pytest.approx(told[f"keel stiffness_{k}"], rel=1e-10)  # a file has 12 digits
    places, zones = [], []
    for zone in ZONES:
        for k in range(1, sum(name.startswith(f"sole {zone}_") and name.endswith("_x") for name in told) + 1):
            low = told["sole radius"] - told["sole below"]
            places.append((told[f"sole {zone}_{k}_x"], low, told[f"sole {zone}_{k}_z"]))
            zones.append(zone)
    centre = np.array(places)
    spheres = SphereSet(centre, np.full(len(places), told["sole radius"]), tuple(zones))
    by = {kind: np.array([told[f"sole {z}_{kind}"] for z in zones]) for kind in ("stiffness", "damping")}
    by |= {kind: np.array([told[f"sole {z}_{kind}"] for z in zones]) for kind in ("static", "kinetic")}
    shared = {name: told[f"sole {name}"] for name in ("exponent", "full_depth", "threshold_speed")}
    sole = KeelSole(spheres, tuple(keel.segment_of(centre[:, 0])))
    return replace(vsf_foot(), keel=keel, sole=sole, law=SoleLaw(**by, **shared))


def socket_of(told: dict[str, float]) -> Bushing:
    return Bushing(*(tuple(told[f"{name} {kind}"] for name in SIX) for kind in ("stiffness", "damping")))


def read_back(folder: Path) -> dict[str, float]:
    lines = [line for line in (folder / "numbers.csv").read_text().splitlines() if not line.startswith("#")]
    return {row["number"]: float(row["value"]) for row in csv.DictReader(lines)}


def walk_and_table(folder: Path, **options: Any) -> tuple[Walk, ProsthesisSimulateOptions, dict[str, float]]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        o = ProsthesisSimulateOptions(TRIAL / "walking.trc", **(GIVEN | options))
        opened(Record("prosthesis simulate", {}))
        walk = walk_of(read(o), o)
    write_table(numbers_table(all_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))), folder, "numbers")
    return walk, o, read_back(folder)


@pytest.mark.parametrize("changed", ["built in", "law", "foot", "socket", "setting"])
def test_the_table_alone_gives_the_equations_their_numbers(tmp_path: Path, changed: str) -> None:
    """EI 22.74 and 46 000 N/m stood there for 19.74 and 38 547, and the built-in sole under `law`."""
    (tmp_path / "law.toml").write_text(LAW + FOOT * (changed == "foot"))
    options: dict[str, Any] = {
        "built in": {},
        "law": {"law": tmp_path / "law.toml"},
        "foot": {"law": tmp_path / "law.toml"},
        "socket": {"socket": "as_printed"},
        "setting": {"setting": "high"},
    }[changed]
    walk, o, told = walk_and_table(tmp_path, **options)
    leg, foot = leg_of(told), foot_of(told)
    ran = stance_numbers(walk.leg, walk.foot, walk.fulcrum, bushing_of(o))
    np.testing.assert_allclose(stance_numbers(leg, foot, told["fulcrum"], socket_of(told)), ran, rtol=1e-9, atol=1e-11)
    assert (foot.law.exponent, foot.law.full_depth) == (walk.foot.law.exponent, walk.foot.law.full_depth)
    np.testing.assert_allclose(foot.sole.spheres.centre, walk.foot.sole.spheres.centre, atol=1e-12)
    assert foot.sole.segment == walk.foot.sole.segment
    motion = walk.walked.motion
    time = np.linspace(motion.time[3], motion.time[-4], 50)
    inputs = [
        driving_inputs(each, np.zeros((len(motion.time), 3))).at(time)
        for each in (motion, LegMotion(leg, motion.time, motion.values))
    ]
    np.testing.assert_allclose(inputs[1], inputs[0], rtol=1e-8, atol=1e-7)
    if changed == "built in":
        assert told["keel bending"] == pytest.approx(19.74, abs=0.005)
        assert told["sole forefoot_stiffness"] == pytest.approx(38547.0, abs=1.0)
    if changed == "foot":
        assert (told["leg foot_height"], told["leg foot_pitch"], told["leg foot_pitch_sd"]) == (0.7e-3, -0.0131, 0.002)
        without = walk_and_table(tmp_path, law=None)[2]
        turned = leg_of(without).turn.inv() * leg.turn
        assert turned.as_rotvec() == pytest.approx([0.0, 0.0, -0.0131], abs=1e-9)
    else:
        assert (told["leg foot_height"], told["leg foot_pitch"]) == (0.0, 0.0)
    if changed in ("law", "foot"):
        assert (told["sole forefoot_stiffness"], told["sole heel_back_stiffness"]) == (61e3, 21e3)
        assert told["sole exponent"] == 1.2


@pytest.mark.slow
def test_the_table_alone_gives_the_same_curves(tmp_path: Path) -> None:
    """Touch-down and loading, under a law from a file; what stood in the table before was 102 N (rms) off.

    The foot is beside its standing trial, by more than half a degree.
    """
    (tmp_path / "law.toml").write_text(LAW.replace("n = 1.2", "") + FOOT)
    walk, _, told = walk_and_table(tmp_path, law=tmp_path / "law.toml")
    motion = walk.walked.motion
    span = (float(motion.time[5]), float(motion.time[5]) + 0.35)
    ran = simulate_stance(motion, walk.foot, walk.fulcrum, walk.push, span, machine_code=False)
    leg = leg_of(told)
    again = simulate_stance(
        LegMotion(leg, motion.time, motion.values),
        foot_of(told),
        told["fulcrum"],
        walk.push,
        span,
        bushing=socket_of(told),
        machine_code=False,
    )
    assert ran.force[:, 1].max() > 300.0
    # 0.253 N fore and aft (rms 0.020), 0.008 and 0.025 N else, around 0.2 s where spheres creep; the same walk with its
    # angles changed in the 13th digit is 0.244 (rms 0.025), 0.013 and 0.020 N off, so that rounding makes all of it. As
    # its foot stood it was 0.085 N, and 0.2 and 0.03 N were allowed.
    np.testing.assert_allclose(again.force, ran.force, atol=0.5)
    assert np.sqrt(np.mean((again.force - ran.force) ** 2, axis=0)).max() < 0.05
    np.testing.assert_allclose(again.keel_angles, ran.keel_angles, atol=1e-6)  # 5e-8
