"""Models of the user's own: found where Python looks, never in the folder of a case; effects that their links carry."""

from __future__ import annotations

import importlib
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from geocontact.chain.effect import Candidate, Effect
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import LISTED_SYSTEMS, GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.simulator import SimulatorError
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import EFFECTS, candidates
from geocontact.io.cases.gap_case import program, read_gap_case
from geocontact.systems import elastic_joint
from geocontact.systems import knee_full_chain as full_chain
from geocontact.systems.acting_law import ActingLaw
from geocontact.systems.base import Base
from geocontact.systems.catalogue import SYSTEMS, system_of
from geocontact.systems.python_model import python_base
from geocontact.systems.simulator import PythonSimulator, Run, simulator_base
from tests.systems.examples import elbow, foot, joint
from tests.systems.test_command import Spring

MODEL = """
from dataclasses import replace
from types import SimpleNamespace

from geocontact.chain.effect import Candidate
from geocontact.chain.effect import Effect
from geocontact.chain.single_deflection import SingleDeflection
from geocontact.data.parameter import Parameter
from geocontact.systems import elastic_joint as model
from geocontact.systems.base import Base

def squared(angle, numbers):
    return angle * abs(angle) + numbers["shift"]

def offer(system):
    extra = Parameter("extra.torque", "N m", 1.0, 0.0, 9.0)
    def link(one):
        return replace(one, sensor=replace(one.sensor))
    return (Candidate("extra", "", "load", (extra,), link, {"extra.torque": 0.0}),)

def build(parameters, constants, tables):
    joint = model.build(parameters, {}, tables)
    extra = Effect("extra", "load", offer, "this test")
    geometry = SingleDeflection("angle", squared)
    return replace(joint, name="mine", constants=dict(constants), geometry=geometry, own=(extra,))

MINE = Base("mine", ("angle",), ("torque",), build)
LIKE = SimpleNamespace(name="mine", inputs=("angle",), outputs=("torque",), build=build)
ELBOW = Base("elbow", ("angle",), ("torque",), build)
TURNED = Base("mine", ("torque",), ("angle",), build)
DICT = Base("mine", ("angle",), ("torque",), lambda *given: {})
FAILS = Base("mine", ("angle",), ("torque",), lambda *given: 1 / 0)
NUMBER = 3.0

def wide(parameters, constants, tables):
    system = build(parameters, constants, tables)
    return replace(system, balance=replace(system.balance, total=lambda loads: loads.normal[:-1]))

WIDE = Base("mine", ("angle",), ("torque",), wide)
BARE = Base("mine", ("angle",), ("torque",), lambda *given: replace(build(*given), geometry=None))
"""


def trial(name: str, channels: tuple[str, ...] = ("angle", "torque"), unit: str = "rad") -> Trial:
    time = np.arange(0.0, 2.0, 0.05)
    values = np.column_stack([np.sin(3.0 * time + column) for column in range(len(channels))])
    return Trial(name, Signals(time, values, channels, (unit, *("N m",) * (len(channels) - 1))))


