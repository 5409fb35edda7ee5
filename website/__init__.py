"""The documentation as a web site: `make docs`. Pages stay plain Markdown; what is added here is made while it is built."""
