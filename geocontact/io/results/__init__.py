"""Tables of results in binary forms."""
