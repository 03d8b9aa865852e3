"""Bounds on the bandwidth by zeros and poles in the right half-plane."""

from __future__ import annotations

from math import sqrt


def zero_bound(z: complex) -> float:
    r"""Highest bandwidth with a zero in the right half-plane, where \|S\| is to rise from 0 to at most 2.

    .. math:: \omega_B < \tfrac12\left(\sqrt{4 x^2 + 3 y^2} - x\right), \qquad z = x \pm iy

    that is z/2 for a real zero. It follows from S(z) = 1 and the weight (s/2 + omega_B)/s.

    Parameters
    ----------
    z : complex
        Re z > 0 [rad/time].

    Returns
    -------
    float
        [rad/time]

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.7.
    """
    return 0.5 * (sqrt(4.0 * z.real**2 + 3.0 * z.imag**2) - z.real)


def pole_bound(p: complex) -> float:
    r"""Lowest bandwidth that an unstable pole asks for, where \|T\| is to stay below 2 and to fall off beyond.

    .. math:: \omega_c > \tfrac23\left(\sqrt{4 x^2 + 3 y^2} + x\right), \qquad p = x \pm iy

    that is 2p for a real pole. It follows from T(p) = 1 and the weight s/omega_c + 1/2.

    Parameters
    ----------
    p : complex
        Re p > 0 [rad/time].

    Returns
    -------
    float
        [rad/time]

    References
    ----------
    .. [1] S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005, sec. 5.9.
    """
    return (sqrt(4.0 * p.real**2 + 3.0 * p.imag**2) + p.real) * 2.0 / 3.0
