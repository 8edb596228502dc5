#include "server/api/memory_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace zwidth::server {
namespace {

[[noreturn]] void fail_in_memory() { throw std::system_error(errno, std::generic_category(), "a file in memory"); }

}  // namespace

MemoryFile::MemoryFile(std::string_view bytes)
    : descriptor_(::memfd_create("recording", MFD_CLOEXEC)), size_(bytes.size()) {
  if (descriptor_ < 0) fail_in_memory();
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      const int error = errno;
      ::close(descriptor_);
      errno = error;
      fail_in_memory();
    }
  }
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

std::string MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

}  // namespace zwidth::server
