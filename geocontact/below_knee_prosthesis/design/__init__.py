"""Which fulcrum, alignment or stiffness of the foot suits a person, and whether the model is good enough to say so."""
