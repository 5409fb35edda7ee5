import ast
import dataclasses
import itertools
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import solve_triangular

import geocontact.gap.benchmark.planted as planted
from geocontact.gap.benchmark.planted import KINDS, cases, plant
from geocontact.gap.benchmark.planted.base_fit import jacobian
from geocontact.gap.benchmark.planted.cases import prepared
from geocontact.gap.benchmark.planted.catalogue import TABLE, plans
from geocontact.gap.benchmark.planted.course import through
from geocontact.gap.benchmark.planted.elbow import NotConvergedError
from geocontact.gap.benchmark.planted.foot import Sole
from geocontact.gap.benchmark.planted.hooks import BASE, Hooks
from geocontact.gap.benchmark.planted.noise import Coloured, smooth_covariance, smooth_noise
from geocontact.gap.benchmark.planted.outside.catalogue import outsiders
from geocontact.gap.benchmark.planted.reach import shortest
from geocontact.gap.benchmark.planted.scene import SCENES
from geocontact.gap.benchmark.planted.trials import Fault, as_measured, fine_enough, record, samples, truth
from geocontact.systems.catalogue import system_of

ALLOWED = {"numpy", "scipy", "pandas", "numba", "jaxtyping"}
STANDARD = {"__future__", "collections", "dataclasses", "functools", "inspect", "math", "typing"}
INPUTS = {"elbow": ("beta",), "foot": ("x", "y", "pitch")}


@pytest.fixture(autouse=True)
def _few_fresh_trials(monkeypatch):
    monkeypatch.setattr(cases, "FRESH", 6)


def test_it_shares_nothing_with_the_candidates():
    for file in Path(planted.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) else []
            for name in names:
                own = name.startswith(("geocontact.data.", "geocontact.gap.benchmark.planted"))
                assert own or name.split(".")[0] in ALLOWED | STANDARD, f"{file.name} imports {name}"


def test_every_file_says_what_is_planted_and_what_the_candidate_does():
    assert len({name for name, *_ in TABLE}) == len(TABLE) == 21
    for name, equation, candidate in TABLE:
        text = (Path(planted.__file__).parent / "effects" / f"{name}.py").read_text()
        assert "planted:" in text and "candidate:" in text and equation != candidate


@pytest.fixture(scope="module")
def stages():
    """A scene of each system with three calibration movements."""
    found = {}
    for system, make in SCENES.items():
        rng = np.random.default_rng(4)
        scene = make(rng, shifted=False)
        found[system] = prepared(scene, [scene.path(rng) for _ in range(2)], "single")
    return found


