"""How slow a model is, for a first choice of a time axis."""

from __future__ import annotations

import numpy as np

from looplab.engine.errors import NonFinite
from looplab.engine.nonlinear.model import CompiledModel

# An eigenvalue this much smaller than the largest is the rounding of an integrator.
_INTEGRATOR = 1e-9


def slowest_time_constant(model: CompiledModel) -> float | None:
    r"""The slowest time constant of a model about its own initial state.

    .. math::

        \tau = \max_{\lambda_i \ne 0} \frac{1}{|\lambda_i|}, \quad
        \lambda_i \text{ the eigenvalues of } \partial f/\partial x

    Parameters
    ----------
    model : CompiledModel

    Returns
    -------
    float or None
        [time]; None where the model only integrates, or cannot be computed there.

    References
    ----------
    .. [1] T. Glad and L. Ljung, Control Theory: Multivariable and Nonlinear Methods, Taylor & Francis, 2000, chapter 2.
    """
    try:
        a = model.state_jacobian(0.0, model.x0, model.u0, model.p0)
    except NonFinite:
        return None
    sizes = np.abs(np.linalg.eigvals(a))
    moving = sizes[sizes > _INTEGRATOR * sizes.max()]
    return float(1.0 / moving.min()) if moving.size else None
