#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/number_text.hpp"
#include "cli/option_refusal.hpp"
#include "cli/option_units.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/subcommand.hpp"
#include "report/analysed_device.hpp"
#include "report/analysis_report.hpp"
#include "report/figure/figures.hpp"
#include "report/text/trust_text.hpp"
#include "results/analysis_json.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

struct AnalyzeOptions {
  DeviceArguments devices;
  OutputArguments output{.figure_option = "--figure"};
  std::string report;
  bool worst_user = false;
  bool require_stable = false;
  bool walls = false;
  report::Detail detail;
  std::string users;
};

constexpr std::string_view example_of_users = "for instance mass=0:2,damping=0:30,stiffness=0:1000";

/// One of the three ranges that --users may name.
struct Named {
  std::optional<ValueRange>* range = nullptr;
  Measure measure = Measure::mass;
};

ValueRange range_in(const std::string& key, const std::string& text, Measure measure, Motion motion) {
  const std::vector<std::string> ends = parts_of(text, ':');
  const auto least_given = measured_number(ends.front(), measure, motion);
  const auto greatest_given = measured_number(ends.back(), measure, motion);
  if (ends.size() > 2 || !least_given || !greatest_given) {
    const UnitProblem* problem = !least_given      ? &least_given.error()
                                 : !greatest_given ? &greatest_given.error()
                                                   : nullptr;
    throw BadInput(
        "--users",
        fmt::format("{}: '{}' must be LEAST:GREATEST or one number{}", key, text, problem ? ": " + problem->what : ""),
        problem ? problem->allowed : "");
  }
  return {*least_given, *greatest_given};
}

Named place_of(UserRanges& ranges, const std::string& key) {
  if (key == "mass" || key == "inertia") return {&ranges.mass, Measure::mass};
  if (key == "damping") return {&ranges.damping, Measure::damping};
  if (key == "stiffness") return {&ranges.stiffness, Measure::stiffness};
  return {};
}

/// Reads "mass=0:2,damping=0:30,stiffness=1000": some of the three keys (inertia is the mass of a rotary axis), each
/// with a range LEAST:GREATEST or one value, plain or with units ("mass=0:500 g"). Throws BadInput that names the key.
UserRanges user_ranges(const std::string& text, Motion motion) {
  UserRanges ranges;
  for (const std::string& part : parts_of(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) {
      throw BadInput("--users", fmt::format("'{}' must be KEY=LEAST:GREATEST", part), std::string(example_of_users));
    }
    const std::string key = part.substr(0, equals);
    const Named named = place_of(ranges, key);
    if (named.range == nullptr) {
      const std::string nearest =
          nearest_word(key, std::vector<std::string>{"mass", "inertia", "damping", "stiffness"});
      throw BadInput("--users", fmt::format("there is no key '{}'", key),
                     nearest.empty() ? "one of mass, damping, stiffness" : "did you mean " + nearest + "?");
    }
    if (*named.range) throw BadInput("--users", fmt::format("{} is given twice", key));
    *named.range = range_in(key, part.substr(equals + 1), named.measure, motion);
  }
  return ranges;
}

/// The library's members as the options that set them.
constexpr std::pair<std::string_view, std::string_view> options_of_analysis[] = {
    {"worst_user", "--worst-user"},
    {"family", "--users"},
};

/// What is asked of one device. Throws BadInput where it cannot be answered.
AnalysisOptions options_for(const AnalyzeOptions& options, const std::string& file, const Device& device) {
  AnalysisOptions asked{.worst_user = options.worst_user};
  if (!options.users.empty()) asked.family = user_ranges(options.users, device.parameters().motion);
  if (const auto problem = find_problem(asked, device)) {
    constexpr std::string_view of_family = "family.";
    if (!problem->member.starts_with(of_family)) refuse(*problem, options_of_analysis, file);
    // A number of the users, which is no key of the device.
    const std::string what = fmt::format("{}: {}", problem->member.substr(of_family.size()), problem->what);
    refuse_key(file, "", what, problem->allowed, "--users");
  }
  return asked;
}

/// The walls with a damper and with margins: of one device in its text and page; in JSON where they are asked for.
bool shows_walls(const AnalyzeOptions& options) {
  return options.walls || (options.devices.files.size() == 1 && (!options.output.json || !options.report.empty()));
}

std::vector<report::AnalysedDevice> analysed_devices(const AnalyzeOptions& options) {
  std::vector<Device> devices = read_devices(options.devices);
  std::vector<AnalysisOptions> asked;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    asked.push_back(options_for(options, options.devices.files[i], devices[i]));
  }
  std::vector<report::AnalysedDevice> analysed;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    ProgressLine line(*options.devices.command, "analysing " + options.devices.files[i]);
    asked[i].progress = line.progress();
    analysed.push_back(worked(options.devices.files[i], [&] {
      report::AnalysedDevice each = report::analysed_device(std::move(devices[i]), asked[i]);
      if (shows_walls(options) && !is_point_wall(each.device)) {
        each.walls = wall_summary(each.device, each.analysis, {.progress = line.progress()});
      }
      if (!options.report.empty()) each.region = report::region_of_page(each, line.progress());
      return each;
    }));
  }
  return analysed;
}

