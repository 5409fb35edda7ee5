"""Areas, distances and fits beside closed forms and other libraries."""
