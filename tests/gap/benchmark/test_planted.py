import ast
import dataclasses
import itertools
import json
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import solve_triangular

import geocontact.gap_benchmark.synthetic as planted
from geocontact.gap_benchmark.drawing import SYSTEMS
from geocontact.gap_benchmark.synthetic import KINDS, cases, synthetic_case
from geocontact.gap_benchmark.synthetic.cases import prepared
from geocontact.gap_benchmark.synthetic.catalogue import NUMBERS, PLANS, SCENES, plans, unknown_effects
from geocontact.gap_benchmark.synthetic.course import through
from geocontact.gap_benchmark.synthetic.effects.kernels import crept, seated
from geocontact.gap_benchmark.synthetic.effects.unknown import UNKNOWN
from geocontact.gap_benchmark.synthetic.hooks import BASE, Hooks
from geocontact.gap_benchmark.synthetic.noise import Coloured, NoiseFilter, smooth_covariance, smooth_noise
from geocontact.gap_benchmark.synthetic.systems.foot import Sole, foot
from geocontact.gap_benchmark.synthetic.systems.interface import NotConvergedError, pull
from geocontact.gap_benchmark.synthetic.systems.knee import area_under, deflection
from geocontact.gap_benchmark.synthetic.systems.shoulder import shoulder
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand import inputs as inputs_of
from geocontact.gap_benchmark.synthetic.systems.sit_to_stand import sit_to_stand
from geocontact.gap_benchmark.synthetic.systems.swing import at_rest
from geocontact.gap_benchmark.synthetic.trials import (
    SyntheticDataError,
    as_measured,
    fine_enough,
    record,
    samples,
    truth,
)
from geocontact.gap_benchmark.synthetic.visibility import jacobian, shortest
from geocontact.systems.catalogue import system_of

pytestmark = pytest.mark.slow

ALLOWED = {"numpy", "scipy", "pandas", "numba", "jaxtyping"}
STANDARD = {"__future__", "collections", "dataclasses", "functools", "inspect", "math", "typing"}


@pytest.fixture(autouse=True)
def _few_fresh_trials(monkeypatch):
    monkeypatch.setattr(cases, "FRESH", 6)


def test_it_shares_nothing_with_the_candidates():
    for file in Path(planted.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) else []
            for name in names:
                own = name.startswith(("geocontact.data.", "geocontact.gap_benchmark.synthetic"))
                assert own or name.split(".")[0] in ALLOWED | STANDARD, f"{file.name} imports {name}"


def test_every_effect_says_what_is_planted_and_what_the_candidate_does():
    assert len({one.name for one in PLANS}) == len(PLANS) == 23
    for one in PLANS:
        text = one.draw.__doc__
        assert "planted:" in text and "candidate:" in text and one.planted != one.candidate


def test_every_effect_of_a_system_is_planned_and_every_plan_has_a_system():
    known, unknown = {one.name for one in PLANS}, {one.name for one in UNKNOWN}
    assert set().union(*(one.names for one in NUMBERS.values())) == known
    assert set().union(*(one.unknown for one in NUMBERS.values())) == unknown
    assert NUMBERS.keys() == SCENES.keys() and tuple(SCENES) == SYSTEMS
    for one in NUMBERS.values():
        assert set(one.no_gap) <= set(one.confounded) <= set(one.names)


@pytest.fixture(scope="module")
def stages():
    """A scene of each system with three calibration movements."""
    found = {}
    for system, make in SCENES.items():
        rng = np.random.default_rng({"shoulder": 59}.get(system, 4))  # pressed enough to lose contact
        scene = make(rng, shifted=False)
        found[system] = prepared(scene, [scene.path(rng, i) for i in range(2)], "single")
    return found


