"""Synthetic recordings of the elbow, or forces along recorded angles: computes, writes, says what it made."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.checks import refuse
from geocontact.analyses.figure_files import save_both
from geocontact.analyses.misalignment import parameters as elbow_numbers
from geocontact.analyses.misalignment.displacement_surfaces import surfaces
from geocontact.analyses.misalignment.figures import surface_figure
from geocontact.analyses.misalignment.pages import write_simulation_report
from geocontact.analyses.misalignment.parameters import MMHG, PER_SI, TYPED, unit_in_key
from geocontact.analyses.options_table import options_table
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.explicit import Offsets, require_no_pole, require_reach
from geocontact.axis_misalignment.synthetic import PAPER, Design, ideal, synthetic
from geocontact.cli.elbow_simulate import SimulateOptions
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.io.recordings.elbow_recording import BETA, MOST_BENT, STRAIGHTEST, read_elbow_recording
from geocontact.io.text.columns import parse_map
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Table
from geocontact.view.page.tables import inputs_table

HEAD = "# synthetic: geocontact elbow simulate"
TRIALS, SEED = 6, 0
LEAST_RANGE = 5.0  # deg
USUAL = Design()


def simulated(paths: Sequence[Path], o: SimulateOptions) -> int:
    """Run the whole simulation."""
    record = Record("elbow simulate", {"recordings": list(paths), **asdict(o)})
    _refuse_idle(paths, o)
    numbers = {**PAPER, **elbow_numbers.values(o.numbers, "--numbers")}
    if numbers["s"] != 0.0 and not paths and o.pressure is None:
        raise InputError(
            "", "--numbers", "s does nothing without a cuff pressure", "give --pressure, for example 10:60"
        )
    stroke = None if o.stroke_mm is None else _stroke(o.stroke_mm)
    design = _design(o)
    with record.catching_warnings(), written_whole(o.out) as draft:
        if paths:
            made = _along(record, paths, o, numbers, stroke)
        else:
            _refuse_numbers(numbers, np.linspace(*design.reach, 181))
            made = _made(design, o, numbers, stroke)
        for each in made:
            _write(each, draft, o.parquet)
        truth = {"synthetic": True, "numbers": _typed(numbers), **({} if stroke is None else _told_stroke(stroke))}
        record.results["truth"] = truth
        (draft / "truth.json").write_text(json.dumps(truth, indent=2) + "\n", encoding="utf-8")
        _show(record, numbers, made, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    for each in made:
        low, high = np.degrees([each.beta.min(), each.beta.max()])
        span = f"{each.force.min():.1f} … {each.force.max():.1f} N over {low:.0f} … {high:.0f}°"
        record.say(f"{each.name}, synthetic: {span}, {each.time[-1] - each.time[0]:g} s")
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _refuse_idle(paths: Sequence[Path], o: SimulateOptions) -> None:
    """Options that do nothing, and numbers that cannot be."""
    of_design = {
        "--trials": o.trials, "--seconds": o.seconds, "--rate": o.rate, "--band": o.band, "--range": o.range,
        "--pressure": o.pressure, "--noise": o.noise, "--memory": o.memory, "--donning-mm": o.donning_mm,
        "--bits": o.bits, "--seed": o.seed,
    }  # fmt: skip
    names = [path.stem for path in paths]
    twice = next((name for name in names if names.count(name) > 1), "")
    refuse(
        *((bool(paths) and value is not None, option, "does nothing along a recording", "leave it out")
          for option, value in of_design.items()),
        *((not paths and value is not None, option, "does nothing without a recording", "leave it out")
          for option, value in (("--map", o.map), ("--angles", o.angles))),
        (bool(twice), "", f"two recordings are named {twice!r}", "rename one"),
        (o.trials is not None and not 1 <= o.trials <= 1000, "--trials", f"{o.trials} is not 1 to 1000", "give 6"),
        (o.bits is not None and not 0 <= o.bits <= 32, "--bits", f"{o.bits} is not 0 to 32", "give 12"),
        *((value is not None and not (np.isfinite(value) and value >= 0.0), option, f"{value} is not 0 or more",
           "give for example 0.5")
          for option, value in (("--noise", o.noise), ("--memory", o.memory), ("--donning-mm", o.donning_mm))),
        (o.seconds is not None and not 1.0 <= o.seconds <= 3600.0, "--seconds", f"{o.seconds} is not 1 to 3600",
         "give 60"),
        (o.rate is not None and not 5.0 <= o.rate <= 1e4, "--rate", f"{o.rate} is not 5 to 10000", "give 1000"),
    )  # fmt: skip


def _design(o: SimulateOptions) -> Design:
    band = USUAL.band if o.band is None else elbow_numbers.interval(o.band, "--band")
    if band[0] <= 0.0:
        raise InputError("", "--band", f"{o.band!r} is not above 0 Hz", "write for example 0.05:0.35")
    rate = USUAL.rate if o.rate is None else o.rate
    if band[1] > 0.5 * rate:
        raise InputError("", "--band", f"{o.band!r} reaches above half of {rate:g} Hz", "give a higher --rate")
    pressures = None
    if o.pressure is not None:
        first, last = elbow_numbers.interval(o.pressure, "--pressure")
        pressures = (first * MMHG, last * MMHG)
    return Design(
        seconds=USUAL.seconds if o.seconds is None else o.seconds,
        rate=rate,
        band=band,
        reach=USUAL.reach if o.range is None else _reach(o.range),
        noise=USUAL.noise if o.noise is None else o.noise,
        memory=USUAL.memory if o.memory is None else o.memory,
        donning=USUAL.donning if o.donning_mm is None else o.donning_mm * 1e-3,
        bits=USUAL.bits if o.bits is None else o.bits,
        pressures=pressures,
    )


def _reach(text: str) -> tuple[float, float]:
    low, high = elbow_numbers.interval(text, "--range")
    if high - low < LEAST_RANGE:
        what = f"{text!r} is a range of {high - low:.3g} degrees"
        raise InputError("", "--range", what, "are these radians? write degrees, for example 8:92")
    if low < np.degrees(STRAIGHTEST) or high > np.degrees(MOST_BENT):
        raise InputError("", "--range", f"{text!r} is beyond any elbow", "write degrees, for example 8:92")
    return float(np.radians(low)), float(np.radians(high))


def _stroke(text: str) -> tuple[float, float]:
    low, high = elbow_numbers.interval(text, "--stroke-mm")
    return low * 1e-3, high * 1e-3


def _refuse_numbers(numbers: Mapping[str, float], beta: np.ndarray) -> None:
    """A pole, a fold, a stiffness that is none."""
    if numbers["k"] <= 0.0:
        raise InputError("", "--numbers", f"k = {numbers['k']:g} N/m is not positive", "give for example k=222")
    offsets = Offsets(l=numbers["l"], z=numbers["z"], x=numbers["x"], y=numbers["y"])
    try:
        require_reach(offsets)
        require_no_pole(beta, offsets)
    except ValueError as error:
        raise InputError("", "--numbers", str(error), "give smaller offsets or a longer link") from error


def _made(
    design: Design, o: SimulateOptions, numbers: Mapping[str, float], stroke: tuple[float, float] | None
) -> list[ElbowRecording]:
    """Recordings after the paper's experiment."""
    rng = np.random.default_rng(SEED if o.seed is None else o.seed)
    count = TRIALS if o.trials is None else o.trials
    mean = 0.0 if design.pressures is None else float(np.mean(design.pressures))
    kinds = [("locked", None), *([] if stroke is None else [("free", stroke)])]
    try:
        return [synthetic(f"{kind}_{k + 1}", numbers, design, rng, each, mean) for kind, each in kinds
                for k in range(count)]  # fmt: skip
    except ValueError as error:
        raise InputError("", "--donning-mm", str(error), "give a smaller one") from error


