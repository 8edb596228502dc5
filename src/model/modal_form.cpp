#include "zwidth/model/modal_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "counted.hpp"
#include "model/device_matrices.hpp"
#include "model/exact_modal_form.hpp"
#include "model/found_poles.hpp"
#include "model/modal_forms.hpp"
#include "model/partial_fractions.hpp"
#include "model/pencil.hpp"
#include "model/pole_starts.hpp"
#include "model/poles_at_zero.hpp"
#include "zwidth/error.hpp"

namespace zwidth {

// What all paths of a device have in common, as far as it is known.
struct internal::FoundPoles {
  std::optional<std::vector<Complex<Extended>>> poles;  // those that are not 0, nor the drive's
  bool do_not_converge = false;                         // in double-double
  std::shared_ptr<ExactlyFound> exact;
};

using namespace internal;
namespace {

using ComplexD = Complex<double>;
using ComplexX = Complex<Extended>;
using partial_fractions::expand;

// Where terms exceed their sum by more than the first it is held against G itself; by more, too few digits are left.
constexpr double checked_cancellation = 1e5;
constexpr double carried_cancellation = 1e7;
// What the sum of terms may be off, near the poles and far above them.
constexpr double carried_error = 1e-12;
constexpr double carried_error_at_nyquist = 1e-9;

// Near the poles of a term.
double typical_frequency(const ModalTerm& term) {
  const auto zeros = static_cast<std::size_t>(term.integrators);
  if (zeros >= term.degree) return 0.0;
  const double product = std::abs(term.denominator[zeros]);
  const std::size_t count = term.degree - zeros;
  return count == 1 ? product : count == 2 ? std::sqrt(product) : std::pow(product, 1.0 / static_cast<double>(count));
}

// G(jw) of one term, with what rounding to double left out.
ComplexX extended_response(const ModalTerm& term, double frequency) {
  const ComplexX s(Extended(0.0), Extended(frequency));
  ComplexX numerator;
  ComplexX denominator{Extended(1.0)};
  for (std::size_t i = term.degree; i-- > 0;) {
    numerator = numerator * s;
    numerator.re += Extended(term.numerator[i]) + Extended(term.numerator_rest[i]);
    denominator = denominator * s;
    denominator.re += Extended(term.denominator[i]) + Extended(term.denominator_rest[i]);
  }
  return numerator / denominator;
}

// The sum of the terms' magnitudes over the magnitude of their sum.
double cancellation(const ModalForm& form, double frequency) {
  std::complex<double> sum = 0.0;
  double size = 0.0;
  for (const ModalTerm& term : form.terms) {
    const std::complex<double> value = response(term, frequency);
    sum += value;
    size += std::sqrt(std::norm(value));
  }
  return size / std::sqrt(std::norm(sum));
}

// Whether |G| is large enough here to matter: a stiffness is 1/|G| where it is critical, and this one is no more than
// irrelevant_below^-1 times one at another pole.
bool is_relevant(const ModalForm& form, double frequency) {
  double largest = 0.0;
  for (const ModalTerm& term : form.terms) {
    const double other = typical_frequency(term);
    if (other > 0.0) largest = std::max(largest, std::abs(response(form, other)));
  }
  return std::abs(response(form, frequency)) > irrelevant_below * largest;
}

// |sum of terms - G| / |G| in double-double.
template <typename PencilX>
double error_of_sum(const ModalForm& form, const PencilX& pencil, double frequency) {
  ComplexX error = ComplexX() - pencil.gain(ComplexX(Extended(0.0), Extended(frequency)));
  const double gain = magnitude(error);
  for (const ModalTerm& term : form.terms) error += extended_response(term, frequency);
  return magnitude(error) / gain;
}

// Whether double-double carried the poles and the terms. Where poles crowd the terms cancel near them, and what they
// lost shows; at the Nyquist frequency it shows most.
template <typename PencilX>
bool is_carried(const ModalForm& form, const PencilX& pencil, double nyquist) {
  for (const ModalTerm& term : form.terms) {
    const double frequency = typical_frequency(term);
    if (frequency == 0.0) continue;
    const double here = cancellation(form, frequency);
    if (!std::isfinite(here)) continue;  // on an undamped mode
    if (here > carried_cancellation && is_relevant(form, frequency)) return false;
    if (here <= checked_cancellation && term.degree <= 2) continue;
    if (error_of_sum(form, pencil, frequency) > carried_error) return false;
  }
  return form.terms.size() < 3 || cancellation(form, nyquist) <= checked_cancellation ||
         error_of_sum(form, pencil, nyquist) <= carried_error_at_nyquist;
}

// The modal form in double-double, or by exact arithmetic, exact(), where that does not carry.
// Poles that are found already are not sought again.
template <typename Pencil, typename PencilX, typename Exact>
ModalForm expand_poles(const Pencil& pencil, const PencilX& extended, std::vector<ComplexD> start,
                       const PoleLabels& labels, double nyquist, FoundPoles& found, const Exact& exact) {
  std::optional<ModalForm> carried;
  try {
    if (!found.poles && !found.do_not_converge) {
      found.do_not_converge = true;
      found.poles = find_poles(pencil, extended, std::move(start));
      found.do_not_converge = false;
    }
    if (found.poles) {
      const bool asks = asks_for_exact(*found.poles, labels);
      ModalForm form = expand(extended, *found.poles, labels);
      if (is_carried(form, extended, nyquist)) {
        if (!asks) return form;
        carried = std::move(form);
      }
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
  }
  try {
    return exact();
  } catch (const Error& error) {  // too many bodies, or poles
    if (error.code() != ErrorCode::did_not_converge || !carried) throw;
    return *std::move(carried);
  }
}

template <typename Real>
BodyPencil<Real> body_pencil(const Device& device, const WeightedPath& path, const DrivePath& drive) {
  DeviceMatrices<Real> matrices = device_matrices<Real>(device);
  BodyPencil<Real> pencil;
  pencil.bodies = matrices.mass.size();
  pencil.force_at = path.force_at;
  pencil.position_of = path.position_of;
  pencil.mass = std::move(matrices.mass);
  pencil.coupling = std::move(matrices.coupling);
  pencil.damping = std::move(matrices.damping);
  pencil.stiffness = std::move(matrices.stiffness);
  pencil.drive = drive;
  pencil.zero_roots = poles_at_zero(device);
  return pencil;
}

// One or two bodies as polynomials (eqs. 5-9 of Díaz & Gil): fewer operations than the matrix.
template <typename Real>
PolynomialPencil<Real> small_device_pencil(const Device& device, const WeightedPath& path, const DrivePath& drive) {
  const DeviceMatrices<Real> d = device_matrices<Real>(device);
  PolynomialPencil<Real> pencil;
  pencil.drive = drive;
  pencil.zero_roots = poles_at_zero(device);
  if (d.mass.size() == 1) {
    pencil.numerator = {Real(1.0)};
    pencil.denominator = {d.stiffness[0], d.damping[0], d.mass[0]};
  } else {
    // det [[p_11, p_12], [p_12, p_22]], p_ij = m_ij s² + b_ij s + k_ij
    const Real &b1 = d.damping[0], &b2 = d.damping[3], &b12 = d.damping[1];
    const Real &k1 = d.stiffness[0], &k2 = d.stiffness[3], &k12 = d.stiffness[1];
    const Real &m1 = d.mass[0], &m2 = d.mass[1];
    pencil.denominator = {k1 * k2 - k12 * k12, b1 * k2 + b2 * k1 - Real(2.0) * b12 * k12,
                          m1 * k2 + m2 * k1 + b1 * b2 - b12 * b12, m1 * b2 + m2 * b1, m1 * m2};
    const std::size_t force_at = path.force_at.front().of;
    if (force_at != path.position_of.front().of) {
      pencil.numerator = {Real(0.0) - k12, Real(0.0) - b12};
    } else if (force_at == 0) {
      pencil.numerator = {k2, b2, m2};
    } else {
      pencil.numerator = {k1, b1, m1};
    }
  }
  pencil.denominator.erase(pencil.denominator.begin(),
                           pencil.denominator.begin() + static_cast<std::ptrdiff_t>(pencil.zero_roots));
  return pencil;
}

// 1/(m s² + b s + k): its own modal form.
ModalForm single_body(const DeviceMatrices<double>& matrices, std::size_t zeros) {
  const double mass = matrices.mass[0];
  ModalTerm term;
  term.degree = 2;
  term.numerator[0] = 1.0 / mass;
  term.denominator[0] = matrices.stiffness[0] / mass;
  term.denominator[1] = matrices.damping[0] / mass;
  term.integrators = static_cast<int>(zeros);
  if (zeros == 0 && term.denominator[1] == 0.0) {
    term.undamped_pairs = 1;
    term.undamped_frequency = std::sqrt(term.denominator[0]);
  }
  ModalForm form;
  form.terms.push_back(term);
  if (zeros == 0) {
    const double frequency = std::sqrt(term.denominator[0]);
    form.suspended_rigid_body = Mode{frequency, term.denominator[1] / (2.0 * frequency)};
  }
  return form;
}

ModalForm expand_bodies(const Device& device, const WeightedPath& path, const DrivePath& drive, FoundPoles& found) {
  const DeviceMatrices<double> matrices = device_matrices<double>(device);
  const std::size_t zeros = poles_at_zero(device);
  const bool is_small = device.has_bodies() && matrices.mass.size() <= 2;
  if (is_small && matrices.mass.size() == 1 && drive.is_ideal()) return single_body(matrices, zeros);
  double mass = 0.0;
  double damping = device.parameters().user.damping;
  for (double m : matrices.mass) mass += m;
  for (const Body& body : device.bodies()) damping += body.damping;

  PoleLabels labels;
  labels.has_bodies = true;
  labels.has_dampers = std::ranges::any_of(matrices.damping, [](double each) { return each != 0.0; });
  labels.rigid_pole = damping / mass;
  std::vector<ComplexD> start;
  if (is_small && matrices.mass.size() == 1) {
    labels.lowest_mode_is_rigid = true;
    if (zeros == 1) start.emplace_back(-labels.rigid_pole);
    if (zeros == 0) {
      const auto [first, second] = quadratic_roots(matrices.damping[0] / mass, matrices.stiffness[0] / mass);
      start = {first, second};
    }
  } else {
    const UndampedModes modes = undamped_modes(device, matrices);
    labels.lowest_mode_is_rigid = zeros == 0 && modes.lowest_mode_is_rigid;
    labels.rigid_poles = modes.damped_free;
    if (!device.has_bodies()) labels.rigid_pole = modes.damped_free == 1 ? modes.damping[0] : 0.0;
    for (std::size_t k = 0; k < modes.stiffness.size(); ++k) {
      const auto [first, second] = quadratic_roots(modes.damping[k], modes.stiffness[k]);
      start.push_back(first);
      start.push_back(second);
    }
    // The poles at zero are known; the smallest starting values stand for them.
    std::sort(start.begin(), start.end(),
              [](const ComplexD& a, const ComplexD& b) { return magnitude(a) < magnitude(b); });
    start.erase(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(zeros));
    if (zeros == 1 && labels.rigid_pole > 0.0) start.front() = ComplexD(-labels.rigid_pole);
  }
  // A start of zero (a mode lost in rounding) would divide by zero.
  for (ComplexD& s : start) {
    if (!(magnitude(s) > 0.0)) s = ComplexD(-1e-3, 1e-3);
  }
  const double nyquist = std::numbers::pi / device.loop().sampling_period;
  const auto exact = [&] { return exact_modal_form(device, path, drive, labels, found.exact); };
  ModalForm form =
      is_small ? expand_poles(small_device_pencil<double>(device, path, drive),
                              small_device_pencil<Extended>(device, path, drive), std::move(start), labels, nyquist,
                              found, exact)
               : expand_poles(body_pencil<double>(device, path, drive), body_pencil<Extended>(device, path, drive),
                              std::move(start), labels, nyquist, found, exact);
  cancel_at_zero(form, poles_at_zero_seen(device, path));
  return form;
}

ModalForm expand_transfer_function(const Device& device) {
  const TransferFunction& transfer_function = *device.parameters().transfer_function;
  const DrivePath drive = drive_path_of(device.parameters());
  const double nyquist = std::numbers::pi / device.loop().sampling_period;
  std::vector<double> numerator(transfer_function.numerator.rbegin(), transfer_function.numerator.rend());
  std::vector<double> denominator(transfer_function.denominator.rbegin(), transfer_function.denominator.rend());
  while (numerator.size() > 1 && numerator.back() == 0.0) numerator.pop_back();
  // s cancels where both polynomials have it.
  while (numerator.size() > 1 && numerator.front() == 0.0 && denominator.front() == 0.0) {
    numerator.erase(numerator.begin());
    denominator.erase(denominator.begin());
  }
  std::size_t zeros = 0;
  while (denominator.front() == 0.0) {
    denominator.erase(denominator.begin());
    ++zeros;
  }
  PolynomialPencil<Extended> extended;
  PolynomialPencil<double> pencil;
  pencil.zero_roots = extended.zero_roots = zeros;
  pencil.drive = drive;
  extended.drive = drive;
  // Exact scaling by a power of two keeps products of extreme coefficients in range.
  int exponent = 0;
  std::frexp(denominator.back(), &exponent);
  for (double& c : numerator) c = std::ldexp(c, -exponent);
  for (double& c : denominator) c = std::ldexp(c, -exponent);
  pencil.numerator = numerator;
  pencil.denominator = denominator;
  extended.numerator.assign(numerator.begin(), numerator.end());
  extended.denominator.assign(denominator.begin(), denominator.end());
  FoundPoles found;
  const PoleLabels labels;
  return expand_poles(pencil, extended, newton_polygon_start(denominator), labels, nyquist, found,
                      [&] { return exact_modal_form(device, {}, drive, labels, found.exact); });
}

}  // namespace

ModalForm modal_form(const Device& device) {
  if (!device.is_mechanical()) return expand_transfer_function(device);
  return ModalForms(device, ActuatorLag::included).along({device.loop().actuated, device.loop().sensed});
}

ModalForm modal_form(const Device& device, Path path, ActuatorLag lag) {
  if (!device.is_mechanical()) {
    throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::no_path_of_transfer_function});
  }
  return ModalForms(device, lag).along(path);
}

