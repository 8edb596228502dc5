// How often identify() is right: records of some sixty kinds, linear and not, from a simulator that shares nothing with it.
//
//   record_campaign [--kinds A,B] [--seeds FIRST:COUNT] [--noises N] [--results FILE] [--time-limit S] [--budget S]
//                   [--method time] [--reasons] [--require] [--list]
//
// One line a record: kind, seed, noise, verdict, lower end, value, upper end, truth, processor seconds, bodies, samples.
// Then, by kind and of all, the figures that the answers are held to. The same seed is the same device and force, whatever
// else is asked; `--noises 3` records each device three times. `--results` keeps the lines in a file, goes on after those
// that stand there, and counts them all: files of several runs may be joined, and `--seeds 1:0` only counts. No record
// begins after the time limit (processor seconds of all); one that takes longer than its budget is `late`. `--require`: exit
// status 1 where a figure is missed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/kinds.hpp"
#include "identification/campaign/recording.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/time_domain.hpp"
#include "zwidth/io/recorded_columns.hpp"

namespace {

using namespace zwidth;
using test::campaign::Case;
using test::campaign::Evidence;
using test::campaign::Kind;

struct Options {
  std::set<std::string> kinds{};  ///< empty: all
  std::uint64_t first = 1;
  std::uint64_t count = 1;
  std::uint64_t noises = 1;
  std::string results{};
  double time_limit = 1e18;
  double budget = 600.0;
  bool in_time = false;
  bool reasons = false;
  bool require = false;
};

/// What became of one record.
struct Line {
  std::string kind;
  std::uint64_t seed = 0;
  std::uint64_t noise = 0;
  std::string verdict = "failed";
  double lower = 0.0;
  double value = 0.0;
  double upper = 0.0;
  double truth = 0.0;
  double seconds = 0.0;
  std::size_t bodies = 0;
  std::size_t samples = 0;

  [[nodiscard]] bool sound() const { return verdict == "sound"; }
  [[nodiscard]] bool answered() const { return sound() || verdict == "doubtful"; }
  /// Both are computed, and written with six digits.
  static constexpr double same = 1.0 + 1e-4;
  [[nodiscard]] bool unsafe() const { return sound() && lower > same * truth; }
  [[nodiscard]] bool holds() const { return answered() && lower <= same * truth && truth <= same * upper; }
  [[nodiscard]] bool is_narrow() const {
    constexpr double share = 0.1;
    return answered() && upper <= (1.0 + share) * value && lower >= (1.0 - share) * value;
  }
  /// A doubt of an answer that is right: within 5 %, on the safe side.
  [[nodiscard]] bool is_false_doubt() const {
    constexpr double right = 0.05;
    return verdict == "doubtful" && lower <= same * truth && std::abs(value / truth - 1.0) <= right;
  }
};

std::optional<Line> read(const std::string& text) {
  Line line;
  std::istringstream words(text);
  if (text.starts_with('#') || !(words >> line.kind >> line.seed >> line.noise >> line.verdict)) return std::nullopt;
  // Infinite ends are read by strtod alone.
  for (double* number : {&line.lower, &line.value, &line.upper, &line.truth, &line.seconds}) {
    std::string word;
    words >> word;
    *number = std::strtod(word.c_str(), nullptr);
  }
  if (!(words >> line.bodies >> line.samples)) return std::nullopt;
  return line;
}

std::string written(const Line& line) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%s %llu %llu %s %.6g %.6g %.6g %.6g %.2f %zu %zu", line.kind.c_str(),
                static_cast<unsigned long long>(line.seed), static_cast<unsigned long long>(line.noise),
                line.verdict.c_str(), line.lower, line.value, line.upper, line.truth, line.seconds, line.bodies,
                line.samples);
  return text.data();
}

struct OverBudget {};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// As a file with these rows is read.
Recording read_back(const test::campaign::Rows& rows) {
  if (rows.times.empty()) return rows.recording;
  RecordedColumns columns{rows.recording.source,
                          {{"t", rows.times},
                           {"force", rows.recording.channels[0].samples},
                           {"position", rows.recording.channels[1].samples}},
                          std::nullopt};
  RecordingOptions options;
  options.columns = {{"force", {}}, {"position", {}}};
  auto recording = read_recording(columns, options);
  if (!recording) throw Error(ErrorCode::invalid_argument, "the rows were not read");
  return *std::move(recording);
}