def _along(
    record: Record,
    paths: Sequence[Path],
    o: SimulateOptions,
    numbers: Mapping[str, float],
    stroke: tuple[float, float] | None,
) -> list[ElbowRecording]:
    """Ideal forces along recorded angles."""
    mapping = {} if o.map is None else parse_map(o.map, (BETA,))
    found = []
    for path in paths:
        r = read_elbow_recording(path, mapping, o.angles, needed=())
        record.add_input("angle", path, samples=len(r.time))
        _refuse_numbers(numbers, r.beta)
        if numbers["s"] != 0.0 and r.pressure is None:
            raise InputError(path, "", "s follows the cuff's pressure, which is not here", "add it, or leave s out")
        centre = _centre(r.pressure)
        pressure = 0.0 if r.pressure is None else r.pressure - centre
        force, joint = ideal(r.time, r.beta, numbers, stroke, pressure)
        shown = None if stroke is None else joint
        found.append(ElbowRecording(f"simulated_{path.stem}", r.time, r.beta, force, shown, r.pressure))
    return found


def _centre(pressure: np.ndarray | None) -> float:
    """The pressure [Pa] at which k holds: the mean of a recording, 0 without."""
    return 0.0 if pressure is None else float(pressure.mean())


def _write(r: ElbowRecording, folder: Path, parquet: bool) -> None:
    """One trial as a table, after a line that says what it is."""
    columns = {"time [s]": r.time, "beta [deg]": np.degrees(r.beta), "force [N]": r.force}
    if r.displacement is not None:
        columns["displacement [mm]"] = r.displacement * 1e3
    if r.pressure is not None:
        columns["pressure [mmHg]"] = r.pressure / MMHG
    table = pd.DataFrame(columns)
    write_table(table, folder, parquet, r.name)
    file = folder / f"{r.name}.csv"
    file.write_text(f"{HEAD}\n{file.read_text(encoding='utf-8')}", encoding="utf-8")


def _typed(numbers: Mapping[str, float]) -> dict[str, float]:
    """Numbers with their units in the keys."""
    return {f"{name}_{unit_in_key(name)}": value * PER_SI[name] for name, value in numbers.items()}


def _told_stroke(stroke: tuple[float, float]) -> dict[str, object]:
    return {"stroke_mm": [end * 1e3 for end in stroke]}


def _show(
    record: Record, numbers: Mapping[str, float], made: Sequence[ElbowRecording], o: SimulateOptions, folder: Path
) -> None:
    """Surfaces of the displacement, figure, page."""
    maps = surfaces(numbers["l"], numbers["z"])
    write_table(maps.table(), folder, o.parquet, "surfaces")
    drawing = save_both(surface_figure(maps), folder, "surfaces")
    rows = [(name, TYPED[name], f"{value * PER_SI[name]:g}") for name, value in numbers.items()]
    tables = [Table("True numbers", ("number", "unit", "value"), rows), inputs_table(record.inputs),
              options_table(record)]  # fmt: skip
    write_simulation_report(folder / "report.html", made, drawing, tables, record.warnings)
