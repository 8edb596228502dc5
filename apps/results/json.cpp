#include "results/json.hpp"

#include <algorithm>

#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {
namespace {

Json numbers_json(const std::vector<Evidence>& numbers) {
  Json json = Json::object();
  for (const Evidence& each : numbers) json[std::string(each.name)] = each.value;
  return json;
}

/// `finding` is null where the text has none.
Json finding_json(const Finding* finding, const char* severity, const std::string& remedy, const std::string& text) {
  const Finding stated;
  const Finding& found = finding != nullptr ? *finding : stated;
  return {{"code", zwidth::name_of(found.code)},
          {"severity", severity},
          {"key", found.key.empty() ? Json(nullptr) : Json(found.key)},
          {"evidence", numbers_json(found.evidence)},
          {"effect", found.effect.empty() ? Json(nullptr) : numbers_json(found.effect)},
          {"remedy", remedy},
          {"text", text}};
}

const char* severity_of(const Finding* finding, const Trust& trust) {
  const bool refuses = finding != nullptr ? finding->severity == Finding::Severity::refusal : trust.refused();
  return refuses ? "refusal" : "doubt";
}

}  // namespace

std::string line(const Json& document) { return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

void to_json(Json& json, const Remark& remark) {
  const bool both = !remark.consequence.empty() && !remark.remedy.empty();
  json = {{"severity", remark.severity},
          {"what", remark.what},
          {"meaning", remark.consequence + (both ? "; " : "") + remark.remedy},
          {"consequence", remark.consequence},
          {"remedy", remark.remedy}};
}

void to_json(Json& json, const Trust& trust) { json = {{"verdict", trust.verdict}, {"reasons", trust.reasons}}; }

Json findings_json(const Trust& trust, const std::vector<Remark>& remarks) {
  Json list = Json::array();
  std::vector<std::string> listed;
  const auto is_new = [&listed](const std::string& text) {
    if (std::ranges::find(listed, text) != listed.end()) return false;
    listed.push_back(text);
    return true;
  };
  for (const std::string& reason : trust.reasons) {
    if (!is_new(reason)) continue;
    const auto found = std::ranges::find(trust.findings, reason, [](const Finding& each) { return text(each); });
    const Finding* const finding = found != trust.findings.end() ? &*found : nullptr;
    const std::string remedy = finding != nullptr ? words_of(*finding).remedy : std::string();
    list.push_back(finding_json(finding, severity_of(finding, trust), remedy, reason));
  }
  for (const Remark& remark : remarks) {
    const std::string text = remark_line(remark);
    if (!is_new(text)) continue;
    list.push_back(finding_json(remark.finding ? &*remark.finding : nullptr, "note", remark.remedy, text));
  }
  return list;
}

}  // namespace zwidth::results
