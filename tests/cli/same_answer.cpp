#include "cli/same_answer.hpp"

#include <fmt/format.h>

#include <future>
#include <optional>
#include <sstream>

#include "zwidth/error.hpp"

namespace zwidth::cli {

void SameAnswer::expect_same(const std::vector<Question>& questions) const {
  std::string script;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    script += fmt::format("zwidth {} > {}.out 2> {}.err; echo $?\n", questions[i].command, i, i);
  }
  std::future<Outcome> run_all = std::async(std::launch::async, [&] { return run(script); });
  std::vector<std::optional<Answer>> answers;
  for (const Question& question : questions) {
    try {
      answers.emplace_back(question.answer());
    } catch (const Error&) {
      answers.emplace_back();
    }
  }
  std::istringstream statuses(run_all.get().output);
  std::size_t failures = 0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    int status = -1;
    statuses >> status;
    const std::string printed = contents(fmt::format("{}.out", i));
    SCOPED_TRACE(questions[i].command + "\n" + contents(fmt::format("{}.err", i)));
    if (answers[i]) {
      EXPECT_EQ(printed, answers[i]->output);
      EXPECT_EQ(status, answers[i]->status);
    } else {
      EXPECT_EQ(printed, "");
      EXPECT_TRUE(status == 1 || status == 2) << status;
      ++failures;
    }
  }
  EXPECT_LE(20 * failures, questions.size());
}

}  // namespace zwidth::cli
