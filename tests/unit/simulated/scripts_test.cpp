// SPDX-License-Identifier: Apache-2.0
// Plays the scripts: what the makers' manuals say of their drives and no vector states, and the few behaviours that the
// rest of the tests build on.
#include "tests/unit/simulated/script.hpp"

namespace axisgate::simulated {

// gtest prints a failing case by its name.
void PrintTo(const Script& it, std::ostream* out) { *out << it.name; }

namespace {

class Scripts : public testing::TestWithParam<Script> {};

std::string with_row(std::string text, const Row& row) {
  for (std::size_t i = row.size(); i > 0; --i) {
    const std::string mark = "$" + std::to_string(i);
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
      text.replace(at, mark.size(), row[i - 1]);
    }
  }
  return text;
}

TEST_P(Scripts, comes_true) {
  const Script& script = GetParam();
  ASSERT_FALSE(script.lines.empty() || script.steps.empty());
  for (const std::string& line : script.lines) {
    for (const Row& row : script.rows.empty() ? std::vector<Row>{{}} : script.rows) {
      SCOPED_TRACE(with_row(line, row) + "\n" + with_row(script.steps, row));
      const auto scene = scene_on(with_row(line, row));
      play(*scene, with_row(script.steps, row));
    }
  }
}

const auto name_of_script = [](const testing::TestParamInfo<Script>& info) { return info.param.name; };

INSTANTIATE_TEST_SUITE_P(drives, Scripts, testing::ValuesIn(all_scripts()), name_of_script);

}  // namespace
}  // namespace axisgate::simulated
