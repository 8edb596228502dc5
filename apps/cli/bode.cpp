#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "cli/device_arguments.hpp"
#include "cli/outputs.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/device_bode.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "results/json.hpp"

namespace zwidth::cli {
namespace {

using report::AnalysedDevice;

struct BodeArguments {
  DeviceArguments devices;
  report::BodeOptions bode;
  std::string output;
  bool json = false;
};

void check(const BodeArguments& arguments, const std::vector<AnalysedDevice>& devices) {
  const auto check_frequency = [](std::string_view name, std::optional<double> value) {
    if (value && !(std::isfinite(*value) && *value > 0.0)) {
      throw BadInput(fmt::format("{}: is {}; a frequency in rad/s > 0", name, *value));
    }
  };
  check_frequency("--from", arguments.bode.from);
  check_frequency("--to", arguments.bode.to);
  const report::FrequencyRange range = report::bode_range(devices, arguments.bode);
  for (const AnalysedDevice& each : devices) {
    const double nyquist = std::numbers::pi / each.device.loop().sampling_period;
    if (range.from >= nyquist) {
      throw BadInput(
          fmt::format("--from: is {} rad/s; below the Nyquist frequency, {:.6g} rad/s", range.from, nyquist));
    }
  }
  if (range.from >= range.to) {
    throw BadInput(fmt::format("--to: is {:.6g} rad/s; above --from, {:.6g} rad/s", range.to, range.from));
  }
}

std::string crossover_table(const std::vector<AnalysedDevice>& devices) {
  std::string text;
  for (const AnalysedDevice& each : devices) {
    using Align = report::TextTable::Align;
    const CriticalStiffness& critical = each.analysis.critical;
    const std::string_view unit = report::units_of(each.device.parameters().motion).stiffness;
    report::TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::left},
                            {{"rad/s", "Hz", fmt::format("K ({})", unit), "K (dB)", "belongs to"}}};
    for (const Crossover& crossover : critical.crossovers) {
      const bool limits = critical.limit && critical.limit->frequency == crossover.frequency;
      table.rows.push_back(
          {report::number(crossover.frequency), report::number(report::hertz(crossover.frequency)),
           report::number(crossover.stiffness), fmt::format("{:.2f}", report::decibels(crossover.stiffness)),
           report::mechanism_name(each.analysis, crossover.limited_by) +
               (crossover.frequency == 0.0 ? ", a real pole at rest" : "") + (limits ? "  <- critical" : "")});
    }
    text += fmt::format("{}\n", each.device.name());
    text += critical.crossovers.empty() ? "  No phase crossover: no wall stiffness makes the loop oscillate.\n"
                                        : report::layout(table);
    text += '\n';
  }
  return text + "A figure or the numbers: add --output FILE.svg, FILE.png, FILE.pdf or FILE.csv, or --json.\n";
}

void check_devices(const std::vector<AnalysedDevice>& devices, bool in_one_figure) {
  if (in_one_figure) {
    if (devices.size() > report::most_curves) {
      throw BadInput(
          fmt::format("{} devices in one figure; at most {} can be told apart", devices.size(), report::most_curves));
    }
    const Motion motion = devices.front().device.parameters().motion;
    for (const AnalysedDevice& each : devices) {
      if (each.device.parameters().motion != motion) {
        throw BadInput("linear and rotary devices in one figure; draw each kind by itself");
      }
    }
  } else if (devices.size() > 1) {
    throw BadInput("--output: a csv file holds one device; give one FILE, or use --json");
  }
}

void run_bode(const BodeArguments& arguments) {
  Outputs outputs;
  outputs.add("--output", arguments.output, Ending::figure_or_csv);
  outputs.keep(arguments.devices.files, "device file");
  const std::vector<AnalysedDevice> devices = analyze_devices(arguments.devices, limit_and_wall_only());
  check(arguments, devices);
  if (!arguments.output.empty()) check_devices(devices, outputs.figure("--output").has_value());
  outputs.put("--output", [&] { return bode_csv(devices.front(), arguments.bode); });
  outputs.draw("--output",
               [&](report::FigureFormat format) { return draw(device_bode_figure(devices, arguments.bode), format); });
  outputs.commit();
  if (arguments.json) {
    std::string lines;
    for (const AnalysedDevice& each : devices) lines += results::line(bode_json(each, arguments.bode));
    write_standard_output(lines);
  } else if (arguments.output.empty()) {
    write_standard_output(crossover_table(devices));
  }
}

}  // namespace

void add_bode(CLI::App& app) {
  auto arguments = std::make_shared<BodeArguments>();
  CLI::App* command = app.add_subcommand("bode", "Frequency responses with every crossover marked");
  add_device_arguments(*command, arguments->devices, FileCount::several);
  command->add_option("-o,--output", arguments->output, "Figure (.svg, .png, .pdf) or numbers (.csv) to write")
      ->type_name("FILE");
  command->add_option("--from", arguments->bode.from, "Lowest frequency, rad/s")->type_name("W");
  command->add_option("--to", arguments->bode.to, "Highest frequency, rad/s; Nyquist unless given")->type_name("W");
  command
      ->add_option("--points", arguments->bode.points, "Frequencies on the logarithmic axis, more where a curve bends")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::Range(2, 100000));
  command->add_flag("--json", arguments->json, "Print the numbers, one JSON document per device, one per line");
  command->footer(
      "Examples:\n"
      "  zwidth bode devices/lhifam.toml\n"
      "  zwidth bode devices/lhifam.toml --output lhifam.svg\n"
      "  zwidth bode devices/lhifam.toml devices/lhifam_rigid.toml --output comparison.pdf\n"
      "  zwidth bode devices/lhifam.toml --set loop.delay=0.25e-3 --output lhifam.csv --points 1000");
  command->callback([arguments, command] {
    for (const char* option : {"--from", "--to", "--points"}) {
      if (command->count(option) > 0 && arguments->output.empty() && !arguments->json) {
        throw BadInput(fmt::format("{}: is for a figure or its numbers; add --output FILE or --json", option));
      }
    }
    run_bode(*arguments);
  });
}

}  // namespace zwidth::cli
