"""The documentation as a web site (`make docs`): pages stay plain Markdown, the rest is made while it is built."""
