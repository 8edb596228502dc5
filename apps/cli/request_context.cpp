#include "cli/request_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/option_units.hpp"
#include "cli/request_problem.hpp"
#include "cli/subcommand.hpp"

namespace zwidth::cli {
namespace {

InputError no_such_name(const std::string& name, const char* allowed) {
  return InputError(InputProblem{{.file = name}, "is not what came with the request", allowed, {}});
}

const RecordedColumns* columns_in_memory(const RequestContext* own, const std::string& name) {
  if (own == nullptr) return nullptr;
  const auto found = own->columns.find(name);
  return found == own->columns.end() ? nullptr : found->second.get();
}

/// Calls `read` with where the recording of that name lies; errors call it by its name.
template <typename Read>
auto read_by_name(const RequestContext* own, const std::string& name, const Read& read) -> decltype(read(name)) {
  if (own == nullptr) return read(name);
  const auto found = own->recordings.find(name);
  if (found == own->recordings.end()) return tl::unexpected(no_such_name(name, "must be the recording given with it"));
  auto result = read(found->second);
  if (!result && result.error().place.file == found->second) result.error().place.file = name;
  return result;
}

RecordingOptions bounded(const RequestContext* own, RecordingOptions options) {
  if (own != nullptr) options.most_unpacked = std::min(options.most_unpacked, own->bounds.unpacked);
  return options;
}

/// Reading from memory comes before the work that is asked for: the progress of that begins at 0.
Progress of_reading(const RequestContext* own, const Progress& progress) {
  if (own == nullptr || !progress) return progress;
  return [&progress](double) { progress(0.0); };
}

}  // namespace

RequestContext* request_of(const CLI::App& command) {
  const auto* const program = dynamic_cast<const Program*>(command.get_parent());
  return program == nullptr ? nullptr : program->request;
}

void check_samples(const CLI::App& command, const char* option, double samples) {
  const RequestContext* own = request_of(command);
  if (own == nullptr || !(samples > own->bounds.samples)) return;
  throw BadInput(option, fmt::format("makes {:.9g} samples", samples),
                 fmt::format("a request may make at most {:.9g}, the command line more", own->bounds.samples));
}

void check_threads(const CLI::App& command, const char* option, std::size_t threads) {
  const RequestContext* own = request_of(command);
  if (own == nullptr || threads <= own->bounds.threads) return;
  throw BadInput(option, fmt::format("is {}", threads),
                 fmt::format("a request may have at most {}", own->bounds.threads));
}

void hand_over_device(const CLI::App& command, const std::string& text) {
  if (RequestContext* own = request_of(command)) own->device = text;
}

void hand_over_series(const CLI::App& command, const std::string& name, const std::vector<double>& samples) {
  if (RequestContext* own = request_of(command)) own->series[name] = samples;
}

tl::expected<Device, InputError> read_named_device(const CLI::App& command, const std::string& name,
                                                   std::span<const std::string> overrides) {
  const RequestContext* own = request_of(command);
  if (own == nullptr) return read_device_file(name, overrides);
  const auto found = own->devices.find(name);
  if (found == own->devices.end()) return tl::unexpected(no_such_name(name, "must be the device given with it"));
  return parse_device(found->second, name, overrides, own->bounds.files);
}

tl::expected<StudyFile, InputError> read_named_study(const CLI::App& command, const std::string& name,
                                                     const Device& device) {
  const RequestContext* own = request_of(command);
  if (own == nullptr) return read_study_file(name, device);
  if (name != study_name || !own->study) {
    return tl::unexpected(no_such_name(name, "must be the study given with it"));
  }
  if (const auto* path = std::get_if<std::filesystem::path>(&*own->study))
    return read_study_file(path->string(), device);
  return parse_study(std::get<std::string>(*own->study), name, device, std::nullopt);
}

tl::expected<Recording, InputError> read_named_recording(const CLI::App& command, const std::string& name,
                                                         const RecordingOptions& options, const Progress& progress) {
  const RequestContext* own = request_of(command);
  if (const RecordedColumns* columns = columns_in_memory(own, name)) return read_recording(*columns, options);
  const Progress told = of_reading(own, progress);
  auto recording = read_by_name(
      own, name, [&](const std::string& path) { return read_recording(path, bounded(own, options), told); });
  if (recording) recording->source = name;  // not where the system has its bytes
  return recording;
}

tl::expected<RecordingContents, InputError> list_named_recording(const CLI::App& command, const std::string& name,
                                                                 const RecordingOptions& options) {
  const RequestContext* own = request_of(command);
  if (const RecordedColumns* columns = columns_in_memory(own, name)) return list_recording(*columns);
  return read_by_name(own, name, [&](const std::string& path) { return list_recording(path, bounded(own, options)); });
}

tl::expected<FrequencyResponse, InputError> read_named_table(const CLI::App& command, const std::string& name,
                                                             const ResponseTableOptions& options,
                                                             const Progress& progress) {
  const RequestContext* own = request_of(command);
  if (columns_in_memory(own, name) != nullptr) {
    return tl::unexpected(
        InputError(InputProblem{{.file = name}, "is in no file", "a table of a response must be a file", {}}));
  }
  const Progress told = of_reading(own, progress);
  return read_by_name(own, name, [&](const std::string& path) { return read_response_table(path, options, told); });
}

}  // namespace zwidth::cli
