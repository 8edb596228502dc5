#include "cli/identify_rigid_body.hpp"

#include <fmt/format.h>

#include <array>

#include "cli/progress_line.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

constexpr std::array own_options{"--cutoff-hz", "--decimation"};

}  // namespace

void add_inverse_dynamics_options(CLI::App& command, InverseDynamicsOptions& options) {
  constexpr const char* group = "Inverse dynamics";
  command.add_option("--cutoff-hz", options.cutoff_hz, "Of the low-pass; else chosen from the motion")
      ->type_name("HZ")
      ->group(group);
  command.add_option("--decimation", options.decimation, "Every N-th sample is kept; else chosen from the cutoff")
      ->type_name("N")
      ->group(group);
}

void check_inverse_dynamics_options(const CLI::App& command) {
  if (command.count("MORE") > 0) throw BadInput("more than one recording: is not for --method inverse-dynamics");
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    const std::string group = option->get_group();
    const bool of_response = group == "Estimate" || group == "Table of a response" ||
                             (group == "Structure" && name != "--motion" && name != "--sampling-period");
    if (of_response || name == "--velocity" || name == "--acceleration" || name == "--from-structure" ||
        name == "--no-hold" || name == "--points") {
      throw BadInput(
          fmt::format("{}: is not for --method inverse-dynamics, which fits one rigid body to its position", name));
    }
  }
}

void refuse_inverse_dynamics_options(const CLI::App& command) {
  for (const char* option : own_options) {
    if (command.count(option) > 0) throw BadInput(fmt::format("{}: is for --method inverse-dynamics", option));
  }
}

RigidBodyIdentification fitted_rigid_body(const RecordingArguments& recording, const StructureArguments& structure,
                                          const InverseDynamicsOptions& options) {
  RigidBodyOptions all{options, structure.motion == "rotary" ? Motion::rotary : Motion::linear,
                       structure.sampling_period};
  if (const auto problem = find_problem(all); problem && problem->member == "sampling_period") {
    throw BadInput(fmt::format("--sampling-period: {}; {}", problem->what, problem->allowed));
  }
  const RecordedMotion motion = read_motion(recording);
  try {
    ProgressLine line("fitting " + recording.file);
    return identify_rigid_body(motion.recording, all, line.progress());
  } catch (const Error& error) {
    throw BadInput(recording.file + ": " + error.what());
  }
}

}  // namespace zwidth::cli