@pytest.mark.parametrize("system", SCENES)
def test_base_models_agree_with_those_of_the_package(system):
    case = synthetic_case(system, "none", 3).case
    if system == "sit_to_stand":  # rates are taken in another way
        case = dataclasses.replace(case, constants={"b": 0.0})
    theirs = system_of(case)
    scene = SCENES[system](np.random.default_rng(0), shifted=False)
    scene = dataclasses.replace(scene, constants=case.constants, parameters=case.parameters)
    theta = np.array([0.7 * p.start for p in case.parameters])
    if system == "foot":
        theta[len(theta) // 2 :] = 0.0  # likewise; without damping only friction feels it
        scene = dataclasses.replace(scene, body=foot(sole_of(case)))
    if system == "shoulder":
        scene = dataclasses.replace(scene, body=shoulder(case.tables["support"]))
    if system == "sit_to_stand":
        sites = tuple(name.removesuffix("_force") for name in theirs.outputs)
        scene = dataclasses.replace(scene, inputs=inputs_of(sites), outputs=theirs.outputs, body=sit_to_stand(sites))
    for trial in case.calibration:
        inputs = np.array([trial.column(name) for name in scene.inputs])
        course = through(trial.time, inputs, float(trial.time[-1]), 0.0, trial.covariates)(trial.time)
        ours = scene.base_model(course)(theta)
        other = theirs.simulate(trial, scene.numbers(theta)).T
        there = np.isfinite(other)
        if system == "shoulder":  # other steps through the noise of the recorded arm: far below that of the sensors
            off = (ours - other) / np.array([0.002, 0.4])[:, None]
            assert np.sqrt(np.mean(off**2)) < 0.03
            continue
        rows = [1, 2] if system == "foot" else range(len(scene.outputs))
        for row in rows:
            np.testing.assert_allclose(ours[row][there[row]], other[row][there[row]], rtol=1e-9, atol=1e-12)
        if system == "foot":
            assert np.sqrt(np.mean((ours[0] - other[0]) ** 2)) < 0.1 * np.abs(other[0]).max()


def sole_of(case):
    table = case.tables["spheres"]
    names = tuple(dict.fromkeys(table["zone"]))
    zone = np.array([names.index(z) for z in table["zone"]])
    return Sole(*(table[c].to_numpy(float) for c in ("px [m]", "py [m]", "radius [m]")), zone, names)


@pytest.mark.slow
@pytest.mark.parametrize(("system", "kind"), list(itertools.product(SCENES, KINDS)))
def test_every_kind_is_what_it_says(system, kind):
    made = synthetic_case(system, kind, 1)
    case, label = made.case, made.label
    assert json.loads(json.dumps(label.as_dict()))["kind"] == kind
    assert label.kind == kind and case.system == system and kind not in case.name
    vocabulary = {one.name for one in plans(system)} | {"unit_error", "sign_flip", "side_swap"}
    assert set(label.effects) <= vocabulary
    assert len(label.effects) == {"none": 0, "outside": 0, "pair": 2}.get(kind, 1)
    assert 3 <= len(case.calibration) <= 4 and 2 <= len(case.evaluation) <= 3
    for trial in (*case.calibration, *case.evaluation):
        assert np.isfinite([trial.column(name) for name in system_of(case).inputs]).all()
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
    one, same, other = (synthetic_case("elbow", "single", seed) for seed in (5, np.random.SeedSequence(5), 6))
    assert one.label == same.label and one.case.name == same.case.name
    np.testing.assert_array_equal(one.case.calibration[0].signals.values, same.case.calibration[0].signals.values)
    assert one.case.name != other.case.name


def test_what_is_asked_for_is_planted():
    label = synthetic_case("elbow", "single", 2, effect="damping", nats=50.0).label
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


@pytest.mark.parametrize(
    "passed",
    [
        NoiseFilter(10.0),
        NoiseFilter(5.0, 3),
        *(
            pytest.param(each, marks=pytest.mark.long)
            for each in (NoiseFilter(4.0), NoiseFilter(6.0), NoiseFilter(6.0, 4))
        ),
    ],
)
def test_noise_of_inputs_has_the_covariance_that_it_states(passed):
    rng = np.random.default_rng(0)
    drawn = np.array([smooth_noise(rng, 1.0, 40, 0.005, passed) for _ in range(4000)])
    place, cross, rate = smooth_covariance(1.0, 40, 0.005, passed)
    np.testing.assert_allclose(np.cov(drawn.T), place, atol=0.12)
    slope = (drawn[:, 2:] - drawn[:, :-2]) / 0.01  # 2 % too small at 10 Hz
    assert np.var(slope) == pytest.approx(rate[0, 0], rel=0.05)
    assert np.mean(slope[:, 20] * drawn[:, 11]) == pytest.approx(cross[11, 21], rel=0.15)


def test_rates_of_noise_that_nobody_filtered_are_those_of_a_spline():
    rng = np.random.default_rng(0)
    drawn = np.array([smooth_noise(rng, 2.0, 40, 0.005, NoiseFilter(100.0)) for _ in range(3000)])
    place, cross, rate = smooth_covariance(2.0, 40, 0.005, NoiseFilter(100.0))
    slope = CubicSpline(0.005 * np.arange(40), drawn, axis=1)(0.1, 1)
    np.testing.assert_allclose(place, 4.0 * np.eye(40), atol=0.02)
    assert np.var(drawn) == pytest.approx(4.0, rel=0.02)
    assert np.var(slope) == pytest.approx(rate[0, 0], rel=0.08)
    assert np.mean(slope * drawn[:, 19]) == pytest.approx(cross[19, 20], rel=0.15)


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
    [(s, one.name) for s in SCENES for one in (*plans(s), *unknown_effects(s)) if one.name != "jump"],
)
def test_every_effect_converges_with_the_step(system, name, stages):
    """Each changes the outputs, and a truth from steps half as long is the same."""
    stage = stages[system]
    scene, path = stage.scene, stage.trials[-1].path  # where the shoulder is supported more
    plan = next(one for one in (*plans(system), *unknown_effects(system)) if one.name == name)
    draw = plan.drawn(np.random.default_rng(1), stage.scale)
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


