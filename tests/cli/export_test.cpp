#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using Complex = std::complex<double>;

constexpr int count = 60;
constexpr double tolerance = 1e-9;

struct Case {
  std::string name;
  std::string text;
};

void PrintTo(const Case& each, std::ostream* stream) { *stream << each.name; }

constexpr std::string_view lhifam = R"(name = "LHIfAM 'quoted' \"%s\" µ"
[[body]]
name = "motor"
mass = 0.3
damping = 0.1
[[body]]
name = "handle"
mass = 5.1
damping = 3.4
[[link]]
between = ["motor", "handle"]
stiffness = 79.5e3
damping = 15.0
[loop]
sampling_period = 1e-3
)";

std::vector<Case> cases() {
  const std::string flexible(lhifam);
  return {{"lhifam", flexible},
          {"whole_delay", flexible + "delay = 3e-3\n"},
          {"fractional_delay", flexible + "delay = 2.25e-3\n"},
          {"lag", flexible + "delay = 0.4e-3\n[actuator]\ntime_constant = 2e-3\n"},
          {"damper", flexible + "[wall]\ndamping = 5.0\nvelocity_filter_hz = 50.0\n"},
          {"filters", flexible + R"(delay = 1.3e-3
[wall]
stiffness = 1000.0
damping = 5.0
velocity_filter_hz = 50.0
[[wall.filter]]
type = "notch"
frequency_hz = 83.0
[[wall.filter]]
type = "low_pass"
frequency_hz = 200.0
[[wall.filter]]
type = "digital"
numerator = [0.5, 0.5]
denominator = [1.0, 0.0]
)"},
          {"one_filter", flexible + "[[wall.filter]]\ntype = \"lead_lag\"\nfrequency_hz = 20\nratio = 3\n"},
          {"three_masses", R"(name = "three"
motion = "rotary"
[[body]]
name = "a"
inertia = 1e-4
damping = 1e-3
[[body]]
name = "b"
inertia = 3e-4
[[body]]
name = "c"
inertia = 2e-3
damping = 2e-3
stiffness = 0.1
[[link]]
between = ["a", "b"]
stiffness = 40.0
damping = 1e-3
[[link]]
between = ["b", "c"]
stiffness = 90.0
damping = 2e-3
[loop]
sensed = "c"
sampling_period = 0.5e-3
)"},
          {"transfer_function", R"(name = "transfer function"
[transfer_function]
numerator = [2.0, 300.0]
denominator = [1.0, 40.0, 9e4, 1e5]
[loop]
sampling_period = 1e-3
delay = 0.7e-3
)"}};
}

/// Sensed across four links: far above the modes the terms cancel to their 14th digit.
Case far_sensed() {
  return {"five_masses", R"(name = "five"
[[body]]
name = "a"
mass = 0.3
damping = 0.1
[[body]]
name = "b"
mass = 0.9
[[body]]
name = "c"
mass = 1.7
damping = 0.4
[[body]]
name = "d"
mass = 0.6
[[body]]
name = "e"
mass = 2.1
damping = 0.2
[[link]]
between = ["a", "b"]
stiffness = 2e3
damping = 0.3
[[link]]
between = ["b", "c"]
stiffness = 1e3
damping = 0.1
[[link]]
between = ["c", "d"]
stiffness = 4e3
damping = 0.2
[[link]]
between = ["d", "e"]
stiffness = 900.0
damping = 0.1
[loop]
sensed = "e"
sampling_period = 0.1e-3
)"};
}

class Export : public Workspace, public ::testing::WithParamInterface<Case> {
 protected:
  Export() : device_(*parse_device(GetParam().text, "test")), plant_(sampled_plant(device_)) {
    write("device.toml", GetParam().text);
    std::string lines;
    const double nyquist = std::numbers::pi / plant_.period;
    for (int i = 0; i < count; ++i) {
      // pow() may round past pi/T, which is the last allowed.
      frequencies_.push_back(std::min(nyquist, std::pow(nyquist, static_cast<double>(i) / (count - 1))));
      lines += fmt::format("{:.17g}\n", frequencies_.back());
    }
    write("frequencies.txt", lines);
  }

  /// Every line "real imaginary" of `output` against the library's response at that frequency.
  void expect_our_response(const std::string& output) const {
    std::istringstream lines(output);
    for (const double frequency : frequencies_) {
      double real = 0.0;
      double imaginary = 0.0;
      ASSERT_TRUE(lines >> real >> imaginary) << output;
      const Complex ours = response(plant_, frequency);
      EXPECT_LE(std::abs(Complex(real, imaginary) - ours), tolerance * std::abs(ours)) << frequency << " rad/s";
    }
  }

  void expect_octave_has_our_response() {
    write("check.m", R"octave(1;
evalc("source('device.m')");
w = load('frequencies.txt')';
p = sampled_response(model, w);
printf('%.17g %.17g\n', [real(p); imag(p)]);
)octave");
    const Outcome outcome = run(
        "zwidth export device.toml --format octave --output device.m && /usr/bin/octave-cli device.m > table.txt && "
        "/usr/bin/octave-cli check.m");
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    expect_our_response(outcome.output);
  }

  void expect_python_has_our_response() {
    write("check.py", R"(import numpy as np
import device
w = np.loadtxt('frequencies.txt')
for p in device.sampled_response(w):
    print('%.17g %.17g' % (p.real, p.imag))
)");
    const Outcome outcome =
        run("zwidth export device.toml --format python --output device.py && /usr/bin/python3 device.py > table.txt && "
            "/usr/bin/python3 check.py");
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    expect_our_response(outcome.output);
  }

  Device device_;
  SampledPlant plant_;
  std::vector<double> frequencies_;
};

TEST_P(Export, RunsInOctaveWithOurResponse) { expect_octave_has_our_response(); }

TEST_P(Export, OctaveSystemsAreTheModel) {
  // sysc by its own frequency response, and sysd by its own: general-purpose code loses digits at low frequency.
  write("check.m", R"octave(1;
evalc("source('device.m')");
w = load('frequencies.txt')';
w = w(w > 20);
p = sampled_response(model, w);
q = squeeze(freqresp(sysd, w)).';
printf('%d %.3g\n', isa(sysc, 'ss') && isa(sysd, 'ss') && isct(sysc) && isdt(sysd), max(abs(p - q) ./ abs(p)));
)octave");
  const Outcome outcome = run("zwidth export device.toml --format octave > device.m && /usr/bin/octave-cli check.m");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::istringstream fields(outcome.output);
  int are_systems = 0;
  double error = 1.0;
  fields >> are_systems >> error;
  EXPECT_EQ(are_systems, 1);
  EXPECT_LT(error, 1e-7);
}

TEST_P(Export, RunsInPythonWithOurResponse) { expect_python_has_our_response(); }

TEST_P(Export, ScipySystemsAreTheModel) {
  write("check.py", R"(import numpy as np
from scipy import signal
import device
assert isinstance(device.sysc, signal.StateSpace) and isinstance(device.sysd, signal.dlti)
assert device.sysd.dt == device.T
w = np.loadtxt('frequencies.txt')
w = w[w > 20]
s = device.sysd
q = np.array([(s.C @ np.linalg.solve(np.exp(1j * x * device.T) * np.eye(len(s.A)) - s.A, s.B))[0, 0] for x in w])
p = device.sampled_response(w)
print(np.max(abs(p - q) / abs(p)))
)");
  const Outcome outcome = run("zwidth export device.toml --format python > device.py && /usr/bin/python3 check.py");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_LT(std::stod(outcome.output), 1e-7) << outcome.output;
}

TEST_P(Export, JsonHoldsOurResponse) {
  write("check.py", R"(import json
import numpy as np
model = json.load(open('device.json'))
T = model['sampling_period_s']
d = model['discrete']
phi, g1, g2, c = (np.array(d[key]) for key in ('Phi', 'Gamma1', 'Gamma2', 'C'))
assert np.allclose(np.array(d['F']), np.eye(len(phi)) + phi)
whole = model['with_delay_states']
for w in np.loadtxt('frequencies.txt'):
    delta = np.expm1(1j * w * T)
    z = np.exp(1j * w * T)
    outside = z ** -model['sampled_terms']['delay_samples']
    terms = [np.polynomial.polynomial.polyval(delta, t['numerator']) /
             np.polynomial.polynomial.polyval(delta, t['denominator']) for t in model['sampled_terms']['terms']]
    p = sum(terms) * outside
    # The matrices lose what the terms cancel: their error is small beside the terms, not beside the sum.
    scale = sum(map(abs, terms))
    q = (c @ np.linalg.solve(delta * np.eye(len(phi)) - phi, g1 + g2 / z))[0, 0] * z ** -d['delay_samples']
    r = (np.array(whole['C']) @ np.linalg.solve(delta * np.eye(len(whole['Phi'])) - np.array(whole['Phi']), np.array(whole['Gamma'])))[0, 0]
    assert abs(p - q) < 1e-9 * scale and abs(p - r) < 1e-9 * scale, (w, p, q, r)
    s = 1j * w
    continuous = (np.array(model['continuous']['C']) @ np.linalg.solve(
        s * np.eye(len(model['continuous']['A'])) - np.array(model['continuous']['A']), np.array(model['continuous']['B'])))[0, 0]
    modal = sum(np.polynomial.polynomial.polyval(s, t['numerator']) / np.polynomial.polynomial.polyval(s, t['denominator'])
                for t in model['modal_terms'])
    assert abs(continuous - modal) < 1e-7 * abs(modal), (w, continuous, modal)
    print('%.17g %.17g' % (p.real, p.imag))
)");
  const Outcome outcome =
      run("zwidth export device.toml --format json --output device.json && /usr/bin/python3 check.py");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  expect_our_response(outcome.output);
}

// The exported device and wall, closed in another program: its poles are the library's, softer and stiffer than K_CR.
class ExportWall : public Export {
 protected:
  ExportWall() : wall_(device_.parameters().wall) {
    const CriticalStiffness critical =
        critical_stiffness(filtered_plant(device_), {wall_.damping, wall_.velocity_filter_hz});
    critical_ = critical.status == StiffnessStatus::finite ? critical.stiffness : 100.0;
    std::string lines;
    for (const double share : shares) lines += fmt::format("{:.17g}\n", share * critical_);
    write("stiffness.txt", lines);
  }

  /// Every line "K real imaginary" of `output` is a pole of ours at that K, and there are as many.
  void expect_our_poles(const std::string& output) {
    const DiscreteStateSpace plant =
        sample(state_space(device_), {device_.loop().sampling_period, device_.loop().delay});
    std::istringstream lines(output);
    for (const double share : shares) {
      wall_.stiffness = share * critical_;
      std::vector<Complex> ours = closed_loop_poles_minus_one(plant, wall_);
      for (Complex& pole : ours) pole += 1.0;
      if (wall_.damping > 0.0 && wall_.velocity_filter_hz > 0.0) {
        // The library keeps the last position beside the low-passed velocity: one pole more, at 0.
        const auto at_zero = std::ranges::min_element(ours, {}, [](const Complex& pole) { return std::abs(pole); });
        EXPECT_LT(std::abs(*at_zero), 1e-6);
        ours.erase(at_zero);
      }
      while (!ours.empty()) {
        double real = 0.0;
        double imaginary = 0.0;
        ASSERT_TRUE(lines >> real >> imaginary) << output;
        const Complex theirs(real, imaginary);
        const auto nearest =
            std::ranges::min_element(ours, {}, [theirs](const Complex& pole) { return std::abs(pole - theirs); });
        // A pole of a long delay is near 0 and there of high multiplicity: it is not known any better.
        EXPECT_LT(std::abs(*nearest - theirs), std::abs(theirs) > 0.5 ? 1e-7 : 2e-2) << theirs;
        ours.erase(nearest);
      }
    }
    double more = 0.0;
    EXPECT_FALSE(lines >> more) << output;
  }

  static constexpr std::array shares{0.3, 0.98, 1.02, 2.0};
  Wall wall_;
  double critical_ = 0.0;
};

TEST_P(ExportWall, ClosesInOctave) {
  write("check.m", R"octave(1;
evalc("source('device.m')");
for K = load('stiffness.txt')'
  p = closed_loop_poles(sysd, wall, K);
  printf('%.17g %.17g\n', [real(p'); imag(p')]);
end
)octave");
  const Outcome outcome = run("zwidth export device.toml --format octave > device.m && /usr/bin/octave-cli check.m");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  expect_our_poles(outcome.output);
}

TEST_P(ExportWall, ClosesInPython) {
  write("check.py", R"(import numpy as np
import device
for K in np.loadtxt('stiffness.txt'):
    for p in device.closed_loop_poles(K):
        print('%.17g %.17g' % (p.real, p.imag))
)");
  const Outcome outcome = run("zwidth export device.toml --format python > device.py && /usr/bin/python3 check.py");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  expect_our_poles(outcome.output);
}

// By the delta form of the filters, response by response: 1 + C P = 0 at every crossover.
TEST_P(ExportWall, ClosesFromJson) {
  write("check.py", R"(import json
import numpy as np
model = json.load(open('device.json'))
T = model['sampling_period_s']
wall = model['wall']
polynomial = np.polynomial.polynomial.polyval
for crossover in model['crossovers']:
    w = crossover['frequency_rad_s']
    d = np.expm1(1j * w * T)
    z = np.exp(1j * w * T)
    p = sum(polynomial(d, t['numerator']) / polynomial(d, t['denominator']) for t in model['sampled_terms']['terms'])
    p *= z ** -model['sampled_terms']['delay_samples']
    f = g = 1.0
    for each in wall['filters']:
        f *= polynomial(d, each['delta']['numerator']) / polynomial(d, each['delta']['denominator'])
        g *= np.polyval(each['z']['numerator'], z) / np.polyval(each['z']['denominator'], z)
    assert abs(f - g) < 1e-9 * abs(f) + 1e-12, (w, f, g)
    c = f * (crossover['stiffness'] + wall['damping'] * (1 - wall['a']) / T * d / (z - wall['a']))
    if w < 0.99 * np.pi / T:
        assert abs(1 + c * p) < 1e-6, (w, 1 + c * p)
print(len(model['crossovers']), len(wall['filters']))
)");
  const Outcome outcome = run("zwidth export device.toml --format json > device.json && /usr/bin/python3 check.py");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::size_t crossovers = 0;
  std::size_t filters = 0;
  std::istringstream(outcome.output) >> crossovers >> filters;
  EXPECT_GT(crossovers, 0U);
  EXPECT_EQ(filters, wall_.filters.size());
}

using ExportFarSensed = Export;
TEST_P(ExportFarSensed, RunsInOctaveWithOurResponse) { expect_octave_has_our_response(); }
TEST_P(ExportFarSensed, RunsInPythonWithOurResponse) { expect_python_has_our_response(); }

INSTANTIATE_TEST_SUITE_P(Far, ExportFarSensed, ::testing::Values(far_sensed()));
INSTANTIATE_TEST_SUITE_P(Devices, ExportWall, ::testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

INSTANTIATE_TEST_SUITE_P(Devices, Export, ::testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

class ExportCommand : public Workspace {};

TEST_F(ExportCommand, RefusesAnUnknownFormatAndAMissingOne) {
  const Outcome unknown = run("zwidth export devices/lhifam.toml --format matlab");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("octave"));
  EXPECT_EQ(run("zwidth export devices/lhifam.toml").status, 2);
}

TEST_F(ExportCommand, AnUnwritableOutputIsAFailureWithoutAFile) {
  const Outcome outcome = run("zwidth export devices/lhifam.toml --format json --output no/such/dir/x.json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("no/such/dir/x.json: cannot write"));
}

TEST_F(ExportCommand, ALongDelayLeavesOutTheMatrixOfDelayStates) {
  const Outcome outcome = run("zwidth export devices/lhifam.toml --format json --set loop.delay=0.5");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto model = nlohmann::json::parse(outcome.output);
  EXPECT_TRUE(model.at("with_delay_states").is_null());
  EXPECT_EQ(model.at("discrete").at("delay_samples"), 500);
}

}  // namespace
}  // namespace zwidth::cli
