"""Below-knee prosthesis with a foot whose stiffness is set by a fulcrum under its keel."""
