"""Tables of the prosthesis in the theory pages are those of benchmarks/results, and say which commit made them."""

from __future__ import annotations

import pytest

from tests.benchmarks.test_documented_figures import ROOT, near, results, row, rows

COMPARE, CALIBRATION = "theory/prosthesis_compare.md", "theory/prosthesis_calibration.md"
ZONES = ("heel_back", "heel_middle", "midfoot", "forefoot")


def test_thirty_predicted_stances() -> None:
    told = {(one["setting"], one["quantity"]): one for one in results("prosthesis_compare")["figures"]["summary"]}
    for setting in ("low", "medium", "high", "all"):
        cells = row(COMPARE, setting)
        for first, quantity, scale in ((0, "resultant", 100.0), (4, "cop_ground", 100.0), (8, "ankle_moment", 1.0)):
            one = told[setting, quantity]
            size, plain = (cells[first + 1], cells[first + 2]) if scale == 100.0 else (cells[first], cells[first + 1])
            if scale == 100.0:
                assert near(cells[first].split(" ± ")[0], one["r2 [-]"]), (setting, quantity)
                assert near(size.split(" ± ")[1], one["rmse sd"], scale), (setting, quantity)
            assert near(size.split(" ± ")[0], one["rmse"], scale), (setting, quantity)
            mean, other = plain.split(", ")
            assert near(mean, one["mean of the others rmse"], scale) and near(other, one["another rmse"], scale), plain
    cells = row(COMPARE, "out of its markers, height and pitch")
    for cell, key in zip(cells, ("low", "medium", "high", "all", "fore_aft", "cop_ground"), strict=False):
        one = told[("all", key) if (key in ("fore_aft", "cop_ground")) else (key, "resultant")]
        assert near(cell, one["rmse"], 100.0), (key, cell)
    better = told["all", "resultant"]
    assert cells[-1] == f"{better['better']} of {better['trials']}"


def test_profiles() -> None:
    told = results("prosthesis_profiles")["figures"]["P1"]["numbers"]
    found = {one["number"]: one for one in told}
    assert all(one["verdict"] == "known" for one in told)
    seen = 0
    for kind in ("stiffness", "damping", "friction"):
        for zone, cell in zip(ZONES, row(CALIBRATION, kind), strict=True):
            one = found.get(f"{kind}.{zone}")
            assert (one is None) == (not cell), (kind, zone)
            if one is not None:
                seen += 1
                for part, side in zip(cell.split(", "), ("lower", "upper"), strict=True):
                    assert near(part, one[side]["of_parabola"]), (kind, zone, side)
    assert seen == len(told)


def test_a_sole_on_the_whole_model() -> None:
    for person, one in results("prosthesis_full_calibration")["figures"].items():
        for first, label, key in ((person, "along the poses", "along poses"), ("", "on the whole model", "whole")):
            wanted = [one[key][when] for when in ("fitted", "medium", "low", "high")]
            lines = [cells[2:] for cells in rows(CALIBRATION) if cells[:2] == [first, label]]
            curves = ("resultant", "fore_aft", "cop_ground")
            assert any(
                all(
                    near(part, each[curve], 100.0)
                    for cell, each in zip(cells, wanted, strict=True)
                    for part, curve in zip(cell.split(", "), curves, strict=True)
                )
                for cells in lines
            ), (person, label)


def test_a_walk_by_its_own_torques() -> None:
    told = results("prosthesis_both_sides")["figures"]["again"]
    lines = (ROOT / "docs" / "theory" / "prosthesis_both_sides.md").read_text(encoding="utf-8").splitlines()
    table = [[cell.strip() for cell in line.split("|")[2:5]] for line in lines if "1e-6 |" in line or "1e-7 |" in line]
    single = [each for each in told if each["span"] == "single support"]
    for one, (_, error, growth) in zip(single, table[:2], strict=True):
        turn, shift, force = error.split(", ")
        assert float(turn.removesuffix("°")) == pytest.approx(one["turn_deg"], rel=0.15)
        assert float(shift.removesuffix(" mm")) == pytest.approx(one["shift_mm"], rel=0.15)
        assert float(force.removesuffix(" % BW")) == pytest.approx(100.0 * one["force_bw"], rel=0.15)
        assert near(growth.removesuffix("/s"), one["growth"])
    double = [each for each in told if each["span"] == "from double support on" and not each["spheres"]]
    for one, (_, error, growth) in zip(double, table[2:4], strict=True):
        assert near(error.removeprefix("0.5° after ").removesuffix(" s"), one["held_s"])
        assert near(growth.removesuffix("/s"), one["growth"])


@pytest.mark.parametrize(
    ("name", "page"),
    [
        ("prosthesis_compare", COMPARE),
        ("prosthesis_calibration", CALIBRATION),
        ("prosthesis_profiles", CALIBRATION),
        ("prosthesis_full_calibration", CALIBRATION),
        ("prosthesis_both_sides", "theory/prosthesis_both_sides.md"),
    ],
)
def test_the_page_says_what_made_its_tables(name: str, page: str) -> None:
    text = (ROOT / "docs" / page).read_text(encoding="utf-8").replace("\n", " ")
    assert f"commit {results(name)['commit']}" in text
    assert "were made before" not in text


def test_known_best_fulcrums() -> None:
    """Right of answered, and the median width of the intervals where there are several."""
    found = results("prosthesis_design")
    page = (ROOT / "docs" / "theory" / "prosthesis_design.md").read_text(encoding="utf-8")
    assert f"commit {found['commit']})" in page
    for label, known in (("calibrated", "known"), ("not calibrated", "blind")):
        own = found["figures"][known]
        (persons, *cells) = row("theory/prosthesis_design.md", label)
        assert int(persons) == own["persons"]
        for cell, aim in zip(cells, ("energy", "radius", "ankle_moment", "socket_moment", "loading_rate"), strict=True):
            counts, _, width = cell.partition(", ")
            assert counts == f"{own['aims'][aim]['within']} of {own['aims'][aim]['told']}", (label, aim)
            assert not width or near(width, own["aims"][aim]["width_mm"]), (label, aim)


def test_responses_of_the_leg() -> None:
    level = results("prosthesis_responses")["figures"]["level"]
    titles = {
        "peak ankle moment [N m]": "ankle_moment",
        "peak moment at the socket [N m]": "socket_moment",
        "energy that the keel returns [J]": "energy",
        "radius [m]": "radius",
        "peak knee moment [N m]": "knee_moment",
        "metabolic proxy [J]": "metabolic",
    }
    for title, aim in titles.items():
        cells = row("theory/prosthesis_design.md", title)
        for cell, response in zip(cells, ("angles kept", "torque kept", "joint torques kept"), strict=True):
            for shown, value in zip(
                cell.split(" → "), (level[aim][response][0], level[aim][response][-1]), strict=True
            ):
                assert near(shown, value), (aim, response)
    assert sorted(round(t, 2) for t in level["tracking 0"]["holds_s"]) == [0.34, 0.37, 0.72]
