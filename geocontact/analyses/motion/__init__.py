"""Scaling, inverse kinematics, inverse dynamics and virtual markers of OpenSim models."""
