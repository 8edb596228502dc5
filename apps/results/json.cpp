#include "results/json.hpp"

namespace zwidth::results {

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

}  // namespace zwidth::results
