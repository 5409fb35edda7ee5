"""What a system may lack: one effect, one file; each turns a system into one that has it."""
