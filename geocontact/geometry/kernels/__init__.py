"""Compiled inner loops (numba): triangles, the bounded tree, clipping and certified areas.

Plain arrays in, plain arrays out; frames, units and meaning are given by the modules of `geometry` that call them.
Compiled once per machine and kept on disk; all of them release the interpreter lock, so frames run in threads.
"""
