"""OpenSim's set-up files of the tools that `ik`, `id` and `scale` stand for."""

from __future__ import annotations

from pathlib import Path

from geocontact.io.opensim.tool_setup import ToolSetup, read_tool_setup

TOOLS = {"ik": "InverseKinematicsTool", "id": "InverseDynamicsTool", "scale": "ScaleTool"}
"""By command."""


def setup_of(command: str, file: Path) -> ToolSetup:
    """What the set-up asks of the command: its recording, and options as they are typed."""
    return read_tool_setup(file, TOOLS[command])
