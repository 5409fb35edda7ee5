"""Gap cases, and what a diagnosis says of them."""
