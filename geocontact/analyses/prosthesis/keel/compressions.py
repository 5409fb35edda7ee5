"""Compressions of a foot as its file describes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.motion.checked_trial import check_apart
from geocontact.analyses.prosthesis.foot_file import SHIPPED, FootFile, keep_inputs, read_foot
from geocontact.analyses.prosthesis.foot_writer import quantity
from geocontact.analyses.prosthesis.keel.options import ProsthesisKeelOptions
from geocontact.analyses.prosthesis.sole_file import number_of
from geocontact.below_knee_prosthesis.keel.identification import (
    MeasuredCompression,
    compressed_curve,
    compressed_to,
)
from geocontact.data.errors import InputError
from geocontact.data.parameter import Number
from geocontact.io.recordings.foot_bench import Compression, read_compression_curve

NOISE, TILT, TRAVEL = 5e-5, radians(20.0), 5e-3
"""Standard deviation of a measured deflection [m]; tilt of the plate against the sole [rad] and its travel [m]."""


@dataclass(frozen=True, eq=False)
class CompressedFoot:
    """A foot and its compressions.

    Parameters
    ----------
    file
        Its description.
    measured
        In the order of the file.
    at, series
        Where the plate presses on the keel [m], and the stiffness of all besides [N/m]; None where it is sought.
    tilt, travel
        Of the plate on the sole [rad, m].
    """

    file: Path
    given: FootFile
    measured: tuple[MeasuredCompression, ...]
    at: float
    series: float | None
    tilt: float
    travel: float

    @property
    def settings(self) -> Mapping[str, str]:
        """Setting of each compression by its name; "" where its fulcrum is named."""
        return {one.name: one.setting or "" for one in self.given.described.compressions}


def read(o: ProsthesisKeelOptions) -> CompressedFoot:
    """The foot and all its compressions; InputError for one whose fulcrum is not on the foot."""
    file = SHIPPED if o.foot is None else o.foot
    given = read_foot(file)
    keep_inputs(file, given)
    if not given.described.compressions:
        remedy = "write [[compressions]] with setting or fulcrum, and curve or stiffness"
        raise InputError(file, "[[compressions]]", "there is none: nothing to identify the keel from", remedy)
    bench, keel = given.described.bench, given.foot.keel
    at = keel.length if bench.at is None else bench.at.value
    if not keel.range[1] < at <= keel.length:
        ends = f"{1e3 * keel.range[1]:g} to {1e3 * keel.length:g} mm"
        what = f"{1e3 * at:g} mm is not in front of all fulcrums and on the keel"
        raise InputError(file, "[bench] at", what, f"give a place from {ends}")
    noise = NOISE if bench.noise is None else bench.noise.value
    if not noise > 0.0:
        raise InputError(file, "[bench] noise", "is 0: no deflection is measured so well", "give what the gauge has")
    measured = tuple(_measured(file, one, given, noise) for one in given.described.compressions)
    curves = {one.name: np.column_stack([one.force, one.deflection]) for one in measured if one.curve}
    check_apart(curves, "two settings have one stiffness")
    return CompressedFoot(
        file,
        given,
        measured,
        at,
        None if bench.series is None else bench.series.value,
        TILT if bench.tilt is None else bench.tilt.value,
        TRAVEL if bench.travel is None else bench.travel.value,
    )


def _measured(file: Path, one: Compression, given: FootFile, noise: float) -> MeasuredCompression:
    """One compression."""
    fulcrum = _fulcrum(file, one, given)
    if one.stiffness is not None and one.sd is not None:
        if not 0.0 < one.sd.value < 0.5 * one.stiffness.value:
            place = f"[[compressions]] {one.name} sd"
            raise InputError(file, place, "is not between 0 and half of the stiffness", "check its unit")
        return compressed_to(one.name, fulcrum, one.stiffness.value, one.sd.value, sought=one.sought)
    if one.curve is None:  # refused by the description
        raise ValueError(one.name)
    curve = read_compression_curve(one.curve)
    add_input(f"compression {one.name}", one.curve, rows=len(curve.force))
    return compressed_curve(one.name, fulcrum, curve.force, curve.deflection, noise, sought=one.sought)


def _fulcrum(file: Path, one: Compression, given: FootFile) -> float:
    """Place of the fulcrum [m]; where its search begins if it is sought and the setting has none."""
    low, high = given.foot.keel.range
    settings = given.foot.record.settings
    if one.setting is not None and one.setting not in settings:
        if one.sought:
            return 0.5 * (low + high)
        what = f"{one.setting!r} is none of the settings"
        remedy = f"write one of {', '.join(settings) or '[settings]'}, or sought = true if its fulcrum is not known"
        raise InputError(file, f"[[compressions]] {one.name} setting", what, remedy)
    place = settings[one.setting] if one.setting is not None else np.nan
    if one.fulcrum is not None:
        place = one.fulcrum.value
    if not low <= place <= high:
        what = f"{1e3 * place:g} mm is out of the fulcrum's range"
        remedy = f"that is {1e3 * low:g} to {1e3 * high:g} mm"
        raise InputError(file, f"[[compressions]] {one.name} fulcrum", what, remedy)
    return place


def lines_of(given: CompressedFoot, stiffnesses: Mapping[str, tuple[float, float]]) -> list[str]:
    """The compressions as a description has them, curves as stiffness and standard deviation [N/m]."""
    lines = []
    for one, measured in zip(given.given.described.compressions, given.measured, strict=True):
        value, sd = stiffnesses[one.name]
        lines += ["", "[[compressions]]", f'name = "{one.name}"']
        if one.setting is not None:
            lines.append(f'setting = "{one.setting}"')
        else:
            lines.append(f"fulcrum = {quantity(Number(measured.fulcrum, 'option'), 'm')}")
        lines += ["sought = true"] * one.sought
        slope = Number(value, "derived", "slope of its curve")
        stated = slope if one.stiffness is None else number_of(one.stiffness)
        error = Number(sd, "derived", "of that slope") if one.sd is None else number_of(one.sd)
        lines += [f"stiffness = {quantity(stated, 'N/m')}", f"sd = {quantity(error, 'N/m')}"]
    return lines
