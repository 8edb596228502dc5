#include "zwidth/batch/batch_stiffness.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t block_size = 64;  // devices between two looks at the progress

BatchStiffness columns_of(std::size_t count, bool any_user) {
  BatchStiffness columns;
  columns.stiffness.assign(count, none);
  columns.status.assign(count, StiffnessStatus::refused);
  columns.frequency.assign(count, none);
  columns.mode.assign(count, -1);
  columns.verdict.assign(count, Trust::Verdict::refused);
  if (any_user) {
    columns.any_user.assign(count, none);
    columns.any_user_frequency.assign(count, none);
  }
  return columns;
}

/// One device, asked as a user of the library would; what is to be said of it besides its numbers.
BatchException answer_alone(DeviceParameters parameters, std::size_t i, const BatchOptions& options,
                            BatchStiffness& columns) {
  BatchException said{i, {}, {}};
  if (const auto problem = find_problem(parameters)) {
    said.failure = fmt::format("{} {}; {}", problem->key, problem->what, problem->allowed);
    return said;
  }
  if (columns.trust.refused()) return said;
  try {
    const Device device(std::move(parameters));
    const CriticalStiffness critical = critical_stiffness(device);
    said.trust = critical.trust;
    if (options.any_user && !said.trust.refused()) {
      const AnyUserLimit limit = any_user_limit(device, virtual_damper(device));
      said.trust.inherit(limit.trust);
      columns.any_user[i] = limit.stiffness;
      columns.any_user_frequency[i] = limit.frequency;
    }
    columns.status[i] = critical.status;
    columns.stiffness[i] = critical.stiffness;
    if (critical.limit) {
      columns.frequency[i] = critical.limit->frequency;
      columns.mode[i] = static_cast<std::int16_t>(critical.limit->limited_by.mode);
    }
  } catch (const Error& error) {
    said.failure = error.what();
  }
  return said;
}

const BatchException* exception_of(const BatchStiffness& columns, std::size_t i) {
  const auto found = std::ranges::lower_bound(columns.exceptions, i, {}, &BatchException::index);
  return found != columns.exceptions.end() && found->index == i ? &*found : nullptr;
}

}  // namespace

std::optional<Mechanism> BatchStiffness::limited_by(std::size_t i) const {
  if (mode[i] < 0) return std::nullopt;
  return Mechanism{mode[i] == 0 ? Mechanism::Kind::rigid_body : Mechanism::Kind::vibration_mode, mode[i]};
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
  if (options.any_user && !device.has_bodies()) {
    return OptionProblem{"any_user", "is asked of a transfer function", "it has no body for a user to hold"};
  }
  if (options.threads > most_batch_threads) {
    return OptionProblem{"threads", fmt::format("is {}", options.threads),
                         fmt::format("must be 0 (all cores) to {}", most_batch_threads)};
  }
  return std::nullopt;
}

BatchStiffness batch_stiffness(const Device& device, std::span<const ParameterValues> changes,
                               const BatchOptions& options, const Progress& progress) {
  if (const auto problem = find_problem(device, changes)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed));
  }
  if (const auto problem = find_problem(options, device)) {
    throw Error(problem->member == "any_user" ? ErrorCode::needs_bodies : ErrorCode::invalid_argument,
                fmt::format("{} {}; {}", problem->member, problem->what, problem->allowed));
  }
  const std::size_t count = changes.front().values.size();
  BatchStiffness columns = columns_of(count, options.any_user);
  columns.trust = trust_of(device);
  DeviceParameters base = device.parameters();
  base.uncertainty.reset();  // its trust is in the columns
  const std::size_t blocks = (count + block_size - 1) / block_size;
  std::vector<std::vector<BatchException>> said(blocks);
  internal::SharedProgress shared(progress, count);
  const auto compute = [&](std::size_t block) {
    const std::size_t end = std::min(count, (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
      DeviceParameters parameters = base;
      for (const ParameterValues& each : changes) set_parameter(parameters, each.key, each.values[i]);
      BatchException one = answer_alone(std::move(parameters), i, options, columns);
      columns.verdict[i] = one.failure.empty() ? std::max(one.trust.verdict, columns.trust.verdict)
                                               : Trust::Verdict::refused;
      if (!one.trust.sound() || !one.failure.empty()) said[block].push_back(std::move(one));
      if (options.any_user) shared.add();
    }
    if (!options.any_user) shared.add(end - block * block_size);
  };
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic : static_cast<int>(options.threads));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, blocks, compute); });
  for (std::vector<BatchException>& each : said) {
    std::ranges::move(each, std::back_inserter(columns.exceptions));
  }
  columns.scalar_count = count;
  return columns;
}

}  // namespace zwidth
