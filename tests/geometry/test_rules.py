"""The crude rules against counting by hand, and their order of size."""

import numpy as np
import pytest

from geocontact.geometry.contact_area.area import ALL_VERTICES, ANY_VERTEX, CENTROID, CLIP, REFINED, RULES
from meshes import simple_shapes as shapes
from tests.geometry.bodies import MM, contact, cube, pose_of, surface, turned

PLATE = surface(shapes.block(80.0, 80.0, 12.0, 24), "plate")
BALL, RADIUS, LIFT = surface(shapes.sphere(20.0, 12), "ball"), 20 * MM, np.array([1.3, 19.7, -2.1]) * MM
THRESHOLD = 4 * MM
POSE = pose_of(turned(10, 20, 30), LIFT)


def heights():
    """Height of the ball's vertices over the plate: their distance, as the plate is large."""
    return POSE.apply(BALL.vertices)[:, 1]


def counted(rule):
    return contact(BALL, PLATE, POSE, THRESHOLD, rule=rule)


@pytest.mark.parametrize(
    ("rule", "count"),
    [
        (ALL_VERTICES, lambda low: low[BALL.faces].all(axis=1)),
        (ANY_VERTEX, lambda low: low[BALL.faces].any(axis=1)),
        (CENTROID, lambda low: heights()[BALL.faces].mean(axis=1) <= THRESHOLD),
    ],
)
def test_whole_faces_are_counted(rule, count):
    faces = count(heights() <= THRESHOLD)
    area, centre = BALL.face_area[faces], POSE.apply(BALL.vertices[BALL.faces[faces]].mean(axis=1))
    found = counted(rule).moving[0]
    assert found.area == pytest.approx(area.sum(), rel=1e-12)
    assert found.centroid == pytest.approx(area @ centre / area.sum(), abs=1e-12)


def test_crude_rules_enclose_the_others():
    """Low, then cut, then high; the certified bounds are of the true area, whatever the rule."""
    found = {rule: counted(rule) for rule in RULES}
    assert set(RULES) == {REFINED, CLIP, ALL_VERTICES, ANY_VERTEX, CENTROID}
    for side in ("fixed", "moving"):
        area = {rule: getattr(frame, side)[0].area for rule, frame in found.items()}
        assert area[ALL_VERTICES] < area[CLIP] < area[ANY_VERTEX], area
        assert area[ALL_VERTICES] < area[CENTROID] < area[ANY_VERTEX], area
        for rule, frame in found.items():
            bounds = getattr(frame, side)[0]
            assert bounds.lower <= area[REFINED] <= bounds.upper, f"{rule}: {bounds}"


@pytest.mark.parametrize("rule", RULES)
def test_whole_overlap_counts_by_every_rule(rule):
    small, large = surface(shapes.sphere(5.0, 4)), surface(cube((0, 0, 0), 30.0))
    found = contact(small, large, pose_of(shift=[3 * MM, 0, 0]), 0.0, rule=rule)
    assert found.moving[0].area == pytest.approx(small.face_area.sum(), rel=1e-12)
    assert found.fixed[0].area == 0
