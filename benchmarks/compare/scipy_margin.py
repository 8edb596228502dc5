"""The gain margin as NumPy and SciPy users get it, by the method of python-control's default.

cont2discrete to a transfer function in z; the phase crossings are the roots on the unit circle of
num(z) den(1/z) - num(1/z) den(z), found by numpy.roots and kept within a tolerance of |z| = 1; the least gain counts.
"""

import numpy as np
from scipy.signal import cont2discrete


def gain_margin(numerator, denominator, period):
    num, den, _ = cont2discrete((numerator, denominator), period, method="zoh")
    num = np.trim_zeros(num[0], "f")
    shift = len(den) - len(num)
    forward = np.polymul(num, den[::-1])
    backward = np.polymul(np.polymul(num[::-1], den), [1.0] + [0.0] * shift)
    z = np.roots(np.polysub(forward, backward))
    tolerance = np.finfo(float).eps ** (1 / len(backward))
    z = z[(np.abs(np.abs(z) - 1) < tolerance) & (np.angle(z) >= 0)]
    z = z[np.angle(z) / period >= 1e-8]
    response = np.polyval(num, z) / np.polyval(den, z)
    negative = np.real(response) < 0
    return np.min(1 / np.abs(response[negative])) if np.any(negative) else np.inf
