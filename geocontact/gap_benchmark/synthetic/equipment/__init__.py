"""What a laboratory records with, and how it places things: parts of a scene that any system may have."""
