#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace zwidth::server {

/// Bytes in memory that readers of files can open: they have no name on any disk, and go with this object.
class MemoryFile {
 public:
  /// Throws std::system_error where the system has no memory or no descriptor left.
  explicit MemoryFile(std::string_view bytes);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Where this process can open them, from any thread and several times at once.
  [[nodiscard]] std::string path() const;

 private:
  int descriptor_;
  std::size_t size_;
};

}  // namespace zwidth::server
