"""A second family of equations for some effects: neither the first family's nor a candidate's."""
