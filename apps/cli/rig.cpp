#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "cli/flight_file.hpp"
#include "cli/input_problem.hpp"
#include "cli/live_line.hpp"
#include "cli/option_refusal.hpp"
#include "cli/place_of_damper.hpp"
#include "cli/progress_line.hpp"
#include "cli/rig_arguments.hpp"
#include "cli/subcommand.hpp"
#include "report/figure/rig_figures.hpp"
#include "report/page/rig_page.hpp"
#include "report/text/rig_text.hpp"
#include "report/text/text_medium.hpp"
#include "report/text/trust_text.hpp"
#include "results/csv.hpp"
#include "results/rig_json.hpp"
#include "rig/open_driver.hpp"
#include "rig/rig_actions.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::cli {
namespace {

constexpr double checked_duration = 2.0;  // s

/// Options by the member that they set.
constexpr std::pair<std::string_view, std::string_view> options_of_rig[] = {{"force", "--force-limit"},
                                                                            {"position", "--position-limit"},
                                                                            {"velocity", "--velocity-limit"},
                                                                            {"saturation_duration", "--saturation"},
                                                                            {"ramp", "--ramp"},
                                                                            {"missed_cycles", "--missed-cycles"},
                                                                            {"amplitude", "--amplitude"},
                                                                            {"relay.amplitude", "--amplitude"},
                                                                            {"relay.hysteresis", "--hysteresis"},
                                                                            {"hysteresis", "--hysteresis"},
                                                                            {"lowest_hz", "--lowest-hz"},
                                                                            {"highest_hz", "--highest-hz"},
                                                                            {"duration", "--duration"},
                                                                            {"start", "--from"},
                                                                            {"ceiling", "--ceiling"},
                                                                            {"stiffness", "--stiffness"},
                                                                            {"trials", "--trials"}};

/// What all actions work with.
struct Rig {
  const RigArguments& arguments;
  Device device;
  Trust trust;  ///< of the device's analysis
  Outputs& outputs;
  rig::RigOptions options;
  std::unique_ptr<rig::Driver> driver;
  const std::string& lost_record;  ///< why the flight record is not in the file that was named; empty: it is
  std::optional<bool> watchdog_proved = {};
};

void check_duration(const std::optional<double>& duration, const Device& device) {
  if (!duration) return;
  const double cycles = *duration / device.loop().sampling_period;
  if (!(cycles >= 1.0 && cycles <= max_simulated_samples)) {
    throw BadInput("--duration", fmt::format("is {} s", *duration),
                   fmt::format("1 to {:.0e} sampling periods", max_simulated_samples));
  }
}

/// A refused device never runs, a doubtful one if that is accepted, an unstable wall if that is.
void check_permission(const RigArguments& arguments, const Trust& trust) {
  const std::string& file = arguments.devices.files.front();
  if (trust.sound() || (!trust.refused() && arguments.accept_doubt)) return;
  throw WorkFailed(file,
                   report::verdict_text(trust) + (trust.refused() ? "" : "; --accept-doubt acts on it all the same"));
}

rig::RigOptions rig_options(const RigArguments& arguments, const Device& device) {
  rig::RigOptions options;
  options.limits = arguments.limits;
  options.nudge = !arguments.no_nudge;
  const auto declared = device.parameters().actuator.force_limit;
  if (!options.limits.force) options.limits.force = declared;
  if (declared && options.limits.force && *options.limits.force > *declared) {
    throw BadInput("--force-limit", fmt::format("is {}", *options.limits.force),
                   fmt::format("at most actuator.force_limit, {}", *declared));
  }
  if (const auto problem = find_problem(options.limits)) refuse(*problem, options_of_rig);
  if (arguments.driver == "simulated") return options;
  if (!options.limits.force)
    throw BadInput("--force-limit", "missing", "a device on a bench needs one, or actuator.force_limit");
  if (!options.limits.position) throw BadInput("--position-limit", "missing", "a device on a bench needs one");
  return options;
}

double amplitude_of(const Rig& rig) {
  const double amplitude = rig.arguments.amplitude.value_or(rig::default_force(rig.device, rig.options.limits.force));
  if (!(std::isfinite(amplitude) && amplitude > 0.0)) {
    throw BadInput("--amplitude", fmt::format("is {}", amplitude), "a force in N or N m above 0");
  }
  if (rig.options.limits.force && amplitude > *rig.options.limits.force) {
    throw BadInput("--amplitude", fmt::format("is {}", amplitude),
                   fmt::format("at most the force limit, {}", *rig.options.limits.force));
  }
  return amplitude;
}

/// Writes what was asked for (`put`: beside the report), and prints the answer: a device cannot be asked again, so that a
/// file that fails does not take the answer with it. A rig that stopped has failed.
template <typename Result>
void answer(
    const Rig& rig, const Result& result, const RigSession& session, const std::function<void()>& put = [] {}) {
  std::string lost = rig.lost_record;
  try {
    put();
    rig.outputs.put("--report", [&] { return report::rig_page(rig.device, result); });
    rig.outputs.commit();
  } catch (const report::OutputFailed& failure) {
    lost = failure.what();
  }
  if constexpr (requires { report::draw_rig(rig.device, result, report::FigureFormat::svg); }) {
    try {  // by itself: a rig that stopped has a page, and nothing to draw
      rig.outputs.draw("--figure",
                       [&](report::FigureFormat format) { return report::draw_rig(rig.device, result, format); });
      rig.outputs.commit();
    } catch (const report::OutputFailed& failure) {
      if (lost.empty()) lost = failure.what();
    }
  }
  if (rig.arguments.output.json) {
    rig.outputs.warn(session.remarks);
    if constexpr (requires { result.remarks; }) rig.outputs.warn(result.remarks);
    rig.outputs.print(results::line(results::rig_json(rig.device, result)));
  } else {
    rig.outputs.print_text(report::rig_text(rig.device, result));
  }
  if (session.stop == StopReason::none && lost.empty()) return;
  if (session.stop == StopReason::none) throw report::OutputFailed(lost);
  if (!lost.empty()) rig.outputs.tell(fmt::format("zwidth: {}\n", lost));
  throw WorkFailed("the rig stopped: " + explanation(session));
}

rig::MeasureOptions measure_options(const Rig& rig) {
  rig::MeasureOptions options = rig::default_measurement(rig.device);
  ExcitationOptions& excitation = options.excitation;
  excitation.amplitude = amplitude_of(rig);
  if (rig.arguments.lowest_hz) excitation.lowest_hz = *rig.arguments.lowest_hz;
  if (rig.arguments.highest_hz) excitation.highest_hz = *rig.arguments.highest_hz;
  if (rig.arguments.duration) excitation.duration = *rig.arguments.duration;
  if (const auto problem = find_problem(excitation, rig.device)) refuse(*problem, options_of_rig);
  return options;
}

std::string recording_csv(const Recording& recording) {
  results::Csv csv({"time_s", "force", "position"});
  if (recording.channels.size() != 2) return csv.text();
  for (std::size_t k = 0; k < recording.channels[0].samples.size(); ++k) {
    csv.row(results::Rounded{static_cast<double>(k) * recording.sampling_period, 12}, recording.channels[0].samples[k],
            recording.channels[1].samples[k]);
  }
  return csv.text();
}

/// The device of the file with the delay that was measured, and how it was.
std::string measured_device(const Rig& rig, const RigCheck& result) {
  DeviceParameters parameters = rig.device.parameters();
  const LoopTiming& timing = result.session.timing;
  parameters.loop.delay = timing.delay.p50;
  return fmt::format(
             "# loop.delay: from asking for the position to having sent the force, the middle of {} cycles of rig "
             "check "
             "on\n# {}; 99 %: {:.3g} s. Cycles began up to {:.3g} s late (99 %): simulate --jitter {:.3g}\n",
             timing.delay.count, rig.arguments.driver, timing.delay.p99, timing.latency.p99, timing.latency.p99) +
         write_device(parameters);
}

/// What a study takes for its distribution "file".
std::string delays_text(const Rig& rig, const LoopTiming& timing) {
  std::string text =
      fmt::format("# unit: s\n# from asking for the position to having sent the force, {} cycles of rig check on {}\n",
                  timing.delay.count, rig.arguments.driver);
  for (const DurationCount& each : timing.delays) text += fmt::format("{} {}\n", each.duration, each.count);
  return text;
}

void run_check(const Rig& rig) {
  const double duration = rig.arguments.duration.value_or(checked_duration);
  RigCheck result = rig::check(rig.device, *rig.driver, rig.options, duration);
  result.watchdog_proved = rig.watchdog_proved;
  answer(rig, result, result.session, [&] {
    if (result.session.stop != StopReason::none) return;
    rig.outputs.put("--output-device", [&] { return measured_device(rig, result); });
    rig.outputs.put("--delays", [&] { return delays_text(rig, result.session.timing); });
  });
}

void run_measure(const Rig& rig) {
  const rig::MeasureOptions options = measure_options(rig);
  ProgressLine line(*rig.arguments.devices.command, "measuring");
  const RigMeasurement result = rig::measure(rig.device, *rig.driver, rig.options, options, line.progress());
  answer(rig, result, result.session, [&] {
    if (result.response) rig.outputs.put("--recording", [&] { return recording_csv(result.recording); });
  });
}

void run_identify(const Rig& rig) {
  const rig::MeasureOptions options = measure_options(rig);
  ProgressLine line(*rig.arguments.devices.command, "identifying");
  const RigIdentification result = rig::identify_on_rig(rig.device, *rig.driver, rig.options, options, line.progress());
  answer(rig, result, result.measurement.session, [&] {
    if (!result.identification) return;
    rig.outputs.put("--recording", [&] { return recording_csv(result.measurement.recording); });
    rig.outputs.put("--output-device", [&] {
      return write_device(result.identification->fit.device.parameters(), result.identification->remarks);
    });
  });
}

void run_relay_on_rig(const Rig& rig) {
  rig::RelayTrialsOptions options;
  options.relay = {amplitude_of(rig), rig.arguments.hysteresis};
  options.trials = rig.arguments.trials;
  options.seek_limit = rig.arguments.seek_limit;
  options.damper_on_drive = rig.arguments.damper_on_drive;
  if (rig.arguments.duration) options.duration = *rig.arguments.duration;
  RelayOptions simulated;
  simulated.relay = options.relay;
  simulated.duration = options.duration;
  simulated.trials = options.trials;
  if (const auto problem = find_problem(simulated, rig.device)) refuse(*problem, options_of_rig);
  ProgressLine line(*rig.arguments.devices.command, "relay");
  const RigRelay result = rig::relay_on_rig(rig.device, *rig.driver, rig.options, options, line.progress());
  answer(rig, result, result.session);
}

/// What work() returns; meanwhile people see what the loop does.
template <typename Work>
auto watched(const Rig& rig, const Work& work) {
  LiveLine line(units_of(rig.device.parameters().motion), !rig.driver->facts().lock_step);
  rig::RigOptions own = rig.options;
  own.watcher = [&line](const rig::LiveState& state) { line.show(state); };
  return work(own);
}

void run_wall(const Rig& rig) {
  const RigArguments& arguments = rig.arguments;
  rig::WallOptions options;
  options.controller = wall_controller(rig.device.parameters().wall);
  if (arguments.contact == "unilateral") options.controller.contact = ControllerOptions::Contact::unilateral;
  if (arguments.duration) options.duration = *arguments.duration;
  options.damper_on_drive = arguments.damper_on_drive;
  if (arguments.amplitude || arguments.driver == "simulated") options.impulse = amplitude_of(rig);
  const RigWall result =
      watched(rig, [&](const rig::RigOptions& own) { return rig::render_wall(rig.device, *rig.driver, own, options); });
  answer(rig, result, result.session);
  if (result.oscillates) throw WorkFailed("an oscillation grew: the wall was taken away");
  if (result.grows && result.predicted_stable == false) {
    throw WorkFailed("the wall is UNSTABLE: its oscillation grows, too slowly to be taken away");
  }
}

void run_limit(const Rig& rig) {
  const RigArguments& arguments = rig.arguments;
  rig::LimitOptions options = rig::default_limit(rig.device);
  options.damper_on_drive = arguments.damper_on_drive;
  if (arguments.from) options.search.start = *arguments.from;
  if (arguments.ceiling) options.search.ceiling = *arguments.ceiling;
  if (arguments.duration) options.dwell = *arguments.duration;
  options.impulse = amplitude_of(rig);
  if (options.search.start == 0.0 || options.search.ceiling == 0.0) {
    throw BadInput("", "--from, --ceiling: missing", "no finite limit is predicted to search around");
  }
  if (const auto problem = find_problem(options.search)) refuse(*problem, options_of_rig);
  const RigLimit result = watched(
      rig, [&](const rig::RigOptions& own) { return rig::measure_limit(rig.device, *rig.driver, own, options, {}); });
  answer(rig, result, result.session);
}

/// With the stiffness that is to run, where the command line gives one.
Device rig_device(const RigArguments& arguments) {
  Device device = std::move(read_devices(arguments.devices).front());
  if (!arguments.stiffness) return device;
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = arguments.stiffness;
  if (const auto problem = find_problem(parameters)) {
    throw BadInput("--stiffness", problem->what, problem->allowed);
  }
  return Device(parameters);
}

void check_wall(const RigArguments& arguments, const Device& device, const Analysis& analysis) {
  const std::string& file = arguments.devices.files.front();
  if (!device.parameters().wall.stiffness) {
    refuse_key(file, "wall.stiffness", "is missing: there is no wall to render", "set it, or give --stiffness");
  }
  if (!analysis.wall_stable_for || arguments.accept_unstable) return;
  if (const std::string holders = unstable_with(*analysis.wall_stable_for); !holders.empty()) {
    throw WorkFailed(fmt::format(
        "{}: the wall is UNSTABLE by linear analysis, {}; --accept-unstable renders it all the same", file, holders));
  }
}

/// Falls silent before any force goes out: whoever dies later must not leave one behind.
std::optional<bool> proved_watchdog(const RigArguments& arguments, rig::Driver& driver) {
  if (arguments.driver == "simulated") return std::nullopt;
  const std::optional<bool> proved = driver.proves_watchdog();
  if (!proved.value_or(false) && !arguments.no_watchdog) {
    throw WorkFailed(arguments.driver +
                     ": the drive did not let go after silence: if this program died, its force would stay; give its "
                     "firmware a watchdog; --no-watchdog acts on it all the same");
  }
  return proved;
}

void add_outputs(const RigArguments& arguments, Outputs& outputs) {
  outputs.add(arguments.output);
  outputs.add("--recording", arguments.recording);
  outputs.add("--output-device", arguments.output_device);
  outputs.add("--delays", arguments.delays);
  outputs.add("--report", arguments.report, Ending::page);
}

void run_rig(const RigArguments& arguments) {
  const CLI::App& command = *arguments.devices.command;
  Outputs outputs(command);
  Outputs flight(command);  // by itself: what goes wrong with the rest must not lose it
  flight.add("--flight-record", arguments.flight_record);
  add_outputs(arguments, outputs);
  Outputs all(command);  // each is a file of its own
  add_outputs(arguments, all);
  all.add("--flight-record", arguments.flight_record);
  all.keep(arguments.devices.files, "device file");
  const Device device = rig_device(arguments);
  check_duration(arguments.duration, device);
  rig::RigOptions options = rig_options(arguments, device);
  check_place_of_damper(arguments, device);
  const bool has_wall = arguments.action == "wall";  // whose certainty counts
  const Analysis analysis = analyze(device, has_wall ? AnalysisOptions{.any_user = false} : limit_and_wall_only());
  check_permission(arguments, analysis.trust);
  if (has_wall) check_wall(arguments, device, analysis);
  all.require_writable();
  std::string lost_record;
  options.record = [&](const rig::FlightRecorder& recorder, StopReason stop) {
    if (arguments.flight_record.empty()) {
      if (stop != StopReason::none) keep_flight_record(command, recorder);
      return;
    }
    try {
      flight.put("--flight-record", [&](const report::Sink& sink) { recorder.write(sink); });
      flight.commit();
    } catch (const report::OutputFailed& failure) {
      keep_flight_record(command, recorder);  // it cannot be made again
      lost_record = failure.what();
      return;
    }
    if (stop != StopReason::none) {
      outputs.tell(fmt::format("zwidth: flight record: {}\n", arguments.flight_record));
    }
  };
  Rig rig{arguments,          device,
          analysis.trust,     outputs,
          std::move(options), rig::open_driver(arguments.driver, device, {arguments.start, arguments.real_time}),
          lost_record};
  if (const auto watchdog = rig.driver->facts().watchdog; watchdog && !rig.driver->facts().lock_step) {
    const auto problem = find_problem(rig.options.limits, device.loop().sampling_period, *watchdog);
    if (problem) refuse(*problem, options_of_rig);
  }
  rig.watchdog_proved = proved_watchdog(arguments, *rig.driver);
  if (arguments.action == "check") return run_check(rig);
  if (arguments.action == "measure") return run_measure(rig);
  if (arguments.action == "identify") return run_identify(rig);
  if (arguments.action == "relay") return run_relay_on_rig(rig);
  if (arguments.action == "wall") return run_wall(rig);
  run_limit(rig);
}

}  // namespace

void add_rig(CLI::App& app) {
  auto arguments = std::make_shared<RigArguments>();
  CLI::App* command = app.add_subcommand("rig", "The loop on a device, a simulated one unless a driver is named");
  add_rig_arguments(*command, *arguments);
  command->footer(
      "Whatever goes wrong, the force goes to zero and the exit status is 1.\n"
      "\n"
      "Examples:\n"
      "  zwidth rig check devices/lhifam.toml\n"
      "  zwidth rig limit devices/lhifam.toml --flight-record flight.csv\n"
      "  zwidth rig wall devices/lhifam.toml --stiffness 4000 --json\n"
      "  zwidth rig identify devices/lhifam.toml --recording run.csv --output-device found.toml\n"
      "  zwidth rig relay devices/lhifam.toml --amplitude 5 --report relay.html");
  command->callback([arguments, command] {
    check_rig_arguments(*command, *arguments);
    try {
      run_rig(*arguments);
    } catch (const rig::DriverFailed& problem) {
      throw WorkFailed(arguments->driver + ": " + problem.what());
    } catch (const Error& error) {
      if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(error.what());
      throw refused_by(error, arguments->devices.files.front());
    }
  });
}

}  // namespace zwidth::cli
