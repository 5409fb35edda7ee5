"""One way to describe a person: the same table in studies of all systems, and what a command does not use of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.collector import collecting, current
from geocontact.analyses.frame.record import Record
from geocontact.analyses.person import unused_values
from geocontact.analyses.prosthesis.compare.options import ProsthesisCompareOptions
from geocontact.analyses.prosthesis.compare.stances import described
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import read as read_optimise
from geocontact.analyses.shoulder.study.cases import read as read_cases
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.io.documents import checked
from geocontact.io.recordings.described_person import DescribedPerson
from geocontact.standing_up.person_segments import SHARES, from_proximal, segments_of, to_proximal
from tests.analyses.prosthesis.test_compare import written
from tests.analyses.shoulder.test_optimise import study as overhead
from tests.standing_up.test_person_segments import STUDY, study_with

ONE_PERSON = """sex = "female"
segments.thigh = { mass = { value = 8, unit = "kg" }, length = { value = 38, unit = "cm" }, \
centre = { value = 15, unit = "cm" } }
segments.shank = { length = { value = 41, unit = "cm" }, centre = { value = 17, unit = "cm" } }
segments.foot = { length = { value = 24, unit = "cm" }, centre = { value = 9.5, unit = "cm" } }
"""
FORMER = """sex = "female"
thigh = { mass = { value = 8, unit = "kg" }, length = { value = 38, unit = "cm" }, \
centre = { value = 23, unit = "cm" } }
shank = { length = { value = 41, unit = "cm" }, centre = { value = 24, unit = "cm" } }
foot = { length = { value = 24, unit = "cm" }, centre = { value = 37.064, unit = "mm" } }
"""
"""The same: 38 - 15, 41 - 17, and 95 mm less (0.4014 - 0.16) of 240 mm from the heel to the ankle."""


def warned(work: object) -> list[str]:
    with collecting(Record("test", {})):
        work()  # type: ignore[operator]
        return list(current().warnings)


def test_both_spellings_are_one_person(tmp_path: Path) -> None:
    """Centres by hand from the lower joints; the equations take nothing else of a person."""
    new, former = tmp_path / "new", tmp_path / "former"
    new.mkdir()
    former.mkdir()
    said: dict[str, list[str]] = {}
    found = {}
    for folder, text in ((new, ONE_PERSON), (former, FORMER)):
        file = study_with(folder, f"[person]\n{text}")
        said[folder.name] = warned(lambda f=file, n=folder.name: found.update({n: standing_trials(f, "study").subject}))
    one, other = found["new"].segments, found["former"].segments
    for name, segment in one.items():
        values = [[getattr(each, key) for key in vars(segment)] for each in (segment, other[name])]
        np.testing.assert_allclose(values[0], values[1], rtol=1e-12)
    assert one["thigh"].centre == pytest.approx(0.23, abs=1e-15) and one["thigh"].mass == 16.0
    assert not [line for line in said["new"] if "person" in line]
    line = "[person.foot], [person.shank], [person.thigh]: former spelling, with centres from the lower joint"
    assert [each for each in said["former"] if line in each]


def test_the_person_of_a_gait_study_stands_up(tmp_path: Path) -> None:
    """The very text of a person in a study of overhead work; mass and height in the table, one key not used."""
    size = 'mass = { value = 61, unit = "kg" }\nheight = { value = 1.66, unit = "m" }\n'
    hand = 'segments.hand = { mass = { value = 0.4, unit = "kg" } }\n'
    over = 'segments.head_arms_trunk = { centre = { value = 31, unit = "cm" } }\n'
    file = study_with(tmp_path, f"[person]\n{size}{ONE_PERSON}{hand}{over}")
    both = file.read_text(encoding="utf-8")
    with pytest.raises(gc.InputError, match=r"\[person\] mass: stands outside of \[person\] as well; keep one of them"):
        standing_trials(file, "study")
    outside = "mass = { value = 70,", "height = { value = 1.75,"
    lines = [line for line in both.splitlines() if not line.startswith(outside)]
    file.write_text("\n".join(lines), encoding="utf-8")
    found = {}
    said = warned(lambda: found.update(subject=standing_trials(file, "study").subject))
    person = found["subject"]
    assert (person.mass, person.height) == (61.0, 1.66)
    assert person.segments["trunk"].centre == 0.31
    assert person.segments["trunk"].mass == pytest.approx(61.0 * (1.0 - 2 * (0.0129 + 0.0481)) - 16.0, rel=1e-12)
    (line,) = [each for each in said if "not used" in each]
    assert line.endswith(
        "[person]: `segments.hand` is not used by sit-to-stand; its head, arms and trunk are segments.head_arms_trunk"
    )


def test_a_segment_in_both_spellings_is_refused(tmp_path: Path) -> None:
    text = '[person]\nshank = { length = { value = 40, unit = "cm" } }\n'
    file = study_with(tmp_path, text + 'segments.shank = { length = { value = 41, unit = "cm" } }\n')
    with pytest.raises(gc.InputError, match=r"\[person\] shank: its values stand in segments.shank as well; keep"):
        standing_trials(file, "study")


def doubted(folder: Path, text: str) -> list[str]:
    """Warnings about centres of a person."""
    folder.mkdir(exist_ok=True)
    said = warned(lambda: standing_trials(study_with(folder, f"[person]\n{text}"), "study"))
    return [line.partition("[person] ")[2] for line in said if "its centre is" in line]


def test_a_centre_from_the_other_joint_is_doubted(tmp_path: Path) -> None:
    """The thigh's 0.64 of its length from the hip, which is its place from the knee; a shank's 0.55 likewise."""
    text = ONE_PERSON.replace('centre = { value = 15, unit = "cm" }', 'centre = { value = 24.3, unit = "cm" }')
    said = doubted(tmp_path / "thigh", text)
    assert said == ["thigh: its centre is at 0.64 of its length, 0.36 in the table: is it from the hip?"]
    nearer = 'segments.shank = { length = { value = 41, unit = "cm" }, centre = { value = 22.7, unit = "cm" } }\n'
    said = doubted(tmp_path / "shank", f'sex = "male"\n{nearer}')
    assert said == [
        (
            "shank: its centre is at 0.55 of its length, 0.45 in the table from the knee and 0.55 from the ankle: "
            "which end is it from?"
        )
    ]
    assert not doubted(tmp_path / "near", f'sex = "male"\n{nearer.replace("22.7", "20")}')


def test_a_centre_beyond_its_segment_is_doubted_as_it_is_written(tmp_path: Path) -> None:
    """0.5 m from the hip in a thigh of 0.38 m: 1.32 of it, where the lower joint has -0.32."""
    text = ONE_PERSON.replace('centre = { value = 15, unit = "cm" }', 'centre = { value = 50, unit = "cm" }')
    assert doubted(tmp_path, text) == [
        "thigh: its centre is 1.3 times its length: is it in its unit, of one side, and of this person?"
    ]


def test_the_former_spelling_says_where_centres_are_from_the_other_end(tmp_path: Path) -> None:
    """By hand: 410 - 240 mm, 380 - 230 mm, and 37 + 0.2414 * 240 mm; what is copied unturned is doubted."""
    file = study_with(tmp_path, f"[person]\n{FORMER}")
    (line,) = [each for each in warned(lambda: standing_trials(file, "study")) if "former spelling" in each]
    assert line.endswith(
        "write segments.foot, segments.shank, segments.thigh; centres are then "
        "foot 95 mm from the heel, in place of 37 from the ankle; shank 170 mm from the knee, in place of 240 from the "
        "ankle; thigh 150 mm from the hip, in place of 230 from the knee"
    )
    assert not doubted(tmp_path / "former", FORMER)
    copied = FORMER.replace("thigh =", "segments.thigh =").replace("shank =", "segments.shank =")
    said = doubted(tmp_path / "copied", copied.replace("foot =", "segments.foot ="))
    assert [line.partition(":")[0] for line in said] == ["thigh", "shank", "foot"]
    turned = FORMER.replace("value = 24, unit", "value = 18, unit", 1)
    assert [line[:5] for line in doubted(tmp_path / "turned", turned)] == ["shank"]


@pytest.mark.parametrize("sex", ["female", "male"])
def test_ends_are_turned_and_back(sex: str) -> None:
    """Of a segment without its own length the table's counts; a foot whose centre is the table's is the table's."""
    own = {"foot": {"centre": 0.1}, "shank": {"centre": 0.2}, "thigh": {"length": 0.4}, "trunk": {"centre": 0.3}}
    there = from_proximal(own, 1.7, sex)  # type: ignore[arg-type]
    back = to_proximal(there, 1.7, sex)  # type: ignore[arg-type]
    assert {name: pytest.approx(values) for name, values in own.items()} == back
    heel = {"female": 0.4014, "male": 0.4415}[sex] * 0.26
    foot = from_proximal({"foot": {"length": 0.26, "centre": heel}}, 1.7, sex)["foot"]  # type: ignore[arg-type]
    assert foot["centre"] == pytest.approx(SHARES[sex]["foot"].centre * 0.26)  # type: ignore[index]
    assert segments_of(60.0, 1.7, sex, there)["trunk"].centre == 0.3  # type: ignore[arg-type]


