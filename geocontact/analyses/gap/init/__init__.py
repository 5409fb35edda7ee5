"""A gap case begun from a simulator of somebody's own and a folder of recordings."""
