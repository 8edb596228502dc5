#include "server/api/device_toml.hpp"

#include <utility>

namespace zwidth::server {
namespace {

using results::Json;

/// A value as TOML: JSON's texts and numbers are TOML's, an object is an inline table.
void put_toml(std::string& toml, const InputPlace& place, const Json& value) {
  const auto put_list = [&](char open, char close, const auto& put_item) {
    toml += open;
    for (auto item = value.begin(); item != value.end(); ++item) {
      if (item != value.begin()) toml += ", ";
      put_item(item);
    }
    toml += close;
  };
  if (value.is_object()) {
    put_list('{', '}', [&](const auto& item) {
      toml += Json(item.key()).dump() + " = ";
      InputPlace below = place;
      below.key += "." + item.key();
      put_toml(toml, below, item.value());
    });
  } else if (value.is_array()) {
    put_list('[', ']', [&](const auto& item) { put_toml(toml, place, *item); });
  } else if (value.is_null()) {
    throw Problem(place.file + "." + place.key,
                  InputProblem{place, "is null", "a value; leave out what is not there", {}});
  } else {
    toml += value.dump();
  }
}

}  // namespace

tl::expected<std::string, Problem> device_toml(const Json& device, const std::string& name) try {
  if (!device.is_object()) throw Problem{name, "is no object", "the keys of a " + name + " file"};
  std::string toml;
  for (const auto& [key, value] : device.items()) {
    toml += Json(key).dump() + " = ";
    put_toml(toml, {name, 0, 0, key, ""}, value);
    toml += '\n';
  }
  return toml;
} catch (const Problem& problem) {
  return tl::unexpected(problem);
}

}  // namespace zwidth::server
