"""Files of OpenSim: models, storage, external loads, tasks."""
