#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/model/coordinates.hpp"
#include "zwidth/model/mechanism_file.hpp"
#include "zwidth/model/motor_drive.hpp"
#include "zwidth/model/uncertainty.hpp"
#include "zwidth/model/wall_filter.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Whether quantities are kg, N s/m, N/m or kg m², N m s/rad, N m/rad.
enum class Motion { linear, rotary };

/// A rigid body of one degree of freedom: mass x'' + damping x' + stiffness x = sum of forces.
struct Body {
  std::string name;        ///< unique in the device
  double mass = 0.0;       ///< kg or kg m²; > 0
  double damping = 0.0;    ///< to ground, N s/m or N m s/rad; >= 0
  double stiffness = 0.0;  ///< to ground, N/m or N m/rad; >= 0
  double coulomb = 0.0;    ///< Coulomb friction force, N or N m; >= 0; no limit depends on it
};

/// A compliant connection of two bodies: force = stiffness (x_1 - x_2) + damping (x_1' - x_2').
struct Link {
  std::size_t first = 0;   ///< index of a body
  std::size_t second = 0;  ///< index of another body
  double stiffness = 0.0;  ///< N/m or N m/rad; >= 0, and stiffness + damping > 0
  double damping = 0.0;    ///< N s/m or N m s/rad; >= 0
};

/// A continuous transfer function from actuator force to sensed position, descending powers of s.
///
/// Requires finite coefficients, a non-zero leading denominator coefficient, a non-zero numerator, and
/// degree(numerator) < degree(denominator).
struct TransferFunction {
  std::vector<double> numerator;    ///< by falling powers of s
  std::vector<double> denominator;  ///< by falling powers of s
};

/// The wall's damper in a loop of its own, as a drive closes it: how often it runs, and how late its force is.
struct LoopDamper {
  std::optional<double> sampling_period;  ///< s; > 0, a whole part or multiple of that of the loop; absent: the same
  std::optional<double> delay;            ///< s, in addition to the zero-order hold; >= 0; absent: that of the loop
};

/// How the loop is closed around the device. Body members are indices into DeviceParameters::bodies, or into the points of
/// its coordinates.
struct Loop {
  std::size_t actuated = 0;               ///< the body that the actuator pushes
  std::size_t sensed = 0;                 ///< the body whose position is sampled
  std::size_t held = 0;                   ///< the body that the user holds
  double sampling_period = 0.0;           ///< T, s; > 0
  double delay = 0.0;                     ///< t_d, s, in addition to the zero-order hold; >= 0
  std::optional<LoopDamper> damper = {};  ///< absent: the damper runs with the spring
};

/// What is between the commanded force and the real one.
struct Actuator {
  double time_constant = 0.0;         ///< s, first-order lag 1/(tau s + 1); >= 0
  std::optional<double> force_limit;  ///< N or N m; > 0; no limit depends on it
};

/// What is between the position and what is read of it.
struct Sensor {
  double resolution = 0.0;  ///< m or rad, encoder step; >= 0; no limit depends on it
  /// w, rad/s; > 0: the drive reads the position through (2 w s + w^2)/(s + w)^2, as its tracking of the encoder; 0: as it is
  double tracking_bandwidth = 0.0;
};

/// The virtual wall C(z) = F(z) (K + B v(z)), where v is the backward difference (1 - z^-1)/T, optionally followed by
/// the low-pass (1 - a)/(1 - a z^-1), a = exp(-2 pi f_c T), and F the product of the filters.
struct Wall {
  std::optional<double> stiffness;       ///< K, N/m or N m/rad; >= 0; absent: no wall to judge
  double damping = 0.0;                  ///< B, N s/m or N m s/rad; >= 0
  double velocity_filter_hz = 0.0;       ///< f_c; 0: no filter
  std::vector<WallFilter> filters = {};  ///< on the whole force, in the order in which they run; at most 20
};

/// A user at the held body: a mass, damper and spring to ground, all >= 0.
struct User {
  double mass = 0.0;       ///< kg or kg m^2
  double damping = 0.0;    ///< N s/m or N m s/rad, to ground
  double stiffness = 0.0;  ///< N/m or N m/rad, to ground
};

/// Everything a device file says. Plain data; Device checks it.
struct DeviceParameters {
  std::string name;                                   ///< for people
  Motion motion = Motion::linear;                     ///< which units all numbers have
  std::vector<Body> bodies;                           ///< empty for a transfer function
  std::vector<Link> links;                            ///< between the bodies
  std::optional<TransferFunction> transfer_function;  ///< instead of bodies and links
  Loop loop;                                          ///< how it is sampled, and where
  Actuator actuator;                                  ///< lag and limit of the force
  Sensor sensor;                                      ///< step of the encoder, and how a drive tracks it
  Wall wall;                                          ///< to judge
  User user;                                          ///< at the held body
  std::optional<Uncertainty> uncertainty;             ///< of some of the numbers above
  std::optional<MotorDrive> driver = {};              ///< what a rig reaches the motor through
  std::optional<Coordinates> coordinates = {};        ///< instead of bodies and links
  std::optional<MechanismDirection> mechanism = {};   ///< what the coordinates are of; device_of_mechanism() makes them
};

