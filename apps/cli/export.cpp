#include "report/export.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/device_arguments.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/output_file.hpp"

namespace zwidth::cli {
namespace {

struct ExportArguments {
  DeviceArguments devices;
  std::string format;
  std::string output;
};

std::string exported(const report::ExportedModel& model, const std::string& format) {
  if (format == "octave") return export_octave(model);
  if (format == "python") return export_python(model);
  return export_json(model).dump() + "\n";
}

void run_export(const ExportArguments& arguments) {
  check_output_is_no_input(arguments.devices, "--output", arguments.output);
  const auto devices = analyze_devices(arguments.devices);
  const std::string text = exported(report::exported_model(devices.front()), arguments.format);
  if (arguments.output.empty() || arguments.output == "-") {
    write_standard_output(text);
  } else {
    report::write_whole(arguments.output, text);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "The continuous and the exact discrete model for Octave, Python (SciPy) or as JSON");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command->add_option("--format", arguments->format, "octave, python or json")
      ->type_name("FORMAT")
      ->required()
      ->check(CLI::IsMember({"octave", "python", "json"}));
  command->add_option("-o,--output", arguments->output, "File to write; standard output unless given")
      ->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  zwidth export devices/lhifam.toml --format octave --output lhifam.m\n"
      "  zwidth export devices/lhifam.toml --format python --output lhifam.py\n"
      "  zwidth export devices/lhifam.toml --format json --set loop.delay=0.25e-3");
  command->callback([arguments] { run_export(*arguments); });
}

}  // namespace zwidth::cli
