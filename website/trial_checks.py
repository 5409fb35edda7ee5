"""Checks of a recorded trial, of two surfaces and of results: docs/reference/trial_checks.md, from their own tables.

What the battery of the tests holds stands in the tests; the page counts it.
"""

from __future__ import annotations

import inspect
import json
from collections.abc import Iterable

from geocontact.analyses.catalogue import ENTRIES
from geocontact.analyses.gap.case import CHANCE, GAIN
from geocontact.analyses.mat.goodness import LOST, PALPATED
from geocontact.analyses.modulus.goodness import LARGER_RADIUS, OTHER_RADIUS
from geocontact.analyses.motion.goodness import SLIDING
from geocontact.analyses.motion.marker_tasks import FAR
from geocontact.analyses.prosthesis.walk.result import OTHER_FOOT
from geocontact.analyses.shape.goodness import EDGE, OTHER_SIDE, POOR
from geocontact.gap.levels import LEFT_OVER
from geocontact.identify import goodness_of_fit as fit
from geocontact.identify.signals.agreement import GAIN as GAIN_OFF
from geocontact.trial_checks.mesh_checks import MESH_CHECKS, MeshCheck
from geocontact.trial_checks.recorded import Check
from geocontact.trial_checks.table import CHECKS
from website.stage import ROOT

PAGE = "docs/reference/trial_checks.md"

HEAD = """# What is checked on the way in and out

## On the way in: a trial against itself

{commands} compare the inputs of a trial with each other before they compute anything, and so does each trial of a
study. What cannot be right is refused, exit 2; anything else is a warning, which names the likely cause. A check is
silent where one of its two inputs is not there. Labels of markers are recognised in the sets of Plug-in Gait, Helen
Hayes, Cleveland and OpenSim's models. A limit without a source is ours: beyond what the recordings below hold.

| check | compares | speaks from | spoken of in the tests |
|---|---|---|---|
"""
SURFACES = """
Surfaces of `area`, `knee settle`, `fit` with `other` and `mat` with a second scan:

| check | compares | speaks from | spoken of in the tests |
|---|---|---|---|
"""
BATTERY = """
The shipped trials are damaged in {count} ways, counted above, each refused or warned of with its cause. A real walk
is damaged in {real} more. {recordings} real recordings, {models} motions of models and
{meshes} sets of surfaces pass, but for jumps of 40 to 54 mm in two files. Of {read} commands on real files,
three devices among them, each warning was looked at and is right.

`--axes` turns markers and plates alike; plates that are upright only before that turn stay, with a warning.

What no check can see: plates of another trial of that person with steps at the same places and times; half of the
force without a mass, in `cop` and `gap gather`; 60 N on a plate over which no foot swings; a mirrored force along the
floor of who stands up; steps that are not whole; a gain below 1.3 of a file's only plate; kgf or lbf in `modulus` and
`knee settle`; a diameter for R of a two-sided knee; a drift in cm; m called mm, and signs of moments, near the origin;
a heel 30 mm lower in the standing trial; a strap's unit while its stiffness is sought; a clock 10 ms or 5 % off; a
load 50 mm ahead; cross-talk below 10 %; markers filtered at too low a frequency; zeros and signs of angles without
markers; a marker 30 mm off in `ik`; T10 150 mm lower; a tool in lb; a mirrored mat; poses or a tool's current backwards
in time; the other hand's push; a gain of all motors; `medial` or two of the load cells exchanged; l
and z of an elbow exchanged.

New wrong inputs of each round, as found, before checks were added for them: 25 of 95, 17 of 65, 8 of 41, 23 of 94 and
10 of 33 were not named by their cause, the last two on commands that had few attempts; 12 of these 33 are in the list
above.

Checks took {median:.1%} of a command's CPU time in the median of {commands}, {most:.1%} at most
(`python -m benchmarks.robustness.checks_cost`).

## On the way out: a result against its data

A result that was compared with data says so in `run.json` (`fit`), and in Python as `result.fit_outcome`: `fits`,
`doubtful`, or `contradicts`. With `contradicts` that is the first sentence, the command ends with 1 (2 where a check
above warned of more than a jump), no parameter is called known, ends of intervals and standard errors stay empty. A
doubt is a warning. {judged} commands judge their result so; studies and `gap diagnose --many` list it for every trial.

| check | doubtful | contradicts |
|---|---|---|
"""
RESULTS = {
    "of_residual": (
        f"z > {fit.SURE:g}, rms > {fit.LARGER:g} s; rms < {fit.TOO_SMALL:g} s",
        f"z > {fit.SURE:g}, rms > {fit.FAR:g} s",
    ),
    "of_each": (f"> {fit.SURE:g} SD", ""),
    "of_r2": ("", "R² < 0"),
    "of_bounds": ("on one of them", ""),
    "of_range": ("any", f"{fit.MUCH:.0%} or more"),
    "of_many_r2": ("R² < 0 in one", f"R² < 0 in {fit.MUCH:.0%} of them"),
    "of_low_r2": (f"R² < {fit.DESCRIBES:g}", "R² < 0"),
    "of_size": ("beyond what is usual", "beyond what is possible"),
    "of_verdict": ("its interval reaches that", ""),
}
"""From where each test of fit doubts and contradicts; what it compares is the first line of its docstring."""
OWN = f"""| markers with the model, `ik` and `scale` | beyond what OpenSim advises | rms > {1e3 * FAR:g} mm |
| residual force, moment of `id` | beyond Hicks et al. | > 1/3 of weight, weight × height, {fit.MUCH:.0%} of the time |
| load of `id` with the foot under it | | nearer to the other foot |
| joint of one segment with that of the other | rms > {2e3 * SLIDING:g} mm | rms > {1e3 * FAR:g} mm |
| cylinder or sphere with a plane, `fit` | rms > {POOR:.0%} of the radius | the plane is as near |
| sphere with that of its inner half, `fit` | {EDGE:.0%} of the radius, intervals apart | |
| faces that look the other way, `fit` | {OTHER_SIDE:.0%} of the area | |
| gain of a trial with others', `gap diagnose` | {GAIN:.0%}, less likely than {CHANCE:.0%} | |
| what `gap diagnose` names with held-out trials | {LEFT_OVER:.0%} of the squared error stay | {fit.MUCH:.0%} stay |
| R of `modulus`, dA/dT = 2πR | {LARGER_RADIUS:g} times; a side {OTHER_RADIUS:g} | |
| force of `prosthesis walk` with its plate | rms > {OTHER_FOOT:.0%} BW | |
| gain of `elbow compare` | {GAIN_OFF:.0%} in every trial | |
| landmarks of `mat` | rms > {1e3 * PALPATED:g} mm | rms > {1e3 * LOST:g} mm |
"""
"""Those that one analysis has for itself."""
NOISE = """
s is the stated noise of a residual r, z = (mean r²/s² − 1) / √(2/n (1 + 2 Σρ²)), with ρ the residual's autocorrelation
up to its first negative value (Bartlett 1946).
"""


