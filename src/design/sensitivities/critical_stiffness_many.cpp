#include "zwidth/design/critical_stiffness_many.hpp"

#include <cstddef>

#include "zwidth/batch/batch_stiffness.hpp"

namespace zwidth {

std::vector<CriticalStiffnessOfOne> critical_stiffness_many(const Device& device,
                                                            std::span<const ParameterValues> changes,
                                                            const Progress& progress) {
  const BatchStiffness columns = batch_stiffness(device, changes, {}, progress);
  std::vector<CriticalStiffnessOfOne> answers(columns.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    answers[i] = {columns.status[i],    columns.stiffness[i], columns.frequency[i], columns.limited_by(i), {},
                  columns.failure_of(i)};
    if (answers[i].failure.empty()) answers[i].trust = columns.trust_of(i);
  }
  return answers;
}

}  // namespace zwidth
