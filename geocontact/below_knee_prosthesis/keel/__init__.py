"""The keel of a variable-stiffness foot: beam theory, eight hinges, equilibrium on the ground."""
