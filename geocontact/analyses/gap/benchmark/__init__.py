"""A diagnosis of many labelled synthetic cases, scored."""
