#include "zwidth/words/problem_text.hpp"

#include <algorithm>
#include <utility>

#include "words/phrase.hpp"
#include "words/problem_phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {
namespace {

const internal::ProblemPhrase& problem_phrase_of(ProblemCode code) {
  const auto all = internal::problem_phrases();
  const auto found = std::ranges::find(all, code, &internal::ProblemPhrase::code);
  if (found == all.end()) throw Error(ErrorCode::invalid_argument, "a problem's code has no words");
  return *found;
}

std::string line_of(const Problem& problem) {
  const ProblemWords words = words_of(problem);
  return words.allowed.empty() ? words.what : words.what + "; " + words.allowed;
}

}  // namespace

std::string_view name_of(ProblemCode code) { return problem_phrase_of(code).name; }

ProblemWords words_of(const Problem& problem) {
  const internal::ProblemPhrase& phrase = problem_phrase_of(problem.code);
  const Finding facts{.evidence = problem.evidence, .subjects = problem.subjects};
  return {internal::filled_in(facts, phrase.what), internal::filled_in(facts, phrase.allowed)};
}

Error::Error(ErrorCode code, const Problem& problem) : std::runtime_error(line_of(problem)), code_(code) {}

OptionProblem option_problem(std::string member, Problem problem) {
  ProblemWords words = words_of(problem);
  return {std::move(member), std::move(words.what), std::move(words.allowed), std::move(problem)};
}

DeviceProblem device_problem(std::string key, Problem problem) {
  ProblemWords words = words_of(problem);
  return {std::move(key), std::move(words.what), std::move(words.allowed), std::move(problem)};
}

}  // namespace zwidth
