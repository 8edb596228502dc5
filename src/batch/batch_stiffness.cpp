#include "zwidth/batch/batch_stiffness.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "batch/kernel/kernel_columns.hpp"
#include "counted.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_user_limit.hpp"
#include "staged_progress.hpp"
#include "thread_arena.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
// Devices: enough of one delay for whole vectors, few enough for the cache; and what takes long is shared out evenly.
constexpr std::size_t kernel_block = 512;
constexpr std::size_t one_by_one_block = 8;

/// Of one thread.
struct Memory {
  internal::KernelAnswers answers;
  internal::BlockScratch scratch;
};

BatchStiffness columns_of(std::size_t count, bool any_user) {
  BatchStiffness columns;
  columns.stiffness.assign(count, none);
  columns.status.assign(count, StiffnessStatus::refused);
  columns.frequency.assign(count, none);
  columns.mode.assign(count, -1);
  columns.poles_leaving.assign(count, 0);
  columns.verdict.assign(count, Trust::Verdict::refused);
  if (any_user) {
    columns.any_user.assign(count, none);
    columns.absolute_stability_frequency.assign(count, none);
  }
  return columns;
}

/// The devices of one call.
class Devices {
 public:
  Devices(const Device& device, std::span<const ParameterValues> changes, const BatchOptions& options)
      : changes_(changes), options_(options), base_(device.parameters()), trust_(trust_of(device)) {
    base_.uncertainty.reset();  // its trust is in the columns
  }

  [[nodiscard]] const DeviceParameters& base() const { return base_; }
  [[nodiscard]] const Trust& trust() const { return trust_; }

  [[nodiscard]] DeviceParameters at(std::size_t i) const {
    DeviceParameters parameters = base_;
    for (const ParameterValues& each : changes_) set_parameter(parameters, each.key, each.values[i]);
    return parameters;
  }

  /// One device, asked as a user of the library would; what is to be said of it besides its numbers.
  [[nodiscard]] BatchException ask(std::size_t i, BatchStiffness& columns) const {
    BatchException said{i, {}, {}};
    std::optional<Device> made;  // once: a mechanism is put to its pose
    try {
      made.emplace(at(i));
    } catch (const Error& error) {
      said.failure = error.what();
      for (const InputProblem& problem : error.problems()) {
        said.failure = fmt::format("{} {}; {}", problem.place.key, problem.what, problem.allowed);
      }
      return said;
    }
    if (trust_.refused()) return said;
    try {
      const Device& device = *made;
      const CriticalStiffness critical = critical_stiffness(device);
      said.trust = critical.trust;
      if (options_.any_user && !said.trust.refused()) said.trust.inherit(ask_absolute_stability(device, i, columns));
      columns.status[i] = critical.status;
      columns.stiffness[i] = critical.stiffness;
      if (critical.limit) {
        columns.frequency[i] = critical.limit->frequency;
        columns.mode[i] = static_cast<std::int16_t>(critical.limit->limited_by.mode);
        columns.poles_leaving[i] = static_cast<std::int8_t>(critical.limit->poles_leaving);
      }
    } catch (const Error& error) {
      said.failure = error.what();
    }
    return said;
  }

  /// The absolute stability limit alone.
  [[nodiscard]] BatchException ask_absolute_stability(std::size_t i, BatchStiffness& columns) const {
    BatchException said{i, {}, {}};
    try {
      said.trust = ask_absolute_stability(Device(at(i)), i, columns);
    } catch (const Error& error) {
      said.failure = error.what();
    }
    return said;
  }

 private:
  [[nodiscard]] static Trust ask_absolute_stability(const Device& device, std::size_t i, BatchStiffness& columns) {
    AbsoluteStabilityLimit limit = internal::known_any_user_limit(device);
    columns.any_user[i] = limit.stiffness;
    columns.absolute_stability_frequency[i] = limit.frequency;
    return std::move(limit.trust);
  }

  std::span<const ParameterValues> changes_;
  const BatchOptions& options_;
  DeviceParameters base_;
  Trust trust_;
};

void take_answer(const internal::KernelAnswers& answers, std::size_t at, std::size_t i, BatchStiffness& columns) {
  columns.status[i] = StiffnessStatus::finite;
  columns.stiffness[i] = answers.stiffness[at];
  columns.frequency[i] = answers.frequency[at];
  columns.mode[i] = answers.mode[at];
  columns.poles_leaving[i] = answers.poles_leaving[at];
}

