"""From a standing and a walking trial to the leg, its angles and the pelvis."""
