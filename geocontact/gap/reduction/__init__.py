"""How far the gap shrinks on trials that were held out."""
