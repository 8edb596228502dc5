#include "zwidth/io/device_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/device_overrides.hpp"
#include "io/device_reading.hpp"
#include "io/prose.hpp"
#include "io/toml_text.hpp"
#include "io/wall_filter_reading.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;
namespace {

Problem beside_transfer_function(const char* part) {
  return {.code = ProblemCode::beside_transfer_function, .subjects = {{"part", part}}};
}

/// Reads the tables of one document, in the order in which later ones need earlier ones.
class DeviceReader {
 public:
  DeviceReader(DeviceReading& reading, const toml::table& document, FilesBeside files)
      : reading_(reading), root_(reading, document, ""), files_(files) {}

  [[nodiscard]] DeviceParameters read(std::string_view source) && {
    root_.refuse_keys_not_of(DeviceTable::root);
    device_.name = root_.text("name").value_or(without_controls(std::filesystem::path(source).stem().string()));
    read_motion();
    read_bodies();
    read_links();
    read_mechanism(std::filesystem::path(source).parent_path());
    read_transmissions();
    read_transfer_function();
    read_loop();
    read_loop_parts();
    read_driver();
    read_uncertainty();
    return std::move(device_);
  }

 private:
  void read_motion() {
    const auto motion = root_.text("motion");
    if (motion == "rotary") device_.motion = Motion::rotary;
    reading_.set_motion(device_.motion);
    if (motion && motion != "linear" && motion != "rotary") {
      const std::string meant = nearest_word(lower_case(*motion), std::vector<std::string>{"linear", "rotary"});
      root_.refuse("motion", not_one_of(*motion, R"("linear" or "rotary")"), suggested(meant));
      if (meant == "rotary") reading_.set_motion(device_.motion = Motion::rotary);  // its units are no further problem
    }
  }

  void read_bodies() {
    for (const toml::table* table : root_.tables(DeviceTable::body)) {
      TableReader reader(reading_, *table, fmt::format("body.{}", device_.bodies.size()));
      Body body;
      body.name = reader.text("name").value_or("");
      if (!body.name.empty()) reader.rename(fmt::format("body.{}", body.name));
      reader.refuse_keys_not_of(DeviceTable::body);
      if (!reader.has("name")) reader.refuse_missing("name", {"text"});
      read_members(reader, DeviceTable::body, body);
      names_.push_back(body.name);
      device_.bodies.push_back(std::move(body));
    }
  }

  void read_links() {
    for (const toml::table* table : root_.tables(DeviceTable::link)) {
      TableReader reader(reading_, *table, fmt::format("link.{}", device_.links.size()));
      reader.refuse_keys_not_of(DeviceTable::link);
      const auto between = reader.required_texts("between", {"bodies"});
      if (between.size() != 2) {
        reader.refuse("between",
                      {.code = ProblemCode::not_two_bodies, .evidence = {counted("length", between.size())}});
      }
      Link link;
      if (between.size() == 2) {
        link.first = body_index(reader, "between", between[0]);
        link.second = body_index(reader, "between", between[1]);
      }
      read_members(reader, DeviceTable::link, link);
      if (!reader.has("stiffness") && !reader.has("damping")) {
        reader.refuse_missing("stiffness", {"gain"});
      }
      device_.links.push_back(link);
    }
  }

  void read_mechanism(const std::filesystem::path& folder) {
    const toml::table* table = root_.table(DeviceTable::mechanism);
    if (!table) return;
    TableReader reader = table_reader(DeviceTable::mechanism, *table);
    MechanismDirection& direction = device_.mechanism.emplace();
    MechanismFile& mechanism = direction.mechanism;
    read_members(reader, DeviceTable::mechanism, mechanism);
    mechanism.text = reader.lines("text").value_or("");
    if (!reader.has("file") && !reader.has("text")) reader.refuse_missing("file", {"text"});
    if (!reader.has("tip")) reader.refuse_missing("tip", {"text"});
    if (!mechanism.path.empty() && files_ == FilesBeside::refused) {
      reader.refuse("file", {.code = ProblemCode::file_beside_text});
    } else if (!mechanism.path.empty()) {
      mechanism.path = std::filesystem::absolute(folder / mechanism.path).lexically_normal().string();
    }
    if (reader.has("encoders")) mechanism.encoders = reader.required_texts("encoders", {"texts"});
    direction.is_point = reader.is_text("normal") && reader.text("normal") == "all";
    if (!direction.is_point) read_normal(reader, direction.normal);
    read_pose(reader, mechanism);
    for (const DeviceTable kind : {DeviceTable::mechanism_joint, DeviceTable::mechanism_tendon}) {
      read_file_numbers(reader, kind, mechanism);
    }
    for (const std::string_view key : {"body", "link"}) {
      if (root_.has(key)) root_.refuse(key, {.code = ProblemCode::beside_mechanism});
    }
  }

