#include "results/json.hpp"

#include "zwidth/ranked_findings.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {
namespace {

Json numbers_json(const std::vector<Evidence>& numbers) {
  Json json = Json::object();
  for (const Evidence& each : numbers) json[std::string(each.name)] = each.value;
  return json;
}

const char* severity_name(Finding::Severity severity) {
  return severity == Finding::Severity::refusal ? "refusal" : severity == Finding::Severity::doubt ? "doubt" : "note";
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
  for (const auto& [found, words] : most_important(trust, remarks)) {
    list.push_back({{"code", zwidth::name_of(found.code)},
                    {"severity", severity_name(found.severity)},
                    {"key", found.key.empty() ? Json(nullptr) : Json(found.key)},
                    {"evidence", numbers_json(found.evidence)},
                    {"effect", found.effect.empty() ? Json(nullptr) : numbers_json(found.effect)},
                    {"remedy", words.remedy},
                    {"text", text(words)}});
  }
  return list;
}

}  // namespace zwidth::results
