"""Units that do not agree are refused with the likely one named; sizes that do not are told."""

import numpy as np
import pytest

from geocontact.geometry.register.scale_guard import UNITS, compare_boxes, compare_landmarks

BODY = np.random.default_rng(0).uniform(-1, 1, (40, 3)) * [0.3, 0.9, 0.2]


@pytest.mark.parametrize(
    ("meant", "read"), [("mm", "m"), ("m", "mm"), ("cm", "m"), ("mm", "cm"), ("in", "mm"), ("m", "in"), ("in", "cm")]
)
def test_landmarks_in_another_unit_are_refused_by_its_name(meant, read):
    """Numbers in the unit `meant`, taken for `read`."""
    wrong = BODY / UNITS[meant] * UNITS[read]
    with pytest.raises(ValueError, match=rf"the scan is in {meant} and was read as {read}"):
        compare_landmarks(wrong, BODY)
    with pytest.raises(ValueError, match=rf"the body model is in {meant} and was read as {read}"):
        compare_landmarks(BODY, wrong)


@pytest.mark.parametrize(("meant", "read"), [("mm", "m"), ("m", "mm"), ("cm", "m"), ("in", "m"), ("in", "mm")])
def test_boxes_in_another_unit_are_refused(meant, read):
    wrong = BODY / UNITS[meant] * UNITS[read]
    with pytest.raises(ValueError, match=rf"the scan is in {meant} and was read as {read}"):
        compare_boxes(wrong, BODY)


def test_a_metre_scan_against_a_millimetre_mat():
    mat = np.array([[0, 0, 0], [320.0, 160.0, 0]]) * 1.0  # millimetres read as metres
    with pytest.raises(ValueError, match="the mat is in mm and was read as m") as refusal:
        compare_boxes(BODY, mat, ("scan", "mat"))
    assert "\n" not in str(refusal.value)


def test_a_part_passes_against_the_whole():
    assert compare_boxes(0.1 * BODY, BODY).ratio == pytest.approx(0.1)
    assert compare_boxes(BODY, 0.1 * BODY).warning == ""


@pytest.mark.parametrize("scale", [0.84, 1.16, 1.5])
def test_sizes_off_by_more_than_15_percent_are_told(scale):
    found = compare_landmarks(scale * BODY + 3.0, BODY)
    assert found.ratio == pytest.approx(scale, rel=1e-12)
    assert f"{100 * abs(scale - 1):.0f} % {'larger' if scale > 1 else 'smaller'}" in found.warning


@pytest.mark.parametrize("scale", [0.86, 1.0, 1.14])
def test_sizes_within_15_percent_pass(scale):
    assert compare_landmarks(scale * BODY, BODY).warning == ""


def test_what_no_unit_explains_is_refused_too():
    with pytest.raises(ValueError, match="which no unit explains"):
        compare_landmarks(4.9 * BODY, BODY)
    with pytest.raises(ValueError, match="all in one place"):
        compare_landmarks(np.zeros((4, 3)), BODY[:4])