def test_a_recorder_repeats_and_rounds_what_it_is_given_noise_and_all(stages):
    scene, path = stages["knee"].scene, stages["knee"].trials[0].path
    named = {one.name: one for one in unknown_effects("knee")}

    def recorded(name, size):
        hooks = named[name].drawn(np.random.default_rng(1), stages["knee"].scale).hooks(size)
        return record(scene, path, np.random.default_rng(2), hooks).outputs

    plain = record(scene, path, np.random.default_rng(2)).outputs
    repeated = (np.diff(recorded("held_samples", 0.03)) == 0.0).mean(axis=1)
    assert (np.diff(plain) != 0.0).all() and (repeated > 0.05).all()
    coarse = recorded("quantisation", 25.0)
    row = int(np.argmax(np.abs(coarse - plain).max(axis=1)))
    steps = np.diff(coarse[row]) / 25.0
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    assert np.abs(coarse - plain)[row].max() <= 12.5 + 1e-9
    np.testing.assert_array_equal(np.delete(coarse, row, axis=0), np.delete(plain, row, axis=0))


def test_an_attachment_creeps_slower_and_slower_and_stays_where_it_is():
    """Held at a stroke of 0.01 m for half the time, unloaded for the other half."""
    time = np.linspace(0.0, 4.0, 401)
    u = np.where(time < 2.0, 0.01, 0.0)
    slid = u - crept(time, u, 0.01, 4e-3, 4.0, 0.05, 4.0)
    at = {t: slid[round(100 * t)] for t in (0.5, 1.0, 1.5, 1.99, 2.1, 4.0)}
    assert at[0.5] > 1.5 * (at[1.0] - at[0.5]) > 1.5 * (at[1.5] - at[1.0]) > 0.0
    assert at[1.99] > 5e-4 and at[4.0] == pytest.approx(at[2.1], rel=0.01)


def test_mistakes_are_exact_and_can_be_corrected(stages):
    scene = stages["foot"].scene
    inputs, outputs = np.random.default_rng(0).normal(size=(2, 3, 5))
    degrees = SyntheticDataError("unit_error", "pitch", np.degrees(1.0))
    np.testing.assert_allclose(degrees.corrected(scene, degrees.inputs(scene, inputs)), inputs)
    np.testing.assert_array_equal(degrees.outputs(scene, outputs), outputs)
    swapped = SyntheticDataError("side_swap", "", 1.0, (0, 1)).outputs(scene, outputs)
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


def test_of_several_sites_an_effect_sits_at_one_or_now_and_then_at_all(stages):
    """What is drawn at a site changes that site's force alone."""
    stage = stages["sit_to_stand"]
    scene, one = stage.scene, stage.trials[0]
    without = truth(scene, one.path, one.count, scene.theta, BASE, 10)
    seen = {"every site": 0, "pelvis": 0, "thigh": 0, "shank": 0}
    stiffening = next(plan for plan in plans("sit_to_stand") if plan.name == "stiffening")
    for seed in range(40):
        draw = stiffening.drawn(np.random.default_rng(seed), stage.scale)
        where = draw.words(0.3).split(":")[0]
        seen[where] += 1
        with_it = truth(scene, one.path, one.count, scene.theta, draw.hooks(0.3), 10)
        changed = np.abs(with_it - without).max(axis=1) > 1e-9
        expected = [where in ("every site", name.removesuffix("_force")) for name in scene.outputs]
        assert changed.tolist() == expected
        assert draw.variant == ("" if where == "every site" else where)
    assert min(seen.values()) > 3 and seen["every site"] < 20


def test_hooks_at_places_add_up_place_by_place():
    one = Hooks(spring=(abs,), places={"thigh": Hooks(play=(abs,))})
    other = Hooks(places={"thigh": Hooks(play=(min,)), "shank": Hooks(series=(max,))})
    both = one + other
    assert both.seen_from("thigh") == Hooks(spring=(abs,), play=(abs, min))
    assert both.seen_from("pelvis") == Hooks(spring=(abs,))
    assert both.cannot_be_solved and not one.cannot_be_solved and not other.cannot_be_solved


