"""The command line: one command, one file; reads, computes, writes, prints. Nothing else prints."""
