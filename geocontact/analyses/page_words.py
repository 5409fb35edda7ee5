"""Words that several pages share."""

from __future__ import annotations

NOT_A_DEVICE = (
    "A research result, not a clinical device: it must not be used to diagnose, "
    "to plan treatment or to select an implant for a patient."
)


def counted(count: int, noun: str) -> str:
    """ "1 frame", "6 frames": of nouns that take an s."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
