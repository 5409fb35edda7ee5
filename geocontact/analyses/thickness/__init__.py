"""Thickness between two surfaces: cartilage on bone, a liner."""
