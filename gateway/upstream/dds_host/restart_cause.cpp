// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_host/restart_cause.hpp"

#include <csignal>
#include <cstring>

#include "gateway/upstream/dds_link/exit_codes.hpp"

namespace axisgate::dds {
namespace {

std::string exit_text(int code) {
  switch (code) {
    case kExitGatewayGone:
      return "lost its connection to the gateway";
    case kExitUsage:
      return "does not know its command line: axisgate and axisgate-dds are not of one installation";
    case kExitInternal:
      return "met a state that it cannot go on from";
    case kExitParticipant:
      return "could not create its participant: look at `domain` and `qos_file`, and at its own lines of the log";
    case kExitNoAddress:
      return "has no address yet on one of its `interfaces`, which its own line of the log names";
    case kExitProtocol:
      return "was sent what is no record: axisgate and axisgate-dds are not of one installation";
    case kExitMemory:
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
  return end.how == ProcessEnd::How::exited && end.number == kExitNoAddress;
}

std::string text(const ProcessEnd& end) {
  const std::string name = "axisgate-dds ";
  switch (end.how) {
    case ProcessEnd::How::exited:
      return name + exit_text(end.number);
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
  }
  return {};
}

}  // namespace axisgate::dds
