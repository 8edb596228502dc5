#pragma once

#include <set>
#include <string>

#include "results/json.hpp"

namespace zwidth::report {

/// Every key of a document, however deep.
inline void collect_keys(const results::Json& value, std::set<std::string>& keys) {
  if (value.is_object()) {
    for (const auto& item : value.items()) keys.insert(item.key());
  }
  if (value.is_structured()) {
    for (const auto& child : value) collect_keys(child, keys);
  }
}

}  // namespace zwidth::report