internal::ModalForms::ModalForms(const Device& device, ActuatorLag parts)
    : device_(device),
      drive_(parts == ActuatorLag::included ? drive_path_of(device.parameters()) : DrivePath{}),
      found_(std::make_unique<FoundPoles>()) {}

internal::ModalForms::~ModalForms() = default;

ModalForm internal::ModalForms::along(Path path) {
  if (std::max(path.force_at, path.position_of) >= internal::points_of(device_)) {
    throw Error(ErrorCode::no_such_body,
                {.code = ProblemCode::no_body_of_path,
                 .evidence = {internal::counted("body", std::max(path.force_at, path.position_of)),
                              internal::counted("bodies", internal::points_of(device_))}});
  }
  return along(
      WeightedPath{internal::weights_of(device_, path.force_at), internal::weights_of(device_, path.position_of)});
}

ModalForm internal::ModalForms::along(const WeightedPath& path) {
  return expand_bodies(device_, path, drive_, *found_);
}

std::complex<double> response(const ModalTerm& term, double frequency) {
  if (term.degree == 2) {  // nearly all: without the loop, and without the library's division where it is safe
    const double n_real = term.numerator[0];
    const double n_imaginary = term.numerator[1] * frequency;
    const double d_real = term.denominator[0] - frequency * frequency;
    const double d_imaginary = term.denominator[1] * frequency;
    const double size = d_real * d_real + d_imaginary * d_imaginary;
    if (size > 1e-200 && size < 1e200) {
      const double scale = 1.0 / size;
      return {(n_real * d_real + n_imaginary * d_imaginary) * scale,
              (n_imaginary * d_real - n_real * d_imaginary) * scale};
    }
  }
  if (term.degree > 2) {  // crowded poles: their polynomials cancel near a resonance
    const ComplexX value = extended_response(term, frequency);
    return {leading(value.re), leading(value.im)};
  }
  const std::complex<double> s(0.0, frequency);
  std::complex<double> numerator = 0.0;
  std::complex<double> denominator = 1.0;
  for (std::size_t i = term.degree; i-- > 0;) {
    numerator = numerator * s + term.numerator[i];
    denominator = denominator * s + term.denominator[i];
  }
  return numerator / denominator;
}

std::complex<double> response(const ModalForm& form, double frequency) {
  std::complex<double> sum = 0.0;
  for (const ModalTerm& term : form.terms) sum += response(term, frequency);
  return sum;
}

}  // namespace zwidth
