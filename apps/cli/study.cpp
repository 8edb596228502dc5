#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/device_arguments.hpp"
#include "cli/input_problem.hpp"
#include "cli/option_refusal.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/refused_answer.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/study_figures.hpp"
#include "report/study_report.hpp"
#include "report/text/text_medium.hpp"
#include "results/study_json.hpp"
#include "study/study_engine.hpp"
#include "study/study_result_file.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/study_file.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {
namespace {

struct StudyArguments {
  DeviceArguments devices;
  std::string study;
  std::optional<std::uint64_t> samples;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> sampling;
  std::size_t threads = 0;
  std::optional<std::uint64_t> index_samples;
  std::uint64_t rare_samples = 0;
  std::uint64_t region_units = 0;
  std::string result;
  std::string report;
  std::string worst;
  bool resume = false;
  OutputArguments output{.figure_option = "--figure"};
};

constexpr std::pair<std::string_view, std::string_view> options_of_study[] = {
    {"samples", "--samples"},
    {"threads", "--threads"},
    {"index_samples", "--index-samples"},
    {"rare_samples", "--rare-samples"},
    {"region_units", "--region-units"},
    {"specification.any_user", "--study"},
    {"parameters", "--study"},
    {"specification.critical_stiffness", "--study"}};

StudyOptions options_of(const StudyArguments& arguments, const StudyFile& file) {
  StudyOptions options;
  options.samples = arguments.samples.value_or(file.samples.value_or(options.samples));
  options.seed = arguments.seed.value_or(file.seed.value_or(options.seed));
  options.sampling = file.sampling.value_or(options.sampling);
  if (arguments.sampling) {
    options.sampling = *arguments.sampling == "random"  ? SamplingScheme::random
                       : *arguments.sampling == "sobol" ? SamplingScheme::sobol
                                                        : SamplingScheme::latin_hypercube;
  }
  options.threads = arguments.threads;
  options.index_samples = arguments.index_samples.value_or(options.index_samples);
  options.rare_samples = arguments.rare_samples;
  options.region_units = arguments.region_units;
  options.specification = file.specification;
  return options;
}

/// That are computed in all, the worst one apart.
double units_of(const StudyOptions& options, std::size_t parameters) {
  const auto count = static_cast<double>(parameters);
  return static_cast<double>(options.samples) + static_cast<double>(options.rare_samples) +
         static_cast<double>(region_grid_points * options.region_units) +
         (count + 2.0) * static_cast<double>(options.index_samples) +
         (count + 1.0) * static_cast<double>(std::min(options.samples, options.tightening_samples));
}

/// "12 k units/s, 3 min left"
std::string rate_text(double done, double of, double seconds) {
  const double rate = done / seconds;
  const double left = (of - done) / rate;
  const std::string time = left < 90.0     ? fmt::format("{:.0f} s", left)
                           : left < 5400.0 ? fmt::format("{:.0f} min", left / 60.0)
                                           : fmt::format("{:.1f} h", left / 3600.0);
  return fmt::format("{}, {} left", quantity(rate, "units/s"), time);
}

std::optional<Study> studied(const StudyRun& run, const StudyArguments& arguments) {
  if (arguments.result.empty()) {
    ProgressLine line(*arguments.devices.command, "studying " + arguments.devices.files.front());
    return study(run.device(), run.distributions(), run.options(), line.progress());
  }
  using Clock = std::chrono::steady_clock;
  const auto begun = Clock::now();
  ProgressLine line(*arguments.devices.command, "studying " + arguments.devices.files.front());
  const Progress computing = line.progress(0.0, 0.9);
  const auto of_ranks = static_cast<double>(study_engine::team().size());
  const auto progress = [&](std::uint64_t done, std::uint64_t of) {
    if (!computing) return;
    const double units = static_cast<double>(done * study_chunk_size) * of_ranks;  // the others are as fast
    const double all = static_cast<double>(of * study_chunk_size);
    line.note(rate_text(std::min(units, all), all, std::chrono::duration<double>(Clock::now() - begun).count()));
    computing(std::min(1.0, units / all));
  };
  const auto start =
      arguments.resume ? study_engine::StudyCheckpoint::Start::resumed : study_engine::StudyCheckpoint::Start::fresh;
  try {
    return study_engine::run_study(run, arguments.result, start, progress, line.progress(0.9, 1.0));
  } catch (const study_engine::CheckpointProblem& problem) {
    throw BadInput("--output", problem.what());
  }
}

void run_study(const StudyArguments& arguments) {
  Outputs outputs(*arguments.devices.command);
  outputs.add("--output", arguments.result, Ending::hdf5);
  outputs.add(arguments.output);
  outputs.add("--report", arguments.report, Ending::page);
  outputs.add("--output-device", arguments.worst);
  outputs.keep(arguments.devices.files, "device file");
  outputs.keep(arguments.study, "study file");
  if (arguments.resume && arguments.result.empty()) {
    throw BadInput("--resume", "goes on with a result that was begun", "add --output FILE.h5");
  }
  if (study_engine::team().size() > 1 && arguments.result.empty()) {
    throw BadInput("--output", "several processes meet at a result on a disk that all see", "add --output FILE.h5");
  }
  if (!arguments.result.empty()) study_engine::require_writer();
  Device device = std::move(read_devices(arguments.devices).front());
  auto file = read_named_study(*arguments.devices.command, arguments.study, device);
  if (!file) refuse_input(file.error());
  const StudyOptions options = options_of(arguments, *file);
  if (const auto problem = find_problem(options, device, file->distributions)) refuse(*problem, options_of_study);
  if (arguments.result.empty() && options.samples > most_samples_in_memory) {
    throw BadInput("--samples", fmt::format("is {}", options.samples),
                   CommandText(fmt::format("at most {}", most_samples_in_memory)) +
                       CommandText(" without --output, which keeps them on the disk"));
  }
  check_threads(*arguments.devices.command, "--threads", options.threads);
  check_samples(*arguments.devices.command, "--samples", units_of(options, file->distributions.parameters.size()));
  const StudyRun run(std::move(device), std::move(file->distributions), options);
  const std::optional<Study> study = studied(run, arguments);
  if (!study) return;  // the first rank tells
  if (study->trust.refused()) {
    return print_refused(outputs, study->trust, run.device().name(),
                         arguments.output.json ? results::line(results::study_json(run, *study)) : "",
                         {arguments.report, arguments.worst, arguments.output.csv, arguments.output.figure});
  }
  if (!arguments.worst.empty() && !study->worst)
    throw WorkFailed("--output-device: no unit has a limit: there is no worst one");
  outputs.put("--report", [&] { return report::study_page(run, *study); });
  outputs.put("--csv", [&] { return results::study_csv(*study); });
  const std::optional<report::FigureFormat> format = outputs.figure("--figure");
  const auto figure = format ? report::draw_study_distribution(run, *study, *format) : std::nullopt;
  if (figure) outputs.draw("--figure", [&](const report::FigureFormat&) { return *figure; });
  outputs.put("--output-device", [&] { return report::worst_device_file(*study); });
  if (study->worst) hand_over_device(*arguments.devices.command, report::worst_device_file(*study));
  outputs.commit();
  outputs.print(arguments.output.json ? results::line(results::study_json(run, *study))
                                      : report::for_medium(report::study_text(run, *study)));
  if (format && !figure) {
    throw WorkFailed("--figure: the finite limits of the units do not differ: there is nothing to draw");
  }
}

}  // namespace

