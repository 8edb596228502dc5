#include "zwidth/stability/bode.hpp"

#include <fmt/format.h>

#include <memory>
#include <string_view>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/device_bode_figure.hpp"
#include "report/text/analysis_tables.hpp"
#include "report/text/trust_text.hpp"
#include "results/bode_json.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {
namespace {

using report::AnalysedDevice;

constexpr double analysis_share = 0.5;  // of the progress

struct BodeArguments {
  DeviceArguments devices;
  BodeOptions bode;
  OutputArguments output{.ending = Ending::figure_or_csv};
};

constexpr std::pair<std::string_view, std::string_view> options_of_bode[] = {
    {"from", "--from"}, {"to", "--to"}, {"points", "--points"}};

std::string crossovers_text(const std::vector<AnalysedDevice>& devices) {
  std::string text;
  for (const AnalysedDevice& each : devices) {
    const CriticalStiffness& critical = each.analysis.critical;
    text += each.device.name() + "\n" + report::trust_lines(each.analysis.trust);
    if (!critical.crossovers.empty()) {
      text += report::layout(report::crossover_table(each, {.decibels = true}));
    } else if (critical.status != StiffnessStatus::refused) {
      text += "  No phase crossover: no wall stiffness makes the loop oscillate.\n";
    }
    text += '\n';
  }
  return text + "A figure or the numbers: add --output FILE.svg, FILE.png, FILE.pdf or FILE.csv, or --json.\n";
}

void check_devices(const std::vector<AnalysedDevice>& devices, bool in_one_figure) {
  if (in_one_figure) {
    if (devices.size() > report::most_curves) {
      throw BadInput("", fmt::format("{} devices in one figure", devices.size()),
                     fmt::format("at most {} can be told apart", report::most_curves));
    }
    const Motion motion = devices.front().device.parameters().motion;
    for (const AnalysedDevice& each : devices) {
      if (each.device.parameters().motion != motion) {
        throw BadInput("", "linear and rotary devices in one figure", "draw each kind by itself");
      }
    }
  } else if (devices.size() > 1) {
    throw BadInput("--output", "a csv file holds one device", "give one FILE, or use --json");
  }
}

void run_bode(const BodeArguments& arguments) {
  Outputs outputs(*arguments.devices.command, arguments.output);
  outputs.keep(arguments.devices.files, "device file");
  ProgressLine line(*arguments.devices.command, "computing the responses");
  AnalysisOptions of_analysis = limit_and_wall_only();
  of_analysis.progress = line.progress(0.0, analysis_share);
  std::vector<Device> read = read_devices(arguments.devices);
  for (std::size_t i = 0; i < read.size(); ++i) {
    worked(arguments.devices.files[i], [&] { require_one_direction(read[i]); });
  }
  const std::vector<AnalysedDevice> devices = analyze_devices(arguments.devices, std::move(read), of_analysis);
  for (const AnalysedDevice& each : devices) {
    if (const auto problem = find_problem(arguments.bode, each.device)) refuse(*problem, options_of_bode);
  }
  BodeOptions options = arguments.bode;
  options.progress = line.progress(analysis_share, 1.0);
  const auto bode_of = [&](const AnalysedDevice& each) { return bode(each.device, each.analysis, options); };
  if (!arguments.output.csv.empty() && devices.size() > 1) {
    throw BadInput("--csv", "a csv file holds one device", "give one FILE, or use --json");
  }
  if (!arguments.output.figure.empty()) check_devices(devices, outputs.figure("--output").has_value());
  const auto numbers = [&] { return results::bode_csv(bode_of(devices.front())); };
  outputs.put("--output", numbers);
  outputs.put("--csv", numbers);
  outputs.draw("--output",
               [&](report::FigureFormat format) { return draw(device_bode_figure(devices, arguments.bode), format); });
  outputs.commit();
  if (arguments.output.json) {
    std::string lines;
    for (const AnalysedDevice& each : devices) lines += results::line(results::bode_json(each.device, bode_of(each)));
    outputs.print(lines);
  } else if (arguments.output.figure.empty() && arguments.output.csv.empty()) {
    outputs.print_text(crossovers_text(devices));
  }
}

}  // namespace

void add_bode(CLI::App& app) {
  auto arguments = std::make_shared<BodeArguments>();
  CLI::App* command = app.add_subcommand("bode", "Frequency responses with every crossover marked");
  add_device_arguments(*command, arguments->devices, FileCount::several);
  add_output_options(*command, arguments->output,
                     {.json = "Print the numbers, one JSON document per device, one per line",
                      .csv = "Write the numbers, of one device",
                      .figure = "Figure (.svg, .png, .pdf) or numbers (.csv) to write"});
  CLI::Option* from = command->add_option("--from", arguments->bode.from, "Lowest frequency, rad/s")->type_name("W");
  CLI::Option* to =
      command->add_option("--to", arguments->bode.to, "Highest frequency, rad/s; Nyquist unless given")->type_name("W");
  const auto in_hertz = [command](const char* name, std::optional<double>& frequency, const char* help,
                                  CLI::Option* other) {
    command
        ->add_option_function<double>(
            name, [&frequency](double hz) { frequency = radians_per_second(hz); }, help)
        ->type_name("HZ")
        ->excludes(other);
  };
  in_hertz("--from-hz", arguments->bode.from, "The same in Hz", from);
  in_hertz("--to-hz", arguments->bode.to, "The same in Hz", to);
  command
      ->add_option("--points", arguments->bode.points, "Frequencies on the logarithmic axis, more where a curve bends")
      ->capture_default_str()
      ->type_name("N");
  command->footer(
      "Examples:\n"
      "  zwidth bode devices/lhifam.toml\n"
      "  zwidth bode devices/lhifam.toml --output lhifam.svg\n"
      "  zwidth bode devices/lhifam.toml devices/lhifam_rigid.toml --output comparison.pdf\n"
      "  zwidth bode devices/lhifam.toml --set loop.delay=0.25e-3 --output lhifam.csv --points 1000");
  command->callback([arguments, command] {
    for (const char* option : {"--from", "--to", "--from-hz", "--to-hz", "--points"}) {
      const bool has_numbers =
          !arguments->output.figure.empty() || !arguments->output.csv.empty() || arguments->output.json;
      if (command->count(option) > 0 && !has_numbers) {
        throw BadInput(option, "is for a figure or its numbers", "add --output FILE or --json");
      }
    }
    run_bode(*arguments);
  });
}

}  // namespace zwidth::cli
