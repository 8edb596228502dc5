#include "study/study_result_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5.h>
#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "report/output_file.hpp"
#include "results/study_json.hpp"
#include "study/stored_chunk.hpp"
#include "study/study_checkpoint.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::study_engine {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_listed = std::size_t{64} << 20U;  // bytes of what is said of single units, in memory at once

struct Hdf5Failed {};

hid_t checked(hid_t id) {
  if (id < 0) throw Hdf5Failed{};
  return id;
}

/// An object of HDF5, closed on every way out.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closing)(hid_t)) : id_(checked(id)), close_(closing) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t get() const { return id_; }
  /// A full disk may show here only.
  void close() {
    if (close_(std::exchange(id_, -1)) < 0) throw Hdf5Failed{};
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A column of the study, written chunk by chunk.
class Column {
 public:
  Column(hid_t folder, const std::string& name, hid_t type, std::uint64_t samples)
      : data_(create(folder, name, type, samples), H5Dclose) {}

  void write(std::uint64_t chunk, const StoredChunk& bytes) {
    const hsize_t start = chunk * study_chunk_size;
    if (H5Dwrite_chunk(data_.get(), H5P_DEFAULT, 0, &start, bytes.size(), bytes.data()) < 0) throw Hdf5Failed{};
  }

 private:
  static hid_t create(hid_t folder, const std::string& name, hid_t type, hsize_t samples) {
    const Handle space(H5Screate_simple(1, &samples, nullptr), H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t chunk = std::min<hsize_t>(study_chunk_size, samples);
    H5Pset_chunk(properties.get(), 1, &chunk);
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), deflate_level);
    H5Pset_fletcher32(properties.get());
    H5Pset_obj_track_times(properties.get(), false);  // the same bytes whenever it is written
    return H5Dcreate2(folder, name.c_str(), type, space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT);
  }

  Handle data_;
};

/// A text as a dataset of bytes: attributes hold 64 KiB at most.
void put_text(hid_t folder, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(1, text.size()));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);
  const Handle data(
      H5Dcreate2(folder, name.c_str(), type.get(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT), H5Dclose);
  if (H5Dwrite(data.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.empty() ? "" : text.data()) < 0) {
    throw Hdf5Failed{};
  }
}

void put_attribute(hid_t folder, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(1, text.size()));
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(folder, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (H5Awrite(attribute.get(), type.get(), text.c_str()) < 0) throw Hdf5Failed{};
}

void put_attribute(hid_t folder, const char* name, std::uint64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(folder, name, H5T_STD_U64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (H5Awrite(attribute.get(), H5T_NATIVE_UINT64, &value) < 0) throw Hdf5Failed{};
}

/// A chunk of the study, ready to be written.
struct PreparedChunk {
  std::uint64_t chunk = 0;
  BatchStiffness answers;
  std::vector<StoredChunk> columns;
};

/// In the order of Columns.
void prepare(const StudyRun& run, PreparedChunk& one) {
  const BatchStiffness& answers = one.answers;
  const std::size_t count = answers.size();
  const auto capacity = static_cast<std::size_t>(std::min(study_chunk_size, run.options().samples));
  const auto store = [&](const auto& values) {
    one.columns.push_back(stored_chunk(values.data(), sizeof values[0], count, capacity));
  };
  const auto store_small = [&](const auto& values) {
    std::vector<std::uint8_t> small;
    small.reserve(count);
    for (const auto value : values) small.push_back(static_cast<std::uint8_t>(value));
    store(small);
  };
  for (const ParameterValues& each : run.columns(one.chunk)) store(each.values);
  store(answers.stiffness);
  store(answers.frequency);
  store(answers.mode);
  store_small(answers.status);
  store_small(answers.verdict);
  if (run.options().any_user) store(answers.any_user);
}

/// What is to be said of single units, as long as there is room for it.
class Exceptions {
 public:
  void add(std::uint64_t chunk, const BatchStiffness& answers) {
    for (const BatchException& each : answers.exceptions) {
      if (text_.size() > most_listed) {
        ++unlisted_;
        continue;
      }
      const std::string why =
          each.failure.empty() ? fmt::format("{}", fmt::join(each.trust.reasons, "; ")) : each.failure;
      text_ += fmt::format("{}\t{}\n", chunk * study_chunk_size + each.index, why);
    }
  }
  [[nodiscard]] std::string text() const {
    return unlisted_ == 0 ? text_ : fmt::format("{}and {} more, by /status and /verdict\n", text_, unlisted_);
  }

 private:
  std::string text_;
  std::uint64_t unlisted_ = 0;
};

/// No name in HDF5 has a slash, names of bodies may: percent signs as in addresses.
std::string link_name(const std::string& key) {
  std::string name;
  for (const char letter : key) name += letter == '/' ? "%2F" : letter == '%' ? "%25" : std::string(1, letter);
  return name;
}

std::vector<std::unique_ptr<Column>> create_columns(hid_t file, hid_t folder, const StudyRun& run) {
  const std::uint64_t samples = run.options().samples;
  std::vector<std::unique_ptr<Column>> columns;
  const auto create = [&](hid_t in, const std::string& name, hid_t type) {
    columns.push_back(std::make_unique<Column>(in, name, type, samples));
  };
  for (const StudyParameter& each : run.distributions().parameters)
    create(folder, link_name(each.key), H5T_NATIVE_DOUBLE);
  create(file, "critical_stiffness", H5T_NATIVE_DOUBLE);
  create(file, "frequency_rad_s", H5T_NATIVE_DOUBLE);
  create(file, "mode", H5T_NATIVE_INT16);
  create(file, "status", H5T_NATIVE_UINT8);
  create(file, "verdict", H5T_NATIVE_UINT8);
  if (run.options().any_user) create(file, "any_user", H5T_NATIVE_DOUBLE);
  return columns;
}

/// One reads, all compress, one writes.
void write_columns(hid_t file, const StudyRun& run, const ChunkSource& chunks) {
  const Handle folder_properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(folder_properties.get(), false);
  const Handle folder(H5Gcreate2(file, "parameters", H5P_DEFAULT, folder_properties.get(), H5P_DEFAULT), H5Gclose);
  const std::vector<std::unique_ptr<Column>> columns = create_columns(file, folder.get(), run);
  Exceptions exceptions;
  std::uint64_t next = 0;
  const auto read = [&](tbb::flow_control& flow) {
    auto one = std::make_shared<PreparedChunk>();
    if (next == run.chunk_count()) {
      flow.stop();
    } else {
      one->chunk = next++;
      one->answers = chunks(one->chunk);
    }
    return one;
  };
  const auto compress = [&](std::shared_ptr<PreparedChunk> one) {
    prepare(run, *one);
    return one;
  };
  const auto write = [&](const std::shared_ptr<PreparedChunk>& one) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // of this thread
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i]->write(one->chunk, one->columns[i]);
    exceptions.add(one->chunk, one->answers);
  };
  using Piece = std::shared_ptr<PreparedChunk>;
  using Control = tbb::global_control;  // more threads than there may be would be refused with a warning
  const std::size_t threads = std::min(run.options().threads, Control::active_value(Control::max_allowed_parallelism));
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
  arena.execute([&] {
    const auto in_work = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 2;
    tbb::parallel_pipeline(in_work, tbb::make_filter<void, Piece>(tbb::filter_mode::serial_in_order, read) &
                                        tbb::make_filter<Piece, Piece>(tbb::filter_mode::parallel, compress) &
                                        tbb::make_filter<Piece, void>(tbb::filter_mode::serial_in_order, write));
  });
  put_text(file, "exceptions", exceptions.text());
}

