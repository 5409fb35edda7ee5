"""The file: small, the same twice, text escaped, nothing allowed but itself."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.data.motion import Course
from geocontact.view.page.content import Curve, Curves, Page, Readout, Row, Scene, SceneBody, Table, Words
from geocontact.view.page.opening import opening_view
from geocontact.view.page.payload import minus, payload, shown
from geocontact.view.page.write import page_html, write_page
from tests.view.page.examples import DIRECTIONS, ball, curves_page, plate, small_page
from tests.view.page.hostile import HOSTILE, hostile_page


class Elements(HTMLParser):
    """Elements, attribute names and texts as a browser's parser sees them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: Counter[str] = Counter()
        self.attributes: set[str] = set()
        self.links: list[str] = []
        self.texts: list[str] = []
        self.inside: list[str] = []
        self.raw: dict[str, list[str]] = {"script": [], "style": []}
        self.policy = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found[tag] += 1
        self.inside.append(tag)
        for name, value in attrs:
            self.attributes.add(name)
            if name in ("href", "src", "srcdoc", "action", "style"):
                self.links.append(f"{tag} {name}={value}")
        if ("http-equiv", "Content-Security-Policy") in attrs:
            self.policy = str(dict(attrs)["content"])
        if tag in self.raw:
            self.raw[tag].append("")

    def handle_data(self, data: str) -> None:
        if self.inside and self.inside[-1] in self.raw:
            self.raw[self.inside[-1]][-1] += data
        else:
            self.texts.append(data)

    def handle_endtag(self, tag: str) -> None:
        while self.inside and self.inside.pop() != tag:
            pass


