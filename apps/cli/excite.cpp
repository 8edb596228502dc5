#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <system_error>

#include "cli/device_arguments.hpp"
#include "cli/remark_lines.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/excitation_summary.hpp"
#include "report/figure/excitation_figure.hpp"
#include "report/output_file.hpp"
#include "report/text/remark_line.hpp"
#include "results/excitation_csv.hpp"
#include "results/json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::cli {
namespace {

struct ExciteArguments {
  ExcitationOptions excitation;
  std::string kind = "linear-chirp";
  std::optional<double> rate;
  std::string device;
  std::vector<std::string> overrides;
  std::optional<double> stroke;
  bool beyond_limits = false;
  std::string output;
  std::string figure;
  bool json = false;
};

const std::map<std::string, ExcitationKind>& excitation_kinds() {
  static const std::map<std::string, ExcitationKind> names{{"linear-chirp", ExcitationKind::linear_chirp},
                                                           {"log-chirp", ExcitationKind::logarithmic_chirp},
                                                           {"multisine", ExcitationKind::multisine},
                                                           {"noise", ExcitationKind::noise},
                                                           {"relay", ExcitationKind::relay}};
  return names;
}

std::optional<Device> read_device(const ExciteArguments& arguments) {
  if (arguments.device.empty()) return std::nullopt;
  const DeviceArguments device{{arguments.device}, arguments.overrides};
  for (const auto& [option, output] : {std::pair("--output", &arguments.output), {"--figure", &arguments.figure}}) {
    check_output_is_no_input(device, option, *output);
  }
  return read_devices(device).front();
}

/// Makes the signal and plays it through the device. Throws BadInput for options that make no signal.
report::CheckedExcitation checked_excitation(const ExciteArguments& arguments) {
  const std::optional<Device> device = read_device(arguments);
  report::CheckedExcitation checked;
  checked.options = arguments.excitation;
  checked.options.kind = excitation_kinds().at(arguments.kind);
  if (arguments.rate) {
    checked.options.rate = *arguments.rate;
  } else if (device) {
    checked.options.rate = 1.0 / device->loop().sampling_period;
  }
  try {
    checked.excitation = excite(checked.options);
    if (device) {
      checked.motion = device->parameters().motion;
      checked.device = device->name();
      checked.check =
          check_excitation(checked.excitation, checked.options.rate, *device, arguments.stroke.value_or(0.0));
    }
  } catch (const Error& error) {
    throw BadInput(error.what());
  }
  return checked;
}

void check_limits(const ExciteArguments& arguments, const report::CheckedExcitation& checked) {
  if (!checked.check || checked.check->exceeded.empty()) return;
  if (arguments.beyond_limits) return write_warnings(checked.check->exceeded);
  std::string problems;
  for (const Remark& remark : checked.check->exceeded) problems += report::remark_line(remark) + "\n";
  throw WorkFailed(problems + "nothing is written; --beyond-limits writes it all the same");
}

void check_outputs(const ExciteArguments& arguments) {
  if (!arguments.figure.empty() && !report::figure_format(arguments.figure)) {
    throw BadInput(fmt::format("--figure: {}: unknown extension; .svg, .png or .pdf", arguments.figure));
  }
  std::error_code one_is_missing;
  if (!arguments.figure.empty() && (arguments.figure == arguments.output ||
                                    std::filesystem::equivalent(arguments.figure, arguments.output, one_is_missing))) {
    throw BadInput("--figure: is the same file as --output; name another");
  }
  if (arguments.json && arguments.output == "-") {
    throw BadInput("--json: standard output is taken by --output -; name a file for the samples");
  }
  if (arguments.stroke && !(std::isfinite(*arguments.stroke) && *arguments.stroke > 0.0)) {
    throw BadInput(fmt::format("--stroke: is {}; a length in m (rotary: rad) above 0", *arguments.stroke));
  }
}

void run_excite(const ExciteArguments& arguments) {
  check_outputs(arguments);
  const report::CheckedExcitation checked = checked_excitation(arguments);
  check_limits(arguments, checked);
  const double rate = checked.options.rate;
  // Drawn before anything is written, so that a failure leaves no half of the results.
  std::string picture;
  if (!arguments.figure.empty()) {
    picture = draw_excitation(report::excitation_title(checked.options), checked.excitation, rate, checked.motion,
                              *report::figure_format(arguments.figure));
  }
  const auto samples = [&](const report::Sink& sink) {
    report::write_excitation_csv(checked.excitation, rate, checked.motion, sink);
  };
  const bool only_asked_for_others = arguments.output.empty() && (arguments.json || !arguments.figure.empty());
  const bool to_standard_output = arguments.output == "-" || (arguments.output.empty() && !only_asked_for_others);
  if (to_standard_output) {
    samples(write_standard_output);
  } else if (!arguments.output.empty()) {
    report::write_whole(arguments.output, samples);
  }
  if (!picture.empty()) report::write_whole(arguments.figure, picture);
  if (arguments.json) {
    write_standard_output(excitation_json(checked).dump() + "\n");
  } else if (to_standard_output) {
    write_standard_error(excitation_text(checked));
  } else {
    write_standard_output(excitation_text(checked));
  }
  write_warnings(checked.excitation.remarks);
  if (checked.check) write_warnings(checked.check->remarks);
}

/// Options that only some kinds of signal have are refused with the others.
void check_kind(const CLI::App& command, const ExciteArguments& arguments) {
  const auto refuse = [&](const char* option, bool applies, std::string_view whose) {
    if (command.count(option) > 0 && !applies) {
      throw BadInput(fmt::format("{}: is for {}; --kind is {}", option, whose, arguments.kind));
    }
  };
  refuse("--periods", arguments.kind == "multisine", "a multisine");
  refuse("--seed", arguments.kind == "noise", "noise");
  refuse("--highest-hz", arguments.kind != "relay", "a band; a relay has one frequency, --lowest-hz");
}

}  // namespace

