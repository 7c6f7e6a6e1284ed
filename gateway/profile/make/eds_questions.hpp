// SPDX-License-Identifier: Apache-2.0
// What no EDS says of a drive, as the questions of a profile ("ask"): each with where manuals have the answer, and what
// must not happen while it is open.
// Promises one question for each constant that nobody gives, and for each fact that would have to be guessed. Never
// answers one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/profile/eds/eds.hpp"

namespace axisgate::profile {

/// Adds to "ask" of `wanted`, and each open question to `questions` in words. A number that the EDS gives and that
/// cannot be right (one count a turn) is not read from the drive.
void ask_questions(const Eds& eds, nlohmann::json& wanted, std::vector<std::string>& questions);

/// One entry of "ask"; replaces none that asks for the same.
struct Question {
  std::string of, text, where;
  std::vector<std::string> before;
};
void add_question(nlohmann::json& document, const Question& question);
/// Each entry of "ask" in one line, in their order.
[[nodiscard]] std::vector<std::string> question_lines(const nlohmann::json& document);

}  // namespace axisgate::profile
