"""Contacts of a person who stands up, calibrated on trials."""
