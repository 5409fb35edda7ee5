"""The torque of a leg exoskeleton by dynamic parameters that an unloaded motion tells."""
