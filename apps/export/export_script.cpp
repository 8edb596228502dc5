#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "export/export.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

/// How a language writes what the scripts hold.
struct Notation {
  std::string_view matrix_start;
  std::string_view row_start;
  std::string_view row_end;
  std::string_view between_rows;
  std::string_view matrix_end;
};
constexpr Notation octave{"[", "", "", ";\n     ", "]"};
constexpr Notation python{"np.array([", "[", "]", ",\n     ", "])"};

std::string literal(const Eigen::MatrixXd& matrix, const Notation& notation) {
  std::string text(notation.matrix_start);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (i > 0) text += notation.between_rows;
    text += notation.row_start;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += fmt::format("{}{:.17g}", j > 0 ? ", " : "", matrix(i, j));
    text += notation.row_end;
  }
  return text += notation.matrix_end;
}

/// The sampled terms as one matrix: a row of numerator and a row of denominator coefficients per term, ascending.
Eigen::MatrixXd term_rows(const SampledPlant& plant) {
  constexpr auto width = static_cast<Eigen::Index>(ModalTerm::max_degree) + 1;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * static_cast<Eigen::Index>(plant.terms.size()), width);
  Eigen::Index row = 0;
  for (const SampledTerm& term : plant.terms) {
    for (std::size_t i = 0; i <= term.degree; ++i) rows(row, static_cast<Eigen::Index>(i)) = term.numerator[i];
    for (std::size_t i = 0; i < term.degree; ++i) rows(row + 1, static_cast<Eigen::Index>(i)) = term.denominator[i];
    rows(row + 1, static_cast<Eigen::Index>(term.degree)) = 1.0;
    row += 2;
  }
  return rows;
}

Eigen::MatrixXd crossover_rows(const CriticalStiffness& critical) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(critical.crossovers.size()), 2);
  Eigen::Index row = 0;
  for (const Crossover& crossover : critical.crossovers) {
    rows(row, 0) = crossover.frequency;
    rows(row++, 1) = crossover.stiffness;
  }
  return rows;
}

/// The filters of the wall as one matrix each, numerator over denominator, by falling powers of z.
std::string filter_list(const Wall& wall, double period, const Notation& notation, std::string_view start,
                        std::string_view end) {
  std::string text(start);
  for (const WallFilter& filter : wall.filters) {
    const FilterCoefficients z = in_z(filter_section(filter, period));
    Eigen::MatrixXd rows(2, static_cast<Eigen::Index>(z.denominator.size()));
    rows.row(0) = Eigen::Map<const Eigen::RowVectorXd>(z.numerator.data(), rows.cols());
    rows.row(1) = Eigen::Map<const Eigen::RowVectorXd>(z.denominator.data(), rows.cols());
    text += (&filter == &wall.filters.front() ? "" : ", ") + literal(rows, notation);
  }
  return text += end;
}

/// A name as a comment or string of one line: control characters become spaces.
std::string one_line(std::string name) {
  for (char& character : name) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7f) character = ' ';
  }
  return name;
}

std::string octave_string(const std::string& text) {
  std::string quoted = "'";
  for (const char character : one_line(text)) quoted += character == '\'' ? "''" : std::string(1, character);
  return quoted + "'";
}

/// JSON's escapes are Python's.
std::string python_string(const std::string& text) { return nlohmann::json(one_line(text)).dump(); }

// The data of each script, filled in by name, and its program, as it is.
constexpr std::string_view octave_data = R"(% {comment}
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
% x[k+1] = F x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C x[k]. Phi = F - I keeps the digits of F.
model.T = {T:.17g};
model.delay_samples = {l};
model.Phi = {Phi};
model.Gamma1 = {Gamma1};
model.Gamma2 = {Gamma2};

% The same as a sum of modal terms in d = z - 1, ascending: rows of numerator, denominator, numerator, ...
% The delay is split so that z^-m stands outside the sum, m samples.
model.terms = {terms};
model.terms_delay_samples = {m};

% Phase crossovers: frequency in rad/s, stiffness of the wall K (with the virtual damper and the filters below closed)
crossovers = {crossovers};

% The wall: u = -C(z) y, C(z) = F(z) (K + B v(z)), v(z) = (1 - a)/T (z - 1)/(z - a), F the product of the filters:
% numerator over denominator, falling powers of z
wall.stiffness = {K};  % K{missing}
wall.damping = {damping:.17g};  % B
wall.a = {a:.17g};
wall.filters = {filters};
)";

constexpr std::string_view octave_body = R"(
% The discrete system with the delayed forces as states
n = rows(A);
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
sysd = ss(F, G, [C, zeros(1, delays)], 0, model.T);