@pytest.mark.parametrize("system", SCENES)
def test_base_models_agree_with_those_of_the_package(system):
    case = plant(system, "none", 3).case
    theirs = system_of(case)
    scene = SCENES[system](np.random.default_rng(0), shifted=False)
    scene = dataclasses.replace(scene, constants=case.constants, parameters=case.parameters)
    theta = np.array([0.7 * p.start for p in case.parameters])
    if system == "foot":
        theta[len(theta) // 2 :] = 0.0  # rates are taken in another way; without damping only friction feels it
        scene = dataclasses.replace(scene, sole=sole_of(case))
    for trial in case.calibration:
        inputs = np.array([trial.column(name) for name in scene.inputs])
        course = through(trial.time, inputs, float(trial.time[-1]), 0.0)(trial.time)
        ours = scene.base_model(course)(theta)
        other = theirs.simulate(trial, scene.numbers(theta)).T
        there = np.isfinite(other)
        rows = [0] if system == "elbow" else [1, 2]
        for row in rows:
            np.testing.assert_allclose(ours[row][there[row]], other[row][there[row]], rtol=1e-9, atol=1e-12)
        if system == "foot":
            assert np.sqrt(np.mean((ours[0] - other[0]) ** 2)) < 0.1 * np.abs(other[0]).max()


def sole_of(case):
    table = case.tables["spheres"]
    names = tuple(dict.fromkeys(table["zone"]))
    zone = np.array([names.index(z) for z in table["zone"]])
    return Sole(*(table[c].to_numpy(float) for c in ("px [m]", "py [m]", "radius [m]")), zone, names)


@pytest.mark.parametrize(("system", "kind"), list(itertools.product(SCENES, KINDS)))
def test_every_kind_is_what_it_says(system, kind):
    made = plant(system, kind, 1)
    case, label = made.case, made.label
    assert json.loads(json.dumps(label.as_dict()))["kind"] == kind
    assert label.kind == kind and case.system == system and kind not in case.name
    vocabulary = {one.name for one in plans(system)} | {"unit_error", "sign_flip", "side_swap"}
    assert set(label.effects) <= vocabulary
    assert len(label.effects) == {"none": 0, "outside": 0, "pair": 2}.get(kind, 1)
    assert 3 <= len(case.calibration) <= 4 and 2 <= len(case.evaluation) <= 3
    for trial in (*case.calibration, *case.evaluation):
        assert np.isfinite([trial.column(name) for name in INPUTS[system]]).all()
        assert (np.diff(trial.time) > 0.0).all()
    assert np.isclose(sum(label.shares.values()), 1.0)
    for low, high in label.window.values():
        assert 0.0 <= low < high <= 1.0
    if kind == "absorbed":
        assert max(label.nats.values()) < 2.0 and min(label.swallowed.values()) > 0.97
    if kind == "pair":
        one, other = label.nats.values()
        assert 1.0 / 3.5 < one / other < 3.5
    if kind in ("single", "shift", "fault", "outside"):
        assert min(label.nats.values()) > 2.9


def test_a_seed_is_a_case():
    one, same, other = (plant("elbow", "single", seed) for seed in (5, np.random.SeedSequence(5), 6))
    assert one.label == same.label and one.case.name == same.case.name
    np.testing.assert_array_equal(one.case.calibration[0].signals.values, same.case.calibration[0].signals.values)
    assert one.case.name != other.case.name


def test_what_is_asked_for_is_planted():
    label = plant("elbow", "single", 2, effect="damping", nats=50.0).label
    assert label.effects == ("damping",) and label.nats["damping"] == pytest.approx(50.0, rel=0.12)
    assert 0.0 < label.reduction["force"] < 1.0 and label.rmse_after["force"] < label.rmse_before["force"]


@pytest.mark.parametrize("system", SCENES)
def test_residuals_without_an_effect_have_the_covariance_that_visibility_is_measured_by(system, stages):
    stage, rng = stages[system], np.random.default_rng(8)
    scene, total, count = stage.scene, 0.0, 0
    for one in stage.trials * 3:
        recording = record(scene, one.path, rng)
        base = scene.base_model(as_measured(recording))(scene.theta)
        there = np.isfinite(one.outputs) & np.isfinite(recording.outputs)
        gap = np.where(there, recording.outputs - base, 0.0).ravel()
        by = np.where(there[..., None], jacobian(one.model, scene.theta), 0.0).reshape(gap.size, -1)
        white = solve_triangular(one.factor, gap, lower=True)
        spread = solve_triangular(one.factor, by @ np.linalg.cholesky(scene.spread), lower=True)
        inner = np.eye(spread.shape[1]) + spread.T @ spread
        total += white @ white - (spread.T @ white) @ np.linalg.solve(inner, spread.T @ white)
        count += there.sum()
    # chi squared over its degrees of freedom; 0.05 is 3.5 standard deviations for 2000
    assert total / count == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / count))


def test_noise_has_the_covariance_that_it_states():
    rng = np.random.default_rng(0)
    noise = Coloured(2.0, 0.4, 0.3, 0.3)
    drawn = np.array([noise.draw(rng, 30, 0.04) for _ in range(4000)])
    np.testing.assert_allclose(np.cov(drawn.T), noise.covariance(30, 0.04), atol=0.4)


@pytest.mark.parametrize("corner", [4.0, 6.0, 10.0])
def test_noise_of_inputs_has_the_covariance_that_it_states(corner):
    rng = np.random.default_rng(0)
    drawn = np.array([smooth_noise(rng, 1.0, 40, 0.005, corner) for _ in range(3000)])
    place, cross, rate = smooth_covariance(1.0, 40, 0.005, corner)
    np.testing.assert_allclose(np.cov(drawn.T), place, atol=0.12)
    slope = (drawn[:, 2:] - drawn[:, :-2]) / 0.01  # 2 % too small at 10 Hz
    assert np.var(slope) == pytest.approx(rate[0, 0], rel=0.05)
    assert np.mean(slope[:, 20] * drawn[:, 11]) == pytest.approx(cross[11, 21], rel=0.15)


