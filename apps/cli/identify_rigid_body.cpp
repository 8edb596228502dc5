#include "cli/identify_rigid_body.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>

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
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    const std::string group = option->get_group();
    const bool of_response = group == "Estimate" || group == "Table of a response" ||
                             (group == "Structure" && name != "--motion" && name != "--sampling-period");
    if (of_response || name == "--velocity" || name == "--acceleration" || name == "--from-structure" ||
        name == "--no-hold" || name == "--figure" || name == "--points") {
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

report::IdentifiedRigidBody fitted_rigid_body(const RecordingArguments& recording, const StructureArguments& structure,
                                              const InverseDynamicsOptions& options) {
  RecordedMotion motion = read_motion(recording);
  const double period = structure.sampling_period.value_or(motion.recording.sampling_period);
  if (!(std::isfinite(period) && period > 0.0)) {
    throw BadInput(fmt::format("--sampling-period: is {}; a number of seconds above 0", period));
  }
  try {
    ProgressLine line("fitting " + recording.file);
    RigidBodyFit fit = identify_rigid_body(motion.force(), motion.motion(), motion.recording.sampling_period, options,
                                           line.progress());
    report::IdentifiedRigidBody identified = report::identified_rigid_body(
        recording.file, std::move(fit), structure.motion == "rotary" ? Motion::rotary : Motion::linear, period);
    std::vector<Remark>& remarks = motion.recording.remarks;
    identified.remarks.insert(identified.remarks.begin(), std::make_move_iterator(remarks.begin()),
                              std::make_move_iterator(remarks.end()));
    return identified;
  } catch (const Error& error) {
    throw BadInput(recording.file + ": " + error.what());
  }
}

}  // namespace zwidth::cli
