"""Controllers made from a model of the plant."""
