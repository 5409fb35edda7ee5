"""Recordings of pressure mats, by format, into one type (`geocontact.data.pressure_frames`).

Row 0 and column 0 of what is returned are the first ones of the mat seen from the side that is pressed.
"""
