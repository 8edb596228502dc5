// Any bytes, as what a drive on a serial line answers: never a crash, and no position in what no drive says.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "rig/odrive_protocol.hpp"

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_odrive(bytes);
  return 0;
}
