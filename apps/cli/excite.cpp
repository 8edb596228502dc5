#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/excitation_text.hpp"
#include "results/excitation_json.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {
namespace {

struct ExciteArguments {
  ExcitationOptions excitation;
  std::string kind = "linear-chirp";
  std::string device;
  std::vector<std::string> overrides;
  const CLI::App* command = nullptr;
  bool beyond_limits = false;
  std::string samples;  ///< the file
  OutputArguments output{.figure_option = "--figure"};
};

/// Options by the member of ExcitationOptions that they set.
constexpr std::pair<std::string_view, std::string_view> options_of_excitation[] = {
    {"amplitude", "--amplitude"}, {"lowest_hz", "--lowest-hz"}, {"highest_hz", "--highest-hz"},
    {"duration", "--duration"},   {"rate", "--rate"},           {"fade_in", "--fade-in"},
    {"periods", "--periods"},     {"stroke_limit", "--stroke"}};

/// Makes the signal, and plays it through the device where there is one.
Excitation made_excitation(const ExciteArguments& arguments) {
  ExcitationOptions options = arguments.excitation;
  options.kind = results::Json(arguments.kind).get<ExcitationKind>();
  if (arguments.device.empty()) {
    if (const auto problem = find_problem(options)) refuse(*problem, options_of_excitation);
    check_samples(*arguments.command, "--duration", options.duration * options.rate.value_or(default_excitation_rate));
    return excite(options);
  }
  const Device device = std::move(read_devices({{arguments.device}, arguments.overrides, arguments.command}).front());
  if (const auto problem = find_problem(options, device)) refuse(*problem, options_of_excitation);
  check_samples(*arguments.command, "--duration",
                options.duration * options.rate.value_or(1.0 / device.loop().sampling_period));
  return excite(options, device);
}

void check_limits(const ExciteArguments& arguments, const Excitation& excitation, const Outputs& outputs) {
  if (!excitation.check || excitation.check->exceeded.empty()) return;
  if (arguments.beyond_limits) return outputs.warn(excitation.check->exceeded);
  std::string problems;
  for (const Remark& remark : excitation.check->exceeded) problems += remark_line(remark) + "\n";
  throw WorkFailed(CommandText(problems) + CommandText("nothing is written; --beyond-limits writes it all the same"));
}

void check(const ExciteArguments& arguments) {
  if (arguments.output.json && arguments.samples == "-") {
    throw BadInput("--json", "standard output is taken by --output -", "name a file for the samples");
  }
}

void run_excite(const ExciteArguments& arguments) {
  Outputs outputs(*arguments.command);
  if (arguments.samples != "-") outputs.add("--output", arguments.samples);
  outputs.add(arguments.output);
  outputs.keep(arguments.device, "device file");
  check(arguments);
  const Excitation excitation = made_excitation(arguments);
  check_limits(arguments, excitation, outputs);
  const auto samples = [&](const report::Sink& sink) { results::write_excitation_csv(excitation, sink); };
  const bool only_asked_for_others =
      arguments.samples.empty() && (arguments.output.json || !arguments.output.figure.empty());
  const bool to_standard_output = arguments.samples == "-" || (arguments.samples.empty() && !only_asked_for_others);
  outputs.put("--output", samples);
  outputs.draw("--figure", [&](report::FigureFormat format) { return report::draw_excitation(excitation, format); });
  outputs.commit();
  hand_over_series(*arguments.command, "samples", excitation.samples);
  if (to_standard_output) samples([&](std::string_view rows) { outputs.print(rows); });
  if (arguments.output.json) {
    outputs.print(results::line(results::excitation_json(excitation)));
  } else if (to_standard_output) {
    outputs.tell(report::excitation_text(excitation));
  } else {
    outputs.print_text(report::excitation_text(excitation));
  }
  if (arguments.output.json) return;  // which has them
  outputs.warn(excitation.remarks);
  if (excitation.check) outputs.warn(excitation.check->remarks);
}

/// Options that only some kinds of signal have are refused with the others.
void check_kind(const CLI::App& command, const ExciteArguments& arguments) {
  const auto refuse = [&](const char* option, bool applies, const CommandText& whose) {
    if (command.count(option) > 0 && !applies) {
      throw BadInput(option, CommandText("is for ") + whose, CommandText("--kind is ") + arguments.kind);
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
  arguments->command = command;
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
  add("--rate", excitation.rate, "Samples per second; else the device's, else 1000", "HZ");
  add("--fade-in", excitation.fade_in, "Raised cosine at the start, and at the end but for a multisine", "S")
      ->capture_default_str();
  add("--periods", excitation.periods, "Whole periods of a multisine in the duration", "N")->capture_default_str();
  add("--seed", excitation.seed, "Of noise: another number, another signal", "N")->capture_default_str();
  CLI::Option* device = add("--device", arguments->device,
                            "Device file to check force limit and stroke against; - standard input", "FILE");
  add("--set", arguments->overrides, "Override a key of the device file; may be repeated", "KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(device);
  add("--stroke", excitation.stroke_limit, "How far the sensed body may move from its start, m (rotary: rad)", "M")
      ->needs(device);
  command->add_flag("--beyond-limits", arguments->beyond_limits, "Warn of an exceeded limit instead of failing")
      ->needs(device);
  add("-o,--output,--csv", arguments->samples, "CSV to write; else, without --figure and --json, standard output",
      "FILE");
  add_output_options(*command, arguments->output,
                     {.json = "Print the summary as JSON on standard output",
                      .figure = "Signal and power density as .svg, .png or .pdf"});
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
