"""Effects of the mechanics: of the interface, the contact, the body, the movement."""
