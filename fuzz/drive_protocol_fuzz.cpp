// Any bytes, as what a drive on a serial line answers: never a crash, and no position in what no drive says.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "rig/moteus_protocol.hpp"
#include "rig/odrive_protocol.hpp"
#include "rig/simplefoc_protocol.hpp"
#include "rig/vesc_protocol.hpp"

namespace {

using namespace zwidth::rig;

void check_odrive(std::string_view bytes) {
  if (const auto answer = odrive_answer(bytes)) (void)odrive_feedback(*answer);
  (void)odrive_feedback(bytes);
  // With a right checksum, so that what lies behind it is reached too.
  const std::string line(odrive_line(bytes.substr(0, 100)).view());
  const auto answer = odrive_answer(line);
  if (!answer || *answer != bytes.substr(0, 100)) std::abort();
  (void)odrive_feedback(*answer);
}

void check_moteus(std::string_view bytes) {
  for (const bool needs_checksum : {false, true}) {
    if (const auto answer = moteus_answer(bytes, needs_checksum)) (void)moteus_reply(*answer, 1);
  }
  (void)moteus_reply(bytes, 1);
  std::string reply = "rcv 100 ";
  for (const char c : bytes.substr(0, 40)) reply += fmt::format("{:02x}", static_cast<unsigned char>(c));
  const std::string line(moteus_line(reply, true).view());
  const auto answer = moteus_answer(line, true);
  if (!answer || answer->size() > reply.size()) std::abort();
  (void)moteus_reply(*answer, 1);
}

void check_simplefoc(std::string_view bytes) {
  for (const std::string_view echo : {"MG", "T", ""}) {
    const auto answer = simplefoc_answer(bytes, "M", echo);
    if (answer && as_number(*answer) && !bytes.starts_with("M")) std::abort();
  }
}

void check_vesc(std::string_view bytes) {
  for (const std::size_t most : {vesc_short_payload, vesc_long_payload}) {
    for (std::string_view rest = bytes; !rest.empty();) {  // as the driver takes packets out of what has come
      const std::size_t size = vesc_packet_size(rest, most);
      if (size > rest.size()) std::abort();
      if (size == 0) break;
      if (const auto payload = vesc_payload(rest.substr(0, size))) (void)vesc_values(*payload);
      rest.remove_prefix(size);
    }
  }
  (void)vesc_version(bytes);
  (void)vesc_settings(bytes);
  (void)vesc_values(bytes);
  if (bytes.empty()) return;
  const std::string packet(vesc_packet(bytes.substr(0, 100)).view());
  const auto payload = vesc_payload(packet);
  if (vesc_packet_size(packet) != packet.size() || !payload || *payload != bytes.substr(0, 100)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_odrive(bytes);
  check_moteus(bytes);
  check_simplefoc(bytes);
  check_vesc(bytes);
  return 0;
}
