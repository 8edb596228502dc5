#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "on_demand/on_demand.hpp"

namespace zwidth {
namespace {

[[noreturn]] void refuse_module(std::string_view why) {
  throw std::runtime_error(fmt::format(
      "a part of zwidth cannot be loaded: {}; it is in the package zwidth, in the folder {} from that of the program",
      why, ZWIDTH_MODULES));
}

/// The bytes that a shared object has by its tables of segments and sections; 0 where it is none.
std::uint64_t stated_size(std::ifstream& file) {
  ElfW(Ehdr) header{};
  file.read(reinterpret_cast<char*>(&header), sizeof header);
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return 0;
  std::uint64_t end = header.e_shoff + std::uint64_t{header.e_shnum} * header.e_shentsize;
  file.seekg(static_cast<std::streamoff>(header.e_phoff));
  ElfW(Phdr) segment{};
  for (unsigned i = 0; i < header.e_phnum && file.read(reinterpret_cast<char*>(&segment), sizeof segment); ++i) {
    end = std::max<std::uint64_t>(end, segment.p_offset + segment.p_filesz);
  }
  return end;
}

/// dlopen() maps a file that is cut short, and the program ends at the first page that is not there.
void refuse_cut_module(const char* name) {
  std::error_code no_path;
  const std::filesystem::path path =
      std::filesystem::read_symlink("/proc/self/exe", no_path).parent_path() / ZWIDTH_MODULES / name;
  std::ifstream file(path, std::ios::binary);
  if (!file) return;  // dlopen() says why
  const std::uint64_t stated = stated_size(file);
  const std::uint64_t there = std::filesystem::file_size(path);
  if (there < stated) refuse_module(fmt::format("{} is cut short, {} bytes of {}", name, there, stated));
}

/// Of the module's file, which stands in the program's run path; it stays loaded.
template <typename Functions>
const void* functions_of_module() {
  refuse_cut_module(Functions::file);
  void* const module = dlopen(Functions::file, RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) refuse_module(dlerror());
  void* const exported = dlsym(module, Functions::name);
  if (exported != nullptr) {
    const on_demand::Module own = reinterpret_cast<decltype(&zwidth_fits)>(exported)();
    if (std::string_view(own.build) == on_demand::build) return own.functions;
  }
  refuse_module(fmt::format("{} is of another build than the program", Functions::file));
}

template <typename Functions>
const Functions& loaded() {
  static const void* const functions = functions_of_module<Functions>();
  return *static_cast<const Functions*>(functions);
}

}  // namespace

namespace internal {

LeastSquares least_squares(const FitModel& model, const FitData& data, const Eigen::VectorXd& start,
                           const LeastSquaresOptions& options, const Pull& pull) {
  return loaded<on_demand::Fits>().least_squares(model, data, start, options, pull);
}

tl::expected<MatFile, InputError> open_mat73_file(const std::string& path) {
  return loaded<on_demand::Fits>().open_mat73_file(path);
}

ModalForm exact_modal_form(const Device& device, const WeightedPath& path, const DrivePath& drive,
                           const PoleLabels& labels, std::shared_ptr<ExactlyFound>& found) {
  return loaded<on_demand::Digits>().exact_modal_form(device, path, drive, labels, found);
}

ExtendedTerm sample_exactly(const ModalTerm& term, const SamplingInstants& instants) {
  return loaded<on_demand::Digits>().sample_exactly(term, instants);
}

std::optional<int> unstable_poles_in_digits(const Device& device, double stiffness) {
  return loaded<on_demand::Digits>().unstable_poles_in_digits(device, stiffness);
}

void polish_poles_in_digits(const Device& device, std::vector<PoleOnCircle>& poles) {
  loaded<on_demand::Digits>().polish_poles_in_digits(device, poles);
}

void solve_group(const KernelGroup& group, const KernelDevices& devices, std::size_t count, KernelAnswers& answers,
                 KernelScratch& scratch) {
  loaded<on_demand::Kernel>().solve_group(group, devices, count, answers, scratch);
}

#ifdef ZWIDTH_MUJOCO
std::shared_ptr<const MujocoFile> open_mujoco_file(const MechanismFile& file) {
  return loaded<on_demand::Mechanisms>().open_mujoco_file(file);
}
#endif

}  // namespace internal

namespace study_engine {

void require_writer() { static_cast<void>(loaded<on_demand::Fits>()); }

void write_result(const std::string& path, const StudyRun& run, const ChunkSource& chunks, const Study& study) {
  loaded<on_demand::Fits>().write_result(path, run, chunks, study);
}

}  // namespace study_engine

namespace server {

std::string sha256(std::string_view bytes) { return loaded<on_demand::Crypto>().sha256(bytes); }

bool equal_in_constant_time(std::string_view one, std::string_view other) {
  return loaded<on_demand::Crypto>().equal_in_constant_time(one, other);
}

}  // namespace server
}  // namespace zwidth
