#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/design_notch.hpp"
#include "cli/design_recommend.hpp"
#include "cli/device_arguments.hpp"
#include "cli/number_text.hpp"
#include "cli/option_refusal.hpp"
#include "cli/option_units.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/design_text.hpp"
#include "report/text/text_medium.hpp"
#include "results/design_json.hpp"
#include "results/design_target_json.hpp"
#include "zwidth/design/design_comparison.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/io/device_variants.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::cli {
namespace {

struct DesignArguments {
  DeviceArguments devices;
  std::vector<std::string> sweeps;
  std::string compare;
  std::vector<std::string> user;  // mass, damping, stiffness
  OutputArguments output{.ending = Ending::figure_or_csv};
  NotchArguments notch;
  RecommendArguments recommend;
  std::optional<std::string> target;
  bool any_user = false;
};

/// The library's members as the options that set them.
constexpr std::pair<std::string_view, std::string_view> options_of_design[] = {{"any_user", "--any-user"},
                                                                               {"user", "--operator"},
                                                                               {"goal", "--any-user"},
                                                                               {"stiffness", "--target"},
                                                                               {"times_now", "--target"}};

[[noreturn]] void refuse_sweep(const std::string& argument, const std::string& why) {
  throw BadInput("--sweep", fmt::format("{}: {}", in_quotes(argument), why),
                 "write KEY=FIRST:LAST:COUNT or KEY=FIRST:LAST:COUNT:log, for instance loop.delay=0:8e-3:81");
}

double end_of(const std::string& argument, const std::string& text, std::string_view which, Measure measure,
              Motion motion) {
  const auto number = measured_number(text, measure, motion);
  if (!number) refuse_sweep(argument, fmt::format("{}: {}; {}", which, number.error().what, number.error().allowed));
  return *number;
}

/// KEY=FIRST:LAST:COUNT, evenly spaced, or KEY=FIRST:LAST:COUNT:log, by equal factors; FIRST and LAST in SI units or
/// with one of the key's. Throws BadInput.
SweepAxis sweep_axis(const std::string& argument, const DeviceParameters& device) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0) refuse_sweep(argument, "has no KEY=");
  const std::vector<std::string> parts = parts_of(argument.substr(equals + 1), ':');
  if (parts.size() != 3 && parts.size() != 4) {
    refuse_sweep(argument, fmt::format("has {} parts after KEY=", parts.size()));
  }
  SweepAxis axis;
  axis.key = argument.substr(0, equals);
  const Measure measure = measure_of(axis.key).value_or(Measure::ratio);
  const Motion motion = motion_of_key(device, axis.key);
  axis.first = end_of(argument, parts[0], "FIRST", measure, motion);
  axis.last = end_of(argument, parts[1], "LAST", measure, motion);
  const std::string& count = parts[2];
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), axis.count);
  if (error != std::errc{} || end != count.data() + count.size()) {
    refuse_sweep(argument, fmt::format("COUNT {} is no whole number", in_quotes(count)));
  }
  if (parts.size() == 4) {
    if (parts[3] != "log") refuse_sweep(argument, fmt::format("{} is not log", in_quotes(parts[3])));
    axis.spacing = SweepAxis::Spacing::logarithmic;
  }
  return axis;
}

void run_sensitivities(const DesignArguments& arguments) {
  if (!arguments.output.figure.empty())
    throw BadInput("--output", "is for a sweep or a notch", "add --sweep KEY=FIRST:LAST:COUNT or --notch");
  const Outputs outputs(*arguments.devices.command);
  const std::vector<Device> devices = read_devices(arguments.devices);
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const Design answer = worked(arguments.devices.files[i], [&] {
      ProgressLine line(*arguments.devices.command, "moving the numbers of " + arguments.devices.files[i]);
      return design(devices[i], {.progress = line.progress()});
    });
    if (arguments.output.json) {
      text += results::line(results::design_json(devices[i], answer));
    } else {
      text += (i > 0 ? "\n" : "") + report::for_medium(report::design_text(devices[i], answer));
    }
  }
  outputs.print(text);
}

Device only_device(const DesignArguments& arguments, const std::string& option) {
  if (arguments.devices.files.size() != 1) throw BadInput(option, "takes one device file");
  return std::move(read_devices(arguments.devices).front());
}

