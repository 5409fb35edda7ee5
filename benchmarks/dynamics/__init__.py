"""Bodies on joints and collocation, beside OpenSim and other peers."""
