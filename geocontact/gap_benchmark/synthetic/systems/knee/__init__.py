"""The knee implant of synthetic cases."""
