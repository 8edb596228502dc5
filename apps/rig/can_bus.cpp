#include "rig/can_bus.hpp"

#include <charconv>

#include "rig/slcan_bus.hpp"
#include "rig/socketcan_bus.hpp"

namespace zwidth::rig {
namespace {

constexpr int baud_of_usb = 4'000'000;  // where a port is USB all the way its speed means nothing

}  // namespace

std::optional<CanAdapter> can_adapter(std::string_view name) {
  const std::size_t at = name.rfind('@');
  CanAdapter adapter{std::string(name.substr(0, at)), {}};
  if (adapter.place.empty()) return std::nullopt;
  if (adapter.place.find('/') != std::string::npos) adapter.baud = baud_of_usb;
  if (at == std::string_view::npos) return adapter;
  int baud = 0;
  const std::string_view digits = name.substr(at + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), baud);
  if (!adapter.baud || error != std::errc{} || end != digits.data() + digits.size() || baud <= 0) return std::nullopt;
  adapter.baud = baud;
  return adapter;
}

std::unique_ptr<CanBus> open_can_bus(const CanAdapter& adapter, const CanBitRates& rates) {
  if (!adapter.baud) return std::make_unique<SocketcanBus>(adapter.place, rates.data > 0.0);
  return std::make_unique<SlcanBus>(adapter, rates);
}

}  // namespace zwidth::rig