def test_visibility_grows_with_the_square_of_a_linear_effect(stages):
    stage = stages["elbow"]

    def shown(size):
        push = Hooks(sensor=((1.0, lambda course, y: y + size * np.sin(3.0 * course.time)),))
        return stage.sight(push).nats

    assert shown(0.02) / shown(0.01) == pytest.approx(4.0, rel=1e-3)


def test_a_gain_of_the_elbow_is_swallowed_whole(stages):
    seen = stages["elbow"].sight(Hooks(sensor=((1.0, lambda _, y: 1.2 * y),)))
    assert seen.swallowed == pytest.approx(1.0, abs=1e-6) and seen.nats < 1e-3 < seen.whole


def test_the_truth_must_not_depend_on_the_step(stages):
    stage = stages["elbow"]
    path = stage.trials[0].path
    rough = Hooks(sensor=((1.0, lambda course, y: y + np.sign(course.time[1] - 1.3e-4 - 1e-9) * len(course.time)),))
    with pytest.raises(NotConvergedError, match="noise levels"):
        fine_enough(stage.scene, path, rough)


@pytest.mark.parametrize(
    ("system", "name"),
    [(s, one.name) for s in SCENES for one in (*plans(s), *outsiders(s)) if one.name not in ("held_samples", "jump")],
)
def test_every_effect_converges_with_the_step(system, name, stages):
    """Each changes the outputs, and a truth from steps half as long is the same."""
    stage = stages[system]
    scene, path = stage.scene, stage.trials[0].path
    plan = next(one for one in (*plans(system), *outsiders(system)) if one.name == name)
    draw = plan.draw(np.random.default_rng(1), stage.scale)
    hooks = draw.hooks(np.sqrt(draw.low * draw.high))
    fine = fine_enough(scene, path, hooks)
    count = samples(scene, path)
    with_it, without, finer = (
        truth(scene, path, count, scene.theta, h, f) for h, f in ((hooks, fine), (BASE, fine), (hooks, 2 * fine))
    )
    effect = np.nan_to_num(with_it - without) / stage.floor[:, None]
    off = np.nan_to_num(with_it - finer) / stage.floor[:, None]
    assert np.abs(effect).max() > 0.0
    assert np.sqrt(np.mean(off**2)) < 0.05


def test_mistakes_are_exact_and_can_be_mended(stages):
    scene = stages["foot"].scene
    inputs, outputs = np.random.default_rng(0).normal(size=(2, 3, 5))
    degrees = Fault("unit_error", "pitch", np.degrees(1.0))
    np.testing.assert_allclose(degrees.mended(scene, degrees.inputs(scene, inputs)), inputs)
    np.testing.assert_array_equal(degrees.outputs(scene, outputs), outputs)
    swapped = Fault("side_swap", "", 1.0, (0, 1)).outputs(scene, outputs)
    np.testing.assert_array_equal(swapped, outputs[[1, 0, 2]])


def test_the_shortest_window_is_found_by_trying_all():
    rng = np.random.default_rng(0)
    for _ in range(20):
        squares = rng.gamma(0.3, size=100)
        low, high = shortest(squares)
        i, j = round(100 * low), round(100 * high)
        assert squares[i:j].sum() >= 0.7 * squares.sum() * (1 - 1e-9)
        widths = [b - a for a in range(100) for b in range(a + 1, 101) if squares[a:b].sum() >= 0.7 * squares.sum()]
        assert j - i == min(widths)


@pytest.mark.parametrize("wrong", [{"system": "knee", "kind": "none"}, {"system": "elbow", "kind": "triple"}])
def test_what_does_not_exist_is_named(wrong):
    with pytest.raises(ValueError, match=r"knee|triple"):
        plant(**wrong, seed=0)
