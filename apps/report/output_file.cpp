#include "report/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace zwidth::report {
namespace {

namespace fs = std::filesystem;

std::string_view remedy_for(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "; make the folder first, or name another";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; name a file in a folder that you may write to";
    case ENOSPC:
    case EDQUOT:
      return "; make room, or name a file on another disk";
    case EFBIG:
      return "; raise the limit of file size (ulimit -f)";
    case ENAMETOOLONG:
      return "; give a shorter name";
    default:
      return "";
  }
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw OutputFailed(fmt::format("{}: cannot write: {}{}", path, std::strerror(error), remedy_for(error)));
}

/// An open descriptor that is closed on every way out.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int get() const { return value_; }
  /// 0 or errno: some file systems report a failed write only here.
  [[nodiscard]] int close() { return ::close(std::exchange(value_, -1)) == 0 ? 0 : errno; }
  [[nodiscard]] int release() { return std::exchange(value_, -1); }

 private:
  int value_;
};

using Produce = std::function<void(const Sink&)>;

/// A failed system call on the way.
struct SystemError {
  int number = 0;
};

void write_all(int descriptor, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t written = ::write(descriptor, contents.data(), contents.size());
    if (written < 0 && errno != EINTR) throw SystemError{errno};
    if (written > 0) contents.remove_prefix(static_cast<std::size_t>(written));
  }
}

void produce_into(Descriptor& file, const Produce& produce) {
  produce([&file](std::string_view piece) { write_all(file.get(), piece); });
}

void write_through(const std::string& path, const Produce& produce) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) throw SystemError{errno};
  produce_into(file, produce);
  if (const int error = file.close()) throw SystemError{error};
}

std::string link_of(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

/// A file without a name in the folder; -1 where the file system, or the lack of /proc to name it by, does not allow one.
int open_unnamed(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor >= 0 && ::access(link_of(descriptor).c_str(), F_OK) == 0) return descriptor;
  if (descriptor >= 0) ::close(descriptor);
  return -1;
}

/// The descriptor of the flushed file while it has no name; -1 where `temporary` is its name.
int write_temporary(const fs::path& temporary, const Produce& produce, const struct stat* replaced) {
  Descriptor file(open_unnamed(temporary.parent_path()));
  const bool is_unnamed = file.get() >= 0;
  if (!is_unnamed) file = Descriptor(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) throw SystemError{errno};
  if (replaced != nullptr && ::fchmod(file.get(), replaced->st_mode & 07777) != 0) throw SystemError{errno};
  produce_into(file, produce);
  if (::fsync(file.get()) != 0) throw SystemError{errno};
  if (is_unnamed) return file.release();
  if (const int error = file.close()) throw SystemError{error};
  return -1;
}

/// The place behind links, and what is there.
struct Target {
  fs::path path;
  std::optional<struct stat> existing;
};

Target target_of(const std::string& path) {
  struct stat existing {};
  const bool exists = ::stat(path.c_str(), &existing) == 0;
  if (!exists && errno != ENOENT) throw SystemError{errno};
  if (!exists) return {path, std::nullopt};
  if (S_ISDIR(existing.st_mode)) throw OutputFailed(fmt::format("{}: is a directory; give a file", path));
  if (!S_ISREG(existing.st_mode)) return {path, existing};
  if (::access(path.c_str(), W_OK) != 0) throw SystemError{errno};
  std::error_code unresolved;
  const fs::path target = fs::canonical(path, unresolved);
  if (unresolved) throw SystemError{unresolved.value()};
  return {target, existing};
}

}  // namespace

OutputFiles::~OutputFiles() {
  for (const Pending& each : pending_) {
    ::unlink(each.temporary.c_str());
    if (each.unnamed >= 0) ::close(each.unnamed);
  }
}

void OutputFiles::require_writable(const std::string& path) {
  if (path.empty()) throw OutputFailed("output: the file name is empty");
  try {
    const Target target = target_of(path);
    if (target.existing && !S_ISREG(target.existing->st_mode)) {
      if (::access(path.c_str(), W_OK) != 0) throw SystemError{errno};
      return;
    }
    const fs::path temporary = target.path.parent_path() / fmt::format(".zwidth-{}-probe.part", ::getpid());
    ::unlink(temporary.c_str());  // left by a killed process that had our number
    const Descriptor unnamed(write_temporary(
        temporary, [](const Sink&) {}, nullptr));
    if (unnamed.get() < 0) ::unlink(temporary.c_str());
  } catch (const SystemError& error) {
    fail(path, error.number);
  }
}

void OutputFiles::write(const std::string& path, std::string_view contents) {
  write(path, [contents](const Sink& sink) { sink(contents); });
}

void OutputFiles::write(const std::string& path, const std::function<void(const Sink&)>& produce) {
  if (path.empty()) throw OutputFailed("output: the file name is empty");
  try {
    const Target target = target_of(path);
    if (target.existing && !S_ISREG(target.existing->st_mode)) return write_through(path, produce);
    const fs::path temporary =
        target.path.parent_path() / fmt::format(".zwidth-{}-{}.part", ::getpid(), pending_.size());
    ::unlink(temporary.c_str());  // left by a killed process that had our number
    pending_.push_back({path, temporary, target.path});
    pending_.back().unnamed = write_temporary(temporary, produce, target.existing ? &*target.existing : nullptr);
  } catch (const SystemError& error) {
    fail(path, error.number);
  }
}

void OutputFiles::commit() {
  for (Pending& each : pending_) {
    if (each.unnamed < 0) continue;
    const std::string link = link_of(each.unnamed);
    if (::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, each.temporary.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      fail(each.path, errno);
    }
    if (::close(std::exchange(each.unnamed, -1)) != 0) fail(each.path, errno);
  }
  for (const Pending& each : pending_) {
    if (::rename(each.temporary.c_str(), each.target.c_str()) != 0) fail(each.path, errno);
  }
  pending_.clear();
}

void write_whole(const std::string& path, const std::function<void(const Sink&)>& produce) {
  OutputFiles file;
  file.write(path, produce);
  file.commit();
}

void write_whole(const std::string& path, std::string_view contents) {
  write_whole(path, [contents](const Sink& sink) { sink(contents); });
}

void make_directory(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    throw OutputFailed(
        fmt::format("{}: cannot make the directory: {}{}", path, error.message(), remedy_for(error.value())));
  }
  if (!fs::is_directory(path, error)) {
    throw OutputFailed(fmt::format("{}: is not a directory; name a directory", path));
  }
}

}  // namespace zwidth::report
