#include "zwidth/words/finding_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "percent.hpp"
#include "words/phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth {
using namespace internal;
namespace {

const std::map<FindingCode, Phrase>& phrases() {
  static const std::map<FindingCode, Phrase> all = [] {
    std::map<FindingCode, Phrase> result;
    for (const std::span<const Phrase> room : {model_phrases(), stability_phrases(), design_phrases(), study_phrases(),
                                               simulation_phrases(), rig_phrases()}) {
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

std::string value_text(const Evidence& evidence, std::string_view format) {
  if (format.empty()) {
    return evidence.unit.empty() ? number(evidence.value) : quantity(evidence.value, evidence.unit);
  }
  if (format == "n") return fmt::format("{:.0f}", evidence.value);
  if (format == "percent") return percent(evidence.value);
  if (format == "limit") return !std::isfinite(evidence.value) ? "every stiffness" : value_text(evidence, {});
  if (format == "%") return fmt::format("{:.0f}", 100.0 * evidence.value);
  const bool is_share = format.front() == '%';
  const std::string spec = fmt::format("{{:{}}}", is_share ? format.substr(1) : format);
  return fmt::format(fmt::runtime(spec), is_share ? 100.0 * evidence.value : evidence.value);
}

// What stands in a pair of braces.
std::string filled(const Finding& finding, std::string_view field) {
  const std::size_t colon = field.find(':');
  const std::string_view name = field.substr(0, colon);
  const std::string_view format = colon == std::string_view::npos ? std::string_view() : field.substr(colon + 1);
  const auto evidence = std::ranges::find(finding.evidence, name, &Evidence::name);
  if (evidence != finding.evidence.end()) return value_text(*evidence, format);
  const auto subject = std::ranges::find(finding.subjects, name, &Subject::name);
  if (subject != finding.subjects.end()) return subject->text;
  if (name == "key") return finding.key;
  throw Error(ErrorCode::invalid_argument,
              fmt::format("the finding \"{}\" lacks \"{}\", which its sentence names", name_of(finding.code), name));
}

std::string filled_in(const Finding& finding, std::string_view phrase) {
  std::string result;
  while (!phrase.empty()) {
    const std::size_t open = phrase.find('{');
    result += phrase.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = phrase.find('}', open);
    result += filled(finding, phrase.substr(open + 1, close - open - 1));
    phrase.remove_prefix(close + 1);
  }
  return result;
}

}  // namespace

std::string_view name_of(FindingCode code) { return phrase_of(code).name; }

FindingWords words_of(const Finding& finding) {
  const Phrase& phrase = phrase_of(finding.code);
  return {filled_in(finding, phrase.what), filled_in(finding, phrase.consequence), filled_in(finding, phrase.remedy)};
}

std::string text(const Finding& finding) {
  const FindingWords words = words_of(finding);
  std::string line = words.what;
  for (const std::string& part : {words.consequence, words.remedy}) {
    if (!part.empty()) line += "; " + part;
  }
  return line;
}

}  // namespace zwidth
