#pragma once

#include <set>
#include <string>

#include "results/json.hpp"

namespace zwidth::report {

/// Every key of a document, however deep; those of its findings are in docs/findings.md.
inline void collect_keys(const results::Json& value, std::set<std::string>& keys) {
  if (!value.is_structured()) return;
  for (const auto& item : value.items()) {
    if (value.is_object()) keys.insert(item.key());
    if (!value.is_object() || item.key() != "findings") collect_keys(item.value(), keys);
  }
}

}  // namespace zwidth::report
