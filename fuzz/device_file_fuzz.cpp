// Any bytes, as a device file and overrides: never a crash, always a device that can be written or a one-line error.
//
// Input: the text, then the overrides, each after a byte 0xFF (which no UTF-8 text contains).
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/io/device_file.hpp"

namespace {

std::vector<std::string> parts_of(std::string_view input) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= input.size();) {
    const std::size_t end = std::min(input.find('\xff', begin), input.size());
    parts.emplace_back(input.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = parts_of({reinterpret_cast<const char*>(data), size});
  const auto overrides = std::span(parts).subspan(1);
  const auto device = zwidth::parse_device(parts[0], "fuzz.toml", overrides);
  if (!device) {
    const std::string message = device.error().str();
    require(!device.error().what.empty() && message.find('\n') == std::string::npos && message.size() < 4096);
    require(device.error().place.file == "an override" || device.error().place.line > 0);
    return 0;
  }
  const std::string text = zwidth::write_device(device->parameters());
  const auto again = zwidth::parse_device(text, "written.toml");
  require(again.has_value() && zwidth::write_device(again->parameters()) == text);
  return 0;
}
