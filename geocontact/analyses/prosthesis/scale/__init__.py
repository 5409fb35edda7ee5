"""Both legs of a person made to measure, for OpenSim and the commands ik and id."""
