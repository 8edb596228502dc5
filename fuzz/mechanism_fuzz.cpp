// Any bytes, as the text of a mechanism: an error, or a mechanism whose numbers make a device or are refused.
#include <cstddef>
#include <cstdint>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  zwidth::MechanismFile file;
  file.text.assign(reinterpret_cast<const char*>(data), size);
  file.tip = "tip";
  zwidth::DeviceParameters parameters;
  parameters.loop.sampling_period = 1e-3;
  try {
    (void)zwidth::device_along(zwidth::at_pose(file), {1.0, 0.0, 0.0}, parameters);
  } catch (const zwidth::Error&) {
    return 0;  // as promised
  }
  return 0;
}
