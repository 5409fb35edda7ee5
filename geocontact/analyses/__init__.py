"""Every job from files to results: one folder an analysis, called alike from Python and from the command line."""
