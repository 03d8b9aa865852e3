"""Virtual experiments on linear and nonlinear plants: step test, ultimate cycle, relay feedback."""
