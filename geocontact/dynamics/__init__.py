"""Bodies that move: one symbolic tree, its kinematics and dynamics, inverse kinematics."""
