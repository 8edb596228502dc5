#include "cli/identify_in_time.hpp"

#include <fmt/format.h>

#include "cli/progress_line.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* segment_option = "--segment-duration";

}  // namespace

void add_time_domain_options(CLI::App& command, TimeDomainArguments& arguments) {
  constexpr const char* group = "Fit in time";
  command.add_option(segment_option, arguments.segment, "Each segment begins in a state of its own")
      ->type_name("S")
      ->capture_default_str()
      ->group(group);
}

void check_time_domain_options(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_name();
    const std::string group = option->get_group();
    if (group == "Estimate" || group == "Table of a response" || name == "--velocity" || name == "--acceleration" ||
        name == "--from-structure" || name == "--no-hold" || name == "--points") {
      throw BadInput(fmt::format("{}: is not for --method time-domain, which fits force and position", name));
    }
  }
}

void refuse_time_domain_options(const CLI::App& command) {
  if (command.count(segment_option) > 0) throw BadInput(fmt::format("{}: is for --method time-domain", segment_option));
}

TimeDomainIdentification fitted_in_time(const RecordingArguments& recording, const StructureArguments& structure_given,
                                        const TimeDomainArguments& arguments) {
  const std::vector<Recording> recordings = read_motions(recording).recordings;
  const Device device = structure(structure_given, recordings.front().sampling_period);
  TimeDomainOptions options;
  options.free = structure_given.free;
  options.locked = structure_given.locked;
  options.segment = arguments.segment;
  if (is_named_structure(structure_given)) options.structure_values = IdentifyOptions::StructureValues::placeholders;
  if (const auto problem = find_problem(options)) {
    throw BadInput(fmt::format("--segment-duration: {}; {}", problem->what, problem->allowed));
  }
  try {
    ProgressLine line("identifying");
    return identify_in_time(recordings, device, options, line.progress());
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(recording.file + ": " + error.what());
    throw BadInput(recording.file + ": " + error.what());
  }
}

}  // namespace zwidth::cli
