// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/host/restart_cause.hpp"

#include <csignal>
#include <cstring>

#include "gateway/upstream/link/coder.hpp"
#include "gateway/upstream/link/exit_codes.hpp"

namespace axisgate::host {
namespace {

std::string exit_text(const HostedProgram& program, int code) {
  switch (code) {
    case link::kExitGatewayGone:
      return "lost its connection to the gateway";
    case link::kExitUsage:
      return "does not know its command line: " + link::not_of_one_installation(program.name);
    case link::kExitInternal:
      return "met a state that it cannot go on from";
    case link::kExitCannotServe:
      return std::string(program.cannot_serve);
    case link::kExitNoAddress:
      return std::string(program.no_address);
    case link::kExitProtocol:
      return "was sent what is no record: " + link::not_of_one_installation(program.name);
    case link::kExitMemory:
      return "reached its memory limit (memory_limit_mb)";
    case 127:  // as a shell tells it
      return "is no program that this system can execute";
    default:
      return "ended with exit code " + std::to_string(code);
  }
}

std::string signal_text(int signal) {
  const char* const name = sigabbrev_np(signal);
  const std::string number =
      "signal " + std::to_string(signal) + (name == nullptr ? "" : " (" + std::string(name) + ")");
  switch (signal) {
    case SIGKILL:
      return "was killed: " + number + ", by somebody or by the system for want of memory";
    case SIGBUS:
      return "crashed: " + number + "; a /dev/shm that is too small does this";
    case SIGSEGV:
    case SIGABRT:
    case SIGFPE:
    case SIGILL:
      return "crashed: " + number;
    default:
      return "was ended: " + number;
  }
}

}  // namespace

bool has_no_address(const ProcessEnd& end) {
  return end.how == ProcessEnd::How::exited && end.number == link::kExitNoAddress;
}

std::string text(const HostedProgram& program, const ProcessEnd& end) {
  const std::string name = std::string(program.name) + " ";
  switch (end.how) {
    case ProcessEnd::How::exited:
      return name + exit_text(program, end.number);
    case ProcessEnd::How::killed:
      return name + signal_text(end.number);
    case ProcessEnd::How::unknown:
      return name + "ended, and the system does not tell how";
    case ProcessEnd::How::not_found:
      return name + "is not installed: " + end.detail;
    case ProcessEnd::How::not_started:
      return name + "could not be started: " + std::strerror(end.number);
    case ProcessEnd::How::not_ready:
      return name + "was not ready in time and was killed";
    case ProcessEnd::How::stuck:
      return name + "took nothing from the gateway for too long and was killed";
    case ProcessEnd::How::not_a_record:
      return name + "sent " + end.detail + " and was killed";
    case ProcessEnd::How::closed:
      return name + "closed its connection, did not end and was killed";
    case ProcessEnd::How::another_configuration:
      return name + "was ended for another configuration";
  }
  return {};
}

}  // namespace axisgate::host
