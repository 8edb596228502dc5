#include "zwidth/study/sobol_indices.hpp"

#include <cmath>
#include <utility>

#include "counted.hpp"
#include "require_argument.hpp"
#include "zwidth/error.hpp"
#include "zwidth/study/sampling_plan.hpp"

namespace zwidth {
namespace {

constexpr double rounding = 1e-11;  // of an answer: less is no variance

struct MeanAndError {
  double mean = 0.0;
  double error = 0.0;
};

template <typename Term>
MeanAndError mean_of(std::size_t count, const Term& term) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += term(i);
  const double mean = sum / static_cast<double>(count);
  double square = 0.0;
  for (std::size_t i = 0; i < count; ++i) square += (term(i) - mean) * (term(i) - mean);
  const auto n = static_cast<double>(count);
  return {mean, std::sqrt(square / (n * (n - 1.0)))};
}

std::vector<double> checked(std::vector<double> values, std::size_t count) {
  if (values.size() != count) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::answers_not_one_a_point});
  for (const double value : values) {
    internal::require_argument(std::isfinite(value), ProblemCode::not_finite, {"an answer", value});
  }
  return values;
}

}  // namespace

std::vector<SobolIndex> sobol_indices(std::size_t dimensions, std::uint64_t samples, std::uint64_t seed,
                                      const ManyAnswers& answers) {
  if (dimensions < 1 || dimensions > most_index_dimensions || samples < 2) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::indices_not_possible,
                 .evidence = {internal::counted("dimensions", dimensions), internal::counted("samples", samples),
                              internal::counted("most", most_index_dimensions)}});
  }
  const SamplingPlan plan(SamplingScheme::sobol, samples, 2 * dimensions, seed);
  const auto count = static_cast<std::size_t>(samples);
  std::vector<std::vector<double>> of_a(dimensions, std::vector<double>(count));
  std::vector<std::vector<double>> of_b = of_a;
  for (std::size_t j = 0; j < dimensions; ++j) {
    for (std::size_t i = 0; i < count; ++i) {
      of_a[j][i] = plan.uniform(i, j);
      of_b[j][i] = plan.uniform(i, dimensions + j);
    }
  }
  std::vector<double> a = checked(answers(of_a), count);
  std::vector<double> b = checked(answers(of_b), count);
  // About their mean, so that the first-order products do not carry its square.
  const double mean = mean_of(count, [&](std::size_t i) { return 0.5 * (a[i] + b[i]); }).mean;
  for (double& value : a) value -= mean;
  for (double& value : b) value -= mean;
  const double variance = mean_of(count, [&](std::size_t i) { return 0.5 * (a[i] * a[i] + b[i] * b[i]); }).mean;
  std::vector<SobolIndex> indices(dimensions);
  if (!(variance > rounding * rounding * mean * mean)) return indices;
  for (std::size_t j = 0; j < dimensions; ++j) {
    std::swap(of_a[j], of_b[j]);
    std::vector<double> mixed = checked(answers(of_a), count);
    std::swap(of_a[j], of_b[j]);
    for (double& value : mixed) value -= mean;
    const MeanAndError first = mean_of(count, [&](std::size_t i) { return b[i] * (mixed[i] - a[i]); });
    const MeanAndError total =
        mean_of(count, [&](std::size_t i) { return 0.5 * (a[i] - mixed[i]) * (a[i] - mixed[i]); });
    indices[j] = {first.mean / variance, first.error / variance, total.mean / variance, total.error / variance};
  }
  return indices;
}

}  // namespace zwidth
