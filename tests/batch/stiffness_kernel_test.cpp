// What holds of the kernel whatever the machine: threads, neighbours and instruction sets.

#include "batch/kernel/stiffness_kernel.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/batch/batch_stiffness.hpp"

namespace zwidth {
namespace {

constexpr unsigned seed = 7;
const Device device{test::lhifam_parameters()};
const Device rigid{test::rigid_parameters()};

// Delays, dampers and lags of all kinds side by side: every group of the kernel.
std::vector<ParameterValues> mixed(std::size_t count) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> share(0.3, 3.0);
  std::uniform_int_distribution<int> kind(0, 3);
  std::vector<ParameterValues> changes{{"link.stiffness", {}}, {"link.damping", {}},
                                       {"loop.delay", {}},     {"actuator.time_constant", {}},
                                       {"wall.damping", {}},   {"wall.velocity_filter_hz", {}}};
  for (std::size_t i = 0; i < count; ++i) {
    changes[0].values.push_back(79.5e3 * share(engine));
    changes[1].values.push_back(15.0 * share(engine));
    const int delay = kind(engine);
    changes[2].values.push_back(delay == 0 ? 0.0 : delay == 1 ? 2e-3 : 3e-3 * share(engine));
    changes[3].values.push_back(kind(engine) == 0 ? 3e-4 * share(engine) : 0.0);
    changes[4].values.push_back(kind(engine) == 0 ? 3.0 * share(engine) : 0.0);
    changes[5].values.push_back(kind(engine) == 0 ? 100.0 * share(engine) : 0.0);
  }
  return changes;
}

// Their polynomial is of degree 1: free and tied ones, with and without a damper, from slow sampling to fast.
std::vector<ParameterValues> rigid_without_delay(std::size_t count) {
  std::mt19937_64 engine(seed);
  const auto log_uniform = [&engine](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(engine));
  };
  std::uniform_int_distribution<int> kind(0, 3);
  std::vector<ParameterValues> changes{{"body.body.mass", {}},
                                       {"body.body.damping", {}},
                                       {"body.body.stiffness", {}},
                                       {"loop.sampling_period", {}},
                                       {"wall.damping", {}}};
  for (std::size_t i = 0; i < count; ++i) {
    changes[0].values.push_back(log_uniform(0.05, 20.0));
    changes[1].values.push_back(log_uniform(1e-3, 50.0));
    changes[2].values.push_back(kind(engine) == 0 ? log_uniform(1.0, 1e5) : 0.0);
    changes[3].values.push_back(log_uniform(5e-5, 0.5));  // e^{-bT/m} from 1 - 1e-8 to 0
    changes[4].values.push_back(kind(engine) == 0 ? log_uniform(1e-2, 20.0) : 0.0);
  }
  return changes;
}

