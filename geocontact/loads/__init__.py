"""Many small loads become one: resultants, centres of pressure."""
