#include "cli/motion_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "cli/input_problem.hpp"
#include "cli/number_text.hpp"
#include "cli/option_units.hpp"
#include "cli/progress_line.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* motion_group = "Motion";

std::vector<double> motion_of_bodies(const std::vector<std::string>& texts, const Device& device,
                                     const std::string& option, Measure measure) {
  if (texts.empty()) return {};
  if (!device.has_bodies()) {
    throw BadInput(option, "a transfer function has no bodies to start from", "move the wall with --wall-position");
  }
  std::vector<double> values(device.bodies().size(), 0.0);
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::string_view number = std::string_view(text).substr(equals == std::string::npos ? 0 : equals + 1);
    auto value = measured_number(number, measure, device.parameters().motion);
    if (!value) {
      value.error().what = fmt::format("'{}': {}", text, value.error().what);
      throw BadInput(problem_of_value(option, value.error()));
    }
    if (equals == std::string::npos) {
      values.assign(values.size(), *value);
      continue;
    }
    const std::string name = text.substr(0, equals);
    std::string names;
    bool found = false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (device.bodies()[i].name == name) values[i] = *value, found = true;
      names += (i == 0 ? "" : ", ") + device.bodies()[i].name;
    }
    if (!found) throw BadInput(option, fmt::format("no body '{}'", name), fmt::format("the device has {}", names));
  }
  return values;
}

/// "5", "5@0.1", "5,3@0.1", "5,3Hz": value, frequency and start.
struct ForceText {
  double value = 0.0;
  std::optional<double> frequency;  ///< Hz
  double start = 0.0;               ///< s
};

std::optional<ForceText> force_text(std::string_view text) {
  ForceText force;
  if (const std::size_t at = text.find('@'); at != std::string_view::npos) {
    const auto start = number_in(text.substr(at + 1));
    if (!start || *start < 0.0) return std::nullopt;
    force.start = *start;
    text = text.substr(0, at);
  }
  if (const std::size_t comma = text.find(','); comma != std::string_view::npos) {
    std::string_view frequency = text.substr(comma + 1);
    if (frequency.ends_with("Hz")) frequency.remove_suffix(2);
    force.frequency = number_in(frequency);
    if (!force.frequency || *force.frequency <= 0.0) return std::nullopt;
    text = text.substr(0, comma);
  }
  const auto value = number_in(text);
  if (!value) return std::nullopt;
  force.value = *value;
  return force;
}

struct ForceKind {
  std::string_view prefix;
  UserForce::Kind kind;
  bool has_frequency;
  std::string_view form;
};

constexpr ForceKind force_kinds[] = {
    {"step:", UserForce::Kind::step, false, "step:N@S (force in N or N m, start in s)"},
    {"ramp:", UserForce::Kind::ramp, false, "ramp:N_PER_S@S (rate in N/s or N m/s, start in s)"},
    {"sine:", UserForce::Kind::sine, true, "sine:N,HZ@S (amplitude, frequency in Hz, start in s)"}};

/// The column that was named, "force", or what excite calls it.
std::string force_column(const MotionArguments& arguments) {
  if (arguments.force_column != MotionArguments{}.force_column || arguments.user_force == "-") {
    return arguments.force_column;
  }
  const auto contents = list_named_recording(*arguments.command, arguments.user_force, {});
  for (const char* name : {"force", "force_N", "torque_N_m"}) {
    if (contents && std::ranges::count(contents->columns, name, &RecordingColumn::name) == 1) return name;
  }
  return arguments.force_column;  // whose lack is told where it is read
}

UserForce recorded_force(const MotionArguments& arguments) {
  RecordingOptions options;
  options.columns = {{force_column(arguments), arguments.force_scale}};
  options.rate = arguments.force_rate;
  ProgressLine line(*arguments.command, "reading " + arguments.user_force);
  const auto recording = read_named_recording(*arguments.command, arguments.user_force, options, line.progress());
  if (!recording) refuse_input(recording.error(), "--user-force");
  UserForce force;
  force.kind = UserForce::Kind::recorded;
  force.start = arguments.force_start;
  force.samples = recording->channels.front().samples;
  force.period = recording->sampling_period;
  return force;
}

