// SPDX-License-Identifier: Apache-2.0
// A command line, one argument a line of the input. It is parsed, and not carried out.
#include <iostream>

#include "gateway/commands/command_line.hpp"
#include "gateway/commands/common/exit_codes.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/targets.hpp"

namespace axisgate::fuzz {
namespace {

void command_line(Bytes content) {
  const std::vector<std::string> words = words_of("axisgate", content);
  std::vector<const char*> arguments;
  for (const std::string& each : words) arguments.push_back(each.c_str());
  // Help and complaints are not looked at.
  std::streambuf* const out = std::cout.rdbuf(nullptr);
  std::streambuf* const err = std::cerr.rdbuf(nullptr);
  const commands::CommandLine line = commands::parse_command_line(static_cast<int>(arguments.size()), arguments.data());
  std::cout.rdbuf(out);
  std::cerr.rdbuf(err);
  must(line.run != nullptr || line.exit_code == 0 || line.exit_code == commands::kWrongCommandLine,
       "a command line is carried out, or wrong");
}

}  // namespace
}  // namespace axisgate::fuzz

int axisgate_fuzz_command_line(const std::uint8_t* data, std::size_t size) {
  axisgate::fuzz::command_line({data, size});
  return 0;
}
