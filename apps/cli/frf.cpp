#include <fmt/format.h>

#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/response_arguments.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/figures.hpp"
#include "report/text/frf_text.hpp"
#include "results/frf_json.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {
namespace {

struct FrfArguments {
  ResponseArguments response;
  std::string force_unit;     ///< empty: as the column's name states it
  std::string position_unit;  ///< likewise
  OutputArguments output;
  bool points = false;
};

results::FrfUnits units_of(const FrfArguments& arguments, const MeasuredResponse& frf) {
  constexpr std::pair<std::string_view, std::string_view> own_options[] = {{"force_unit", "--force-unit"},
                                                                           {"length_unit", "--position-unit"}};
  if (const auto problem = find_problem(arguments.force_unit, arguments.position_unit, frf))
    refuse(*problem, own_options);
  results::FrfUnits units = results::frf_units(frf);
  if (!arguments.force_unit.empty()) units.force = arguments.force_unit;
  if (!arguments.position_unit.empty()) units.position = arguments.position_unit;
  return units;
}

void run_frf(const FrfArguments& arguments) {
  const RecordingArguments& recording = arguments.response.recording;
  if (recording.list) return write_contents(recording, arguments.output.json);
  Outputs outputs(*arguments.response.command, arguments.output);
  if (arguments.points && !arguments.output.json)
    throw BadInput("--points", "is for JSON", "add --json, or use --csv FILE");
  outputs.keep(recording.file, "recording");
  for (const std::string& file : recording.more) outputs.keep(file, "recording");

  const MeasuredResponse frf = measured_response(response_source(arguments.response));
  const results::FrfUnits units = units_of(arguments, frf);
  outputs.put("--csv", [&] { return results::frf_csv(frf); });
  outputs.draw("--output", [&](report::FigureFormat format) { return report::draw_frf(frf, units, format); });
  outputs.commit();
  if (arguments.output.json) {
    const auto content = arguments.points ? results::FrfContent::with_lines : results::FrfContent::summary;
    outputs.print(results::line(results::frf_json(frf, units, content)));
  } else {
    outputs.print_text(report::frf_text(frf, units, arguments.output.findings));
  }
}

}  // namespace

void add_frf(CLI::App& app) {
  auto arguments = std::make_shared<FrfArguments>();
  CLI::App* command =
      app.add_subcommand("frf", "Measured frequency response of a recording, and the critical stiffness it shows");
  add_response_arguments(*command, arguments->response);
  command->add_option("--force-unit", arguments->force_unit, "For the report; else of the column's name, else N")
      ->type_name("UNIT");
  command->add_option("--position-unit", arguments->position_unit, "Likewise; else of the column's name, else m")
      ->type_name("UNIT");
  add_output_options(*command, arguments->output,
                     {.csv = "Also write the lines of the response",
                      .figure = "Also draw a figure: .svg, .png or .pdf",
                      .explain = explain_help});
  command->add_flag("--points", arguments->points, "With --json: the lines of the response too");
  command->footer(
      "Examples:\n"
      "  zwidth frf recordings/locked_chirp.csv --list\n"
      "  zwidth frf recordings/locked_chirp.csv --force force --position position --output frf.svg\n"
      "  zwidth frf recordings/locked_chirp.csv --force 2 --position 3 --rate 1000 --csv frf.csv --json\n"
      "  zwidth frf frf.csv --table --magnitude magnitude --phase phase_deg --rate 1000");
  command->callback([arguments] { run_frf(*arguments); });
}

}  // namespace zwidth::cli
