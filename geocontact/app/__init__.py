"""The window: a form in the browser for every analysis, from the one declaration of its options."""