/// The first thing that makes DeviceParameters impossible.
struct DeviceProblem {
  std::string key;      ///< key of the device file, as in `--set`: "body.motor.mass", "link.0.stiffness", "loop.delay"
  std::string what;     ///< "is -0.3"
  std::string allowed;  ///< "must be a number > 0"
  std::optional<Problem> problem = {};  ///< what these are the words of, where it is data
};

/// A key's problem, in the words of words/problem_text.hpp.
[[nodiscard]] DeviceProblem device_problem(std::string key, Problem problem);

inline constexpr std::size_t max_bodies = 100;                ///< of a device
inline constexpr std::size_t max_links = 1000;                ///< of a device
inline constexpr std::size_t max_degree = 100;                ///< of a transfer function
inline constexpr std::size_t max_name_size = 200;             ///< bytes
inline constexpr std::size_t max_uncertain_parameters = 100;  ///< of a device
inline constexpr double max_delay_samples = 10000;            ///< whole device: delay / sampling_period
inline constexpr double max_rate_ratio = 1000;                ///< of the periods of spring and damper

/// Finds the first impossible value, or nothing when the parameters make a device.
///
/// Checks: all numbers finite and in the ranges given with each member, and 0 or within 1e-30..1e30 in magnitude
/// (coefficients of a transfer function: 1e-100..1e100), so that no product of a few of them overflows; body names
/// unique and not empty; link ends distinct and existing; every body connected to every other through links; one of
/// bodies, coordinates and a transfer function; of coordinates sizes that agree and a mass matrix that is symmetric and
/// positive definite; no user, link or second body with a transfer function; uncertain parameters
/// known, present and each once, their covariance square, symmetric and positive semidefinite; the damper's own period a
/// whole part or multiple of the loop's (to 1e-9), at most max_rate_ratio, and without filters of the wall where it is
/// another.
[[nodiscard]] std::optional<DeviceProblem> find_problem(const DeviceParameters& parameters);

/// The first problem of every key whose value is impossible, beside those of other keys: find_problem() without how the
/// bodies are connected and what is uncertain.
[[nodiscard]] std::vector<DeviceProblem> find_value_problems(const DeviceParameters& parameters);

/// A haptic device and its sampled loop; valid once constructed.
class Device {
 public:
  /// Throws Error (invalid_argument) with the key and the value when find_problem() finds one.
  explicit Device(DeviceParameters parameters);

  /// All that it was made of.
  [[nodiscard]] const DeviceParameters& parameters() const noexcept { return parameters_; }
  /// For people.
  [[nodiscard]] const std::string& name() const noexcept { return parameters_.name; }
  /// Empty for coordinates and for a transfer function.
  [[nodiscard]] const std::vector<Body>& bodies() const noexcept { return parameters_.bodies; }
  /// Between the bodies.
  [[nodiscard]] const std::vector<Link>& links() const noexcept { return parameters_.links; }
  /// How it is sampled, and where.
  [[nodiscard]] const Loop& loop() const noexcept { return parameters_.loop; }
  /// False for coordinates and for a transfer function.
  [[nodiscard]] bool has_bodies() const noexcept { return !parameters_.bodies.empty(); }
  /// Bodies or coordinates: what has mass, and can be held. False for a transfer function.
  [[nodiscard]] bool is_mechanical() const noexcept { return !parameters_.transfer_function; }
  /// How many bodies or coordinates there are; 0 for a transfer function.
  [[nodiscard]] std::size_t degrees_of_freedom() const noexcept {
    return parameters_.coordinates ? parameters_.coordinates->size() : parameters_.bodies.size();
  }

  /// This device with another value of one number, by its key as in `--set` (zwidth/model/parameter.hpp): SI units.
  /// A mechanism is put to its pose again. Throws Error (invalid_argument) for an unknown key, and where no device results.
  [[nodiscard]] Device with(std::string_view key, double value) const;

  /// Index of the body of that name; throws Error (no_such_body).
  [[nodiscard]] std::size_t body_index(const std::string& name) const;

 private:
  DeviceParameters parameters_;
};

/// Whether the wall of a mechanism acts in every direction at once: analyze() and point_wall_limit() answer for it, what is of one
/// direction throws Error (invalid_argument).
[[nodiscard]] inline bool is_point_wall(const Device& device) noexcept {
  return device.parameters().mechanism && device.parameters().mechanism->is_point;
}

/// Throws Error (needs_bodies) for a device of coordinates: for computations that know bodies and transfer functions alone.
void require_no_coordinates(const Device& device);

/// Throws Error (invalid_argument) for a drive that tracks the position: for computations that know positions as they are.
void require_no_tracking(const Device& device);

}  // namespace zwidth