  static void read_normal(TableReader& mechanism, std::array<double, 3>& normal) {
    const std::vector<double> numbers = mechanism.required_numbers("normal");
    if (numbers.size() == normal.size()) {
      std::ranges::copy(numbers, normal.begin());
    } else {
      mechanism.refuse("normal",
                       {.code = ProblemCode::normal_not_three_numbers, .evidence = {counted("count", numbers.size())}});
    }
  }

  void read_pose(TableReader& mechanism, MechanismFile& file) {
    const toml::table* table = mechanism.table(DeviceTable::mechanism_pose);
    if (!table) return;
    TableReader reader(reading_, *table, path_of(DeviceTable::mechanism_pose));
    for (const std::string& joint : reader.keys()) {
      std::optional<Motion> unit;
      file.pose[joint] = reader.number_of_either_motion(joint, Measure::position, unit).value_or(0.0);
      if (unit) file.units_of_pose[joint] = *unit;
    }
  }

  /// In either unit: the mechanism's file says which joints slide.
  void read_file_numbers(TableReader& mechanism, DeviceTable kind, MechanismFile& file) {
    const toml::table* tables = mechanism.table(kind);
    if (!tables) return;
    TableReader parts(reading_, *tables, path_of(kind));
    for (const std::string& name : parts.keys()) {
      const toml::table* table = parts.table(name, header_of(kind));
      if (!table) continue;
      TableReader reader(reading_, *table, fmt::format("{}.{}", path_of(kind), name));
      reader.refuse_keys_not_of(kind);
      for (const KeyRow& row : rows_of(kind)) {
        std::optional<Motion> unit;
        const auto value = reader.number_of_either_motion(row.key.name, *row.key.measure, unit);
        const std::string key = fmt::format("{}.{}.{}", entry_of(kind).name, name, row.key.name);
        if (value) file.numbers[key] = *value;
        if (unit) file.units_of_numbers[key] = *unit;
      }
    }
  }

  /// Their numbers are of rotary motion.
  void read_transmissions() {
    reading_.set_motion(Motion::rotary);
    for (const toml::table* table : root_.tables(DeviceTable::transmission)) {
      if (!device_.mechanism) {
        root_.refuse("transmission", {.code = ProblemCode::without_mechanism});
        break;
      }
      std::vector<Transmission>& transmissions = device_.mechanism->mechanism.transmissions;
      TableReader reader(reading_, *table, fmt::format("transmission.{}", transmissions.size()));
      reader.refuse_keys_not_of(DeviceTable::transmission);
      if (!reader.has("joint")) reader.refuse_missing("joint", {"text"});
      Transmission& transmission = transmissions.emplace_back();
      transmission.joint = reader.text("joint").value_or("");
      read_members(reader, DeviceTable::transmission, transmission);
    }
    reading_.set_motion(device_.motion);
  }

  void read_transfer_function() {
    const toml::table* table = root_.table(DeviceTable::transfer_function);
    if (!table) return;
    TableReader reader = table_reader(DeviceTable::transfer_function, *table);
    device_.transfer_function = {reader.required_numbers("numerator"), reader.required_numbers("denominator")};
    for (const std::string_view key : {"body", "link"}) {
      if (root_.has(key)) {
        root_.refuse(key, beside_transfer_function("bodies"));
      }
    }
    if (root_.has("operator")) {
      root_.refuse("operator", beside_transfer_function("operator"));
    }
  }

