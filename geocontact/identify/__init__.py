"""Numbers from data: fits over trials, noise that has a memory, what the data tell apart."""