void withdraw(std::size_t i, BatchStiffness& columns) {
  columns.status[i] = StiffnessStatus::refused;
  columns.stiffness[i] = columns.frequency[i] = none;
  columns.mode[i] = -1;
  columns.poles_leaving[i] = 0;
}

const BatchException* exception_of(const BatchStiffness& columns, std::size_t i) {
  const auto found = std::ranges::lower_bound(columns.exceptions, i, {}, &BatchException::index);
  return found != columns.exceptions.end() && found->index == i ? &*found : nullptr;
}

}  // namespace

std::optional<Oscillator> BatchStiffness::limited_by(std::size_t i) const {
  if (mode[i] < 0) return std::nullopt;
  return Oscillator{mode[i] == 0 ? Oscillator::Kind::rigid_body : Oscillator::Kind::vibration_mode, mode[i]};
}

Trust BatchStiffness::trust_of(std::size_t i) const {
  Trust whole = trust;
  if (const BatchException* said = exception_of(*this, i)) whole.inherit(said->trust);
  return whole;
}

std::string BatchStiffness::failure_of(std::size_t i) const {
  const BatchException* said = exception_of(*this, i);
  return said != nullptr ? said->failure : "";
}

std::optional<OptionProblem> find_problem(const BatchOptions& options, const Device& device) {
  if (options.any_user && !device.is_mechanical()) {
    return option_problem("any_user", {.code = ProblemCode::asked_of_transfer_function});
  }
  if (options.threads > most_batch_threads) {
    return option_problem("threads", {.code = ProblemCode::too_many_threads,
                                      .evidence = {internal::counted("value", options.threads),
                                                   internal::counted("most", most_batch_threads)}});
  }
  return std::nullopt;
}

BatchStiffness batch_stiffness(const Device& device, std::span<const ParameterValues> changes,
                               const BatchOptions& options, const Progress& progress) {
  internal::require_known_structure(device);
  if (const auto problem = find_problem(device, changes)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed));
  }
  if (const auto problem = find_problem(options, device)) {
    throw Error(problem->member == "any_user" ? ErrorCode::needs_bodies : ErrorCode::invalid_argument,
                fmt::format("{} {}; {}", problem->member, problem->what, problem->allowed));
  }
  const std::size_t count = changes.front().values.size();
  const Devices devices(device, changes, options);
  const internal::KernelColumns kernel(devices.base(), changes);
  const bool by_kernel = options.vectorised && kernel.suits() && !devices.trust().refused();
  BatchStiffness columns = columns_of(count, options.any_user);
  columns.trust = devices.trust();
  const std::size_t block_size = by_kernel && !options.any_user ? kernel_block : one_by_one_block;
  const std::size_t blocks = (count + block_size - 1) / block_size;
  std::vector<std::vector<BatchException>> said(blocks);
  std::vector<std::size_t> alone(blocks);
  tbb::enumerable_thread_specific<Memory> memories;
  internal::SharedProgress shared(progress, count);
  const auto compute = [&](std::size_t block) {
    const std::size_t begin = block * block_size;
    const std::size_t end = std::min(count, begin + block_size);
    Memory& memory = memories.local();
    if (by_kernel) kernel.solve(begin, end, memory.answers, memory.scratch);
    std::size_t quick = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const bool certain = by_kernel && memory.answers.certain[i - begin] != 0;
      if (certain) take_answer(memory.answers, i - begin, i, columns);
      if (certain && !options.any_user) {
        columns.verdict[i] = columns.trust.verdict;
        ++quick;
        continue;
      }
      if (!certain) ++alone[block];
      BatchException one = certain ? devices.ask_absolute_stability(i, columns) : devices.ask(i, columns);
      if (!one.failure.empty()) withdraw(i, columns);
      columns.verdict[i] =
          one.failure.empty() ? std::max(one.trust.verdict, columns.trust.verdict) : Trust::Verdict::refused;
      if (!one.trust.sound() || !one.failure.empty()) said[block].push_back(std::move(one));
      shared.add();
    }
    shared.add(quick);
  };
  internal::ThreadArena arena(options.threads);
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, blocks, compute); });
  for (std::vector<BatchException>& each : said) {
    std::ranges::move(each, std::back_inserter(columns.exceptions));
  }
  columns.scalar_count = std::accumulate(alone.begin(), alone.end(), std::size_t{0});
  return columns;
}

}  // namespace zwidth