void run_sweep(const DesignArguments& arguments) {
  Outputs outputs(*arguments.devices.command, arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  const Device device = only_device(arguments, "--sweep");
  std::vector<SweepAxis> axes;
  for (const std::string& each : arguments.sweeps) axes.push_back(sweep_axis(each, device.parameters()));
  if (const auto problem = find_sweep_problem(device, axes)) {
    throw BadInput("--sweep", fmt::format("{}: {}", problem->key, problem->what), problem->allowed);
  }
  // The figure of one parameter shows the absolute stability limit beside it.
  const bool is_curve = outputs.figure("--output").has_value() && axes.size() == 1;
  const SweepOptions options{arguments.any_user || (is_curve && device.is_mechanical()), is_curve};
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_design);
  ProgressLine line(*arguments.devices.command, "sweeping");
  const ParameterSweep sweep =
      worked(arguments.devices.files.front(), [&] { return parameter_sweep(device, axes, options, line.progress()); });
  if (sweep.trust.refused()) {
    return print_refused(outputs, sweep.trust, device.name(),
                         arguments.output.json ? results::line(results::sweep_json(device, sweep)) : "",
                         {arguments.output.csv, arguments.output.figure});
  }
  for (const char* option : {"--csv", "--output"}) outputs.put(option, [&] { return results::sweep_csv(sweep); });
  outputs.draw("--output", [&](report::FigureFormat format) { return report::draw_sweep(device, sweep, format); });
  outputs.commit();
  outputs.print(arguments.output.json ? results::line(results::sweep_json(device, sweep))
                                      : report::for_medium(report::sweep_text(device, sweep)));
}

void run_comparison(const DesignArguments& arguments) {
  if (!arguments.output.figure.empty()) throw BadInput("--output", "is for a sweep, not for --compare");
  const Device device = only_device(arguments, "--compare");
  const auto variants = device_variants(device, arguments.compare);
  if (!variants) {
    std::vector<InputProblem> problems;
    for (const InputError& error : variants.error()) {
      for (InputProblem& each : error.problems()) {
        each.place = {"", 0, 0, each.place.key, "--compare"};
        problems.push_back(std::move(each));
      }
    }
    throw BadInput(std::move(problems));
  }
  std::optional<User> user;
  if (!arguments.user.empty()) {
    const auto number = [&](std::size_t i, Measure measure) {
      return measured_number("--operator", arguments.user[i], measure, device.parameters().motion);
    };
    user = {number(0, Measure::mass), number(1, Measure::damping), number(2, Measure::stiffness)};
  }
  if (const auto problem = find_problem(*variants, user)) refuse(*problem, options_of_design);
  const Outputs outputs(*arguments.devices.command);
  const auto comparison = worked(arguments.devices.files.front(), [&] {
    ProgressLine line(*arguments.devices.command, "judging the designs");
    return compare_designs(*variants, user, line.progress());
  });
  outputs.print(arguments.output.json ? results::line(results::comparison_json(comparison))
                                      : report::for_medium(report::comparison_text(comparison)));
}

/// The whole text as a number, whatever its size: who knows the range tells what is out of it.
std::optional<double> plain_number(std::string_view text) {
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// K, plain or with a unit, or a multiple of today's limit: 2x, 200 %. Throws BadInput.
void set_target(const std::string& text, Motion motion, DesignTargetOptions& options) {
  if (const auto number = plain_number(text)) {
    options.stiffness = *number;
  } else if (text.ends_with('x')) {
    options.times_now = plain_number(std::string_view(text).substr(0, text.size() - 1));
  } else if (text.ends_with('%')) {
    options.times_now = plain_number(std::string_view(text).substr(0, text.size() - 1));
    if (options.times_now) *options.times_now /= 100.0;
  } else {
    const bool is_stiffness = options.limit_of == WallNumber::stiffness;
    options.stiffness = measured_number("--target", text, is_stiffness ? Measure::stiffness : Measure::damping, motion);
  }
  const bool is_multiple = text.ends_with('x') || text.ends_with('%');
  if (is_multiple && !options.times_now) {
    throw BadInput("--target", fmt::format("{} is no multiple of today's limit", in_quotes(text)),
                   "write 2x or \"200 %\", or the stiffness to reach: 12000, \"12 kN/m\"");
  }
}

/// Which limit is to reach it. Throws BadInput.
void set_goal(const DesignArguments& arguments, DesignTargetOptions& options) {
  if (arguments.any_user) options.goal = StiffnessGoal::absolute_stability_limit;
  const std::string goal = arguments.notch.goal.value_or("stiffness");
  if (goal == "damper") {
    options.limit_of = WallNumber::damping;
  } else if (goal == "any-user") {
    options.goal = StiffnessGoal::absolute_stability_limit;
  } else if (goal != "stiffness" && goal != "critical-stiffness") {
    throw BadInput("--goal", fmt::format("{} is not for a target", goal), "stiffness, any-user or damper is");
  }
}

void run_target(const DesignArguments& arguments) {
  if (!arguments.output.figure.empty()) throw BadInput("--output", "is for a sweep, not for --target");
  const Device device = only_device(arguments, "--target");
  DesignTargetOptions options;
  set_goal(arguments, options);
  set_target(*arguments.target, device.parameters().motion, options);
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_design);
  ProgressLine line(*arguments.devices.command, "searching the numbers");
  options.progress = line.progress();
  const Outputs outputs(*arguments.devices.command);
  const DesignTargets targets =
      worked(arguments.devices.files.front(), [&] { return design_targets(device, options); });
  outputs.print(arguments.output.json ? results::line(results::design_target_json(device, options, targets))
                                      : report::for_medium(report::design_target_text(device, options, targets)));
}