/// The verdict and the interval of a found device, whatever found it.
template <typename Found>
void take(Line& line, std::string& reasons, const Found& found) {
  line.verdict = found.trust.sound() ? "sound" : found.trust.refused() ? "refused" : "doubtful";
  line.value = line.lower = line.upper = found.analysis.critical.stiffness;
  if (found.analysis.interval) {
    line.lower = found.analysis.interval->lower;
    line.upper = found.analysis.interval->upper;
  }
  for (const std::string& reason : found.trust.reasons) reasons += "#     " + reason + "\n";
}

/// The device and how it was recorded, for who looks into an answer.
std::string described(const Case& made) {
  static const std::array signals{"multisine", "random phase", "noise", "linear chirp", "logarithmic chirp", "square"};
  const auto& e = made.experiment;
  std::array<char, 400> text{};
  std::string what = "#   ";
  for (const auto& body : made.plant.masses) {
    std::snprintf(text.data(), text.size(), "m %.4g b %.4g k %.4g Fc %.3g; ", body.mass, body.damping, body.stiffness,
                  body.friction.coulomb);
    what += text.data();
  }
  for (const auto& joint : made.plant.joints) {
    std::snprintf(text.data(), text.size(), "link k %.4g b %.4g; ", joint.stiffness, joint.damping);
    what += text.data();
  }
  std::snprintf(
      text.data(), text.size(),
      "T %.1f ms, delay %.2f T, lag %.2f T, %s %.2f-%.1f Hz, limit at %.2f Hz, force %.3g, step %.3g, noise %.2f, "
      "disturbance %.4f\n",
      1e3 * e.period, made.plant.drive.delay / e.period, made.plant.drive.lag / e.period,
      signals[static_cast<std::size_t>(e.signal)], e.lowest_hz, e.highest_hz, made.limiting_hz, e.force, e.resolution,
      e.noise, e.disturbance);
  return what + text.data();
}

