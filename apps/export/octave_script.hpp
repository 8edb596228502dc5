#pragma once

#include <string_view>

namespace zwidth::report {

// The data of the script, filled in by name, and its program, as it is.
inline constexpr std::string_view octave_data = R"(% {comment}
% Continuous and exact discrete model, written by zwidth {version}. Run: octave-cli THIS_FILE
1;  % marks a script file
pkg load control

device = {device};

% x' = A x + B u, y = C x: force in, position out, SI units
A = {A};
B = {B};
C = {C};
sysc = ss(A, B, C, 0);

% Exact sampling behind a zero-order hold, period T, with the delay of {delay:.17g} s split into whole samples l and a rest:
% x[k+1] = F x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C x[k], C that of the model. Phi = F - I keeps the digits of F.
model.T = {T:.17g};
model.delay_samples = {l};
model.Phi = {Phi};
model.Gamma1 = {Gamma1};
model.Gamma2 = {Gamma2};
model.C = {Cd};

% The same as a sum of modal terms in d = z - 1, ascending: rows of numerator, denominator, numerator, ...
% The delay is split so that z^-m stands outside the sum, m samples.
model.terms = {terms};
model.terms_delay_samples = {m};
% What rounding left out of the terms; the numerator of their sum over all denominators, where the terms nearly cancel, and
% its rests; the response at pi/T, where only that keeps digits.
model.terms_rest = {terms_rest};
model.sum = {sum};
model.sum_rest = {sum_rest};
model.at_nyquist = {at_nyquist};

% Phase crossovers: frequency in rad/s, stiffness of the wall K (with the virtual damper and the filters below closed)
crossovers = {crossovers};

% The wall: u = -C(z) y, C(z) = F(z) (K + B v(z)), v(z) = (1 - a)/T (z - 1)/(z - a), F the product of the filters:
% numerator over denominator, falling powers of z
wall.stiffness = {K};  % K{missing}
wall.damping = {damping:.17g};  % B
wall.a = {a:.17g};
wall.filters = {filters};
)";

inline constexpr std::string_view octave_body = R"(
% The discrete system with the delayed forces as states
n = rows(model.Phi);
delays = model.delay_samples + any(model.Gamma2 != 0);
F = blkdiag(eye(n) + model.Phi, zeros(delays));
G = zeros(n + delays, 1);
inputs = zeros(n, delays + 1);  % columns: u[k], u[k-1], ...
inputs(:, model.delay_samples + 1) = model.Gamma1;
if (delays > model.delay_samples)
  inputs(:, delays + 1) = model.Gamma2;
end
G(1:n) = inputs(:, 1);
if (delays > 0)
  F(1:n, n+1:end) = inputs(:, 2:end);
  G(n + 1) = 1;
  F(n+2:end, n+1:end-1) = eye(delays - 1);
end
sysd = ss(F, G, [model.C, zeros(1, delays)], 0, model.T);

% A double and its rest, [high; low], times a double, and plus another: 32 digits (Dekker 1971)
function [high, low] = sum_of(a, a_low, b, b_low)
  s = a + b;
  t = s - a;
  e = (a - (s - t)) + (b - t) + a_low + b_low;
  high = s + e;
  low = e - (high - s);
end
function [high, low] = product_of(a, a_low, x)
  half = @(y) 134217729 * y - (134217729 * y - y);
  p = a .* x;
  a1 = half(a);
  x1 = half(x);
  a2 = a - a1;
  x2 = x - x1;
  e = ((a1 .* x1 - p) + a1 .* x2 + a2 .* x1) + a2 .* x2 + a_low .* x;
  high = p + e;
  low = e - (high - p);
end

% A polynomial of ascending coefficients and their rests at complex d, in such pairs
function value = precise_polynomial(c, rest, d)
  x = real(d);
  y = imag(d);
  re = zeros(size(d)); re_low = re; im = re; im_low = re;
  for k = numel(c):-1:1
    [a, a_low] = product_of(re, re_low, x);
    [b, b_low] = product_of(im, im_low, -y);
    [e, e_low] = product_of(re, re_low, y);
    [f, f_low] = product_of(im, im_low, x);
    [re, re_low] = sum_of(a, a_low, b, b_low);
    [re, re_low] = sum_of(re, re_low, c(k) * ones(size(d)), rest(k));
    [im, im_low] = sum_of(e, e_low, f, f_low);
  end
  value = complex(re, im);
end

% Response of the sampled device at frequencies w in rad/s, 0 < w <= pi/T. Works with z - 1, which keeps the digits
% that z itself loses at low frequency.
function response = sampled_response(model, w)
  d = expm1(1i * w * model.T);
  response = zeros(size(w));
  if (isempty(model.sum))
    for k = 1:2:rows(model.terms)
      response += precise_polynomial(model.terms(k, :), model.terms_rest(k, :), d) ./ ...
                  precise_polynomial(model.terms(k + 1, :), model.terms_rest(k + 1, :), d);
    end
  else
    response = precise_polynomial(model.sum, model.sum_rest, d);
    for k = 2:2:rows(model.terms)
      response ./= precise_polynomial(model.terms(k, :), model.terms_rest(k, :), d);
    end
  end
  response .*= exp(-1i * w * model.T * model.terms_delay_samples);
  if (! isempty(model.at_nyquist))
    response(w * model.T >= pi) = model.at_nyquist;
  end
end

% The wall C(z) as a state space, position in and the force that pushes back out
function [A, B, C, D] = wall_controller(wall, T, stiffness)
  rate = wall.damping * (1 - wall.a) / T;
  sections = wall.filters;
  A = zeros(0, 0); B = zeros(0, 1); C = zeros(1, 0); D = stiffness;
  if (wall.damping > 0)
    D = 1;
    sections = [{[stiffness + rate, -(stiffness * wall.a + rate); 1, -wall.a]}, sections];
  end
  for k = 1:numel(sections)
    b = sections{k}(1, :);
    a = sections{k}(2, :);
    n = numel(a) - 1;
    As = [-a(2:end); eye(n - 1, n)];
    Bs = eye(n, 1);
    Cs = b(2:end) - b(1) * a(2:end);
    A = [A, zeros(rows(A), n); Bs * C, As];
    B = [B; Bs * D];
    C = [b(1) * C, Cs];
    D = b(1) * D;
  end
end

% Poles z of the device with the wall closed at this stiffness, its damper and filters with it
function poles = closed_loop_poles(sysd, wall, stiffness)
  [F, G, H] = ssdata(sysd);
  [A, B, C, D] = wall_controller(wall, sysd.tsam, stiffness);
  poles = eig([F - G * D * H, -G * C; B * H, A]);
end

printf('%s\n', device);
printf('%20s %25s %25s %22s\n', 'frequency (rad/s)', 'response, real', 'imaginary', 'K (N per unit)');
if (rows(crossovers) > 0)
  frequencies = crossovers(:, 1)';
else
  frequencies = logspace(0, log10(pi / model.T), 10);
end
for w = frequencies
  p = sampled_response(model, w);
  printf('%20.12g %25.16e %25.16e', w, real(p), imag(p));
  if (rows(crossovers) > 0)
    printf(' %22.15g', crossovers(crossovers(:, 1) == w, 2)(1));
  end
  printf('\n');
end
)";

}  // namespace zwidth::report
