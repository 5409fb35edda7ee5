"""The sole's numbers from one recorded stance, and what that stance can tell of them."""