def case(system: str, one: Trial | None = None, constants: dict[str, float] | None = None) -> GapCase:
    k = Parameter("k", "N m/rad", 50.0, 1.0, 500.0)
    known = {"shift": 0.2} if constants is None else constants
    return GapCase("hinge", system, (trial("t01"),), (one or trial("t02"),), (k,), known)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a module of the user's own in it."""
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry])
    (tmp_path / "own_hinge.py").write_text(MODEL, encoding="utf-8")
    (tmp_path / "own_broken.py").write_text("import no_such_library\n", encoding="utf-8")
    (tmp_path / "own_leaving.py").write_text("raise SystemExit(3)\n", encoding="utf-8")
    (tmp_path / "own_typo.py").write_text("def build(:\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for name in ("own_hinge", "own_broken", "own_leaving", "own_typo"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    return tmp_path


@pytest.mark.parametrize("name", ["MINE", "LIKE"])
def test_own_model_runs_and_has_its_own_effect_beside_the_others(here: Path, name: str) -> None:
    given = case(f"own_hinge:{name}")
    system = system_of(given)
    angle = given.calibration[0].column("angle")
    got = system.simulate(given.calibration[0], system.start)[:, 0]
    np.testing.assert_allclose(got, 50.0 * (angle * np.abs(angle) + 0.2), rtol=1e-13)
    assert system.scale.deflection == pytest.approx(np.abs(angle * np.abs(angle) + 0.2).max())
    names = [one.name for one in candidates(system)]
    assert names[-1] == "extra"
    assert {"damping", "dry_friction", "series_compliance", "asymmetry", "unit_error", "saturation"} < set(names)


def test_a_model_of_the_package_is_one_like_any_other() -> None:
    assert system_of(case("geocontact.systems.elastic_joint:JOINT")).name == "elastic_joint"


@pytest.mark.parametrize(
    ("former", "expected"),
    [
        ("geocontact.systems.elastic_joint:JOINT", elastic_joint.JOINT),
        ("geocontact.systems.knee_chain:CELLS", full_chain.CELLS),
        ("geocontact.systems.knee_chain:SIDES", full_chain.SIDES),
        ("geocontact.systems.knee.full_chain:CELLS", full_chain.CELLS),
        ("geocontact.systems.elastic_joint.model:JOINT", elastic_joint.JOINT),
    ],
)
def test_a_case_may_name_a_model_of_the_package_as_before_it_moved(former: str, expected: Base) -> None:
    assert python_base(case(former)) is expected


@pytest.mark.parametrize(
    ("system", "words"),
    [
        ("own_absent:MINE", r"module own_absent cannot be imported: .*; start from the folder that holds it"),
        ("own_broken:MINE", r"cannot be imported: ModuleNotFoundError: No module named 'no_such_library'"),
        ("own_leaving:MINE", r"cannot be imported: SystemExit: 3"),
        ("own_typo:MINE", r"cannot be imported: SyntaxError"),
        ("own_hinge:THEIRS", r"has no object THEIRS"),
        ("own_hinge:NUMBER", r"is a float, not a base model; it needs name, inputs, outputs and build"),
        ("own_hinge:squared", r"is a function, not a base model"),
        ("own_hinge:ELBOW", r"is named elbow like a listed system"),
        ("own_hinge:TURNED", r"its system has the channels angle → torque"),
        ("own_hinge:DICT", r"build gave a dict"),
        ("own_hinge:FAILS", r"cannot be built: ZeroDivisionError: division by zero"),
        ("own_hinge:WIDE", r"gives \(39, 1\) values for trial t01; expected \(40, 1\)"),
        ("own_hinge:BARE", r"(its geometry is a NoneType|parameter 'geometry')"),
        ("antigravity:geohash", r"antigravity is a part of Python, not a model"),
    ],
)
def test_what_is_no_model_is_refused_in_one_line(here: Path, system: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        system_of(case(system))
    assert str(caught.value).startswith(f"hinge/case.toml system {system}: ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("one", "constants", "words"),
    [
        (trial("t02", ("angle",)), None, r"needs channel torque, which trial t02 lacks; it has angle"),
        (trial("t02", unit="m"), None, r"needs angle in rad, trial t02 gives m"),
        (None, {}, r"needs the number shift in trial t01; give it under \[constants\], \[parameters.shift\] or"),
    ],
)
def test_a_case_that_does_not_fit_the_model_is_refused(
    here: Path, one: Trial | None, constants: dict[str, float] | None, words: str
) -> None:
    with pytest.raises(InputError, match=words):
        system_of(case("own_hinge:MINE", one, constants))


def test_code_in_the_folder_of_a_case_is_not_run(here: Path) -> None:
    folder = here / "theirs"
    (folder / "trials").mkdir(parents=True)
    (folder / "own_guest.py").write_text("open('was_here', 'w')\n", encoding="utf-8")
    rows = "\n".join(f"{0.1 * i:.1f},{0.2 * i:.1f},1.0" for i in range(9))
    for name in ("t01", "t02"):
        (folder / "trials" / f"{name}.csv").write_text(f"time [s],angle [rad],torque [N m]\n{rows}\n")
    text = 'format = 1\nsystem = "own_guest:MINE"\ncalibration = ["t01"]\nevaluation = ["t02"]\n'
    (folder / "case.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="own_guest cannot be imported"):
        system_of(read_gap_case(folder))
    assert not (here / "was_here").exists()


def renamed(system: System) -> System:
    return replace(system, name="mine")


def names(system: System) -> set[str]:
    return {one.name for one in candidates(system)}


def test_links_decide_which_effects_an_own_model_gets() -> None:
    """The elbow and the foot under another name are offered the same."""
    # until effects asked for what a system has instead of its name, the first lacked inertia_load and had asymmetry and
    # contact_loss besides
    assert names(renamed(elbow())) == names(elbow()) >= {"inertia_load"}
    assert names(renamed(foot())) == names(foot()) >= {"inertia_load"}


def test_what_the_model_has_is_not_offered_again() -> None:
    damped = replace(joint(), law=joint().law.having({"damping.b": 1.0}))
    assert names(joint()) - names(damped) == {"damping"}


def test_own_effects_may_ask_for_slots_too() -> None:
    def offer(system: System) -> tuple[Candidate, ...]:
        return (Candidate("mine", "", "load", (), lambda one: one),)

    for slot, offered in (("damping.b", True), ("suction.force", False)):
        effect = Effect("mine", "load", offer, "here", (slot,))
        assert ("mine" in names(replace(joint(), own=(effect,)))) == offered


def test_listed_names_are_those_of_the_systems() -> None:
    assert {base.name for base in SYSTEMS} <= set(LISTED_SYSTEMS)


def blocks() -> list[str]:
    """Python of the page for users: a simulator, the model, a law, an effect, and three more.

    They are a simulator, one that takes a law, and a program, which commands write to a file.
    """
    page = Path(__file__).resolve().parents[2] / "docs" / "how-to" / "own_model.md"
    text = page.read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL) + re.findall(
        r"cat > simulator.py << 'END'\n(.*?)^END", text, re.DOTALL | re.MULTILINE
    )


def test_the_model_of_the_page_for_users_works(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, model, _, effect, _, _, _ = blocks()
    monkeypatch.delitem(sys.modules, "own_orthosis", raising=False)
    text = effect + model.replace('"N m"},', '"N m"}, own=(SECOND_STRUT,),')
    (here / "own_orthosis.py").write_text(text, encoding="utf-8")
    given = case("own_orthosis:ORTHOSIS", constants={"neutral": 0.1})
    system = system_of(given)
    angle = given.calibration[0].column("angle")
    base = 50.0 * np.sin(angle - 0.1) * np.cos(angle - 0.1)
    np.testing.assert_allclose(system.simulate(given.calibration[0], system.start)[:, 0], base, rtol=1e-12, atol=1e-12)
    strut = candidates(system)[-1].apply(system)
    values = {**system.start, "second_strut.stiffness": 30.0, "second_strut.gap": 0.2}
    want = base + 30.0 * np.maximum(angle - 0.2, 0.0)
    np.testing.assert_allclose(strut.simulate(given.calibration[0], values)[:, 0], want, rtol=1e-12, atol=1e-12)


def test_the_simulator_of_the_page_for_users_works(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against the branch's convolution; the diagnosis is offered what does not reach inside."""
    monkeypatch.delitem(sys.modules, "own_creeping", raising=False)
    (here / "own_creeping.py").write_text(blocks()[-3], encoding="utf-8")
    given = case("own_creeping:CREEPING", constants={"neutral": 0.1, "c": 4.0, "tau": 0.3})
    system = system_of(given)
    time, angle = given.calibration[0].time, given.calibration[0].column("angle")
    steps = np.diff(angle, prepend=angle[0])
    branch = np.exp(-np.maximum(time[:, None] - time, 0.0) / 0.3) * (time[:, None] >= time) @ steps
    want = 50.0 * (angle - 0.1) + 4.0 * branch
    np.testing.assert_allclose(system.simulate(given.calibration[0], system.start)[:, 0], want, rtol=1e-9, atol=1e-9)
    offered = {one.name for one in candidates(system)}
    assert {"sensor_drift", "time_shift", "motion_offset", "unit_error"} <= offered
    assert not {"damping", "series_compliance"} & offered


def carriage(law: dict[str, str] | None = None) -> Base:
    """Mass and spring of its own beside the law."""

    def run(_: np.ndarray, inputs: np.ndarray, numbers: dict[str, float], acting: ActingLaw) -> np.ndarray:
        return numbers["M"] * acting.acceleration + numbers["c"] * inputs[0] + acting(inputs[0], acting.rate)

    return simulator_base("carriage", {"angle": "rad"}, {"torque": "N m"}, run, acts_on="angle", law=law)


def test_effects_of_a_law_act_inside_of_a_simulator() -> None:
    """As they do on a chain with the same law, whatever else the simulator does."""
    parameters = (Parameter("M", "kg m^2", 0.3, 0.0, 9.0), Parameter("c", "N m/rad", 4.0, 0.0, 99.0))
    parameters += (Parameter("k", "N m/rad", 50.0, 1.0, 500.0),)
    given = case("carriage")
    made = carriage({"k": "k"}).build(parameters, {}, {}).scaled(given.calibration)
    chain = elastic_joint.JOINT.build(parameters[2:], {"angle0": 0.0}, {}).scaled(given.calibration)
    trial, inputs = given.calibration[0], made.motion.seen(given.calibration[0], made.start)
    own = 0.3 * inputs.acceleration[0] + 4.0 * inputs.position[0]
    law = {"dry_friction", "damping", "dead_zone", "end_stop", "stiffening", "preload", "relaxation", "slip"}
    offered = {one.label: one for one in candidates(made)}
    assert law <= {one.name for one in offered.values()} and "series_compliance" not in offered
    for one in candidates(chain):
        if one.name in law and one.label in offered:
            values = {**made.start, **one.starts[0]}
            want = one.apply(chain).simulate(trial, values)[:, 0] + own
            found = offered[one.label].apply(made).simulate(trial, values)[:, 0]
            np.testing.assert_allclose(found, want, rtol=1e-9, atol=1e-9, err_msg=one.label)
    np.testing.assert_allclose(made.simulate(trial, made.start)[:, 0], own + 50.0 * inputs.position[0], atol=1e-9)


def test_a_law_goes_from_step_to_step_as_along_a_run() -> None:
    """With friction and creep, which remember."""
    time = np.linspace(0.0, 2.0, 81)
    u = np.sin(3.0 * time)
    v = 3.0 * np.cos(3.0 * time)
    numbers = INTERFACE_LAW.having(
        {"k": 5.0, "dry_friction.stroke.limit": 2.0, "dry_friction.stroke.reach": 0.1, "relaxation.ratio": 0.5}
    ).numbers({})
    acting = ActingLaw(time, v, -9.0 * u, numbers)
    force = acting.stepper()
    steps = [force(u[i], v[i], time[i] - time[i - 1] if i else 0.0) for i in range(len(time))]
    np.testing.assert_allclose(steps, acting(u, v), rtol=1e-12, atol=1e-12)
    assert np.abs(acting(u, v) - 5.0 * u).max() > 1.0
    with pytest.raises(ValueError, match=r"a deflection \(3,\) where \(81,\) is expected"):
        acting(u[:3])


def test_a_law_needs_an_input_to_act_on() -> None:
    def run(time: np.ndarray, inputs: np.ndarray, numbers: dict[str, float]) -> np.ndarray:
        return inputs[0]

    with pytest.raises(ValueError, match="acts_on names 'x'; inputs are q"):
        simulator_base("s", {"q": "m"}, {"force": "N"}, run, acts_on="x")
    with pytest.raises(ValueError, match="a law without acts_on"):
        simulator_base("s", {"q": "m"}, {"force": "N"}, run, law={"k": "k"})


def test_the_simulator_with_a_law_of_the_page_for_users_works(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "own_carriage", raising=False)
    (here / "own_carriage.py").write_text(f"import geocontact as gc\n\n{blocks()[-2]}", encoding="utf-8")
    monkeypatch.chdir(here)
    monkeypatch.syspath_prepend(here)
    base = importlib.import_module("own_carriage").CARRIAGE
    made = base.build((Parameter("M", "kg", 90.0, 1.0, 500.0), Parameter("F_v", "N s/m", 200.0, 0.0, 900.0)), {}, {})
    time = np.linspace(0.0, 2.0, 101)
    moved = Trial("t", Signals(time, np.column_stack([0.1 * np.sin(3.0 * time)] * 2), ("q", "force"), ("m", "N")))
    seen = made.motion.seen(moved, made.start)
    want = 90.0 * seen.acceleration[0] + 200.0 * seen.rate[0]
    np.testing.assert_allclose(made.simulate(moved, made.start)[:, 0], want, rtol=1e-9, atol=1e-9)
    assert "dry_friction" in {one.name for one in candidates(made.scaled((moved,)))}


@pytest.mark.parametrize(
    ("answer", "complaint"),
    [
        (lambda time, inputs, numbers: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda time, inputs, numbers: inputs, "gave an array (1, 21) where (21, 2) is expected: a row per time"),
        (lambda time, inputs, numbers: np.full((21, 2), np.nan), "gave values that are not finite"),
    ],
)
def test_a_run_that_fails_says_why(answer: Run, complaint: str) -> None:
    simulator = PythonSimulator(answer, ("a",), ("b", "c"), {"a": "rad", "b": "N", "c": "N"})
    with pytest.raises(SimulatorError, match=re.escape(complaint)):
        simulator.run(np.linspace(0.0, 1.0, 21), np.zeros((1, 21)), {})


def test_the_program_of_the_page_for_users_works(tmp_path: Path) -> None:
    """Which is the spring that the tests of programs have in place of one."""
    (tmp_path / "simulator.py").write_text(blocks()[-1], encoding="utf-8")
    words = f'"{sys.executable}" -S -E "{tmp_path / "simulator.py"}" {{params}} {{trial}} {{out}}'
    own = program(words, ("angle",), ("torque",), {"angle": "rad", "torque": "N m"})
    time = np.linspace(0.0, 1.0, 21)
    angle, numbers = np.sin(3.0 * time)[None], {"k": 60.0, "neutral": 0.05, "h": 0.0, "level": 0.0}
    np.testing.assert_allclose(own.run(time, angle, numbers), Spring().run(time, angle, numbers), rtol=1e-12)


def test_the_table_of_the_page_for_users_names_every_effect() -> None:
    page = Path(__file__).resolve().parents[2] / "docs" / "how-to" / "own_model.md"
    table = page.read_text(encoding="utf-8").split("## Which effects it gets")[1].split("##")[0]
    assert {effect.name for effect in EFFECTS} <= set(re.findall(r"\w+", table))
