"""Inverse kinematics: reads, computes, writes, says what it found."""

from __future__ import annotations

import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from geocontact.analyses.motion.inverse_kinematics.page import write_kinematics_report
from geocontact.analyses.motion.inverse_kinematics.write import knee_table, knees_of, write_results
from geocontact.analyses.motion.marker_tasks import marker_tasks
from geocontact.analyses.motion.markers import markers_given, with_marker_set
from geocontact.analyses.options_table import options_table
from geocontact.analyses.progress import progress
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.ik import IkOptions
from geocontact.data.errors import InputError
from geocontact.dynamics.inverse_kinematics import inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.results import write_table
from geocontact.view.page.tables import inputs_table


def analyse(markers: Path, o: IkOptions) -> int:
    """Run the whole analysis."""
    record = Record("ik", {"markers": markers, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
        model = with_marker_set(record, model, o.model, o.marker_set)
        knees = knees_of(o.knee, model)
        seen = markers_given(markers, o.axes, o.time)
        record.add_input("markers", markers, frames=len(seen), markers=len(seen.names))
        tasks = marker_tasks(record, model, seen, o.tasks, o.weight, o.hold)
        tree, filled = tree_of(model), _filled(o.fill)
        began = time.perf_counter()
        with progress("frames", len(seen)) as step:
            try:
                found = inverse_kinematics(tree, seen, tasks, lambda _: step(), fill=filled)
            except ValueError as error:
                raise InputError(markers, "", str(error), "compare the names in the file with the model's") from error
        seconds = time.perf_counter() - began
        write_results(record, model, found, draft, seconds)
        if knees:
            write_table(knee_table(model, found, knees), draft, False, "knees")
        title = f"Inverse kinematics of {markers.name}"
        tables = [inputs_table(record.inputs), options_table(record)]
        write_kinematics_report(draft / "report.html", title, model, found, tables, list(record.warnings))
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _filled(seconds: float) -> float:
    if not (np.isfinite(seconds) and seconds >= 0.0):
        raise InputError("", "--fill", f"{seconds:g} is not a time", "write seconds; 0 fills nothing")
    return seconds
