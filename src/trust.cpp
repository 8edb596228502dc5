#include "zwidth/trust.hpp"

#include <algorithm>
#include <utility>

namespace zwidth {
namespace {

void add(Trust& trust, Trust::Verdict least, std::string reason) {
  trust.verdict = std::max(trust.verdict, least);
  if (std::find(trust.reasons.begin(), trust.reasons.end(), reason) == trust.reasons.end()) {
    trust.reasons.push_back(std::move(reason));
  }
}

}  // namespace

void Trust::doubt(std::string reason) { add(*this, Verdict::doubtful, std::move(reason)); }

void Trust::refuse(std::string reason) { add(*this, Verdict::refused, std::move(reason)); }

void Trust::inherit(const Trust& source) {
  for (const std::string& reason : source.reasons) add(*this, source.verdict, reason);
}

}  // namespace zwidth
