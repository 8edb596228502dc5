#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "server/api/memory_file.hpp"

namespace zwidth::server {

struct RecordingLimits {
  std::size_t count = 32;
  std::size_t bytes = std::size_t{256} << 20;     ///< of all together
  std::size_t unpacked = std::size_t{128} << 20;  ///< of one that came compressed
};

/// Recordings by the digest of their bytes; where there are too many, the one that was longest not used goes. What a
/// request is at work on stays until it is done. For any number of threads.
class RecordingStore {
 public:
  explicit RecordingStore(const RecordingLimits& limits = {}) : limits_(limits) {}

  struct Stored {
    std::string id;  ///< SHA-256 of the bytes, in hexadecimal
    std::shared_ptr<const MemoryFile> bytes;
  };

  [[nodiscard]] const RecordingLimits& limits() const { return limits_; }
  Stored put(std::string_view bytes);
  /// Nothing where there is none of that id, or no longer.
  [[nodiscard]] std::shared_ptr<const MemoryFile> find(std::string_view id);

 private:
  std::shared_ptr<const MemoryFile> used(std::string_view id);

  RecordingLimits limits_;
  std::mutex mutex_;
  std::list<Stored> stored_;  // the last used first
};

}  // namespace zwidth::server
