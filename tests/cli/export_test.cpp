#include <fmt/format.h>
#include <gmock/gmock.h>

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
      EXPECT_LT(std::abs(Complex(real, imaginary) - ours), tolerance * std::abs(ours)) << frequency << " rad/s";
    }
  }

  Device device_;
  SampledPlant plant_;
  std::vector<double> frequencies_;
};

TEST_P(Export, RunsInOctaveWithOurResponse) {
  write("check.m", R"octave(1;
evalc("source('device.m')");
w = load('frequencies.txt')';
p = sampled_response(model, w);
printf('%.17g %.17g\n', [real(p); imag(p)]);
)octave");
  const Outcome outcome =
      run("zwidth export device.toml --format octave --output device.m && /usr/bin/octave-cli device.m > table.txt && "
          "/usr/bin/octave-cli check.m");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  expect_our_response(outcome.output);
}

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

TEST_P(Export, RunsInPythonWithOurResponse) {
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
