// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/system/dds_log.hpp"
#include "gateway/upstream/program/steady.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <string>
#include <utility>

#include "gateway/core/log.hpp"

namespace axisgate::dds {
namespace {

using eprosima::fastdds::dds::Log;

class ToLog : public eprosima::fastdds::dds::LogConsumer {
 public:
  explicit ToLog(DdsLog& log) : log_(log) {}
  void Consume(const Log::Entry& entry) override {
    // What the library calls an error is a warning to us: it goes on, and says so of packets that others have spoiled.
    const std::string category = entry.context.category == nullptr ? "" : entry.context.category;
    log_.add({static_cast<std::uint8_t>(LogLevel::warning), "Fast DDS: " + category + ": " + entry.message});
  }

 private:
  DdsLog& log_;
};

}  // namespace

void DdsLog::add(LogRecord line) {
  {
    const std::lock_guard lock(mutex_);
    if (lines_.size() >= kMaxLogLinesWaiting) {
      ++left_out_;
      return;
    }
    lines_.push_back(std::move(line));
  }
  wake_.set();
}

std::optional<LogRecord> DdsLog::next(SteadyNs now) {
  const std::lock_guard lock(mutex_);
  if (now - second_ >= kSecond) {
    second_ = now;
    in_second_ = 0;
  }
  if (in_second_ >= kMaxLogLinesPerSecond) return std::nullopt;
  if (lines_.empty() && left_out_ == 0) return std::nullopt;
  ++in_second_;
  if (lines_.empty()) {
    return LogRecord{static_cast<std::uint8_t>(LogLevel::warning),
                     "Fast DDS: " + std::to_string(std::exchange(left_out_, 0)) + " more lines were left out"};
  }
  LogRecord line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

void take_over_library_log(DdsLog& log) {
  Log::ClearConsumers();
  Log::SetVerbosity(Log::Kind::Error);
  Log::ReportFunctions(false);
  Log::RegisterConsumer(std::make_unique<ToLog>(log));
}

void release_library_log() {
  Log::Flush();
  Log::ClearConsumers();
}

}  // namespace axisgate::dds
