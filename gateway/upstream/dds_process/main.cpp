// SPDX-License-Identifier: Apache-2.0
// axisgate-dds: the DDS topics of axisgate, in a process of their own.
#include <cstdio>
#include <exception>

#include "gateway/upstream/dds_process/options.hpp"
#include "gateway/upstream/dds_process/serve_command.hpp"
#include "gateway/upstream/dds_process/topics_command.hpp"
#include "gateway/upstream/link/exit_codes.hpp"
#include "gateway/upstream/program/start_error.hpp"

namespace {

struct Runner {
  int operator()(int exit_code) const { return exit_code; }
  template <typename Options>
  int operator()(const Options& options) const {
    return axisgate::dds::run(options);
  }
};

}  // namespace

int main(int argc, char** argv) {
  try {
    return std::visit(Runner{}, axisgate::dds::parse_command_line(argc, argv));
  } catch (const axisgate::program::StartError& error) {
    std::fprintf(stderr, "axisgate-dds: %s\n", error.what());
    return error.exit_code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "axisgate-dds: %s\n", error.what());
    return axisgate::link::kExitInternal;
  }
}
