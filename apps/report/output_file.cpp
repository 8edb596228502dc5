#include "report/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
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
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int get() const { return value_; }
  /// 0 or errno: some file systems report a failed write only here.
  [[nodiscard]] int close() { return ::close(std::exchange(value_, -1)) == 0 ? 0 : errno; }

 private:
  int value_;
};

/// 0 or errno.
int write_all(int descriptor, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t written = ::write(descriptor, contents.data(), contents.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) contents.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void write_through(const std::string& path, std::string_view contents) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0) fail(path, errno);
  if (const int error = write_all(file.get(), contents)) fail(path, error);
  if (const int error = file.close()) fail(path, error);
}

/// 0 or errno; the temporary is left for the caller to rename or remove.
int write_temporary(const fs::path& temporary, std::string_view contents, const struct stat* replaced) {
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) return errno;
  if (replaced != nullptr && ::fchmod(file.get(), replaced->st_mode & 07777) != 0) return errno;
  if (const int error = write_all(file.get(), contents)) return error;
  if (::fsync(file.get()) != 0) return errno;
  return file.close();
}

}  // namespace

void write_whole(const std::string& path, std::string_view contents) {
  if (path.empty()) throw OutputFailed("output: the file name is empty");
  struct stat existing {};
  const bool exists = ::stat(path.c_str(), &existing) == 0;
  if (!exists && errno != ENOENT) fail(path, errno);
  if (exists && S_ISDIR(existing.st_mode)) throw OutputFailed(fmt::format("{}: is a directory; give a file", path));
  if (exists && !S_ISREG(existing.st_mode)) return write_through(path, contents);
  if (exists && ::access(path.c_str(), W_OK) != 0) fail(path, errno);

  std::error_code unresolved;
  fs::path target = exists ? fs::canonical(path, unresolved) : fs::path(path);
  if (unresolved) fail(path, unresolved.value());
  const fs::path temporary = target.parent_path() / fmt::format(".zwidth-{}.part", ::getpid());
  ::unlink(temporary.c_str());  // left by a killed process that had our number
  int error = write_temporary(temporary, contents, exists ? &existing : nullptr);
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
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