void run_design(const CLI::App& command, const DesignArguments& arguments) {
  OutputArguments figure_alone = arguments.output;
  figure_alone.ending = Ending::figure;
  if (!arguments.output.csv.empty() && arguments.sweeps.empty()) {
    throw BadInput("--csv", "is for a sweep", "add --sweep KEY=FIRST:LAST:COUNT");
  }
  if (arguments.recommend.wanted) {
    return run_recommend(command, arguments.devices, arguments.recommend, arguments.notch, figure_alone);
  }
  if (arguments.recommend.quantisation_force) throw BadInput("--ripple", "is for a recommendation", "add --recommend");
  if (arguments.notch.wanted) {
    if (!arguments.sweeps.empty() || !arguments.compare.empty()) {
      throw BadInput("--notch", "excludes --sweep and --compare");
    }
    if (arguments.devices.files.size() != 1) throw BadInput("--notch", "takes one device file");
    if (arguments.target) throw BadInput("--notch", "excludes --target");
    return run_notch(arguments.devices, arguments.notch, figure_alone);
  }
  refuse_notch_options(command, arguments.target.has_value());
  if (!arguments.sweeps.empty()) return run_sweep(arguments);
  if (!arguments.compare.empty()) return run_comparison(arguments);
  if (arguments.target) return run_target(arguments);
  if (arguments.any_user) throw BadInput("--any-user", "is for a sweep or a target", "add --sweep or --target");
  run_sensitivities(arguments);
}

}  // namespace

void add_design(CLI::App& app) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand(
      "design", "What to change: slopes of every number, sweeps, targets, a notch, the wall to render");
  add_device_arguments(*command, arguments->devices, FileCount::several);
  add_output_options(*command, arguments->output,
                     {.json = "Print one JSON document per answer, on one line",
                      .csv = "Of a sweep: also write its numbers",
                      .figure = "Also draw a sweep, a notch or a recommendation: .svg, .png or\n.pdf; .csv as --csv"});
  CLI::Option* sweep = command->add_option("--sweep", arguments->sweeps,
                                           "Follow a number: KEY=FIRST:LAST:COUNT, or with :log; two: twice");
  sweep->type_name("KEY=A:B:N")->allow_extra_args(false);
  command->add_flag("--any-user", arguments->any_user,
                    "Of a sweep: also the limit over all passive users; of a target: it");
  CLI::Option* compare =
      command->add_option("--compare", arguments->compare, "Judge several values of one key side by side");
  compare->type_name("KEY=V,V")->excludes(sweep);
  command
      ->add_option("--target", arguments->target,
                   "What each number alone must be for the limit to be K, or a\nmultiple of today's: 2x, \"200 %\"")
      ->type_name("K|2x")
      ->excludes(sweep)
      ->excludes(compare);
  command->add_option("--operator", arguments->user, "Of a comparison: the user, instead of the file's [operator]")
      ->type_name("MASS,DAMPING,STIFFNESS")
      ->delimiter(',')
      ->expected(3)
      ->allow_extra_args(false)
      ->needs(compare);
  add_notch_options(*command, arguments->notch);
  add_recommend_options(*command, arguments->recommend);
  command->footer(
      "Examples:\n"
      "  zwidth design devices/lhifam.toml\n"
      "  zwidth design devices/lhifam.toml --sweep loop.delay=0:8e-3:81 --output delay.svg\n"
      "  zwidth design devices/lhifam.toml --sweep loop.delay=0:4e-3:9 --sweep link.damping=5:50:9 -o m.svg\n"
      "  zwidth design devices/lhifam.toml --compare sensed=motor,handle --operator 0.5,6,135\n"
      "  zwidth design devices/lhifam.toml --target 12000\n"
      "  zwidth design devices/lhifam.toml --target 2x --any-user\n"
      "  zwidth design devices/lhifam.toml --target 2x --goal damper\n"
      "  zwidth design devices/lhifam.toml --recommend --ripple 0.1\n"
      "  zwidth design devices/lhifam_reduced_pretension.toml --notch --drift-percent 10 \\\n"
      "    --phase-margin-deg 0 --lower-any-user --output notch.svg");
  command->callback([arguments, command] { run_design(*command, *arguments); });
}

}  // namespace zwidth::cli