void write_all(const std::string& path, const StudyRun& run, const ChunkSource& chunks, const Study& study) {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.get(), H5P_DEFAULT), H5Fclose);
  put_attribute(file.get(), "schema", "zwidth.study_file/1");
  put_attribute(file.get(), "version", ZWIDTH_VERSION);
  put_attribute(file.get(), "samples", run.options().samples);
  put_attribute(file.get(), "seed", run.options().seed);
  put_attribute(file.get(), "sampling", results::name_of(run.options().sampling));
  put_attribute(file.get(), "status_values", "0 finite, 1 none_stable, 2 unbounded, 3 refused");
  put_attribute(file.get(), "verdict_values", "0 sound, 1 doubtful, 2 refused");
  put_text(file.get(), "device", write_device(run.device().parameters()));
  put_text(file.get(), "study", description(run));
  write_columns(file.get(), run, chunks);
  put_text(file.get(), "summary", results::line(results::study_json(run, study)));
  file.close();
}

[[noreturn]] void fail(const std::string& path, const std::string& why, std::string_view remedy) {
  throw report::OutputFailed(fmt::format("{}: cannot write: {}{}", path, why, remedy));
}

}  // namespace

void require_writer() {}

void write_result(const std::string& path, const StudyRun& run, const ChunkSource& chunks, const Study& study) {
  const fs::path temporary = path + ".part";  // nobody else writes it: the checkpoint is locked
  ::unlink(temporary.c_str());                // left by a process that was killed
  // A file that could not be closed stays open in HDF5, which would write to it again when the process ends, and crash.
  // Everything else is closed by its Handle.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    write_all(temporary.string(), run, chunks, study);
  } catch (const Hdf5Failed&) {
    std::error_code error;
    const auto room = fs::space(temporary.parent_path().empty() ? "." : temporary.parent_path(), error);
    ::unlink(temporary.c_str());
    const bool is_full = !error && room.available < (std::uintmax_t{1} << 20U);
    fail(path, is_full ? "No space left on device" : "HDF5 failed",
         "; make room, or name a file where there is, and add --resume: what was computed is kept");
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const int written = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_safe = written >= 0 && ::fsync(written) == 0;
  const int error = errno;
  if (written >= 0) ::close(written);
  if (!is_safe || ::rename(temporary.c_str(), path.c_str()) != 0) {
    const int why = is_safe ? errno : error;
    ::unlink(temporary.c_str());
    fail(path, std::strerror(why), "; add --resume: what was computed is kept");
  }
}

}  // namespace zwidth::study_engine