def _rows(checks: Iterable[Check | MeshCheck], damaged: dict[str, list[str]]) -> str:
    rows = ""
    for check in checks:
        name = check.name
        cells = (name, check.compares, check.limit, "; ".join(damaged[name]))
        rows += f"| {' | '.join(cells)} |\n"
    return rows


def _damages(damages: dict[str, tuple[str, object]]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for words, (check, _) in damages.items():
        found.setdefault(check, []).append(words)
    return found


def tests_of_fit() -> dict[str, str]:
    """First lines of the tests of fit, by the name of each."""
    functions = {name: each for name, each in vars(fit).items() if name.startswith("of_") and inspect.isfunction(each)}
    return {name: (inspect.getdoc(each) or "").partition("\n")[0] for name, each in functions.items()}


def _judged() -> list[str]:
    """Commands that judge a result, in a file of their own or in one of their group that they import."""
    found = []
    for entry in ENTRIES:
        folder = ROOT.joinpath(*entry.package.split("."))
        texts = [file.read_text("utf-8") for file in folder.glob("*.py")]
        shared = [file.stem for file in folder.parent.glob("*.py") if "judge(" in file.read_text("utf-8")]
        own = any("judge(" in text for text in texts)
        if entry.command and (own or any(f".{stem} import" in text for stem in shared for text in texts)):
            found.append(entry.command)
    return found


def trial_checks() -> str:
    """The whole page."""
    from tests.real import test_real_trial_checks as real
    from tests.trial_checks import test_checks, test_commands, test_mesh_checks

    commands = ", ".join(f"`{name}` ({len(damages)})" for name, (_, _, damages) in test_commands.COMMANDS.items())
    trials = HEAD.format(commands=commands) + _rows(CHECKS, _damages(test_checks.DAMAGED))
    surfaces = SURFACES + _rows(MESH_CHECKS, _damages(test_mesh_checks.DAMAGED))
    cost = json.loads((ROOT / "benchmarks" / "results" / "checks_cost.json").read_text("utf-8"))["figures"]
    battery = BATTERY.format(
        count=len(test_commands.EACH),
        real=len(real.DAMAGED),
        recordings=len(real.TRIALS),
        models=len(real.MODELS),
        read=len(real.READ) + len(real.DEVICES),
        meshes=len(real.SURFACES),
        judged=len(_judged()),
        median=cost["median"],
        most=cost["most"],
        commands=sum(len(row) > 2 for row in cost["commands"].values()),
    )
    results = ""
    for name, line in tests_of_fit().items():
        doubtful, contradicts = RESULTS[name]
        results += f"| {line.removeprefix('A doubt for ').removesuffix('.')} | {doubtful} | {contradicts} |\n"
    return trials + surfaces + battery + results + OWN + NOISE
