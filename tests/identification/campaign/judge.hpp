#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "identification/campaign/bench.hpp"
#include "identification/campaign/recording.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/io/recorded_columns.hpp"
#include "zwidth/progress.hpp"

/// What identify() makes of a record of the campaign.
namespace zwidth::test::campaign {

/// `identify`: what the motion shows; `lines`: what the lines of its response show, of a linear device; `response`: the limit
/// that they show without a structure.
enum class Method { identify, lines, response };

struct JudgeOptions {
  Method method = Method::identify;
  double budget = 600.0;  ///< processor seconds of one record
  bool reasons = false;   ///< with the device, how it was recorded and why the answer is doubtful
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

inline std::optional<Line> line_of(const std::string& text) {
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

inline std::string text_of(const Line& line) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%s %llu %llu %s %.6g %.6g %.6g %.6g %.2f %zu %zu", line.kind.c_str(),
                static_cast<unsigned long long>(line.seed), static_cast<unsigned long long>(line.noise),
                line.verdict.c_str(), line.lower, line.value, line.upper, line.truth, line.seconds, line.bodies,
                line.samples);
  return text.data();
}

namespace detail {

struct OverBudget {};

inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// As a file with these rows is read.
inline Recording read_back(const Rows& rows) {
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

inline void take(Line& line, std::string& reasons, const Trust& trust) {
  line.verdict = trust.sound() ? "sound" : trust.refused() ? "refused" : "doubtful";
  for (const std::string& reason : trust.reasons) reasons += "#     " + reason + "\n";
}

/// The verdict and the interval of a found device, whatever found it.
template <typename Found>
void take(Line& line, std::string& reasons, const Found& found) {
  take(line, reasons, found.trust);
  line.value = line.lower = line.upper = found.analysis.critical.stiffness;
  if (found.analysis.interval) {
    line.lower = found.analysis.interval->lower;
    line.upper = found.analysis.interval->upper;
  }
}

/// Those of a response.
inline void take(Line& line, std::string& reasons, const MeasuredResponse& found) {
  take(line, reasons, found.trust);
  if (!found.stiffness || !found.stiffness->limit) return;
  line.value = line.lower = line.upper = found.stiffness->limit->stiffness;
  if (const auto interval = stiffness_interval(*found.stiffness)) {
    line.lower = interval->lower;
    line.upper = interval->upper;
  }
}

/// The device and how it was recorded, for who looks into an answer.
inline std::string described(const Case& made) {
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
      "disturbance %.4f, any user's limit %.4g\n",
      1e3 * e.period, made.plant.drive.delay / e.period, made.plant.drive.lag / e.period,
      signals[static_cast<std::size_t>(e.signal)], e.lowest_hz, e.highest_hz, made.limiting_hz, e.force, e.resolution,
      e.noise, e.disturbance, any_user_limit(made));
  return what + text.data();
}

}  // namespace detail

/// The answer to the recordings of this noise, and what is to say of it.
inline Line judged(const Case& made, std::uint64_t noise, const JudgeOptions& options, std::string& reasons) {
  Line line{.kind = made.kind, .seed = made.seed, .noise = noise, .truth = made.stiffness, .bodies = made.named};
  if (options.reasons) reasons += detail::described(made);
  const std::vector<Rows> rows = recorded(made, noise);
  for (const auto& each : rows) line.samples += each.recording.channels[0].samples.size();
  const double begin = detail::processor_seconds();
  const Progress in_budget = [&](double) {
    if (detail::processor_seconds() - begin > options.budget) throw detail::OverBudget{};
  };
  const auto values =
      made.known ? IdentifyOptions::StructureValues::known : IdentifyOptions::StructureValues::placeholders;
  try {
    std::vector<Recording> recordings;
    for (const auto& each : rows) recordings.push_back(detail::read_back(each));
    const Device structure(made.structure);
    if (options.method == Method::response) {
      detail::take(line, reasons, frequency_response(recordings, {}, in_budget));
    } else {
      IdentifyOptions how;
      how.structure_values = values;
      how.fit.free = made.free;
      how.fit.locked = made.locked;
      if (options.method == Method::lines) how.method = IdentifyOptions::Method::lines;
      detail::take(line, reasons, identify(recordings, structure, how, in_budget));
    }
  } catch (const detail::OverBudget&) {
    line.verdict = "late";
  } catch (const Error& error) {
    reasons += std::string("#     ") + error.what() + "\n";
  }
  line.seconds = detail::processor_seconds() - begin;
  return line;
}

}  // namespace zwidth::test::campaign