UserForce user_force(const MotionArguments& arguments) {
  const std::string& text = arguments.user_force;
  for (const ForceKind& each : force_kinds) {
    if (!text.starts_with(each.prefix)) continue;
    const auto parsed = force_text(std::string_view(text).substr(each.prefix.size()));
    if (!parsed || parsed->frequency.has_value() != each.has_frequency) {
      throw BadInput("--user-force", fmt::format("'{}': {}", text, each.form));
    }
    if (parsed->value == 0.0) throw BadInput("--user-force", fmt::format("'{}': has no force", text), "a number but 0");
    UserForce force;
    force.kind = each.kind;
    force.amplitude = parsed->value;
    force.frequency = 2.0 * std::numbers::pi * parsed->frequency.value_or(0.0);
    force.start = parsed->start;
    return force;
  }
  return recorded_force(arguments);
}

}  // namespace

void add_motion_arguments(CLI::App& command, MotionArguments& arguments) {
  arguments.command = &command;
  const auto add_bodies = [&](const std::string& name, std::vector<std::string>& target, const std::string& what) {
    command.add_option(name, target, what)->type_name("BODY=X")->allow_extra_args(false)->group(motion_group);
  };
  add_bodies("--start", arguments.starts, "Where a body starts, m or rad; a number alone: all bodies");
  add_bodies("--start-velocity", arguments.velocities, "How fast it starts, m/s or rad/s");
  command
      .add_option(
          "--user-force", arguments.user_force,
          "Force on the held body: step:N@S, ramp:N_PER_S@S, sine:N,HZ@S\n(each from S seconds on), or a recording")
      ->type_name("FORCE|FILE")
      ->group(motion_group);
  command
      .add_option("--user-force-column", arguments.force_column,
                  "Column of the recording; force_N and torque_N_m too, as excite writes")
      ->type_name("COLUMN")
      ->capture_default_str()
      ->group(motion_group);
  command
      .add_option("--user-force-scale", arguments.force_scale, "What its samples are multiplied by, to get N or N m")
      ->type_name("X")
      ->capture_default_str()
      ->group(motion_group);
  command.add_option("--user-force-rate", arguments.force_rate, "Samples per second, where no column holds the time")
      ->type_name("HZ")
      ->group(motion_group);
  command.add_option("--user-force-start", arguments.force_start, "When the recording begins to act, s")
      ->type_name("S")
      ->capture_default_str()
      ->group(motion_group);
}

void apply(const MotionArguments& arguments, const Device& device, SimulationOptions& options) {
  if (!(std::isfinite(arguments.force_scale) && arguments.force_scale != 0.0)) {
    throw BadInput("--user-force-scale", fmt::format("is {}", arguments.force_scale), "a number but 0");
  }
  if (!(std::isfinite(arguments.force_start) && arguments.force_start >= 0.0)) {
    throw BadInput("--user-force-start", fmt::format("is {}", arguments.force_start), "a number of s >= 0");
  }
  if (arguments.force_rate && !(std::isfinite(*arguments.force_rate) && *arguments.force_rate > 0.0)) {
    throw BadInput("--user-force-rate", fmt::format("is {}", *arguments.force_rate), "a number of Hz above 0");
  }
  options.initial_position = motion_of_bodies(arguments.starts, device, "--start", Measure::position);
  options.initial_velocity = motion_of_bodies(arguments.velocities, device, "--start-velocity", Measure::velocity);
  if (arguments.user_force.empty()) return;
  if (!device.has_bodies()) throw BadInput("--user-force", "a transfer function has no body that a user could hold");
  options.user_force = user_force(arguments);
}

}  // namespace zwidth::cli