Line judged(const Case& made, std::uint64_t noise, const Options& options, std::string& reasons) {
  Line line{.kind = made.kind, .seed = made.seed, .noise = noise, .truth = made.stiffness, .bodies = made.named};
  if (options.reasons) reasons += described(made);
  const std::vector<test::campaign::Rows> rows = test::campaign::recorded(made, noise);
  for (const auto& each : rows) line.samples += each.recording.channels[0].samples.size();
  const double begin = processor_seconds();
  const Progress in_budget = [&](double) {
    if (processor_seconds() - begin > options.budget) throw OverBudget{};
  };
  const auto values =
      made.known ? IdentifyOptions::StructureValues::known : IdentifyOptions::StructureValues::placeholders;
  try {
    std::vector<Recording> recordings;
    for (const auto& each : rows) recordings.push_back(read_back(each));
    const Device structure(made.structure);
    if (options.in_time) {
      TimeDomainOptions how;
      how.structure_values = values;
      how.free = made.free;
      how.locked = made.locked;
      take(line, reasons, identify_in_time(recordings, structure, how, in_budget));
    } else {
      IdentifyOptions how;
      how.structure_values = values;
      how.fit.free = made.free;
      how.fit.locked = made.locked;
      take(line, reasons, identify(recordings, structure, how, in_budget));
    }
  } catch (const OverBudget&) {
    line.verdict = "late";
  } catch (const Error& error) {
    reasons += std::string("#     ") + error.what() + "\n";
  }
  line.seconds = processor_seconds() - begin;
  return line;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

using Lines = std::vector<Line>;

std::size_t count(const Lines& lines, const std::function<bool(const Line&)>& of) {
  return static_cast<std::size_t>(std::ranges::count_if(lines, of));
}

void print_row(const std::string& name, const char* marks, const Lines& lines) {
  std::vector<double> seconds;
  std::vector<double> errors;
  std::vector<double> widths;
  for (const Line& line : lines) {
    seconds.push_back(line.seconds);
    if (!line.answered()) continue;
    errors.push_back(100.0 * (line.value / line.truth - 1.0));
    widths.push_back(line.upper / line.lower);
  }
  const std::size_t answered = count(lines, &Line::answered);
  std::printf("%-24s %-4s %5zu %5zu %6zu %6zu %5zu %5zu %6zu %4zu/%-4zu %8.2f %8.3g %8.2f %8.2f\n", name.c_str(), marks,
              lines.size(), count(lines, &Line::sound), count(lines, &Line::unsafe),
              answered - count(lines, &Line::sound), count(lines, &Line::is_false_doubt),
              count(lines, [](const Line& l) { return l.verdict == "refused"; }),
              count(lines, [](const Line& l) { return l.verdict == "failed" || l.verdict == "late"; }),
              count(lines, &Line::holds), answered, quantile(errors, 0.5), quantile(widths, 0.5),
              quantile(seconds, 0.5), quantile(seconds, 1.0));
}

/// One figure beside what it is held to; whether it holds.
bool figure(const char* what, std::size_t part, std::size_t whole, double bound, bool at_most) {
  if (whole == 0) return true;
  const double share = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  const bool holds = at_most ? share <= bound : share >= bound;
  std::printf("%-72s %5zu of %5zu, %5.1f %%, at %s %4.1f %%%s\n", what, part, whole, share, at_most ? "most" : "least",
              bound, holds ? "" : "   MISSED");
  return holds;
}

bool print_figures(const Lines& lines, const std::map<std::string, Kind>& kinds) {
  const auto evidence = [&](const Line& l) { return kinds.at(l.kind).evidence; };
  Lines judged;
  Lines as_docs;
  for (const Line& line : lines) {
    if (evidence(line) != Evidence::none) judged.push_back(line);
    if (kinds.at(line.kind).as_docs) as_docs.push_back(line);
  }
  bool holds = true;
  const std::size_t sound = count(judged, &Line::sound);
  std::printf("\nwhat is held to (without the kinds that no record shows)\n");
  holds &= figure("sound, lower end above the truth", count(judged, &Line::unsafe), sound, 2.5, true);
  const auto far = [](const Line& l) { return l.sound() && l.lower > 1.1 * l.truth; };
  holds &= figure("sound, lower end above the truth by more than 10 %", count(judged, far), sound, 0.0, true);
  holds &=
      figure("intervals that hold the truth", count(judged, &Line::holds), count(judged, &Line::answered), 95.0, false);
  holds &= figure("made as the docs say: sound", count(as_docs, &Line::sound), as_docs.size(), 90.0, false);
  holds &= figure("made as the docs say: within 10 %", count(as_docs, &Line::is_narrow), as_docs.size(), 80.0, false);
  const auto doubtful = [](const Line& l) { return l.verdict == "doubtful"; };
  const auto falsely = [&](const Line& l) { return evidence(l) == Evidence::of_limit && l.is_false_doubt(); };
  holds &= figure("doubts of answers within 5 % on the safe side", count(judged, falsely), count(judged, doubtful),
                  10.0, true);
  const auto narrowly = [&](const Line& l) { return falsely(l) && l.upper <= 1.5 * l.lower; };
  std::printf("  of these with an interval within a factor of 1.5: %zu\n", count(judged, narrowly));

  std::map<std::pair<std::string, std::uint64_t>, std::map<std::string, std::size_t>> verdicts;
  for (const Line& line : lines) ++verdicts[{line.kind, line.seed}][line.verdict];
  std::size_t again = 0;
  std::size_t flips = 0;
  for (const auto& [device, each] : verdicts) {
    std::size_t all = 0;
    std::size_t most = 0;
    for (const auto& [verdict, number] : each) {
      all += number;
      most = std::max(most, number);
    }
    if (all < 2) continue;
    again += all;
    flips += all - most;
  }
  holds &= figure("of one device: another verdict than most, by the noise alone", flips, again, 5.0, true);

  const std::map<std::size_t, double> medians{{1, 0.5}, {2, 2.0}, {3, 10.0}};
  for (const auto& [bodies, most] : medians) {
    std::vector<double> seconds;
    for (const Line& line : lines) {
      constexpr double usual = 10000.0;  // samples: 10 s at 1 kHz
      if (line.bodies == bodies && line.samples > 0) {
        seconds.push_back(line.seconds * usual / static_cast<double>(line.samples));
      }
    }
    if (seconds.empty()) continue;
    const double median = quantile(seconds, 0.5);
    const double longest = quantile(seconds, 1.0);
    const bool fast = median <= most && longest <= 5.0 * most;
    std::printf(
        "processor seconds of 10 000 samples, %zu bodies: median %.2f, at most %.1f; longest %.1f, at most %.1f%s\n",
        bodies, median, most, longest, 5.0 * most, fast ? "" : "   MISSED");
    holds &= fast;
  }
  double most = 0.0;
  for (const Line& line : judged) {
    if (line.unsafe()) most = std::max(most, line.lower / line.truth - 1.0);
  }
  std::printf("the farthest that a sound answer's lower end is above the truth: %.2f %%\n", 100.0 * most);
  return holds;
}

bool print_totals(const Lines& lines, const std::map<std::string, Kind>& kinds) {
  std::printf("\n%-24s %-4s %5s %5s %6s %6s %5s %5s %6s %9s %8s %8s %8s %8s\n", "kind", "", "all", "sound", "unsafe",
              "doubt", "false", "refus", "failed", "holds", "error %", "up/low", "median s", "longest");
  for (const Kind& kind : test::campaign::kinds()) {
    Lines of_kind;
    for (const Line& line : lines) {
      if (line.kind == kind.name) of_kind.push_back(line);
    }
    const char* marks = kind.as_docs                      ? "docs"
                        : kind.evidence == Evidence::open ? "open"
                        : kind.evidence == Evidence::none ? "none"
                                                          : "";
    if (!of_kind.empty()) print_row(kind.name, marks, of_kind);
  }
  print_row("all", "", lines);
  return print_figures(lines, kinds);
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) {
        std::fprintf(stderr, "record_campaign: %s needs a value\n", name.c_str());
        std::exit(2);
      }
      return argv[++i];
    };
    if (name == "--kinds") {
      std::istringstream words(value());
      for (std::string word; std::getline(words, word, ',');) options.kinds.insert(word);
    } else if (name == "--seeds") {
      const std::string range = value();
      options.first = std::strtoull(range.c_str(), nullptr, 10);
      const auto colon = range.find(':');
      if (colon != std::string::npos) options.count = std::strtoull(range.c_str() + colon + 1, nullptr, 10);
    } else if (name == "--noises") {
      options.noises = std::strtoull(value().c_str(), nullptr, 10);
    } else if (name == "--results") {
      options.results = value();
    } else if (name == "--time-limit") {
      options.time_limit = std::strtod(value().c_str(), nullptr);
    } else if (name == "--budget") {
      options.budget = std::strtod(value().c_str(), nullptr);
    } else if (name == "--method") {
      options.in_time = value() == "time";
    } else if (name == "--reasons") {
      options.reasons = true;
    } else if (name == "--require") {
      options.require = true;
    } else if (name == "--list") {
      for (const Kind& kind : test::campaign::kinds()) std::printf("%s\n", kind.name);
      std::exit(0);
    } else {
      std::fprintf(stderr, "record_campaign: no option %s\n", name.c_str());
      std::exit(2);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = options_of(argc, argv);
  std::map<std::string, Kind> kinds;
  for (const Kind& kind : test::campaign::kinds()) kinds.emplace(kind.name, kind);
  for (const std::string& name : options.kinds) {
    if (kinds.contains(name)) continue;
    std::fprintf(stderr, "record_campaign: no kind %s; --list names them\n", name.c_str());
    return 2;
  }
  Lines lines;
  std::set<std::tuple<std::string, std::uint64_t, std::uint64_t>> done;
  if (!options.results.empty()) {
    std::ifstream before(options.results);
    for (std::string text; std::getline(before, text);) {
      const auto line = read(text);
      if (!line || !kinds.contains(line->kind) || !done.insert({line->kind, line->seed, line->noise}).second) continue;
      lines.push_back(*line);
    }
  }
  std::ofstream kept;
  if (!options.results.empty()) kept.open(options.results, std::ios::app);
  for (std::uint64_t seed = options.first; seed < options.first + options.count; ++seed) {
    for (const Kind& kind : test::campaign::kinds()) {
      if (!options.kinds.empty() && !options.kinds.contains(kind.name)) continue;
      for (std::uint64_t noise = 0; noise < options.noises; ++noise) {
        if (done.contains({kind.name, seed, noise}) || processor_seconds() > options.time_limit) continue;
        std::string reasons;
        lines.push_back(judged(test::campaign::drawn_case(kind, seed), noise, options, reasons));
        const std::string text = written(lines.back());
        std::printf("%s%s\n%s", text.c_str(), lines.back().unsafe() ? " UNSAFE" : "",
                    options.reasons ? reasons.c_str() : "");
        std::fflush(stdout);
        if (kept.is_open()) kept << text << '\n' << std::flush;
      }
    }
  }
  const bool holds = print_totals(lines, kinds);
  return options.require && !holds ? 1 : 0;
}