void add_excite(CLI::App& app) {
  auto arguments = std::make_shared<ExciteArguments>();
  ExcitationOptions& excitation = arguments->excitation;
  CLI::App* command = app.add_subcommand("excite", "A force signal that identifies a device, as CSV");
  const auto add = [&](const char* name, auto& value, const char* what, const char* type) {
    return command->add_option(name, value, what)->type_name(type);
  };
  add("--kind", arguments->kind, "linear-chirp, log-chirp, multisine, noise or relay (square wave)", "KIND")
      ->capture_default_str()
      ->check(CLI::IsMember({"linear-chirp", "log-chirp", "multisine", "noise", "relay"}));
  add("--amplitude", excitation.amplitude, "Peak force, N (rotary: N m)", "F")->required();
  add("--lowest-hz", excitation.lowest_hz, "Lower end of the band; of a relay its frequency", "HZ")
      ->capture_default_str();
  add("--highest-hz", excitation.highest_hz, "Upper end of the band", "HZ")->capture_default_str();
  add("--duration", excitation.duration, "Length of the signal", "S")->capture_default_str();
  add("--rate", arguments->rate, "Samples per second; else the device's, else 1000", "HZ");
  add("--fade-in", excitation.fade_in, "Raised cosine at the start, and at the end but for a multisine", "S")
      ->capture_default_str();
  add("--periods", excitation.periods, "Whole periods of a multisine in the duration", "N")->capture_default_str();
  add("--seed", excitation.seed, "Of noise: another number, another signal", "N")->capture_default_str();
  CLI::Option* device = add("--device", arguments->device,
                            "Device file to check force limit and stroke against; - standard input", "FILE");
  add("--set", arguments->overrides, "Override a key of the device file; may be repeated", "KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(device);
  add("--stroke", arguments->stroke, "How far the sensed body may move from its start, m (rotary: rad)", "X")
      ->needs(device);
  command->add_flag("--beyond-limits", arguments->beyond_limits, "Warn of an exceeded limit instead of failing")
      ->needs(device);
  add("-o,--output", arguments->output, "CSV to write; else, without --figure and --json, standard output", "FILE");
  add("--figure", arguments->figure, "Signal and power density as .svg, .png or .pdf", "FILE");
  command->add_flag("--json", arguments->json, "Print the summary as JSON on standard output");
  command->footer(
      "An exceeded force limit or stroke is a failure: status 1, and nothing is written.\n"
      "\n"
      "Examples:\n"
      "  zwidth excite --amplitude 5 --output chirp.csv\n"
      "  zwidth excite --amplitude 2 --device devices/lhifam.toml --stroke 0.05 \\\n"
      "    --figure chirp.svg --output chirp.csv\n"
      "  zwidth excite --kind multisine --amplitude 3 --lowest-hz 1 --highest-hz 100 --periods 10 \\\n"
      "    --output multisine.csv\n"
      "  zwidth excite --kind noise --amplitude 3 --seed 7 --fade-in 0.5 --rate 2000 --json");
  command->callback([arguments, command] {
    check_kind(*command, *arguments);
    run_excite(*arguments);
  });
}

}  // namespace zwidth::cli
