"""Modules that make a base model of a function or of an FMU, as they are written beside the case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from pprint import pformat

FUNCTION = '''"""{function} of {module}.py as a base model for `geocontact gap diagnose`. Keep it beside {module}.py."""

import geocontact as gc
from {module} import {function}

INPUTS = {inputs}
OUTPUTS = {outputs}
SIMULATOR = gc.simulator_base(
    "{module}",
    INPUTS,
    OUTPUTS,
    {function},
    dynamic={dynamic},
{law})
'''

FMU = '''"""{file} as a base model for `geocontact gap diagnose`: one co-simulation per trial. Keep it beside {file}.

FMPy reads outputs after a step, with the inputs that the step began with. Each step here begins with the inputs of its
end, so that outputs are those of their own sample; inputs are held over a step, a part 1/STEPS of a sample.
"""

from pathlib import Path

import fmpy
import numpy as np

import geocontact as gc

INPUTS = {inputs}
OUTPUTS = {outputs}
PARAMETERS = {parameters}
STEPS = 4  # communication points per sample
FILE = Path(__file__).resolve().parent / "{file}"
UNPACKED = fmpy.extract(str(FILE))
DESCRIPTION = fmpy.read_model_description(UNPACKED)


def run(time, inputs, numbers):
    """Outputs at the times of a trial; the FMU's own clock begins at 0."""
    step = float(np.median(np.diff(time))) / STEPS
    count = int(np.ceil((time[-1] - time[0]) / step - 1e-6)) + 1
    own = step * np.arange(count)
    driven = np.zeros(count, dtype=[("time", float), *((name, float) for name in INPUTS)])
    driven["time"] = own
    for name, values in zip(INPUTS, inputs):
        driven[name] = np.interp(own, time - time[0], values)
    found = fmpy.simulate_fmu(
        UNPACKED,
        validate=False,
        model_description=DESCRIPTION,
        start_time=0.0,
        stop_time=count * step,
        output_interval=step,
        start_values={{name: numbers[name] for name in PARAMETERS}},
        input=driven,
        output=list(OUTPUTS),
        fmi_type="CoSimulation",
    )
    after = found["time"] - step
    return np.column_stack([np.interp(time - time[0], after[1:], found[name][1:]) for name in OUTPUTS])


SIMULATOR = gc.simulator_base("{name}", INPUTS, OUTPUTS, run, dynamic=True)
'''


def function_adapter(
    module: str,
    function: str,
    inputs: Mapping[str, str],
    outputs: Mapping[str, str],
    acts_on: str = "",
    dynamic: bool = False,
) -> str:
    """Text of the module that wraps a function of another one; SI units of channels by name."""
    law = f'    acts_on="{acts_on}",\n' if acts_on else ""
    return FUNCTION.format(
        module=module, function=function, inputs=dict(inputs), outputs=dict(outputs), dynamic=dynamic, law=law
    )


def fmu_adapter(file: Path, inputs: Mapping[str, str], outputs: Mapping[str, str], parameters: Sequence[str]) -> str:
    """Text of the module that runs an FMU by FMPy, which it needs; SI units of channels by name."""
    return FMU.format(
        file=file.name,
        name=file.stem,
        inputs=dict(inputs),
        outputs=dict(outputs),
        parameters=pformat(list(parameters), width=100),
    )