  void read_loop() {
    const toml::table* table = root_.table(DeviceTable::loop);
    if (!table) {
      if (!device_.bodies.empty() || device_.transfer_function || device_.mechanism) {
        root_.refuse_missing("loop", {"loop"});
      }
      return;
    }
    TableReader reader = table_reader(DeviceTable::loop, *table);
    device_.loop.actuated = loop_body(reader, "actuated", 0);
    device_.loop.sensed = loop_body(reader, "sensed", 0);
    device_.loop.held = loop_body(reader, "held", device_.bodies.empty() ? 0 : device_.bodies.size() - 1);
    read_members(reader, DeviceTable::loop, device_.loop);
    if (reader.has("damper")) read_table(reader, DeviceTable::loop_damper, device_.loop.damper.emplace());
  }

  void read_loop_parts() {
    read_table(root_, DeviceTable::actuator, device_.actuator);
    read_table(root_, DeviceTable::sensor, device_.sensor);
    if (auto wall = read_table(root_, DeviceTable::wall, device_.wall)) {
      read_velocity_filter_tau(*wall);
      read_filters(*wall);
    }
    read_table(root_, DeviceTable::user, device_.user);
  }

  /// The velocity's low-pass by the time constant of backward Euler, whose pole is tau/(tau + T), instead of its cutoff:
  ///     exp(-2 pi f T) = tau/(tau + T)   for   f = ln(1 + T/tau) / (2 pi T)
  void read_velocity_filter_tau(TableReader& wall) {
    const std::optional<double> tau = wall.number("velocity_filter_tau", Measure::time);
    if (!tau) return;
    const double period = damper_timing(device_.loop).sampling_period;
    constexpr double longest_time_constant = 1e29;  // its cutoff is a number that a device may have
    if (wall.has("velocity_filter_hz")) {
      wall.refuse("velocity_filter_tau",
                  {.code = ProblemCode::given_beside, .subjects = {{"other", "velocity_filter_hz"}}});
    } else if (!not_negative_numbers.contains(*tau) || *tau > longest_time_constant) {
      wall.refuse("velocity_filter_tau", {.code = ProblemCode::number_beyond_range,
                                          .evidence = {{"value", *tau}},
                                          .subjects = {{"in", std::string(si_unit(Measure::time, device_.motion))}}});
    } else if (*tau > 0.0 && period > 0.0) {
      device_.wall.velocity_filter_hz = std::log1p(period / *tau) / (2.0 * std::numbers::pi * period);
    }
  }

  void read_filters(TableReader& wall) {
    for (const toml::table* table : wall.tables(DeviceTable::filter)) {
      TableReader reader(reading_, *table,
                         fmt::format("{}.{}", path_of(DeviceTable::filter), device_.wall.filters.size()));
      device_.wall.filters.push_back(read_wall_filter(reader));
    }
  }

  void read_driver() {
    if (root_.has(path_of(DeviceTable::driver))) read_table(root_, DeviceTable::driver, device_.driver.emplace());
  }

  void read_uncertainty() {
    const toml::table* table = root_.table(DeviceTable::uncertainty);
    if (!table) return;
    TableReader reader = table_reader(DeviceTable::uncertainty, *table);
    Uncertainty& uncertainty = device_.uncertainty.emplace();
    uncertainty.warning = reader.text("warning").value_or("");
    if (reader.has("reasons")) uncertainty.reasons = reader.required_texts("reasons", {"texts"});
    uncertainty.verdict = read_verdict(reader);
    const bool is_of_parameters = reader.has("parameters") || reader.has("covariance");
    const bool says_why = reader.has("warning") || reader.has("reasons") || reader.has("verdict");
    if (reader.has("assumed")) {
      uncertainty.assumed = reader.required_texts("assumed", {"keys", "body.motor.mass"});
      // An empty list is that of a device whose numbers have all been given.
      if (!is_of_parameters && !says_why && uncertainty.assumed.empty()) device_.uncertainty.reset();
      if (!is_of_parameters) return;
    }
    if (!is_of_parameters && says_why) return;
    uncertainty.parameters = reader.required_texts("parameters", {"keys", "link.0.stiffness"});
    uncertainty.covariance = reader.required_rows("covariance");
  }

