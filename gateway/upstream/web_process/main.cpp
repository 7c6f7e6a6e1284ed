// SPDX-License-Identifier: Apache-2.0
// axisgate-web: the page and the API of axisgate, in a process of their own.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"
#include "gateway/upstream/web_process/options.hpp"
#include "gateway/upstream/web_process/serve_command.hpp"

namespace {

int run(int argc, char** argv) {
  try {
    const auto parsed = axisgate::web::parse_command_line(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    return axisgate::web::run(std::get<axisgate::web::ServeOptions>(parsed));
  } catch (const axisgate::program::StartError& error) {
    std::fprintf(stderr, "axisgate-web: %s\n", error.what());
    return error.exit_code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "axisgate-web: %s\n", error.what());
    return axisgate::link::kExitInternal;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int exit_code = run(argc, argv);
  // At once: what others may do at an end, the system refuses by now.
  std::fflush(nullptr);
  std::_Exit(exit_code);
}
