"""`geocontact sit-to-stand`: standing up from a chair."""

from __future__ import annotations

from cyclopts import App

sit_to_stand = App(
    name="sit-to-stand", help="Standing up from a chair: contacts calibrated, trials predicted, a device chosen."
)
sit_to_stand.command("geocontact.cli.sit_to_stand.calibrate:calibrate", name="calibrate")
sit_to_stand.command("geocontact.cli.sit_to_stand.predict:predict", name="predict")
sit_to_stand.command("geocontact.cli.sit_to_stand.design:design", name="design")
sit_to_stand.command("geocontact.cli.sit_to_stand.compare:compare", name="compare")
sit_to_stand.command("geocontact.cli.sit_to_stand.device:device", name="device")
