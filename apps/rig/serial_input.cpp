#include "rig/serial_input.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "rig/byte_port.hpp"

namespace zwidth::rig {

std::string_view SerialInput::take(std::size_t size) noexcept {
  const std::string_view taken = bytes().substr(0, size);
  begin_ += taken.size();
  return taken;
}

bool SerialInput::fill(BytePort& port, std::int64_t until) noexcept {
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), bytes_.begin() + static_cast<std::ptrdiff_t>(end_),
            bytes_.begin());
  end_ -= std::exchange(begin_, 0);
  if (end_ == bytes_.size()) end_ = 0;
  const std::ptrdiff_t count = port.read(std::span(bytes_).subspan(end_), until);
  has_failed_ = count < 0;
  if (count > 0) end_ += static_cast<std::size_t>(count);
  return count > 0;
}

}  // namespace zwidth::rig