def sha256(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def test_the_policy_allows_this_script_and_this_style_alone() -> None:
    page = Elements(page_html(small_page()))
    policy = dict(rule.split(" ", 1) for rule in page.policy.split("; "))
    assert policy == {
        "default-src": "'none'",
        "script-src": f"'{sha256(page.raw['script'][-1])}'",
        "style-src": f"'{sha256(page.raw['style'][0])}'",
        "img-src": "data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }


def test_nothing_is_linked_and_no_attribute_holds_code_or_style() -> None:
    page = Elements(page_html(small_page()))
    assert page.links == []
    assert not [name for name in page.attributes if name.startswith("on") or name == "style"]


def test_hostile_texts_change_no_element() -> None:
    plain = hostile_page(small_page(), [f"text {k}" for k in range(len(HOSTILE))])
    hostile = hostile_page(small_page(), HOSTILE)
    assert len(HOSTILE) >= 30
    there, here = Elements(page_html(plain)), Elements(page_html(hostile))
    assert here.found == there.found
    assert here.attributes == there.attributes
    for text in HOSTILE:
        assert text in here.texts, text


def test_hostile_texts_in_the_data_stay_data() -> None:
    hostile = hostile_page(small_page(), HOSTILE)
    text = re.search(r'id="page-data">(.*?)</script>', page_html(hostile), re.DOTALL)
    assert text
    assert not set("<>&") & set(text[1])
    assert json.loads(text[1])["title"] == HOSTILE[0]


def test_a_name_that_is_no_text_can_be_written(tmp_path: Path) -> None:
    page = replace(small_page(name="stl-\udce9.stl"), title="\udcff")
    assert write_page(page, tmp_path / "page.html") == (tmp_path / "page.html").stat().st_size


def test_the_same_page_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.html", "b.html"):
        write_page(small_page(), tmp_path / name)
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_a_large_page_stays_below_five_megabytes(tmp_path: Path) -> None:
    frames, n = 101, 142
    shift = np.column_stack([0.01 * np.sin(np.linspace(0, 6, frames)), np.full(frames, 0.0202), np.zeros(frames)])
    (plate_vertices, plate_faces), (ball_vertices, ball_faces) = plate(n), ball(n=n)
    on_plate = np.array([np.linalg.norm(plate_vertices - s, axis=1) - 0.02 for s in shift])
    on_ball = np.array([ball_vertices[:, 1] + s[1] for s in shift])
    scene = Scene(
        [
            SceneBody("plate", plate_vertices, plate_faces, distance=on_plate),
            SceneBody("ball", ball_vertices, ball_faces, RigidTransform.from_translation(shift), on_ball),
        ],
        [4e-3],
        (-1e-3, 4e-3),
        "distance",
        DIRECTIONS,
    )
    page = Page("large", "", np.arange(frames) / 100.0, "time [s]", sections=[scene])
    assert len(plate_faces) + len(ball_faces) > 79_000
    assert write_page(page, tmp_path / "page.html") < 5e6


@pytest.mark.parametrize(
    ("what", "change"),
    [
        ("start_frame is 9", {"start_frame": 9}),
        ("start_frame is -1", {"start_frame": -1}),
        ("time must be finite", {"time": np.full(9, np.nan)}),
        ("curve short: 8 frames, expected the 9", {"sections": [Curves("a", "b", [Curve("short", np.zeros(8))])]}),
        ("numbers: 8 frames, expected the 9", {"numbers": np.arange(1, 9), "total": 20}),
        ("must count up", {"numbers": np.arange(9), "total": 20}),
        ("must count up", {"numbers": np.array([1, 2, 3, 3, 5, 6, 7, 8, 9]), "total": 20}),
        ("numbers end at 17 of 9 frames; pass total", {"numbers": np.arange(1, 18, 2)}),
        ("numbers end at 9 of 8 frames", {"total": 8}),
        ("holds one Scene", {"sections": [small_page().sections[0]] * 2}),
    ],
)
def test_what_does_not_fit_is_refused(what: str, change: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=what):
        replace(small_page(), **change)


@pytest.mark.parametrize(
    ("what", "change"),
    [
        ("does not hold the threshold", {"thresholds": [7e-3]}),
        ("a threshold is missing", {"thresholds": []}),
        ("finite vertices", {"bodies": [SceneBody("a", np.full((3, 3), np.nan), np.array([[0, 1, 2]]))]}),
        ("not there", {"bodies": [SceneBody("a", np.zeros((3, 3)), np.array([[0, 1, 3]]))]}),
    ],
)
def test_a_scene_that_cannot_be_drawn_is_refused(what: str, change: dict[str, object]) -> None:
    page = small_page()
    with pytest.raises(ValueError, match=what):
        replace(page, sections=[replace(page.sections[0], **change)])


@pytest.mark.parametrize(
    ("text", "here"),
    [
        ("-1.50", "−1.50"),
        ("-0.00", "0.00"),
        ("-0", "0"),
        ("-0.01", "−0.01"),
        ("-.5", "−.5"),
        ("-0e-3", "−0e-3"),
        ("1e-3", "1e-3"),
        ("-2 (at least)", "−2 (at least)"),
        ("–", "–"),
        ("-->", "-->"),
        ("", ""),
    ],
)
def test_a_leading_hyphen_is_shown_as_minus_and_zero_has_none(text: str, here: str) -> None:
    assert shown(text) == here


def test_readouts_show_a_minus_with_and_without_scripts() -> None:
    page = Page("a", "", np.arange(2.0), "time [s]", sections=[Readout([Row("height", "mm", ["-0.00", "-1.00"])])])
    html = page_html(replace(page, start_frame=1))
    assert "−1.00" in Elements(html).texts
    assert '"texts":[["0.00","\\u22121.00"]]' in html


def test_the_page_opens_where_the_patch_is_seen() -> None:
    page = small_page()
    scene = page.sections[0]
    assert isinstance(scene, Scene)
    view = opening_view(scene, page.opening)
    assert view @ [0.0, 1.0, 0.0] > 0.8, "the plate's patch looks up"
    assert np.linalg.norm(view) == pytest.approx(1.0)


def test_far_frames_cost_no_digits() -> None:
    near, far = small_page(), small_page()
    shift = np.array([1e4, -2e4, 3e4])
    moved = []
    for body in far.sections[0].bodies:
        if body.poses is None:
            moved.append(replace(body, vertices=body.vertices + shift))
        else:
            moved.append(replace(body, poses=RigidTransform.from_translation(shift) * body.poses))
    far = replace(far, sections=[replace(far.sections[0], bodies=moved)])
    poses = [[b for b in payload(p).blocks if b.name.endswith("poses")] for p in (near, far)]
    from geocontact.view.page.pack import unpacked

    for a, b in zip(*poses, strict=True):
        assert np.abs(unpacked(a) - unpacked(b)).max() < 1e-4, "mm"


def test_an_inside_out_body_is_turned() -> None:
    page = small_page()
    scene = page.sections[0]
    turned = replace(scene.bodies[1], faces=scene.bodies[1].faces[:, ::-1])
    here = payload(replace(page, sections=[replace(scene, bodies=[scene.bodies[0], turned])]))
    there = payload(page)
    assert len([b for b in here.blocks if b.name == "body-1-faces"]) == 1
    outward = [_volume(turned if flip else scene.bodies[1], p) for p, flip in ((here, True), (there, False))]
    assert min(outward) > 0.0


def _volume(body: SceneBody, found: object) -> float:
    from geocontact.view.page.pack import unpacked

    faces = unpacked(next(b for b in found.blocks if b.name == "body-1-faces"))  # type: ignore[attr-defined]
    a, b, c = (body.vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)))


