#include "cli/design_recommend.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/subcommand.hpp"
#include "report/analysed_device.hpp"
#include "report/figure/figures.hpp"
#include "report/text/design_text.hpp"
#include "report/text/text_medium.hpp"
#include "results/wall_recommendation_json.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::cli {
namespace {

RecommendationOptions recommendation_options(const RecommendArguments& arguments, const NotchArguments& shared) {
  static const std::map<std::string, WallGoal> goals{{"stiffness", WallGoal::stiffness},
                                                     {"width", WallGoal::width},
                                                     {"critical-damping", WallGoal::critical_damping},
                                                     {"damper", WallGoal::damper}};
  RecommendationOptions options{.drive_damper = true};
  if (shared.goal) {
    const auto goal = goals.find(*shared.goal);
    if (goal == goals.end()) {
      throw BadInput("--goal", fmt::format("{} is not for a recommendation", *shared.goal),
                     "stiffness, width, critical-damping or damper is");
    }
    options.goal = goal->second;
  }
  if (shared.gain_margin_db) options.gain_margin = ratio_of_decibels(*shared.gain_margin_db);
  if (shared.phase_margin_deg) options.phase_margin = radians(*shared.phase_margin_deg);
  if (shared.drift_percent) options.modal_frequency_uncertainty = *shared.drift_percent / 100.0;
  options.quantisation_force = arguments.quantisation_force;
  return options;
}

constexpr std::pair<std::string_view, std::string_view> options_of_recommendation[] = {
    {"gain_margin", "--gain-margin-db"},
    {"phase_margin", "--phase-margin-deg"},
    {"quantisation_force", "--ripple"},
    {"modal_frequency_uncertainty", "--drift-percent"},
    {"goal", "--goal"}};

WallRecommendation recommended(const CLI::App& command, const Device& device, const RecommendationOptions& options,
                               const std::string& file) {
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_recommendation, file);
  ProgressLine line(command, "searching the wall for " + file);
  RecommendationOptions asked = options;
  asked.progress = line.progress();
  return worked(file, [&] { return recommend_wall(device, asked); });
}

}  // namespace

void add_recommend_options(CLI::App& command, RecommendArguments& arguments) {
  const char* group = "Recommendation";
  command.add_flag("--recommend", arguments.wanted, "The wall to render: K, B, velocity filter, notch, for any user")
      ->group(group);
  command
      .add_option("--ripple", arguments.quantisation_force, "Greatest force per encoder count of that wall, N or N m")
      ->type_name("FORCE")
      ->group(group);
}

void run_recommend(const CLI::App& command, const DeviceArguments& devices, const RecommendArguments& arguments,
                   const NotchArguments& shared, const OutputArguments& output) {
  const bool json = output.json;
  if (devices.files.size() != 1) throw BadInput("--recommend", "takes one device file");
  for (const char* option : {"--notch", "--sweep", "--compare", "--target", "--any-user"}) {
    if (command.count(option) > 0) throw BadInput("--recommend", CommandText("excludes ") + CommandText(option));
  }
  for (const char* option : {"--far-from-modes", "--lower-any-user"}) {
    if (command.count(option) > 0) throw BadInput(option, "is for a notch", "add --notch");
  }
  const RecommendationOptions options = recommendation_options(arguments, shared);
  Outputs outputs(command);
  outputs.add("--write", shared.write);
  outputs.add(output);
  outputs.keep(devices.files, "device file");
  const std::string& file = devices.files.front();
  const Device device = read_devices(devices).front();
  const WallRecommendation recommendation = recommended(command, device, options, file);
  if (recommendation.status == WallRecommendation::Status::refused) {
    return print_refused(outputs, recommendation.trust, device.name(),
                         json ? results::line(results::wall_recommendation_json(device, options, recommendation)) : "",
                         {shared.write, output.figure});
  }
  if (!shared.write.empty() && !recommendation.wall) {
    throw WorkFailed(fmt::format("{}: {} is not written: {}", file, shared.write, text(recommendation.reason)));
  }
  outputs.put("--write", [&] {
    DeviceParameters walled = device.parameters();
    walled.wall = recommendation.wall->wall;
    return write_device(walled);
  });
  outputs.draw("--output", [&](report::FigureFormat format) {
    if (!recommendation.wall) return report::draw_region(device, region(device, {.approximations = false}), format);
    const Wall& wall = recommendation.wall->wall;
    const Device walled = report::device_with_wall(device, wall);
    return report::draw_region(walled, region(walled, {.approximations = false}), format, wall);
  });
  outputs.commit();
  outputs.print(json ? results::line(results::wall_recommendation_json(device, options, recommendation))
                     : report::for_medium(report::wall_recommendation_text(device, options, recommendation)));
}

}  // namespace zwidth::cli