def test_values_that_change_nothing_are_found_one_by_one() -> None:
    """A length that scales the table is used, where a body height leaves it without effect."""
    content = {
        "sex": "male",
        "segments": {
            "thigh": {"length": {"value": 0.4, "unit": "m"}, "mass": {"value": 9, "unit": "kg"}},
            "hand": {"centre": {"value": 0.06, "unit": "m"}},
            "foot": {"mass": {"value": 1.0, "unit": "kg"}},
            "head_arms_trunk": {"mass": {"value": 50, "unit": "kg"}},
        },
    }

    def of_hand(body: object) -> list[float]:
        return [body["hand"].centre]  # type: ignore[index]

    alone = checked(Path("study.toml"), DescribedPerson, content)
    found = unused_values(alone, 73.0, of_hand)
    assert found == ["segments.head_arms_trunk", "segments.thigh.mass", "segments.foot"]
    tall = checked(Path("study.toml"), DescribedPerson, content | {"height": {"value": 1.75, "unit": "m"}})
    assert unused_values(tall, 73.0, of_hand) == ["segments.head_arms_trunk", "segments.thigh", "segments.foot"]


OWN_FOOT = """height = { value = 1.81, unit = "m" }
segments.thigh = { mass = { value = 8, unit = "kg" } }
segments.shank = { mass = { value = 3, unit = "kg" }, gyration = { value = 11, unit = "cm" } }
segments.foot = { mass = { value = 1.1, unit = "kg" } }
"""


