#include "study/study_checkpoint.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "report/output_file.hpp"
#include "results/study_json.hpp"
#include "study/answer_bytes.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::study_engine {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_words = "zwidth study checkpoint ";
constexpr std::string_view first_line = "zwidth study checkpoint 3\n";  // the number is that of the format
constexpr std::string_view last_line = "end of description\n";
constexpr std::uint64_t record_mark = 0x6b6e756863646577;
constexpr std::uint64_t most_record_bytes = std::uint64_t{1} << 32U;

struct RecordHead {
  std::uint64_t mark = record_mark;
  std::uint64_t chunk = 0;
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;  // of chunk, size and the answers
};

std::uint64_t checksum_of(const RecordHead& head, const char* bytes) {
  const std::uint64_t numbers[2] = {head.chunk, head.size};
  const uLong of_head = crc32_z(0, reinterpret_cast<const Bytef*>(numbers), sizeof numbers);
  return crc32_z(of_head, reinterpret_cast<const Bytef*>(bytes), head.size);
}

[[noreturn]] void fail(const std::string& path, int error) {
  const std::string_view remedy =
      error == ENOSPC || error == EDQUOT                    ? "; make room and add --resume: what was computed is kept"
      : error == EACCES || error == EROFS || error == EPERM ? "; name a file in a folder that you may write to"
      : error == ENOENT || error == ENOTDIR                 ? "; make the folder first, or name another"
                                                            : "";
  throw report::OutputFailed(fmt::format("{}: cannot write: {}{}", path, std::strerror(error), remedy));
}

[[noreturn]] void fail_in_use(const std::string& path) {
  throw CheckpointProblem(path + ": another process is at this study; wait for it, or name another output");
}

/// All bytes at the offset, or how many there were.
std::size_t read_at(int file, char* bytes, std::size_t size, std::uint64_t offset) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(file, bytes + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

std::string prefix_of(const std::string& output) { return fs::path(output).filename().string() + ".partial."; }

std::vector<std::string> checkpoints_of(const std::string& output) {
  const fs::path folder = fs::path(output).parent_path().empty() ? fs::path(".") : fs::path(output).parent_path();
  std::vector<std::string> found;
  std::error_code error;
  for (fs::directory_iterator each(folder, error), end; !error && each != end; each.increment(error)) {
    const std::string name = each->path().filename().string();
    const std::string prefix = prefix_of(output);
    const bool is_one = name.starts_with(prefix) && name.size() > prefix.size() &&
                        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(prefix.size()), name.end(),
                                    [](char letter) { return letter >= '0' && letter <= '9'; });
    if (is_one) found.push_back((fs::path(output).parent_path() / name).string());
  }
  std::ranges::sort(found);
  return found;
}

/// The first line that differs, in words; empty where none does.
std::string difference(std::string_view own, std::string_view other) {
  const auto next = [](std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
  };
  while (!own.empty() || !other.empty()) {
    const std::string_view mine = next(own);
    const std::string_view its = next(other);
    if (mine != its) return fmt::format("it has \"{}\", this one \"{}\"", its.substr(0, 120), mine.substr(0, 120));
  }
  return {};
}

}  // namespace

std::string description(const StudyRun& run) {
  std::string text = fmt::format("version: {}\nsamples: {}\nseed: {}\nsampling: {}\nany user: {}\n", ZWIDTH_VERSION,
                                 run.options().samples, run.options().seed, results::name_of(run.options().sampling),
                                 run.options().any_user);
  for (const StudyParameter& each : run.distributions().parameters) {
    const Distribution& d = each.distribution;
    text += fmt::format("parameter: {} kind {} {} {} {} {}", each.key, static_cast<int>(d.kind), d.centre, d.deviation,
                        d.lower, d.upper);
    if (!d.values.empty())
      text += fmt::format(" values {} weights {}", fmt::join(d.values, " "), fmt::join(d.weights, " "));
    text += "\n";
  }
  for (const auto& row : run.distributions().correlation) text += fmt::format("correlation: {}\n", fmt::join(row, " "));
  return text + "device:\n" + write_device(run.device().parameters());
}