def test_medial_and_lateral_sides_share_what_the_knee_carries(stages):
    """Areas that the loads make by Hertz's law carry these loads again."""
    scene = stages["knee"].scene
    force = np.array([100.0, 400.0, 900.0])
    modulus, radius = float(scene.theta[0]), scene.constants["R"]
    again = 4.0 / 3.0 * modulus * deflection(area_under(force, modulus, radius), np.asarray(radius))
    np.testing.assert_allclose(again, force, rtol=1e-12)
    made = stages["knee"].trials[0].outputs
    assert (made > 20.0).all() and 0.4 < made[0].mean() / made.mean(axis=1).sum() < 0.75


@pytest.mark.parametrize(
    ("hooks", "name", "value"),
    [
        (Hooks(beside=(lambda p: 500.0 * p.deflection,)), "k_t", 500.0),
        (Hooks(beside=(lambda p: 9.0 * p.rate,)), "b_t", 9.0),
        (Hooks(hinge=(lambda p: 0.1 * p.rate,)), "c", 0.1),
        (Hooks(hinge=(lambda p: 0.03 * p.acceleration,)), "I", 0.03),
    ],
)
def test_what_is_hooked_in_at_the_shoulder_moves_the_arm_as_the_same_number_of_the_base_does(
    hooks, name, value, stages
):
    scene, path = stages["shoulder"].scene, stages["shoulder"].trials[0].path
    numbers = scene.numbers(scene.theta)
    course = path(np.arange(2001) * 2.5e-3)
    hooked = scene.body.respond(course, numbers, hooks)
    known = scene.body.respond(course, {**numbers, name: numbers[name] + value}, BASE)
    without = scene.body.respond(course, numbers, BASE)
    changed = np.abs(known - without).max(axis=1)
    assert (changed > 1e-5).all()
    assert (np.abs(hooked - known).max(axis=1) < 0.01 * changed).all()


def test_noise_of_the_arm_is_passed_on_as_the_base_model_does(stages):
    scene, one = stages["shoulder"].scene, stages["shoulder"].trials[0]
    course = one.path(np.arange(one.count) * scene.step)
    noise = 1e-4 * (1.0 + np.sin(14.0 * course.time) + np.exp(-(((course.time - 3.0) / 0.05) ** 2)))
    sides = [
        through(course.time, course.position + np.array([[size], [0.0]]) * noise, course.duration, 0.0, course.setting)
        for size in (1.0, -1.0)
    ]
    more, less = (scene.base_model(path(course.time))(scene.theta) for path in sides)
    linear = scene.body.passed_on(course, scene.numbers(scene.theta), 0, noise[:, None])[:, :, 0]
    off = np.abs(linear - 0.5 * (more - less)).max(axis=1)
    assert (off < 0.01 * np.abs(linear).max(axis=1)).all()


def test_an_arm_that_finds_no_rest_is_not_solved():
    with pytest.raises(NotConvergedError, match="no rest"):
        at_rest(lambda _: 1.0, 0.0)


def test_a_dashpot_follows_what_reaches_the_spring():
    """k u + b u' for a free strap; a strap in its play carries nothing at all."""
    time = np.linspace(0.0, 1.0, 2001)
    u = 0.01 * np.sin(2.0 * np.pi * time)
    free = pull(time, u, 4000.0, BASE, 80.0)
    exact = 4000.0 * u + 80.0 * 0.02 * np.pi * np.cos(2.0 * np.pi * time)
    np.testing.assert_allclose(free, exact, atol=1e-4)
    slack = Hooks(play=(lambda d: np.zeros_like(d),))
    assert not pull(time, u, 4000.0, slack, 80.0).any()


def test_a_pad_that_was_pressed_sits_closer_until_it_has_opened():
    """Halfway through either ramp on the way up and down; between the ramps it keeps what it had."""
    up, down = [0.0, 0.85, 1.1], [1.5, 0.85, 0.6, 0.3, 0.85]
    np.testing.assert_allclose(seated(2e-3 * np.array(up + down), 2e-3), [0.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 0.0])


@pytest.mark.parametrize("wrong", [{"system": "hip", "kind": "none"}, {"system": "elbow", "kind": "triple"}])
def test_what_does_not_exist_is_named(wrong):
    with pytest.raises(ValueError, match=r"hip|triple"):
        synthetic_case(**wrong, seed=0)


def test_a_draw_whose_visibility_is_no_number_is_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    real, drawn = cases.FINDERS["single"], []

    def broken_at_first(*given: object) -> cases.DrawnCase:
        found = real(*given)
        drawn.append(found)
        sights = {name: dataclasses.replace(seen, nats=np.nan) for name, seen in (found.sights or {}).items()}
        return dataclasses.replace(found, sights=sights) if len(drawn) == 1 else found

    monkeypatch.setitem(cases.FINDERS, "single", broken_at_first)  # type: ignore[arg-type]
    made = synthetic_case("knee", "single", 5)
    assert len(drawn) > 1
    assert all(np.isfinite(nats) for nats in made.label.nats.values())
