"""The true critical stiffness of a two-mass device, with 80 digits and no code in common with the peers."""

from mpmath import mp, mpf

from two_mass import SAMPLING_PERIOD

mp.dps = 80


def sampled(device):
    """N(z) and D(z), descending, of the zero-order-hold equivalent, from the residues at the four poles."""
    numerator, denominator = ([mpf(c) for c in side] for side in device.transfer_function())
    period = mpf(SAMPLING_PERIOD)
    poles = [mpf(0)] + mp.polyroots(denominator[:-1], maxsteps=500, extraprec=500)
    slope = [c * (len(denominator) - 1 - i) for i, c in enumerate(denominator[:-1])]
    gains, z_poles = [], []
    for pole in poles:
        residue = mp.polyval(numerator, pole) / mp.polyval(slope, pole)
        gains.append(residue * (period if pole == 0 else mp.expm1(pole * period) / pole))
        z_poles.append(mp.exp(pole * period))
    n = [mpf(0)] * len(poles)
    for i, gain in enumerate(gains):
        others = expand(z for j, z in enumerate(z_poles) if j != i)
        n = [a + gain * b for a, b in zip(n, others)]
    return [mp.re(c) for c in n], [mp.re(c) for c in expand(z_poles)]


def expand(roots):
    """Coefficients, descending, of the monic polynomial with these roots."""
    polynomial = [mpf(1)]
    for root in roots:
        polynomial = [a - root * b for a, b in zip(polynomial + [mpf(0)], [mpf(0)] + polynomial)]
    return polynomial


def crossovers(n, d):
    """Every K > 0 with D + K N = 0 somewhere on the unit circle.

    Im N(z) D(1/z) = sum_k c_k sin(k t) = sin(t) sum_k c_k U_{k-1}(cos t), U the Chebyshev polynomials of the second
    kind: a polynomial in cos t, all of whose roots are taken. sin(t) = 0 adds Nyquist, t = pi.
    """
    degree = len(d) - 1
    n_up, d_up = [mpf(0)] * (degree + 1 - len(n)) + n, d
    n_up, d_up = n_up[::-1], d_up[::-1]
    chebyshev = [[mpf(1)], [mpf(2), mpf(0)]]
    while len(chebyshev) < degree:
        twice = [2 * c for c in chebyshev[-1]] + [mpf(0)]
        chebyshev.append([a - b for a, b in zip(twice, [mpf(0), mpf(0)] + chebyshev[-2])])
    phase = [mpf(0)] * degree
    for a in range(degree + 1):
        for b in range(degree + 1):
            if a != b:
                u = chebyshev[abs(a - b) - 1]
                sign = 1 if a > b else -1
                for i, c in enumerate(u):
                    phase[degree - len(u) + i] += sign * n_up[a] * d_up[b] * c
    cosines = [mpf(-1)]
    for root in mp.polyroots(phase, maxsteps=500, extraprec=500):
        if abs(mp.im(root)) < mpf(10) ** -40 and abs(mp.re(root)) < 1:
            cosines.append(mp.re(root))
    stiffnesses = []
    for cosine in cosines:
        z = mp.mpc(cosine, mp.sqrt(1 - cosine**2))
        stiffness = -mp.re(mp.polyval(d, z) / mp.polyval(n, z))
        if stiffness > 0:
            stiffnesses.append(stiffness)
    return sorted(stiffnesses)


def is_stable(n, d, stiffness):
    """Whether all roots of D + K N lie inside the unit circle."""
    polynomial = [a + stiffness * b for a, b in zip(d, [mpf(0)] * (len(d) - len(n)) + n)]
    return all(abs(z) < 1 for z in mp.polyroots(polynomial, maxsteps=500, extraprec=500))


def critical_stiffness(device):
    """Upper end of the first stable interval: the closed loop is tried between every two crossovers."""
    n, d = sampled(device)
    below = mpf(0)
    for stiffness in crossovers(n, d) + [None]:
        inside = 2 * below + 1 if stiffness is None else (below + stiffness) / 2
        if not is_stable(n, d, inside):
            return float(below)
        below = stiffness
    return float("inf")
