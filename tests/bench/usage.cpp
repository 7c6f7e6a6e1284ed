// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/usage.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace axisgate::bench {

Usage usage_of(pid_t pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  std::ifstream stat(folder + "/stat");
  std::string text(std::istreambuf_iterator<char>(stat), {});
  // proc(5): utime and stime are fields 14 and 15, the second one, in brackets, may hold blanks.
  text = text.substr(text.rfind(')') + 2);
  std::size_t at = 0;
  for (int field = 3; field < 14; ++field) at = text.find(' ', at) + 1;
  char* rest = nullptr;
  const double user = std::strtod(text.c_str() + at, &rest);
  const double system = std::strtod(rest, nullptr);
  std::ifstream statm(folder + "/statm");
  double pages = 0, resident = 0;
  statm >> pages >> resident;
  return {(user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK)),
          resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1024 * 1024)};
}

}  // namespace axisgate::bench
