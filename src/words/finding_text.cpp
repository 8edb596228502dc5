#include "zwidth/words/finding_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "words/percent.hpp"
#include "words/phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth {
using namespace internal;
namespace {

const std::map<FindingCode, Phrase>& phrases() {
  static const std::map<FindingCode, Phrase> all = [] {
    std::map<FindingCode, Phrase> result;
    for (const std::span<const Phrase> room :
         {model_phrases(), stability_phrases(), design_phrases(), design_reason_phrases(), study_phrases(),
          simulation_phrases(), relay_phrases(), rig_phrases(), signal_phrases(), io_phrases(), response_phrases(),
          identification_phrases()}) {
      for (const Phrase& phrase : room) result.emplace(phrase.code, phrase);
    }
    return result;
  }();
  return all;
}

const Phrase& phrase_of(FindingCode code) {
  const auto found = phrases().find(code);
  if (found == phrases().end()) {
    throw Error(ErrorCode::invalid_argument, fmt::format("finding code {} has no words", static_cast<int>(code)));
  }
  return found->second;
}

// "12 ms": what fits the size of a time.
std::string time_text(double time) {
  const double size = std::abs(time);
  if (size > 0.0 && size < 1e-3) return fmt::format("{:.4g} us", time * 1e6);
  if (size > 0.0 && size < 1.0) return fmt::format("{:.4g} ms", time * 1e3);
  return fmt::format("{:.6g} s", time);
}

// A quantity with the units of both motions.
std::string measure_text(std::string_view measure) {
  static constexpr std::array measures{std::pair{"force", "a force in N or N m"},
                                       std::pair{"position", "a position in m or rad"},
                                       std::pair{"distance", "a distance in m or rad"},
                                       std::pair{"speed", "a speed in m/s or rad/s"},
                                       std::pair{"time", "a time in s"},
                                       std::pair{"stiffness", "a stiffness in N/m or N m/rad"}};
  for (const auto& [name, text] : measures) {
    if (measure == name) return text;
  }
  throw Error(ErrorCode::invalid_argument, fmt::format("\"{}\" is no measure", measure));
}

std::string value_text(const Evidence& evidence, std::string_view format) {
  if (format.empty()) {
    return evidence.unit.empty() ? number(evidence.value) : quantity(evidence.value, evidence.unit);
  }
  if (format == "exact") return fmt::format("{}", evidence.value);
  if (format == "n") return fmt::format("{:.0f}", evidence.value);
  if (format == "x") return fmt::format("{:#x}", static_cast<long long>(evidence.value));
  if (format == "s") return evidence.value == 1.0 ? "" : "s";
  if (format == "time") return time_text(evidence.value);
  if (format == "percent") return percent(evidence.value);
  if (format == "limit") return !std::isfinite(evidence.value) ? "every stiffness" : value_text(evidence, {});
  // "N s/m": the damping of a wall
  if (format == "gain" && evidence.unit.find(" s") != std::string_view::npos) {
    return fmt::format("{} {}", number(evidence.value), evidence.unit);
  }
  if (format == "gain") return value_text(evidence, {});
  if (format == "%") return fmt::format("{:.0f}", 100.0 * evidence.value);
  const bool is_share = format.front() == '%';
  const std::string spec = fmt::format("{{:{}}}", is_share ? format.substr(1) : format);
  return fmt::format(fmt::runtime(spec), is_share ? 100.0 * evidence.value : evidence.value);
}

// Whether the finding holds a name, or holds it with this very value.
bool holds(const Finding& finding, std::string_view condition) {
  const std::size_t equals = condition.find('=');
  const std::string_view name = condition.substr(0, equals);
  const auto evidence = std::ranges::find(finding.evidence, name, &Evidence::name);
  const auto subject = std::ranges::find(finding.subjects, name, &Subject::name);
  const bool is_number = evidence != finding.evidence.end();
  if (!is_number && subject == finding.subjects.end()) return false;
  if (equals == std::string_view::npos) return true;
  const std::string value = is_number ? fmt::format("{}", evidence->value) : subject->text;
  return value == condition.substr(equals + 1);
}

// What stands in a pair of braces.
std::string filled(const Finding& finding, std::string_view field) {
  if (field.front() == '?' || field.front() == '!') {
    const std::size_t bar = field.find('|');
    const bool is_shown = holds(finding, field.substr(1, bar - 1)) == (field.front() == '?');
    return is_shown ? filled_in(finding, field.substr(bar + 1)) : std::string();
  }
  const std::size_t colon = field.find(':');
  const std::string_view name = field.substr(0, colon);
  const std::string_view format = colon == std::string_view::npos ? std::string_view() : field.substr(colon + 1);
  const auto evidence = std::ranges::find(finding.evidence, name, &Evidence::name);
  if (evidence != finding.evidence.end()) return value_text(*evidence, format);
  const auto subject = std::ranges::find(finding.subjects, name, &Subject::name);
  if (subject != finding.subjects.end()) return format == "of" ? measure_text(subject->text) : subject->text;
  if (name == "key") return finding.key;
  throw Error(ErrorCode::invalid_argument,
              fmt::format("the finding \"{}\" lacks \"{}\", which its sentence names", name_of(finding.code), name));
}

// The brace that closes the one at `open`.
std::size_t closing_brace(std::string_view phrase, std::size_t open) {
  std::size_t depth = 0;
  for (std::size_t i = open; i < phrase.size(); ++i) {
    if (phrase[i] == '{') ++depth;
    if (phrase[i] == '}' && --depth == 0) return i;
  }
  return phrase.size() - 1;
}

}  // namespace

std::string internal::filled_in(const Finding& finding, std::string_view phrase) {
  std::string result;
  while (!phrase.empty()) {
    const std::size_t open = phrase.find('{');
    result += phrase.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = closing_brace(phrase, open);
    result += filled(finding, phrase.substr(open + 1, close - open - 1));
    phrase.remove_prefix(close + 1);
  }
  return result;
}

std::string_view name_of(FindingCode code) { return phrase_of(code).name; }

Finding::Severity worst_severity(FindingCode code) { return phrase_of(code).worst; }

FindingWords words_of(const Finding& finding) {
  const Phrase& phrase = phrase_of(finding.code);
  std::string whose;
  for (const Subject& each : finding.subjects) {
    if (each.name == of_recording) whose = each.text + ": ";
    if (each.name == of_holder) whose = "with " + each.text + ": ";
  }
  return {whose + filled_in(finding, phrase.what), filled_in(finding, phrase.consequence),
          filled_in(finding, phrase.remedy)};
}

std::string text(const FindingWords& words) {
  std::string line = words.what;
  for (const std::string& part : {words.consequence, words.remedy}) {
    if (!part.empty()) line += "; " + part;
  }
  return line;
}

std::string text(const Finding& finding) { return text(words_of(finding)); }

std::string text(const std::optional<Finding>& finding) { return finding ? text(*finding) : std::string(); }

}  // namespace zwidth