void add_study(CLI::App& app) {
  auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = app.add_subcommand(
      "study", "How the limit varies over many units: yield, the worst unit, which tolerance to tighten");
  add_device_arguments(*command, arguments->devices, FileCount::one);
  command->add_option("--study", arguments->study, "What varies, and what every unit must reach (TOML)")
      ->type_name("FILE")
      ->required();
  command->add_option("--samples", arguments->samples, "Units; instead of the study's own (default: 10 000)")
      ->type_name("N");
  command->add_option("--seed", arguments->seed, "Of the random numbers (default: 1)")->type_name("N");
  command->add_option("--sampling", arguments->sampling, "random, latin-hypercube or sobol (default: random)")
      ->type_name("HOW")
      ->check(CLI::IsMember({"random", "latin-hypercube", "sobol"}));
  command
      ->add_option("--index-samples", arguments->index_samples,
                   "Points of each set of Sobol indices; 0: none (default: 1024)")
      ->type_name("N");
  command
      ->add_option("--rare-samples", arguments->rare_samples,
                   "Rare failures by importance sampling with N units: one in a thousand")
      ->type_name("N");
  command
      ->add_option("--region-units", arguments->region_units,
                   "Walls (K, B) that 99, 50 and 1 % of the first N units render")
      ->type_name("N");
  command->add_option("--threads", arguments->threads, "0: all cores; no result depends on it (default: 0)")
      ->type_name("N");
  command->add_option("-o,--output", arguments->result, "Also write every unit, as HDF5")->type_name("FILE");
  command->add_flag("--resume", arguments->resume, "Go on with the --output of a run that was ended");
  command->add_option("--report", arguments->report, "Also write a page with figures: .html")->type_name("FILE");
  command->add_option("--output-device", arguments->worst, "Also write the worst unit as a device file")
      ->type_name("FILE");
  add_output_options(*command, arguments->output,
                     {.csv = "Also write units, at most 2000 of them, evenly apart",
                      .figure = "Also draw how the limit varies: .svg, .png or .pdf"});
  command->footer(
      "Examples:\n"
      "  zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml\n"
      "  zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --output-device worst.toml\n"
      "  zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --output units.h5\n"
      "  zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --report study.html");
  command->callback([arguments] { run_study(*arguments); });
}

}  // namespace zwidth::cli
