"""Effects of the mechanics in synthetic cases."""
