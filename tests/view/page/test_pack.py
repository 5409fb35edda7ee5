"""What packing costs: nothing for words, half a step for positions and distances."""

from __future__ import annotations

import base64

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from geocontact.view.page.pack import BEYOND, GRID, AmountLevels, Grid, Levels, across, face_words, packed, unpacked

SHAPES = hnp.array_shapes(min_dims=1, max_dims=2, max_side=40)
WORDS = st.sampled_from([np.uint8, np.uint16, np.uint32]).flatmap(lambda kind: hnp.arrays(kind, SHAPES))


@given(WORDS)
def test_words_come_back_as_they_were(words: np.ndarray) -> None:
    back = unpacked(packed("a", words))
    assert back.dtype == words.dtype
    assert np.array_equal(back, words)


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.uint32])
def test_filtered_words_come_back_as_they_were(kind: type) -> None:
    slow = np.cumsum(np.tile([1, 0, 3, -1], (400, 3)), axis=0).astype(kind)  # smooth, so that the filter pays
    block = packed("a", slow)
    assert block.filtered
    assert np.array_equal(unpacked(block), slow)


def test_poses_come_back_as_they_were() -> None:
    poses = np.random.default_rng(1).normal(size=(7, 12)).astype(np.float32)
    assert np.array_equal(unpacked(packed("a", poses)), poses)


@pytest.mark.parametrize("kind", [np.uint16, np.float32])
def test_packing_keeps_no_time_of_day(kind: type) -> None:
    block = packed("a", np.arange(1000).astype(kind))
    assert base64.b64decode(block.text)[4:8] == bytes(4), "gzip's field for the time"


@given(hnp.arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=st.floats(-1e3, 1e3)))
def test_positions_are_off_by_half_a_step_at_most(vertices: np.ndarray) -> None:
    grid = Grid.around(vertices)
    back = grid.positions(grid.steps(vertices))
    step = grid.size / GRID
    assert (np.abs(back - vertices) <= 0.5 * step + 1e-12 * np.abs(vertices).max()).all()
    assert np.linalg.norm(back - vertices, axis=1).max() <= grid.error + 1e-9


def test_the_stated_position_error_is_reached() -> None:
    vertices = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], np.full(3, 0.4999 / GRID)])
    grid = Grid.around(vertices)
    off = np.linalg.norm(grid.positions(grid.steps(vertices)) - vertices, axis=1).max()
    assert off == pytest.approx(grid.error, rel=1e-3)


SPANS = st.tuples(st.floats(-5e-3, 0.0), st.floats(1e-3, 2e-2))


@given(SPANS, st.floats(0.01, 1.0), st.floats(0.0, 3.0), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=50))
def test_distances_are_off_by_half_a_step_at_most(
    span: tuple[float, float], part: float, beyond: float, parts: list[float]
) -> None:
    threshold = part * span[1]
    levels = Levels.of(span, threshold, span[1] * (1.0 + beyond))
    inside = span[0] + np.array([parts]) * (span[1] - span[0])
    codes = levels.codes(inside)
    back = levels.distance(codes)
    shown = codes > 0
    assert (np.abs(back - inside)[shown] <= levels.error * (1 + 1e-9)).all()
    assert (inside[~shown] <= span[0] + 2 * levels.error).all(), "only what lies at the lower end"


@given(SPANS, st.floats(0.01, 1.0))
def test_the_threshold_is_a_level(span: tuple[float, float], part: float) -> None:
    threshold = part * span[1]
    levels = Levels.of(span, threshold)
    code = levels.codes(np.array([[threshold]]))
    assert 1 <= code[0, 0] <= 254
    assert levels.distance(code)[0, 0] == pytest.approx(threshold, abs=1e-15)


def test_the_ends_are_told_apart() -> None:
    levels = Levels.of((-1e-3, 6e-3), 4e-3)
    codes = levels.codes(np.array([[np.inf, np.nan, -np.inf, -5e-3, 7e-3, 4e-3]]))
    assert codes[0, :3].tolist() == [255, 255, 0]
    assert codes[0, 3:5].tolist() == [0, 255]
    assert np.isinf(levels.distance(codes)[0, [0, 2]]).tolist() == [True, True]


def test_levels_reach_across_the_upper_limit() -> None:
    faces = np.array([[0, 1, 2], [2, 3, 4]])
    distance = np.array([[3.0, 3.5, 4.4, 5.0, np.inf]])
    assert across(faces, distance, upper=4.0, most=9.0) == 4.4
    assert across(faces, distance, upper=4.4, most=9.0) == 5.0
    assert across(faces, distance, upper=4.0, most=4.2) == 4.0


@pytest.mark.parametrize(("largest", "kind"), [(65535, np.uint16), (65536, np.uint32)])
def test_faces_take_as_few_bytes_as_they_need(largest: int, kind: type) -> None:
    words = face_words(np.array([[0, 1, largest]]))
    assert words.dtype == kind
    assert words[0, 2] == largest


def test_amounts_keep_their_zero_and_their_largest() -> None:
    values = np.array([[0.0, 1e-9, 0.5, 7.3, 20.0, np.nan, -1.0]])
    levels = AmountLevels.of(20.0)
    codes = levels.codes(values)[0].astype(float)
    assert codes[[0, 5, 6]].tolist() == [BEYOND] * 3, "none"
    assert codes[1] == 1.0 and codes[4] == BEYOND - 1.0, "a little is not none, the largest is the last level"
    np.testing.assert_allclose(codes[1:5] * levels.step, values[0, 1:5], atol=levels.error)
    np.testing.assert_allclose(codes[2:5] * levels.step, values[0, 2:5], atol=0.5 * levels.error + 1e-12)