/// "nobody holding", "the file's user", or both.
std::string holders_of_unstable(const Analysis& analysis) {
  const StableFor& wall = *analysis.wall_stable_for;
  std::string holders = wall.nobody ? "" : std::string(words_of(Holder::nobody));
  if (wall.user.value_or(true)) return holders;
  return holders + (holders.empty() ? "" : " and with ") + std::string(words_of(Holder::user));
}

[[noreturn]] void refuse_without_wall(const std::string& file) {
  refuse_key(file, "wall.stiffness", "is missing: there is no wall to judge", "set it", "--require-stable");
}

/// For scripts: every wall given stands, and its verdict with it.
void require_stable(const AnalyzeOptions& options, const std::vector<report::AnalysedDevice>& analysed) {
  for (std::size_t i = 0; i < analysed.size(); ++i) {
    const Analysis& analysis = analysed[i].analysis;
    const std::string& file = options.devices.files[i];
    const CommandText place = CommandText("--require-stable: ") + file;
    switch (verdict_on_wall(analysis)) {
      case WallVerdict::stable:
        break;
      case WallVerdict::unstable:
        throw WorkFailed(place + ": the wall is unstable with " + holders_of_unstable(analysis));
      case WallVerdict::unsure:
        throw WorkFailed(place + ": the answer is " + report::verdict_text(analysis.trust));
      case WallVerdict::no_wall:
        refuse_without_wall(file);
    }
  }
}

void check_walls(const AnalyzeOptions& options, const std::vector<report::AnalysedDevice>& analysed) {
  for (std::size_t i = 0; i < analysed.size(); ++i) {
    if (analysed[i].device.parameters().wall.stiffness) continue;
    refuse_without_wall(options.devices.files[i]);
  }
}

void run_analyze(const AnalyzeOptions& options) {
  Outputs outputs(*options.devices.command);
  outputs.add(options.output);
  outputs.add("--report", options.report, Ending::page);
  outputs.keep(options.devices.files, "device file");
  if (!options.output.figure.empty() && options.devices.files.size() > 1) {
    throw BadInput("--figure", "shows one device", "give one FILE; zwidth bode draws several");
  }
  const std::vector<report::AnalysedDevice> analysed = analysed_devices(options);
  if (options.require_stable) check_walls(options, analysed);
  for (const report::AnalysedDevice& each : analysed) {
    if (!each.analysis.point_wall) continue;
    constexpr const char* remedy = "leave it out, or give one normal";
    if (!options.report.empty()) throw BadInput("--report", "a wall in every direction has no page", remedy);
    if (!options.output.figure.empty()) throw BadInput("--figure", "a wall in every direction has none", remedy);
  }
  outputs.put("--report", [&] { return report::html_report(analysed); });
  outputs.draw("--figure",
               [&](report::FigureFormat format) { return report::draw_stiffness_axis(analysed.front(), format); });
  outputs.put("--csv", [&] {
    results::LimitTable table;
    for (const report::AnalysedDevice& each : analysed) table.add(each.device, each.analysis);
    return table.text();
  });
  outputs.commit();
  if (options.output.json) {
    std::string lines;
    for (const report::AnalysedDevice& each : analysed)
      lines +=
          results::line(results::analysis_json(each.device, each.analysis, options.walls ? each.walls : std::nullopt));
    outputs.print(lines);
  } else {
    outputs.print_text(report::analysis_text(analysed, options.detail));
    if (!options.report.empty()) outputs.print("\nThe report is in " + options.report + "\n");
  }
  if (options.require_stable) require_stable(options, analysed);
}

}  // namespace

void add_analyze(CLI::App& app) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand("analyze", "Critical stiffness, what limits it, and the margins of a wall");
  add_device_arguments(*command, options->devices, FileCount::several);
  add_output_options(*command, options->output,
                     {.json = "Print one JSON document per device, one per line",
                      .csv = "Also write the limits, a row per device",
                      .figure = "Also draw which stiffness is stable, of one device: .svg, .png\nor .pdf"});
  command->add_option("--report", options->report, "Also write one self-contained page with figures")
      ->type_name("OUT.html");
  command->add_flag("--worst-user", options->worst_user,
                    "Also name the passive user who proves the limit for any user tight");
  command->add_flag("--walls", options->walls,
                    "Also the stiffest wall with a damper and the one to run (key\n\"walls\" of --json)");
  command->add_option("--users", options->users, "Also search a family of users: ranges of mass, damping, stiffness")
      ->type_name("RANGES")
      ->check([](const std::string& text) { return text.empty() ? "is empty" : ""; });
  command->add_flag("--db", options->detail.decibels, "Print stiffnesses in dB re 1 N/m or 1 N m/rad, too");
  command->add_flag("--formulas", options->detail.formulas,
                    "Print formulas of the literature where they say nothing of\nthis device, too");
  command->add_flag(
      "--require-stable", options->require_stable,
      "Fail (exit status 1) where a wall is unstable with nobody or\nthe file's user, or not surely stable");
  command->footer(
      "Examples:\n"
      "  zwidth analyze devices/lhifam.toml\n"
      "  zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --set wall.damping=5\n"
      "  zwidth analyze devices/lhifam.toml devices/lhifam_rigid.toml --json\n"
      "  zwidth analyze devices/lhifam.toml --worst-user --users mass=0:2,damping=0:30,stiffness=0:1000\n"
      "  zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --require-stable\n"
      "  zwidth analyze devices/lhifam.toml --report lhifam.html");
  command->callback([options] { run_analyze(*options); });
}

}  // namespace zwidth::cli
