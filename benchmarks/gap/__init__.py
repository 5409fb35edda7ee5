"""The diagnosis of the gap."""
