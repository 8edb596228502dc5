#pragma once

#include <string>

namespace zwidth {

/// The device file of the interface, every key given.
inline const std::string full_device_text = R"(name = "LHIfAM, translational axis"
motion = "linear"

[[body]]
name = "motor"
mass = 0.3
damping = 0.1
stiffness = 2.0
coulomb = 0.25

[[body]]
name = "handle"
mass = 5.1
damping = 3.4

[[link]]
between = ["motor", "handle"]
stiffness = 79.5e3
damping = 15.0

[loop]
actuated = "motor"
sensed = "handle"
held = "motor"
sampling_period = 1e-3
delay = 0.25e-3

[actuator]
time_constant = 2e-4
force_limit = 20

[sensor]
resolution = 3.14e-6

[wall]
stiffness = 5000.0
damping = 5.0
velocity_filter_hz = 50.0

[operator]
mass = 0.5
damping = 6.0
stiffness = 130.0
)";

/// One body, nothing optional.
inline const std::string small_device_text = R"([[body]]
name = "handle"
mass = 2
[loop]
sampling_period = 1e-3
)";

/// Two bodies and a link.
inline const std::string two_body_text = R"([[body]]
name = "motor"
mass = 0.3
[[body]]
name = "handle"
mass = 5.1
[[link]]
between = ["motor", "handle"]
stiffness = 79.5e3
[loop]
sampling_period = 1e-3
)";

/// A body "a" with more keys below it, and a loop.
inline std::string body_text(const std::string& rest) { return "[[body]]\nname = \"a\"\nmass = 1\n" + rest + "\n"; }
inline std::string loop_text(const std::string& rest = "") { return "[loop]\nsampling_period = 1e-3\n" + rest + "\n"; }

}  // namespace zwidth