% Response of the sampled device at frequencies w in rad/s, 0 < w <= pi/T. Works with z - 1, which keeps the digits
% that z itself loses at low frequency.
function response = sampled_response(model, w)
  d = expm1(1i * w * model.T);
  response = zeros(size(w));
  for k = 1:2:rows(model.terms)
    response += polyval(fliplr(model.terms(k, :)), d) ./ polyval(fliplr(model.terms(k + 1, :)), d);
  end
  response .*= exp(-1i * w * model.T * model.terms_delay_samples);
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

constexpr std::string_view python_data = R"(# {comment}
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
# x[k+1] = F x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C x[k]. Phi = F - I keeps the digits of F.
T = {T:.17g}
delay_samples = {l}
Phi = {Phi}
Gamma1 = {Gamma1}
Gamma2 = {Gamma2}

# The same as a sum of modal terms in d = z - 1, ascending: rows of numerator, denominator, numerator, ...
# The delay is split so that z^-m stands outside the sum, m samples.
terms = {terms}
terms_delay_samples = {m}

# Phase crossovers: frequency in rad/s, stiffness of the wall K (with the virtual damper and the filters below closed)
crossovers = {crossovers}.reshape(-1, 2)

# The wall: u = -C(z) y, C(z) = F(z) (K + B v(z)), v(z) = (1 - a)/T (z - 1)/(z - a), F the product of the filters:
# numerator over denominator, falling powers of z
wall_stiffness = {K}  # K{missing}
wall_damping = {damping:.17g}  # B
wall_a = {a:.17g}
wall_filters = {filters}
)";

constexpr std::string_view python_body = R"(

def with_delay_states():
    """The discrete system with the delayed forces as states."""
    n = len(A)
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
    return signal.dlti(F, G, np.hstack([C, np.zeros((1, delays))]), np.zeros((1, 1)), dt=T)


sysd = with_delay_states()


def sampled_response(w):
    """Response of the sampled device at frequencies w in rad/s, 0 < w <= pi/T.

    Works with z - 1, which keeps the digits that z itself loses at low frequency.
    """
    w = np.asarray(w, dtype=float)
    d = np.expm1(1j * w * T)
    polynomial = np.polynomial.polynomial.polyval
    total = sum(polynomial(d, terms[k]) / polynomial(d, terms[k + 1]) for k in range(0, len(terms), 2))
    return total * np.exp(-1j * w * T * terms_delay_samples)


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

/// What a language calls things.
struct Words {
  std::string_view missing;
  std::string_view list_start;
  std::string_view list_end;
};

/// Behind the device's name in the first comment.
std::string doubt_of(const DeviceModel& model) {
  const auto note = trust_note(model.analysis.trust);
  return note ? ". " + *note : std::string();
}

std::string filled_in(std::string_view data, const DeviceModel& model, const Notation& notation, const Words& words,
                      const std::string& name) {
  const Wall& wall = model.device.parameters().wall;
  const Device& device = model.device;
  const DiscreteStateSpace& discrete = model.discrete;
  const auto matrix = [&](const Eigen::MatrixXd& values) { return literal(values, notation); };
  return fmt::format(
      fmt::runtime(data), fmt::arg("comment", one_line(device.name() + doubt_of(model))),
      fmt::arg("version", ZWIDTH_VERSION), fmt::arg("device", name), fmt::arg("A", matrix(model.continuous.A)),
      fmt::arg("B", matrix(model.continuous.B)), fmt::arg("C", matrix(model.continuous.C)),
      fmt::arg("T", discrete.period), fmt::arg("delay", device.loop().delay), fmt::arg("l", discrete.delay_samples),
      fmt::arg("Phi", matrix(discrete.Phi)), fmt::arg("Gamma1", matrix(discrete.Gamma1)),
      fmt::arg("Gamma2", matrix(discrete.Gamma2)), fmt::arg("terms", matrix(term_rows(model.sampled))),
      fmt::arg("m", model.sampled.delay_samples), fmt::arg("damping", wall.damping),
      fmt::arg("K", wall.stiffness ? fmt::format("{:.17g}", *wall.stiffness) : std::string(words.missing)),
      fmt::arg("missing", wall.stiffness ? "" : ", not given"),
      fmt::arg("a", velocity_filter_pole(wall.velocity_filter_hz, discrete.period)),
      fmt::arg("filters", filter_list(wall, discrete.period, notation, words.list_start, words.list_end)),
      fmt::arg("crossovers", matrix(crossover_rows(model.analysis.critical))));
}

}  // namespace

std::string export_octave(const DeviceModel& model) {
  return filled_in(octave_data, model, octave, {"[]", "{", "}"}, octave_string(model.device.name())) +
         std::string(octave_body);
}

std::string export_python(const DeviceModel& model) {
  return filled_in(python_data, model, python, {"None", "[", "]"}, python_string(model.device.name())) +
         std::string(python_body);
}

}  // namespace zwidth::report
