"""The experiment that would separate the competing models best."""
