// Any bytes, on both ends of the line to a microcontroller: never a crash; no position in what it did not say, and no force
// that it was not told, beyond its limit or after its watchdog.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "rig/microcontroller_frame.hpp"
#include "zwidth_serial.h"

namespace {

using namespace zwidth::rig;

constexpr float force_limit = 4.0F;
constexpr std::uint16_t watchdog = 100;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_host(std::string_view bytes) {
  const auto answer = microcontroller_answer(bytes);
  const auto description = microcontroller_description(bytes);
  require(!answer || (bytes.size() == microcontroller_answer_bytes && !description));
  require(!description || bytes.size() == microcontroller_answer_bytes - 1);
}

/// Time goes on with each byte; what is taken out of the bytes as a force has to have been framed as one.
void check_board(std::string_view bytes, bool begins_held) {
  zwidth_serial_t board;
  zwidth_serial_begin(&board, force_limit, watchdog);
  std::uint32_t now = 0;
  if (begins_held) {
    const SerialFrame hold = microcontroller_frame(MicrocontrollerCommand::hold, 0);
    for (const char c : hold.view()) {
      (void)zwidth_serial_receive(&board, static_cast<std::uint8_t>(c), now);
    }
    require(board.state == ZWIDTH_SERIAL_HOLDING);
  }
  for (const char c : bytes) {
    const auto byte = static_cast<std::uint8_t>(c);
    now += byte % 8;
    const std::uint32_t fed = board.fed;
    if (zwidth_serial_receive(&board, byte, now) != 0) {
      std::array<std::uint8_t, ZWIDTH_SERIAL_MOST> out{};
      const std::size_t count = zwidth_serial_answer(&board, 1.0F, 2.0F, out.data());
      require(count <= out.size());
      const std::string frame(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count));
      const auto answer = microcontroller_answer(frame);
      const auto description = microcontroller_description(frame);
      require(answer.has_value() != description.has_value());
      require(!answer || (answer->sequence == board.asked && answer->position == 1.0 && answer->velocity == 2.0));
      require(!description || description->sequence == board.asked);
    }
    require(board.fed == fed || byte == 0);
    const float force = zwidth_serial_force(&board, 0.0F, now);
    require(std::abs(force) <= force_limit);
    require(force == 0.0F || (board.state == ZWIDTH_SERIAL_HOLDING && now - board.fed <= watchdog));
  }
  (void)zwidth_serial_receive(&board, 0, now);
  require(std::abs(zwidth_serial_force(&board, 0.0F, now)) <= force_limit);
  require(zwidth_serial_force(&board, 0.0F, now + watchdog + 1) == 0.0F);
}

/// The bytes as a payload with a CRC that is right, so that what lies behind it is reached too.
void check_framed(std::string_view bytes) {
  std::array<std::uint8_t, ZWIDTH_SERIAL_MOST> payload{};
  const auto count = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), ZWIDTH_SERIAL_MOST - 4));
  std::copy_n(bytes.begin(), count, payload.begin());
  zwidth_serial_put16(payload.data() + count, zwidth_serial_crc(payload.data(), count));
  std::array<std::uint8_t, ZWIDTH_SERIAL_MOST> out{};
  const std::uint8_t size = zwidth_serial_encode(payload.data(), static_cast<std::uint8_t>(count + 2), out.data());
  const std::string frame(out.begin(), out.begin() + size);
  check_host(frame);
  check_board(frame, true);
  const std::uint8_t decoded = zwidth_serial_decode(out.data(), static_cast<std::uint8_t>(size - 1));
  require(decoded == count + 2 && std::equal(payload.begin(), payload.begin() + decoded, out.begin()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_host(bytes);
  check_board(bytes, false);
  check_board(bytes, true);
  check_framed(bytes);
  return 0;
}
