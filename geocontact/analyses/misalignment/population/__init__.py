"""How the largest force spreads over people whose offsets differ."""
