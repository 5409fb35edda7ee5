"""The frame of every analysis: one result from Python and from the command line, whole or not at all."""

from __future__ import annotations

import json
from base64 import b64decode
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

import pandas as pd
import pytest
from matplotlib.figure import Figure

import geocontact as gc
from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.frame.job import Call, Job, execute
from geocontact.analyses.frame.marks import Length, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.record import Listener
from geocontact.analyses.frame.result import Result
from geocontact.cli.command import Command
from geocontact.data.errors import InputError, InputWarning


@dataclass(frozen=True)
class DoubleOptions(Options):
    """Twice a length.

    Parameters
    ----------
    file
        Where it stands [mm].
    more
        What is added.
    """

    writes: ClassVar[str] = """
    Writes double.csv,
    see `more`.
    """
    last_line: ClassVar[str] = "next: look into {out}"

    file: Path
    _: KW_ONLY
    more: Annotated[Length, Spelled(default="0")] = 0.0


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Doubled(Result):
    """The length [m]."""

    elsewhere: ClassVar[frozenset[str]] = frozenset({"none"})

    options: DoubleOptions
    length: float

    def tables(self) -> dict[str, pd.DataFrame]:
        return {"double": pd.DataFrame({"length [mm]": [self.length * 1e3]}), "none": pd.DataFrame()}

    @property
    def title(self) -> str:
        return "Twice"


def read_length(o: DoubleOptions) -> float:
    add_input("`file`", o.file)
    try:
        value = float(o.file.read_text()) * 1e-3
    except ValueError as error:
        raise InputError(o.file, "", "is not a number", "or give `more`") from error
    if value > 1.0:
        reserve("more than a metre, see `more`")
    return value


def run(value: float, o: DoubleOptions) -> Doubled:
    say(f"twice {value:g} m")
    return Doubled(options=o, length=2.0 * value + o.more)


double = Job("double", DoubleOptions, read_length, run)
from_command = Command(DoubleOptions, lambda _: double)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "length.txt").write_text("5")
    return tmp_path / "length.txt"


def test_a_call_returns_a_result_and_writes_nothing(file: Path) -> None:
    result = double(file, more=gc.mm(1))
    assert result.length == pytest.approx(11e-3) and str(result) == "twice 0.005 m"
    assert list(result.table()["length [mm]"]) == pytest.approx([11.0])
    assert [p.name for p in file.parent.iterdir()] == [file.name]
    with pytest.raises(KeyError, match="there are double, none"):
        result.table("triple")


def test_reservations_become_warnings_once_and_stand_in_the_result(file: Path) -> None:
    file.write_text("2000")
    with pytest.warns(InputWarning, match="more than a metre, see `more`") as caught:
        result = double(file)
    assert len(caught) == 1
    assert result.warnings == ("more than a metre, see `more`",)
    assert str(result).endswith("warning: more than a metre, see `more`")


def test_a_result_is_written_as_the_command_writes_it(file: Path, tmp_path: Path) -> None:
    python = double(file, more=gc.mm(1)).write(tmp_path / "python")
    call = Call({"file": file, "more": "1"}, Listener())
    execute(double, DoubleOptions(file, more=gc.mm(1)), tmp_path / "typed", call)
    told = [json.loads((folder / "run.json").read_text()) for folder in (python, tmp_path / "typed")]
    assert (python / "double.csv").read_bytes() == (tmp_path / "typed/double.csv").read_bytes()
    assert told[0]["options_si"] == told[1]["options_si"] == {"file": str(file), "more [m]": 1e-3}
    assert told[0]["options"] == told[0]["options_si"] and told[1]["options"]["more"] == "1"
    assert told[0]["files"] == ["double.csv", "report.html", "run.json"]
    assert set(told[0]["sha256"]) == {"double.csv", "report.html"}


def test_the_page_alone(file: Path, tmp_path: Path) -> None:
    page = double(file).page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "Twice 0.005\u00a0m." in page and "length [mm]" in page and file.name in page


def test_the_command_says_what_was_found_and_spells_options(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file.write_text("2000")
    assert from_command(file, out=tmp_path / "out", more="1mm") == 0
    said = capsys.readouterr()
    out = tmp_path / "out"
    results = f"results in {out}: double.csv, report.html, run.json"
    assert said.out.splitlines() == ["twice 2 m", results, f"next: look into {out}"]
    assert said.err == "warning: more than a metre, see --more\n"
    told = json.loads((tmp_path / "out/run.json").read_text())
    assert told["warnings"] == ["more than a metre, see --more"] and told["inputs"][0]["role"] == "FILE"
    file.write_text("five")
    with pytest.raises(InputError, match="is not a number; or give --more"):
        from_command(file, out=tmp_path / "out")
    assert from_command.__doc__ == "Twice a length.\n\nWrites double.csv, see --more.", "what the options say"


def test_what_fails_leaves_the_folder_as_it_was(file: Path, tmp_path: Path) -> None:
    out = double(file).write(tmp_path / "out")
    before = {p.name: p.read_bytes() for p in out.iterdir()}
    result = double(file)
    object.__setattr__(result, "length", "no number")
    with pytest.raises(TypeError):
        result.write(out)
    assert {p.name: p.read_bytes() for p in out.iterdir()} == before
    assert not [p for p in tmp_path.iterdir() if p.name.startswith(".geocontact")]


def test_a_notebook_shows_sentences_and_figure(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One answer that notebooks prefer to text: pictures alone would hide what was found."""
    file.write_text("2000")
    with pytest.warns(InputWarning):
        result = double(file)
    assert result._repr_html_() == "<p>twice 2 m</p><p>warning: more than a metre, see `more`</p>"
    monkeypatch.setattr(Doubled, "figure", lambda _: Figure())
    assert result._repr_html_().endswith('"/>') and "<p>twice 2 m</p>" in result._repr_html_()
    drawn, _, rest = result._repr_html_().partition("base64,")[2].partition('"')
    assert b64decode(drawn).startswith(b"\x89PNG") and rest == ' alt="Figure: twice 2 m"/>'
