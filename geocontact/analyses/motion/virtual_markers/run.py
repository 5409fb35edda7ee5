"""Virtual markers: reads, computes, writes, says what it found."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.cli.markers import MarkersOptions
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.trc_writer import write_trc
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table


def analyse(coordinates: Path, o: MarkersOptions) -> int:
    """Run the whole analysis."""
    record = Record("markers", {"coordinates": coordinates, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        model = read_multibody(o.model)
        record.add_input("--model", o.model, bodies=len(model.bodies), markers=len(model.markers))
        if not model.markers:
            raise InputError(o.model, "", "has no markers", "give a model with a MarkerSet")
        table = read_table(coordinates)
        record.add_input("coordinates", coordinates, frames=len(table.time))
        if table.time_unit != "s":
            raise InputError(coordinates, "", "time is in per cent of a cycle", "a .trc file needs seconds")
        places = model.marker_places(motion_of(table, model, o.angles))
        names = tuple(m.name for m in model.markers)
        write_trc(draft / "markers.trc", MarkerTrajectories(table.time, places, names))
        record.results.update(frames=len(table.time), markers=len(names))
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    record.say(f"{len(names)} markers in {len(table.time)} frames; results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0