def test_words_are_there_without_scripts() -> None:
    page = replace(small_page(), sections=[Words("Not a device", ["For research."])])
    assert {"Not a device", "For research.", "largest area"} <= set(Elements(page_html(page)).texts)


def test_a_page_without_time_has_no_player() -> None:
    words = Words("said", ["nothing moves"])
    for page, stage, player in (
        (small_page(), True, True),
        (small_page(frames=1), True, False),
        (replace(small_page(), plays=False), True, False),
        (Page("a", "", np.zeros(1), "time [s]", sections=[words]), False, False),
    ):
        body = page_html(page).partition("<main>")[2]
        opened = re.search(r'<div class="stage[^>]*>', body)
        assert opened is not None and ("hidden" in opened[0]) == (not stage)
        assert ('<div class="timeline"' in body) == ("play, pause" in body) == player


@pytest.mark.parametrize(
    ("text", "here"),
    [
        ("z -19.5 mm", "z −19.5\u00a0mm"),
        ("5 mmm 4 N, 3 of", "5 mmm 4\u00a0N, 3 of"),
        ("-3", "−3"),
        ("-17.7 (-25.6 to -12.1), [-1, 2]", "−17.7 (−25.6 to −12.1), [−1, 2]"),
        ("walk-3.csv", "walk-3.csv"),
        ("2-4", "2-4"),
        ("a - b", "a - b"),
    ],
)
def test_numbers_that_stand_by_themselves_have_a_minus(text: str, here: str) -> None:
    assert minus(text) == here


def test_tables_print_a_minus_and_commands_keep_their_hyphens() -> None:
    rows = [("turned", "-1.5 … -0.5 mm"), ("--axis", "-1,2")]
    shown_table, folded = Table("Numbers", ("what", "value"), rows), Table("How", ("what", "value"), rows, folded=True)
    page = page_html(replace(small_page(), sections=(*small_page().sections, shown_table, folded)))
    assert "<bdi>−1.5 … −0.5\u00a0mm</bdi>" in page
    assert "<bdi>-1.5 … -0.5 mm</bdi>" in page.split("<summary><h2><bdi>How</bdi>")[1]


def test_nothing_is_played_where_nothing_follows_the_time() -> None:
    page = curves_page()
    assert 'id="timeline"' in page_html(page)
    course = Course("angle", "°", page.time)
    own = [replace(each, over=course) for each in page.sections if isinstance(each, Curves)]
    assert own and 'id="timeline"' not in page_html(replace(page, sections=own))


def test_times_of_a_late_clock_are_counted_from_the_first_frame() -> None:
    """Seven digits of a clock that counts from 1970 are the same for all frames."""
    page = replace(curves_page(200), time=1.76e9 + 0.25 + 1e-3 * np.arange(200), time_label="time [s]")
    data = payload(page).data
    assert data["timeLabel"] == "time after 1760000000.25 [s]"
    np.testing.assert_allclose(np.array(data["time"]), 1e-3 * np.arange(200), atol=1e-6)
    assert payload(replace(page, time_label="force [N]")).data["timeLabel"] == "force [N]"
