"""Shapes of the answers, for the API's description; answers themselves are encoded by hand."""