void StudyCheckpoint::require_none(const std::string& output) {
  std::error_code unknown;  // what cannot be asked for cannot be written either, which is said then
  if (fs::is_directory(output, unknown)) throw CheckpointProblem(output + ": is a folder; name a file");
  const auto there = checkpoints_of(output);
  if (there.empty()) return;
  const int first = ::open(there.front().c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_in_use = first >= 0 && ::flock(first, LOCK_SH | LOCK_NB) != 0;
  if (first >= 0) ::close(first);
  if (is_in_use) fail_in_use(there.front());
  throw CheckpointProblem(fmt::format(
      "{}: a study was ended before it was done; add --resume to go on with it, or remove that file to begin anew",
      there.front()));
}

StudyCheckpoint::StudyCheckpoint(const StudyRun& run, std::string output, std::size_t rank, Start start)
    : run_(run), output_(std::move(output)) {
  own_path_ = fmt::format("{}.partial.{}", output_, rank);
  own_ = ::open(own_path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (own_ < 0) fail(own_path_, errno);
  if (::flock(own_, LOCK_EX | LOCK_NB) != 0) {
    ::close(std::exchange(own_, -1));
    fail_in_use(own_path_);
  }
  const std::string head = fmt::format("{}{}{}", first_line, description(run_), last_line);
  if (start == Start::resumed) find_all();
  const auto found = std::ranges::find(paths_, own_path_);
  // What follows the last whole record was being written when the process was killed.
  end_ = found == paths_.end() ? 0 : scan(static_cast<std::size_t>(found - paths_.begin()));
  if (::ftruncate(own_, static_cast<off_t>(end_)) != 0) fail(own_path_, errno);
  ::lseek(own_, 0, SEEK_END);
  if (end_ > 0) return;
  if (const int error = write_all(own_, head)) {
    ::unlink(own_path_.c_str());
    fail(own_path_, error);
  }
  end_ = head.size();
}

StudyCheckpoint::~StudyCheckpoint() {
  for (const int file : files_) ::close(file);
  if (own_ >= 0) ::close(own_);
}

void StudyCheckpoint::append(std::uint64_t chunk, const BatchStiffness& answers) {
  bytes_.assign(sizeof(RecordHead), '\0');
  write_bytes(answers, bytes_);
  RecordHead head{.chunk = chunk, .size = bytes_.size() - sizeof(RecordHead)};
  head.checksum = checksum_of(head, bytes_.data() + sizeof head);
  std::memcpy(bytes_.data(), &head, sizeof head);
  if (const int error = write_all(own_, {bytes_.data(), bytes_.size()})) fail(own_path_, error);
  end_ += bytes_.size();
}

void StudyCheckpoint::flush() {
  if (::fdatasync(own_) != 0) fail(own_path_, errno);
}

void StudyCheckpoint::find_all() {
  for (const int file : files_) ::close(file);
  files_.clear();
  places_.clear();
  paths_ = checkpoints_of(output_);
  for (const std::string& path : paths_) {
    files_.push_back(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (files_.back() < 0) throw CheckpointProblem(fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
  }
  for (std::size_t i = 0; i < files_.size(); ++i) (void)scan(i);
}

/// Notes every whole record; the end of the last one, 0 where the file has not even its description.
std::uint64_t StudyCheckpoint::scan(std::size_t file) {
  struct stat status {};
  ::fstat(files_[file], &status);
  const auto file_size = static_cast<std::uint64_t>(status.st_size);
  const std::string own = fmt::format("{}{}{}", first_line, description(run_), last_line);
  constexpr std::size_t most_description = std::size_t{1} << 24U;
  std::string head(std::min<std::uint64_t>(file_size, std::max(own.size(), most_description)), '\0');
  head.resize(read_at(files_[file], head.data(), head.size(), 0));
  if (!head.starts_with(own)) {
    if (own.starts_with(head)) return 0;  // killed while it wrote its first bytes
    if (!head.starts_with(first_words)) {
      throw CheckpointProblem(paths_[file] + ": is no checkpoint of this program; remove it, or name another output");
    }
    const std::string its = head.substr(0, head.find(last_line));
    throw CheckpointProblem(
        fmt::format("{}: is of another study: {}; give what it was begun with, or name another output", paths_[file],
                    difference(own, its)));
  }
  std::uint64_t at = own.size();
  RecordHead record;
  while (read_at(files_[file], reinterpret_cast<char*>(&record), sizeof record, at) == sizeof record) {
    const bool is_whole = record.mark == record_mark && record.size <= most_record_bytes &&
                          at + sizeof record + record.size <= file_size && record.chunk < run_.chunk_count();
    if (!is_whole) break;
    bytes_.resize(record.size);
    if (read_at(files_[file], bytes_.data(), bytes_.size(), at + sizeof record) != bytes_.size()) break;
    if (checksum_of(record, bytes_.data()) != record.checksum) break;
    places_.try_emplace(record.chunk, Place{file, at + sizeof record, record.size});
    at += sizeof record + record.size;
  }
  return at;
}

const BatchStiffness& StudyCheckpoint::read(std::uint64_t chunk) {
  const auto place = places_.find(chunk);
  if (place == places_.end()) throw CheckpointProblem(fmt::format("{}: chunk {} is missing", own_path_, chunk));
  bytes_.resize(place->second.size);
  const std::size_t got = read_at(files_[place->second.file], bytes_.data(), bytes_.size(), place->second.offset);
  auto answers = got == bytes_.size() ? answers_of(bytes_) : std::nullopt;
  if (!answers || answers->size() != run_.size_of(chunk)) {
    throw CheckpointProblem(
        fmt::format("{}: chunk {} is damaged; remove the file and add --resume", paths_[place->second.file], chunk));
  }
  answers_ = *std::move(answers);
  return answers_;
}

void StudyCheckpoint::remove() {
  for (const std::string& path : checkpoints_of(output_)) ::unlink(path.c_str());
}

}  // namespace zwidth::study_engine