bool are_identical(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(StiffnessKernel, DoesNotDependOnThreads) {
  const std::vector<ParameterValues> changes = mixed(3000);
  BatchOptions options;
  options.threads = 1;
  const BatchStiffness one = batch_stiffness(device, changes, options);
  EXPECT_LT(one.scalar_count, one.size() / 2);
  for (const std::size_t threads : {2U, 7U}) {
    options.threads = threads;
    const BatchStiffness many = batch_stiffness(device, changes, options);
    EXPECT_TRUE(are_identical(one.stiffness, many.stiffness)) << threads;
    EXPECT_TRUE(are_identical(one.frequency, many.frequency)) << threads;
    EXPECT_EQ(one.mode, many.mode);
    EXPECT_EQ(one.status, many.status);
    EXPECT_EQ(one.scalar_count, many.scalar_count);
  }
}

TEST(StiffnessKernel, DoesNotDependOnNeighbours) {
  const std::vector<ParameterValues> changes = mixed(1000);
  const BatchStiffness all = batch_stiffness(device, changes);
  std::vector<ParameterValues> part = changes;
  for (const std::size_t begin : {1U, 3U, 500U, 993U}) {
    for (std::size_t k = 0; k < changes.size(); ++k) {
      part[k].values.assign(changes[k].values.begin() + static_cast<std::ptrdiff_t>(begin), changes[k].values.end());
      std::reverse(part[k].values.begin(), part[k].values.end());
    }
    BatchStiffness some = batch_stiffness(device, part);
    std::reverse(some.stiffness.begin(), some.stiffness.end());
    EXPECT_TRUE(are_identical(some.stiffness,
                              {all.stiffness.begin() + static_cast<std::ptrdiff_t>(begin), all.stiffness.end()}))
        << begin;
  }
}

// Devices; ZWIDTH_PROPERTY_CASES overrides.
std::size_t cases() {
  const char* wish = std::getenv("ZWIDTH_PROPERTY_CASES");
  return wish != nullptr ? std::max<std::size_t>(100, std::strtoul(wish, nullptr, 10)) : 20'000;
}

// Each instruction set of this machine by itself, one lane to AVX-512 (Highway's test targets).
void expect_that_instruction_sets_agree(const Device& base, const std::vector<ParameterValues>& changes) {
  const BatchStiffness best = batch_stiffness(base, changes);
  std::size_t sets = 0;
  for (std::int64_t targets = hwy::SupportedTargets(), one = 0; targets != 0; targets -= one) {
    one = targets & -targets;
    hwy::SetSupportedTargetsForTest(one);
    hwy::GetChosenTarget().Update(one);
    const BatchStiffness other = batch_stiffness(base, changes);
    ++sets;
    EXPECT_LT(other.scalar_count, other.size() / 2) << hwy::TargetName(one);
    for (std::size_t i = 0; i < best.size(); ++i) {
      EXPECT_LE(std::abs(other.stiffness[i] - best.stiffness[i]), 1e-12 * best.stiffness[i])
          << hwy::TargetName(one) << ", device " << i;
      EXPECT_EQ(other.mode[i], best.mode[i]);
      EXPECT_EQ(other.status[i], best.status[i]);
      EXPECT_EQ(other.poles_leaving[i], best.poles_leaving[i]);
    }
    std::printf("%s: %zu devices, %zu one by one\n", hwy::TargetName(one), other.size(), other.scalar_count);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  EXPECT_GE(sets, 1U);
}

TEST(StiffnessKernel, InstructionSetsAgree) {
  expect_that_instruction_sets_agree(device, mixed(cases()));
  expect_that_instruction_sets_agree(rigid, rigid_without_delay(cases()));
}

TEST(StiffnessKernel, RigidDevicesWithoutDelayAreAnsweredAsAlone) {
  const std::vector<ParameterValues> changes = rigid_without_delay(cases());
  const BatchStiffness found = batch_stiffness(rigid, changes);
  const BatchStiffness alone = batch_stiffness(rigid, changes, {.vectorised = false});
  EXPECT_LT(found.scalar_count, found.size() / 5);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found.status[i], alone.status[i]) << i;
    EXPECT_EQ(found.mode[i], alone.mode[i]) << i;
    EXPECT_EQ(found.poles_leaving[i], alone.poles_leaving[i]) << i;
    EXPECT_EQ(found.verdict[i], alone.verdict[i]) << i;
    if (alone.status[i] != StiffnessStatus::finite) continue;
    EXPECT_LE(std::abs(found.stiffness[i] - alone.stiffness[i]), 1e-12 * alone.stiffness[i]) << i;
    EXPECT_LE(std::abs(found.frequency[i] - alone.frequency[i]), 1e-12 * alone.frequency[i]) << i;
  }
}

// Values at every edge of what a device may be: none may crash, hang or pass for certain where the library refuses.
TEST(StiffnessKernel, ExtremeValuesAreAnsweredAsAlone) {
  const double extremes[] = {0.0, 1e-30, 1e-12, 1e-3, 1.0, 1e5, 1e12, 1e30, -1.0, std::nan(""), 1e300};
  for (const char* key : {"body.motor.mass", "body.handle.damping", "link.stiffness", "link.damping", "loop.delay",
                          "loop.sampling_period", "actuator.time_constant", "wall.damping", "wall.velocity_filter_hz",
                          "operator.mass", "operator.stiffness"}) {
    const std::vector<ParameterValues> changes{{key, {std::begin(extremes), std::end(extremes)}}};
    BatchOptions alone;
    alone.vectorised = false;
    if (find_problem(device, changes)) continue;
    const BatchStiffness expected = batch_stiffness(device, changes, alone);
    const BatchStiffness found = batch_stiffness(device, changes);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found.status[i], expected.status[i]) << key << " = " << extremes[i];
      EXPECT_EQ(found.mode[i], expected.mode[i]) << key << " = " << extremes[i];
      EXPECT_EQ(found.failure_of(i), expected.failure_of(i));
      if (std::isfinite(expected.stiffness[i])) {
        EXPECT_NEAR(found.stiffness[i], expected.stiffness[i], 1e-12 * expected.stiffness[i]) << key << extremes[i];
      }
    }
  }
}

}  // namespace
}  // namespace zwidth
