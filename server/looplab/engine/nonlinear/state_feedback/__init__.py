"""A nonlinear model under the state feedback that was designed on its linear model."""