  static Trust::Verdict read_verdict(TableReader& reader) {
    const std::optional<std::string> text = reader.text("verdict");
    if (!text || *text == "sound") return Trust::Verdict::sound;
    if (*text == "doubtful") return Trust::Verdict::doubtful;
    if (*text != "refused") {
      reader.refuse("verdict", not_one_of(*text, R"("sound", "doubtful" or "refused")"));
    }
    return Trust::Verdict::refused;
  }

  TableReader table_reader(DeviceTable kind, const toml::table& table) {
    TableReader reader(reading_, table, path_of(kind));
    reader.refuse_keys_not_of(kind);
    return reader;
  }

  /// A table that may be left out, and its reader where it is there.
  template <typename Table>
  std::optional<TableReader> read_table(TableReader& parent, DeviceTable kind, Table& members) {
    const toml::table* table = parent.table(kind);
    if (!table) return std::nullopt;
    TableReader reader = table_reader(kind, *table);
    read_members(reader, kind, members);
    return reader;
  }

  std::size_t loop_body(TableReader& reader, std::string_view key, std::size_t otherwise) {
    const auto name = reader.text(key);
    if (!name) return otherwise;
    if (device_.transfer_function || device_.mechanism) {
      reader.refuse(key, device_.mechanism
                             ? Problem{.code = ProblemCode::beside_mechanism, .subjects = {{"part", "loop"}}}
                             : beside_transfer_function("loop"));
      return otherwise;
    }
    return body_index(reader, key, *name);
  }

  /// Index of the named body; 0 and a refusal where there is none.
  std::size_t body_index(TableReader& reader, std::string_view key, const std::string& name) {
    const auto found = std::ranges::find(names_, name);
    if (found != names_.end()) return static_cast<std::size_t>(found - names_.begin());
    // Without any body, or with a name that two bodies share, the device is refused for that.
    if (names_.empty() || has_repeated_name()) {
      reader.leave(key);
      return 0;
    }
    const std::string meant = nearest_word(name, names_);
    // Of the two of a link there is no one value to put.
    reader.refuse(key, no_such_body(name, names_, meant), suggested(key == "between" ? "" : meant));
    return 0;
  }

  [[nodiscard]] bool has_repeated_name() const {
    return std::set<std::string>(names_.begin(), names_.end()).size() < names_.size();
  }

  DeviceReading& reading_;
  TableReader root_;
  FilesBeside files_;
  DeviceParameters device_;
  std::vector<std::string> names_;
};

/// Puts the coordinates of the mechanism at its pose into the device; what its file says wrong is refused.
void go_to_pose(DeviceParameters& parameters, DeviceReading& reading) {
  try {
    parameters = device_of_mechanism(parameters).parameters();
  } catch (const Error& error) {
    for (const InputProblem& each : error.problems()) reading.refuse_at(each);
    if (!reading.passed()) return;
    reading.refuse({}, "mechanism.file",
                   {.code = ProblemCode::mechanism_file_refused, .subjects = {{"why", error.what()}}});
  }
}

}  // namespace

tl::expected<Device, InputError> parse_device(std::string_view text, std::string_view source,
                                              std::span<const std::string> overrides, FilesBeside files) {
  auto document = parse_toml(text, source);
  if (!document) return tl::unexpected(std::move(document.error()));
  std::optional<InputError> overriding;
  for (const std::string& assignment : overrides) {
    auto error = apply_override(*document, assignment);
    if (!error) continue;
    if (overriding) {
      overriding->others.push_back(*std::move(error));
    } else {
      overriding = std::move(error);
    }
  }
  if (overriding) return tl::unexpected(*std::move(overriding));
  DeviceReading reading(source);
  DeviceParameters parameters = DeviceReader(reading, *document, files).read(source);
  for (const DeviceProblem& problem : find_value_problems(parameters)) reading.refuse(problem);
  if (reading.passed() && parameters.mechanism) go_to_pose(parameters, reading);
  if (reading.passed()) {
    if (const auto problem = find_problem(parameters)) reading.refuse(*problem);
  }
  if (!reading.passed()) return tl::unexpected(reading.error());
  return Device(std::move(parameters));
}

}  // namespace zwidth
