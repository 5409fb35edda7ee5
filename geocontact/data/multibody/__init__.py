"""Bodies, joints and markers of a multibody model."""
