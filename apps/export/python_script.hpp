#pragma once

#include <string_view>

namespace zwidth::report {

// The data of the script, filled in by name, and its program, as it is.
inline constexpr std::string_view python_data = R"(# {comment}
# Continuous and exact discrete model, written by zwidth {version}. Run: python3 THIS_FILE, or import it.
import numpy as np
from scipy import signal

device = {device}

# x' = A x + B u, y = C x: force in, position out, SI units
A = {A}
B = {B}
C = {C}
sysc = signal.StateSpace(A, B, C, np.zeros((1, 1)))

# Exact sampling behind a zero-order hold, period T, with the delay of {delay:.17g} s split into whole samples l and a rest:
# x[k+1] = F x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C_sampled x[k]. Phi = F - I keeps the digits of F.
T = {T:.17g}
delay_samples = {l}
Phi = {Phi}
Gamma1 = {Gamma1}
Gamma2 = {Gamma2}
C_sampled = {Cd}

# The same as a sum of modal terms in d = z - 1, ascending: rows of numerator, denominator, numerator, ...
# The delay is split so that z^-m stands outside the sum, m samples.
terms = {terms}
terms_delay_samples = {m}
# What rounding left out of the terms; the numerator of their sum over all denominators, where the terms nearly cancel, and
# its rests; the response at pi/T, where only that keeps digits.
terms_rest = {terms_rest}
sum_numerator = {sum}.ravel()
sum_rest = {sum_rest}.ravel()
at_nyquist = {at_nyquist}

# Phase crossovers: frequency in rad/s, stiffness of the wall K (with the virtual damper and the filters below closed)
crossovers = {crossovers}.reshape(-1, 2)

# The wall: u = -C(z) y, C(z) = F(z) (K + B v(z)), v(z) = (1 - a)/T (z - 1)/(z - a), F the product of the filters:
# numerator over denominator, falling powers of z
wall_stiffness = {K}  # K{missing}
wall_damping = {damping:.17g}  # B
wall_a = {a:.17g}
wall_filters = {filters}
)";

inline constexpr std::string_view python_body = R"(

def with_delay_states():
    """The discrete system with the delayed forces as states."""
    n = len(Phi)
    delays = delay_samples + int(np.any(Gamma2))
    inputs = np.zeros((n, delays + 1))  # columns: u[k], u[k-1], ...
    inputs[:, [delay_samples]] = Gamma1
    if delays > delay_samples:
        inputs[:, [delays]] = Gamma2
    F = np.zeros((n + delays, n + delays))
    G = np.zeros((n + delays, 1))
    F[:n, :n] = np.eye(n) + Phi
    G[:n, 0] = inputs[:, 0]
    if delays > 0:
        F[:n, n:] = inputs[:, 1:]
        G[n, 0] = 1.0
        F[n + 1:, n:-1] = np.eye(delays - 1)
    return signal.dlti(F, G, np.hstack([C_sampled, np.zeros((1, delays))]), np.zeros((1, 1)), dt=T)


sysd = with_delay_states()


def _sum(a, b):
    """Two doubles with their rests, (high, low): 32 digits (Dekker 1971)."""
    s = a[0] + b[0]
    t = s - a[0]
    e = (a[0] - (s - t)) + (b[0] - t) + a[1] + b[1]
    high = s + e
    return high, e - (high - s)


def _product(a, x):
    """The same times a double."""
    def half(y):
        return 134217729.0 * y - (134217729.0 * y - y)

    p = a[0] * x
    a1, x1 = half(a[0]), half(x)
    a2, x2 = a[0] - a1, x - x1
    e = ((a1 * x1 - p) + a1 * x2 + a2 * x1) + a2 * x2 + a[1] * x
    high = p + e
    return high, e - (high - p)


def _polynomial(d, c, rest):
    """A polynomial of ascending coefficients and their rests at complex d, added up in such pairs."""
    x, y = d.real, d.imag
    re = im = (np.zeros_like(x), np.zeros_like(x))
    for high, low in zip(c[::-1], rest[::-1]):
        re, im = (_sum(_sum(_product(re, x), _product(im, -y)), (high, low)),
                  _sum(_product(re, y), _product(im, x)))
    return re[0] + 1j * im[0]


def sampled_response(w):
    """Response of the sampled device at frequencies w in rad/s, 0 < w <= pi/T.

    Works with z - 1, which keeps the digits that z itself loses at low frequency.
    """
    w = np.asarray(w, dtype=float)
    d = np.expm1(1j * w * T)
    numerators = [_polynomial(d, terms[k], terms_rest[k]) for k in range(0, len(terms), 2)]
    denominators = [_polynomial(d, terms[k], terms_rest[k]) for k in range(1, len(terms), 2)]
    if sum_numerator.size == 0:
        total = sum(n / m for n, m in zip(numerators, denominators))
    else:  # the terms nearly cancel
        total = _polynomial(d, sum_numerator, sum_rest)
        for m in denominators:
            total = total / m
    total = total * np.exp(-1j * w * T * terms_delay_samples)
    return total if at_nyquist is None else np.where(w * T >= np.pi, at_nyquist, total)[()]


def wall_controller(stiffness):
    """The wall C(z) as A, B, C, D: position in, the force that pushes back out."""
    rate = wall_damping * (1.0 - wall_a) / T
    sections = list(wall_filters)
    A, B, C, D = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), stiffness
    if wall_damping > 0.0:
        D = 1.0
        sections.insert(0, np.array([[stiffness + rate, -(stiffness * wall_a + rate)], [1.0, -wall_a]]))
    for b, a in sections:
        n = len(a) - 1
        As = np.vstack([-a[1:], np.eye(n)[:-1]])
        Bs = np.eye(n, 1)
        Cs = (b[1:] - b[0] * a[1:]).reshape(1, n)
        A = np.block([[A, np.zeros((len(A), n))], [Bs @ C, As]])
        B = np.vstack([B, Bs * D])
        C = np.hstack([b[0] * C, Cs])
        D = b[0] * D
    return A, B, C, D


def closed_loop_poles(stiffness):
    """Poles z of the device with the wall closed at this stiffness, its damper and filters with it."""
    A, B, C, D = wall_controller(stiffness)
    F, G, H = sysd.A, sysd.B, sysd.C
    return np.linalg.eigvals(np.block([[F - G @ H * D, -G @ C], [B @ H, A]]))


if __name__ == "__main__":
    print(device)
    print(f"{'frequency (rad/s)':>20} {'response, real':>25} {'imaginary':>25} {'K (N per unit)':>22}")
    for w, stiffness in crossovers:
        p = sampled_response(w)
        print(f"{w:20.12g} {p.real:25.16e} {p.imag:25.16e} {stiffness:22.15g}")
    if len(crossovers) == 0:
        for w in np.geomspace(1.0, np.pi / T, 10):
            p = sampled_response(w)
            print(f"{w:20.12g} {p.real:25.16e} {p.imag:25.16e}")
)";

}  // namespace zwidth::report
