"""The self-contained page: what it says (`content`), how numbers are packed (`pack`), how it is written (`write`)."""
