#include "zwidth/option_text.hpp"

#include <string_view>

#include "zwidth/input_problem.hpp"

namespace zwidth {
namespace {

constexpr std::string_view letters_of_members = "abcdefghijklmnopqrstuvwxyz_";

void name_options_in(std::string& text, std::vector<NamedOption>& options,
                     const std::function<std::optional<std::string>(const std::string&)>& called) {
  std::size_t longer = 0;  // modulo 2^64: the text so far may have become shorter
  for (NamedOption& option : options) {
    option.at += longer;
    std::optional<std::string> name = called(option.name);
    if (!name) continue;
    text.replace(option.at, option.length, *name);
    longer += name->size() - option.length;
    option.length = name->size();
    option.name = *std::move(name);
  }
}

}  // namespace

std::vector<NamedOption> options_named_in(std::string_view phrase) {
  constexpr char quote = '`';
  std::vector<NamedOption> options;
  for (std::size_t begin = phrase.find(quote); begin != std::string_view::npos;) {
    const std::size_t end = phrase.find_first_not_of(letters_of_members, begin + 1);
    const bool is_member = end != std::string_view::npos && end > begin + 1 && phrase[end] == quote;
    if (is_member) {
      options.push_back({std::string(phrase.substr(begin + 1, end - begin - 1)), begin, end + 1 - begin});
    }
    begin = phrase.find(quote, is_member ? end + 1 : begin + 1);
  }
  return options;
}

OptionText::OptionText(const char* literal) : text(literal), options(options_named_in(text)) {}

OptionText operator+(OptionText begin, const OptionText& end) {
  for (NamedOption option : end.options) {
    option.at += begin.text.size();
    begin.options.push_back(std::move(option));
  }
  begin.text += end.text;
  return begin;
}

void InputProblem::allow(OptionText remedy) {
  allowed = std::move(remedy.text);
  options_of_allowed = std::move(remedy.options);
}

void InputProblem::begin_with(const std::string& text) {
  what.insert(0, text);
  for (NamedOption& option : options_of_what) option.at += text.size();
}

void InputProblem::name_options(const std::function<std::optional<std::string>(const std::string&)>& called) {
  name_options_in(what, options_of_what, called);
  name_options_in(allowed, options_of_allowed, called);
}

}  // namespace zwidth
