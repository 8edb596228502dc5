#include "server/api/recording_store.hpp"

#include <algorithm>
#include <iterator>

#include "server/api/digest.hpp"

namespace zwidth::server {

RecordingStore::Stored RecordingStore::put(std::string_view bytes) {
  std::string id = sha256(bytes);
  if (auto known = find(id)) return {std::move(id), std::move(known)};
  auto file = std::make_shared<const MemoryFile>(bytes);
  const std::lock_guard lock(mutex_);
  if (auto known = used(id)) return {std::move(id), std::move(known)};  // another thread was quicker
  stored_.push_front({id, file});
  std::size_t total = 0;
  for (const Stored& each : stored_) total += each.bytes->size();
  while (stored_.size() > 1 && (stored_.size() > limits_.count || total > limits_.bytes)) {
    total -= stored_.back().bytes->size();
    stored_.pop_back();
  }
  return {std::move(id), std::move(file)};
}

std::shared_ptr<const MemoryFile> RecordingStore::find(std::string_view id) {
  const std::lock_guard lock(mutex_);
  return used(id);
}

/// The mutex is held. It moves to the front.
std::shared_ptr<const MemoryFile> RecordingStore::used(std::string_view id) {
  const auto found = std::ranges::find(stored_, id, &Stored::id);
  if (found == stored_.end()) return nullptr;
  stored_.splice(stored_.begin(), stored_, found);
  return stored_.front().bytes;
}

}  // namespace zwidth::server
