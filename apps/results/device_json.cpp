#include "results/device_json.hpp"

#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "zwidth/io/device_file.hpp"

namespace zwidth::results {
namespace {

/// The table of "[[wall.filter]]" (a new one of its array) or "[loop]".
Json& table_of(const std::string& header, Json& device) {
  const bool is_one_of_many = header.starts_with("[[");
  const std::size_t brackets = is_one_of_many ? 2 : 1;
  std::istringstream path(header.substr(brackets, header.size() - 2 * brackets));
  Json* table = &device;
  for (std::string key; std::getline(path, key, '.');) table = &(*table)[key];
  if (!is_one_of_many) return *table = Json::object();
  table->push_back(Json::object());
  return table->back();
}

/// A value as write_device() writes it is JSON but for the comma after an array's last line.
Json value_of(std::string toml) {
  for (std::size_t at = toml.find(",\n]"); at != std::string::npos; at = toml.find(",\n]", at)) toml.erase(at, 1);
  return Json::parse(toml);
}

/// A text of several lines, from behind its first quotes.
std::string text_of(std::istringstream& lines) {
  constexpr std::string_view quotes = "'''";
  std::string text;
  for (std::string next; std::getline(lines, next); text += next + "\n") {
    if (next.ends_with(quotes)) return text + next.substr(0, next.size() - quotes.size());
  }
  return text;
}

}  // namespace

// From the device file's text: what is written there is all here, and under the same keys.
Json device_json(const DeviceParameters& parameters) {
  Json device = Json::object();
  Json* table = &device;
  std::istringstream lines(write_device(parameters));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) {
      table = &table_of(line, device);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      std::string value = line.substr(equals + 3);
      if (value == "[") {  // on lines of its own up to "]"
        for (std::string next; next != "]" && std::getline(lines, next);) value += "\n" + next;
      }
      const std::string key = line.substr(0, equals);
      (*table)[key.starts_with('"') ? Json::parse(key).get<std::string>() : key] =
          value == "'''" ? Json(text_of(lines)) : value_of(std::move(value));
    }
  }
  return device;
}

}  // namespace zwidth::results
