"""Input files of finite-element programs: FEBio and Abaqus."""
