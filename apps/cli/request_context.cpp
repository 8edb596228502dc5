#include "cli/request_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/request_problem.hpp"
#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

thread_local RequestContext* of_this_thread = nullptr;

InputError no_such_name(const std::string& name, const char* allowed) {
  return InputError(InputProblem{{.file = name}, "is not what came with the request", allowed, {}});
}

const RecordedColumns* columns_in_memory(const std::string& name) {
  const RequestContext* own = of_this_thread;
  if (own == nullptr) return nullptr;
  const auto found = own->columns.find(name);
  return found == own->columns.end() ? nullptr : found->second.get();
}

/// Calls `read` with where the recording of that name lies; errors call it by its name.
template <typename Read>
auto read_by_name(const std::string& name, const Read& read) -> decltype(read(name)) {
  const RequestContext* own = of_this_thread;
  if (own == nullptr) return read(name);
  const auto found = own->recordings.find(name);
  if (found == own->recordings.end()) return tl::unexpected(no_such_name(name, "must be the recording given with it"));
  auto result = read(found->second);
  if (!result && result.error().place.file == found->second) result.error().place.file = name;
  return result;
}

RecordingOptions bounded(const RecordingOptions& options) {
  RecordingOptions own = options;
  if (of_this_thread != nullptr) own.most_unpacked = std::min(own.most_unpacked, of_this_thread->bounds.unpacked);
  return own;
}

/// Reading from memory comes before the work that is asked for: the progress of that begins at 0.
Progress of_reading(const Progress& progress) {
  if (of_this_thread == nullptr || !progress) return progress;
  return [&progress](double) { progress(0.0); };
}

}  // namespace

RequestContext* request_context() { return of_this_thread; }

void check_samples(const char* option, double samples) {
  if (of_this_thread == nullptr || !(samples > of_this_thread->bounds.samples)) return;
  throw BadInput(
      option, fmt::format("makes {:.9g} samples", samples),
      fmt::format("a request may make at most {:.9g}, the command line more", of_this_thread->bounds.samples));
}

void check_threads(const char* option, std::size_t threads) {
  if (of_this_thread == nullptr || threads <= of_this_thread->bounds.threads) return;
  throw BadInput(option, fmt::format("is {}", threads),
                 fmt::format("a request may have at most {}", of_this_thread->bounds.threads));
}

void hand_over_device(const std::string& text) {
  if (of_this_thread != nullptr) of_this_thread->device = text;
}

void hand_over_series(const std::string& name, const std::vector<double>& samples) {
  if (of_this_thread != nullptr) of_this_thread->series[name] = samples;
}

InRequestContext::InRequestContext(RequestContext& own) { of_this_thread = &own; }

InRequestContext::~InRequestContext() { of_this_thread = nullptr; }

tl::expected<Device, InputError> read_named_device(const std::string& name, std::span<const std::string> overrides) {
  const RequestContext* own = of_this_thread;
  if (own == nullptr) return read_device_file(name, overrides);
  const auto found = own->devices.find(name);
  if (found == own->devices.end()) return tl::unexpected(no_such_name(name, "must be the device given with it"));
  return parse_device(found->second, name, overrides);
}

tl::expected<StudyFile, InputError> read_named_study(const std::string& name, const Device& device) {
  const RequestContext* own = of_this_thread;
  if (own == nullptr) return read_study_file(name, device);
  if (name != study_name || !own->study) {
    return tl::unexpected(no_such_name(name, "must be the study given with it"));
  }
  if (const auto* path = std::get_if<std::filesystem::path>(&*own->study))
    return read_study_file(path->string(), device);
  return parse_study(std::get<std::string>(*own->study), name, device, std::nullopt);
}

tl::expected<Recording, InputError> read_named_recording(const std::string& name, const RecordingOptions& options,
                                                         const Progress& progress) {
  if (const RecordedColumns* columns = columns_in_memory(name)) return read_recording(*columns, options);
  const Progress told = of_reading(progress);
  auto recording =
      read_by_name(name, [&](const std::string& path) { return read_recording(path, bounded(options), told); });
  if (recording) recording->source = name;  // not where the system has its bytes
  return recording;
}

tl::expected<RecordingContents, InputError> list_named_recording(const std::string& name,
                                                                 const RecordingOptions& options) {
  if (const RecordedColumns* columns = columns_in_memory(name)) return list_recording(*columns);
  return read_by_name(name, [&](const std::string& path) { return list_recording(path, bounded(options)); });
}

tl::expected<FrequencyResponse, InputError> read_named_table(const std::string& name,
                                                             const ResponseTableOptions& options,
                                                             const Progress& progress) {
  if (columns_in_memory(name) != nullptr) {
    return tl::unexpected(
        InputError(InputProblem{{.file = name}, "is in no file", "a table of a response must be a file", {}}));
  }
  const Progress told = of_reading(progress);
  return read_by_name(name, [&](const std::string& path) { return read_response_table(path, options, told); });
}

}  // namespace zwidth::cli
