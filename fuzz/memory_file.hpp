#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "zwidth/io/input_error.hpp"

/// What must hold of any input; the fuzzer stops where it does not.
inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void require_one_line(const zwidth::InputError& error) {
  const std::string message = error.str();
  require(!error.what.empty() && message.find('\n') == std::string::npos && message.size() < 4096);
}

/// A file in memory, by its name.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : descriptor_(memfd_create("recording", MFD_CLOEXEC)) {
    require(descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};
