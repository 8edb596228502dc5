#include "cli/same_answer.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <future>
#include <optional>
#include <sstream>

#include "zwidth/error.hpp"

namespace zwidth::cli {

void SameAnswer::expect_same(const std::vector<Question>& questions) const {
  std::string commands;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    commands += fmt::format("{0}.out {0}.err {1}\n", i, questions[i].command);
  }
  write("commands", commands);
  std::future<Outcome> run_all =
      std::async(std::launch::async, [&] { return run("LD_PRELOAD='" ZWIDTH_STARTED_ONCE "' zwidth < commands"); });
  std::vector<std::optional<Answer>> answers;
  for (const Question& question : questions) {
    try {
      answers.emplace_back(question.answer());
    } catch (const Error&) {
      answers.emplace_back();
    }
  }
  const Outcome ran = run_all.get();
  ASSERT_EQ(ran.status, 0) << ran.errors;
  std::istringstream statuses(ran.output);
  std::size_t failures = 0;
  std::string told;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    int status = -1;
    statuses >> status;
    std::string printed = contents(fmt::format("{}.out", i));
    if (status == 0 && !questions[i].file.empty()) printed += contents(questions[i].file);
    SCOPED_TRACE(questions[i].command + "\n" + contents(fmt::format("{}.err", i)));
    if (answers[i]) {
      EXPECT_EQ(printed, answers[i]->output);
      EXPECT_EQ(status, answers[i]->status);
    } else {
      EXPECT_EQ(printed, "");
      EXPECT_TRUE(status == 1 || status == 2) << status;
      ++failures;
      told += contents(fmt::format("{}.err", i));
    }
  }
  constexpr double most_failures = 0.05;
  EXPECT_LE(static_cast<double>(failures), most_failures * static_cast<double>(questions.size())) << told;
}

std::size_t how_many(std::size_t usual) {
  const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES");
  return campaign != nullptr ? std::strtoul(campaign, nullptr, 10) : usual;
}

}  // namespace zwidth::cli