def test_studies_name_what_they_do_not_use(tmp_path: Path) -> None:
    """Gait: the prosthesis' own foot, and a shank that is a frustum. Overhead work: legs; its study: everything."""
    gait = written(tmp_path, "low", changed=("[persons.P1]\n", f"[persons.P1]\n{OWN_FOOT}"))
    said = warned(lambda: described(ProsthesisCompareOptions(gait)))
    line = "[persons.P1]: `segments.shank.gyration`, `segments.foot` are not used by prosthesis compare"
    assert [each for each in said if line in each]
    folder = tmp_path / "overhead"
    folder.mkdir()
    work = overhead(folder, 1, 1)
    text = 'age = { value = 30, unit = "years" }\nsegments.hand = { mass = { value = 0.5, unit = "kg" } }\n'
    text += 'segments.foot = { mass = { value = 1.1, unit = "kg" } }\n'
    work.write_text(work.read_text().replace('sex = "male"\n', f'sex = "male"\n{text}', 1), encoding="utf-8")
    said = warned(lambda: read_optimise(ShoulderOptimiseOptions(work)))
    assert [each for each in said if each.endswith("[persons.P1]: `segments.foot` is not used by shoulder optimise")]
    trials = work.read_text().replace('task = "T1"', 'task = "T1"\nlevel = "100%"', 1)
    work.write_text(trials, encoding="utf-8")
    said = warned(lambda: read_cases(StudyOptions(work)))
    line = "[persons.P1]: `age`, `segments.hand`, `segments.foot` are not used by shoulder study"
    assert [each for each in said if each.endswith(line)]


def test_the_sample_has_no_person_that_is_doubted() -> None:
    assert not [line for line in warned(lambda: standing_trials(STUDY, "study")) if "person" in line]
